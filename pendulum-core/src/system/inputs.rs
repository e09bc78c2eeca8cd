//! The samples of driven and controlled inputs of a system, and its outputs.

// Code for lanes must be compiled with the vector instructions of its caller.
#![allow(clippy::inline_always)]

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

/// The samples of all inputs of a system over the scalar `T`: `()` or a tuple of [`Sample`]s.
pub trait Samples<T: Real>: Copy + Debug + PartialEq {
    /// The number of components of each input.
    const COMPONENTS: &'static [usize];

    /// Constructs samples from numbers.
    fn from_numbers(numbers: &mut impl Numbers<T>) -> Self;

    /// Returns the number of an input, a derivative (0 for the position) and a component.
    fn number(&self, input: usize, derivative: usize, component: usize) -> Option<&T>;

    /// Writes `values` to the positions of the inputs, starting with the input of index `first`.
    fn set_controls(&mut self, first: usize, values: &[T]);

    /// Returns samples with zero in all components.
    #[inline(always)]
    fn zero() -> Self {
        Self::from_numbers(&mut |_, _, _| T::from_f64(0.0))
    }

    /// Returns samples of the same shape with every number mapped.
    #[inline(always)]
    fn map<U: Real, I: Samples<U>>(&self, map: impl Fn(T) -> U) -> I {
        I::from_numbers(&mut |input, derivative, component| {
            map(self.number(input, derivative, component).copied().unwrap_or(T::from_f64(0.0)))
        })
    }

    /// Returns the indices of the first number that is not finite: the input, the derivative and
    /// the component.
    fn first_not_finite(&self) -> Option<(usize, usize, usize)> {
        // 0 · x = 0 holds exactly if x is finite.
        let zero = T::from_f64(0.0);
        let components = Self::COMPONENTS.iter().enumerate();
        let mut places = components.flat_map(|(input, &components)| {
            (0..3 * components).map(move |k| (input, k / components, k % components))
        });
        places.find(|&(input, derivative, component)| {
            self.number(input, derivative, component).is_some_and(|x| *x * zero != zero)
        })
    }
}

/// A source of the numbers of samples. Loops over lanes have sources of their own types, because
/// closures may not be inlined and would then be compiled for another instruction set.
pub trait Numbers<T> {
    /// Returns the number of an input, a derivative (0 for the position) and a component.
    fn number(&mut self, input: usize, derivative: usize, component: usize) -> T;
}

impl<T, F: FnMut(usize, usize, usize) -> T> Numbers<T> for F {
    #[inline(always)]
    fn number(&mut self, input: usize, derivative: usize, component: usize) -> T {
        self(input, derivative, component)
    }
}

impl<T: Real> Samples<T> for () {
    const COMPONENTS: &'static [usize] = &[];

    #[inline(always)]
    fn from_numbers(_: &mut impl Numbers<T>) -> Self {}

    #[inline(always)]
    fn number(&self, _: usize, _: usize, _: usize) -> Option<&T> {
        None
    }

    #[inline]
    fn set_controls(&mut self, _: usize, _: &[T]) {}
}

/// Constructs the sample of an input from numbers.
#[inline(always)]
fn sample<T: Real, const D: usize>(input: usize, numbers: &mut impl Numbers<T>) -> Sample<T, D> {
    let mut sample = Sample::zero();
    for c in 0..D {
        sample.position[c] = numbers.number(input, 0, c);
        sample.velocity[c] = numbers.number(input, 1, c);
        sample.acceleration[c] = numbers.number(input, 2, c);
    }
    sample
}

macro_rules! samples {
    ($(($($motion:ident $dim:ident $index:tt),+))+) => {$(
        impl<T: Real, $(const $dim: usize),+> Samples<T> for ($(Sample<T, $dim>,)+) {
            const COMPONENTS: &'static [usize] = &[$($dim),+];

            #[inline(always)]
            fn from_numbers(numbers: &mut impl Numbers<T>) -> Self {
                ($(sample::<T, $dim>($index, numbers),)+)
            }

            #[inline(always)]
            fn number(&self, input: usize, derivative: usize, component: usize) -> Option<&T> {
                match (input, derivative) {
                    $(
                        ($index, 0) => self.$index.position.get(component),
                        ($index, 1) => self.$index.velocity.get(component),
                        ($index, 2) => self.$index.acceleration.get(component),
                    )+
                    _ => None,
                }
            }

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

for_tuples_of_motions!(samples);

/// The samples `()` of a system `S` without inputs.
#[diagnostic::on_unimplemented(
    message = "the inputs of `{S}` are missing",
    label = "call `.driven_by(…)` with a motion for each `driven`, in the order of declaration, then `.controlled_by(…)` or `.sampled(…)` with a controller for all of `input`"
)]
pub trait NoInputs<S> {
    /// Returns the empty samples.
    fn none() -> Self;
}

impl<S> NoInputs<S> for () {
    #[inline]
    fn none() {}
}
