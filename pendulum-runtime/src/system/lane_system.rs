//! Systems over scalars of several numbers.

use super::{Staged, System};
use crate::scalar::{Lane, Lanes, Octet, Real};

/// An arrangement of several numbers in one scalar.
#[doc(hidden)]
pub trait Arrangement {
    /// The scalar.
    type Of<T: Lane>: Real;
}

/// As many numbers as [`Lanes`] has room for.
#[doc(hidden)]
#[derive(Debug)]
pub struct InLanes<const W: usize>;

impl<const W: usize> Arrangement for InLanes<W> {
    type Of<T: Lane> = Lanes<T, W>;
}

/// Eight numbers in an [`Octet`].
#[doc(hidden)]
#[derive(Debug)]
pub struct InOctets;

impl Arrangement for InOctets {
    type Of<T: Lane> = Octet<T>;
}

/// A system that stands in lanes: the same equations over a scalar of several numbers, which the
/// arrangement `A` gives.
///
/// Every system that `lagrangian!` generates does; hand-written ones have no stages.
pub trait LaneSystem<A: Arrangement, const N: usize>: System<N, Scalar: Lane> {
    /// The system over lanes.
    #[doc(hidden)]
    type Wide: Staged<N, Scalar = A::Of<Self::Scalar>>;

    /// The system over lanes, with every parameter mapped.
    #[doc(hidden)]
    fn widen(&self, map: impl FnMut(Self::Scalar) -> A::Of<Self::Scalar>) -> Self::Wide;
}

impl<S, A: Arrangement, const N: usize> LaneSystem<A, N> for S
where
    S: System<N, Scalar: Lane>,
    S::With<A::Of<S::Scalar>>: Staged<N>,
{
    type Wide = S::With<A::Of<S::Scalar>>;

    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn widen(&self, map: impl FnMut(S::Scalar) -> A::Of<S::Scalar>) -> Self::Wide {
        self.map(map)
    }
}
