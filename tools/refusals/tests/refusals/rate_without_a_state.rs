//! A rate without a state.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Servo { m: kg, T: s }
    coordinate x: m;
    rate z = x/T;
    kinetic = m/2*x_dot^2;
}

fn main() {}
