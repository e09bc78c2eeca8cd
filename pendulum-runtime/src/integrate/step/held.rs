//! The dynamics of an integration: borrowed or its own.

use core::ops::Deref;

/// Dynamics that an integration borrows or owns.
#[derive(Clone, Debug)]
pub(crate) enum Held<'a, D> {
    Borrowed(&'a D),
    Owned(D),
}

impl<D> Deref for Held<'_, D> {
    type Target = D;

    #[inline]
    fn deref(&self) -> &D {
        match self {
            Self::Borrowed(dynamics) => dynamics,
            Self::Owned(dynamics) => dynamics,
        }
    }
}
