//! Visibility: hidden pendulums are not computed.

use crate::integrate::{Dop853, solve};
use crate::motion::{Side, shorter};
use crate::scalar::{Float, Lane};
use crate::scene::error::SceneError;
use crate::scene::group::joints::inputs_at;
use crate::scene::group::status::SceneStatus;
use crate::scene::handle::Handle;
use crate::scene::lanes::limits::Limits;
use crate::scene::sampling::joint::JointSlot;
use crate::scene::scene::Scene;
use crate::scene::system::SceneSystem;
use crate::system::{Dynamics, Purpose, scalar_time};
use crate::time::Time;

/// The state in which a hidden pendulum returns.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Resume {
    /// The pendulum continues from the state in which it was hidden.
    Unchanged,
    /// The pendulum hangs at rest.
    Rest,
    /// The motion over the hidden time is integrated in a few large accurate steps. If the hidden
    /// time is longer than `longest`, the integration begins with the state of rest at `longest`
    /// before now.
    CatchUp {
        /// The longest time that is integrated, in seconds.
        longest: f64,
    },
}

/// The dynamics of a pendulum on the joints of a scene, with damping and soft stops.
struct Hanging<'a, S, T, const N: usize> {
    system: S,
    joint_slots: &'a [JointSlot<T>],
    joints: Vec<u32>,
    limits: Limits<T, N>,
}

impl<S: SceneSystem<T, N>, T: Lane + Float, const N: usize> Dynamics<N> for Hanging<'_, S, T, N> {
    type System = S;
    type Scalar = T;

    fn system(&self) -> &S {
        &self.system
    }

    fn inputs(&self, t: Time, side: Side, purpose: Purpose) -> S::Inputs {
        inputs_at::<S, T, N>(self.joint_slots, &self.joints, t, side, purpose, false)
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        let next = |&joint: &u32| {
            self.joint_slots[joint as usize].drive.next_kink(t).filter(|&kink| t < kink)
        };
        self.joints.iter().filter_map(next).min_by(f64::total_cmp)
    }

    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        let longest = |&joint: &u32| {
            self.joint_slots[joint as usize].drive.longest_step(t, widths).unwrap_or(unknown)
        };
        self.joints.iter().map(longest).fold(f64::INFINITY, shorter)
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
        let mut a = self.system.accelerations_prepared(prepared, scalar_time(t), q, v, &inputs);
        let push = self.limits.push(q);
        for i in 0..N {
            a[i] += push[i] - self.limits.damping * v[i];
        }
        a
    }
}

impl<T: Lane + Float> Scene<T> {
    /// Hides a pendulum: it is not computed until [`show`](Self::show) is called.
    ///
    /// # Errors
    /// Returns an error if the pendulum belongs to another scene.
    pub fn hide<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
    ) -> Result<(), SceneError> {
        let tick = self.tick();
        let group = self.checked(pendulum)?;
        let status = &mut group.status[pendulum.index() as usize];
        if matches!(status, SceneStatus::Awake | SceneStatus::Asleep(_)) {
            *status = SceneStatus::Hidden(tick);
            group.set_awake(pendulum.index(), false);
            }
        Ok(())
    }

    /// Shows a hidden pendulum again. A pendulum that is not hidden stays unchanged.
    ///
    /// [`Resume::CatchUp`] integrates the whole time by [`Dop853`] with a relative tolerance of
    /// 10⁻⁶, including kinks, damping and soft stops. Hard stops hold only at the end.
    ///
    /// # Errors
    /// Returns an error if the pendulum belongs to another scene, if `longest` is not positive, if
    /// the pendulum has no state of rest, or if the integration fails. The pendulum stays hidden
    /// after an error.
    pub fn show<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
        how: Resume,
    ) -> Result<(), SceneError> {
        let id = pendulum.index();
        let SceneStatus::Hidden(since) = self.checked(pendulum)?.status[id as usize] else {
            return Ok(());
        };
        let (group, clock, joint_slots) = self.parts_of(pendulum)?;
        let mut detached = group.read(id);
        let zero = [T::from_f64(0.0); N];
        let mut put = |q, v| detached.state = [q, zero, v, zero, q, v];
        let restless = SceneError::Restless { kind: S::FACTS.name, index: id };
        match how {
            Resume::Unchanged => {}
            Resume::Rest => put(
                group
                    .rest_of(joint_slots, &group.read(id), clock.time(clock.tick()))
                    .ok_or(restless)?,
                zero,
            ),
            Resume::CatchUp { longest } => {
                if longest <= 0.0 || longest.is_nan() {
                    return Err(SceneError::Setting {
                        name: "longest",
                        value: longest,
                        required: "positive",
                    });
                }
                let now = clock.time(clock.tick());
                let (mut start, mut from) = (clock.time(since), group.read(id));
                if longest < now - start {
                    start = now - longest;
                    let q = group.rest_of(joint_slots, &from, start).ok_or(restless)?;
                    (from.state[0], from.state[2]) = (q, zero);
                }
                let system = group.system_of(&from.parameters);
                let [q, _, v, ..] = from.state;
                let hanging =
                    Hanging { system, joint_slots, joints: from.joints, limits: from.limits };
                if start < now {
                    let solution = solve(&hanging, (start, now), q, v)
                        .method(Dop853)
                        .rtol(1e-6)
                        .atol(1e-6)
                        .run();
                    let end =
                        solution.map_err(|failure| SceneError::Integration(failure.error))?.end;
                    let (mut q, mut v) = (end.q, end.v);
                    from.limits.hold(&mut q, &mut v);
                    put(q, v);
                }
            }
        }
        group.write(&detached);
        self.wake(pendulum)
    }
}
