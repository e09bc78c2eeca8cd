//! Motions without the derivatives that the equations need.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct MovingPendulum { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate theta: rad;
    driven x: [m; 2];
    let y = L * [sin(theta), -cos(theta)];
    kinetic   = m/2 * |x_dot + dot(y)|^2;
    potential = m*g * (height(x) + height(y));
}

lagrangian! {
    pub struct Carriage { m: kg, c: N*s/m }
    coordinate q: m;
    driven x: m;
    driven z: m;
    kinetic = m/2 * (q_dot + x_dot)^2;
    force q = -c*(q_dot - z_dot);
}

fn main() {
    let lift = motion::Function::new(|t: f64| [0.0, 0.5 * t * t]);
    let driven = MovingPendulum::new(1.0, 1.0).driven_by(lift);
    let _ = solve(&driven, (0.0, 10.0), [1.0], [0.0]).run();

    let push = motion::Function::new(|t: f64| [t * t]).velocity(|t: f64| [2.0 * t]);
    let belt = motion::Function::new(|t: f64| [t]);
    let _ = Carriage::new(1.0, 1.0).driven_by(push, belt);
}
