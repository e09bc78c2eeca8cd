//! Constraints of pendulums after changes of states, parameters or joints.

use crate::error::Error;
use crate::integrate::State;
use crate::integrate::field::inertia::inertia_of;
use crate::integrate::step::projection;
use crate::motion::Side;
use crate::scalar::{Float, Lane};
use crate::scene::error::SceneError;
use crate::scene::group::joints::inputs_at;
use crate::scene::lanes::detached::Detached;
use crate::scene::sampling::joint::JointSlot;
use crate::scene::system::{Layouts, SceneSystem};
use crate::system::{Dynamics, Purpose};
use crate::time::Time;

/// A system on the joints of a scene.
pub(crate) struct OnJoints<'a, S, T, const N: usize> {
    pub(crate) system: &'a S,
    pub(crate) joint_slots: &'a [JointSlot<T>],
    pub(crate) joints: &'a [u32],
}

impl<S: SceneSystem<T, N>, T: Lane + Float, const N: usize> Dynamics<N> for OnJoints<'_, S, T, N> {
    type System = S;
    type Scalar = T;

    fn system(&self) -> &S {
        self.system
    }

    fn inputs(&self, t: Time, side: Side, purpose: Purpose) -> S::Inputs {
        inputs_at::<S, T, N>(self.joint_slots, self.joints, t, side, purpose, false)
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

impl<S: SceneSystem<T, N>, T: Lane + Float, const N: usize> OnJoints<'_, S, T, N> {
    /// Checks a given state at `t`, and removes deviations from the constraints that are due to
    /// rounding.
    ///
    /// # Errors
    /// Returns an error if the state violates the constraints or if a mass is negative.
    pub(crate) fn start(
        &self,
        t: f64,
        q: [T; N],
        v: [T; N],
    ) -> Result<([T; N], [T; N]), SceneError> {
        self.check_inertia(t, &q, &v)?;
        if const { !Layouts::<S, N>::HELD } {
            return Ok((q, v));
        }
        let start = projection::start(self, Time::new(t), Side::After, q, v);
        let start = start.map_err(SceneError::Constraint)?;
        Ok((start.q.high, start.v.high))
    }

    /// Returns an error if the mass matrix is not positive definite.
    pub(crate) fn check_inertia(&self, t: f64, q: &[T; N], v: &[T; N]) -> Result<(), SceneError> {
        if !S::FACTS.derived {
            return Ok(());
        }
        let t = Time::new(t);
        // The mass matrix is independent of the velocities of joints.
        let (joint_slots, joints, purpose) = (self.joint_slots, self.joints, Purpose::Momenta);
        let inputs = inputs_at::<S, T, N>(joint_slots, joints, t, Side::After, purpose, true);
        inertia_of(self.system, t, q, v, &inputs).map_err(SceneError::Inertia)
    }

    /// Moves a pendulum to the nearest state that fulfils the constraints, after a change of its
    /// parameters or joints.
    ///
    /// # Errors
    /// Returns an error if the search does not reach the constraints.
    pub(crate) fn constrain(
        &self,
        t: f64,
        detached: &mut Detached<T, N>,
    ) -> Result<(), SceneError> {
        if const { !Layouts::<S, N>::HELD } {
            return Ok(());
        }
        let [q, _, v, ..] = detached.state;
        self.check_inertia(t, &q, &v)?;
        let near = projection::nearest(self, &State { t, q, v }).map_err(SceneError::Constraint)?;
        if (near.q, near.v) != (q, v) {
            let zero = [T::from_f64(0.0); N];
            (detached.state[0], detached.state[1]) = (near.q, zero);
            (detached.state[2], detached.state[3]) = (near.v, zero);
        }
        Ok(())
    }

    /// Returns an error with the most violated constraint at the end of a tick of length `h` from
    /// this state; `None` if there are no constraints or the accelerations are not finite.
    pub(crate) fn lost(&self, t: f64, q: &[T; N], v: &[T; N], h: f64) -> Option<Error> {
        if const { !Layouts::<S, N>::HELD } {
            return None;
        }
        let a = self.accelerations_at(Time::new(t), Side::After, q, v);
        let (h, half) = (T::from_f64(h), T::from_f64(0.5));
        let ahead = |x: T, rate: T, more: T| x + h * rate + half * h * h * more;
        let later = State {
            t: t + h.to_f64(),
            q: core::array::from_fn(|i| ahead(q[i], v[i], a[i])),
            v: core::array::from_fn(|i| v[i] + h * a[i]),
        };
        let finite = a.iter().all(|a| a.is_finite());
        finite.then(|| projection::misfit(self, &later))
    }
}
