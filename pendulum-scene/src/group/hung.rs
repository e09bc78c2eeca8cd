//! A pendulum on the joints of its scene: its inputs, checks of its state, and the causes of faults.

use crate::error::SceneError;
use crate::group::frequency::fastest;
use crate::group::rest::rest;
use crate::lanes::bucket::Detached;
use crate::sampling::scheme::{Grid, Kind, MOST_SUBSTEPS, Scheme};
use crate::sampling::world::World;
use crate::system::{Layouts, ORDERS, SceneSystem, needed};
use pendulum_core::error::{Error, Quantity};
use pendulum_core::integrate::limits::{self, Standings};
use pendulum_core::integrate::method::Endpoint;
use pendulum_core::integrate::{Rk4, State, constraints};
use pendulum_core::motion::Side;
use pendulum_core::scalar::Float;
use pendulum_core::system::{
    At, Dynamics, Facts, Purpose, Samples, check_inertia, scalar_time, suspects,
};
use pendulum_core::time::Time;

/// A pendulum with its system on the joints of a scene, with damping and soft stops.
pub(crate) struct Hung<'a, S, T, const N: usize> {
    pub(crate) system: S,
    pub(crate) world: &'a World<T>,
    pub(crate) pendulum: &'a Detached<T, N>,
}

impl<S: SceneSystem<T, N>, T: Float, const N: usize> Dynamics<N> for Hung<'_, S, T, N> {
    type System = S;
    type Scalar = T;

    fn system(&self) -> &S {
        &self.system
    }

    fn inputs(&self, t: Time, side: Side, purpose: Purpose) -> S::Inputs {
        self.sampled(t, side, purpose, false)
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        let kinks = self.world.drives(&self.pendulum.joints).filter_map(|drive| drive.next_kink(t));
        kinks.filter(|&kink| t < kink).min_by(f64::total_cmp)
    }

    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        let drives = self.world.drives(&self.pendulum.joints);
        drives
            .map(|drive| drive.longest_step(t, widths).unwrap_or(unknown))
            .fold(f64::INFINITY, shorter)
    }

    fn accelerations_with(
        &self,
        prepared: &S::Prepared,
        t: Time,
        side: Side,
        q: &[T; N],
        v: &[T; N],
    ) -> [T; N] {
        let inputs = self.inputs(t, side, Purpose::Accelerations);
        let at = At { t: scalar_time(t), q, v, inputs: &inputs };
        let mut a = self.system.accelerations_prepared(prepared, at);
        let limits = &self.pendulum.limits;
        let push = limits.push(q);
        for i in 0..N {
            a[i] += push[i] - limits.damping * v[i];
        }
        a
    }
}

impl<S: SceneSystem<T, N>, T: Float, const N: usize> Hung<'_, S, T, N> {
    /// Returns the samples of all inputs at `t`, with velocities and accelerations of zero.
    pub(crate) fn resting(&self, t: f64, purpose: Purpose) -> S::Inputs {
        self.sampled(Time::new(t), Side::After, purpose, true)
    }

    fn sampled(&self, t: Time, side: Side, purpose: Purpose, at_rest: bool) -> S::Inputs {
        let Detached { joints, controls, .. } = self.pendulum;
        let mut inputs = self.world.inputs::<S, N>(joints, t, side, purpose, at_rest);
        inputs.set_controls(Layouts::<S, N>::DRIVEN, controls);
        inputs
    }

    /// Returns an error if the motion of a joint lacks a derivative that the equations or the
    /// outputs need.
    pub(crate) fn check_motions(&self) -> Result<(), SceneError> {
        for (input, drive) in self.world.drives(&self.pendulum.joints).enumerate() {
            let needs = [Purpose::Accelerations, Purpose::Momenta, Purpose::Outputs]
                .map(|purpose| needed(S::FACTS.inputs, input, purpose));
            for (derivative, order) in ORDERS.into_iter().enumerate() {
                if needs.iter().any(|needs| needs.contains(order)) && !drive.has().contains(order) {
                    let input = S::FACTS.inputs.get(input).map_or("", |input| input.name);
                    return Err(SceneError::Derivative { input, derivative });
                }
            }
        }
        Ok(())
    }

    /// Returns a state given for now, without deviations from the constraints that are due to
    /// rounding and after the impacts at this time, with the states of the limits.
    ///
    /// # Errors
    /// Returns an error if the state violates constraints or limits or if a mass is negative.
    pub(crate) fn begin(&self, q: [T; N], v: [T; N]) -> Result<Begun<T, N>, SceneError> {
        self.check_inertia(&q, &v)?;
        let (now, zero) = (self.world.now(), [T::from_f64(0.0); N]);
        if const { Layouts::<S, N>::LIMITED } {
            let start = limits::start(self, Rk4, now, q, v);
            let (Endpoint { q, v, .. }, standing) = start.map_err(SceneError::Constraint)?;
            return Ok(([q.high, q.low, v.high, v.low, q.high, v.high], standing));
        }
        if const { !Layouts::<S, N>::HELD } {
            return Ok(([q, zero, v, zero, q, v], Standings::OPEN));
        }
        let start = constraints::start(self, Time::new(now), Side::After, q, v);
        let start = start.map_err(SceneError::Constraint)?;
        let (q, v) = (start.q.high, start.v.high);
        Ok(([q, zero, v, zero, q, v], Standings::OPEN))
    }

    /// Returns an error if the mass matrix is not positive definite now.
    fn check_inertia(&self, q: &[T; N], v: &[T; N]) -> Result<(), SceneError> {
        // The mass matrix is independent of the velocities of joints, which a motion may not have.
        let (t, inputs) = (self.world.now(), self.resting(self.world.now(), Purpose::Momenta));
        check_inertia(&self.system, Time::new(t), q, v, &inputs).map_err(SceneError::Inertia)
    }

    /// Returns the nearest coordinates and velocities that fulfil the constraints now, after a
    /// change of parameters or joints.
    ///
    /// # Errors
    /// Returns an error if the search does not reach the constraints.
    pub(crate) fn nearest(&self) -> Result<[[T; N]; 2], SceneError> {
        let [q, _, v, ..] = self.pendulum.state;
        if const { !Layouts::<S, N>::HELD } {
            return Ok([q, v]);
        }
        self.check_inertia(&q, &v)?;
        let near = constraints::nearest(self, &State { t: self.world.now(), q, v });
        near.map(|near| [near.q, near.v]).map_err(SceneError::Constraint)
    }

    /// Returns the kind of the pendulum: its steps, and `true` if its joints rest for ever.
    ///
    /// # Errors
    /// Returns an error if a mass is negative or if the pendulum is too fast in its current state.
    /// If only its neighbourhood is too fast, it takes `MOST_SUBSTEPS` steps.
    pub(crate) fn kind(&self, chosen: Option<Scheme>, tolerance: f64) -> Result<Kind, SceneError> {
        let Detached { id, joints, state: [q, _, v, ..], .. } = self.pendulum;
        self.check_inertia(q, v)?;
        let step = self.world.clock.step();
        let [here, nearby] = self.frequencies(self.world.now());
        let grid = |omega: f64| Grid::of(&S::FACTS, chosen, omega * step, tolerance);
        let grid = match (grid(here), grid(nearby)) {
            (Some(_), Some(grid)) => grid,
            (Some(grid), None) => Grid { substeps: MOST_SUBSTEPS, ..grid },
            (None, _) => {
                return Err(SceneError::Frequency {
                    kind: S::FACTS.name,
                    index: *id,
                    frequency: here,
                    step,
                    tolerance,
                });
            }
        };
        Ok(Kind { grid, still: self.world.still(joints), level: self.world.level(joints) })
    }

    /// Returns the angular frequencies of the fastest small motions at `t`, about the current state
    /// and about its neighbourhood, including those on soft stops.
    fn frequencies(&self, t: f64) -> [f64; 2] {
        let inputs = self.resting(t, Purpose::Accelerations);
        let stop = self.pendulum.limits.stiffness.to_f64().sqrt();
        fastest(&self.system, T::from_f64(t), &self.pendulum.state[0], &inputs)
            .map(|omega| omega.max(stop))
    }

    /// Returns the coordinates at which the pendulum comes to rest, with its joints fixed at their
    /// positions at `t`.
    ///
    /// # Errors
    /// Returns an error if there is no state of rest.
    pub(crate) fn rest(&self, t: f64) -> Result<[T; N], SceneError> {
        let Detached { id, state: [q, ..], limits, .. } = self.pendulum;
        let (inputs, [_, omega]) = (self.resting(t, Purpose::Accelerations), self.frequencies(t));
        rest(&self.system, T::from_f64(t), q, &inputs, omega, limits)
            .ok_or(SceneError::Restless { kind: S::FACTS.name, index: *id })
    }

    /// Returns the error of a tick that begins at `t` with the state of the pendulum: the value
    /// that is not finite, or the violated constraint.
    pub(crate) fn fault(&self, t: f64) -> Error {
        let [q, _, v, ..] = &self.pendulum.state;
        let time = Time::new(t);
        let inputs = self.inputs(time, Side::After, Purpose::Accelerations);
        let a = self.system.accelerations(At { t: scalar_time(time), q, v, inputs: &inputs });
        let wrong = a.iter().position(|a| !a.is_finite());
        if const { Layouts::<S, N>::HELD } && wrong.is_none() {
            // The most violated constraint at the end of the tick, by a parabola.
            let (h, half) = (T::from_f64(self.world.clock.step()), T::from_f64(0.5));
            let ahead = |x: T, rate: T, more: T| x + h * rate + half * h * h * more;
            let later = State {
                t: t + h.to_f64(),
                q: core::array::from_fn(|i| ahead(q[i], v[i], a[i])),
                v: core::array::from_fn(|i| v[i] + h * a[i]),
            };
            return constraints::misfit(self, &later);
        }
        // If all values are finite at the beginning of the tick, the velocity diverges within the
        // tick.
        let fastest = |i: &usize, j: &usize| v[*i].to_f64().abs().total_cmp(&v[*j].to_f64().abs());
        let input = inputs.first_not_finite().map(|(input, derivative, component)| {
            let name = S::FACTS.inputs.get(input).map_or("", |input| input.name);
            Quantity::Input { name, component, derivative }
        });
        let what = input
            .or_else(|| wrong.map(|index| Quantity::Acceleration(S::FACTS.coordinate(index))))
            .unwrap_or_else(|| {
                let index = (0..N).max_by(fastest).unwrap_or(0);
                Quantity::Velocity(S::FACTS.coordinate(index))
            });
        let suspects = match what {
            Quantity::Acceleration(_) => suspects(&self.system),
            _ => Vec::new(),
        };
        Error::NotFinite { t, what, suspects }
    }
}

/// The state of a pendulum as in [`Detached`], and the states of its limits.
pub(crate) type Begun<T, const N: usize> = ([[T; N]; 6], Standings);

/// Returns the shorter of two steps, or the second one if it is NaN, so that NaN is not lost.
fn shorter(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// Returns an error if a state is not finite.
pub(crate) fn check_state<T: Float, const N: usize>(
    facts: &Facts,
    values: &[T; N],
) -> Result<(), SceneError> {
    values.iter().position(|value| !value.is_finite()).map_or(Ok(()), |index| {
        let (coordinate, value) = (facts.coordinate(index), values[index].to_f64());
        Err(SceneError::State { coordinate, value })
    })
}
