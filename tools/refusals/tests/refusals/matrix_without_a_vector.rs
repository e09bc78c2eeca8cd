#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Particle { M: [kg; 3, 3] }

    coordinate x: [m; 3];
    kinetic = inner(ẋ*M, ẋ)/2;
}

fn main() {}
