//! The test problems integrated by several tests, examples and benchmarks;
//! `tests/methods/problems.rs` contains their digits under the names P01, P11, …

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
    /// A pendulum of unit mass on a moving joint.
    #[derive(Clone, Debug)]
    pub struct Hung { l, g }
    coordinate θ;
    driven x: [1; 2];
    let y = l*[sin(θ), -cos(θ)];
    kinetic = |ẋ + ẏ|^2/2;
    potential = g*height(x + y);
}

lagrangian! {
    /// P11: the pivot shakes up and down as ⅛ cos 32t, prescribed from outside.
    #[derive(Clone, Debug)]
    pub struct Kapitza {}
    coordinate q;
    driven y;
    let r = [sin(q), y - cos(q)];
    kinetic = |ṙ|^2/2;
    potential = height(r);
}

lagrangian! {
    /// P16 with c = ¼: damped and forced; the force stands outside L.
    #[derive(Clone, Debug)]
    pub struct Forced { c }
    coordinate q;
    kinetic = q̇^2/2;
    potential = -cos(q);
    dissipation = c*q̇^2;
    force q = 3/2*cos(5/8*t);
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
    #[derive(Clone, Debug)]
    pub struct Triple { m: [1; 3], l: [1; 3], g }
    coordinate θ[3];
    let y[k in 0..3] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..3, m[k]/2*|ẏ[k]|^2);
    potential = sum(k in 0..3, m[k]*g*height(y[k]));
}

lagrangian! {
    /// P29: five links.
    #[derive(Clone, Debug)]
    pub struct Five { m: [1; 5], l: [1; 5], g }
    coordinate θ[5];
    let y[k in 0..5] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..5, m[k]/2*|ẏ[k]|^2);
    potential = sum(k in 0..5, m[k]*g*height(y[k]));
}

lagrangian! {
    /// P31: a pendulum on a cart.
    #[derive(Clone, Debug)]
    pub struct Cart { M, m, l, g }
    coordinate x;
    coordinate θ;
    let r = [x + l*sin(θ), -l*cos(θ)];
    kinetic = M/2*ẋ^2 + m/2*|ṙ|^2;
    potential = m*g*height(r);
}

lagrangian! {
    /// P32: a bob of unit mass on a spring.
    #[derive(Clone, Debug)]
    pub struct Elastic { k, l, g }
    coordinate r;
    coordinate θ;
    let y = r*[sin(θ), -cos(θ)];
    kinetic = |ẏ|^2/2;
    potential = g*height(y) + k/2*(r - l)^2;
}

lagrangian! {
    /// The same of unit length with a damper beside the spring.
    #[derive(Clone, Debug)]
    pub struct DampedElastic { k, c }
    coordinate r;
    coordinate θ;
    let y = r*[sin(θ), -cos(θ)];
    kinetic = |ẏ|^2/2;
    potential = height(y) + k/2*(r - 1)^2;
    dissipation = c*ṙ^2/2;
}

lagrangian! {
    /// P33: a bob of unit mass on a sphere.
    #[derive(Clone, Debug)]
    pub struct Spherical { l, g }
    coordinate θ;
    coordinate φ;
    let r = l*[sin(θ)*cos(φ), sin(θ)*sin(φ), -cos(θ)];
    kinetic = |ṙ|^2/2;
    potential = g*height(r);
}

lagrangian! {
    /// P35: a bead on a rotating hoop.
    #[derive(Clone, Debug)]
    pub struct Hoop {}
    coordinate q;
    lagrangian = (q̇^2 + 2*sin(q)^2)/2 + cos(q);
}

lagrangian! {
    /// Three bodies in a plane.
    #[derive(Clone, Debug)]
    pub struct ThreeBodies { m: [1; 3], G }
    coordinate r[3]: [1; 2];
    kinetic = sum(k in 0..3, m[k]/2*|ṙ[k]|^2);
    potential = -G*sum(k in 0..3, sum(j in 0..k, m[j]*m[k]/|r[k] - r[j]|));
}

lagrangian! {
    /// P38 with μ = 1: a planet.
    #[derive(Clone, Debug)]
    pub struct Kepler { μ }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = -μ/|[x, y]|;
}

lagrangian! {
    /// P39 with λ = 1: a star in a galaxy.
    #[derive(Clone, Debug)]
    pub struct HenonHeiles { λ }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = (x^2 + y^2)/2 + λ*(x^2*y - y^3/3);
}

lagrangian! {
    /// A ball over a floor that is moved.
    pub struct Lifted { e, g }
    coordinate y;
    driven floor;
    kinetic = ẏ^2/2;
    potential = g*y;
    limit ground: y >= floor, restitution = e;
}
