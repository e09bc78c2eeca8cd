//! States of pendulums: reading, interpolation, changes.

use crate::error::SceneError;
use crate::group::hung::check_state;
use crate::group::members::{Group, SceneStatus};
use crate::handle::Handle;
use crate::lanes::bucket::Detached;
use crate::sampling::joint::Joint;
use crate::sampling::world::World;
use crate::scene::Scene;
use crate::system::SceneSystem;
use pendulum_core::motion::{Derivatives, Side};
use pendulum_core::scalar::{Float, Real};
use pendulum_core::system::{At, Dynamics, Purpose, System, scalar_time};
use pendulum_core::time::Time;

impl<T: Float> Scene<T> {
    /// Returns the coordinates and velocities of a pendulum at the last tick.
    ///
    /// # Panics
    /// Panics if the pendulum is not in this scene.
    pub fn state<S: SceneSystem<T, N>, const N: usize>(
        &self,
        pendulum: Handle<S, N>,
    ) -> ([T; N], [T; N]) {
        self.known(pendulum).states(pendulum.index())[1]
    }

    /// Returns the coordinates at the fraction `alpha` of the way from the second-to-last tick to
    /// the last tick, by the cubic through the coordinates and velocities at both ticks (Hermite).
    ///
    /// With [`alpha`](Self::alpha) the result is the pose for the current frame, delayed by one
    /// tick. The error of the interpolation is h⁴/384·|q⁗|.
    ///
    /// # Panics
    /// Panics if the pendulum is not in this scene.
    pub fn pose<S: SceneSystem<T, N>, const N: usize>(
        &self,
        pendulum: Handle<S, N>,
        alpha: f64,
    ) -> [T; N] {
        let states = self.known(pendulum).states(pendulum.index());
        hermite(self.world.clock.step(), alpha, &states)
    }

    /// Returns everything that the outputs of a pendulum depend on, at the time of
    /// [`pose`](Self::pose).
    ///
    /// The velocities are the derivative of the cubic.
    ///
    /// ```
    /// # #![allow(mixed_script_confusables)]
    /// # use pendulum_runtime::{motion::Still, prelude::*, scene::Scene};
    /// lagrangian! {
    ///     pub struct Lamp { m: kg, L: m, g: m/s^2 = 9.81 }
    ///     coordinate θ: rad;
    ///     driven x: [m; 2];
    ///     let y = x + L * [sin(θ), -cos(θ)];
    ///     kinetic = m/2 * |ẏ|^2;
    ///     potential = m*g*height(y);
    ///     output bulb: [m; 2] = y;
    /// }
    ///
    /// let mut scene = Scene::<f64>::new(240.0)?;
    /// let hook = scene.joint(Still::new([1.0, 3.0]));
    /// let lamp = scene.hang(hook, Lamp::new(1.0, 2.0), [0.0], [0.0])?;
    /// scene.advance(0.5)?;
    /// let seen = scene.observe(lamp, scene.alpha());
    /// assert_eq!(seen.system.bulb(seen.t, &seen.q, &seen.v, &seen.inputs), [1.0, 1.0]);
    /// # Ok::<(), pendulum_runtime::scene::SceneError>(())
    /// ```
    ///
    /// # Panics
    /// Panics if the pendulum is not in this scene.
    pub fn observe<S: SceneSystem<T, N>, const N: usize>(
        &self,
        pendulum: Handle<S, N>,
        alpha: f64,
    ) -> Observation<S, N> {
        let group = self.known(pendulum);
        let (h, states) = (self.world.clock.step(), group.states(pendulum.index()));
        let t = self.world.clock.within(self.world.clock.tick() - 1, alpha);
        let detached = group.read(pendulum.index());
        let hung = group.hung(&self.world, &detached);
        let inputs = hung.inputs(t, Side::After, Purpose::Outputs);
        Observation {
            system: hung.system,
            t: scalar_time(t),
            q: hermite(h, alpha, &states),
            v: hermite_rate(h, alpha, &states),
            inputs,
        }
    }

    /// Writes the poses of all pendulums of a type to `poses`, in the order of hanging. The memory
    /// of `poses` is reused.
    pub fn poses<S: SceneSystem<T, N>, const N: usize>(&self, alpha: f64, poses: &mut Vec<[T; N]>) {
        poses.clear();
        if let Some(group) = self.group::<S, N>() {
            let h = self.world.clock.step();
            poses.extend(group.ids().map(|id| hermite(h, alpha, &group.states(id))));
        }
    }

    /// Returns the position of a joint at the time of [`pose`](Self::pose).
    ///
    /// # Panics
    /// Panics if the joint is not in this scene.
    pub fn joint_pose<const D: usize>(&self, joint: Joint<D>, alpha: f64) -> [T; D] {
        let mut position = [T::from_f64(0.0); D];
        let t = self.world.clock.within(self.world.clock.tick() - 1, alpha);
        let index = joint.of(self.living()).unwrap_or_else(|error| panic!("{error}"));
        let drive = &self.world.joints[index as usize].drive;
        drive.sample(t, Side::After, Derivatives::POSITION, &mut position);
        position
    }

    /// Sets the state of a pendulum and wakes it. Coordinates beyond a hard limit are moved to the
    /// limit and lose their outward velocity.
    ///
    /// # Errors
    /// Returns an error if the state is not finite or violates constraints or limits, or if the
    /// pendulum belongs to another scene.
    pub fn set_state<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
        q: [T; N],
        v: [T; N],
    ) -> Result<(), SceneError> {
        check_state(&S::FACTS, &q)?;
        check_state(&S::FACTS, &v)?;
        let (group, world) = self.parts_of(pendulum)?;
        let detached = group.read(pendulum.index());
        let begun = group.hung(world, &detached).begin(q, v)?;
        self.change(pendulum, |detached| {
            (detached.state, detached.standing) = begun;
            detached.hold();
            (detached.state[4], detached.state[5]) = (detached.state[0], detached.state[2]);
        })?;
        self.wake(pendulum)
    }

    /// Returns the Jacobi integral of a pendulum at the last tick.
    ///
    /// # Panics
    /// Panics if the pendulum is not in this scene.
    pub fn energy<S: SceneSystem<T, N>, const N: usize>(&self, pendulum: Handle<S, N>) -> T {
        let group = self.known(pendulum);
        let detached = group.read(pendulum.index());
        let (hung, t) = (group.hung(&self.world, &detached), Time::new(self.time()));
        let inputs = hung.inputs(t, Side::After, Purpose::Energy);
        let [q, _, v, ..] = &detached.state;
        hung.system.energy(At { t: scalar_time(t), q, v, inputs: &inputs })
    }

    /// Returns the system of a pendulum with its current parameters.
    ///
    /// # Panics
    /// Panics if the pendulum is not in this scene.
    pub fn system<S: SceneSystem<T, N>, const N: usize>(&self, pendulum: Handle<S, N>) -> S {
        let group = self.known(pendulum);
        group.system_of(&group.read(pendulum.index()).parameters)
    }

    /// Returns the status of a pendulum.
    ///
    /// # Panics
    /// Panics if the pendulum is not in this scene.
    pub fn status<S: SceneSystem<T, N>, const N: usize>(
        &self,
        pendulum: Handle<S, N>,
    ) -> SceneStatus {
        self.known(pendulum).status[pendulum.index() as usize]
    }

    /// Wakes a pendulum in its current state, also if it is hidden or has failed.
    ///
    /// # Errors
    /// Returns an error if the pendulum belongs to another scene.
    pub fn wake<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
    ) -> Result<(), SceneError> {
        let (group, world) = self.parts_of(pendulum)?;
        group.status[pendulum.index() as usize] = SceneStatus::Awake;
        group.set_awake(world, pendulum.index(), true);
        Ok(())
    }

    /// Returns the group of a pendulum; panics if the pendulum is not in this scene.
    pub(crate) fn known<S: SceneSystem<T, N>, const N: usize>(
        &self,
        pendulum: Handle<S, N>,
    ) -> &Group<S, T, N> {
        let group = if pendulum.scene() == self.id { self.group::<S, N>() } else { None };
        let own = |group: &&Group<S, T, N>| {
            group.generation(pendulum.index()) == Some(pendulum.generation())
        };
        group.filter(own).unwrap_or_else(|| panic!("{}", unknown(pendulum)))
    }

    /// Returns the group of a pendulum, with the clock and the joints of the scene.
    pub(crate) fn parts_of<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
    ) -> Result<(&mut Group<S, T, N>, &mut World<T>), SceneError> {
        if pendulum.scene() != self.id {
            return Err(unknown(pendulum));
        }
        let found = self.group_mut::<S, N>();
        let own = found
            .filter(|(group, _)| group.generation(pendulum.index()) == Some(pendulum.generation()));
        own.ok_or_else(|| unknown(pendulum))
    }

    /// Changes properties of a pendulum that do not influence its steps, and wakes it if it sleeps.
    pub(crate) fn change<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
        change: impl FnOnce(&mut Detached<T, N>),
    ) -> Result<(), SceneError> {
        let (group, world) = self.parts_of(pendulum)?;
        let mut detached = group.read(pendulum.index());
        change(&mut detached);
        group.write(world, &detached);
        group.forget_criterion(pendulum.index());
        group.wake(world, pendulum.index());
        let place = group.place_of(pendulum.index());
        self.carry_from(place);
        Ok(())
    }
}

fn unknown<S: SceneSystem<T, N>, T: Float, const N: usize>(pendulum: Handle<S, N>) -> SceneError {
    SceneError::Pendulum { kind: S::FACTS.name, index: pendulum.index() }
}

/// The state of a pendulum at one time, with everything that its outputs depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Observation<S: System<N>, const N: usize> {
    /// The system with its parameters.
    pub system: S,
    /// The time in seconds.
    pub t: S::Scalar,
    /// The coordinates.
    pub q: [S::Scalar; N],
    /// The velocities.
    pub v: [S::Scalar; N],
    /// The samples of the driven inputs.
    pub inputs: S::Inputs,
}

/// Evaluates the cubic through the coordinates and velocities at both ends of a step `h`, at the
/// fraction `alpha`.
pub(crate) fn hermite<T: Real, const N: usize>(
    h: f64,
    alpha: f64,
    [(q0, v0), (q1, v1)]: &[([T; N], [T; N]); 2],
) -> [T; N] {
    if alpha == 1.0 {
        return *q1;
    }
    let (a, h) = (T::from_f64(alpha), T::from_f64(h));
    core::array::from_fn(|i| {
        let (d, m0, m1) = (q1[i] - q0[i], h * v0[i], h * v1[i]);
        let three_d = d + d + d;
        q0[i] + a * (m0 + a * ((three_d - m0 - m0 - m1) + a * (m0 + m1 - d - d)))
    })
}

/// Evaluates the time derivative of the cubic of [`hermite`].
fn hermite_rate<T: Real, const N: usize>(
    h: f64,
    alpha: f64,
    [(q0, v0), (q1, v1)]: &[([T; N], [T; N]); 2],
) -> [T; N] {
    if alpha == 1.0 {
        return *v1;
    }
    let (a, over) = (T::from_f64(alpha), T::from_f64(1.0 / h));
    core::array::from_fn(|i| {
        let slope = over * (q1[i] - q0[i]);
        let three = slope + slope + slope - v0[i] - v0[i] - v1[i];
        let cubic = v0[i] + v1[i] - slope - slope;
        v0[i] + a * (three + three + a * (cubic + cubic + cubic))
    })
}
