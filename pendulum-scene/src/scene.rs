//! Joints, pendulums and settings of a scene.

use crate::contact::Limits;
use crate::error::{SceneError, SceneFault};
use crate::group::any::AnyGroup;
use crate::group::change::Change;
use crate::group::hung::{Hung, check_state};
use crate::group::members::Group;
use crate::handle::{Bundle, Handle, SceneId};
use crate::lanes::bucket::Detached;
use crate::sampling::clock::Clock;
use crate::sampling::joint::{Anchored, Joint, Living, erase};
use crate::sampling::live::{Course, Live, Path, check_position};
use crate::sampling::scheme::{Fixed, Scheme};
use crate::sampling::turn::Turn;
use crate::sampling::world::World;
use crate::system::{Layouts, SceneSystem};
use crate::threads::Threads;
use core::any::{Any, TypeId};
use core::fmt;
use pendulum_core::attitude::Attitude;
use pendulum_core::motion::Motion;
use pendulum_core::scalar::Float;
use pendulum_core::system::tables;

/// The groups of a scene.
pub(super) type Groups<T> = Vec<(TypeId, Box<dyn AnyGroup<T>>)>;

/// A set of joints with motions, and pendulums of any type that hang on them, over `f32` or `f64`.
pub struct Scene<T> {
    pub(super) id: SceneId,
    pub(super) world: World<T>,
    pub(super) groups: Groups<T>,
    pub(super) tolerance: f64,
    pub(super) longest_frame: f64,
    pub(super) parallel: bool,
    pub(super) threads: Threads,
    pub(super) paused: bool,
    pub(super) sleep: Option<f64>,
    pub(super) faults: Vec<SceneFault>,
    /// What has been added since a bundle was begun.
    pub(super) bundle: Option<Bundle>,
    /// The live joints that do not continue their motion in a frame; empty between frames.
    pub(super) others: Vec<(u32, Course)>,
    pub(super) limits: Limits,
}

impl<T> fmt::Debug for Scene<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Scene")
            .field("clock", &self.world.clock)
            .field("joints", &self.world.joints.len())
            .finish_non_exhaustive()
    }
}

impl<T: Float> Scene<T> {
    /// Creates an empty scene with `rate` ticks per second that begins at time 0. With a rate of
    /// 240, frames at 24, 30, 40, 48, 60, 80, 120 or 240 per second take whole numbers of ticks.
    pub fn new(rate: f64) -> Result<Self, SceneError> {
        Ok(Self {
            id: SceneId::next(),
            world: World::new(Clock::new(rate)?, Vec::new()),
            groups: Vec::new(),
            tolerance: 1e-3,
            longest_frame: 60.0,
            parallel: true,
            threads: Threads::new(),
            paused: false,
            sleep: None,
            faults: Vec::new(),
            bundle: None,
            others: Vec::new(),
            limits: Limits::default(),
        })
    }

    /// Adds a joint that follows `motion`.
    pub fn joint<M: Motion<T, D> + Send + Sync + 'static, const D: usize>(
        &mut self,
        motion: M,
    ) -> Joint<D> {
        let name = self.world.add_joint(erase(motion, self.world.clock.rate()));
        if let Some(bundle) = &mut self.bundle {
            bundle.joints.push(name);
        }
        Joint::new(self.id, name)
    }

    /// Adds a joint that [`move_to`](Self::move_to) moves while the scene runs, at a position or a
    /// [`Live`].
    ///
    /// # Errors
    /// Returns an error if the position is infinite or NaN.
    pub fn live<const D: usize>(
        &mut self,
        start: impl Into<Live<D>>,
    ) -> Result<Joint<D>, SceneError> {
        let start = start.into();
        check_position(self.world.next_joint(), &start.position)?;
        Ok(self.joint(Path::new(self.world.clock.asked(0), &start)))
    }

    /// Adds a frame that [`move_to`](Self::move_to) moves and turns while the scene runs: a joint
    /// for its position and one for its attitude, the four numbers of a quaternion. The pair is an
    /// anchor of systems with two driven inputs, a position and a rotation.
    ///
    /// The attitude is interpolated as the position, in the rotation vector relative to that at the
    /// beginning of the frame, by the shortest turn: turns of less than half a turn in a frame are
    /// followed, and turning about a fixed axis with a constant angular acceleration is exact after
    /// three attitudes. A position that is [smoothed](Live::smoothed) smooths the attitude too.
    ///
    /// ```
    /// use pendulum_runtime::attitude::Attitude;
    /// use pendulum_runtime::scene::Scene;
    ///
    /// let mut scene = Scene::<f64>::new(240.0)?;
    /// let head = scene.live_frame([0.0, 0.0, 1.7], Attitude::identity())?;
    /// // What hangs there: scene.hang(head, …)
    /// scene.move_to(head.0, [0.0, 0.1, 1.7])?;
    /// scene.move_to(head.1, Attitude::from_axis_angle([0.0, 0.0, 1.0], 0.1).to_quaternion())?;
    /// scene.advance(1.0 / 60.0)?;
    /// # Ok::<(), pendulum_runtime::scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if the position or the attitude is infinite or NaN.
    pub fn live_frame(
        &mut self,
        position: impl Into<Live<3>>,
        attitude: Attitude,
    ) -> Result<(Joint<3>, Joint<4>), SceneError> {
        let start = position.into();
        check_position(self.world.next_joint(), &start.position)?;
        check_position(self.world.next_joint() + 1, &attitude.to_quaternion())?;
        let position = self.live(start)?;
        let turn = Turn::new(self.world.clock.asked(0), attitude, start.smoothed);
        Ok((position, self.joint(turn)))
    }

    /// Hangs a system with coordinates `q` and velocities `v` on a joint or a tuple of joints, or
    /// on `()` if the system has no driven inputs. Control inputs are zero until
    /// [`set_inputs`](Self::set_inputs) sets them.
    ///
    /// # Errors
    /// Returns an error if the state is not finite or violates constraints or limits, if a mass is
    /// negative, if a joint belongs to another scene, if a motion lacks a derivative that the
    /// equations need, or if the pendulum is too fast: its tolerance would require more than 1024
    /// steps in a tick.
    // Passed by value so that a call can construct both arguments in place.
    #[allow(clippy::needless_pass_by_value)]
    pub fn hang<S: SceneSystem<T, N>, A, const N: usize>(
        &mut self,
        anchor: A,
        system: S,
        q: [T; N],
        v: [T; N],
    ) -> Result<Handle<S, N>, SceneError>
    where
        S::Inputs: Anchored<A>,
    {
        const {
            assert!(
                S::FACTS.states == 0,
                "a scene does not integrate a `state` of a block: integrate the system with `solve`"
            );
            assert!(
                <S::Inputs as Anchored<A>>::JOINTS == Layouts::<S, N>::DRIVEN,
                "a system hangs on one joint for each `driven` input of its block; an `input` has no joint: call `Scene::set_inputs`"
            );
        };
        check_state(&S::FACTS, &q)?;
        check_state(&S::FACTS, &v)?;
        let mut detached = Detached::new(&system, S::Inputs::joints(anchor, self.living())?, q, v);
        let prototype = system.map(|parameter| parameter);
        let hung = Hung { system, world: &self.world, pendulum: &detached };
        hung.check_motions()?;
        (detached.state, detached.standing) = hung.begin(q, v)?;
        let others = self.group::<S, N>().map(|group| tables(&group.prototype));
        if others.is_some_and(|others| others != tables(&prototype)) {
            return Err(SceneError::Tables { kind: S::FACTS.name });
        }
        let index = self.index_of::<S, N>().unwrap_or_else(|| {
            let group = Group::<S, T, N>::new(prototype, self.groups.len());
            self.groups.push((TypeId::of::<Group<S, T, N>>(), Box::new(group)));
            self.groups.len() - 1
        });
        let (id, tolerance) = (self.id, self.tolerance);
        let (group, world) = self
            .group_mut::<S, N>()
            .ok_or(SceneError::Pendulum { kind: S::FACTS.name, index: 0 })?;
        let hung = group.hang(world, detached, tolerance);
        // Removes the group again if it is empty.
        if group.table.is_empty() {
            self.groups.remove(index);
        }
        let name = hung?;
        if let Some(bundle) = &mut self.bundle {
            bundle.pendulums.push((TypeId::of::<Group<S, T, N>>(), name));
        }
        Ok(Handle::new(id, name.0, name.1))
    }

    /// Sets the relative phase error by which methods and steps are chosen for pendulums hung from
    /// now on. The initial value is 0.001, an error of 0.36° per swing. With RK4, the amplitude
    /// decays by less than this fraction per radian.
    ///
    /// Steps depend on the frequencies of small motions about four states: the state in which a
    /// pendulum is hung, or in which its parameters are changed, and three neighbouring states. If
    /// a swing becomes faster later, its error is larger than the tolerance. Ticks in which an angle
    /// has h² |θ̈| above half a radian, in a step h of RK4, are repeated in shorter steps.
    pub fn set_tolerance(&mut self, tolerance: f64) -> Result<(), SceneError> {
        if !(1e-14..=0.1).contains(&tolerance) {
            return Err(SceneError::Setting {
                name: "tolerance",
                value: tolerance,
                required: "between 1e-14 and 0.1",
            });
        }
        self.tolerance = tolerance;
        Ok(())
    }

    /// Sets the method of all pendulums of a type, which take as many steps as the tolerance
    /// requires. A method that does not suit the type does not compile.
    ///
    /// # Errors
    /// Returns an error if the scene contains no pendulum of this type, or if a pendulum is too
    /// fast for the method.
    pub fn set_method<S: SceneSystem<T, N>, const N: usize, M: Fixed<S, N>>(
        &mut self,
        _: M,
    ) -> Result<(), SceneError> {
        const {
            assert!(
                !Layouts::<S, N>::LIMITED || matches!(M::SCHEME, Scheme::Rk4),
                "this method keeps no contacts of a `limit`: use `Rk4`"
            );
        };
        let missing = SceneError::Pendulum { kind: S::FACTS.name, index: 0 };
        let (group, world) = self.group_mut::<S, N>().ok_or(missing)?;
        let before = group.scheme.replace(M::SCHEME);
        let planned = AnyGroup::plan(group, world, &Change::Steps, None);
        if planned.is_ok() {
            group.commit(world, &Change::Steps);
        } else {
            group.scheme = before;
        }
        planned.map(drop)
    }

    /// Sets the longest time by which a frame may advance the scene, initially 60 s. Longer frames
    /// are shortened, and [`Advanced::dropped`](crate::Advanced::dropped) reports the rest.
    pub fn set_longest_frame(&mut self, seconds: f64) -> Result<(), SceneError> {
        if !(0.0 < seconds && seconds < f64::INFINITY) {
            return Err(SceneError::Setting {
                name: "longest frame",
                value: seconds,
                required: "positive and finite",
            });
        }
        self.longest_frame = seconds;
        Ok(())
    }

    /// Allows or forbids the use of all threads, which is initially allowed. The result has the
    /// same bits either way. Without the feature `rayon` there is only one thread.
    ///
    /// Measurements at run time decide between one thread and all threads. Batches that take less
    /// than 0.2 ms on one thread always stay on one thread. From time to time two consecutive
    /// batches run in the slower way for comparison: at least once in 1024 batches, or once in 8192
    /// batches while all threads take less than half the time of one thread and their time changes
    /// by less than a quarter.
    pub fn set_parallel(&mut self, parallel: bool) {
        self.parallel = parallel;
    }

    /// Forces every batch to fork, however short, if threads are allowed. Tests use this setting to
    /// compare the bits of both ways.
    #[doc(hidden)]
    pub fn set_always_fork(&mut self, always: bool) {
        self.threads.always = always;
    }

    /// Returns the time of the last tick, in seconds.
    pub fn time(&self) -> f64 {
        self.world.now()
    }

    /// Returns the number of ticks since time 0.
    pub fn tick(&self) -> i64 {
        self.world.clock.tick()
    }

    /// Returns the length of a tick in seconds.
    pub fn step(&self) -> f64 {
        self.world.clock.step()
    }

    /// Returns the fraction of the next tick that frames have requested, in [0, 1), as an argument
    /// of [`pose`](Self::pose).
    pub fn alpha(&self) -> f64 {
        self.world.clock.fraction()
    }

    /// Returns the handle of the pendulum with the number `index` among the pendulums of its type,
    /// in the order of hanging, from 0; `None` if there is none. Numbers of removed pendulums are
    /// used again. Scenes that are built in the same
    /// way have equal numbers.
    pub fn handle<S: SceneSystem<T, N>, const N: usize>(&self, index: u32) -> Option<Handle<S, N>> {
        let group = self.group::<S, N>()?;
        Some(Handle::new(self.id, index, group.generation(index)?))
    }

    /// Returns the number of computed pendulums and the number of all pendulums.
    pub fn awake(&self) -> (usize, usize) {
        self.groups.iter().fold((0, 0), |(awake, all), (_, group)| {
            let (more, others) = group.awake();
            (awake + more, all + others)
        })
    }

    /// Returns the faults of pendulums in the order of time.
    pub fn faults(&self) -> &[SceneFault] {
        &self.faults
    }

    /// Returns the joints that handles may name.
    pub(super) fn living(&self) -> Living<'_> {
        Living { scene: self.id, generations: &self.world.generations }
    }

    pub(super) fn index_of<S: SceneSystem<T, N>, const N: usize>(&self) -> Option<usize> {
        let id = TypeId::of::<Group<S, T, N>>();
        self.groups.iter().position(|(other, _)| *other == id)
    }

    pub(super) fn group<S: SceneSystem<T, N>, const N: usize>(&self) -> Option<&Group<S, T, N>> {
        let group: &dyn Any = &*self.groups[self.index_of::<S, N>()?].1;
        group.downcast_ref()
    }

    pub(super) fn group_mut<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
    ) -> Option<(&mut Group<S, T, N>, &mut World<T>)> {
        let index = self.index_of::<S, N>()?;
        let group: &mut dyn Any = &mut *self.groups[index].1;
        Some((group.downcast_mut()?, &mut self.world))
    }
}
