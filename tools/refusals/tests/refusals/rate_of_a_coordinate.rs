//! The rate of a coordinate.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Servo { m: kg, T: s }
    coordinate x: m;
    rate x = 1;
    kinetic = m/2*x_dot^2;
}

fn main() {}
