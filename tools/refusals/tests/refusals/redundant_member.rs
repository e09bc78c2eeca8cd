#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Beads { m: [kg; 2], k: N/m }

    coordinate x[3]: m;
    kinetic = m[0]/2*(ẋ[0] + ẋ[1])^2 + m[1]/2*(ẋ[1] - ẋ[2])^2;
    potential = k/2*sum(j in 0..3, x[j]^2);
}

fn main() {}
