//! Every spelling of a name is one name, in one block.

#![allow(mixed_script_confusables)]

use pendulum_runtime::prelude::*;

lagrangian! {
    /// A pendulum whose pivot is moved.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Pendulum {
        /// Mass.
        m: kg,
        L: m,
        g: m/s^2 = 981/100,
    }

    coordinate theta: rad;
    driven x: [m; 2];
    let y = L * [sin(θ), -cos(theta)];
    let r(p) = x + p;
    kinetic = m/2 * |x_dot + ẏ|^2 + 0*inner(dot(x), y_dot);
    potential = m*g*height(r(y));
    force θ = 0*dot(θ)*theta_dot*θ̇;
}

fn main() {
    let pendulum = Pendulum::new(1.0, 2.0);
    assert_eq!(pendulum.g, 9.81);
    assert_eq!(<Pendulum as System<1>>::FACTS.coordinates, ["theta"]);
}
