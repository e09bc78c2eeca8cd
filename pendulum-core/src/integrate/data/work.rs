//! The work along a solution.

use super::column::{ColumnError, power};
use crate::integrate::field::contacts::Contacts;
use crate::integrate::field::phase::Phase;
use crate::integrate::interpolant::dense::DenseStep;
use crate::integrate::solution::Solution;
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::{Dynamics, Purpose, System};
use crate::time::Time;

/// The changes of the energy along a [`Solution`]: `power + jumps` is the energy at its end less
/// that at its start.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Work<T> {
    /// The integral of the power of forces, dissipation, frictions, drives and controllers.
    pub power: T,
    /// The sum of the changes in an instant: by impacts, by actions of events, and by velocities of
    /// driven inputs that jump.
    pub jumps: T,
}

/// The nodes of Gauss's quadrature with eight points on [−1, 1], and their weights; the other four
/// are symmetric. Abramowitz and Stegun (1964), table 25.4.
const GAUSS: [[f64; 2]; 4] = [
    [0.183434642495649805, 0.362683783378361983],
    [0.525532409916328986, 0.313706645877887287],
    [0.796666477413626740, 0.222381034453374471],
    [0.960289856497536232, 0.101228536290376259],
];

/// The number of terms of a step for which one panel of the quadrature suffices. The power is of
/// twice the degree of the velocities: eight points are exact for seven terms.
const TERMS: usize = 8;

impl<T: Float, const N: usize> Solution<T, N> {
    /// Returns the work along the motion: the integral of the [`power`](Self::power), and the
    /// changes of the energy in an instant beside it.
    ///
    /// The run needs [`dense`](crate::integrate::Solve::dense). The integral is as accurate as the
    /// dense output.
    ///
    /// ```
    /// use pendulum_runtime::prelude::*;
    ///
    /// # mod system {
    /// pendulum_runtime::lagrangian! {
    ///     pub struct Ball { c, g }
    ///     coordinate y;
    ///     kinetic = ẏ^2/2;
    ///     potential = g*y;
    ///     dissipation = c*ẏ^2/2;
    ///     limit floor: y >= 0, restitution = 0.8;
    /// }
    /// # }
    /// # use system::Ball;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let ball = Ball::new(0.1, 9.81);
    /// let run = solve(&ball, (0.0, 1.0), [1.0], [0.0]).rtol(1e-10).dense().run()?;
    /// let work = run.work(&ball)?;
    /// let end = run.energy(&ball)[0];
    /// assert!((9.81 + work.power + work.jumps - end).abs() < 1e-9);
    /// assert!(work.jumps < -2.0 && work.power < -0.2);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// Returns an error for a run without dense output, or if a
    /// [sampled](crate::system::Sampled) controller has run again since.
    pub fn work<D: Dynamics<N, Scalar = T>>(&self, dynamics: &D) -> Result<Work<T>, ColumnError> {
        self.fresh(dynamics, "work")?;
        let dense = self.dense.as_ref().ok_or_else(|| ColumnError::not_dense("work"))?;
        let zero = T::from_f64(0.0);
        let mut work = Work { power: zero, jumps: zero };
        let jumps = self.jumps();
        let mut steps = dense.steps().peekable();
        let energy = |t: Time, side: Side, (q, v): (&[T; N], &[T; N])| {
            let phase = Phase { dynamics, t, side, q, v };
            dynamics.system().energy(phase.at(&phase.inputs(Purpose::Energy)))
        };
        while let Some(step) = steps.next() {
            work.power += integral(dynamics, &step);
            let (t, beyond) = (step.interval.end, step.interval.side());
            let at = |side| dynamics.inputs(t, side, Purpose::Energy);
            let jumped = jumps.binary_search_by(|time| time.total_cmp(&t.to_f64())).is_ok();
            if jumped || at(Side::Before) != at(Side::After) {
                let (q, v) = step.at(T::from_f64(1.0));
                let before = energy(t, beyond.opposite(), (&q, &v));
                let next = steps.peek().map_or((&dense.end().q, &dense.end().v), DenseStep::start);
                work.jumps += energy(t, beyond, next) - before;
            }
        }
        Ok(work)
    }

    /// Returns the times at which an impact or an action of an event has changed the state, sorted.
    fn jumps(&self) -> Vec<f64> {
        let impacts = self.impacts.iter().map(|impact| impact.time);
        let acts = self
            .events
            .iter()
            .filter(|event| (event.state.q, event.state.v) != (event.after.q, event.after.v));
        let times = impacts.chain(acts.map(|event| event.time));
        let mut times: Vec<f64> = times.map(Time::to_f64).collect();
        times.sort_by(f64::total_cmp);
        times
    }
}

/// Returns the integral of the power over a step.
fn integral<T: Float, D: Dynamics<N, Scalar = T>, const N: usize>(
    dynamics: &D,
    step: &DenseStep<'_, T, N>,
) -> T {
    let number = T::from_f64;
    let panels = step.terms().div_ceil(TERMS).max(1);
    let mut sum = number(0.0);
    for panel in 0..panels {
        for [node, weight] in GAUSS.into_iter().flat_map(|[x, w]| [[-x, w], [x, w]]) {
            let theta = (panel as f64 + 0.5 + 0.5 * node) / panels as f64;
            let ((q, v), (t, side)) = (step.at(number(theta)), step.interval.at(theta));
            let phase = Phase { dynamics, t, side, q: &q, v: &v };
            sum += number(weight) * power(&phase, &Contacts::from_bits(step.contacts));
        }
    }
    sum * step.interval.length::<T>() / number(2.0 * panels as f64)
}
