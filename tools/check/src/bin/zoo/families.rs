//! The families: systems with distributions of parameters, starts and intervals.

use crate::blocks::{Forced, Friction, Relay, Wall};
use crate::case::{Case, Guide, Scalar};
use crate::motions::{Drive, Shape};
use crate::random::Random;
use crate::trial::Trial;
use pendulum_runtime::motion::{Curve, MotionError};
use systems::problems::Hung;

/// A problem of any type.
pub(crate) type Problem = Box<dyn Case>;

/// A family of problems.
pub(crate) struct Family {
    pub(crate) name: &'static str,
    pub(crate) scalar: Scalar,
    pub(crate) make: fn(&mut Random, Scalar) -> Problem,
}

impl Family {
    /// Returns the problem of a run, and the generator after its creation.
    pub(crate) fn problem(&self, run: usize) -> (Problem, Random) {
        let mut random = Random::of(self.name, run);
        let case = (self.make)(&mut random, self.scalar);
        (case, random)
    }
}

pub(crate) const fn double(name: &'static str, make: fn(&mut Random, Scalar) -> Problem) -> Family {
    Family { name, scalar: Scalar::F64, make }
}

#[cfg(feature = "all")]
pub(crate) const fn single(name: &'static str, make: fn(&mut Random, Scalar) -> Problem) -> Family {
    Family { name, scalar: Scalar::F32, make }
}

/// The families of the short test.
pub(crate) const SHORT: &[Family] = &[
    double("moving", moving),
    double("closure gentle", |r, s| {
        closure(r, s, |r| Shape::Sine { a: r.within(0.05, 0.2), ω: r.within(1.0, 5.0), φ: 0.0 })
    }),
    double("contact 1e-2", |r, s| contact(r, s, 1e-2)),
    double("contact 1e-3", |r, s| contact(r, s, 1e-3)),
    double("friction", |r, s| friction(r, s, 0.03, 0.0)),
    double("friction 3e-3", |r, s| friction(r, s, 0.003, 0.0)),
    double("stiction", |r, s| friction(r, s, 0.03, 1.0)),
    double("square wave 1e-2", |r, s| square_wave(r, s, 1e-2)),
    double("square wave 1e-3", |r, s| square_wave(r, s, 1e-3)),
    double("sign(sin 10t)", relay),
    double("kick", kick),
    double("kick at rest, limited", |r, s| Box::new(kick_at_rest(r, s).limited(0.05))),
    double("kick at rest", |r, s| Box::new(kick_at_rest(r, s))),
    double("burst", burst),
    double("closure step", |r, s| {
        closure(r, s, |r| Shape::Jump { a: r.within(1.0, 5.0), at: r.within(1.0, 6.0) })
    }),
    double("closure ramp", |r, s| {
        closure(r, s, |r| Shape::Ramp {
            a: r.within(0.1, 0.5),
            from: r.within(1.0, 5.0),
            long: r.within(0.2, 1.0),
        })
    }),
    double("closure cubics", |r, s| {
        closure(r, s, |r| Shape::Cubics { j: r.within(10.0, 100.0), every: r.within(0.1, 0.3) })
    }),
    double("closure rise", |r, s| {
        closure(r, s, |r| Shape::Rise {
            a: r.within(0.1, 0.5),
            c: r.within(2.0, 6.0),
            s: r.within(0.02, 0.2),
        })
    }),
    double("closure pulse", |r, s| {
        closure(r, s, |r| Shape::Pulse {
            a: r.within(0.01, 0.05),
            c: r.within(2.0, 6.0),
            s: r.within(0.02, 0.05),
        })
    }),
    double("spline keys", |r, s| keyed(r, s, Curve::spline)),
    double("linear keys", |r, s| keyed(r, s, Curve::linear)),
    double("catmull-rom keys", |r, s| keyed(r, s, Curve::catmull_rom)),
    double("kapitza 1 kHz", |r, s| kapitza(r, s, 1000.0, 0.3)),
    double("kapitza 100 Hz", |r, s| kapitza(r, s, 100.0, 1.0)),
];

/// Shortens the interval for double-double, which takes a hundred times as long.
pub(crate) fn shorter(scalar: Scalar, end: f64) -> f64 {
    if scalar == Scalar::Wide { 0.25 * end } else { end }
}

/// Creates a pendulum with a random start.
pub(crate) fn pendulum<S, F>(r: &mut Random, trial: F) -> Problem
where
    F: FnOnce(f64, [f64; 1]) -> Trial<S, 1>,
    Trial<S, 1>: Case + 'static,
{
    let (q, v) = (r.within(-1.5, 1.5), [r.within(-2.0, 2.0)]);
    Box::new(trial(q, v))
}

pub(crate) fn contact(r: &mut Random, scalar: Scalar, w: f64) -> Problem {
    let wall = Wall { g: 9.81, k: 1e4, w };
    let (q, v) = ([r.within(0.3, 1.2)], [r.within(-1.0, 1.0)]);
    Box::new(Trial::new(scalar, &wall, q, v, shorter(scalar, 3.0), Guide::max_step(5.0 * w)))
}

pub(crate) fn friction(r: &mut Random, scalar: Scalar, w: f64, s: f64) -> Problem {
    let (μ, ω) = (r.within(0.3, 1.0), r.within(0.5, 3.0));
    let block = Friction { k: 4.0, μ, w, s, u: 0.1, f: 1.5, ω };
    let (q, v) = ([r.within(-1.0, 1.0)], [r.within(-1.0, 1.0)]);
    Box::new(Trial::new(scalar, &block, q, v, 10.0, Guide::max_step((2.0 * w).min(0.05))))
}

const UNFORCED: Forced =
    Forced { g: 9.81, a: 0.0, ω: 1.0, w: 1.0, k: 0.0, c: 0.0, s: 1.0, b: 0.0 };

pub(crate) fn square_wave(r: &mut Random, scalar: Scalar, w: f64) -> Problem {
    let forced = Forced { a: r.within(0.5, 3.0), ω: 10.0, w, ..UNFORCED };
    let end = shorter(scalar, 5.0);
    pendulum(r, |q, v| {
        Trial::new(scalar, &forced, [q], v, end, Guide::max_step((2.0 * w).min(0.02)))
    })
}

pub(crate) fn relay(r: &mut Random, scalar: Scalar) -> Problem {
    let relay = Relay { g: 9.81, a: r.within(0.5, 3.0), ω: 10.0 };
    pendulum(r, |q, v| Trial::new(scalar, &relay, [q], v, 5.0, Guide::max_step(0.05)))
}

pub(crate) fn kick(r: &mut Random, scalar: Scalar) -> Problem {
    let forced = Forced { k: r.within(30.0, 100.0), c: r.within(2.0, 6.0), s: 0.01, ..UNFORCED };
    pendulum(r, |q, v| Trial::new(scalar, &forced, [q], v, 8.0, Guide::max_step(0.02)))
}

pub(crate) fn kick_at_rest(r: &mut Random, scalar: Scalar) -> Trial<Forced<f64>, 1> {
    let forced = Forced { k: r.within(30.0, 100.0), c: r.within(5.0, 15.0), s: 0.01, ..UNFORCED };
    Trial::new(scalar, &forced, [0.0], [0.0], 20.0, Guide::max_step(0.02))
}

pub(crate) fn burst(r: &mut Random, scalar: Scalar) -> Problem {
    let forced = Forced {
        k: r.within(5.0, 30.0),
        c: r.within(2.0, 6.0),
        s: r.within(0.1, 0.4),
        b: r.within(50.0, 150.0),
        ..UNFORCED
    };
    pendulum(r, |q, v| Trial::new(scalar, &forced, [q], v, 8.0, Guide::max_step(0.1)))
}

/// Creates a pendulum on a joint moved by closures.
pub(crate) fn closure(r: &mut Random, scalar: Scalar, shape: fn(&mut Random) -> Shape) -> Problem {
    let hung = Hung { l: r.within(0.3, 1.0), g: 9.81 };
    let shape = shape(r);
    let longest =
        if let Shape::Pulse { s, .. } | Shape::Rise { s, .. } = shape { s } else { 1e300 };
    let drive = Drive::Closure(shape, [1.0, 0.3]);
    pendulum(r, |q, v| {
        Trial::new(scalar, &hung, [q], v, 8.0, Guide::max_step(longest)).driven(drive)
    })
}

pub(crate) fn moving(r: &mut Random, scalar: Scalar) -> Problem {
    let hung = Hung { l: r.within(0.3, 1.0), g: 9.81 };
    let shape =
        Shape::Sine { a: r.within(0.05, 0.2), ω: r.within(1.0, 5.0), φ: r.within(0.0, 6.0) };
    pendulum(r, |q, v| {
        Trial::new(scalar, &hung, [q], v, 8.0, Guide::FREE)
            .driven(Drive::Sinusoid(shape, [1.0, 0.2]))
    })
}

/// A constructor of curves through keys.
type Keys = fn(&[f64], &[[f64; 2]]) -> Result<Curve<2>, MotionError>;

pub(crate) fn keyed(r: &mut Random, scalar: Scalar, keys: Keys) -> Problem {
    let hung = Hung { l: r.within(0.3, 1.0), g: 9.81 };
    let mut t = -0.1;
    let (mut times, mut values) = (Vec::new(), Vec::new());
    while t < 5.5 {
        times.push(t);
        values.push([r.within(-0.1, 0.1), r.within(-0.05, 0.05)]);
        t += r.within(0.1, 0.5);
    }
    let drive = Drive::Keys(keys(&times, &values).expect("times increase"));
    // The keys have the precision of `f64`.
    let guide = Guide { least: 1e-15, ..Guide::FREE };
    pendulum(r, |q, v| Trial::new(scalar, &hung, [q], v, 5.0, guide).driven(drive))
}

pub(crate) fn kapitza(r: &mut Random, scalar: Scalar, frequency: f64, end: f64) -> Problem {
    let ω = core::f64::consts::TAU * frequency;
    let hung = Hung { l: r.within(0.2, 0.4), g: 9.81 };
    let drive = Drive::Sinusoid(
        Shape::Sine { a: r.within(3.0, 6.0) / ω, ω, φ: r.within(0.0, 6.0) },
        [0.0, 1.0],
    );
    let (q, v) = ([r.within(2.0, 4.2)], [r.within(-2.0, 2.0)]);
    Box::new(Trial::new(scalar, &hung, q, v, end, Guide::max_step(0.1 / frequency)).driven(drive))
}
