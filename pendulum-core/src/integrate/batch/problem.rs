//! Problems, the systems that lanes support, and outcomes.

use crate::integrate::solution::{Failure, Solution};
use crate::jet::{JetDynamics, Jets};
use crate::motion::AnalyticMotions;
use crate::scalar::{Float, Lanes};
use crate::system::{Driven, Dynamics, InLanes, LaneSystem, Staged};
use core::ops::Deref;

/// The number of motions integrated at the same time: a vector of 64 bytes for `f64`.
pub(super) const W: usize = 8;

/// An initial value problem: a system with its driven inputs, and the start of its motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Problem<S: Dynamics<N>, const N: usize> {
    /// The system with its parameters.
    pub system: S,
    /// The start and the end in seconds; an end before the start leads back in time.
    pub time: (f64, f64),
    /// The coordinates at the start.
    pub q: [S::Scalar; N],
    /// The velocities at the start.
    pub v: [S::Scalar; N],
}

/// A problem, borrowed from the caller or owned.
#[derive(Debug)]
pub(crate) enum Posed<'a, S: Dynamics<N>, const N: usize> {
    Borrowed(&'a Problem<S, N>),
    Owned(Problem<S, N>),
}

impl<S: Dynamics<N>, const N: usize> Deref for Posed<'_, S, N> {
    type Target = Problem<S, N>;

    fn deref(&self) -> &Problem<S, N> {
        match self {
            Self::Borrowed(problem) => problem,
            Self::Owned(problem) => problem,
        }
    }
}

/// Dynamics that lanes support: every system that `lagrangian!` generates without control inputs,
/// over `f32` and `f64`, with motions for its driven inputs.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be integrated in a batch",
    note = "a batch takes systems that `lagrangian!` has made, over `f64` or `f32` and without controllers"
)]
pub trait Batched<const N: usize>:
    JetDynamics<N, false, Scalar: Float, System: LaneSystem<InLanes<8>, N, Wide: Jets<N>>> + Sized
{
}

impl<S, const N: usize> Batched<N> for S
where
    S: Jets<N, Scalar: Float, Inputs = ()>,
    S::With<Lanes<S::Scalar, W>>: Jets<N> + Staged<N>,
{
}

impl<S, M, const N: usize> Batched<N> for Driven<S, M>
where
    S: Jets<N, Scalar: Float>,
    M: AnalyticMotions<S::Inputs, S::Scalar, false>,
    S::With<Lanes<S::Scalar, W>>: Jets<N> + Staged<N>,
{
}

/// The system of the dynamics `D` over lanes.
pub(super) type WideOf<D, const N: usize> =
    <<D as Dynamics<N>>::System as LaneSystem<InLanes<W>, N>>::Wide;

/// A source of problems and their indices.
pub(crate) type Problems<'a, D, const N: usize> =
    dyn FnMut() -> Option<(usize, Posed<'a, D, N>)> + 'a;

/// A receiver of outcomes and their indices.
pub type Outcomes<'a, T, const N: usize> = dyn FnMut(usize, Outcome<T, N>) + 'a;

/// The result of one motion of a batch.
pub type Outcome<T, const N: usize> = Result<Solution<T, N>, Failure<T, N>>;
