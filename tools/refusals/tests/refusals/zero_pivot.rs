#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct LightCone { m: kg }

    coordinate u[2]: m;
    kinetic = m*u̇[0]*u̇[1];
}

fn main() {}
