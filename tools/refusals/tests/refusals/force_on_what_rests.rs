#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Pendulum { m: kg, L: m, F: N }

    coordinate θ: rad;
    driven x: [m; 2];
    kinetic = m/2 * (L*θ̇)^2;
    force (x + [L, 0]) = [F, 0];
}

fn main() {}
