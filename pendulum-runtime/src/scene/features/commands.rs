//! Commands to a scene: resets, teleports, mirrors, damping, stops, parameters that change while
//! the scene runs.

use crate::motion::Motion;
use crate::scalar::{Float, Lane};
use crate::scene::error::SceneError;
use crate::scene::group::change::Preserve;
use crate::scene::group::constraints::OnJoints;
use crate::scene::handle::Handle;
use crate::scene::lanes::limits::Limits;
use crate::scene::lanes::system::SceneSystem;
use crate::scene::sampling::joint::{Joint, JointSlot, erase};
use crate::scene::scene::Scene;

/// Kind of the limits of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Stop {
    /// A wall: what flies at it comes back with this part of its velocity, in [0, 1].
    Hard {
        /// The part of the velocity that is left.
        restitution: f64,
    },
    /// A spring beyond the limit: an acceleration of so much per unit, in 1/s².
    Soft {
        /// The square of its angular frequency.
        stiffness: f64,
    },
}

impl<T: Lane + Float> Scene<T> {
    /// Lets a pendulum hang at rest where an overdamped one would creep to, within its limits, with
    /// its joints at rest where they are now. One that has failed swings again.
    ///
    /// # Errors
    /// A pendulum of another scene, or one that comes to rest nowhere.
    pub fn reset_to_rest<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
    ) -> Result<(), SceneError> {
        self.dirty = true;
        let (group, clock, joint_slots) = self.parts_of(pendulum)?;
        group.rest(clock, joint_slots, pendulum.index())
    }

    /// Lets all pendulums hang at rest.
    ///
    /// # Errors
    /// A pendulum that comes to rest nowhere.
    pub fn reset_all_to_rest(&mut self) -> Result<(), SceneError> {
        let snapshot = self.snapshot();
        self.dirty = true;
        let Self { clock, joint_slots, groups, .. } = self;
        let reset = groups.iter_mut().try_for_each(|(_, group)| group.reset(clock, joint_slots));
        reset.or_else(|error| self.restore(&snapshot).and(Err(error)))
    }

    /// Mirrors a pendulum: coordinate i and its velocity are multiplied by `signs[i]`, as the
    /// angles are when a drawing is flipped.
    ///
    /// # Errors
    /// A pendulum of another scene, a sign that is neither 1 nor −1, a mirror image that does not
    /// fulfil the constraints.
    pub fn mirror<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
        signs: [f64; N],
    ) -> Result<(), SceneError> {
        if let Some(&value) = signs.iter().find(|sign| sign.abs() != 1.0) {
            return Err(SceneError::Setting { name: "signs", value, required: "1 or -1" });
        }
        self.checked(pendulum)?;
        let (system, (q, v)) = (self.system(pendulum), self.state(pendulum));
        let turned = |x: [T; N]| core::array::from_fn(|i| T::from_f64(signs[i]) * x[i]);
        let joints = self.known(pendulum).joints(pendulum.index());
        OnJoints { system: &system, joint_slots: &self.joint_slots, joints }.start(
            self.time(),
            turned(q),
            turned(v),
        )?;
        self.change(pendulum, |detached| {
            for (i, &sign) in signs.iter().enumerate() {
                for numbers in &mut detached.state {
                    numbers[i] *= T::from_f64(sign);
                }
                if sign < 0.0 {
                    (detached.limits.low[i], detached.limits.high[i]) =
                        (-detached.limits.high[i], -detached.limits.low[i]);
                }
            }
        })
    }

    /// Gives a joint another motion from the last tick on.
    ///
    /// # Errors
    /// A joint of another scene, a motion that lacks what the equations of a pendulum on it need;
    /// with [`Preserve::Nothing`] a pendulum that comes to rest nowhere; one that cannot be brought
    /// onto its constraints or is too fast for the ticks.
    pub fn set_motion<M, const D: usize>(
        &mut self,
        joint: Joint<D>,
        motion: M,
        preserve: Preserve,
    ) -> Result<(), SceneError>
    where
        M: Motion<T, D> + Send + Sync + 'static,
    {
        let joint = joint.of(self.id)?;
        for (_, group) in &self.groups {
            group.accepts_motion(joint, M::HAS)?;
        }
        let held = self.groups.iter().any(|(_, group)| group.is_constrained());
        let snapshot = (held || preserve == Preserve::Nothing).then(|| self.snapshot());
        let before = self.joint_slots.clone();
        self.joint_slots[joint as usize] = JointSlot::new(erase::<T, M, D>(motion));
        self.dirty = true;
        let Self { clock, joint_slots, groups, .. } = self;
        if snapshot.is_none() {
            let accepted = groups
                .iter()
                .try_for_each(|(_, group)| group.accepts_steps(clock, joint_slots, joint));
            if accepted.is_err() {
                self.joint_slots = before;
                return accepted;
            }
        }
        let moved = groups
            .iter_mut()
            .try_for_each(|(_, group)| group.moved(clock, &before, joint_slots, joint, preserve));
        if let (Err(_), Some(snapshot)) = (&moved, snapshot) {
            self.joint_slots = before;
            self.restore(&snapshot)?;
        }
        moved
    }

    /// Stops the time of the scene or lets it go on: frames pass, ticks do not, so that nothing
    /// jumps afterwards.
    pub fn set_paused(&mut self, paused: bool) {
        self.paused = paused;
    }

    /// Sets the damping of a pendulum: γ in 1/s, so that free velocities decay as e^(−γt) exactly,
    /// whatever the step.
    ///
    /// # Errors
    /// A pendulum of another scene, a damping that is negative or not finite.
    pub fn set_damping<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
        damping: f64,
    ) -> Result<(), SceneError> {
        if !(0.0..f64::INFINITY).contains(&damping) {
            return Err(SceneError::Setting {
                name: "damping",
                value: damping,
                required: "zero or positive",
            });
        }
        self.change(pendulum, |detached| detached.limits.damping = T::from_f64(damping))
    }

    /// Keeps coordinates within `low` and `high`, in place of the limits set before; infinite
    /// limits are none.
    ///
    /// A coordinate beyond a hard limit is put on it. Hard stops act within the drifts of leapfrog
    /// and SRKN6b, where the path is straight, and at the ends of the steps of RK4; they turn the
    /// velocity of the coordinate alone, which for coupled coordinates is not what a wall at the
    /// tip would do. Systems with constraints have none: this does not compile for them.
    ///
    /// # Errors
    /// A pendulum of another scene, limits in the wrong order or that leave no finite place, a
    /// restitution outside of [0, 1], a negative stiffness or one that is too fast for the ticks.
    pub fn set_limits<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
        low: [T; N],
        high: [T; N],
        stop: Stop,
    ) -> Result<(), SceneError> {
        const {
            assert!(
                S::FACTS.constraints.is_empty(),
                "stops act on single coordinates, which constraints tie together: write springs into the potential"
            );
        };
        for i in 0..N {
            let ordered = low[i] <= high[i];
            if !ordered || low[i].to_f64() == f64::INFINITY {
                return Err(SceneError::Setting {
                    name: "low",
                    value: low[i].to_f64(),
                    required: "at most the upper limit",
                });
            }
            if high[i].to_f64() == f64::NEG_INFINITY {
                return Err(SceneError::Setting {
                    name: "high",
                    value: high[i].to_f64(),
                    required: "greater than minus infinity",
                });
            }
        }
        let [restitution, stiffness, hard] = match stop {
            Stop::Hard { restitution: e } if (0.0..=1.0).contains(&e) => [e, 0.0, 1.0],
            Stop::Hard { restitution: value } => {
                return Err(SceneError::Setting {
                    name: "restitution",
                    value,
                    required: "between 0 and 1",
                });
            }
            Stop::Soft { stiffness: k } if (0.0..f64::INFINITY).contains(&k) => [1.0, k, 0.0],
            Stop::Soft { stiffness: value } => {
                return Err(SceneError::Setting {
                    name: "stiffness",
                    value,
                    required: "zero or positive",
                });
            }
        }
        .map(T::from_f64);
        let (group, clock, joint_slots) = self.parts_of(pendulum)?;
        let mut detached = group.read(pendulum.index());
        detached.limits = Limits { low, high, restitution, stiffness, hard, ..detached.limits };
        detached.hold();
        group.rewrite(clock, joint_slots, &detached)?;
        group.forget_criterion(pendulum.index());
        group.wake(pendulum.index());
        self.dirty = true;
        Ok(())
    }

    /// Sets a parameter of a pendulum by its name, as in `FACTS.parameters`; the state stays, or
    /// goes to the nearest that fulfils the constraints, its steps are chosen anew and it wakes.
    ///
    /// # Errors
    /// A pendulum of another scene, a name that it does not have; a value that is not finite, makes
    /// a mass negative or the pendulum too fast for its ticks, or with which its constraints cannot
    /// be fulfilled.
    pub fn set_parameter<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
        name: &str,
        value: T,
    ) -> Result<(), SceneError> {
        finite(name, value)?;
        let index = S::FACTS.parameters.iter().position(|parameter| *parameter == name);
        let (group, clock, joint_slots) = self.parts_of(pendulum)?;
        let index = index.ok_or_else(|| SceneError::Parameter {
            name: name.to_owned(),
            parameters: S::FACTS.parameters.to_vec(),
        })?;
        let mut detached = group.read(pendulum.index());
        detached.parameters[index] = value;
        group.constrain(clock, joint_slots, &mut detached)?;
        group.rewrite(clock, joint_slots, &detached)?;
        group.wake(pendulum.index());
        group.forget_criterion(pendulum.index());
        self.dirty = true;
        Ok(())
    }

    /// Sets a parameter of all pendulums that have one of that name, such as gravity or wind;
    /// states stay, steps are chosen anew (a fraction of a microsecond each) and sleepers wake.
    /// Gives the number of pendulums.
    ///
    /// # Errors
    /// A name that no type here has; a value that is not finite, makes a mass negative or a
    /// pendulum too fast for its ticks, or with which the constraints of one cannot be fulfilled.
    pub fn set_parameter_everywhere(&mut self, name: &str, value: T) -> Result<usize, SceneError> {
        finite(name, value)?;
        self.dirty = true;
        let Self { clock, joint_slots, groups, .. } = self;
        for (_, group) in &*groups {
            group.accepts_parameter(clock, joint_slots, name, value)?;
        }
        let changed: Vec<usize> = groups
            .iter_mut()
            .filter_map(|(_, group)| group.set_parameter(clock, joint_slots, name, value))
            .collect();
        if changed.is_empty() {
            let mut parameters: Vec<_> =
                groups.iter().flat_map(|(_, group)| group.parameters()).copied().collect();
            parameters.sort_unstable();
            parameters.dedup();
            Err(SceneError::Parameter { name: name.to_owned(), parameters })
        } else {
            Ok(changed.iter().sum())
        }
    }
}

fn finite<T: Float>(name: &str, value: T) -> Result<(), SceneError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(SceneError::ParameterValue { name: name.to_owned(), value: value.to_f64() })
}
