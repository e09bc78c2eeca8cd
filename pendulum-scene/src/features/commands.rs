//! Commands to a scene: resets, teleports, mirrors, damping, stops, changes of parameters.

use crate::error::SceneError;
use crate::group::change::{Change, Preserve};
use crate::handle::Handle;
use crate::lanes::limits::Limits;
use crate::sampling::joint::{Joint, erase};
use crate::sampling::live::check_position;
use crate::scene::Scene;
use crate::system::{Layouts, ORDERS, SceneSystem};
use core::iter;
use pendulum_core::motion::Motion;
use pendulum_core::scalar::Float;
use pendulum_core::system::{ControlValues, MOST_CONTROLS};

/// The kind of the limits of coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Stop {
    /// A wall: at the limit the velocity of a coordinate is reversed and multiplied by the
    /// restitution.
    Hard {
        /// The fraction of the velocity after the impact, in [0, 1].
        restitution: f64,
    },
    /// A spring beyond the limit.
    Soft {
        /// The acceleration per unit of distance beyond the limit, in 1/s²: the square of the
        /// angular frequency of the spring.
        stiffness: f64,
    },
}

impl<T: Float> Scene<T> {
    /// Sets a pendulum to its state of rest: the state that an overdamped pendulum approaches
    /// within its limits, with its joints fixed at their current positions. A pendulum that has
    /// failed is computed again.
    ///
    /// # Errors
    /// Returns an error if the pendulum belongs to another scene or has no state of rest.
    pub fn reset_to_rest<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
    ) -> Result<(), SceneError> {
        let (group, world) = self.parts_of(pendulum)?;
        group.plan_for(world, &Change::Rest, iter::once(pendulum.index()))?;
        group.commit(world, &Change::Rest);
        let place = group.place_of(pendulum.index());
        self.carry_from(place);
        Ok(())
    }

    /// Sets all pendulums to their states of rest.
    ///
    /// # Errors
    /// Returns an error if a pendulum has no state of rest.
    pub fn reset_all_to_rest(&mut self) -> Result<(), SceneError> {
        if self.world.carriers.is_empty() {
            return self.change_all(&Change::Rest).map(drop);
        }
        // Each turn brings a level to rest whose joints rest already.
        let before = self.snapshot();
        for _ in 0..=self.world.top() {
            if let Err(error) = self.change_all(&Change::Rest) {
                self.restore(&before)?;
                return Err(error);
            }
        }
        Ok(())
    }

    /// Mirrors a pendulum: coordinate i and its velocity are multiplied by `signs[i]`. When a
    /// drawing is flipped, angles change their signs.
    ///
    /// # Errors
    /// Returns an error if the pendulum belongs to another scene, if a sign is neither 1 nor −1, or
    /// if the mirror image violates constraints or limits.
    pub fn mirror<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
        signs: [f64; N],
    ) -> Result<(), SceneError> {
        if let Some(&value) = signs.iter().find(|sign| sign.abs() != 1.0) {
            return Err(SceneError::Setting { name: "signs", value, required: "1 or -1" });
        }
        let (group, world) = self.parts_of(pendulum)?;
        let detached = group.read(pendulum.index());
        let [q, _, v, ..] = detached.state;
        let turned = |x: [T; N]| core::array::from_fn(|i| T::from_f64(signs[i]) * x[i]);
        let (_, standing) = group.hung(world, &detached).begin(turned(q), turned(v))?;
        self.change(pendulum, |detached| {
            detached.standing = standing;
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

    /// Replaces the motion of a joint from the last tick on.
    ///
    /// # Errors
    /// Returns an error if the joint belongs to another scene or a pendulum carries it, if the
    /// motion lacks a derivative that a pendulum on the joint or the joints that it carries need,
    /// or if a pendulum cannot be brought onto its constraints, is too fast or, with
    /// [`Preserve::Nothing`], has no state of rest.
    pub fn set_motion<M, const D: usize>(
        &mut self,
        joint: Joint<D>,
        motion: M,
        preserve: Preserve,
    ) -> Result<(), SceneError>
    where
        M: Motion<T, D> + Send + Sync + 'static,
    {
        let joint = joint.of(self.living())?;
        if self.world.carried[joint as usize].is_some() {
            return Err(SceneError::Carried(joint));
        }
        let missing = ORDERS.iter().position(|order| !M::HAS.contains(*order));
        if let Some(derivative) = missing
            && self.carries_carrier(joint)
        {
            let input = "a pendulum that carries joints";
            return Err(SceneError::Derivative { input, derivative });
        }
        let next = erase(motion, self.world.clock.rate());
        let before = core::mem::replace(&mut self.world.joints[joint as usize], next);
        let changed = self.change_on(joint, &Change::Motion(joint, Some(&before), preserve));
        if changed.is_err() {
            self.world.joints[joint as usize] = before;
        }
        self.world.tracks.iter_mut().for_each(|tracks| tracks.forget(joint));
        changed
    }

    /// Tells a live joint where it is at the end of the coming frame, the time that the next call
    /// of [`advance`](Self::advance) or [`advance_ticks`](Self::advance_ticks) covers. [`Live`]
    /// defines its motion within the frame.
    ///
    /// The last call before a frame counts; frames shorter than a tick are joined to the next one.
    /// A joint that is not told comes to a stop within the frame. The call takes no more time than
    /// it takes to store the position.
    ///
    /// The first position after [`live`](Self::live), after frames during a pause and in a frame of
    /// which time is [dropped](crate::Advanced::dropped) may be a jump: if it is farther from where
    /// the velocity of the joint leads than the way of the frame at this velocity, the joint is
    /// moved as by [`teleport`](Self::teleport), and counted in
    /// [`Advanced::jumped`](crate::Advanced::jumped).
    ///
    /// # Errors
    /// Returns an error if the joint belongs to another scene or is not live, or if the position is
    /// infinite or NaN; the joint then keeps what it was told before.
    ///
    /// [`Live`]: crate::Live
    pub fn move_to<const D: usize>(
        &mut self,
        joint: Joint<D>,
        position: [f64; D],
    ) -> Result<(), SceneError> {
        let joint = joint.of(self.living())?;
        let live = self.world.live_mut(joint).ok_or(SceneError::NotLive(joint))?;
        check_position(joint, &position)?;
        live.check(&position)?;
        live.tell(&position);
        Ok(())
    }

    /// Moves a live joint to another position, which is not felt: the joint rests there, and
    /// pendulums keep their coordinates and velocities, as with [`Preserve::Swing`]. The joint
    /// forgets its earlier positions and what it was told.
    ///
    /// # Errors
    /// Returns an error if the joint belongs to another scene or is not live, if the position is
    /// infinite or NaN, or if a pendulum cannot be brought onto its constraints or is too fast.
    pub fn teleport<const D: usize>(
        &mut self,
        joint: Joint<D>,
        position: [f64; D],
    ) -> Result<(), SceneError> {
        let (joint, now) = (joint.of(self.living())?, self.world.clock.asked(0));
        let live = self.world.live_mut(joint).ok_or(SceneError::NotLive(joint))?;
        check_position(joint, &position)?;
        live.check(&position)?;
        let mut before = Vec::new();
        live.save(&mut before);
        live.place(now, &position);
        let changed = self.change_on(joint, &Change::Motion(joint, None, Preserve::Swing));
        if changed.is_err()
            && let Some(live) = self.world.live_mut(joint)
        {
            live.restore(&mut &before[..]);
        }
        changed
    }

    /// Pauses or resumes the scene. While the scene is paused, [`advance`](Self::advance) ignores
    /// frame times, so the motion does not jump when the scene resumes.
    pub fn set_paused(&mut self, paused: bool) {
        self.paused = paused;
    }

    /// Sets the damping γ of a pendulum in 1/s. Free velocities decay exactly as e^(−γt),
    /// independently of the step. With a `limit` in its block, the damping is a force as all others,
    /// and the pendulum does not stay in lanes: write a `dissipation` there.
    ///
    /// # Errors
    /// Returns an error if the pendulum belongs to another scene, or if the damping is negative,
    /// infinite or NaN.
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

    /// Limits coordinates to the range from `low` to `high`, in place of previous limits. Infinite
    /// limits have no effect.
    ///
    /// A coordinate beyond a hard limit is moved to the limit. Hard stops act within the drifts of
    /// leapfrog and SRKN6b, where the path is straight, and at the ends of the steps of RK4. They
    /// reverse only the velocity of the limited coordinate; with coupled coordinates, a wall at the
    /// tip would change all velocities, as a `limit` of a block does in
    /// [`solve`](pendulum_core::integrate::solve) and in scenes. Systems with constraints or with a
    /// `limit` have no stops: this method does not compile for them.
    ///
    /// # Errors
    /// Returns an error if the pendulum belongs to another scene, if `low[i]` ≤ `high[i]` does not
    /// hold, if the limits exclude all finite values, if the restitution is outside of [0, 1], or
    /// if the stiffness is negative or too large for the ticks.
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
            assert!(
                !Layouts::<S, N>::LIMITED,
                "a system with a `limit` in its block has no further stops: write them as limits too"
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
        let (group, world) = self.parts_of(pendulum)?;
        let mut detached = group.read(pendulum.index());
        detached.limits = Limits { low, high, restitution, stiffness, hard, ..detached.limits };
        detached.hold();
        let kind = group.kind(world, &detached)?;
        group.place(world, kind, &detached);
        group.forget_criterion(pendulum.index());
        group.wake(world, pendulum.index());
        let place = group.place_of(pendulum.index());
        self.carry_from(place);
        Ok(())
    }

    /// Sets a parameter of a pendulum by its name in `FACTS.parameters` and wakes the pendulum. The
    /// state is kept, or moved to the nearest state that fulfils the constraints. The steps are
    /// chosen again.
    ///
    /// # Errors
    /// Returns an error if the pendulum belongs to another scene, if it has no parameter of this
    /// name, or if the value is not finite, makes a mass negative, makes the pendulum too fast or
    /// makes its constraints unsatisfiable.
    pub fn set_parameter<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
        name: &str,
        value: T,
    ) -> Result<(), SceneError> {
        finite(name, value)?;
        let (group, world) = self.parts_of(pendulum)?;
        let change = Change::Parameter(name, value);
        if group.plan_for(world, &change, iter::once(pendulum.index()))? == 0 {
            return Err(SceneError::Parameter {
                name: name.to_owned(),
                parameters: S::FACTS.parameters.to_vec(),
            });
        }
        group.commit(world, &change);
        let place = group.place_of(pendulum.index());
        self.carry_from(place);
        Ok(())
    }

    /// Sets all control inputs of a pendulum, which keep their values until they are set again: a
    /// number or an array for one input, a tuple for several, in the units and in the order of their
    /// declarations. They are zero at first. The call takes no more time than it takes to store the
    /// values, unless it wakes the pendulum, which other values do.
    ///
    /// A feedback law reads the [state](Self::state) before each tick, or before each frame, and
    /// sets the inputs; between ticks nothing asks it. The steps stay those chosen for zero: where
    /// an input makes a pendulum faster, as the stiffness of a spring does, a parameter chooses them
    /// again.
    ///
    /// ```
    /// use pendulum_runtime::prelude::*;
    /// use pendulum_runtime::scene::Scene;
    ///
    /// lagrangian! {
    ///     pub struct Cart { m: kg, c: N*s/m }
    ///     coordinate s: m;
    ///     input u: N;
    ///     kinetic = m/2 * ṡ^2;
    ///     dissipation = c/2 * ṡ^2;
    ///     force s = u;
    /// }
    ///
    /// let mut scene = Scene::<f64>::new(240.0)?;
    /// let cart = scene.hang((), Cart::new(1.0, 2.0), [0.5], [0.0])?;
    /// for _ in 0..2400 {
    ///     let ([s], [v]) = scene.state(cart);
    ///     scene.set_inputs(cart, -4.0 * s - 2.0 * v)?;
    ///     scene.advance_ticks(1);
    /// }
    /// assert!(scene.state(cart).0[0].abs() < 1e-6);
    /// # Ok::<(), pendulum_runtime::scene::SceneError>(())
    /// ```
    ///
    /// Does not compile if the number of values differs from the number of components of the
    /// control inputs.
    ///
    /// # Errors
    /// Returns an error if the pendulum belongs to another scene, or if a value is infinite or NaN.
    // Passed by value as a controller returns it.
    #[allow(clippy::needless_pass_by_value)]
    pub fn set_inputs<S: SceneSystem<T, N>, U: ControlValues<T>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
        values: U,
    ) -> Result<(), SceneError> {
        const {
            assert!(
                U::COUNT == Layouts::<S, N>::CONTROLS,
                "the control inputs have another number of components than the values"
            );
        };
        let (group, world) = self.parts_of(pendulum)?;
        let mut numbers = [T::from_f64(0.0); MOST_CONTROLS];
        values.write(&mut numbers[..U::COUNT]);
        if let Some(index) = numbers.iter().position(|number| !number.is_finite()) {
            let (input, component) = Layouts::<S, N>::control(index);
            return Err(SceneError::Input { input, component, value: numbers[index].to_f64() });
        }
        group.set_controls(world, pendulum.index(), &numbers[..U::COUNT]);
        Ok(())
    }

    /// Sets a parameter, such as gravity or wind, of all pendulums that have a parameter of this
    /// name, and returns the number of these pendulums. States are kept or moved to the nearest
    /// states that fulfil the constraints, steps are chosen again (a fraction of a microsecond
    /// each), and sleeping pendulums wake.
    ///
    /// # Errors
    /// Returns an error if no pendulum has a parameter of this name, or if the value is not finite,
    /// makes a mass negative, makes a pendulum too fast or makes its constraints unsatisfiable.
    pub fn set_parameter_everywhere(&mut self, name: &str, value: T) -> Result<usize, SceneError> {
        finite(name, value)?;
        let changed = self.change_all(&Change::Parameter(name, value))?;
        if changed != 0 {
            return Ok(changed);
        }
        let mut parameters: Vec<_> =
            self.groups.iter().flat_map(|(_, group)| group.parameters()).copied().collect();
        parameters.sort_unstable();
        parameters.dedup();
        Err(SceneError::Parameter { name: name.to_owned(), parameters })
    }

    /// Returns `true` if a pendulum on a joint carries joints itself.
    fn carries_carrier(&self, joint: u32) -> bool {
        let place = |&(group, id): &(u32, u32)| self.groups[group as usize].1.place_of(id);
        let mut places = self.world.carries[joint as usize].iter().map(place);
        places.any(|place| self.world.carriers.contains_key(&place))
    }

    /// Changes the pendulums on a joint.
    fn change_on(&mut self, joint: u32, change: &Change<'_, T>) -> Result<(), SceneError> {
        let Self { world, groups, .. } = self;
        let mut carried = world.carries[joint as usize].clone();
        carried.sort_unstable();
        carried.dedup();
        for part in carried.chunk_by(|one, other| one.0 == other.0) {
            let ids: Vec<u32> = part.iter().map(|(_, id)| *id).collect();
            groups[part[0].0 as usize].1.plan(world, change, Some(&ids))?;
        }
        for part in carried.chunk_by(|one, other| one.0 == other.0) {
            groups[part[0].0 as usize].1.commit(world, change);
        }
        for (group, id) in carried {
            self.carry_from(self.groups[group as usize].1.place_of(id));
        }
        Ok(())
    }

    /// Changes all pendulums, and returns the number of those that the change concerns.
    fn change_all(&mut self, change: &Change<'_, T>) -> Result<usize, SceneError> {
        let Self { world, groups, .. } = self;
        let mut count = 0;
        for (_, group) in groups.iter_mut() {
            count += group.plan(world, change, None)?;
        }
        for (_, group) in groups {
            group.commit(world, change);
        }
        self.carry_all(true);
        Ok(count)
    }
}

fn finite<T: Float>(name: &str, value: T) -> Result<(), SceneError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(SceneError::ParameterValue { name: name.to_owned(), value: value.to_f64() })
}
