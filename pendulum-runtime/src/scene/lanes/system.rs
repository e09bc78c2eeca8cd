//! The types of systems that can hang in a scene.

use crate::real::{Float, Lane, Lanes};
use crate::scene::sampling::assemble::Assemble;
use crate::system::{Input, Purpose, Staged, System};

/// The lanes of a block.
pub(crate) const W: usize = 32;

/// Several numbers, one for each pendulum of a block.
pub(crate) type Wide<T> = Lanes<T, W>;

/// A system that can hang in a scene over the scalar `T`: every type that `lagrangian!` generates,
/// over `f32` and `f64`.
pub trait Hung<T: Lane + Float, const N: usize>:
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

impl<S, T: Lane + Float, const N: usize> Hung<T, N> for S
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

/// Where the derivatives of each input begin in a record that holds those that a purpose needs, one
/// after the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    /// By input and derivative; [`NONE`] if it is not needed.
    begin: [[usize; 3]; 8],
    /// The numbers in a record.
    pub(crate) width: usize,
}

const NONE: usize = usize::MAX;

impl Layout {
    /// The layout for `inputs` with so many `components` each.
    pub(crate) const fn new(inputs: &[Input], components: &[usize], purpose: Purpose) -> Self {
        let (mut begin, mut width, mut input) = ([[NONE; 3]; 8], 0, 0);
        while input < components.len() {
            let orders = crate::motion::orders(inputs, input, purpose);
            let mut derivative = 0;
            while derivative < 3 {
                if orders.contains(crate::motion::Orders::of(derivative)) {
                    begin[input][derivative] = width;
                    width += components[input];
                }
                derivative += 1;
            }
            input += 1;
        }
        Self { begin, width }
    }

    /// The place of a number in a record, if it is there.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    pub(crate) fn place(&self, input: usize, derivative: usize, component: usize) -> Option<usize> {
        let begin = self.begin[input][derivative];
        if begin == NONE { None } else { Some(begin + component) }
    }
}

/// The two layouts of a system and whether splitting methods suit it.
pub(crate) struct Known<S, const N: usize>(core::marker::PhantomData<S>);

impl<S: System<N, Inputs: Assemble<S::Scalar>>, const N: usize> Known<S, N> {
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
    pub(crate) const SPLITS: bool = S::FACTS.velocity_free && S::FACTS.constant_mass_matrix;
}
