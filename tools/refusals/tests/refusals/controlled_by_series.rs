//! A method that requires series, with a control law that has no series.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Arm { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate theta: rad;
    input u: N*m;
    kinetic = m/2*L^2*theta_dot^2;
    potential = -m*g*L*cos(theta);
    force theta = u;
}

fn main() {
    let arm = Arm::new(1.0, 1.0).controlled_by(|_, q, _| -q[0]);
    let _ = solve(&arm, (0.0, 10.0), [1.0], [0.0]).method(Taylor::new()).run();
}
