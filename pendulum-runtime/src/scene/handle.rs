//! Handles of pendulums.

use core::fmt;
use core::marker::PhantomData;

/// A pendulum in a scene: its type and its number among those of its type.
pub struct Handle<S, const N: usize> {
    index: u32,
    kind: PhantomData<fn() -> S>,
}

impl<S, const N: usize> Handle<S, N> {
    /// The pendulum that was hung as number `index` of its type, from 0.
    pub const fn new(index: u32) -> Self {
        Self { index, kind: PhantomData }
    }

    /// Its number among those of its type, in the order of hanging.
    pub const fn index(self) -> u32 {
        self.index
    }
}

impl<S, const N: usize> Clone for Handle<S, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, const N: usize> Copy for Handle<S, N> {}

impl<S, const N: usize> PartialEq for Handle<S, N> {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index
    }
}

impl<S, const N: usize> Eq for Handle<S, N> {}

impl<S, const N: usize> fmt::Debug for Handle<S, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Handle").field(&self.index).finish()
    }
}
