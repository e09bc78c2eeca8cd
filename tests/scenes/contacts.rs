//! Limits of blocks in scenes: impacts, contacts and rest, with the bits of single runs.

use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::FixedStep;
use pendulum_runtime::motion::{Curve, Function, Sinusoid, Still};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Float;
use pendulum_runtime::scene::{Handle, Preserve, Resume, Scene, SceneError, SceneStatus};
use pendulum_runtime::system::Dynamics;
use systems::pendulums::Hanging;
use systems::random::Random;

lagrangian! {
    /// A ball above a plate that moves, pushed by a jet.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Ball { m: kg, e: 1, g: m/s^2 = 9.81 }
    coordinate y: m;
    driven plate: m;
    input jet: N;
    kinetic = m/2*ẏ^2;
    potential = m*g*y;
    force y = jet;
    limit floor: y - plate >= 0, restitution = e;
    output top: [m; 2] = [0, y];
}

lagrangian! {
    /// A pendulum on a moving joint beside a wall.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Knocker { m: kg, L: m, w: m, e: 1, c: N*m*s = 0, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L*[sin(θ), -cos(θ)];
    kinetic = m/2*|ẏ|^2;
    potential = m*g*height(y);
    dissipation = c/2*θ̇^2;
    limit wall: y.x + w >= 0, restitution = e;
}

lagrangian! {
    /// Two bobs on one rod after the other between two walls.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Clapper { m: kg, L: m, w: m, e: 1, g: m/s^2 = 9.81 }
    coordinate θ[2]: rad;
    driven x: [m; 2];
    let a = x + L*[sin(θ[0]), -cos(θ[0])];
    let b = a + L*[sin(θ[1]), -cos(θ[1])];
    kinetic = m/2*(|ȧ|^2 + |ḃ|^2);
    potential = m*g*(height(a) + height(b));
    limit left: b.x + w >= 0, restitution = e;
    limit right: w - b.x >= 0, restitution = e;
}

lagrangian! {
    /// A bob on a rod, in absolute coordinates, above a floor.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Bob { m: kg, L: m, h: m, e: 1, g: m/s^2 = 9.81 }
    coordinate r: [m; 2];
    driven x: [m; 2];
    kinetic = m/2*|dot(r)|^2;
    potential = m*g*r.y;
    constraint rod: |r - x| = L;
    limit floor: r.y + h >= 0, restitution = e;
}

lagrangian! {
    /// A ball that flies over ridges.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Flyer { a: m, κ: 1/m, e: 1, g: m/s^2 = 9.81 }
    coordinate p: [m; 2];
    kinetic = |dot(p)|^2/2;
    potential = g*p.y;
    limit ridges: p.y - a*cos(κ*p.x) >= 0, restitution = e;
}

/// The ticks per second of scenes whose bits are compared; their times are exact.
pub(crate) const RATE: u32 = 256;

/// Coordinates and velocities after each tick.
pub(crate) type States<T, const N: usize> = Vec<([T; N], [T; N])>;

/// Returns the states of a single run after each tick.
pub(crate) fn alone<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    ticks: u32,
    q: [D::Scalar; N],
    v: [D::Scalar; N],
) -> States<D::Scalar, N> {
    let control = FixedStep::new(1.0 / f64::from(RATE));
    let mut run = Integrator::new(dynamics, Rk4, 0.0, q, v).unwrap().control(control).unwrap();
    let states = (1..=ticks).map(|tick| {
        run.advance_to(f64::from(tick) / f64::from(RATE)).unwrap();
        (*run.q(), *run.v())
    });
    states.collect()
}

pub(crate) fn scene<T: Float>() -> Scene<T> {
    Scene::new(f64::from(RATE)).unwrap()
}

pub(crate) fn sway() -> Sinusoid<2> {
    Sinusoid::new([0.2, 0.05], 7.0, [0.0, 1.0])
}

#[test]
fn pendulums_beside_a_wall_have_the_bits_of_single_runs() {
    fn same<T: Float>() {
        let number = T::from_f64;
        let mut scene = scene::<T>();
        let joint = scene.joint(sway());
        // Most never touch the wall, some knock on it, some lean on it.
        let start = |k: u32| {
            let w = if k.is_multiple_of(5) { 0.1 } else { 5.0 };
            let knocker = Knocker::new(number(0.3), number(0.5), number(w), number(0.4));
            (Knocker { c: number(0.05), ..knocker }, number(0.02 * f64::from(k)))
        };
        let hang = |k: u32| {
            let (knocker, q) = start(k);
            (k, scene.hang(joint, knocker, [q], [number(-1.0)]).unwrap())
        };
        let all: Vec<(u32, Handle<Knocker<T>, 1>)> = (0..40).map(hang).collect();
        let mut seen = vec![Vec::new(); 40];
        for _ in 0..2 * RATE {
            scene.advance_ticks(1);
            for &(k, handle) in &all {
                seen[k as usize].push(scene.state(handle));
            }
        }
        assert!(scene.faults().is_empty(), "{:?}", scene.faults());
        for k in 0..40 {
            let (knocker, q) = start(k);
            let single = alone(&knocker.driven_by(sway()), 2 * RATE, [q], [number(-1.0)]);
            assert_eq!(seen[k as usize], single, "{k}");
        }
        let knocked = |states: &[([T; 1], [T; 1])]| {
            states.windows(2).any(|pair| number(0.3) < pair[1].1[0] - pair[0].1[0])
        };
        assert!(knocked(&seen[0]) && knocked(&seen[35]) && !knocked(&seen[1]));
    }
    same::<f64>();
    same::<f32>();
}

#[test]
fn coupled_coordinates_between_two_walls_have_the_bits_of_single_runs() {
    let mut scene = scene::<f64>();
    scene.set_tolerance(1e-2).unwrap();
    let joint = scene.joint(sway());
    let clapper = Clapper::new(0.1, 0.3, 0.2, 0.7);
    let handle = scene.hang(joint, clapper.clone(), [0.3, 0.1], [2.0, 0.0]).unwrap();
    let single = alone(&clapper.driven_by(sway()), 3 * RATE, [0.3, 0.1], [2.0, 0.0]);
    let mut impacts = 0;
    for (tick, expected) in single.iter().enumerate() {
        let before = scene.state(handle).1[1];
        scene.advance_ticks(1);
        assert_eq!(scene.state(handle), *expected, "{tick}");
        impacts += u32::from(2.0 < (expected.1[1] - before).abs());
    }
    assert!(5 < impacts, "{impacts}");
}

#[test]
fn a_bob_on_a_rod_strikes_the_floor_with_the_bits_of_a_single_run() {
    let mut scene = scene::<f64>();
    let joint = scene.joint(sway());
    let bob = Bob::new(0.3, 0.5, 0.35, 0.6);
    // The joint begins at (0, 0.05 sin 1), and the bob moves with it.
    let q = [0.4, 0.05 * 1f64.sin() - 0.3];
    let v = [0.2 * 7.0, 0.05 * 7.0 * 1f64.cos()];
    let handle = scene.hang(joint, bob.clone(), q, v).unwrap();
    let single = alone(&bob.driven_by(sway()), RATE, q, v);
    scene.advance_ticks(RATE);
    assert_eq!(scene.state(handle), single[RATE as usize - 1]);
}

#[test]
fn no_impact_of_a_single_run_is_lost_in_lanes() {
    let (mut scene, mut random) = (scene::<f64>(), Random::new(7));
    let (mut all, mut singles) = (Vec::new(), Vec::new());
    for _ in 0..64 {
        // Up to nine ridges in a tick.
        let flyer = Flyer::new(0.02, random.uniform(20.0, 80.0), random.uniform(0.0, 0.9));
        let q = [random.uniform(-0.1, 0.1), random.uniform(0.05, 0.4)];
        let v = [random.uniform(-180.0, 180.0), random.uniform(-2.0, 1.0)];
        singles.push(alone(&flyer, RATE / 2, q, v));
        all.push(scene.hang((), flyer, q, v).unwrap());
    }
    let mut impacts = 0;
    for tick in 0..RATE as usize / 2 {
        scene.advance_ticks(1);
        for (handle, single) in all.iter().zip(&singles) {
            assert_eq!(scene.state(*handle), single[tick], "tick {tick}");
            impacts +=
                u32::from(0 < tick && 0.1 < (single[tick].1[1] - single[tick - 1].1[1]).abs());
        }
    }
    assert!(50 < impacts, "{impacts}");
}

#[test]
fn a_ball_strikes_a_rising_plate_at_the_right_time() {
    let (e, g, speed, end) = (0.6, 9.81, 0.7, 0.75);
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let rising = Function::new(move |t: f64| [speed * t]).velocity(move |_| [speed]);
    let plate = scene.joint(rising.acceleration(|_| [0.0]));
    let ball = scene.hang(plate, Ball::new(0.2, e), [1.0], [0.0]).unwrap();
    scene.advance(end).unwrap();
    // 1 − g t²/2 = u t; the ball leaves with the plate's speed and e times the speed of approach.
    let t = (-speed + (speed * speed + 2.0 * g).sqrt()) / g;
    let v = speed + e * (g * t + speed);
    let s = end - t;
    let ([y], [w]) = scene.state(ball);
    assert!((y - (speed * t + v * s - g * s * s / 2.0)).abs() < 1e-12, "{y}");
    assert!((w - (v - g * s)).abs() < 1e-12, "{w}");
}

#[test]
fn a_pendulum_knocks_on_a_wall_as_in_an_accurate_run() {
    let knocker = Knocker::new(0.3, 0.5, 0.1, 0.8);
    let exact = knocker.clone().driven_by(sway());
    let run = solve(&exact, (0.0, 2.0), [0.4], [0.0]).rtol(1e-13).atol(1e-14);
    let exact = run.run().unwrap();
    assert!(1 < exact.impacts.len(), "{}", exact.impacts.len());
    let mut errors = Vec::new();
    for tolerance in [1e-4, 1e-8, 1e-11] {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        scene.set_tolerance(tolerance).unwrap();
        let joint = scene.joint(sway());
        let handle = scene.hang(joint, knocker.clone(), [0.4], [0.0]).unwrap();
        scene.advance(2.0).unwrap();
        errors.push((scene.state(handle).0[0] - exact.end.q[0]).abs());
    }
    assert!(errors[0] < 1e-4 && errors[1] < 1e-8 && errors[2] < 1e-11, "{errors:?}");
}

#[test]
fn a_ball_bounces_to_rest_sleeps_and_wakes_with_its_plate() {
    let mut scene = scene::<f64>();
    scene.set_sleep(Some(1e-3)).unwrap();
    let plate = scene.joint(Curve::linear(&[8.0, 9.0], &[[0.0], [0.5]]).unwrap());
    let ball = scene.hang(plate, Ball::new(0.2, 0.5), [0.3], [0.0]).unwrap();
    scene.advance(6.0).unwrap();
    assert!(matches!(scene.status(ball), SceneStatus::Asleep(_)), "{:?}", scene.status(ball));
    assert!(scene.state(ball).0[0].abs() < 1e-15);
    scene.advance(2.0 + 1.0 / 64.0).unwrap();
    // The plate moves from one tick to the next with 0.5 m/s: an impact throws the ball up, with
    // half of the plate's speed relative to it.
    let ([y], _) = scene.state(ball);
    let (t, g) = (1.0 / 64.0, 9.81);
    assert!((y - (0.75 * t - g * t * t / 2.0)).abs() < 1e-12, "{y}");
    assert_eq!(scene.status(ball), SceneStatus::Awake);
    scene.advance(0.5 - t).unwrap();
    let ([y], [v]) = scene.state(ball);
    assert!((y - 0.25).abs() < 1e-12 && (v - 0.5).abs() < 1e-12, "{y} {v}");
}

#[test]
fn a_pendulum_that_leans_on_a_wall_sleeps_there() {
    let mut scene = scene::<f64>();
    scene.set_sleep(Some(1e-3)).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    // The wall is right of where it would hang.
    let leaning = Knocker::new(0.3, 0.5, -0.1, 0.3);
    let leaning = scene.hang(joint, leaning, [0.5], [0.0]).unwrap();
    let free = Knocker { c: 0.1, ..Knocker::new(0.3, 0.5, 0.4, 0.3) };
    let free = scene.hang(joint, free, [0.5], [0.0]).unwrap();
    scene.advance(20.0).unwrap();
    for handle in [leaning, free] {
        assert!(matches!(scene.status(handle), SceneStatus::Asleep(_)));
    }
    assert!((0.5 * scene.state(leaning).0[0].sin() - 0.1).abs() < 1e-15);
    assert!(scene.state(free).0[0].abs() < 1e-3);
    // The wall gives way.
    scene.set_parameter(leaning, "w", 0.0).unwrap();
    scene.advance(0.2).unwrap();
    assert!(0.5 * scene.state(leaning).0[0].sin() < 0.07);
}

#[test]
fn what_is_restored_in_contact_goes_on_as_before() {
    let build = || {
        let mut scene = scene::<f64>();
        let joint = scene.joint(sway());
        let plate = scene.joint(Sinusoid::new([0.01], 9.0, [0.0]));
        let ball = scene.hang(plate, Ball::new(0.2, 0.0), [0.1], [0.0]).unwrap();
        let knocker = Knocker::new(0.3, 0.5, 0.1, 0.4);
        (scene.hang(joint, knocker, [0.4], [0.0]).unwrap(), ball, scene)
    };
    let (_, ball, mut scene) = build();
    scene.advance(0.5).unwrap();
    let on = |scene: &Scene<f64>| scene.state(ball).0[0] - 0.01 * (9.0 * scene.time()).sin();
    assert!(on(&scene).abs() < 1e-15);
    let kept = scene.snapshot();
    scene.advance(1.0).unwrap();
    let after = scene.snapshot();
    scene.restore(&kept).unwrap();
    scene.advance(1.0).unwrap();
    assert_eq!(scene.snapshot(), after);
    let (_, _, mut other) = build();
    other.restore(&kept).unwrap();
    other.advance(1.0).unwrap();
    assert_eq!(other.checksum(), after.checksum());
}

#[test]
fn frames_threads_and_neighbours_change_no_bits() {
    let run = |always: bool, frames: u32, members: core::ops::Range<u32>| {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        scene.set_always_fork(always);
        let joint = scene.joint(sway());
        let hang = |k: u32| {
            let knocker = Knocker::new(0.3, 0.3 + 0.01 * f64::from(k), 0.2, 0.5);
            scene.hang(joint, knocker, [0.01 * f64::from(k)], [0.0]).unwrap()
        };
        let all: Vec<_> = members.map(hang).collect();
        for _ in 0..frames {
            scene.advance(1.0 / f64::from(frames)).unwrap();
        }
        all.iter().map(|&handle| scene.state(handle)).collect::<Vec<_>>()
    };
    let all = run(false, 30, 0..70);
    assert_eq!(run(true, 30, 0..70), all);
    assert_eq!(run(false, 144, 0..70), all);
    assert_eq!(run(false, 24, 66..67), all[66..67]);
}

#[test]
fn states_beyond_a_limit_are_refused() {
    let mut scene = scene::<f64>();
    let plate = scene.joint(Still::new([0.0]));
    let beyond = |done: Result<(), SceneError>| {
        let error = done.unwrap_err();
        let SceneError::Constraint(Error::Penetration { limit, .. }) = &error else {
            panic!("{error}")
        };
        assert_eq!(*limit, "floor");
    };
    beyond(scene.hang(plate, Ball::new(0.2, 0.5), [-0.1], [0.0]).map(drop));
    let ball = scene.hang(plate, Ball::new(0.2, 0.5), [0.1], [0.0]).unwrap();
    scene.advance(2.0).unwrap();
    let before = scene.snapshot();
    beyond(scene.set_state(ball, [-1e-3], [0.0]));
    beyond(scene.mirror(ball, [-1.0]).and(scene.set_state(ball, [-1.0], [0.0])));
    scene.restore(&before).unwrap();
    beyond(scene.set_motion(plate, Still::new([0.2]), Preserve::Swing));
    assert_eq!(scene.snapshot(), before);
    // Without the plate's support it falls.
    scene.set_motion(plate, Still::new([-10.0]), Preserve::Swing).unwrap();
    let top = scene.state(ball).0[0];
    scene.advance(0.5).unwrap();
    assert!((top - scene.state(ball).0[0] - 9.81 / 8.0).abs() < 1e-12);
}

#[test]
fn a_plate_that_jumps_pushes_the_ball_out() {
    let mut scene = scene::<f64>();
    let plate = scene.live([0.0]).unwrap();
    let ball = scene.hang(plate, Ball::new(0.2, 0.5), [0.1], [0.0]).unwrap();
    scene.advance(1.0).unwrap();
    scene.set_paused(true);
    scene.advance(1.0).unwrap();
    scene.set_paused(false);
    scene.move_to(plate, [0.5]).unwrap();
    assert_eq!(scene.advance(1.0 / 64.0).unwrap().jumped, 1);
    let ([y], [v]) = scene.state(ball);
    assert!((0.5 - 1e-12..0.51).contains(&y) && v.abs() < 1.0, "{y} {v}");
    assert!(scene.faults().is_empty());
}

#[test]
fn a_jet_lifts_a_ball_out_of_its_contact() {
    let mut scene = scene::<f64>();
    // It sleeps, and the jet wakes it.
    scene.set_sleep(Some(1e-3)).unwrap();
    let plate = scene.joint(Still::new([0.0]));
    let ball = scene.hang(plate, Ball::new(0.5, 0.0), [0.0], [0.0]).unwrap();
    scene.set_inputs(ball, 4.0).unwrap();
    scene.advance(0.5).unwrap();
    assert_eq!(scene.state(ball), ([0.0], [0.0]));
    scene.set_inputs(ball, 0.5 * (9.81 + 2.0)).unwrap();
    scene.advance(0.5).unwrap();
    let ([y], [v]) = scene.state(ball);
    assert!((y - 0.25).abs() < 1e-12 && (v - 1.0).abs() < 1e-12, "{y} {v}");
}

#[test]
fn a_restitution_above_one_is_a_fault_with_its_name() {
    let mut scene = scene::<f64>();
    let plate = scene.joint(Still::new([0.0]));
    let ball = scene.hang(plate, Ball::new(0.5, 1.5), [0.1], [0.0]).unwrap();
    let other = scene.hang(plate, Ball::new(0.5, 0.5), [0.1], [0.0]).unwrap();
    let advanced = scene.advance(0.5).unwrap();
    assert_eq!((advanced.failed, scene.status(ball)), (1, SceneStatus::Failed));
    assert_eq!(scene.status(other), SceneStatus::Awake);
    let error = &scene.faults()[0].error;
    assert!(matches!(error, Error::Restitution { limit: "floor", .. }), "{error}");
    // It keeps the state before the tick of the impact.
    assert!(0.0 < scene.state(ball).0[0] && scene.state(ball).0[0] < 0.01);
}

#[test]
fn a_joint_carried_by_a_ball_in_contact_rests() {
    let mut scene = scene::<f64>();
    let plate = scene.joint(Still::new([0.0]));
    let ball = scene.hang(plate, Ball::new(0.5, 0.0), [0.0], [0.0]).unwrap();
    let top = scene.joint_on::<_, 1, 2>(ball, "top").unwrap();
    let hung = scene.hang(top, Hanging::new(0.1, 0.3), [0.2], [0.0]).unwrap();
    let still = scene.joint(Still::new([0.0, 0.0]));
    let other = scene.hang(still, Hanging::new(0.1, 0.3), [0.2], [0.0]).unwrap();
    scene.advance(1.0).unwrap();
    let ([a], [b]) = (scene.state(hung).0, scene.state(other).0);
    assert!((a - b).abs() < 1e-14, "{a} for {b}");
}

#[test]
fn a_hidden_pendulum_catches_up_with_its_impacts() {
    let mut scene = scene::<f64>();
    scene.set_tolerance(1e-9).unwrap();
    let joint = scene.joint(sway());
    let knocker = Knocker { c: 0.05, ..Knocker::new(0.3, 0.5, 0.1, 0.4) };
    let [shown, hidden] = [0, 1].map(|_| scene.hang(joint, knocker.clone(), [0.4], [0.0]).unwrap());
    scene.advance(0.125).unwrap();
    scene.hide(hidden).unwrap();
    scene.advance(1.0).unwrap();
    scene.show(hidden, Resume::CatchUp { longest: 10.0 }).unwrap();
    let ([a], [b]) = (scene.state(hidden).0, scene.state(shown).0);
    assert!((a - b).abs() < 1e-4, "{a} for {b}");
}
