#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Pendulum { m: kg, L: m, F: N }

    coordinate θ: rad;
    let y = L*[sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    force y = F;
}

fn main() {}
