//! Projections of motions in space to a plane.

use crate::motion::analytic::Analytic;
use crate::motion::prescribed::Motion;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::motion::series::Series;
use crate::scalar::Real;
use crate::time::Time;

/// The projection P x(t) of a motion in space to a plane. Velocities and accelerations are
/// projected, too, and the projection is analytic if the motion is.
#[derive(Clone, Debug, PartialEq)]
pub struct Projected<M>(Seen<M>);

/// A projection that may or may not be analytic, as determined at run time.
#[derive(Clone, Debug, PartialEq)]
struct Seen<M> {
    motion: M,
    rows: [[f64; 3]; 2],
}

impl<M> Projected<M> {
    /// Creates a projection. `rows` are the directions in space of the x and y axes of the plane;
    /// lengths other than 1 scale the motion.
    ///
    /// `[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]` projects along the third axis, `[[0.01, 0.0, 0.0],
    /// [0.0, 0.01, 0.0]]` also converts centimetres to metres.
    pub const fn new(motion: M, rows: [[f64; 3]; 2]) -> Self {
        Self(Seen { motion, rows })
    }
}

impl<T: Real, M: Motion<T, 3>> Motion<T, 2> for Projected<M> {
    const HAS: Derivatives = M::HAS;

    #[inline]
    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, 2> {
        let Seen { motion, rows } = &self.0;
        let sample = motion.sample(t, side, wanted);
        let seen = |vector: [T; 3]| {
            rows.map(|row| {
                let [a, b, c] = row.map(T::from_f64);
                a * vector[0] + b * vector[1] + c * vector[2]
            })
        };
        Sample {
            position: seen(sample.position),
            velocity: seen(sample.velocity),
            acceleration: seen(sample.acceleration),
        }
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        self.0.motion.next_kink(t)
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        self.0.motion.kink_before(t)
    }

    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        self.0.motion.longest_step(t, widths)
    }

    fn analytic(&self) -> Option<&dyn Analytic<T, 2>> {
        self.0.motion.analytic().map(|_| &self.0 as &dyn Analytic<T, 2>)
    }

    fn rest_until(&self, t: f64) -> f64 {
        self.0.motion.rest_until(t)
    }
}

/// Writes the Taylor series of one component of the projection of `motion`.
fn series<T: Real>(
    motion: &(impl Analytic<T, 3> + ?Sized),
    row: &[f64; 3],
    (t, side): (Time, Side),
    count: usize,
    position: &mut Series<T>,
) {
    let (zero, mut along) = (T::from_f64(0.0), *position);
    position[..count].fill(zero);
    for (component, &weight) in row.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
        motion.series(t, side, component, count, &mut along);
        for (sum, &coefficient) in position[..count].iter_mut().zip(&along) {
            *sum += T::from_f64(weight) * coefficient;
        }
    }
}

impl<T: Real, M: Analytic<T, 3>> Analytic<T, 2> for Projected<M> {
    fn series(
        &self,
        t: Time,
        side: Side,
        component: usize,
        count: usize,
        position: &mut Series<T>,
    ) {
        series(&self.0.motion, &self.0.rows[component], (t, side), count, position);
    }

    fn next_break(&self, t: f64) -> Option<f64> {
        self.0.motion.next_break(t)
    }

    fn last_break(&self, t: f64) -> Option<f64> {
        self.0.motion.last_break(t)
    }

    fn last_kink(&self, t: f64) -> Option<f64> {
        self.0.motion.last_kink(t)
    }
}

impl<T: Real, M: Motion<T, 3>> Analytic<T, 2> for Seen<M> {
    fn series(
        &self,
        t: Time,
        side: Side,
        component: usize,
        count: usize,
        position: &mut Series<T>,
    ) {
        if let Some(motion) = self.motion.analytic() {
            series(motion, &self.rows[component], (t, side), count, position);
        }
    }

    fn next_break(&self, t: f64) -> Option<f64> {
        self.motion.analytic()?.next_break(t)
    }

    fn last_break(&self, t: f64) -> Option<f64> {
        self.motion.analytic()?.last_break(t)
    }

    fn last_kink(&self, t: f64) -> Option<f64> {
        self.motion.analytic()?.last_kink(t)
    }
}
