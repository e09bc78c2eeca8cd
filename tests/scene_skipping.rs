//! Scenes compute once what many need, and nothing that nobody needs.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::motion::{Motion, Orders, Sample, Side, Sinusoid};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::Scene;
use pendulum_runtime::time::Time;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

#[path = "common/pendulums.rs"]
mod pendulums;

use pendulums::{Double, Hanging, Simple};

/// A motion that counts how often it is asked, and refuses what no equation contains.
#[derive(Clone)]
struct Watched(Arc<AtomicUsize>);

impl Motion<f64, 2> for Watched {
    const HAS: Orders = Orders::ALL;

    fn sample(&self, t: Time, side: Side, orders: Orders) -> Sample<f64, 2> {
        assert!(orders == Orders::ACCELERATION || orders == Orders::NONE, "asked for {orders:?}");
        self.0.fetch_add(1, Ordering::Relaxed);
        Motion::<f64, 2>::sample(&Sinusoid::new([0.1, 0.0], 5.0, [0.0, 0.0]), t, side, orders)
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

#[test]
fn joints_are_asked_once_per_time_for_what_is_needed() {
    let mut scene = Scene::<f64>::new(100.0).unwrap();
    let asked = Arc::new(AtomicUsize::new(0));
    let joint = scene.joint(Watched(asked.clone()));
    for index in 0..100 {
        scene.hang(joint, Hanging::new(0.1, 1.0 + 0.01 * f64::from(index)), [0.1], [0.0]).unwrap();
    }
    asked.store(0, Ordering::Relaxed);
    scene.advance_ticks(50);
    assert_eq!(asked.load(Ordering::Relaxed), 50);
    // RK4 looks at the middle too, where the sample is there already, and at both ends, of which each is asked for once in a batch.
    scene.hang(joint, Double::new(0.1, 1.0, 0.0), [0.1, 0.0], [0.0, 0.0]).unwrap();
    asked.store(0, Ordering::Relaxed);
    scene.advance_ticks(8);
    assert_eq!(asked.load(Ordering::Relaxed), 8 + 9);
}

/// A motion that rests and must not be asked while the scene runs.
#[derive(Clone)]
struct Asleep(Arc<AtomicUsize>);

impl Motion<f64, 2> for Asleep {
    const HAS: Orders = Orders::ALL;

    fn sample(&self, _: Time, _: Side, orders: Orders) -> Sample<f64, 2> {
        if orders.contains(Orders::ACCELERATION) || orders.contains(Orders::VELOCITY) {
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
    // Ten batches; each reads once what never changes.
    assert!(asked.load(Ordering::Relaxed) <= 10);
    assert_eq!(scene.state(handle), scene.state(free));
}

#[test]
fn fast_pendulums_do_not_hurry_slow_ones() {
    let mut scene = Scene::<f64>::new(100.0).unwrap();
    let counters = [Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0))];
    let joints = counters.each_ref().map(|counter| scene.joint(Watched(counter.clone())));
    // 3 rad/s and 140 rad/s.
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
