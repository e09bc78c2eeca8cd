//! Systems that scenes support.

use crate::scalar::{Float, Lane, Lanes};
use crate::scene::sampling::from_numbers::FromNumbers;
use crate::scene::sampling::layout::Layout;
use crate::system::{InLanes, LaneSystem, Purpose, Staged, System};

/// The number of lanes of a block.
pub(crate) const W: usize = 32;

/// A number for each pendulum of a block.
pub(crate) type Wide<T> = Lanes<T, W>;

/// A system that scenes over the scalar `T` support: every type that `lagrangian!` generates, over
/// `f32` and `f64`.
pub trait SceneSystem<T: Lane + Float, const N: usize>:
    System<N, Scalar = T, With<T> = Self, Inputs: FromNumbers<T>>
    + LaneSystem<
        InLanes<32>,
        N,
        Wide: Staged<N, Inputs: FromNumbers<Lanes<T, 32>>, Prepared: Send + Sync> + Send + Sync,
    > + Sized
    + Send
    + Sync
    + 'static
{
}

impl<S, T: Lane + Float, const N: usize> SceneSystem<T, N> for S
where
    S: System<N, Scalar = T, Inputs: FromNumbers<T>, With<T> = S> + Send + Sync + 'static,
    S::With<Wide<T>>: Staged<N, Inputs: FromNumbers<Wide<T>>, Prepared: Send + Sync> + Send + Sync,
{
}

/// The layouts of the records of a system, and the properties that select its steps.
pub(crate) struct Layouts<S, const N: usize>(core::marker::PhantomData<S>);

impl<S: System<N, Inputs: FromNumbers<S::Scalar>>, const N: usize> Layouts<S, N> {
    pub(crate) const FORCES: Layout = Layout::new(
        S::FACTS.inputs,
        <S::Inputs as FromNumbers<S::Scalar>>::COMPONENTS,
        Purpose::Accelerations,
    );
    pub(crate) const MOMENTA: Layout = Layout::new(
        S::FACTS.inputs,
        <S::Inputs as FromNumbers<S::Scalar>>::COMPONENTS,
        Purpose::Momenta,
    );
    /// `true` if the system has constraints.
    pub(crate) const HELD: bool = 0 < S::FACTS.held_constraints();
    pub(crate) const SPLITS: bool = S::FACTS.velocity_free && S::FACTS.constant_mass_matrix;
}
