//! The systems that are measured only with `--features all`.

#![allow(missing_docs)]

use crate::case::{Case, Guide, MOST, Method, Run, Scalar, State};
use crate::trial::{Trial, finished};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::DoubleDouble;
use std::time::{Duration, Instant};
use systems::problems::{Double, HenonHeiles, Kepler, Simple};

lagrangian! {
    /// A pendulum with a soft stop at the angle m.
    #[derive(Clone, Debug)]
    pub struct SoftStop { g, k, m, w }
    coordinate q;
    kinetic = q̇^2/2;
    potential = -g*cos(q) + k/2*(w*ln(1 + exp((q - m)/w)))^2;
}

lagrangian! {
    /// A pendulum with what the language has for corners: a sharp valley, a stop and a drag that
    /// grows with the square of the velocity.
    #[derive(Clone, Debug)]
    pub struct Kinked { g, a, k, m, c }
    coordinate q;
    kinetic = q̇^2/2;
    potential = -g*cos(q) + a*abs(q) + k/2*max(0, q - m)^2;
    force q = -c*abs(q̇)*q̇;
}

lagrangian! {
    /// A point in a steep valley with a hill or a needle in its middle.
    #[derive(Clone, Debug)]
    pub struct Steep { a, e, k, d, h, p }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = a*x^12 + e*(exp(k*x) + exp(-k*x)) + d*(x^4/4 - x^2/2) + h*exp(-(x/p)^2);
}

lagrangian! {
    /// A valley with a sharp bottom.
    #[derive(Clone, Debug)]
    pub struct Valley { k, d }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k*sqrt(x^2 + d) + x^2/2;
}

lagrangian! {
    /// The oscillators of Morse, Duffing and van der Pol under a force whose frequency grows.
    #[derive(Clone, Debug)]
    pub struct Oscillator { D, s, k, c, μ, f, ω, χ }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = D*(1 - exp(-s*x))^2 + k*x^2/2 + c*x^4/4;
    force x = f*cos(ω*t + χ*t^2) + μ*(1 - x^2)*ẋ;
}

lagrangian! {
    /// A ball on a soft ground that moves.
    #[derive(Clone, Debug)]
    pub struct Lifted { g, k, w, c }
    coordinate y;
    driven x: [1; 2];
    kinetic = ẏ^2/2;
    potential = g*y + k/2*(w*ln(1 + exp((x.y - y)/w)))^2;
    dissipation = c*ẏ^2/2;
}

lagrangian! {
    /// An atom about another.
    #[derive(Clone, Debug)]
    pub struct Atoms { ε }
    coordinate r;
    coordinate φ;
    lagrangian = (ṙ^2 + r^2*φ̇^2)/2 - 4*ε*(r^(-12) - r^(-6));
}

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Five { l, g }
    coordinate θ[5];
    let y[k in 0..5] = sum(j in 0..=k, l*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..5, |ẏ[k]|^2/2);
    potential = sum(k in 0..5, g*height(y[k]));
}

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Eight { l, g }
    coordinate θ[8];
    let y[k in 0..8] = sum(j in 0..=k, l*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..8, |ẏ[k]|^2/2);
    potential = sum(k in 0..8, g*height(y[k]));
}

lagrangian! {
    /// A bob on a stiff spring.
    #[derive(Clone, Debug)]
    pub struct Elastic { k, g }
    coordinate r;
    coordinate θ;
    let y = r*[sin(θ), -cos(θ)];
    kinetic = |ẏ|^2/2;
    potential = g*height(y) + k/2*(r - 1)^2;
}

lagrangian! {
    /// A bead on a hoop that turns.
    #[derive(Clone, Debug)]
    pub struct Hoop { g, ω }
    coordinate q;
    lagrangian = (q̇^2 + ω^2*sin(q)^2)/2 + g*cos(q);
}

lagrangian! {
    /// A charge in a magnetic field that grows along x.
    #[derive(Clone, Debug)]
    pub struct Charged { B, E }
    coordinate x;
    coordinate y;
    lagrangian = (ẋ^2 + ẏ^2)/2 + B*(x + x^2/4)*ẏ + E*y;
}

lagrangian! {
    /// A spring that turns what it lifts.
    #[derive(Clone, Debug)]
    pub struct Wilberforce { k, δ, ε }
    coordinate z;
    coordinate φ;
    kinetic = (ż^2 + φ̇^2)/2;
    potential = k*z^2/2 + δ*φ^2/2 + ε*z*φ;
}

lagrangian! {
    /// A satellite of the earth and the moon, in the frame that turns with them.
    #[derive(Clone, Debug)]
    pub struct Restricted { μ }
    coordinate x;
    coordinate y;
    lagrangian = ((ẋ - y)^2 + (ẏ + x)^2)/2 + (1 - μ)/|[x + μ, y]| + μ/|[x - 1 + μ, y]|;
}

lagrangian! {
    /// Three stars in a plane.
    #[derive(Clone, Debug)]
    pub struct Stars { G }
    coordinate x[3];
    coordinate y[3];
    kinetic = sum(k in 0..3, (ẋ[k]^2 + ẏ[k]^2)/2);
    potential = -G*(1/|[x[0] - x[1], y[0] - y[1]]| + 1/|[x[1] - x[2], y[1] - y[2]]| + 1/|[x[2] - x[0], y[2] - y[0]]|);
}

lagrangian! {
    /// Three particles on a ring with the springs of Toda.
    #[derive(Clone, Debug)]
    pub struct Toda { a }
    coordinate x[3];
    kinetic = (ẋ[0]^2 + ẋ[1]^2 + ẋ[2]^2)/2;
    potential = exp(a*(x[0] - x[1])) + exp(a*(x[1] - x[2])) + exp(a*(x[2] - x[0]));
}

// `Dprkn12` requires accelerations that do not depend on velocities.
case!(SoftStop, 1, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4 Dprkn12]);
case!(Kinked, 1, free, Dop853, f64 [Default Picard Dop853 Rodas4]);
case!(Steep, 1, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4 Dprkn12]);
case!(Valley, 1, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4 Dprkn12]);
case!(Oscillator, 1, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4]);
case!(Lifted, 1, driven, Dop853, f64 [Default Picard Dop853 Rodas4]);
case!(Atoms, 2, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4], f32 [Default Picard Dop853]);
case!(Double, 2, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4],
    f32 [Default Picard Dop853], dd [Default Taylor Dop853]);
case!(Five, 5, free, Taylor, f64 [Default Picard Dop853]);
case!(Eight, 8, free, Dop853, f64 [Default Picard Dop853]);
case!(Elastic, 2, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4]);
case!(Hoop, 1, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4]);
case!(Charged, 2, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4]);
case!(Wilberforce, 2, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4 Dprkn12]);
case!(Kepler, 2, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4 Dprkn12], dd [Default Taylor Dop853]);
case!(Restricted, 2, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4]);
case!(Stars, 6, free, Taylor, f64 [Default Picard Taylor Dop853 Dprkn12]);
case!(HenonHeiles, 2, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4 Dprkn12]);
case!(Toda, 3, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4 Dprkn12]);
case!(Simple, 1, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4 Dprkn12],
    f32 [Default Picard Dop853], dd [Default Taylor Dop853]);
