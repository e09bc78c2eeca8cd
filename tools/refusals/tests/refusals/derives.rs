//! Derived traits that floating-point numbers do not implement.

use pendulum_runtime::prelude::*;

lagrangian! {
    #[derive(Debug, Clone, PartialEq, Eq)]
    #[derive(std::hash::Hash, PartialOrd, Ord)]
    pub struct Pendulum { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate theta: rad;
    kinetic   = m/2 * L^2*theta_dot^2;
    potential = -m*g*L*cos(theta);
}

lagrangian! {
    #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
    pub struct Sound { m: kg }
    coordinate x: m;
    kinetic   = m/2 * x_dot^2;
}

fn main() {}
