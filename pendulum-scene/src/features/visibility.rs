//! Hidden pendulums, and the setting of sleep: pendulums that are not computed.

use crate::error::SceneError;
use crate::group::members::SceneStatus;
use crate::handle::Handle;
use crate::scene::Scene;
use crate::system::SceneSystem;
use pendulum_core::integrate::{Dop853, solve};
use pendulum_core::scalar::Float;

/// The state in which a hidden pendulum returns.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Resume {
    /// The pendulum continues from the state in which it was hidden.
    Unchanged,
    /// The pendulum hangs at rest.
    Rest,
    /// The motion over the hidden time is integrated in a few large accurate steps. Live joints
    /// count as at rest before the last two frames, and joints that pendulums carry before the last
    /// tick, because earlier positions are forgotten. If the hidden time is longer than `longest`,
    /// the integration begins with the state of rest at `longest` before now.
    CatchUp {
        /// The longest time that is integrated, in seconds.
        longest: f64,
    },
}

impl<T: Float> Scene<T> {
    /// Hides a pendulum: it is not computed until [`show`](Self::show) is called.
    ///
    /// # Errors
    /// Returns an error if the pendulum belongs to another scene.
    pub fn hide<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
    ) -> Result<(), SceneError> {
        let tick = self.tick();
        let (group, world) = self.parts_of(pendulum)?;
        let status = &mut group.status[pendulum.index() as usize];
        if matches!(status, SceneStatus::Awake | SceneStatus::Asleep(_)) {
            *status = SceneStatus::Hidden(tick);
            group.set_awake(world, pendulum.index(), false);
        }
        Ok(())
    }

    /// Shows a hidden pendulum again. A pendulum that is not hidden stays unchanged.
    ///
    /// [`Resume::CatchUp`] integrates the whole time by [`Dop853`] with a relative tolerance of
    /// 10⁻⁶, or of 2·10⁻⁶ over `f32`, including kinks, damping and soft stops. Hard stops hold only
    /// at the end.
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
        let (group, world) = self.parts_of(pendulum)?;
        let SceneStatus::Hidden(since) = group.status[id as usize] else { return Ok(()) };
        let (mut detached, now) = (group.read(id), world.now());
        let zero = [T::from_f64(0.0); N];
        match how {
            Resume::Unchanged => {}
            Resume::Rest => {
                let q = group.hung(world, &detached).rest(now)?;
                detached.set_state(q, zero);
                group.settle(world, &mut detached)?;
            }
            Resume::CatchUp { longest } => {
                if longest <= 0.0 || longest.is_nan() {
                    return Err(SceneError::Setting {
                        name: "longest",
                        value: longest,
                        required: "positive",
                    });
                }
                let hung = group.hung(world, &detached);
                let (mut start, [mut q, _, mut v, ..]) = (world.clock.time(since), detached.state);
                if longest < now - start {
                    start = now - longest;
                    (q, v) = (hung.rest(start)?, zero);
                }
                if start < now {
                    // Integrations refuse tolerances below ten roundings of the scalar.
                    let rtol = f64::max(1e-6, 16.0 * T::EPSILON.to_f64());
                    let solution =
                        solve(&hung, (start, now), q, v).method(Dop853).rtol(rtol).atol(1e-6);
                    let end =
                        solution.run().map_err(|failed| SceneError::Integration(failed.error))?.end;
                    (q, v) = (end.q, end.v);
                    detached.limits.hold(&mut q, &mut v);
                    detached.set_state(q, v);
                    group.settle(world, &mut detached)?;
                }
            }
        }
        group.write(world, &detached);
        let place = group.place_of(id);
        self.wake(pendulum)?;
        self.carry_from(place);
        Ok(())
    }

    /// Lets pendulums that hardly move fall asleep while their joints rest: a pendulum falls asleep
    /// if its energy does not suffice to move a coordinate by more than `tolerance` from the state
    /// of rest. A suitable tolerance moves the tip by half a pixel. With `None`, the initial value,
    /// pendulums do not sleep.
    ///
    /// A sleeping pendulum keeps its coordinates and is not computed. It wakes in the tick in which
    /// its joints move again, as given by
    /// [`rest_until`](pendulum_core::motion::Motion::rest_until), when one of its properties is
    /// changed, and by [`wake`](Self::wake). A pendulum never sleeps if it has no state of rest, if
    /// that state is not a minimum of its energy, if its equations depend explicitly on time, or if
    /// it has constraints on velocities. Constraints on positions, such as those of rotations,
    /// count as springs that are ten thousand times as stiff as the pendulum.
    ///
    /// # Errors
    /// Returns an error if the tolerance is not positive and finite.
    pub fn set_sleep(&mut self, tolerance: Option<f64>) -> Result<(), SceneError> {
        if let Some(value) = tolerance
            && !(0.0 < value && value < f64::INFINITY)
        {
            return Err(SceneError::Setting { name: "sleep", value, required: "positive" });
        }
        self.sleep = tolerance;
        for (_, group) in &mut self.groups {
            group.forget_criteria();
        }
        if tolerance.is_none() {
            self.wake_all();
        }
        Ok(())
    }

    /// Wakes all sleeping pendulums.
    pub(crate) fn wake_all(&mut self) {
        for (_, group) in &mut self.groups {
            group.wake_all(&mut self.world);
        }
    }
}
