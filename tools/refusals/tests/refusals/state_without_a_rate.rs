//! A state without a rate.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Servo { m: kg, T: s }
    coordinate x: m;
    state z: m;
    kinetic = m/2*x_dot^2;
}

fn main() {}
