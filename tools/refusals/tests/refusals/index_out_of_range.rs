#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Chain { m: [kg; 5] }

    coordinate θ[5]: rad;
    kinetic = sum(k in 0..=5, m[k]/2*θ̇[k]^2);
}

fn main() {}
