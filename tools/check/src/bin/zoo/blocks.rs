//! The systems that are also used by the short test.

#![allow(missing_docs)]

use crate::case::{Case, Guide, MOST, Method, Run, Scalar, State};
use crate::trial::{Trial, finished};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::DoubleDouble;
use std::time::{Duration, Instant};
use systems::problems::Hung;

lagrangian! {
    /// A ball above a soft ground: a spring that begins over the width w.
    #[derive(Clone, Debug)]
    pub struct Wall { g, k, w }
    coordinate y;
    kinetic = ẏ^2/2;
    potential = g*y + k/2*(w*ln(1 + exp(-y/w)))^2;
}

lagrangian! {
    /// A block on a spring with friction that is greater below the velocity u, and a force.
    #[derive(Clone, Debug)]
    pub struct Friction { k, μ, w, s, u, f, ω }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k*x^2/2;
    force x = f*cos(ω*t) - μ*(1 + s*exp(-(ẋ/u)^2))*tanh(ẋ/w);
}

lagrangian! {
    /// A pendulum under a square wave with smooth sides and a pulse.
    #[derive(Clone, Debug)]
    pub struct Forced { g, a, ω, w, k, c, s, b }
    coordinate q;
    kinetic = q̇^2/2;
    potential = -g*cos(q);
    force q = a*tanh(sin(ω*t)/w) + k*exp(-((t - c)/s)^2)*cos(b*(t - c));
}

lagrangian! {
    /// A pendulum under a square wave.
    #[derive(Clone, Debug)]
    pub struct Relay { g, a, ω }
    coordinate q;
    kinetic = q̇^2/2;
    potential = -g*cos(q);
    force q = a*sign(sin(ω*t));
}

// `Dprkn12` requires accelerations that do not depend on velocities.
case!(Wall, 1, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4 Dprkn12],
    f32 [Default Picard Dop853], dd [Default Taylor Dop853]);
case!(Friction, 1, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4], f32 [Default Picard Dop853]);
case!(Forced, 1, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4 Dprkn12],
    f32 [Default Picard Dop853], dd [Default Taylor Dop853]);
case!(Relay, 1, free, Dop853, f64 [Default Picard Dop853 Rodas4 Dprkn12]);
case!(Hung, 1, driven, Dop853, f64 [Default Picard Dop853 Rodas4 Dprkn12], f32 [Default Picard Dop853]);
