//! Scenes compute shared values once and skip unused values.

use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::motion::{Derivatives, Motion, Sample, Side, Sinusoid};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Fixed, Scene};
use pendulum_runtime::time::Time;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use systems::pendulums::{Double, Hanging, Simple};
use systems::random::Random;

/// A motion that counts its samples and refuses derivatives that no equation contains.
#[derive(Clone)]
struct Watched(Arc<AtomicUsize>);

impl Motion<f64, 2> for Watched {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<f64, 2> {
        assert!(
            wanted == Derivatives::ACCELERATION || wanted == Derivatives::NONE,
            "asked for {wanted:?}"
        );
        self.0.fetch_add(1, Ordering::Relaxed);
        Motion::<f64, 2>::sample(&Sinusoid::new([0.1, 0.0], 5.0, [0.0, 0.0]), t, side, wanted)
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

#[test]
fn joints_are_asked_once_per_time_and_type_for_what_is_needed() {
    let mut scene = Scene::<f64>::new(100.0).unwrap();
    let asked = Arc::new(AtomicUsize::new(0));
    let joint = scene.joint(Watched(asked.clone()));
    for index in 0..100 {
        scene.hang(joint, Hanging::new(0.1, 1.0 + 0.01 * f64::from(index)), [0.1], [0.0]).unwrap();
    }
    asked.store(0, Ordering::Relaxed);
    scene.advance_ticks(50);
    assert_eq!(asked.load(Ordering::Relaxed), 50);
    // Another type asks for itself: RK4 uses the middle, and both ends, each of which is sampled
    // once in a batch.
    scene.hang(joint, Double::new(0.1, 1.0, 0.0), [0.1, 0.0], [0.0, 0.0]).unwrap();
    asked.store(0, Ordering::Relaxed);
    scene.advance_ticks(8);
    assert_eq!(asked.load(Ordering::Relaxed), 8 + 17);
}

/// A motion at rest that must not be sampled while the scene runs.
#[derive(Clone)]
struct Asleep(Arc<AtomicUsize>);

impl Motion<f64, 2> for Asleep {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, _: Time, _: Side, wanted: Derivatives) -> Sample<f64, 2> {
        if wanted.contains(Derivatives::ACCELERATION) || wanted.contains(Derivatives::VELOCITY) {
            self.0.fetch_add(1, Ordering::Relaxed);
        }
        Sample::zero()
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        panic!("a joint at rest has no kinks to ask for")
    }

    fn rest_until(&self, _: f64) -> f64 {
        f64::INFINITY
    }
}

#[test]
fn still_joints_are_left_alone() {
    let mut scene = Scene::<f64>::new(100.0).unwrap();
    let asked = Arc::new(AtomicUsize::new(0));
    let joint = scene.joint(Asleep(asked.clone()));
    let handle = scene.hang(joint, Hanging::new(0.1, 1.0), [0.1], [0.0]).unwrap();
    let free = scene.hang((), Simple::new(0.1, 1.0), [0.1], [0.0]).unwrap();
    scene.advance_ticks(80);
    // Ten batches, each of which samples constant derivatives once.
    assert!(asked.load(Ordering::Relaxed) <= 10);
    assert_eq!(scene.state(handle), scene.state(free));
}

#[test]
fn fast_pendulums_do_not_hurry_slow_ones() {
    let mut scene = Scene::<f64>::new(100.0).unwrap();
    let counters = [Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0))];
    let joints = counters.each_ref().map(|counter| scene.joint(Watched(counter.clone())));
    // The frequencies are 3 rad/s and 140 rad/s.
    let slow = scene.hang(joints[0], Hanging::new(0.1, 1.0), [0.1], [0.0]).unwrap();
    scene.hang(joints[1], Hanging::new(0.1, 0.0005), [0.1], [0.0]).unwrap();
    for counter in &counters {
        counter.store(0, Ordering::Relaxed);
    }
    scene.advance_ticks(80);
    let asked = counters.each_ref().map(|counter| counter.load(Ordering::Relaxed));
    assert_eq!(asked[0], 80);
    assert!(6 * 80 <= asked[1], "{asked:?}");
    let mut alone = Scene::<f64>::new(100.0).unwrap();
    let joint = alone.joint(Watched(counters[0].clone()));
    let handle = alone.hang(joint, Hanging::new(0.1, 1.0), [0.1], [0.0]).unwrap();
    alone.advance_ticks(80);
    assert_eq!(alone.state(handle), scene.state(slow));
}

/// ẍ = −k x, written by hand to count the preparations of its parameters.
mod counted {
    use super::{AtomicUsize, Ordering};
    use pendulum_runtime::scalar::{Lanes, Real};
    use pendulum_runtime::system::{At, Facts, Staged, System};

    /// The numbers of preparations of single systems and of blocks.
    pub(crate) static PREPARED: [AtomicUsize; 2] = [AtomicUsize::new(0), AtomicUsize::new(0)];

    #[derive(Clone, Copy, Debug)]
    pub(crate) struct Spring<T> {
        pub(crate) k: T,
    }

    impl<T: Real> System<1> for Spring<T> {
        type Scalar = T;
        type Inputs = ();
        type With<U: Real> = Spring<U>;
        type Prepared = T;

        const FACTS: Facts = {
            let mut facts = Facts::new("Spring", &["x"]);
            facts.parameters = &["k"];
            facts
        };

        fn map<U: Real>(&self, mut map: impl FnMut(T) -> U) -> Spring<U> {
            Spring { k: map(self.k) }
        }

        fn prepare(&self) -> T {
            let block = size_of::<T>() == size_of::<Lanes<f64, 32>>();
            PREPARED[usize::from(block)].fetch_add(1, Ordering::Relaxed);
            -self.k
        }

        fn accelerations_prepared(&self, prepared: &T, At { q, .. }: At<'_, T, (), 1>) -> [T; 1] {
            [*prepared * q[0]]
        }

        fn accelerations(&self, At { t, q, v, .. }: At<'_, T, (), 1>) -> [T; 1] {
            self.accelerations_prepared(&self.prepare(), At::of(t, q, v))
        }

        fn energy(&self, _: At<'_, T, (), 1>) -> T {
            unreachable!("nobody sleeps")
        }

        fn power(&self, _: At<'_, T, (), 1>) -> T {
            unreachable!("nobody asks for the power")
        }

        fn momenta(&self, _: At<'_, T, (), 1>) -> [T; 1] {
            unreachable!("nothing has a kink")
        }

        fn velocities(&self, _: T, _: &[T; 1], _: &[T; 1], (): &()) -> [T; 1] {
            unreachable!("nothing has a kink")
        }

        fn mass_matrix(&self, _: At<'_, T, (), 1>) -> nalgebra::SMatrix<T, 1, 1> {
            unreachable!("nobody asks for the mass matrix")
        }

        fn forces(&self, _: At<'_, T, (), 1>) -> [T; 1] {
            unreachable!("nobody asks for the forces")
        }

        fn momentum_rates(&self, _: At<'_, T, (), 1>) -> [T; 1] {
            unreachable!("nobody asks for the momentum rates")
        }
    }

    impl<T: Real> Staged<1> for Spring<T> {
        type AtTime = ();
        type AtPosition = ();

        fn at_time(_: T, (): &()) {}

        fn at_position(&self, _: &T, (): &(), _: T, _: &[T; 1], (): &()) {}

        fn accelerations_staged(
            &self,
            prepared: &T,
            (): &(),
            (): &(),
            t: T,
            q: &[T; 1],
            v: &[T; 1],
            (): &(),
        ) -> [T; 1] {
            self.accelerations_prepared(prepared, At::of(t, q, v))
        }
    }
}

#[test]
fn what_parameters_decide_is_computed_once() {
    use counted::{PREPARED, Spring};
    let prepared = || PREPARED.each_ref().map(|count| count.load(Ordering::Relaxed));
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    // Four blocks, the last of which has 4 lanes.
    let stiffness = |index: usize| 1.0 + 0.03 * index as f64;
    let handles: Vec<_> = (0..100)
        .map(|index| scene.hang((), Spring { k: stiffness(index) }, [1.0], [0.0]).unwrap())
        .collect();
    scene.advance_ticks(8);
    let once = prepared();
    // Each block is prepared when it is created and when it is filled.
    assert!((4..=8).contains(&once[1]), "{once:?}");
    for _ in 0..148 {
        scene.advance(1.0 / 60.0).unwrap();
    }
    assert_eq!((scene.tick(), prepared()), (600, once));
    // Steps are chosen again for one pendulum, and only its block is prepared again, once.
    scene.set_parameter(handles[40], "k", 9.0).unwrap();
    for _ in 0..60 {
        scene.advance(1.0 / 60.0).unwrap();
    }
    assert_eq!((scene.tick(), prepared()), (840, [once[0] + 1, once[1] + 1]));
    for (index, &handle) in handles.iter().enumerate() {
        let (ω, before, after) = (stiffness(index).sqrt(), 2.5, 1.0);
        let expected = if index == 40 {
            (ω * before).cos() * (3.0 * after).cos()
                - ω / 3.0 * (ω * before).sin() * (3.0 * after).sin()
        } else {
            (ω * (before + after)).cos()
        };
        let (q, _) = scene.state(handle);
        assert!((q[0] - expected).abs() < 1e-7, "{index}: {} for {expected}", q[0]);
    }
}

/// Compares forty pendulums, of which number k hangs on joint `pattern(k)`, bit by bit with single
/// pendulums.
macro_rules! neighbours {
    ($name:ident, $float:ident) => {
        fn $name<
            M: Fixed<Hanging<$float>, 1> + Method<Driven<Hanging<$float>, (Sinusoid<2>,)>, 1>,
        >(
            method: M,
            pattern: fn(usize) -> usize,
        ) {
            // Ticks are exact in binary, so that scenes and solvers use the same times.
            let mut scene = Scene::<$float>::new(256.0).unwrap();
            scene.set_tolerance(1e-2).unwrap();
            let mut random = Random::new(11);
            let motion = |joint: usize| {
                Sinusoid::new([0.05, 0.02], 5.0 + 0.3 * joint as f64, [0.1 * joint as f64, 1.0])
            };
            let joints: Vec<_> = (0..40).map(|joint| scene.joint(motion(joint))).collect();
            let mut number = |low, high| random.uniform(low, high) as $float;
            let all: Vec<_> =
                (0..40).map(|_| (number(0.3, 2.0), number(-2.0, 2.0), number(-2.0, 2.0))).collect();
            let hang = |(k, &(length, q, v)): (usize, &($float, $float, $float))| {
                scene.hang(joints[pattern(k)], Hanging::new(0.1, length), [q], [v]).unwrap()
            };
            let handles: Vec<_> = all.iter().enumerate().map(hang).collect();
            scene.set_method::<Hanging<$float>, 1, M>(method).unwrap();
            scene.advance(0.375).unwrap();
            for (k, &(length, q, v)) in all.iter().enumerate() {
                let alone = Hanging::<$float>::new(0.1, length).driven_by(motion(pattern(k)));
                let whole =
                    solve(&alone, (0.0, 0.375), [q], [v]).method(method).steps(96).run().unwrap();
                assert_eq!(scene.state(handles[k]), (whole.end.q, whole.end.v), "{k}");
            }
        }
    };
}

neighbours!(same_as_alone_f64, f64);
neighbours!(same_as_alone_f32, f32);

#[test]
fn neighbours_on_joints_do_not_show() {
    // One joint for all pendulums; ten, four (eight joints in a block), three (eleven joints in a
    // block) and one pendulum on each joint; two alternating joints.
    let patterns: [fn(usize) -> usize; 6] =
        [|_| 0, |k| k / 10, |k| k / 4, |k| k / 3, |k| k, |k| k % 2];
    for pattern in patterns {
        same_as_alone_f64(Leapfrog, pattern);
        same_as_alone_f64(Srkn6b, pattern);
        same_as_alone_f64(Rk4, pattern);
        same_as_alone_f32(Leapfrog, pattern);
        same_as_alone_f32(Srkn6b, pattern);
        same_as_alone_f32(Rk4, pattern);
    }
}
