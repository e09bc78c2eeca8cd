//! A block whose struct has the same name as another struct.

use pendulum_runtime::prelude::*;

pub struct Pendulum {
    pub length: f64,
}

lagrangian! {
    pub struct Pendulum { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate theta: rad;
    kinetic   = m/2 * L^2*theta_dot^2;
    potential = -m*g*L*cos(theta);
}

fn main() {}
