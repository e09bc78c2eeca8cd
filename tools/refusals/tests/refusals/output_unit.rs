//! An output whose unit differs from the declared unit.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Arm { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate theta: rad;
    input u: N*m;
    kinetic = m/2*L^2*theta_dot^2;
    potential = -m*g*L*cos(theta);
    force theta = u;
    output tip: m/s = L*sin(theta);
}

fn main() {}
