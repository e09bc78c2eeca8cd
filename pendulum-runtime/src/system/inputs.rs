//! Driven inputs of a system and their samples.

use crate::motion::{Derivatives, Sample};
use crate::scalar::Real;
use core::fmt::Debug;

/// Needs of a system of one of its driven inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input {
    /// The name as written.
    pub name: &'static str,
    /// The number of components.
    pub components: usize,
    /// Derivatives that accelerations and forces need.
    pub accelerations: Derivatives,
    /// Derivatives that momenta, velocities and momentum rates need.
    pub momenta: Derivatives,
    /// Derivatives that the energy needs.
    pub energy: Derivatives,
    /// Derivatives that the power needs.
    pub power: Derivatives,
}

/// The samples of all driven inputs of a system: `()` or a tuple of [`Sample`]s.
pub trait Samples: Copy + Debug + PartialEq {
    /// The first number that is not finite: the input, the derivative (0 for the position) and the
    /// component, by index.
    fn first_not_finite(&self) -> Option<(usize, usize, usize)>;
}

impl Samples for () {
    fn first_not_finite(&self) -> Option<(usize, usize, usize)> {
        None
    }
}

macro_rules! samples {
    ($(($($motion:ident $dim:ident $index:tt),+))+) => {$(
        impl<T: Real, $(const $dim: usize),+> Samples for ($(Sample<T, $dim>,)+) {
            fn first_not_finite(&self) -> Option<(usize, usize, usize)> {
                $(if let Some((derivative, component)) = first_in_sample(&self.$index) {
                    return Some(($index, derivative, component));
                })+
                None
            }
        }
    )+};
}

for_tuples_of_motions!(samples);

/// The derivative and the component of the first number in `sample` that is not finite.
fn first_in_sample<T: Real, const D: usize>(sample: &Sample<T, D>) -> Option<(usize, usize)> {
    // Times zero, infinity and what is not a number are not zero; everything else is.
    let zero = T::from_f64(0.0);
    let infinite = |x: &T| *x * zero != zero;
    let derivatives = [&sample.position, &sample.velocity, &sample.acceleration];
    derivatives
        .iter()
        .enumerate()
        .find_map(|(derivative, values)| Some((derivative, values.iter().position(infinite)?)))
}

/// The output for which a driven input is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Purpose {
    /// [`System::accelerations`](crate::system::System::accelerations) and
    /// [`System::forces`](crate::system::System::forces).
    Accelerations,
    /// [`System::momenta`](crate::system::System::momenta),
    /// [`System::velocities`](crate::system::System::velocities),
    /// [`System::momentum_rates`](crate::system::System::momentum_rates) and
    /// [`System::mass_matrix`](crate::system::System::mass_matrix).
    Momenta,
    /// [`System::energy`](crate::system::System::energy) and the two energies of
    /// [`SplitEnergy`](crate::system::SplitEnergy).
    Energy,
    /// [`System::power`](crate::system::System::power).
    Power,
}

impl Input {
    /// The derivatives that `purpose` needs.
    pub const fn derivatives(&self, purpose: Purpose) -> Derivatives {
        match purpose {
            Purpose::Accelerations => self.accelerations,
            Purpose::Momenta => self.momenta,
            Purpose::Energy => self.energy,
            Purpose::Power => self.power,
        }
    }
}

/// The samples of the driven inputs of a system `S` that has none: `()`.
#[diagnostic::on_unimplemented(
    message = "`{S}` has driven inputs; give their motions by `.driven_by(…)`",
    label = "the motions of its driven inputs are missing",
    note = "`driven_by` takes one motion for each driven input, in the order of declaration"
)]
pub trait NoInputs<S>: Samples {
    /// No samples.
    fn none() -> Self;
}

impl<S> NoInputs<S> for () {
    #[inline]
    fn none() {}
}
