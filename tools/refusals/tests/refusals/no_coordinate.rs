#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Pendulum { m: kg, L: m }

    kinetic = m/2 * L^2;
}

fn main() {}
