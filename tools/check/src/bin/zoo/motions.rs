//! Prescribed motions: in the form that users provide, and in double-double with every break
//! declared.

use pendulum_runtime::motion::{
    Analytic, Curve, Derivatives, Function, Motion, Sample, Side, Sinusoid,
};
use pendulum_runtime::scalar::{Float, Octet, Real};
use pendulum_runtime::system::scalar_time;
use pendulum_runtime::time::Time;

/// A function of time with two derivatives, over any scalar.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// a sin(ωt + φ).
    Sine { a: f64, ω: f64, φ: f64 },
    /// An acceleration that starts at a time.
    Jump { a: f64, at: f64 },
    /// A rise from 0 to a along 3u² − 2u³. The acceleration jumps at both ends.
    Ramp { a: f64, from: f64, long: f64 },
    /// Cubic pieces. The third derivative jumps between j and −j where they meet.
    Cubics { j: f64, every: f64 },
    /// a exp(−((t − c)/s)²).
    Pulse { a: f64, c: f64, s: f64 },
    /// A rise from 0 to a along a hyperbolic tangent.
    Rise { a: f64, c: f64, s: f64 },
}

impl Shape {
    /// Returns position, velocity and acceleration. `early(at)` is `true` before the time `at`.
    fn at<T: Real>(&self, t: T, early: impl Fn(f64) -> bool) -> [T; 3] {
        let n = T::from_f64;
        match *self {
            Self::Sine { a, ω, φ } => {
                let (sin, cos) = (n(ω) * t + n(φ)).sin_cos();
                [n(a) * sin, n(a) * n(ω) * cos, -(n(a) * n(ω) * n(ω) * sin)]
            }
            Self::Jump { a, at } => {
                let u = if early(at) { n(0.0) } else { t - n(at) };
                let a = if early(at) { n(0.0) } else { n(a) };
                [a * u * u * n(0.5), a * u, a]
            }
            Self::Ramp { a, from, long } => {
                let (zero, one) = (n(0.0), n(1.0));
                if early(from) {
                    return [zero; 3];
                }
                if !early(from + long) {
                    return [n(a), zero, zero];
                }
                let u = (t - n(from)) / n(long);
                let (speed, a) = (n(6.0) * u * (one - u) / n(long), n(a));
                let bend = n(6.0) * (one - u - u) / (n(long) * n(long));
                [a * u * u * (n(3.0) - u - u), a * speed, a * bend]
            }
            Self::Cubics { j, every } => {
                // The time in a single word determines the piece. At the ends of pieces, both sides
                // agree up to the second derivative.
                let mut piece = 0.0;
                while !early((piece + 1.0) * every) {
                    piece += 1.0;
                }
                let (p, u) = (n(every), t - n(piece) * n(every));
                let x = n(j) * (u * u * u / n(6.0) - p * u * u / n(4.0));
                let (v, a) = (n(j) * (u * u - p * u) / n(2.0), n(j) * (u - p / n(2.0)));
                if piece % 2.0 == 0.0 {
                    [x, v, a]
                } else {
                    [-(n(j) * p * p * p / n(12.0)) - x, -v, -a]
                }
            }
            Self::Pulse { a, c, s } => {
                let u = (t - n(c)) / n(s);
                let x = n(a) * (-(u * u)).exp();
                [x, -(n(2.0) * u * x) / n(s), (n(4.0) * u * u - n(2.0)) * x / (n(s) * n(s))]
            }
            Self::Rise { a, c, s } => {
                let tanh = ((t - n(c)) / n(s)).tanh();
                let (half, slope) = (n(0.5) * n(a), n(1.0) - tanh * tanh);
                [
                    half * (n(1.0) + tanh),
                    half * slope / n(s),
                    -(n(a) * slope * tanh) / (n(s) * n(s)),
                ]
            }
        }
    }

    /// Returns the times at which the function is not analytic.
    fn breaks(&self) -> Vec<f64> {
        match *self {
            Self::Sine { .. } | Self::Pulse { .. } | Self::Rise { .. } => Vec::new(),
            Self::Jump { at, .. } => vec![at],
            Self::Ramp { from, long, .. } => vec![from, from + long],
            Self::Cubics { every, .. } => (1..400).map(|piece| f64::from(piece) * every).collect(),
        }
    }
}

/// The form in which a motion is provided.
#[derive(Clone, Debug)]
pub(crate) enum Drive {
    /// Closures without declared breaks.
    Closure(Shape, [f64; 2]),
    /// A `Sinusoid` of a sine.
    Sinusoid(Shape, [f64; 2]),
    Keys(Curve<2>),
}

type Closure = Box<dyn Fn(f64) -> [f64; 2]>;

/// A motion of a type available to users.
#[derive(Debug)]
pub(crate) enum Given {
    Function(Function<Closure, Closure, Closure>),
    Sinusoid(Sinusoid<2>),
    Keys(Curve<2>),
}

impl Drive {
    /// Returns the motion in the form that a user provides.
    pub(crate) fn given(&self) -> Given {
        match self {
            Self::Closure(shape, along) => {
                let part = |k: usize| -> Closure {
                    let (shape, along) = (shape.clone(), *along);
                    Box::new(move |t| along.map(|d| d * shape.at(t, |at| t < at)[k]))
                };
                Given::Function(Function::new(part(0)).velocity(part(1)).acceleration(part(2)))
            }
            Self::Sinusoid(Shape::Sine { a, ω, φ }, along) => {
                Given::Sinusoid(Sinusoid::new(along.map(|d| d * a), *ω, [*φ; 2]))
            }
            Self::Sinusoid(..) => unreachable!("a sinusoid is a sine"),
            Self::Keys(keys) => Given::Keys(keys.clone()),
        }
    }

    /// Returns the same motion in double-double, with a break at each time at which it is not
    /// analytic.
    pub(crate) fn exact(&self) -> Exact<'_> {
        Exact(self)
    }
}

macro_rules! each {
    ($given:expr, $motion:ident => $value:expr) => {
        match $given {
            Given::Function($motion) => $value,
            Given::Sinusoid($motion) => $value,
            Given::Keys($motion) => $value,
        }
    };
}

impl<T: Real> Motion<T, 2> for Given {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, 2> {
        each!(self, motion => motion.sample(t, side, wanted))
    }

    fn sample_all(&self, times: &[Time], wanted: Derivatives, samples: &mut [Sample<T, 2>]) {
        each!(self, motion => motion.sample_all(times, wanted, samples));
    }

    fn sample_lanes(&self, times: &[Time; 8], wanted: Derivatives) -> Sample<Octet<T>, 2>
    where
        T: Float,
    {
        each!(self, motion => motion.sample_lanes(times, wanted))
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        each!(self, motion => Motion::<T, 2>::next_kink(motion, t))
    }

    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        each!(self, motion => Motion::<T, 2>::longest_step(motion, t, widths))
    }

    fn analytic(&self) -> Option<&dyn Analytic<T, 2>> {
        each!(self, motion => Motion::<T, 2>::analytic(motion))
    }
}

/// A motion for references.
#[derive(Debug)]
pub(crate) struct Exact<'a>(&'a Drive);

impl<T: Real> Motion<T, 2> for Exact<'_> {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, 2> {
        let (shape, along) = match self.0 {
            Drive::Closure(shape, along) | Drive::Sinusoid(shape, along) => (shape, along),
            Drive::Keys(keys) => return keys.sample(t, side, wanted),
        };
        let early = |at: f64| t.since(at) < 0.0 || t.since(at) == 0.0 && side == Side::Before;
        let orders = shape.at(scalar_time::<T>(t), early);
        let [position, velocity, acceleration] =
            orders.map(|order| along.map(|d| T::from_f64(d) * order));
        Sample { position, velocity, acceleration }
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        match self.0 {
            Drive::Closure(shape, _) | Drive::Sinusoid(shape, _) => {
                shape.breaks().into_iter().find(|at| t < *at)
            }
            // A spline has no kinks between its pieces.
            Drive::Keys(keys) => Motion::<T, 2>::analytic(keys)?.next_break(t),
        }
    }
}
