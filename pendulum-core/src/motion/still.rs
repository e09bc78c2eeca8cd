//! A point at rest.

use crate::motion::analytic::{Analytic, polynomial};
use crate::motion::prescribed::Motion;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::motion::series::Series;
use crate::scalar::Real;
use crate::time::Time;

/// A point at rest: x(t) = `position`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Still<const D: usize> {
    /// The position in metres.
    pub position: [f64; D],
}

impl<const D: usize> Still<D> {
    /// Creates a point at rest.
    pub const fn new(position: [f64; D]) -> Self {
        Self { position }
    }
}

impl<T: Real, const D: usize> Motion<T, D> for Still<D> {
    const HAS: Derivatives = Derivatives::ALL;

    #[inline]
    fn sample(&self, _: Time, _: Side, wanted: Derivatives) -> Sample<T, D> {
        let mut sample = Sample::zero();
        if wanted.contains(Derivatives::POSITION) {
            sample.position = self.position.map(T::from_f64);
        }
        sample
    }

    fn kink_before(&self, _: f64) -> Option<f64> {
        Some(f64::NEG_INFINITY)
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }

    // No bound: the point never moves.
    fn longest_step(&self, _: f64, _: f64) -> Option<f64> {
        Some(f64::INFINITY)
    }

    fn analytic(&self) -> Option<&dyn Analytic<T, D>> {
        Some(self)
    }

    fn rest_until(&self, _: f64) -> f64 {
        f64::INFINITY
    }
}

impl<T: Real, const D: usize> Analytic<T, D> for Still<D> {
    fn series(&self, _: Time, _: Side, component: usize, count: usize, position: &mut Series<T>) {
        polynomial([self.position[component]], count, position);
    }

    fn next_break(&self, _: f64) -> Option<f64> {
        None
    }

    fn last_break(&self, _: f64) -> Option<f64> {
        None
    }

    fn last_kink(&self, _: f64) -> Option<f64> {
        None
    }
}
