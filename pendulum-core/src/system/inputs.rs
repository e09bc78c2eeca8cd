//! The samples of driven and controlled inputs of a system, and its outputs.

use crate::motion::Sample;
use crate::scalar::Real;
use core::fmt::Debug;

/// An output of a system: its name, unit and shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Output {
    /// The name in the source.
    pub name: &'static str,
    /// The unit in the source, empty if none is given.
    pub unit: &'static str,
    /// The number of members if the output is a family.
    pub members: Option<usize>,
    /// The number of components if the output, or each member of the family, is a vector or a
    /// rotation.
    pub components: Option<usize>,
    /// `true` if it is a rotation, whose components are those of its quaternion.
    pub rotation: bool,
}

impl Output {
    /// Returns the number of scalars: components times members.
    pub const fn count(&self) -> usize {
        let members = if let Some(members) = self.members { members } else { 1 };
        let components = if let Some(components) = self.components { components } else { 1 };
        members * components
    }

    /// Returns the name of each scalar, in the order of
    /// [`System::output`](crate::system::System::output): `tip.x`, `tip[3].y`, `load`, `head.w`.
    pub fn names(&self) -> Vec<String> {
        let component = |k: usize| match self.components {
            None => String::new(),
            Some(_) if self.rotation => format!(".{}", ["w", "x", "y", "z"][k % 4]),
            Some(1..=3) => format!(".{}", ["x", "y", "z"][k]),
            Some(_) => format!("[{k}]"),
        };
        let member = |k: usize| self.members.map_or_else(String::new, |_| format!("[{k}]"));
        let components = self.components.unwrap_or(1);
        (0..self.count())
            .map(|k| {
                format!("{}{}{}", self.name, member(k / components), component(k % components))
            })
            .collect()
    }
}

/// The samples of all inputs of a system: `()` or a tuple of [`Sample`]s.
pub trait Samples: Copy + Debug + PartialEq {
    /// Returns the indices of the first number that is not finite: the input, the derivative (0 for
    /// the position) and the component.
    fn first_not_finite(&self) -> Option<(usize, usize, usize)>;

    /// Returns samples with zero in all components.
    fn zero() -> Self;
}

impl Samples for () {
    fn first_not_finite(&self) -> Option<(usize, usize, usize)> {
        None
    }

    fn zero() {}
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

            fn zero() -> Self {
                ($(Sample::<T, $dim>::zero(),)+)
            }
        }
    )+};
}

for_tuples_of_motions!(samples);

/// Samples of inputs over the scalar `T` in which the values of control inputs can be set.
pub trait ControlSamples<T>: Samples {
    /// Writes `values` to the positions of the inputs, starting with the input of index `first`.
    fn set_controls(&mut self, first: usize, values: &[T]);
}

impl<T> ControlSamples<T> for () {
    #[inline]
    fn set_controls(&mut self, _: usize, _: &[T]) {}
}

macro_rules! control_samples {
    ($(($($motion:ident $dim:ident $index:tt),+))+) => {$(
        impl<T: Real, $(const $dim: usize),+> ControlSamples<T> for ($(Sample<T, $dim>,)+) {
            #[inline]
            fn set_controls(&mut self, first: usize, values: &[T]) {
                let mut values = values.iter();
                $(if first <= $index {
                    for (position, value) in self.$index.position.iter_mut().zip(values.by_ref()) {
                        *position = *value;
                    }
                })+
            }
        }
    )+};
}

for_tuples_of_motions!(control_samples);

/// Returns the derivative and the component of the first number in `sample` that is not finite.
fn first_in_sample<T: Real, const D: usize>(sample: &Sample<T, D>) -> Option<(usize, usize)> {
    // 0 · x = 0 holds exactly if x is finite.
    let zero = T::from_f64(0.0);
    let infinite = |x: &T| *x * zero != zero;
    let derivatives = [&sample.position, &sample.velocity, &sample.acceleration];
    derivatives
        .iter()
        .enumerate()
        .find_map(|(derivative, values)| Some((derivative, values.iter().position(infinite)?)))
}

/// The samples `()` of a system `S` without inputs.
#[diagnostic::on_unimplemented(
    message = "the inputs of `{S}` are missing",
    label = "call `.driven_by(…)` with a motion for each `driven`, in the order of declaration, `.controlled_by(…)` or `.sampled(…)` with a controller for all of `input`"
)]
pub(crate) trait NoInputs<S>: Samples {
    /// Returns the empty samples.
    fn none() -> Self;
}

impl<S> NoInputs<S> for () {
    #[inline]
    fn none() {}
}
