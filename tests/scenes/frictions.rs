//! Dry friction of blocks in scenes: stick and slip with the bits of single runs, and rest.

use crate::contacts::{RATE, alone, scene, sway};
use pendulum_runtime::error::Error;
use pendulum_runtime::motion::{Curve, Still};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Float;
use pendulum_runtime::scene::{Handle, Scene, SceneStatus};

lagrangian! {
    /// A pendulum on a moving joint whose pin rubs.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Rusty { m: kg, L: m, M: N*m, S: N*m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L*[sin(θ), -cos(θ)];
    kinetic = m/2*|ẏ|^2;
    potential = m*g*height(y);
    friction pin: θ̇, force = M, static = S;
    output tip: [m; 2] = y;
}

lagrangian! {
    /// A block on a belt and a spring, pushed by a jet.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Sled { m: kg, k: N/m, F: N, S: N }
    coordinate x: m;
    driven belt: m;
    input jet: N;
    kinetic = m/2*ẋ^2;
    potential = k/2*x^2;
    force x = jet;
    friction sole: ẋ - dot(belt), force = F, static = S;
}

lagrangian! {
    /// A puck on a plate that moves in its plane, on a spring.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Puck { m: kg, k: N/m, F: N }
    coordinate p: [m; 2];
    driven plate: [m; 2];
    kinetic = m/2*|dot(p)|^2;
    potential = k/2*|p|^2;
    friction grip: dot(p) - dot(plate), force = F;
}

lagrangian! {
    /// A block that is thrown onto a rough floor.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Thrown { m: kg, μ: 1, e: 1, g: m/s^2 = 9.81 }
    coordinate p: [m; 2];
    kinetic = m/2*|dot(p)|^2;
    potential = m*g*p.y;
    limit floor: p.y >= 0, restitution = e, friction = μ along dot(p).x;
}

#[test]
fn pendulums_on_rusty_pins_have_the_bits_of_single_runs() {
    fn same<T: Float>() {
        let number = T::from_f64;
        let mut scene = scene::<T>();
        let joint = scene.joint(sway());
        // Some never stick, others more and more often.
        let start = |k: u32| {
            let force = number(0.02 * f64::from(k));
            Rusty::new(number(0.3), number(0.5), force, force * number(1.3))
        };
        let all: Vec<Handle<Rusty<T>, 1>> = (0..40)
            .map(|k| scene.hang(joint, start(k), [number(0.3)], [number(0.0)]).unwrap())
            .collect();
        let mut seen = vec![Vec::new(); 40];
        for _ in 0..2 * RATE {
            scene.advance_ticks(1);
            for (handle, seen) in all.iter().zip(&mut seen) {
                seen.push(scene.state(*handle));
            }
        }
        assert!(scene.faults().is_empty(), "{:?}", scene.faults());
        let stuck = |states: &[([T; 1], [T; 1])]| {
            states.iter().filter(|(_, [rate])| *rate == number(0.0)).count()
        };
        for k in 0..40 {
            let single = alone(&start(k).driven_by(sway()), 2 * RATE, [number(0.3)], [number(0.0)]);
            assert_eq!(seen[k as usize], single, "{k}");
        }
        let counts: Vec<usize> = seen.iter().map(|own| stuck(own)).collect();
        let at_times = counts.iter().filter(|count| (2..400).contains(*count)).count();
        assert!(counts[0] == 0 && 60 < counts[39] && 3 < at_times, "{counts:?}");
    }
    same::<f64>();
    same::<f32>();
}

#[test]
fn blocks_on_belts_plates_and_floors_have_the_bits_of_single_runs() {
    let mut scene = scene::<f64>();
    let (plate, slope) = (scene.joint(sway()), [[0.0], [0.4], [0.1]]);
    let belt = || Curve::linear(&[0.0, 1.5, 3.0], &slope).unwrap();
    let joint = scene.joint(belt());
    let sled = Sled::new(0.5, 20.0, 1.0, 1.5);
    let puck = Puck::new(0.3, 5.0, 1.5);
    let thrown = Thrown::new(0.3, 0.4, 0.5);
    let on_belt = scene.hang(joint, sled.clone(), [0.0], [0.0]).unwrap();
    let on_plate = scene.hang(plate, puck.clone(), [0.3, 0.1], [0.0, 1.0]).unwrap();
    let on_floor = scene.hang((), thrown.clone(), [0.0, 0.5], [2.0, 1.0]).unwrap();
    let (ticks, none) = (4 * RATE, |_: f64, _: &[f64; 1], _: &[f64; 1]| 0.0);
    let sled = alone(&sled.driven_by(belt()).controlled_by(none), ticks, [0.0], [0.0]);
    let puck = alone(&puck.driven_by(sway()), ticks, [0.3, 0.1], [0.0, 1.0]);
    let thrown = alone(&thrown, ticks, [0.0, 0.5], [2.0, 1.0]);
    let mut rests = [0; 3];
    for tick in 0..ticks as usize {
        scene.advance_ticks(1);
        assert_eq!(scene.state(on_belt), sled[tick], "{tick}");
        assert_eq!(scene.state(on_plate), puck[tick], "{tick}");
        assert_eq!(scene.state(on_floor), thrown[tick], "{tick}");
        rests[0] += u32::from((sled[tick].1[0] - 0.4 / 1.5).abs() < 1e-15);
        rests[2] += u32::from(thrown[tick].1 == [0.0; 2]);
    }
    assert!(scene.faults().is_empty(), "{:?}", scene.faults());
    assert!(20 < rests[0] && 20 < rests[2], "{rests:?}");
}

#[test]
fn what_friction_holds_sleeps_where_it_is_and_wakes_with_its_joint() {
    let run = |sleep: bool| {
        let mut scene = scene::<f64>();
        scene.set_sleep(sleep.then_some(1e-3)).unwrap();
        let keys = [[0.0, 0.0], [0.0, 0.0], [3.0, 0.0]];
        let joint = scene.joint(Curve::linear(&[0.0, 8.0, 9.0], &keys).unwrap());
        let rusty = Rusty::new(0.3, 0.5, 0.4, 0.5);
        let handle = scene.hang(joint, rusty, [0.8], [0.0]).unwrap();
        scene.advance(7.0).unwrap();
        let (status, held) = (scene.status(handle), scene.state(handle));
        scene.advance(2.0).unwrap();
        (status, held, scene.state(handle))
    };
    let (asleep, held, after) = run(true);
    assert!(matches!(asleep, SceneStatus::Asleep(_)), "{asleep:?}");
    // Far from where it would hang: m g L sin θ is at most the bound.
    assert!(0.05 < held.0[0].abs() && 0.3 * 9.81 * 0.5 * held.0[0].abs().sin() < 0.5, "{held:?}");
    assert_eq!(held.1, [0.0]);
    let (awake, same, other) = run(false);
    assert_eq!((awake, same), (SceneStatus::Awake, held));
    assert_eq!(after, other);
}

#[test]
fn a_jet_tears_a_block_off_its_belt() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    scene.set_sleep(Some(1e-3)).unwrap();
    let belt = scene.joint(Still::new([0.0]));
    let sled = scene.hang(belt, Sled::new(0.5, 0.0, 0.6, 1.0), [0.2], [0.0]).unwrap();
    scene.set_inputs(sled, 0.99).unwrap();
    scene.advance(1.0).unwrap();
    assert_eq!(scene.state(sled), ([0.2], [0.0]));
    scene.set_inputs(sled, 1.1).unwrap();
    scene.advance(1.0).unwrap();
    // It slides with (1.1 − 0.6)/m.
    let ([x], [v]) = scene.state(sled);
    assert!((x - 0.7).abs() < 1e-12 && (v - 1.0).abs() < 1e-12, "{x} {v}");
    scene.set_inputs(sled, 0.0).unwrap();
    scene.advance(3.0).unwrap();
    // It stops after m v/F.
    let ([x], [v]) = scene.state(sled);
    assert!((x - (0.7 + 0.5 / 1.2)).abs() < 1e-12 && v == 0.0, "{x} {v}");
    assert!(matches!(scene.status(sled), SceneStatus::Asleep(_)));
}

#[test]
fn what_is_restored_while_it_sticks_goes_on_as_before() {
    let build = || {
        let mut scene = scene::<f64>();
        let joint = scene.joint(sway());
        let rusty = Rusty::new(0.3, 0.5, 0.6, 0.8);
        (scene.hang(joint, rusty, [0.3], [0.0]).unwrap(), scene)
    };
    let (handle, mut scene) = build();
    let mut modes = [0, 0];
    for _ in 0..100 {
        scene.advance_ticks(3);
        modes[usize::from(scene.state(handle).1 == [0.0])] += 1;
        let kept = scene.snapshot();
        scene.advance_ticks(40);
        let after = scene.snapshot();
        scene.restore(&kept).unwrap();
        scene.advance_ticks(40);
        assert_eq!(scene.snapshot(), after);
        let (_, mut other) = build();
        other.restore(&kept).unwrap();
        other.advance_ticks(40);
        assert_eq!(other.checksum(), after.checksum());
        scene.restore(&kept).unwrap();
    }
    assert!(modes.iter().all(|count| 5 < *count), "{modes:?}");
}

#[test]
fn a_negative_magnitude_is_a_fault_with_its_name() {
    let mut scene = scene::<f64>();
    let belt = scene.joint(Still::new([0.0]));
    let sled = Sled::new(0.5, 1.0, -0.6, 0.0);
    let handle = scene.hang(belt, sled, [0.2], [1.0]).unwrap();
    scene.advance_ticks(1);
    assert_eq!(scene.status(handle), SceneStatus::Failed);
    let error = &scene.faults()[0].error;
    assert!(matches!(error, Error::NegativeFriction { friction: "sole", .. }), "{error}");
}

#[test]
fn a_joint_carried_by_a_pendulum_that_sticks_rests() {
    let mut scene = scene::<f64>();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    let rusty = scene.hang(joint, Rusty::new(0.3, 0.5, 2.0, 2.0), [0.5], [0.0]).unwrap();
    let tip = scene.joint_on::<_, 1, 2>(rusty, "tip").unwrap();
    let loose = || Rusty::new(0.1, 0.3, 0.0, 0.0);
    let hung = scene.hang(tip, loose(), [0.2], [0.0]).unwrap();
    let other = scene.hang(joint, loose(), [0.2], [0.0]).unwrap();
    scene.advance(1.0).unwrap();
    let ([a], [b]) = (scene.state(hung).0, scene.state(other).0);
    assert!((a - b).abs() < 1e-14, "{a} for {b}");
}
