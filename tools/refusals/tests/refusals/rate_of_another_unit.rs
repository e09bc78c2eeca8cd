//! A rate whose unit is not that of its state per second.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Servo { m: kg, T: s }
    coordinate x: m;
    state z: m;
    rate z = x;
    kinetic = m/2*x_dot^2;
}

fn main() {}
