//! Steps of equal length.

use crate::error::Error;
use crate::integrate::method::{self, Method};
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::controller::{Controller, ControllerState, StepContext};
use crate::integrate::step::short::{is_short, straight};
use crate::scalar::Float;
use crate::system::Dynamics;
use crate::time::Time;

/// A controller of steps of equal length.
///
/// Every stretch between two times at which a step must end (start, kinks, stops, end) is divided
/// into the least number of equal steps that are not longer than requested, up to a relative 1e-9.
/// Steps therefore end exactly at these times, and no sliver is left. Symplectic methods require
/// equal steps: a step size that depends on the state destroys their advantages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedStep {
    step: f64,
    count: Option<u64>,
}

impl FixedStep {
    /// Creates a controller of steps of at most this length in seconds.
    pub const fn new(step: f64) -> Self {
        Self { step, count: None }
    }

    /// Creates a controller of `count` steps over a length of time, or more if kinks divide it.
    pub(crate) fn dividing(length: f64, count: u64) -> Self {
        Self { step: length / count as f64, count: Some(count) }
    }
}

impl<M: Method<D, N>, D: Dynamics<N, Scalar: Float>, const N: usize> Controller<M, D, N>
    for FixedStep
{
    fn check(&self) -> Result<(), Error> {
        match self.count {
            Some(0) => Err(Error::Setting { name: "steps", value: 0.0, required: "at least 1" }),
            None if !(0.0 < self.step && self.step < f64::INFINITY) => Err(Error::Setting {
                name: "step",
                value: self.step,
                required: "positive and finite",
            }),
            _ => Ok(()),
        }
    }

    fn least_steps(&self, length: f64) -> f64 {
        steps(length, self.step)
    }

    #[inline]
    fn step(
        &self,
        state: &mut ControllerState,
        context: StepContext<'_, '_, D, M, N>,
    ) -> Result<StepInterval, Error> {
        let StepContext { method, field, from, to, workspace, target, stats } = context;
        let mut plan = *state;
        let interval = self.next(&mut plan, from.t, target);
        *to = if is_short::<D::Scalar>(interval.h) {
            straight(field, &interval, from)
        } else {
            method.attempt(field, &interval, from, workspace)
        };
        if !to.is_finite() {
            return Err(method::cause(method, field, &interval, from, workspace));
        }
        *state = plan;
        stats.accepted += 1;
        Ok(interval)
    }
}

impl FixedStep {
    /// Returns the next step from `t` on the way to `target`.
    #[inline]
    fn next(&self, plan: &mut ControllerState, t: Time, target: f64) -> StepInterval {
        if target.is_infinite() {
            plan.left = 0;
            return StepInterval::by(t, self.step.copysign(target));
        }
        if plan.left == 0 || plan.target != target {
            let length = -t.since(target);
            let count = steps(length.abs(), self.step);
            *plan = ControllerState {
                h: length / count,
                left: count as u64,
                target,
                ..ControllerState::default()
            };
        }
        plan.left -= 1;
        if plan.left == 0 { StepInterval::to(t, target) } else { StepInterval::by(t, plan.h) }
    }
}

/// Returns the least number of steps over `length` that are not longer than `step`.
fn steps(length: f64, step: f64) -> f64 {
    let count = (length / step * (1.0 - 1e-9)).ceil();
    if 1.0 < count { count } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::{ControllerState, FixedStep, steps};
    use crate::time::Time;

    fn ends(step: f64, targets: &[f64]) -> Vec<f64> {
        let (control, mut plan, mut t, mut ends) =
            (FixedStep::new(step), ControllerState::default(), Time::new(0.0), Vec::new());
        for &target in targets {
            while 0.0 < -t.since(target) {
                t = control.next(&mut plan, t, target).end;
                ends.push(t.to_f64());
            }
        }
        ends
    }

    #[test]
    fn each_stretch_is_divided_evenly_and_met_exactly() {
        assert_eq!(ends(0.3, &[1.0]), [0.25, 0.5, 0.75, 1.0]);
        assert_eq!(ends(0.5, &[0.75, 1.0]), [0.375, 0.75, 1.0]);
        assert_eq!(ends(10.0, &[1.0]), [1.0]);
    }

    #[test]
    fn rounding_adds_no_step() {
        // 10/0.001 and 0.7/0.1 lie a rounding error away from an integer.
        assert_eq!(steps(10.0, 0.001), 10_000.0);
        assert_eq!(steps(0.7, 0.1), 7.0);
        assert_eq!(steps(0.7 + 1e-6, 0.1), 8.0);
    }

    #[test]
    fn a_new_target_makes_a_new_plan() {
        let (control, mut plan) = (FixedStep::new(0.1), ControllerState::default());
        let interval = control.next(&mut plan, Time::new(0.0), 1.0);
        assert_eq!(interval.h, 0.1);
        let interval = control.next(&mut plan, interval.end, 0.15);
        assert_eq!(interval.end, Time::new(0.15));
        let interval = control.next(&mut plan, interval.end, f64::INFINITY);
        assert_eq!(interval.h, 0.1);
        // A step towards an infinite target in between ends the plan of ten steps.
        let interval = control.next(&mut plan, Time::new(0.0), 1.0);
        let interval = control.next(&mut plan, interval.end, f64::INFINITY);
        control.next(&mut plan, interval.end, 1.0);
        assert_eq!(plan.left, 7);
    }
}
