//! Scenes: every lane has the bits of the scalar methods, independent of frames, neighbours and
//! kinks.

use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::motion::{Curve, Function, Sinusoid, Still};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Float;
use pendulum_runtime::scene::{Fixed, Handle, Scene, SceneError, SceneStatus};

use systems::pendulums::{Double, Hanging, Simple};
use systems::random::{Random, some};

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Strung { m: kg, k: N/m, #[allow(unused)] g: m/s^2 = 9.81 }
    coordinate u: m;
    driven a: m;
    driven b: [m; 2];
    kinetic = m/2 * u̇^2;
    potential = k/2*(u - a)^2 + k/2*(u - b.x)^2;
}

lagrangian! {
    /// Four rods with friction in the joints, whose equations are long.
    #[derive(Clone, Debug)]
    pub struct Four { m: kg, l: m, c: N*m*s, u: N*m, g: m/s^2 = 9.81 }
    coordinate θ[4]: rad;
    driven x: [m; 2];
    input w: 1;
    let y[k in 0..4] = x + sum(j in 0..=k, l*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..4, m/2*|ẏ[k]|^2);
    potential = sum(k in 0..4, m*g*height(y[k]));
    dissipation = c/2*(θ̇[0]^2 + sum(k in 1..4, (θ̇[k] - θ̇[k-1])^2));
    force θ[3] = u*w;
}

pub(crate) fn keys() -> Curve<2> {
    let times: Vec<f64> = (0..60).map(|key| f64::from(key) / 24.0).collect();
    let mut random = Random::new(5);
    let values: Vec<[f64; 2]> =
        times.iter().map(|_| [random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02)]).collect();
    Curve::linear(&times, &values).unwrap()
}

/// Creates a scene with pendulums of several types on joints that move smoothly, with kinks, or not
/// at all.
pub(crate) fn zoo(tolerance: f64) -> Scene<f64> {
    let mut scene = Scene::new(240.0).unwrap();
    scene.set_tolerance(tolerance).unwrap();
    let mut random = Random::new(1);
    let joints = [
        scene.joint(Sinusoid::new([0.05, 0.02], 9.0, [0.0, 1.0])),
        scene.joint(keys()),
        scene.joint(Still::new([1.0, 2.0])),
        scene.joint(
            Curve::spline(
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

/// They are evaluated for eight lanes at a time.
#[test]
fn long_equations_have_the_bits_of_the_scalar_method() {
    fn same<T: Float>() {
        const { assert!(150 <= Four::<T>::FACTS.cost) };
        let mut scene = Scene::<T>::new(256.0).unwrap();
        scene.set_tolerance(1e-2).unwrap();
        let hands = [2.0, 3.0].map(|rate| Sinusoid::new([0.05, 0.02], rate, [0.0, 1.0]));
        let joints = hands.map(|hand| scene.joint(hand));
        let number = |k: usize, by: f64| T::from_f64(0.3 + by * k as f64);
        let four =
            |k| Four::new(number(k, 0.01), number(k, 0.02), number(k, 1e-4), number(k, 0.01));
        let start = |k| [number(k, 0.01), number(k, -0.02), T::from_f64(0.1), number(k, 0.0)];
        let hang = |k: usize| {
            let hung = scene.hang(joints[k % 2], four(k), start(k), [T::from_f64(0.5); 4]).unwrap();
            scene.set_inputs(hung, number(k, 0.1)).unwrap();
            hung
        };
        let all: Vec<Handle<Four<T>, 4>> = (0..45).map(hang).collect();
        scene.advance_ticks(64);
        for (k, hung) in all.into_iter().enumerate() {
            let (dynamics, value) = (four(k).driven_by(hands[k % 2]), number(k, 0.1));
            let dynamics = dynamics.controlled_by(move |_, _, _| value);
            let (q, v) = (start(k), [T::from_f64(0.5); 4]);
            let run = solve(&dynamics, (0.0, 0.25), q, v).method(Rk4).steps(64).run().unwrap();
            assert_eq!(scene.state(hung), (run.end.q, run.end.v), "{k}");
        }
    }
    same::<f64>();
    same::<f32>();
}

#[test]
fn frames_do_not_show() {
    for tolerance in [1e-3, 1e-9] {
        let mut checksums = Vec::new();
        for frames in some([1000, 24, 30, 60, 144, 240]) {
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

/// Returns the bits of all states and of the states one tick before.
pub(crate) fn states(scene: &Scene<f64>) -> Vec<u64> {
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
    // The same random numbers as in the zoo.
    let mut random = Random::new(1);
    for index in 0..100 {
        let length = random.uniform(0.02, 1.0);
        let (q, v) = ([random.uniform(-2.0, 2.0)], [random.uniform(-1.0, 1.0)]);
        if index % 4 == 1 {
            let (q1, v1) = scene.state(scene.handle::<Hanging<f64>, 1>(index).unwrap());
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
                let (q2, _) = scene.state(scene.handle::<Double<f64>, 2>(index / 3).unwrap());
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
        assert_eq!(
            alone.state(handle),
            crowd.state(crowd.handle::<Hanging<f64>, 1>(index).unwrap())
        );
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
        let handle = bad.handle::<Hanging<f64>, 1>(index).unwrap();
        let neighbour = good.handle::<Hanging<f64>, 1>(index).unwrap();
        if index == 7 {
            assert_eq!(bad.state(handle), ([0.1 * 7.0], [0.0]));
            assert_eq!(bad.status(handle), SceneStatus::Failed);
        } else {
            assert_eq!(bad.state(handle), good.state(neighbour));
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
    // A joint with this number exists, but it moves in one dimension.
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
        "the motion that drives `x` has no velocity, which the equations or outputs need; give one that has"
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
    // The same in a tick that is divided by kinks.
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
    // The pendulum hits the wall at 0.3 s; 0.2 s later it has moved back by 0.1 with half the
    // speed.
    let (q, v) = scene.state(hard);
    assert!((q[0] - 0.2).abs() < 1e-12 && v == [-0.5], "{q:?} {v:?}");
    // Half a period of the spring, then back with the same speed.
    let (q, v) = scene.state(soft);
    let expected = 0.3 - (0.2 - std::f64::consts::PI / 30.0);
    assert!((q[0] - expected).abs() < 1e-4 && (v[0] + 1.0).abs() < 2e-3, "{q:?} {v:?} {expected}");
    // A pendulum that falls onto a wall without restitution stays there.
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
    // Walls so close together that a step would pass both.
    for (gap, restitution) in [(0.02, 1.0), (0.002, 1.0), (0.0, 0.5)] {
        let handle = scene.hang((), Simple::new(0.1, 0.1), [0.0], [12.0]).unwrap();
        scene.set_limits(handle, [-gap], [gap], Stop::Hard { restitution }).unwrap();
        for _ in 0..500 {
            scene.advance_ticks(1);
            assert!(scene.state(handle).0[0].abs() <= gap);
        }
    }
}

lagrangian! {
    pub struct Lamp { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    potential = m*g*height(y);
    output bulb: [m; 2] = y;
    output speed: [m/s; 2] = ẏ;
    output felt: [m/s^2; 2] = dot(dot(y)) + [0, g];
}

/// Outputs of a pendulum in a scene belong to its pose, and `speed` is the derivative of `bulb`.
#[test]
fn outputs_follow_the_pose() {
    let mut scene = Scene::<f64>::new(1000.0).unwrap();
    let hook = scene.joint(Sinusoid::new([0.1, 0.2], 3.0, [0.0, 0.5]));
    let lamp = scene.hang(hook, Lamp::new(1.0, 2.0), [0.3], [0.0]).unwrap();
    let mut before: Option<[f64; 2]> = None;
    for _ in 0..20 {
        scene.advance(0.0505).unwrap();
        let alpha = scene.alpha();
        let seen = scene.observe(lamp, alpha);
        assert_eq!(seen.q, scene.pose(lamp, alpha));
        let [x, y] = scene.joint_pose(hook, alpha);
        let bulb = seen.system.bulb(seen.t, &seen.q, &seen.v, &seen.inputs);
        assert!((bulb[0] - x - 2.0 * seen.q[0].sin()).abs() < 1e-14);
        assert!((bulb[1] - y + 2.0 * seen.q[0].cos()).abs() < 1e-14);
        let speed = seen.system.speed(seen.t, &seen.q, &seen.v, &seen.inputs);
        let beside = scene.observe(lamp, alpha + 1e-3);
        let next = beside.system.bulb(beside.t, &beside.q, &beside.v, &beside.inputs);
        for axis in 0..2 {
            let slope = (next[axis] - bulb[axis]) / 1e-6;
            assert!((slope - speed[axis]).abs() < 1e-4, "{slope} {speed:?}");
        }
        // The force of the rod is parallel to the rod.
        let [a, b] = seen.system.felt(seen.t, &seen.q, &seen.v, &seen.inputs);
        assert!(
            (a * seen.q[0].cos() + b * seen.q[0].sin()).abs() < 1e-12 * (1.0 + a.abs() + b.abs())
        );
        assert_ne!(Some(bulb), before.replace(bulb));
    }
}

/// A joint without a derivative that an output needs is refused, as if an equation needed it.
#[test]
fn joints_have_what_outputs_need() {
    lagrangian! {
        pub struct Far { m: kg, L: m, g: m/s^2 }
        coordinate θ: rad;
        driven x: m;
        kinetic = m/2*L^2*θ̇^2;
        potential = m*g*x*cos(θ);
        output pace: m/s = ẋ;
    }
    let mut scene = Scene::<f64>::new(100.0).unwrap();
    let joint = scene.joint(Function::new(|t: f64| [t]));
    let error = scene.hang(joint, Far::new(1.0, 1.0, 9.81), [0.0], [0.0]).unwrap_err();
    assert!(error.to_string().contains("`x` has no velocity"), "{error}");
}
