//! Prescribed motions: what drives the joints of a scene.
//!
//! A motion is asked for exactly the derivatives that the equations contain, and says where its
//! kinks are: the times at which its position, velocity or acceleration jumps. There it has two
//! values, one from each side.

mod analytic;
mod attenuated;
mod catmull_rom;
mod clip;
mod error;
mod function;
mod linear;
pub(crate) mod piecewise;
mod projected;
mod sinusoid;
mod spline;
mod still;
#[cfg(test)]
mod tests;

use crate::real::{Lane, Octet, Real};
use crate::sealed::Sealed;
use crate::system::{Input, Purpose};
use crate::time::Time;
pub use analytic::{Analytic, AnalyticMotions, MaybeAnalytic};
pub use attenuated::Attenuated;
pub use catmull_rom::CatmullRom;
pub use clip::{Clip, Interpolation};
pub use error::MotionError;
pub use function::{Function, MaybeFunction, Missing};
pub use linear::Linear;
pub use projected::Projected;
pub use sinusoid::Sinusoid;
pub use spline::Spline;
pub use still::Still;

/// A prescribed motion in `D` dimensions over the scalar `T`.
pub trait Motion<T: Real, const D: usize> {
    /// The derivatives that this motion has between its kinks.
    const HAS: Derivatives;

    /// Position, velocity and acceleration at `t`; those that `wanted` leaves out are zero.
    ///
    /// At a kink the value is the limit from `side`; elsewhere `side` does not matter.
    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D>;

    /// The same at as many times as there are samples, after a kink: for motions that can do
    /// several at once, with the same bits.
    fn sample_all(&self, times: &[Time], wanted: Derivatives, samples: &mut [Sample<T, D>]) {
        for (sample, &t) in samples.iter_mut().zip(times) {
            *sample = self.sample(t, Side::After, wanted);
        }
    }

    /// The same at eight times, a lane each, with the bits of single samples: what
    /// [`Picard`](crate::integrate::Picard) asks for.
    fn sample_lanes(&self, times: &[Time; 8], wanted: Derivatives) -> Sample<Octet<T>, D>
    where
        T: Lane,
    {
        let mut samples = [Sample::zero(); 8];
        self.sample_all(times, wanted, &mut samples);
        let mut lanes = Sample::<Octet<T>, D>::zero();
        for (k, sample) in samples.iter().enumerate() {
            for d in 0..D {
                lanes.position[d].0[k] = sample.position[d];
                lanes.velocity[d].0[k] = sample.velocity[d];
                lanes.acceleration[d].0[k] = sample.acceleration[d];
            }
        }
        lanes
    }

    /// The first time after `t` (never `t` itself) at which the position, the velocity or the
    /// acceleration jumps.
    fn next_kink(&self, t: f64) -> Option<f64>;

    /// The longest step from `t` that cannot go unseen over anything that the motion does, in
    /// seconds, where a step may be `widths` times as long as the narrowest of it; infinite if
    /// nothing is too narrow for any step, and `None` if that is not known.
    ///
    /// Steps end at kinks, so that only what lies between two of them counts. Where nothing is
    /// known, a step is at most a fiftieth of the interval of [`solve`](crate::integrate::solve),
    /// or one second in an [`Integrator`](crate::integrate::Integrator). What lies farther off may
    /// be approached: for something as wide as w the answer is the longer of `widths`·w and half
    /// the distance to its middle, which is always positive; an answer of 0 is an error.
    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        let _ = (t, widths);
        None
    }

    /// The motion as one that knows all its derivatives: `Some(self)` where it is [`Analytic`].
    ///
    /// [`Auto`](crate::integrate::Auto) asks for it.
    fn analytic(&self) -> Option<&dyn Analytic<T, D>> {
        None
    }

    /// A time up to which the point rests from `t` on: `t` itself if that is not known, infinity if
    /// it rests for ever.
    ///
    /// Scenes let pendulums sleep until then, so a time that is too late is wrong and one that is
    /// too early only costs time.
    fn rest_until(&self, t: f64) -> f64 {
        t
    }
}

/// A set of derivatives: of a motion's position, velocity and acceleration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Derivatives(u8);

impl Derivatives {
    /// Nothing at all.
    pub const NONE: Self = Self(0);
    /// The position x.
    pub const POSITION: Self = Self(1);
    /// The velocity ẋ.
    pub const VELOCITY: Self = Self(2);
    /// The acceleration ẍ.
    pub const ACCELERATION: Self = Self(4);
    /// All three.
    pub const ALL: Self = Self(7);

    /// The derivatives that are in `self`, in `other` or in both.
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether all of `other` are in `self`.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// How many there are.
    pub const fn count(self) -> usize {
        self.0.count_ones() as usize
    }

    /// The derivative of that order alone: 0 is the position.
    pub(crate) const fn of(derivative: usize) -> Self {
        Self(1 << derivative)
    }
}

/// The side from which a kink is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// The limit from earlier times.
    Before,
    /// The limit from later times.
    After,
}

impl Side {
    /// The other side.
    pub const fn opposite(self) -> Self {
        match self {
            Self::Before => Self::After,
            Self::After => Self::Before,
        }
    }
}

/// A motion at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<T, const D: usize> {
    /// x, in metres as a rule.
    pub position: [T; D],
    /// ẋ.
    pub velocity: [T; D],
    /// ẍ.
    pub acceleration: [T; D],
}

impl<T, const D: usize> Sealed for Sample<T, D> {}

impl<T: Real, const D: usize> Sample<T, D> {
    /// Zero in all components.
    pub fn zero() -> Self {
        let zero = [T::from_f64(0.0); D];
        Self { position: zero, velocity: zero, acceleration: zero }
    }
}

impl<T: Copy, const D: usize> Sample<T, D> {
    /// Every number mapped.
    pub fn map<U>(&self, mut map: impl FnMut(T) -> U) -> Sample<U, D> {
        let (position, velocity) = (self.position.map(&mut map), self.velocity.map(&mut map));
        Sample { position, velocity, acceleration: self.acceleration.map(&mut map) }
    }
}

/// The motions of all driven inputs of a system: `()` or a tuple, in the order of declaration.
pub trait Motions<Inputs> {
    /// The derivatives that each motion has.
    const HAS: &'static [Derivatives];

    /// One sample for each motion.
    fn sample(&self, t: Time, side: Side, inputs: &[Input], purpose: Purpose) -> Inputs;

    /// The first kink of any of them after `t`.
    fn next_kink(&self, t: f64) -> Option<f64>;

    /// The least of the answers of [`Motion::longest_step`], with `unknown` for those that do not
    /// know.
    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        let _ = (t, widths);
        unknown
    }
}

/// Whether motions that have the derivatives `has` can drive `inputs`.
pub(crate) const fn sufficient(has: &[Derivatives], inputs: &[Input]) -> bool {
    let mut index = 0;
    while index < inputs.len() {
        let input = &inputs[index];
        let needed =
            input.accelerations.union(input.momenta).union(input.energy).union(input.power);
        if !has[index].contains(needed) {
            return false;
        }
        index += 1;
    }
    true
}

impl Motions<()> for () {
    const HAS: &'static [Derivatives] = &[];

    fn sample(&self, _: Time, _: Side, _: &[Input], _: Purpose) {}

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }

    #[inline]
    fn longest_step(&self, _: f64, _: f64, _: f64) -> f64 {
        f64::INFINITY
    }
}

/// The shorter of two steps; what is no number stays, so that somebody says so.
#[inline]
pub(crate) fn shorter(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// The earlier of two kinks.
fn earlier(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b < a { b } else { a }),
        (a, None) => a,
        (None, b) => b,
    }
}

/// What an input is asked for; everything, if its system does not say.
pub(crate) const fn derivatives_of(
    inputs: &[Input],
    index: usize,
    purpose: Purpose,
) -> Derivatives {
    if index < inputs.len() { inputs[index].derivatives(purpose) } else { Derivatives::ALL }
}

macro_rules! tuples {
    ($(($($motion:ident $dim:ident $index:tt),+))+) => {$(
        impl<T: Real, $($motion: Motion<T, $dim>, const $dim: usize),+> Motions<($(Sample<T, $dim>,)+)> for ($($motion,)+) {
            const HAS: &'static [Derivatives] = &[$($motion::HAS),+];

            #[inline]
            fn sample(&self, t: Time, side: Side, inputs: &[Input], purpose: Purpose) -> ($(Sample<T, $dim>,)+) {
                ($(self.$index.sample(t, side, derivatives_of(inputs, $index, purpose)),)+)
            }

            fn next_kink(&self, t: f64) -> Option<f64> {
                let mut next = None;
                $(next = earlier(next, self.$index.next_kink(t));)+
                next
            }

            #[inline]
            fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
                let mut longest = f64::INFINITY;
                $(longest = shorter(longest, self.$index.longest_step(t, widths).unwrap_or(unknown));)+
                longest
            }
        }
    )+};
}

for_tuples_of_motions!(tuples);
