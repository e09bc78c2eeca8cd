#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Pendulum { m: kg, L: m, g: m/s^2 = 9.81 }

    coordinate θ: rad;
    let a = b + L;
    let b = a - L;
    kinetic = m/2 * (a*θ̇)^2;
}

fn main() {}
