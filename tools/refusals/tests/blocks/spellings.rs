//! All spellings of a name in one block refer to the same name.

#![allow(mixed_script_confusables)]

use pendulum_runtime::motion::Sample;
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::System;

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

lagrangian! {
    /// Nothing has a unit, vectors and families neither.
    pub struct Chain { m: [_; 2], c: [_; 3], g: _ = 9.81 }

    coordinate q[2];
    driven x: [_; 2];
    kinetic = sum(k in 0..2, m[k]/2 * (dot(q[k]) + ẋ.x)^2);
    potential = g*height(x)*q[0] + inner(c, [q[0], q[1], 0]);
}

fn main() {
    let chain = Chain::new([1.0, 2.0], [0.5, 0.25, 0.0]);
    let x = Sample { position: [0.0, 1.0], velocity: [0.0; 2], acceleration: [2.0, 0.0] };
    let [a, b] = chain.accelerations(At { t: 0.0, q: &[0.0; 2], v: &[0.0; 2], inputs: &(x,) });
    assert!((a + 9.81 + 0.5 + 2.0).abs() < 1e-14 && (b + 0.125 + 2.0).abs() < 1e-14);
    let pendulum = Pendulum::new(1.0, 2.0);
    assert_eq!(pendulum.g, 9.81);
    assert_eq!(<Pendulum as System<1>>::FACTS.coordinates, ["theta"]);
}
