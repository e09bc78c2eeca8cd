//! Scenes: the same bits as scalar methods, in lanes and threads, and a soak test of random
//! characters.

use crate::memory::memory;
use crate::systems::{Double, Hung, Simple};
use ::systems::random::Random;
use check::report::{Report, Scale};
use pendulum_runtime::integrate::FixedStep;
use pendulum_runtime::integrate::controller::Controller;
use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::motion::{Curve, Sinusoid, Still};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Float;
use pendulum_runtime::scene::{Fixed, Handle, Joint, Preserve, Resume, Scene, SceneSystem};
use pendulum_runtime::system::System;

/// The number of ticks per second. The length of a tick is a power of two, so that solvers take the
/// same steps.
const BINARY: f64 = 256.0;

/// Measures the part of S22 that concerns scenes.
pub(crate) fn bits(scale: Scale, report: &mut Report) {
    let seconds = scale.pick(2, 8, 64);
    let mut differ = differing(Leapfrog, seconds, simple());
    differ += differing(Srkn6b, seconds, simple());
    differ += differing(Rk4, seconds, simple());
    differ += differing(Rk4, seconds, doubles(|x| x));
    differ += differing(Rk4, seconds, doubles(|x| x as f32));
    report.row(format!(
            "pendulums of a scene and by `solve`, three methods, two scalars, {} steps: pendulums that differ",
            256 * seconds
        )).at_most(differ as f64, 0.0);
    let frames = scale.pick(30, 120, 1000);
    let run = |parallel: bool| {
        let mut crowd = Crowd::new(22, 4000);
        crowd.scene.set_parallel(parallel);
        for _ in 0..frames {
            crowd.frame();
        }
        crowd.scene.checksum()
    };
    let here = run(false);
    let beside: Vec<u64> = std::thread::scope(|scope| {
        let threads = [scope.spawn(|| run(false)), scope.spawn(|| run(true))];
        threads.map(|thread| thread.join().unwrap()).into()
    });
    report
        .row("a scene of 4000 pendulums, and the same in other threads")
        .failures(beside.iter().map(|other| *other == here));
    #[cfg(feature = "rayon")]
    report.row("the same scene in 1, 2, 3 and 7 threads at once").failures([1, 2, 3, 7].map(
        |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| run(true)) == here
        },
    ));
}

/// Returns fifty pendulums of random lengths and starts.
fn simple() -> Vec<(Simple<f64>, [f64; 1], [f64; 1])> {
    let mut random = Random::new(9);
    let mut one = || [(0.3, 9.0), (-3.0, 3.0), (-3.0, 3.0)].map(|(a, b)| random.uniform(a, b));
    (0..50).map(|_| one()).map(|[g, q, v]| (Simple::new(g), [q], [v])).collect()
}

/// Returns fifty double pendulums, whose accelerations depend on velocities, in any scalar.
fn doubles<T: Float>(round: impl Fn(f64) -> T) -> Vec<(Double<T>, [T; 2], [T; 2])> {
    let mut random = Random::new(10);
    let system = || Double::new([1.0, 0.7].map(&round), [0.9, 1.1].map(&round), round(3.0));
    let mut start = || [0, 1].map(|_| round(random.uniform(-1.0, 1.0)));
    (0..50).map(|_| (system(), start(), [round(0.0); 2])).collect()
}

/// Returns the number of pendulums whose final states in a scene and with `solve` differ.
fn differing<T: Float, S, M, const N: usize>(
    method: M,
    seconds: u32,
    pendulums: Vec<(S, [T; N], [T; N])>,
) -> usize
where
    S: SceneSystem<T, N> + System<N, Scalar = T, Inputs = ()> + Clone,
    M: Fixed<S, N> + Method<S, N>,
    FixedStep: Controller<M, S, N>,
{
    let mut scene = Scene::<T>::new(BINARY).unwrap();
    scene.set_tolerance(1e-2).unwrap();
    let hang = |(system, q, v): &(S, _, _)| scene.hang((), system.clone(), *q, *v).unwrap();
    let handles: Vec<_> = pendulums.iter().map(hang).collect();
    scene.set_method::<S, N, M>(method).unwrap();
    scene.advance(f64::from(seconds)).unwrap();
    let differs = |(handle, (system, q, v)): &(Handle<S, N>, (S, _, _))| {
        let run = solve(system, (0.0, f64::from(seconds)), *q, *v).method(method);
        let end = run.steps(256 * u64::from(seconds)).run().unwrap().end;
        scene.state(*handle) != (end.q, end.v)
    };
    handles.into_iter().zip(pendulums).filter(differs).count()
}

/// A pendulum of a crowd.
#[derive(Clone, Copy)]
enum Pendulum {
    One(Handle<Hung<f64>, 1>),
    Two(Handle<Double<f64>, 2>),
}

/// A copy of a pendulum of the crowd in a separate scene.
struct Single {
    scene: Scene<f64>,
    joint: Joint<2>,
    pendulum: Handle<Hung<f64>, 1>,
    /// The character, which is the index of the joint, and the handle in the crowd.
    character: usize,
    there: Handle<Hung<f64>, 1>,
}

/// Characters with fifty pendulums that move randomly, are teleported and hidden, and pause.
struct Crowd {
    scene: Scene<f64>,
    joints: Vec<Joint<2>>,
    pendulums: Vec<Pendulum>,
    singles: Vec<Single>,
    random: Random,
    paused: bool,
    hidden: Option<Handle<Hung<f64>, 1>>,
    /// The total time passed to the scene while it was not paused.
    asked: f64,
}

/// The types of motions.
enum Moving {
    Keys(Curve<2>),
    Swing(Sinusoid<2>),
    Still(Still<2>),
}

impl Moving {
    /// Creates the motion of a seed, whose keys begin before `now`.
    fn new(seed: u64, now: f64) -> Self {
        let mut random = Random::new(seed);
        let times: Vec<f64> = (0..=60).map(|key| now - 1.0 + 0.25 * f64::from(key)).collect();
        let mut place = || [random.uniform(-0.2, 0.2), random.uniform(-0.05, 0.05)];
        let mut keys: Vec<[f64; 2]> = times.iter().map(|_| place()).collect();
        keys[60] = keys[0];
        match seed % 4 {
            0 => Self::Keys(Curve::linear(&times, &keys).unwrap()),
            1 => Self::Keys(Curve::periodic(&times, &keys).unwrap()),
            2 => Self::Swing(Sinusoid::new(keys[0], 9.0, keys[1])),
            _ => Self::Still(Still::new(keys[0])),
        }
    }
}

/// Adds a joint that moves from the current time on.
fn moving(scene: &mut Scene<f64>, seed: u64) -> Joint<2> {
    match Moving::new(seed, scene.time()) {
        Moving::Keys(motion) => scene.joint(motion),
        Moving::Swing(motion) => scene.joint(motion),
        Moving::Still(motion) => scene.joint(motion),
    }
}

/// Sets another motion for a joint.
fn teleport(scene: &mut Scene<f64>, joint: Joint<2>, seed: u64, preserve: Preserve) {
    let moved = match Moving::new(seed, scene.time()) {
        Moving::Keys(motion) => scene.set_motion(joint, motion, preserve),
        Moving::Swing(motion) => scene.set_motion(joint, motion, preserve),
        Moving::Still(motion) => scene.set_motion(joint, motion, preserve),
    };
    moved.unwrap();
}

impl Crowd {
    fn new(seed: u64, count: usize) -> Self {
        let mut scene = Scene::new(240.0).unwrap();
        let mut random = Random::new(seed);
        let characters = count.div_ceil(50);
        let joints: Vec<_> =
            (0..characters).map(|character| moving(&mut scene, character as u64)).collect();
        let (mut pendulums, mut singles) = (Vec::new(), Vec::new());
        for index in 0..count {
            let character = index / 50;
            let (length, q) = (random.uniform(0.1, 2.0), random.uniform(-3.0, 3.0));
            if index % 10 == 9 {
                let system = Double::new([1.0; 2], [length; 2], 9.81);
                pendulums
                    .push(Pendulum::Two(scene.hang((), system, [q, 0.5 * q], [0.0; 2]).unwrap()));
                continue;
            }
            let hang = |scene: &mut Scene<f64>, joint| {
                let pendulum = scene.hang(joint, Hung::new(length, 9.81), [q], [0.0]).unwrap();
                scene.set_damping(pendulum, if index % 2 == 0 { 0.5 } else { 0.0 }).unwrap();
                pendulum
            };
            let there = hang(&mut scene, joints[character]);
            pendulums.push(Pendulum::One(there));
            if index % (count / 16) == 0 {
                let mut scene = Scene::new(240.0).unwrap();
                let joint = moving(&mut scene, character as u64);
                let pendulum = hang(&mut scene, joint);
                singles.push(Single { scene, joint, pendulum, character, there });
            }
        }
        Self { scene, joints, pendulums, singles, random, paused: false, hidden: None, asked: 0.0 }
    }

    /// Advances a frame of random length with random events, and returns the number of ticks.
    fn frame(&mut self) -> u64 {
        let chance = |random: &mut Random, one_in: u64| random.bits().is_multiple_of(one_in);
        if chance(&mut self.random, 10) {
            let character = self.random.bits() as usize % self.joints.len();
            let (seed, preserve) = (
                self.random.bits(),
                if chance(&mut self.random, 2) { Preserve::Swing } else { Preserve::Momentum },
            );
            teleport(&mut self.scene, self.joints[character], seed, preserve);
            for single in self.singles.iter_mut().filter(|single| single.character == character) {
                teleport(&mut single.scene, single.joint, seed, preserve);
            }
        }
        if chance(&mut self.random, 50) {
            self.paused = !self.paused;
            self.scene.set_paused(self.paused);
        }
        if chance(&mut self.random, 20) {
            // A hidden pendulum resumes as if no time had passed.
            if let Some(pendulum) = self.hidden.take() {
                self.scene.show(pendulum, Resume::Unchanged).unwrap();
            } else {
                let index = self.random.bits() as usize % self.pendulums.len();
                if let Pendulum::One(pendulum) = self.pendulums[index]
                    && !self.singles.iter().any(|single| single.there == pendulum)
                {
                    self.scene.hide(pendulum).unwrap();
                    self.hidden = Some(pendulum);
                }
            }
        }
        let dt = match self.random.bits() % 100 {
            0 => 0.0,
            1 => 0.3,
            _ => self.random.uniform(0.0, 1.0 / 30.0),
        };
        let ticks = self.scene.advance(dt).unwrap().ticks;
        self.asked += if self.paused { 0.0 } else { dt };
        // The single scenes advance by the same ticks.
        for single in &mut self.singles {
            single.scene.advance_ticks(ticks as u32);
        }
        ticks
    }

    /// Returns `true` if all states are finite and no pendulum has failed.
    fn is_well(&self) -> bool {
        let finite = |x: &f64| x.is_finite();
        let one = |pendulum: &Pendulum| match *pendulum {
            Pendulum::One(handle) => {
                let (q, v) = self.scene.state(handle);
                q.iter().chain(&v).all(finite)
            }
            Pendulum::Two(handle) => {
                let (q, v) = self.scene.state(handle);
                q.iter().chain(&v).all(finite)
            }
        };
        self.scene.faults().is_empty() && self.pendulums.iter().all(one)
    }
}

/// Measures the part of S28 that concerns scenes.
pub(crate) fn soak(scale: Scale, report: &mut Report) {
    let (count, frames) = (scale.pick(1_000, 10_000, 100_000), scale.pick(2_000, 10_000, 36_000));
    let mut crowd = Crowd::new(28, count);
    let (mut well, mut restored, mut ticks, mut before) = (true, Vec::new(), 0, None);
    for frame in 0..frames {
        ticks += crowd.frame();
        if frame % (frames / 10) == 0 {
            well &= crowd.is_well();
            // Save and advance; then restore and advance again.
            let snapshot = crowd.scene.snapshot();
            crowd.scene.advance_ticks(7);
            let after = crowd.scene.checksum();
            crowd.scene.restore(&snapshot).unwrap();
            restored.push(crowd.scene.checksum() == snapshot.checksum());
            crowd.scene.advance_ticks(7);
            restored.push(crowd.scene.checksum() == after);
            crowd.scene.restore(&snapshot).unwrap();
        }
        if frame == frames / 10 {
            before = memory();
        }
    }
    well &= crowd.is_well();
    let grown = before.zip(memory()).map_or(0.0, |(before, after)| after - before);
    report
        .row(format!(
            "a scene of {count} pendulums, {frames} random frames: finite, and nobody has failed"
        ))
        .failures([well]);
    let lost =
        |single: &Single| crowd.scene.state(single.there) == single.scene.state(single.pendulum);
    report
        .row(format!("its pendulums against the same alone, {} of them", crowd.singles.len()))
        .failures(crowd.singles.iter().map(lost));
    report.row("saved, gone on, restored, gone on: the same bits").failures(restored);
    let passed = crowd.scene.time() + crowd.scene.alpha() * crowd.scene.step();
    report
        .row(format!("the time of its {ticks} ticks against that of the frames, relative"))
        .at_most((passed / crowd.asked - 1.0).abs(), 1e-12);
    report.row("its growth of memory in bytes, other tests included").at_most(grown, 3e7);
}
