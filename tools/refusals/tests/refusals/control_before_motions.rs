//! A controller before the motions of the driven inputs.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Arm { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate theta: rad;
    driven x: m;
    input u: N*m;
    kinetic = m/2*((L*cos(theta)*theta_dot + x_dot)^2 + (L*sin(theta)*theta_dot)^2);
    potential = -m*g*L*cos(theta);
    force theta = u;
}

fn main() {
    let arm = Arm::new(1.0, 1.0).controlled_by(|_, q, _| -q[0]);
}
