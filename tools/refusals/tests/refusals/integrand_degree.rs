#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Pendulum { B: body, g: m/s^2 = 9.81 }

    coordinate θ: rad;
    kinetic = integral(p in B, |dot(cis(θ)*p)|^2 / 2);
    potential = integral(p in B, g*|p|^2*p.y);
}

fn main() {}
