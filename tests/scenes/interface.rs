//! Scenes: the bits of the scalar methods in every lane, whatever the frames, the neighbours and
//! the kinks.

use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::motion::{Linear, Sinusoid, Spline, Still};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Fixed, Handle, Scene, SceneError, SceneStatus};

use systems::pendulums::{Double, Hanging, Simple};
use systems::random::Random;

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Strung { m: kg, k: N/m, #[allow(unused)] g: m/s^2 = 9.81 }
    coordinate u: m;
    driven a: m;
    driven b: [m; 2];
    kinetic = m/2 * u̇^2;
    potential = k/2*(u - a)^2 + k/2*(u - b.x)^2;
}

fn keys() -> Linear<2> {
    let times: Vec<f64> = (0..60).map(|key| f64::from(key) / 24.0).collect();
    let mut random = Random::new(5);
    let values: Vec<[f64; 2]> =
        times.iter().map(|_| [random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02)]).collect();
    Linear::new(&times, &values).unwrap()
}

/// Pendulums of several types on joints that move smoothly, in kinks and not at all.
fn zoo(tolerance: f64) -> Scene<f64> {
    let mut scene = Scene::new(240.0).unwrap();
    scene.set_tolerance(tolerance).unwrap();
    let mut random = Random::new(1);
    let joints = [
        scene.joint(Sinusoid::new([0.05, 0.02], 9.0, [0.0, 1.0])),
        scene.joint(keys()),
        scene.joint(Still::new([1.0, 2.0])),
        scene.joint(
            Spline::natural(
                &[0.2, 0.61, 0.9, 1.7],
                &[[0.0, 0.0], [0.1, 0.0], [0.0, 0.1], [0.2, 0.0]],
            )
            .unwrap(),
        ),
    ];
    let lift = scene.joint(Sinusoid::new([0.1], 3.0, [0.0]));
    for index in 0..100 {
        let length = random.uniform(0.02, 1.0);
        let (q, v) = ([random.uniform(-2.0, 2.0)], [random.uniform(-1.0, 1.0)]);
        scene.hang(joints[index % 4], Hanging::new(0.1, length), q, v).unwrap();
        if index % 3 == 0 {
            scene.hang((), Simple::new(0.1, length), q, v).unwrap();
            scene
                .hang(
                    joints[index % 4],
                    Double::new(0.1, 0.2 + length, 1e-4),
                    [q[0], 0.1],
                    [v[0], 0.0],
                )
                .unwrap();
            scene.hang((lift, joints[index % 4]), Strung::new(0.1, 5.0), q, v).unwrap();
        }
    }
    scene
}

fn same_as_scalar<M>(method: M, tolerance: f64)
where
    M: Fixed<Simple<f64>, 1> + Method<Simple<f64>, 1>,
{
    let mut scene = Scene::<f64>::new(256.0).unwrap();
    scene.set_tolerance(tolerance).unwrap();
    let mut random = Random::new(9);
    let all: Vec<_> = (0..50)
        .map(|_| (random.uniform(0.3, 2.0), random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0)))
        .collect();
    let hang = |&(length, q, v): &(f64, f64, f64)| {
        scene.hang((), Simple::new(0.3, length), [q], [v]).unwrap()
    };
    let handles: Vec<Handle<Simple<f64>, 1>> = all.iter().map(hang).collect();
    scene.set_method::<Simple<f64>, 1, M>(method).unwrap();
    scene.advance(4.0).unwrap();
    for (handle, &(length, q, v)) in handles.into_iter().zip(&all) {
        let pendulum = Simple::new(0.3, length);
        let whole =
            solve(&pendulum, (0.0, 4.0), [q], [v]).method(method).steps(1024).run().unwrap();
        assert_eq!(scene.state(handle), (whole.end.q, whole.end.v));
    }
}

#[test]
fn lanes_have_the_bits_of_the_scalar_methods() {
    same_as_scalar(Leapfrog, 1e-2);
    same_as_scalar(Srkn6b, 1e-2);
    same_as_scalar(Rk4, 1e-2);
}

#[test]
fn frames_do_not_show() {
    for tolerance in [1e-3, 1e-9] {
        let mut checksums = Vec::new();
        for frames in [24, 30, 60, 144, 240, 1000] {
            let mut scene = zoo(tolerance);
            for _ in 0..2 * frames {
                scene.advance(1.0 / f64::from(frames)).unwrap();
            }
            assert_eq!(scene.tick(), 480);
            checksums.push((states(&scene), scene.checksum()));
        }
        let mut scene = zoo(tolerance);
        let mut random = Random::new(3);
        let mut left = 2.0;
        while 0.0 < left {
            let dt = f64::min(left, random.uniform(0.0, 0.05));
            scene.advance(dt).unwrap();
            left -= dt;
        }
        checksums.push((states(&scene), scene.checksum()));
        assert!(checksums.iter().all(|other| *other == checksums[0]));
    }
}

/// The bits of all states and of those a tick before.
fn states(scene: &Scene<f64>) -> Vec<u64> {
    let mut bits = Vec::new();
    let (mut hanging, mut simple, mut double, mut strung) = (vec![], vec![], vec![], vec![]);
    for alpha in [0.0, 0.3, 1.0] {
        scene.poses::<Hanging<f64>, 1>(alpha, &mut hanging);
        scene.poses::<Simple<f64>, 1>(alpha, &mut simple);
        scene.poses::<Double<f64>, 2>(alpha, &mut double);
        scene.poses::<Strung<f64>, 1>(alpha, &mut strung);
        bits.extend(hanging.iter().chain(&simple).chain(&strung).map(|q| q[0].to_bits()));
        bits.extend(double.iter().flatten().map(|q| q.to_bits()));
    }
    bits
}

#[test]
fn kinks_are_felt_in_every_lane() {
    let mut scene = zoo(1e-10);
    scene.advance(2.0).unwrap();
    // The state of the zoo, again.
    let mut random = Random::new(1);
    for index in 0..100 {
        let length = random.uniform(0.02, 1.0);
        let (q, v) = ([random.uniform(-2.0, 2.0)], [random.uniform(-1.0, 1.0)]);
        if index % 4 == 1 {
            let (q1, v1) = scene.state(Handle::<Hanging<f64>, 1>::new(index));
            let alone = Hanging::new(0.1, length).driven_by(keys());
            let exact = solve(&alone, (0.0, 2.0), q, v).rtol(1e-12).atol(1e-13).run().unwrap();
            assert!(
                (q1[0] - exact.end.q[0]).abs() < 2e-5,
                "{index}: {} for {}",
                q1[0],
                exact.end.q[0]
            );
            assert!(
                (v1[0] - exact.end.v[0]).abs() < 5e-3,
                "{index}: {} for {}",
                v1[0],
                exact.end.v[0]
            );
            if index % 3 == 0 {
                let (q2, _) = scene.state(Handle::<Double<f64>, 2>::new(index / 3));
                let alone = Double::new(0.1, 0.2 + length, 1e-4).driven_by(keys());
                let exact = solve(&alone, (0.0, 2.0), [q[0], 0.1], [v[0], 0.0])
                    .rtol(1e-12)
                    .atol(1e-13)
                    .run()
                    .unwrap();
                assert!(
                    (q2[1] - exact.end.q[1]).abs() < 1e-5,
                    "{index}: {} for {}",
                    q2[1],
                    exact.end.q[1]
                );
            }
        }
    }
}

#[test]
fn a_pendulum_swings_as_it_would_alone() {
    let mut crowd = zoo(1e-6);
    crowd.advance(1.5).unwrap();
    let mut random = Random::new(1);
    for index in 0..100 {
        let length = random.uniform(0.02, 1.0);
        let (q, v) = ([random.uniform(-2.0, 2.0)], [random.uniform(-1.0, 1.0)]);
        let mut alone = Scene::new(240.0).unwrap();
        alone.set_tolerance(1e-6).unwrap();
        let joint = match index % 4 {
            0 => alone.joint(Sinusoid::new([0.05, 0.02], 9.0, [0.0, 1.0])),
            1 => alone.joint(keys()),
            _ => continue,
        };
        let handle = alone.hang(joint, Hanging::new(0.1, length), q, v).unwrap();
        alone.advance(1.5).unwrap();
        assert_eq!(alone.state(handle), crowd.state(Handle::<Hanging<f64>, 1>::new(index)));
    }
}

#[test]
fn what_is_restored_goes_on_as_before() {
    let mut scene = zoo(1e-3);
    scene.advance(0.71).unwrap();
    let snapshot = scene.snapshot();
    assert_eq!(snapshot.checksum(), scene.checksum());
    scene.advance(0.9).unwrap();
    let after = (scene.checksum(), scene.alpha());
    assert_ne!(after.0, snapshot.checksum());
    scene.restore(&snapshot).unwrap();
    assert_eq!(scene.snapshot(), snapshot);
    for _ in 0..9 {
        scene.advance(0.1).unwrap();
    }
    assert!((scene.alpha() - after.1).abs() < 1e-9);
    let mut again = zoo(1e-3);
    again.restore(&snapshot).unwrap();
    again.advance(0.9).unwrap();
    assert_eq!((again.checksum(), again.alpha()), after);
    let mut other = Scene::<f64>::new(240.0).unwrap();
    assert!(matches!(other.restore(&snapshot), Err(SceneError::Snapshot(_))));
}

#[test]
fn failures_stay_where_they_are() {
    let build = |bad: bool| {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        let joint = scene.joint(Sinusoid::new([0.05, 0.02], 9.0, [0.0, 1.0]));
        for index in 0..40 {
            let length = if bad && index == 7 { 0.0 } else { 0.5 };
            scene.hang(joint, Hanging::new(0.1, length), [0.1 * f64::from(index)], [0.0]).unwrap();
        }
        scene
    };
    let (mut good, mut bad) = (build(false), build(true));
    good.advance(1.0).unwrap();
    let advanced = bad.advance(1.0).unwrap();
    assert_eq!(advanced.failed, 1);
    for index in 0..40 {
        let handle = Handle::<Hanging<f64>, 1>::new(index);
        if index == 7 {
            assert_eq!(bad.state(handle), ([0.1 * 7.0], [0.0]));
            assert_eq!(bad.status(handle), SceneStatus::Failed);
        } else {
            assert_eq!(bad.state(handle), good.state(handle));
        }
    }
    let message = bad.faults()[0].to_string();
    assert!(
        message.starts_with(
            "`Hanging` 7: at t = 0.0 the acceleration of `θ` is not finite; check parameter `L`"
        ),
        "{message}"
    );
}

#[test]
fn bad_input_is_refused() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    assert!(matches!(
        scene.hang(joint, Hanging::new(0.1, 1.0), [f64::NAN], [0.0]),
        Err(SceneError::State { .. })
    ));
    for dt in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(scene.advance(dt), Err(SceneError::FrameTime(_))));
    }
    assert_eq!(scene.advance(0.0).unwrap().ticks, 0);
    scene.set_longest_frame(0.5).unwrap();
    let advanced = scene.advance(2.0).unwrap();
    assert_eq!((advanced.ticks, advanced.dropped), (120, 1.5));
    let mut other = Scene::<f64>::new(240.0).unwrap();
    assert!(matches!(
        other.hang(joint, Hanging::new(0.1, 1.0), [0.0], [0.0]),
        Err(SceneError::Joint(0))
    ));
    // There is a joint of that number, but it moves along a line.
    other.joint(Still::new([0.0]));
    assert!(matches!(
        other.hang(joint, Hanging::new(0.1, 1.0), [0.0], [0.0]),
        Err(SceneError::Joint(0))
    ));
    let refused =
        other.set_motion(joint, Still::new([0.0, 0.0]), pendulum_runtime::scene::Preserve::Swing);
    assert_eq!(refused, Err(SceneError::Joint(0)));
    let position = pendulum_runtime::motion::Function::new(|t: f64| [t, 0.0]);
    let vague = scene.joint(position);
    let missing = scene.hang(vague, Hanging::new(0.1, 1.0), [0.0], [0.0]).unwrap_err();
    assert_eq!(
        missing.to_string(),
        "the motion that drives `x` has no velocity, which the equations need; give one that has"
    );
}

#[test]
fn single_numbers_swing_too() {
    let mut scene = Scene::<f32>::new(240.0).unwrap();
    let joint = scene.joint(Sinusoid::new([0.05, 0.02], 9.0, [0.0, 1.0]));
    let handle = scene.hang(joint, Hanging::new(0.1, 0.4), [0.1], [0.0]).unwrap();
    scene.advance(10.0).unwrap();
    let alone = Hanging::new(0.1, 0.4).driven_by(Sinusoid::new([0.05, 0.02], 9.0, [0.0, 1.0]));
    let exact = solve(&alone, (0.0, 10.0), [0.1], [0.0]).run().unwrap();
    assert!((f64::from(scene.state(handle).0[0]) - exact.end.q[0]).abs() < 2e-3);
}

#[test]
fn damping_is_exact_for_any_step() {
    // Without gravity a damped pendulum turns by v/γ (1 − e^(−γt)).
    for rate in [2.0, 60.0] {
        let mut scene = Scene::<f64>::new(rate).unwrap();
        let handle = scene.hang((), Simple { m: 0.1, L: 1.0, g: 0.0 }, [0.0], [3.0]).unwrap();
        scene.set_damping(handle, 0.7).unwrap();
        scene.advance(10.0).unwrap();
        let (_, v) = scene.state(handle);
        assert!((v[0] - 3.0 * (-7.0f64).exp()).abs() < 1e-15, "{}", v[0]);
    }
    // In a tick cut by kinks too.
    let mut scene = Scene::<f64>::new(10.0).unwrap();
    let joint = scene.joint(keys());
    let handle = scene.hang(joint, Hanging { m: 0.1, L: 1e9, g: 0.0 }, [0.0], [3.0]).unwrap();
    scene.set_damping(handle, 0.7).unwrap();
    scene.advance(2.0).unwrap();
    assert!((scene.state(handle).1[0] - 3.0 * (-1.4f64).exp()).abs() < 1e-8);
}

#[test]
fn stops_throw_back_and_hold() {
    use pendulum_runtime::scene::Stop;
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let free = |scene: &mut Scene<f64>| {
        scene.hang((), Simple { m: 0.1, L: 1.0, g: 0.0 }, [0.0], [1.0]).unwrap()
    };
    let (hard, soft) = (free(&mut scene), free(&mut scene));
    scene.set_limits(hard, [-1.0], [0.3], Stop::Hard { restitution: 0.5 }).unwrap();
    scene.set_limits(soft, [-9.0], [0.3], Stop::Soft { stiffness: 900.0 }).unwrap();
    scene.advance(0.25).unwrap();
    assert_eq!(scene.state(hard), (scene.state(soft).0, [1.0]));
    scene.advance(0.25).unwrap();
    // At 0.3 s the wall; 0.2 s later it has gone back by 0.1 with half the speed.
    let (q, v) = scene.state(hard);
    assert!((q[0] - 0.2).abs() < 1e-12 && v == [-0.5], "{q:?} {v:?}");
    // Half a period of the spring, then back with the same speed.
    let (q, v) = scene.state(soft);
    let expected = 0.3 - (0.2 - std::f64::consts::PI / 30.0);
    assert!((q[0] - expected).abs() < 1e-4 && (v[0] + 1.0).abs() < 2e-3, "{q:?} {v:?} {expected}");
    // What falls onto a wall without restitution lies there.
    let handle = scene.hang((), Simple::new(0.1, 0.2), [1.0], [0.0]).unwrap();
    scene.set_limits(handle, [0.5], [2.0], Stop::Hard { restitution: 0.0 }).unwrap();
    scene.advance(2.0).unwrap();
    let (q, v) = scene.state(handle);
    assert!((q[0] - 0.5).abs() < 1e-12 && v[0].abs() < 0.3, "{q:?} {v:?}");
    assert!(scene.set_limits(handle, [1.0], [0.0], Stop::Soft { stiffness: 1.0 }).is_err());
    assert!(scene.set_limits(handle, [0.0], [1.0], Stop::Hard { restitution: 2.0 }).is_err());
    assert!(
        scene
            .set_limits(handle, [f64::INFINITY], [f64::INFINITY], Stop::Hard { restitution: 0.0 })
            .is_err()
    );
    // Walls so near that a step would go through both.
    for (gap, restitution) in [(0.02, 1.0), (0.002, 1.0), (0.0, 0.5)] {
        let handle = scene.hang((), Simple::new(0.1, 0.1), [0.0], [12.0]).unwrap();
        scene.set_limits(handle, [-gap], [gap], Stop::Hard { restitution }).unwrap();
        for _ in 0..500 {
            scene.advance_ticks(1);
            assert!(scene.state(handle).0[0].abs() <= gap);
        }
    }
}

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
        // Steps are chosen anew, with the tolerance that it was hung with.
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
        let joint = scene.joint(Linear::new(&times, &values).unwrap());
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
    // One that has failed swings again.
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
    use pendulum_runtime::scene::Preserve;
    let mut scene = zoo(1e-3);
    let handle = Handle::<Hanging<f64>, 1>::new(4);
    let double = Handle::<Double<f64>, 2>::new(3);
    scene.advance(0.3).unwrap();
    // Rest.
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
    // Gravity, everywhere and by name; nothing is reset.
    let before = states(&scene);
    assert_eq!(scene.set_parameter_everywhere("g", 1.62).unwrap(), 100 + 3 * 34);
    assert_eq!(states(&scene), before);
    assert_eq!(scene.system(handle).g, 1.62);
    assert!(matches!(scene.set_parameter_everywhere("h", 1.0), Err(SceneError::Parameter(_))));
    scene.set_parameter(handle, "L", 0.25).unwrap();
    assert_eq!(scene.system(handle).L, 0.25);
    // Pause.
    scene.set_paused(true);
    assert_eq!(scene.advance(5.0).unwrap().ticks, 0);
    assert_eq!(scene.system(handle).L, 0.25);
    scene.set_paused(false);
    // Another motion, felt and unfelt.
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    let handle = scene.hang(joint, Hanging::new(0.1, 0.5), [0.2], [0.1]).unwrap();
    let away = Linear::new(&[-1.0, 9.0], &[[0.0, 0.0], [20.0, 0.0]]).unwrap();
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
    // Warming up for as long leads there too.
    scene.set_state(handle, [0.0], [0.0]).unwrap();
    scene.warm_up(20.0).unwrap();
    assert_eq!(scene.tick(), 160);
    assert!((scene.state(handle).0[0] - end.0[0]).abs() < 1e-8);
}

#[test]
fn baked_is_live() {
    let mut scene = zoo(1e-3);
    scene.advance(0.1).unwrap();
    let handles: Vec<_> = (0..40).map(Handle::<Hanging<f64>, 1>::new).collect();
    let exact = scene.bake(&handles, 240, 0.0).unwrap();
    let near = scene.bake(&handles, 240, 1e-3).unwrap();
    let (mut all, mut kept) = (0, 0);
    for tick in 1..=240 {
        scene.advance_ticks(1);
        for (index, &handle) in handles.iter().enumerate() {
            for alpha in [0.1, 0.25, 0.5, 0.8, 1.0] {
                let pose = scene.pose(handle, alpha)[0];
                let at = f64::from(tick) - 1.0 + alpha;
                // Other times have rounding errors of their own.
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

/// A thousand joints with kinks at odd times, and enough pendulums that every thread has some.
#[cfg(feature = "rayon")]
fn crowd(seed: u64) -> Scene<f64> {
    let mut scene = Scene::new(240.0).unwrap();
    let mut random = Random::new(seed);
    for index in 0..1000 {
        let times: Vec<f64> = (0..5).map(|key| f64::from(key) * random.uniform(0.1, 0.2)).collect();
        let mut place = || [random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)];
        let values: Vec<[f64; 2]> = times.iter().map(|_| place()).collect();
        let mut sorted = times.clone();
        sorted.sort_by(f64::total_cmp);
        let joint = match index % 3 {
            0 => scene.joint(Linear::new(&sorted, &values).unwrap_or_else(|_| keys())),
            1 => scene.joint(Sinusoid::new(values[0], random.uniform(3.0, 9.0), values[1])),
            _ => scene.joint(Still::new(values[0])),
        };
        for _ in 0..12 {
            let length = random.uniform(0.05, 1.0);
            scene
                .hang(joint, Hanging::new(0.1, length), [random.uniform(-1.0, 1.0)], [0.0])
                .unwrap();
        }
        scene.hang(joint, Double::new(0.1, 0.3, 1e-4), [0.1, 0.2], [0.0, 0.0]).unwrap();
    }
    scene
}

#[test]
#[cfg(feature = "rayon")]
fn threads_do_not_show() {
    let alone = {
        let mut scene = crowd(7);
        scene.set_parallel(false);
        scene.advance(0.5).unwrap();
        scene.checksum()
    };
    for threads in [1, 2, 3, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let many = pool.install(|| {
            let mut scene = crowd(7);
            // Otherwise the load of the machine decides whether anything is shared.
            scene.set_always_fork(true);
            scene.advance(0.5).unwrap();
            scene.checksum()
        });
        assert_eq!(many, alone, "{threads}");
    }
}

#[test]
#[cfg(feature = "serde")]
fn snapshots_can_be_written_and_read() {
    use pendulum_runtime::scene::{Snapshot, Stop};
    let mut scene = zoo(1e-3);
    let handle = Handle::<Hanging<f64>, 1>::new(4);
    // A limit on one side only: JSON knows no infinity.
    scene.set_limits(handle, [-0.2], [f64::INFINITY], Stop::Hard { restitution: 0.5 }).unwrap();
    scene.advance(0.71).unwrap();
    let snapshot = scene.snapshot();
    let text = serde_json::to_string(&snapshot).unwrap();
    let read: Snapshot<f64> = serde_json::from_str(&text).unwrap();
    assert_eq!(read, snapshot);
    // What a file was damaged to is refused, and the scene goes on as if nothing had been.
    let clock = serde_json::to_value(&snapshot).unwrap()["clock"].to_string();
    for (good, bad) in [
        ("\"Leapfrog\",1", "\"Leapfrog\",0"),
        ("\"Rk4\",1", "\"Srkn6b\",1"),
        ("\"Rk4\",1", "\"Rk4\",4000000000"),
    ] {
        assert!(text.contains(good));
        let damaged: Snapshot<f64> = serde_json::from_str(&text.replacen(good, bad, 1)).unwrap();
        assert!(matches!(scene.restore(&damaged), Err(SceneError::Snapshot(_))), "{bad}");
    }
    let damaged = text.replacen(&clock, "[9223372036854775807,0,[0.0,0.0]]", 1);
    assert!(matches!(
        scene.restore(&serde_json::from_str(&damaged).unwrap()),
        Err(SceneError::Snapshot(_))
    ));
    scene.advance(0.9).unwrap();
    let mut other = zoo(1e-3);
    other.restore(&read).unwrap();
    other.advance(0.9).unwrap();
    assert_eq!(other.checksum(), scene.checksum());
}

#[test]
fn bits_are_the_same_on_every_machine() {
    // With and without vectors and threads, whatever their width and number; found once and kept.
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
    // A tenth of a shake is what a tenth of the amplitude is, and a speed below the limit is all
    // felt.
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
    // Cut speeds through the kinks, by an integrator that lands on them.
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
