#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Pendulum { m: pound, L: m }

    coordinate θ: rad;
    kinetic = m/2 * (L*θ̇)^2;
}

fn main() {}
