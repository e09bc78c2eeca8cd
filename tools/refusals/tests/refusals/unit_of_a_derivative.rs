#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Pendulum { m: kg, L: m, k, g: m/s^2 = 9.81 }

    coordinate θ: rad;
    driven x: [m; 2];
    kinetic = m/2 * |x + dot(L*cis(θ))|^2;
}

fn main() {}
