//! Driven inputs that are cubic polynomials, given by their derivatives at one time.

use pendulum_runtime::jet::Series;
use pendulum_runtime::motion::{Analytic, Derivatives, Motion, Sample, Side};
use pendulum_runtime::time::Time;

/// Components with position, velocity, acceleration and the third derivative at the time `at`.
#[derive(Clone, Debug)]
pub(crate) struct Cubic<const D: usize> {
    at: f64,
    orders: [[f64; 4]; D],
}

impl<const D: usize> Cubic<D> {
    fn new(at: f64, sample: &Sample<f64, D>, jerks: &[f64]) -> Self {
        let Sample { position, velocity, acceleration } = sample;
        Self {
            at,
            orders: core::array::from_fn(|i| [position[i], velocity[i], acceleration[i], jerks[i]]),
        }
    }

    /// Returns the derivatives of a component at `t`.
    fn orders(&self, t: Time, component: usize) -> [f64; 4] {
        let ([x, v, a, j], s) = (self.orders[component], t.since(self.at));
        [x + s * (v + s / 2.0 * (a + s / 3.0 * j)), v + s * (a + s / 2.0 * j), a + s * j, j]
    }
}

impl<const D: usize> Motion<f64, D> for Cubic<D> {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, _: Side, _: Derivatives) -> Sample<f64, D> {
        let of = |order: usize| core::array::from_fn(|i| self.orders(t, i)[order]);
        Sample { position: of(0), velocity: of(1), acceleration: of(2) }
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

impl<const D: usize> Analytic<f64, D> for Cubic<D> {
    fn series(&self, t: Time, _: Side, component: usize, count: usize, position: &mut Series<f64>) {
        let [x, v, a, j] = self.orders(t, component);
        position[..count].fill(0.0);
        for (coefficient, part) in position[..count].iter_mut().zip([x, v, a / 2.0, j / 6.0]) {
            *coefficient = part;
        }
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

/// The conversion of samples to motions.
pub(crate) trait Driving {
    type Motions;

    /// Returns the motions with these samples at `t`; `jerks` are the third derivatives of the
    /// components.
    fn motions(&self, t: f64, jerks: &[f64]) -> Self::Motions;
}

impl Driving for () {
    type Motions = ();

    fn motions(&self, _: f64, _: &[f64]) {}
}

impl<const A: usize> Driving for (Sample<f64, A>,) {
    type Motions = (Cubic<A>,);

    fn motions(&self, t: f64, jerks: &[f64]) -> Self::Motions {
        (Cubic::new(t, &self.0, jerks),)
    }
}

impl<const A: usize, const B: usize> Driving for (Sample<f64, A>, Sample<f64, B>) {
    type Motions = (Cubic<A>, Cubic<B>);

    fn motions(&self, t: f64, jerks: &[f64]) -> Self::Motions {
        (Cubic::new(t, &self.0, jerks), Cubic::new(t, &self.1, &jerks[A..]))
    }
}
