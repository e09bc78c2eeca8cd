//! The dynamics of an integration, borrowed or owned.

use crate::error::Error;
use crate::scalar::Float;
use crate::system::Dynamics;
use crate::time::Time;
use core::ops::Deref;

/// Dynamics that an integration borrows or owns.
#[derive(Debug)]
pub(crate) struct Held<'a, D> {
    place: Place<'a, D>,
    /// The number that identifies the integration in sampled controllers, which never use 0.
    run: u64,
}

#[derive(Clone, Debug)]
enum Place<'a, D> {
    Borrowed(&'a D),
    Owned(D),
}

impl<'a, D> Held<'a, D> {
    pub(crate) fn borrowed(dynamics: &'a D) -> Self {
        Self { place: Place::Borrowed(dynamics), run: 0 }
    }

    pub(crate) fn owned(dynamics: D) -> Self {
        Self { place: Place::Owned(dynamics), run: 0 }
    }

    /// Begins an integration at `t`; sampled controllers restart.
    pub(crate) fn begin<const N: usize>(&mut self, t: f64)
    where
        D: Dynamics<N>,
    {
        self.run = Dynamics::begin(&**self, t);
    }

    /// Samples a sampled controller if a sample is due.
    #[inline]
    pub(crate) fn sample<const N: usize>(
        &self,
        t: Time,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
    ) -> Result<bool, Error>
    where
        D: Dynamics<N, Scalar: Float>,
    {
        Dynamics::sample(&**self, self.run, t, q, v)
    }
}

/// The clone of a borrowed sampled controller would be the same controller, in the middle of
/// another integration. The number 0 makes the controller reject the clone of the integration.
impl<D: Clone> Clone for Held<'_, D> {
    fn clone(&self) -> Self {
        let run = if let Place::Owned(_) = self.place { self.run } else { 0 };
        Self { place: self.place.clone(), run }
    }
}

impl<D> Deref for Held<'_, D> {
    type Target = D;

    #[inline]
    fn deref(&self) -> &D {
        match &self.place {
            Place::Borrowed(dynamics) => dynamics,
            Place::Owned(dynamics) => dynamics,
        }
    }
}
