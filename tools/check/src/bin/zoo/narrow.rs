//! The families with functions whose argument passes a narrow range, or a switch, within a step.

#![allow(missing_docs)]

use crate::case::{Case, Guide, MOST, Method, Run, Scalar, State};
use crate::families::{Family, Problem, double, single};
use crate::motions::{Drive, Shape};
use crate::random::Random;
use crate::trial::{Trial, finished};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::DoubleDouble;
use std::time::{Duration, Instant};

lagrangian! {
    /// A pendulum that is kicked when a polynomial of time passes a value.
    #[derive(Clone, Debug)]
    pub struct Timed { g, a, b, c, w }
    coordinate q;
    kinetic = q̇^2/2;
    potential = -g*cos(q);
    force q = a*exp(-((t^2 - c^2)/w)^2) + b/(1 + ((t^3 - c^3)/w)^2);
}

lagrangian! {
    /// A pendulum with a kick that has no derivatives in its middle.
    #[derive(Clone, Debug)]
    pub struct Cusped { g, a, c, w }
    coordinate q;
    kinetic = q̇^2/2;
    potential = -g*cos(q);
    force q = a*exp(-(abs(t - c)/w)^(3/2));
}

lagrangian! {
    /// A pendulum that is kicked when a motion passes a place.
    #[derive(Clone, Debug)]
    pub struct Passed { g, a, c, w }
    coordinate q;
    driven x: [1; 2];
    kinetic = q̇^2/2;
    potential = -g*cos(q);
    force q = a*exp(-((x.x - c)/w)^2);
}

lagrangian! {
    /// A block on a table that shakes, with friction over the width w.
    #[derive(Clone, Debug)]
    pub struct Shaken { a, ω, F, w }
    coordinate x;
    kinetic = ẋ^2/2;
    force x = a*ω^2*sin(ω*t) - F*tanh(ẋ/w);
}

lagrangian! {
    /// A point between two springs, of which the nearer one pulls.
    #[derive(Clone, Debug)]
    pub struct Wells { k }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = k/2*min((x - 1)^2, (x + 1)^2) + y^2/2 + x*y/5;
}

lagrangian! {
    /// A point that passes a step, a ridge and a trench.
    #[derive(Clone, Debug)]
    pub struct Crossed { k, s, c, h, w }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k*x^2/2 - h*atan((x - c)/w);
    force x = -s*sign(x - c/2) - s*max(0, x - c);
}

lagrangian! {
    /// A spring and a pendulum with late kicks, whose tails vanish in different ways.
    #[derive(Clone, Debug)]
    pub struct Late { k, g, h, a, b, d, w, c }
    coordinate q;
    kinetic = q̇^2/2;
    potential = k*q^2/2 - g*cos(q) + h*q^4/4;
    force q = a/cosh((t - c)/w) + b*(1 - tanh((t - c)/w)^2)
        + d*exp(-sqrt(1 + ((t - c)/w)^2));
}

case!(Timed, 1, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4], f32 [Default Picard Dop853]);
case!(Cusped, 1, free, Dop853, f64 [Default Picard Dop853], f32 [Default Picard Dop853]);
case!(Passed, 1, driven, Dop853, f64 [Default Picard Dop853 Rodas4], f32 [Default Picard Dop853]);
case!(Shaken, 1, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4], f32 [Default Picard Dop853]);
case!(Wells, 2, free, Dop853, f64 [Default Picard Dop853 Rodas4], f32 [Default Picard Dop853]);
case!(Crossed, 1, free, Dop853, f64 [Default Picard Dop853 Rodas4], f32 [Default Picard Dop853]);
case!(Late, 1, free, Taylor, f64 [Default Picard Taylor Dop853 Rodas4 Dprkn12], f32 [Default Picard Dop853]);

pub(crate) const NARROW: &[Family] = &[
    double("kick at t^2", |r, s| timed(r, s, 1.0, 0.0)),
    double("kick at t^3", |r, s| timed(r, s, 0.0, 1.0)),
    double("kick with a cusp", cusped),
    double("kick at a place", passed),
    double("shaken block", shaken),
    double("two wells", wells),
    double("step and ridge", crossed),
    double("late kick", |r, s| late(r, s, 0.0)),
    double("late kick, tiny start", |r, s| late(r, s, 1.0)),
    double("tiny start", small),
    single("late kick f32", |r, s| late(r, s, 0.0)),
    single("late kick, tiny start f32", |r, s| late(r, s, 1.0)),
    single("tiny start f32", small),
    single("kick at t^2 f32", |r, s| timed(r, s, 1.0, 0.0)),
    single("kick at t^3 f32", |r, s| timed(r, s, 0.0, 1.0)),
    single("kick with a cusp f32", cusped),
    single("kick at a place f32", passed),
    single("shaken block f32", shaken),
    single("two wells f32", wells),
    single("step and ridge f32", crossed),
];

fn timed(r: &mut Random, scalar: Scalar, a: f64, b: f64) -> Problem {
    let c = r.within(2.0, 10.0);
    let w = r.log_within(0.01, 0.05);
    let size = r.within(5.0, 50.0);
    let system = Timed { g: 9.81, a: size * a, b: size * b, c, w };
    // A series in double-double shows the kick from a few widths away, and the poles of the second
    // one from farther; steps that end at shorter and shorter distances cannot miss it.
    let width = if b == 0.0 { w / c } else { w / (c * c) };
    let apart: Vec<f64> =
        (0..16).map(|k| width * 2f64.powi(k)).take_while(|apart| *apart < 1.0).collect();
    let before = apart.iter().rev().map(|apart| c - apart);
    let stops = before.chain([c]).chain(apart.iter().map(|apart| c + apart)).collect();
    let guide = Guide { stops, ..Guide::max_step(0.2) };
    Box::new(Trial::new(scalar, &system, [0.0], [0.0], 12.0, guide))
}

fn cusped(r: &mut Random, scalar: Scalar) -> Problem {
    let (c, w) = (scalar.round(r.within(2.0, 10.0)), 0.01);
    let system = Cusped { g: 9.81, a: r.within(5.0, 50.0), c, w };
    let guide = Guide { stops: vec![c], ..Guide::max_step(w) };
    Box::new(Trial::new(scalar, &system, [0.0], [0.0], 12.0, guide))
}

fn passed(r: &mut Random, scalar: Scalar) -> Problem {
    let (ω, w) = (r.within(0.2, 2.0), r.log_within(1e-3, 0.01));
    let system = Passed { g: 9.81, a: r.within(5.0, 50.0), c: r.within(0.1, 0.9), w };
    let drive = Drive::Sinusoid(Shape::Sine { a: 1.0, ω, φ: r.within(0.0, 6.0) }, [1.0, 0.0]);
    let guide = Guide::max_step(w / ω);
    Box::new(Trial::new(scalar, &system, [0.0], [0.0], 8.0, guide).driven(drive))
}

fn shaken(r: &mut Random, scalar: Scalar) -> Problem {
    let w = r.log_within(1e-3, 1e-2);
    let system = Shaken { a: 1.0, ω: core::f64::consts::TAU, F: r.within(1.0, 3.0), w };
    let v = [r.within(5.0, 10.0)];
    Box::new(Trial::new(scalar, &system, [0.0], v, 6.0, Guide::max_step(0.02)))
}

fn wells(r: &mut Random, scalar: Scalar) -> Problem {
    let q = [r.within(-0.5, 0.5), r.within(-1.0, 1.0)];
    let v = [r.within(-1.0, 1.0), 0.0];
    let system = Wells { k: r.within(5.0, 30.0) };
    Box::new(Trial::new(scalar, &system, q, v, 4.0, Guide::max_step(0.02)))
}

fn crossed(r: &mut Random, scalar: Scalar) -> Problem {
    let system = Crossed {
        k: r.within(1.0, 5.0),
        s: r.within(0.1, 2.0),
        c: r.within(0.1, 0.6),
        h: r.within(0.05, 0.2),
        w: r.log_within(1e-3, 1e-2),
    };
    let (q, v) = ([r.within(-1.0, -0.5)], [r.within(1.5, 4.0)]);
    Box::new(Trial::new(scalar, &system, q, v, 6.0, Guide::max_step(5e-3)))
}

/// A number whose square underflows, sometimes without all its digits.
fn tiny(r: &mut Random, scalar: Scalar) -> f64 {
    let (least, most) = if scalar == Scalar::F32 { (1e-44, 1e-20) } else { (1e-320, 1e-160) };
    r.log_within(least, most)
}

fn late(r: &mut Random, scalar: Scalar, start: f64) -> Problem {
    let (w, size) = (r.log_within(0.005, 0.1), r.within(5.0, 50.0));
    let mut kicks = [0.0; 3];
    kicks[r.within(0.0, 3.0) as usize % 3] = size;
    let [a, b, d] = kicks;
    let (k, g) = (r.within(0.0, 10.0), r.within(0.0, 10.0));
    let system = Late { k, g, h: 0.0, a, b, d, w, c: r.within(3.0, 15.0) };
    let (q, v) = ([start * tiny(r, scalar)], [start * tiny(r, scalar)]);
    Box::new(Trial::new(scalar, &system, q, v, 20.0, Guide::max_step(2.0 * w)))
}

fn small(r: &mut Random, scalar: Scalar) -> Problem {
    let k = r.log_within(1.0, 1e4);
    let (g, h) = (r.within(-1.0, 10.0), r.within(-1e3, 1e3));
    let system = Late { k, g, h, a: 0.0, b: 0.0, d: 0.0, w: 1.0, c: 0.0 };
    let (q, v) = ([tiny(r, scalar)], [tiny(r, scalar)]);
    Box::new(Trial::new(scalar, &system, q, v, 20.0, Guide::FREE))
}
