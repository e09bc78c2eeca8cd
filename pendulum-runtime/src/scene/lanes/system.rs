//! The types of systems that can hang in a scene.

use crate::scalar::{Float, Lane, Lanes};
use crate::scene::sampling::assemble::Assemble;
use crate::scene::sampling::layout::Layout;
use crate::system::{Purpose, Staged, System};

/// The lanes of a block.
pub(crate) const W: usize = 32;

/// Several numbers, one for each pendulum of a block.
pub(crate) type Wide<T> = Lanes<T, W>;

/// A system that can hang in a scene over the scalar `T`: every type that `lagrangian!` generates,
/// over `f32` and `f64`.
pub trait SceneSystem<T: Lane + Float, const N: usize>:
    System<N, Scalar = T, Inputs: Assemble<T>> + Sized + Send + Sync + 'static
{
    /// The same system over lanes.
    #[doc(hidden)]
    type Lanes: Staged<N, Scalar = Lanes<T, 32>, Inputs: Assemble<Lanes<T, 32>>, Prepared: Send + Sync>
        + Send
        + Sync;

    /// The same system over lanes, with every parameter mapped.
    #[doc(hidden)]
    fn widen(&self, map: impl FnMut(T) -> Lanes<T, 32>) -> Self::Lanes;

    /// The same system with every parameter mapped.
    #[doc(hidden)]
    fn mapped(&self, map: impl FnMut(T) -> T) -> Self;
}

impl<S, T: Lane + Float, const N: usize> SceneSystem<T, N> for S
where
    S: System<N, Scalar = T, Inputs: Assemble<T>, With<T> = S> + Send + Sync + 'static,
    S::With<Wide<T>>: Staged<N, Inputs: Assemble<Wide<T>>, Prepared: Send + Sync> + Send + Sync,
{
    type Lanes = S::With<Wide<T>>;

    fn widen(&self, map: impl FnMut(T) -> Wide<T>) -> Self::Lanes {
        self.map(map)
    }

    fn mapped(&self, map: impl FnMut(T) -> T) -> Self {
        self.map(map)
    }
}

/// The two layouts of a system and whether splitting methods suit it.
pub(crate) struct Layouts<S, const N: usize>(core::marker::PhantomData<S>);

impl<S: System<N, Inputs: Assemble<S::Scalar>>, const N: usize> Layouts<S, N> {
    pub(crate) const FORCES: Layout = Layout::new(
        S::FACTS.inputs,
        <S::Inputs as Assemble<S::Scalar>>::COMPONENTS,
        Purpose::Accelerations,
    );
    pub(crate) const MOMENTA: Layout = Layout::new(
        S::FACTS.inputs,
        <S::Inputs as Assemble<S::Scalar>>::COMPONENTS,
        Purpose::Momenta,
    );
    /// It has constraints.
    pub(crate) const HELD: bool = 0 < S::FACTS.held_constraints();
    pub(crate) const SPLITS: bool = S::FACTS.velocity_free && S::FACTS.constant_mass_matrix;
}
