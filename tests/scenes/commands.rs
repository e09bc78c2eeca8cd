//! Requests to scenes: commands, loops, baking, snapshots.

use super::interface::{states, zoo};
use pendulum_runtime::motion::{Curve, Sinusoid, Still};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Preserve, Scene, SceneError, SceneStatus};
use systems::pendulums::{Double, Hanging, Simple};

#[test]
fn what_is_refused_changes_nothing() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    scene.hang(joint, Hanging::new(0.1, 1.0), [0.1], [0.0]).unwrap();
    let snapshot = scene.snapshot();
    assert!(scene.hang((), Simple::new(0.1, 1.0), [f64::NAN], [0.0]).is_err());
    assert_eq!(scene.snapshot(), snapshot);
    scene.restore(&snapshot).unwrap();
}

#[test]
fn tolerances_are_those_of_the_time_of_hanging() {
    let swing = |before: bool| {
        let mut scene = Scene::<f64>::new(60.0).unwrap();
        if before {
            scene.hang((), Simple::new(0.1, 0.1), [0.3], [0.0]).unwrap();
        }
        scene.set_tolerance(1e-10).unwrap();
        let handle = scene.hang((), Simple::new(0.1, 0.1), [1.0], [0.0]).unwrap();
        scene.set_tolerance(1e-2).unwrap();
        // Steps are chosen again, with the tolerance at the time of hanging.
        scene.set_parameter(handle, "g", 9.81).unwrap();
        scene.advance_ticks(600);
        scene.state(handle)
    };
    assert_eq!(swing(true), swing(false));
}

#[test]
fn scenes_go_back_to_when_joints_still_moved() {
    let pose = |last: &[f64]| {
        let (mut times, mut values) =
            (vec![-1.0, -0.5, -0.2], vec![[0.0, 0.0], [0.3, 0.0], [0.0, 0.0]]);
        for &time in last {
            times.push(time);
            values.push([0.0, 0.0]);
        }
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        let joint = scene.joint(Curve::linear(&times, &values).unwrap());
        let handle = scene.hang(joint, Hanging::new(0.1, 0.3), [0.0], [0.0]).unwrap();
        scene.warm_up(2.0).unwrap();
        scene.state(handle)
    };
    assert_eq!(pose(&[]), pose(&[1e6]));
    assert!(pose(&[]).0[0].abs() > 0.1);
}

#[test]
fn failures_stand_in_the_order_of_time() {
    use pendulum_runtime::motion::Function;
    let failures = |ticks: u32| {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        let mut bad = |ticks: f64| {
            let a = move |t| [if ticks / 240.0 < t { f64::NAN } else { 0.0 }, 0.0];
            scene.joint(Function::new(|_| [0.0, 0.0]).velocity(|_| [0.0, 0.0]).acceleration(a))
        };
        let (late, soon) = (bad(5.0), bad(2.0));
        scene.hang(late, Hanging::new(0.1, 0.3), [0.1], [0.0]).unwrap();
        scene.hang(soon, Double::new(0.1, 0.3, 0.0), [0.1, 0.0], [0.0, 0.0]).unwrap();
        for _ in 0..8 / ticks {
            scene.advance_ticks(ticks);
        }
        scene.faults().iter().map(|failure| (failure.kind, failure.t)).collect::<Vec<_>>()
    };
    assert_eq!(failures(8), failures(1));
    assert_eq!(
        failures(8).iter().map(|(kind, _)| *kind).collect::<Vec<_>>(),
        ["Double", "Hanging"]
    );
}

#[test]
fn only_the_one_that_is_meant_is_reset() {
    mod other {
        pendulum_runtime::lagrangian! {
            pub struct Simple { m: kg, L: m, g: m/s^2 = 9.81 }
            coordinate θ: rad;
            kinetic = m*L^2/2 * θ̇^2;
            potential = -m*g*L*cos(θ);
        }
    }
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let first = scene.hang((), Simple::new(0.1, 0.0), [0.2], [0.0]).unwrap();
    let second = scene.hang((), other::Simple::new(0.1, 1.0), [0.7], [0.0]).unwrap();
    // A failed pendulum swings again after a command.
    scene.advance_ticks(1);
    assert_eq!(scene.status(first), SceneStatus::Failed);
    assert!(scene.reset_to_rest(first).is_err());
    scene.set_parameter(first, "L", 1.0).unwrap();
    let before = scene.state(second);
    scene.reset_to_rest(first).unwrap();
    assert_eq!((scene.state(second), scene.status(first)), (before, SceneStatus::Awake));
    assert!(scene.state(first).0[0].abs() < 1e-12);
}

#[test]
fn directors_get_what_they_ask_for() {
    let mut scene = zoo(1e-3);
    let handle = scene.handle::<Hanging<f64>, 1>(4).unwrap();
    let double = scene.handle::<Double<f64>, 2>(3).unwrap();
    scene.advance(0.3).unwrap();
    // Reset to rest.
    scene.reset_to_rest(handle).unwrap();
    let (q, v) = scene.state(handle);
    assert!((q[0] / std::f64::consts::TAU).fract().abs() < 1e-9 && v == [0.0], "{q:?}");
    scene.reset_all_to_rest().unwrap();
    let (q, v) = scene.state(double);
    assert!(q.iter().all(|q| q.sin().abs() < 1e-9 && 0.0 < q.cos()) && v == [0.0, 0.0], "{q:?}");
    // Mirror.
    scene.advance(0.3).unwrap();
    let (q, v) = scene.state(double);
    scene.mirror(double, [-1.0, -1.0]).unwrap();
    assert_eq!(scene.state(double), (q.map(|q| -q), v.map(|v| -v)));
    // Gravity of all pendulums, by name; no state is reset.
    let before = states(&scene);
    assert_eq!(scene.set_parameter_everywhere("g", 1.62).unwrap(), 100 + 3 * 34);
    assert_eq!(states(&scene), before);
    assert_eq!(scene.system(handle).g, 1.62);
    assert!(matches!(scene.set_parameter_everywhere("h", 1.0), Err(SceneError::Parameter { .. })));
    scene.set_parameter(handle, "L", 0.25).unwrap();
    assert_eq!(scene.system(handle).L, 0.25);
    // Pause.
    scene.set_paused(true);
    assert_eq!(scene.advance(5.0).unwrap().ticks, 0);
    assert_eq!(scene.system(handle).L, 0.25);
    scene.set_paused(false);
    // Another motion, with each way of preserving the state.
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    let handle = scene.hang(joint, Hanging::new(0.1, 0.5), [0.2], [0.1]).unwrap();
    let away = Curve::linear(&[-1.0, 9.0], &[[0.0, 0.0], [20.0, 0.0]]).unwrap();
    scene.set_motion(joint, away.clone(), Preserve::Swing).unwrap();
    assert_eq!(scene.state(handle), ([0.2], [0.1]));
    scene.set_motion(joint, Still::new([7.0, 0.0]), Preserve::Swing).unwrap();
    scene.set_motion(joint, away, Preserve::Momentum).unwrap();
    // Δθ̇ = −Δẋ cos θ / L.
    assert!((scene.state(handle).1[0] - (0.1 - 2.0 * 0.2f64.cos() / 0.5)).abs() < 1e-14);
    scene.set_motion(joint, Still::new([7.0, 0.0]), Preserve::Nothing).unwrap();
    assert_eq!(scene.state(handle).1, [0.0]);
    assert!(scene.state(handle).0[0].abs() < 1e-12);
}

lagrangian! {
    /// A bead on a wire that two joints carry.
    pub struct Bead { m: kg }
    coordinate u: m;
    driven a: m;
    driven b: m;
    kinetic = m/2 * (u̇ + ȧ + ḃ)^2;
}

/// A new motion per frame at the same speed is no jump, although each motion ends in one.
#[test]
fn a_motion_that_is_continued_gives_no_impulse() {
    use pendulum_runtime::motion::{Attenuated, Curve, Function, Motion, Projected};
    const FRAME: f64 = 1.0 / 60.0;
    fn steady<M: Motion<f64, 2> + Send + Sync + 'static>(part: impl Fn(f64) -> M) {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        let joint = scene.joint(part(0.0));
        let free = Hanging { g: 0.0, ..Hanging::new(0.1, 1.0) };
        let handle = scene.hang(joint, free, [0.3], [0.0]).unwrap();
        for frame in 1..=30 {
            scene.advance_ticks(4);
            // The joint has stopped: Δθ̇ = Δẋ cos θ / L.
            let kick = scene.state(handle).1[0];
            assert!((kick - scene.state(handle).0[0].cos()).abs() < 1e-9, "{frame}: {kick}");
            let part = part(f64::from(frame) / 60.0);
            scene.set_motion(joint, part, Preserve::Momentum).unwrap();
            let (q, v) = scene.state(handle);
            assert!((q[0] - 0.3).abs() < 1e-9 && v[0].abs() < 1e-9, "{frame}: {q:?} {v:?}");
        }
    }
    let line = |t: f64| Curve::linear(&[t, t + FRAME], &[[t, 0.0], [t + FRAME, 0.0]]).unwrap();
    steady(line);
    steady(|t| Attenuated::new(line(t), 1.0, 2.0).unwrap());
    steady(|t| {
        let line = Curve::linear(&[t, t + FRAME], &[[0.0, t, 0.0], [0.0, t + FRAME, 0.0]]).unwrap();
        Projected::new(line, [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    });
    steady(|t| {
        let moves = move |at: f64| t <= at && at < t + FRAME;
        Function::new(move |at: f64| [at.clamp(t, t + FRAME), 0.0])
            .velocity(move |at| [if moves(at) { 1.0 } else { 0.0 }, 0.0])
            .acceleration(|_| [0.0, 0.0])
            .kinks(&[t, t + FRAME])
    });
    // The end of a clip stops the joint once.
    let clip = Curve::linear(&[0.0, FRAME], &[[0.0, 0.0], [FRAME, 0.0]]).unwrap();
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let joint = scene.joint(clip);
    let free = Hanging { g: 0.0, ..Hanging::new(0.1, 1.0) };
    let handle = scene.hang(joint, free, [0.0], [0.0]).unwrap();
    scene.advance_ticks(4);
    let after = scene.state(handle);
    scene.set_motion(joint, Still::new([FRAME, 0.0]), Preserve::Momentum).unwrap();
    assert_eq!(scene.state(handle), after);
    assert!((after.1[0] - 1.0).abs() < 1e-12, "{after:?}");
}

#[test]
fn the_kink_of_another_joint_is_not_felt_twice() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let line = |slope: f64| Curve::linear(&[-1.0, 0.25], &[[0.0], [1.25 * slope]]).unwrap();
    let (a, b) = (scene.joint(line(1.0)), scene.joint(line(2.0)));
    let handle = scene.hang((a, b), Bead::new(0.1), [0.0], [0.5]).unwrap();
    scene.advance_ticks(60);
    // Both joints have stopped.
    assert!((scene.state(handle).1[0] - 3.5).abs() < 1e-12);
    for (slope, expected) in [(0.0, 3.5), (-4.0, 7.5), (1.0, 2.5)] {
        let moves = Curve::linear(&[0.0, 1.0], &[[0.0], [slope]]).unwrap();
        scene.set_motion(a, moves, Preserve::Momentum).unwrap();
        assert!((scene.state(handle).1[0] - expected).abs() < 1e-12, "{slope}");
        assert_eq!(scene.state(handle).0[0], scene.pose(handle, 1.0)[0]);
    }
    scene.set_motion(b, line(2.0), Preserve::Momentum).unwrap();
    assert!((scene.state(handle).1[0] - 2.5).abs() < 1e-12);
}

#[test]
fn loops_close() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let joint = scene.joint(Sinusoid::new([0.05, 0.0], std::f64::consts::TAU * 1.5, [0.0, 0.0]));
    let handle = scene.hang(joint, Hanging::new(0.1, 0.3), [0.4], [0.0]).unwrap();
    scene.set_damping(handle, 2.0).unwrap();
    let closed = scene.close_loop(160, 100, 1e-12).unwrap();
    assert!(closed.gap <= 1e-12 && closed.turns < 60, "{closed:?}");
    assert_eq!(scene.tick(), 0);
    let start = scene.state(handle);
    scene.advance_ticks(160);
    let end = scene.state(handle);
    assert!((end.0[0] - start.0[0]).abs() < 1e-12 && (end.1[0] - start.1[0]).abs() < 1e-11);
    // A warm-up of the same duration leads to the same state.
    scene.set_state(handle, [0.0], [0.0]).unwrap();
    scene.warm_up(20.0).unwrap();
    assert_eq!(scene.tick(), 160);
    assert!((scene.state(handle).0[0] - end.0[0]).abs() < 1e-8);
}

/// Closes a loop of `ticks` ticks, and returns the gap with the jumps of coordinate and velocity
/// when the loop is played.
fn closed<T: pendulum_runtime::scalar::Float>(
    rate: f64,
    ticks: u32,
    motion: impl pendulum_runtime::motion::Motion<T, 2> + Send + Sync + 'static,
    tolerance: f64,
) -> [f64; 3]
where
    Hanging<T>: pendulum_runtime::scene::SceneSystem<
            T,
            1,
            Inputs = (pendulum_runtime::motion::Sample<T, 2>,),
        >,
{
    let mut scene = Scene::<T>::new(rate).unwrap();
    let joint = scene.joint(motion);
    let hanging = Hanging::new(T::from_f64(0.1), T::from_f64(0.3));
    let number = T::from_f64;
    let handle = scene.hang(joint, hanging, [number(0.4)], [number(0.0)]).unwrap();
    scene.set_damping(handle, 14.0).unwrap();
    let closed = scene.close_loop(ticks, 20, tolerance).unwrap();
    let (start, tick) = (scene.state(handle), scene.tick());
    assert_eq!(tick, 0);
    scene.advance_ticks(ticks);
    let end = scene.state(handle);
    let apart = |a: [T; 1], b: [T; 1]| (a[0] - b[0]).to_f64().abs();
    [closed.gap, apart(start.0, end.0), apart(start.1, end.1)]
}

#[test]
fn loops_close_at_the_seam_of_a_rounded_period() {
    // The joint turns back in the middle and at the seam of its period.
    let there_and_back = |period: f64| {
        let keys = [[0.0, 0.0], [0.05, 0.02], [0.0, 0.0]];
        Curve::linear(&[0.0, 0.4 * period, period], &keys).unwrap().looped().unwrap()
    };
    for (rate, ticks, period) in [
        (240.0, 120, 0.5),
        (240.0, 120, 0.5 - 3e-8),
        (240.0, 120, 0.5 + 3e-8),
        (60.0, 48, f64::from(0.8_f32)),
        (240.0, 176, f64::from(22.0 / 30.0_f32)),
        (1000.0, 700, f64::from(0.7_f32)),
        (30.0, 40, f64::from(40.0 / 30.0_f32)),
    ] {
        let [gap, q, v] = closed::<f64>(rate, ticks, there_and_back(period), 1e-7);
        assert!(gap <= 1e-7 && q <= 1e-6 && v < 1e-5, "{period}: {gap} {q} {v}");
        let [gap, q, v] = closed::<f32>(rate, ticks, there_and_back(period), 1e-5);
        assert!(gap <= 1e-5 && q <= 1e-4 && v < 1e-3, "{period}: {gap} {q} {v}");
    }
}

/// A coordinate may pass its beginning with another velocity.
#[test]
fn closed_loops_return_within_their_gap() {
    for case in 0..40 {
        let part = |factor: f64| (f64::from(case + 1) * factor).fract();
        let ticks = 30 + (200.0 * part(0.6180339887)) as u32;
        let period = f64::from(ticks) / 240.0;
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        let handles = [1.0, 2.0].map(|times| {
            let rate = times * std::f64::consts::TAU / period;
            let joint = scene.joint(Sinusoid::new([0.03, 0.0], rate, [case.into(), 0.0]));
            let length = 0.1 + part(0.4142135623) * times;
            let handle = scene.hang(joint, Hanging::new(0.1, length), [0.4], [0.0]).unwrap();
            scene.set_damping(handle, 0.5 + 4.0 * part(0.7320508075)).unwrap();
            handle
        });
        let tolerance = 10f64.powf(-4.0 - 6.0 * part(0.2360679775));
        let gap = scene.close_loop(ticks, 2000, tolerance).unwrap().gap;
        let begin = handles.map(|handle| scene.state(handle).0[0]);
        scene.advance_ticks(ticks);
        for (handle, begin) in handles.into_iter().zip(begin) {
            let jump = (scene.state(handle).0[0] - begin).abs();
            assert!(jump <= gap + 1e-14 && gap <= tolerance, "{case}: {jump:e} for {gap:e}");
        }
    }
}

#[test]
fn loops_that_are_no_period_do_not_close() {
    let sway = |period: f64| Sinusoid::new([0.05, 0.0], std::f64::consts::TAU / period, [0.0, 0.0]);
    let line = |at: f64| {
        let keys = [[0.0, 0.0], [at, 0.0], [0.0, 0.0]];
        Curve::linear(&[0.0, 0.1, 0.5], &keys).unwrap().looped().unwrap()
    };
    for ticks in [90, 119, 130, 60] {
        let [gap, ..] = closed::<f64>(240.0, ticks, sway(0.5), 1e-7);
        assert!(gap > 1e-3, "{ticks}: {gap}");
    }
    for ticks in [60, 90, 119, 210] {
        let [gap, ..] = closed::<f64>(240.0, ticks, line(0.05), 1e-7);
        assert!(gap > 1e-3, "{ticks}: {gap}");
    }
    let [gap, q, _] = closed::<f64>(240.0, 120, sway(0.5), 1e-7);
    assert!(gap <= 1e-7 && q <= 1e-6, "{gap} {q}");
    let [gap, q, _] = closed::<f64>(240.0, 240, line(0.05), 1e-7);
    assert!(gap <= 1e-7 && q <= 1e-6, "{gap} {q}");
    // A wave and a rest of any length: the loop ends as it begins.
    let wave = |rest: f64| {
        let keys = [[0.0, 0.0], [0.0, 0.0], [0.05, 0.0], [0.0, 0.0], [0.0, 0.0]];
        let times = [0.0, 0.05, 0.1, 0.175, 0.175 + rest];
        Curve::linear(&times, &keys).unwrap().looped().unwrap()
    };
    let [gap, q, v] = closed::<f64>(240.0, 90, wave(0.325), 1e-7);
    assert!(gap <= 1e-7 && q <= 1e-6 && v <= 1e-5, "{gap} {q} {v}");
    // A joint that goes on: only its velocity is felt.
    let walk = Curve::linear(&[-9.0, 9.0], &[[-3.0, 0.0], [3.0, 0.0]]).unwrap();
    let [gap, q, _] = closed::<f64>(240.0, 90, walk, 1e-7);
    assert!(gap <= 1e-7 && q <= 1e-6, "{gap} {q}");
}

#[test]
fn kinks_of_a_loop_are_felt_at_every_tick() {
    // Multiples of 0.1 s are ticks, but 0.1 · 3 is larger than 72/240.
    let keys = [[0.0, 0.0], [0.01, 0.0], [0.0, 0.0]];
    let motion = Curve::linear(&[0.0, 0.05, 0.1], &keys).unwrap().looped().unwrap();
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    scene.set_tolerance(1e-9).unwrap();
    let joint = scene.joint(motion.clone());
    let handle = scene.hang(joint, Hanging::new(0.1, 0.3), [0.1], [0.0]).unwrap();
    let system = Hanging::new(0.1, 0.3).driven_by(motion);
    scene.advance_ticks(20 * 24 + 6);
    let end = scene.time();
    let exact = solve(&system, (0.0, end), [0.1], [0.0]).rtol(1e-12).atol(1e-13).run().unwrap();
    let (q, v) = scene.state(handle);
    assert!((q[0] - exact.end.q[0]).abs() < 1e-6, "{} for {}", q[0], exact.end.q[0]);
    assert!((v[0] - exact.end.v[0]).abs() < 1e-5, "{} for {}", v[0], exact.end.v[0]);
}

#[test]
fn baked_is_live() {
    let mut scene = zoo(1e-3);
    scene.advance(0.1).unwrap();
    let handles: Vec<_> = (0..40).filter_map(|k| scene.handle::<Hanging<f64>, 1>(k)).collect();
    let exact = scene.bake(&handles, 240, 0.0).unwrap();
    let near = scene.bake(&handles, 240, 1e-3).unwrap();
    let (mut all, mut kept) = (0, 0);
    for tick in 1..=240 {
        scene.advance_ticks(1);
        for (index, &handle) in handles.iter().enumerate() {
            for alpha in [0.1, 0.25, 0.5, 0.8, 1.0] {
                let pose = scene.pose(handle, alpha)[0];
                let at = f64::from(tick) - 1.0 + alpha;
                // Other times have different rounding errors.
                if (4.0 * alpha).fract() == 0.0 {
                    assert_eq!(exact[index].at(at)[0], pose);
                }
                assert!((near[index].at(at)[0] - pose).abs() < 1.0000001e-3, "{index} at {at}");
            }
        }
    }
    for (exact, near) in exact.iter().zip(&near) {
        all += exact.keys().count();
        kept += near.keys().count();
    }
    assert_eq!(all, 40 * 241);
    assert!(4 * kept < all, "{kept} of {all}");
}

#[test]
fn bits_are_the_same_on_every_machine() {
    // The checksums of an earlier run, which do not depend on vectors and threads.
    for (tolerance, expected) in [(1e-3, 0xcb06e6ec8ba8f2dd), (1e-9, 0xf7d4fa07f9ca4d7a)] {
        let mut scene = zoo(tolerance);
        scene.advance(3.0).unwrap();
        assert_eq!(scene.checksum(), expected, "{:#x}", scene.checksum());
    }
}

#[test]
fn a_pause_does_not_show() {
    let (mut through, mut paused) = (zoo(1e-3), zoo(1e-3));
    for scene in [&mut through, &mut paused] {
        scene.advance(0.3).unwrap();
    }
    paused.set_paused(true);
    for _ in 0..1000 {
        assert_eq!(paused.advance(0.06).unwrap().ticks, 0);
    }
    paused.set_paused(false);
    for scene in [&mut through, &mut paused] {
        scene.advance(0.3).unwrap();
    }
    assert_eq!(paused.checksum(), through.checksum());
}

#[test]
fn joints_are_felt_as_much_as_directors_want() {
    use pendulum_runtime::motion::Attenuated;
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    scene.set_tolerance(1e-9).unwrap();
    let shake = Sinusoid::new([0.1, 0.0], 9.0, [0.0, 0.0]);
    // A gain of 0.1 equals a tenth of the amplitude, and a limit above the speed has no effect.
    let tenth = scene.joint(Attenuated::new(shake, 0.1, f64::INFINITY).unwrap());
    let small = scene.joint(Sinusoid::new([0.01, 0.0], 9.0, [0.0, 0.0]));
    let below = scene.joint(Attenuated::new(shake, 1.0, 0.91).unwrap());
    let whole = scene.joint(shake);
    let beyond = scene.joint(Attenuated::new(shake, 1.0, 0.3).unwrap());
    let all = [tenth, small, below, whole, beyond]
        .map(|joint| scene.hang(joint, Hanging::new(0.1, 0.5), [0.1], [0.0]).unwrap());
    scene.advance(2.0).unwrap();
    let [tenth, small, below, whole, beyond] = all.map(|handle| scene.state(handle).0[0]);
    assert!(
        (tenth - small).abs() < 1e-12 && (below - whole).abs() < 1e-12,
        "{tenth} {small} {below} {whole}"
    );
    // Limited speeds with kinks, compared with an integrator that ends steps at the kinks.
    let alone = Hanging::new(0.1, 0.5).driven_by(Attenuated::new(shake, 1.0, 0.3).unwrap());
    let exact = solve(&alone, (0.0, 2.0), [0.1], [0.0]).rtol(1e-12).atol(1e-13).run().unwrap();
    assert!((beyond - exact.end.q[0]).abs() < 1e-7, "{beyond} for {}", exact.end.q[0]);
    assert!((beyond - whole).abs() > 0.01);
}

#[test]
fn a_shaken_pendulum_swings_alike_at_all_frame_rates() {
    let swing = |rate: u32| {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        let joint = scene.joint(Sinusoid::new([0.05, 0.0], 4.0 * std::f64::consts::PI, [0.0, 0.0]));
        let handle = scene.hang(joint, Hanging::new(0.01, 0.1), [0.0], [0.0]).unwrap();
        scene.set_damping(handle, 4.0).unwrap();
        let mut at_common_times = Vec::new();
        for frame in 1..=20 * rate {
            scene.advance(1.0 / f64::from(rate)).unwrap();
            if frame % (rate / 6) == 0 {
                at_common_times.push(scene.state(handle).0[0]);
            }
        }
        let baked = scene.bake(&[handle], 240, 0.0).unwrap();
        (at_common_times, baked[0].keys().map(|(_, q, _)| q[0].abs()).fold(0.0, f64::max))
    };
    let (reference, peak) = swing(240);
    assert!((peak.to_degrees() - 44.34).abs() < 0.02, "{peak}");
    for rate in [24, 30, 60, 120] {
        let (states, other) = swing(rate);
        assert!(
            reference.iter().zip(&states).all(|(a, b)| (a - b).abs() <= 1e-12)
                && (peak - other).abs() <= 1e-12,
            "{rate}"
        );
        assert_eq!(states.len(), reference.len());
    }
}

lagrangian! {
    /// A cart on a cart on a cart: the velocities of both joints act as impulses.
    #[derive(Clone, Debug)]
    pub struct Stacked { m: kg, k: N/m }
    coordinate u: m;
    driven a: m;
    driven b: m;
    kinetic = m/2 * (u̇ + dot(a) + dot(b))^2;
    potential = k/2 * u^2;
}

#[test]
fn a_jump_of_one_of_two_joints_is_an_impulse_of_this_one() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let a = scene.joint(Sinusoid::new([0.05], 8.0, [0.0]));
    let b = scene.joint(Still::new([0.0]));
    let [one, other] = [(a, b), (a, a)]
        .map(|joints| scene.hang(joints, Stacked::new(1.0, 2.0), [0.1], [0.2]).unwrap());
    scene.advance(0.1).unwrap();
    let before = [one, other].map(|stacked| scene.state(stacked).1[0]);
    let moving = Curve::linear(&[0.0, 100.0], &[[0.0], [50.0]]).unwrap();
    scene.set_motion(b, moving, Preserve::Momentum).unwrap();
    let after = [one, other].map(|stacked| scene.state(stacked).1[0]);
    assert!((after[0] - (before[0] - 0.5)).abs() < 1e-15, "{after:?} {before:?}");
    assert_eq!(after[1], before[1]);
}
