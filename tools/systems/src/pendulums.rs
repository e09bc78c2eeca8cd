//! Pendulums with units, for tests and benchmarks: on a fixed joint and on a moving joint.

#![allow(missing_docs)]

use pendulum_runtime::lagrangian;

lagrangian! {
    /// A point mass on a rod.
    #[derive(Clone, Debug)]
    pub struct Simple { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    let y = L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    potential = m*g*height(y);
}

lagrangian! {
    /// The same on a moving joint.
    #[derive(Clone, Debug)]
    pub struct Hanging { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    potential = m*g*height(y);
}

lagrangian! {
    /// Two such, one on the other, with friction in the joints.
    #[derive(Clone, Debug)]
    pub struct Double { m: kg, l: m, c: N*m*s, g: m/s^2 = 9.81 }
    coordinate θ[2]: rad;
    driven x: [m; 2];
    let y[k in 0..2] = x + sum(j in 0..=k, l*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..2, m/2*|ẏ[k]|^2);
    potential = sum(k in 0..2, m*g*height(y[k]));
    dissipation = c/2*(θ̇[0]^2 + (θ̇[1] - θ̇[0])^2);
}

lagrangian! {
    /// A rigid body on a pivot: `c` is its centre of mass at rest and `I` its moment of inertia,
    /// both about the pivot.
    #[derive(Clone, Debug)]
    pub struct Compound { m: kg, c: [m; 2], I: kg*m^2, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    kinetic = I/2 * θ̇^2;
    potential = m*g*height(cis(θ)*c);
}

lagrangian! {
    /// The same on a moving joint, exactly.
    #[derive(Clone, Debug)]
    pub struct MovingCompound { m: kg, c: [m; 2], I: kg*m^2, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let r = cis(θ)*c;
    kinetic = m/2*|ẋ|^2 + m*inner(ẋ, ṙ) + I/2*θ̇^2;
    potential = m*g*height(x + r);
}
