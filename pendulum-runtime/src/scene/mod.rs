//! Scenes: many systems on many joints, and nothing computed that the scene does not need.
//!
//! A [`Scene`] holds joints, each with a [`Motion`], and pendulums of any type that `lagrangian!`
//! generates hung on them. [`Scene::advance`] takes frame times and does whole ticks of a fixed
//! length, so that the motion does not depend on how time is cut into frames; [`Scene::pose`]
//! interpolates between the last two ticks.
//!
//! ```
//! # #![allow(mixed_script_confusables)]
//! use pendulum_runtime::motion::Sinusoid;
//! use pendulum_runtime::prelude::*;
//! use pendulum_runtime::scene::Scene;
//!
//! lagrangian! {
//!     pub struct Feather { m: kg, L: m, g: m/s^2 = 9.81 }
//!     coordinate θ: rad;
//!     driven x: [m; 2];
//!     let y = x + L * [sin(θ), -cos(θ)];
//!     kinetic = m/2 * |ẏ|^2;
//!     potential = m*g*height(y);
//! }
//!
//! let mut scene = Scene::<f32>::new(240.0)?;
//! let wing = scene.joint(Sinusoid::new([0.0, 0.05], 12.0, [0.0, 0.0]));
//! let feathers = (0..20).map(|k| scene.hang(wing, Feather::new(0.01, 0.05 + 0.002 * k as f32), [0.0], [0.0]));
//! let feathers: Vec<_> = feathers.collect::<Result<_, _>>()?;
//! for _frame in 0..60 {
//!     scene.advance(1.0 / 60.0)?;
//!     let angle = scene.pose(feathers[3], scene.alpha())[0];
//! #   assert!(angle.abs() < 1.0);
//! }
//! # Ok::<(), pendulum_runtime::scene::SceneError>(())
//! ```
//!
//! # How it is computed
//!
//! Pendulums of one type that take the same steps stand in blocks of 32 lanes, structures of
//! arrays, and go through eight ticks at a time; the code is compiled for several instruction sets
//! and the widest is chosen while running (feature `simd`). Every lane has the bits that the
//! pendulum would have alone, so neither its neighbours, nor the number of threads (feature
//! `rayon`), nor the machine can be seen in the result.
//!
//! Velocity-free systems take leapfrog or SRKN6b, all others RK4, in as many equal steps a tick as
//! the [tolerance](Scene::set_tolerance) asks for: the method that needs fewer evaluations. Steps
//! are cut at the kinks of the motions, and there the momenta carry the state over.

mod assemble;
mod bake;
mod block;
mod bucket;
mod clock;
mod cycle;
mod director;
mod error;
mod frequency;
mod group;
mod hash;
mod hung;
mod inputs;
mod joint;
mod kernel;
#[cfg(any(feature = "rayon", test))]
mod pace;
mod rest;
mod run;
mod scheme;
mod screen;
mod sleep;
mod snapshot;
mod state;
mod threads;
mod timetable;
mod tracks;

pub use assemble::{Anchor, Assemble, Numbers};
pub use bake::Baked;
pub use cycle::Closed;
pub use director::{Carry, Stop};
pub use error::{Failure, SceneError};
pub use group::Status;
pub use hung::Hung;
pub use joint::Joint;
pub use run::Advanced;
pub use scheme::{Fixed, Scheme};
pub use screen::Return;
pub use snapshot::{GroupState, Snapshot};

use crate::motion::Motion;
use crate::real::{Float, Lane};
use clock::Clock;
use core::any::TypeId;
use core::fmt;
use core::marker::PhantomData;
use group::{AnyGroup, Group, check_state};
use joint::{Active, Place};
use threads::Threads;
use timetable::Timetable;

/// Joints with their motions and pendulums of any type hung on them, over `f32` or `f64`.
pub struct Scene<T> {
    clock: Clock,
    places: Vec<Place<T>>,
    /// Those that somebody awake needs.
    actives: Vec<Active>,
    groups: Vec<(TypeId, Box<dyn AnyGroup<T>>)>,
    timetable: Timetable,
    /// What was sampled of the joints in a batch.
    numbers: Vec<T>,
    /// Somebody has been hung up, woken or put to sleep since the timetable was made.
    dirty: bool,
    tolerance: f64,
    longest_frame: f64,
    parallel: bool,
    threads: Threads,
    paused: bool,
    sleep: Option<f64>,
    failures: Vec<Failure>,
}

/// A group, and what of the scene its pendulums see.
type Parts<'a, S, T, const N: usize> = (&'a mut Group<S, T, N>, &'a Clock, &'a [Place<T>]);

/// A pendulum in a scene: its type and its number among those of its type.
pub struct Handle<S, const N: usize> {
    index: u32,
    kind: PhantomData<fn() -> S>,
}

impl<S, const N: usize> Handle<S, N> {
    /// The pendulum that was hung as number `index` of its type, from 0.
    pub const fn new(index: u32) -> Self {
        Self { index, kind: PhantomData }
    }

    /// Its number among those of its type, in the order of hanging.
    pub const fn index(self) -> u32 {
        self.index
    }
}

impl<S, const N: usize> Clone for Handle<S, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, const N: usize> Copy for Handle<S, N> {}

impl<S, const N: usize> PartialEq for Handle<S, N> {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index
    }
}

impl<S, const N: usize> Eq for Handle<S, N> {}

impl<S, const N: usize> fmt::Debug for Handle<S, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Handle").field(&self.index).finish()
    }
}

impl<T> fmt::Debug for Scene<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Scene")
            .field("clock", &self.clock)
            .field("joints", &self.places.len())
            .finish_non_exhaustive()
    }
}

impl<T: Lane + Float> Scene<T> {
    /// An empty scene that does `rate` ticks a second, beginning at time 0. With 240 or more every
    /// usual frame rate is a whole number of ticks.
    pub fn new(rate: f64) -> Result<Self, SceneError> {
        Ok(Self {
            clock: Clock::new(rate)?,
            places: Vec::new(),
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
            failures: Vec::new(),
        })
    }

    /// Adds a joint that moves so.
    pub fn joint<M: Motion<T, D> + Send + Sync + 'static, const D: usize>(
        &mut self,
        motion: M,
    ) -> Joint<D> {
        self.places.push(Place::new(joint::forget(motion)));
        Joint(self.places.len() as u32 - 1)
    }

    /// Hangs a system on a joint, on a tuple of joints or, without driven inputs, on `()`, with
    /// coordinates `q` and velocities `v`.
    ///
    /// # Errors
    /// A state that is not finite, a joint of another scene, a motion without a derivative that the
    /// equations need.
    // Taken by value, so that both can be made in the call.
    #[allow(clippy::needless_pass_by_value)]
    pub fn hang<S: Hung<T, N>, const N: usize>(
        &mut self,
        anchor: impl Anchor<S::Inputs>,
        system: S,
        q: [T; N],
        v: [T; N],
    ) -> Result<Handle<S, N>, SceneError> {
        check_state(&S::FACTS, &q)?;
        check_state(&S::FACTS, &v)?;
        let joints = anchor.joints();
        group::check_joints::<S, T, N>(&self.places, &joints)?;
        // Nothing is refused from here on, so that no empty group stays behind.
        let index = self.index_of::<S, N>().unwrap_or_else(|| {
            let group = Group::<S, T, N>::new(system.mapped(|parameter| parameter));
            self.groups.push((TypeId::of::<Group<S, T, N>>(), Box::new(group)));
            self.groups.len() - 1
        });
        self.dirty = true;
        let Self { clock, places, groups, tolerance, .. } = self;
        let group = groups[index].1.as_any_mut().downcast_mut::<Group<S, T, N>>();
        let group = group.ok_or(SceneError::Pendulum { kind: S::FACTS.name, index: 0 })?;
        Ok(Handle::new(group.hang(clock, places, joints, &system, *tolerance, [q, v])))
    }

    /// The relative error of the phase by which methods and steps are chosen for what is hung from
    /// now on; 0.001 at first.
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
    /// Nothing of that type hangs here yet.
    pub fn set_method<S: Hung<T, N>, const N: usize, M: Fixed<S, N>>(
        &mut self,
        _: M,
    ) -> Result<(), SceneError> {
        let missing = SceneError::Pendulum { kind: S::FACTS.name, index: 0 };
        let (group, clock, places) = self.group_mut::<S, N>().ok_or(missing)?;
        group.scheme = Some(M::SCHEME);
        for id in 0..group.table.len() as u32 {
            let loose = group.read(id);
            group.rewrite(clock, places, &loose);
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

    /// Whether all threads may be used, as at first; the bits are the same. Without the feature
    /// `rayon` there is only one.
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

    /// The pendulums that have failed, in the order of time.
    pub fn failures(&self) -> &[Failure] {
        &self.failures
    }

    fn index_of<S: Hung<T, N>, const N: usize>(&self) -> Option<usize> {
        let id = TypeId::of::<Group<S, T, N>>();
        self.groups.iter().position(|(other, _)| *other == id)
    }

    fn group<S: Hung<T, N>, const N: usize>(&self) -> Option<&Group<S, T, N>> {
        self.groups[self.index_of::<S, N>()?].1.as_any().downcast_ref()
    }

    fn group_mut<S: Hung<T, N>, const N: usize>(&mut self) -> Option<Parts<'_, S, T, N>> {
        let index = self.index_of::<S, N>()?;
        Some((self.groups[index].1.as_any_mut().downcast_mut()?, &self.clock, &self.places))
    }
}
