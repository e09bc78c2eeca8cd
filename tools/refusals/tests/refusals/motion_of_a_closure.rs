//! A closure in place of a motion.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Cart { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate theta: rad;
    driven x: m;
    let bob = [x, 0] + L*[sin(theta), -cos(theta)];
    kinetic = m/2*|dot(bob)|^2;
    potential = m*g*height(bob);
}

fn main() {
    let _ = Cart::new(1.0, 1.0).driven_by(|t: f64| [t.sin()]);
}
