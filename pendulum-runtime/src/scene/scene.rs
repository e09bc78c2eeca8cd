//! The joints and pendulums of a scene, and its settings.

use crate::motion::Motion;
use crate::scalar::{Float, Lane};
use crate::scene::error::{SceneError, SceneFault};
use crate::scene::group::any::AnyGroup;
use crate::scene::group::constraints::OnJoints;
use crate::scene::group::joints::{check_joints, check_state};
use crate::scene::group::members::Group;
use crate::scene::handle::{Handle, SceneId};
use crate::scene::lanes::system::SceneSystem;
use crate::scene::sampling::clock::Clock;
use crate::scene::sampling::from_numbers::Anchor;
use crate::scene::sampling::joint::{Active, Joint, JointSlot, erase};
use crate::scene::sampling::scheme::Fixed;
use crate::scene::sampling::timetable::Timetable;
use crate::scene::threads::Threads;
use core::any::TypeId;
use core::fmt;

/// Joints with their motions and pendulums of any type hung on them, over `f32` or `f64`.
pub struct Scene<T> {
    pub(super) id: SceneId,
    pub(super) clock: Clock,
    pub(super) joint_slots: Vec<JointSlot<T>>,
    /// The joints that a pendulum which is awake needs.
    pub(super) actives: Vec<Active>,
    pub(super) groups: Vec<(TypeId, Box<dyn AnyGroup<T>>)>,
    pub(super) timetable: Timetable,
    /// Samples of the joints in a batch.
    pub(super) numbers: Vec<T>,
    /// Somebody has been hung up, woken or put to sleep since the timetable was made.
    pub(super) dirty: bool,
    pub(super) tolerance: f64,
    pub(super) longest_frame: f64,
    pub(super) parallel: bool,
    pub(super) threads: Threads,
    pub(super) paused: bool,
    pub(super) sleep: Option<f64>,
    pub(super) faults: Vec<SceneFault>,
}

/// A group, and what of the scene its pendulums see.
pub(super) type Parts<'a, S, T, const N: usize> =
    (&'a mut Group<S, T, N>, &'a Clock, &'a [JointSlot<T>]);

impl<T> fmt::Debug for Scene<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Scene")
            .field("clock", &self.clock)
            .field("joints", &self.joint_slots.len())
            .finish_non_exhaustive()
    }
}

impl<T: Lane + Float> Scene<T> {
    /// An empty scene that does `rate` ticks a second, beginning at time 0. With 240 or more every
    /// usual frame rate is a whole number of ticks.
    pub fn new(rate: f64) -> Result<Self, SceneError> {
        Ok(Self {
            id: SceneId::next(),
            clock: Clock::new(rate)?,
            joint_slots: Vec::new(),
            actives: Vec::new(),
            groups: Vec::new(),
            timetable: Timetable::default(),
            numbers: Vec::new(),
            dirty: false,
            tolerance: 1e-3,
            longest_frame: 60.0,
            parallel: true,
            threads: Threads::new(),
            paused: false,
            sleep: None,
            faults: Vec::new(),
        })
    }

    /// Adds a joint that moves so.
    pub fn joint<M: Motion<T, D> + Send + Sync + 'static, const D: usize>(
        &mut self,
        motion: M,
    ) -> Joint<D> {
        self.joint_slots.push(JointSlot::new(erase(motion)));
        Joint::new(self.id, self.joint_slots.len() as u32 - 1)
    }

    /// Hangs a system on a joint, on a tuple of joints or, without driven inputs, on `()`, with
    /// coordinates `q` and velocities `v`.
    ///
    /// # Errors
    /// A state that is not finite or does not fulfil the constraints, a negative mass, a joint of
    /// another scene, a motion without a derivative that the equations need, a pendulum that is too
    /// fast: more than 1024 steps in a tick would be needed for the tolerance.
    // Taken by value, so that both can be made in the call.
    #[allow(clippy::needless_pass_by_value)]
    pub fn hang<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        anchor: impl Anchor<S::Inputs>,
        system: S,
        q: [T; N],
        v: [T; N],
    ) -> Result<Handle<S, N>, SceneError> {
        const {
            assert!(
                S::FACTS.limits.is_empty(),
                "scenes keep no limits of a system: integrate it by `solve`, or give coordinates limits by `Scene::set_limits`"
            );
        };
        check_state(&S::FACTS, &q)?;
        check_state(&S::FACTS, &v)?;
        let joints = anchor.joints(self.id)?;
        check_joints::<S, T, N>(&self.joint_slots, &joints)?;
        let (q, v) = OnJoints { system: &system, joint_slots: &self.joint_slots, joints: &joints }
            .start(self.time(), q, v)?;
        let index = self.index_of::<S, N>().unwrap_or_else(|| {
            let group = Group::<S, T, N>::new(system.map(|parameter| parameter));
            self.groups.push((TypeId::of::<Group<S, T, N>>(), Box::new(group)));
            self.groups.len() - 1
        });
        self.dirty = true;
        let Self { id, clock, joint_slots, groups, tolerance, .. } = self;
        let group = groups[index].1.as_any_mut().downcast_mut::<Group<S, T, N>>();
        let group = group.ok_or(SceneError::Pendulum { kind: S::FACTS.name, index: 0 })?;
        match group.hang(clock, joint_slots, joints, &system, *tolerance, [q, v]) {
            Ok(index) => Ok(Handle::new(*id, index)),
            Err(error) => {
                // No empty group stays behind.
                if group.table.is_empty() {
                    groups.remove(index);
                }
                Err(error)
            }
        }
    }

    /// The relative error of the phase by which methods and steps are chosen for what is hung from
    /// now on; 0.001 at first, an error of 0.36° in a swing. What RK4 integrates loses less than
    /// this part of its amplitude in a radian.
    ///
    /// Steps are chosen by the frequencies of small motions about the state in which a pendulum is
    /// hung or whose parameters are changed and about three states beside it; a swing that becomes
    /// much faster on its way has a larger error.
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

    /// Lets all pendulums of a type take `method`, in as many steps as the tolerance asks for; one
    /// that is wrong for them does not compile.
    ///
    /// # Errors
    /// Nothing of that type hangs here yet, or a pendulum is too fast for the method.
    pub fn set_method<S: SceneSystem<T, N>, const N: usize, M: Fixed<S, N>>(
        &mut self,
        _: M,
    ) -> Result<(), SceneError> {
        let missing = SceneError::Pendulum { kind: S::FACTS.name, index: 0 };
        let (group, clock, joint_slots) = self.group_mut::<S, N>().ok_or(missing)?;
        let before = group.scheme.replace(M::SCHEME);
        let ids = 0..group.table.len() as u32;
        let suited = ids
            .clone()
            .try_for_each(|id| group.checked_kind(clock, joint_slots, &group.read(id)).map(drop));
        if suited.is_err() {
            group.scheme = before;
            return suited;
        }
        for id in ids {
            let detached = group.read(id);
            group.rewrite(clock, joint_slots, &detached)?;
        }
        self.dirty = true;
        Ok(())
    }

    /// The longest time that one frame may take; what is longer is cut and reported. 60 s at first.
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

    /// Allows or forbids the use of all threads, which is allowed at first; the bits are the same.
    /// Without the feature `rayon` there is only one.
    ///
    /// They are used where that is quicker, which is measured while running. Batches that took less
    /// than 0.2 ms on one thread do not fork. Two batches in a row are run the slower way from time
    /// to time, to compare: at least once in 1024 batches, or once in 8192 while all threads take
    /// less than half the time of one and their time stays within a quarter.
    pub fn set_parallel(&mut self, parallel: bool) {
        self.parallel = parallel;
    }

    /// Forks every batch where threads are allowed, however short it is: tests compare the bits of
    /// both ways.
    #[doc(hidden)]
    pub fn set_always_fork(&mut self, always: bool) {
        self.threads.set_always(always);
    }

    /// The time of the last tick, in seconds.
    pub fn time(&self) -> f64 {
        self.clock.time(self.clock.tick())
    }

    /// The ticks done since time 0.
    pub fn tick(&self) -> i64 {
        self.clock.tick()
    }

    /// The length of a tick in seconds.
    pub fn step(&self) -> f64 {
        self.clock.step()
    }

    /// The part of the next tick that frames have asked for, in [0, 1): what [`pose`](Self::pose)
    /// takes.
    pub fn alpha(&self) -> f64 {
        self.clock.fraction()
    }

    /// The pendulum that was hung as number `index` of its type, from 0: handles of a scene that
    /// was built as another one was.
    pub fn handle<S: SceneSystem<T, N>, const N: usize>(&self, index: u32) -> Option<Handle<S, N>> {
        let group = self.group::<S, N>()?;
        ((index as usize) < group.table.len()).then(|| Handle::new(self.id, index))
    }

    /// The pendulums that are computed, and all.
    pub fn awake(&self) -> (usize, usize) {
        self.groups.iter().fold((0, 0), |(awake, all), (_, group)| {
            let (more, others) = group.awake();
            (awake + more, all + others)
        })
    }

    /// The pendulums that have failed, in the order of time.
    pub fn faults(&self) -> &[SceneFault] {
        &self.faults
    }

    pub(super) fn index_of<S: SceneSystem<T, N>, const N: usize>(&self) -> Option<usize> {
        let id = TypeId::of::<Group<S, T, N>>();
        self.groups.iter().position(|(other, _)| *other == id)
    }

    pub(super) fn group<S: SceneSystem<T, N>, const N: usize>(&self) -> Option<&Group<S, T, N>> {
        self.groups[self.index_of::<S, N>()?].1.as_any().downcast_ref()
    }

    pub(super) fn group_mut<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
    ) -> Option<Parts<'_, S, T, N>> {
        let index = self.index_of::<S, N>()?;
        Some((self.groups[index].1.as_any_mut().downcast_mut()?, &self.clock, &self.joint_slots))
    }
}
