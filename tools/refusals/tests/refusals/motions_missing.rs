//! A driven system without its motions.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct MovingPendulum { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate theta: rad;
    driven x: [m; 2];
    let y = L * [sin(theta), -cos(theta)];
    kinetic   = m/2 * |x_dot + dot(y)|^2;
    potential = m*g * (height(x) + height(y));
}

fn main() {
    let pendulum = MovingPendulum::new(1.0, 1.0);
    let _ = solve(&pendulum, (0.0, 10.0), [1.0], [0.0]);
}
