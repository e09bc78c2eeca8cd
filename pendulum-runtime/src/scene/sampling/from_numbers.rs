//! Construction of the samples of driven inputs from single numbers, and the joints that provide
//! them.

#![allow(clippy::inline_always)]

use crate::motion::Sample;
use crate::scalar::Real;
use crate::scene::error::SceneError;
use crate::scene::handle::SceneId;
use crate::scene::sampling::joint::Joint;
use crate::sealed::Sealed;
use crate::system::Samples;

/// A source of the numbers of samples. A trait is used in place of closures, because closures may
/// not be inlined and would then be compiled for another instruction set.
pub trait Numbers<T>: Sealed {
    /// Returns the number of an input, a derivative (0 for the position) and a component.
    fn number(&mut self, input: usize, derivative: usize, component: usize) -> T;
}

/// A source of numbers given by a function, for code in which inlining is not needed.
pub(crate) struct By<F>(pub(crate) F);

impl<F> Sealed for By<F> {}

impl<T, F: FnMut(usize, usize, usize) -> T> Numbers<T> for By<F> {
    fn number(&mut self, input: usize, derivative: usize, component: usize) -> T {
        (self.0)(input, derivative, component)
    }
}

/// The samples of all driven inputs of a system over the scalar `T`, constructed number by number.
pub trait FromNumbers<T>: Samples + Sealed {
    /// The number of components of each input.
    const COMPONENTS: &'static [usize];

    /// Constructs samples from numbers.
    fn from_numbers(numbers: &mut impl Numbers<T>) -> Self;
}

impl<T: Real> FromNumbers<T> for () {
    const COMPONENTS: &'static [usize] = &[];

    #[inline(always)]
    fn from_numbers(_: &mut impl Numbers<T>) -> Self {}
}

/// The joints on which a system hangs: `()`, a [`Joint`] or a tuple of joints, one for each driven
/// input in the order of declaration.
pub trait Anchor<Inputs>: Sealed {
    /// Returns the indices of the joints in a scene.
    ///
    /// # Errors
    /// Returns an error if a joint belongs to another scene.
    #[doc(hidden)]
    fn joints(&self, scene: SceneId) -> Result<Vec<u32>, SceneError>;
}

impl Anchor<()> for () {
    fn joints(&self, _: SceneId) -> Result<Vec<u32>, SceneError> {
        Ok(Vec::new())
    }
}

impl<T: Real, const D: usize> Anchor<(Sample<T, D>,)> for Joint<D> {
    fn joints(&self, scene: SceneId) -> Result<Vec<u32>, SceneError> {
        Ok(vec![self.of(scene)?])
    }
}

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

macro_rules! tuples {
    ($(($($motion:ident $dim:ident $index:tt),+))+) => {$(
        impl<T: Real, $(const $dim: usize),+> FromNumbers<T> for ($(Sample<T, $dim>,)+) {
            const COMPONENTS: &'static [usize] = &[$($dim),+];

            #[inline(always)]
            fn from_numbers(numbers: &mut impl Numbers<T>) -> Self {
                ($(sample::<T, $dim>($index, numbers),)+)
            }
        }

        impl<T: Real, $(const $dim: usize),+> Anchor<($(Sample<T, $dim>,)+)> for ($(Joint<$dim>,)+) {
            fn joints(&self, scene: SceneId) -> Result<Vec<u32>, SceneError> {
                Ok(vec![$((self.$index).of(scene)?),+])
            }
        }
    )+};
}

for_tuples_of_motions!(tuples);
