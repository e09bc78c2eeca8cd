//! The systems of the stress table. P01, P22, … are the names of problems whose digits are in
//! `reference`.

#![allow(missing_docs)]

pub(crate) use ::systems::problems::{
    Cart, Double, Five, Hung, Kapitza, Kepler, Simple, Spherical, Triple,
};
use pendulum_runtime::lagrangian;

lagrangian! {
    /// The simple pendulum seen from its upper equilibrium.
    pub struct Upright {}
    coordinate q;
    kinetic = q̇^2/2;
    potential = cos(q);
}

lagrangian! {
    /// The simple pendulum with friction.
    pub struct Damped { c }
    coordinate q;
    kinetic = q̇^2/2;
    potential = -cos(q);
    dissipation = c/2*q̇^2;
}

lagrangian! {
    /// The mean motion of Kapitza's pendulum when it is shaken fast, at the speed `s`: the
    /// effective potential of Kapitza (1951).
    pub struct Effective { s }
    coordinate q;
    kinetic = q̇^2/2;
    potential = -cos(q) + s^2*sin(q)^2/4;
}

/// Chains of links on a fixed joint; those of two, three and five links are problems.
pub(crate) mod chains {
    use pendulum_runtime::lagrangian;

    macro_rules! chain {
        ($($name:ident $links:literal)+) => {$(
            lagrangian! {
                pub(crate) struct $name { m: [1; $links], l: [1; $links], g }
                coordinate θ[$links];
                let y[k in 0..$links] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
                kinetic = sum(k in 0..$links, m[k]/2*|ẏ[k]|^2);
                potential = sum(k in 0..$links, m[k]*g*height(y[k]));
            }
        )+};
    }

    chain! { Chain1 1 Chain8 8 Chain10 10 Chain16 16 }
}

lagrangian! {
    /// P32: a bob on a spring.
    pub struct Elastic { m, k, l, g }
    coordinate r;
    coordinate θ;
    let y = r*[sin(θ), -cos(θ)];
    kinetic = m*|ẏ|^2/2;
    potential = m*g*height(y) + k/2*(r - l)^2;
}

lagrangian! {
    /// P41: the restricted problem of three bodies in the rotating frame, with the mass ratio of
    /// earth and moon.
    pub struct Arenstorf {}
    coordinate x;
    coordinate y;
    let μ = 0.012277471;
    kinetic = ((ẋ - y)^2 + (ẏ + x)^2)/2;
    potential = -(1 - μ)/|[x + μ, y]| - μ/|[x - 1 + μ, y]|;
}
