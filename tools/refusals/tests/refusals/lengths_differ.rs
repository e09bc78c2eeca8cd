#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Pendulum { m: kg, L: m, g: m/s^2 = 9.81 }

    coordinate θ: rad;
    let y = L * [sin(θ), -cos(θ)];
    kinetic = m/2 * (L*θ̇)^2;
    potential = m*g*inner(y, [0, 0, 1]);
}

fn main() {}
