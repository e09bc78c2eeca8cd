#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Pendulum { m: kg, L: m, k, g: m/s^2 = 9.81 }

    coordinate θ: rad;
    kinetic = m/2 * (L*θ̇)^2;
    dissipation = m*L^2*θ̇^2/2;
}

fn main() {}
