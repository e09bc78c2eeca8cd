//! The systems of the stress table; P01, P22, … are names of problems whose digits stand in `reference`.

#![allow(missing_docs)]

use pendulum_runtime::lagrangian;

lagrangian! {
    /// P01 to P05: a pendulum of unit length and mass.
    #[derive(Clone, Debug)]
    pub struct Simple { g }
    coordinate q;
    kinetic = q̇^2/2;
    potential = -g*cos(q);
}

lagrangian! {
    /// The same seen from its upper equilibrium.
    pub struct Upright {}
    coordinate q;
    kinetic = q̇^2/2;
    potential = cos(q);
}

lagrangian! {
    /// The same with friction.
    pub struct Damped { c }
    coordinate q;
    kinetic = q̇^2/2;
    potential = -cos(q);
    dissipation = c/2*q̇^2;
}

lagrangian! {
    /// A pendulum on a moving joint.
    #[derive(Clone, Debug)]
    pub struct Hung { L, g }
    coordinate θ;
    driven x: [1; 2];
    let y = L*[sin(θ), -cos(θ)];
    kinetic = |ẋ + ẏ|^2/2;
    potential = g*height(x + y);
}

lagrangian! {
    /// P11: the pivot shakes up and down.
    pub struct Kapitza {}
    coordinate q;
    driven y;
    let r = [sin(q), y - cos(q)];
    kinetic = |ṙ|^2/2;
    potential = height(r);
}

lagrangian! {
    /// The mean motion of the same when it is shaken fast, at the speed `s`: the effective potential of Kapitza (1951).
    pub struct Effective { s }
    coordinate q;
    kinetic = q̇^2/2;
    potential = -cos(q) + s^2*sin(q)^2/4;
}

lagrangian! {
    /// P22 to P26: two links from Cartesian positions.
    #[derive(Clone, Debug)]
    pub struct Double { m: [1; 2], l: [1; 2], g }
    coordinate θ[2];
    let y[k in 0..2] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..2, m[k]/2*|ẏ[k]|^2);
    potential = sum(k in 0..2, m[k]*g*height(y[k]));
}

lagrangian! {
    /// P28: three links.
    pub struct Triple { m: [1; 3], l: [1; 3], g }
    coordinate θ[3];
    let y[k in 0..3] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..3, m[k]/2*|ẏ[k]|^2);
    potential = sum(k in 0..3, m[k]*g*height(y[k]));
}

/// Chains of links on a fixed joint.
pub(crate) mod chains {
    use pendulum_runtime::lagrangian;

    macro_rules! chain {
        ($($name:ident $links:literal)+) => {$(
            lagrangian! {
                #[derive(Clone, Debug)]
                pub(crate) struct $name { m: [1; $links], l: [1; $links], g }
                coordinate θ[$links];
                let y[k in 0..$links] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
                kinetic = sum(k in 0..$links, m[k]/2*|ẏ[k]|^2);
                potential = sum(k in 0..$links, m[k]*g*height(y[k]));
            }
        )+};
    }

    chain! { Chain1 1 Chain2 2 Chain3 3 Chain5 5 Chain8 8 Chain10 10 Chain16 16 }
}

lagrangian! {
    /// P31: a pendulum on a cart.
    pub struct Cart { M, m, l, g }
    coordinate x;
    coordinate θ;
    let r = [x + l*sin(θ), -l*cos(θ)];
    kinetic = M/2*ẋ^2 + m/2*|ṙ|^2;
    potential = m*g*height(r);
}

lagrangian! {
    /// P32: a bob on a spring.
    #[derive(Clone, Debug)]
    pub struct Elastic { m, k, l, g }
    coordinate r;
    coordinate θ;
    let y = r*[sin(θ), -cos(θ)];
    kinetic = m*|ẏ|^2/2;
    potential = m*g*height(y) + k/2*(r - l)^2;
}

lagrangian! {
    /// P33: a bob on a sphere.
    pub struct Spherical { l, g }
    coordinate θ;
    coordinate φ;
    let r = l*[sin(θ)*cos(φ), sin(θ)*sin(φ), -cos(θ)];
    kinetic = |ṙ|^2/2;
    potential = g*height(r);
}

lagrangian! {
    /// P38: a planet.
    pub struct Kepler {}
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = -1/|[x, y]|;
}

lagrangian! {
    /// P41: the restricted problem of three bodies in the rotating frame, with the mass ratio of earth and moon.
    pub struct Arenstorf {}
    coordinate x;
    coordinate y;
    let μ = 0.012277471;
    kinetic = ((ẋ - y)^2 + (ẏ + x)^2)/2;
    potential = -(1 - μ)/|[x + μ, y]| - μ/|[x - 1 + μ, y]|;
}
