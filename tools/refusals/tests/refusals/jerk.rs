#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Pendulum { m: kg, L: m, g: m/s^2 = 9.81 }

    coordinate θ: rad;
    driven x: m;
    kinetic = m/2 * (L*θ̇ + t*ẍ)^2;
}

fn main() {}
