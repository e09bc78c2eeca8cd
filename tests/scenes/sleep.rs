//! Sleeping and hidden pendulums: no computation, and no visible effect.

use pendulum_runtime::motion::{Curve, Derivatives, Motion, Sample, Side, Sinusoid, Still};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Handle, Resume, Scene, SceneStatus, Stop};
use pendulum_runtime::time::Time;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use systems::pendulums::Hanging;
use systems::random::Random;

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Strung { m: kg, k: N/m }
    coordinate u[2]: m;
    driven a: m;
    kinetic = m/2 * (u̇[0]^2 + u̇[1]^2);
    potential = k/2*(u[0] - a)^2 + 5*k*(u[1] - u[0])^2;
}

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Blown { m: kg, L: m, w: m/s^2, Ω: rad/s, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    potential = m*g*height(y) - m*w*sin(Ω*t)*y.x;
}

fn keys() -> Curve<2> {
    let times: Vec<f64> = (0..60).map(|key| f64::from(key) / 24.0).collect();
    let mut random = Random::new(5);
    let values: Vec<[f64; 2]> =
        times.iter().map(|_| [random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02)]).collect();
    Curve::linear(&times, &values).unwrap()
}

/// A motion that counts its samples.
#[derive(Clone)]
struct Watched(Arc<AtomicUsize>);

impl Motion<f64, 2> for Watched {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<f64, 2> {
        self.0.fetch_add(1, Ordering::Relaxed);
        Motion::<f64, 2>::sample(&Sinusoid::new([0.01, 0.0], 5.0, [0.0, 0.0]), t, side, wanted)
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

#[test]
fn sleepers_wake_with_the_tick_in_which_their_joint_moves() {
    let asked = Arc::new(AtomicUsize::new(0));
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    scene.set_sleep(Some(2e-3)).unwrap();
    // At rest until 30 s, then up and down.
    let keys = Curve::linear(&[30.0, 30.2, 30.4], &[[0.0, 0.0], [0.1, 0.05], [0.0, 0.0]]).unwrap();
    let joint = scene.joint(keys.clone());
    let other = scene.joint(Watched(asked.clone()));
    let handles: Vec<_> = (0..40)
        .map(|k| {
            scene.hang(joint, Hanging::new(0.1, 0.2 + 0.01 * f64::from(k)), [0.5], [0.0]).unwrap()
        })
        .collect();
    let moving = scene.hang(other, Hanging::new(0.1, 0.5), [0.0], [0.0]).unwrap();
    for &handle in &handles {
        scene.set_damping(handle, 1.0).unwrap();
    }
    scene.advance(9.0).unwrap();
    assert_eq!(scene.awake().0, 41);
    scene.advance(19.0).unwrap();
    assert_eq!(scene.awake(), (1, 41));
    assert_eq!(scene.status(handles[0]), SceneStatus::Asleep(7199));
    assert_eq!(scene.status(moving), SceneStatus::Awake);
    // Pendulums fall asleep at the bottom of the swing, and not at the top, where they are also
    // slow.
    let asleep = scene.state(handles[7]);
    assert!(asleep.0[0].abs() < 2e-3 && asleep.1 == [0.0]);
    let snapshot = scene.snapshot();
    let go = |scene: &mut Scene<f64>, frames: u32| {
        scene.restore(&snapshot).unwrap();
        for _ in 0..3 * frames {
            scene.advance(1.0 / f64::from(frames)).unwrap();
        }
        scene.snapshot()
    };
    go(&mut scene, 24);
    let coarse: Vec<_> = handles.iter().map(|&handle| scene.state(handle)).collect();
    assert_eq!(scene.awake(), (41, 41));
    go(&mut scene, 144);
    let fine: Vec<_> = handles.iter().map(|&handle| scene.state(handle)).collect();
    assert_eq!(coarse, fine);
    // The motion equals that of a pendulum that never slept, except for a tenth of a second of
    // damping.
    let alone = Hanging::new(0.1, 0.27).driven_by(keys);
    let exact = solve(&alone, (29.9, 30.1), asleep.0, [0.0]).rtol(1e-11).run().unwrap();
    scene.restore(&snapshot).unwrap();
    scene.advance(2.1).unwrap();
    assert!(
        (scene.state(handles[7]).0[0] - exact.end.q[0]).abs()
            < 0.05 * (exact.end.q[0] - asleep.0[0]).abs() + 2e-3
    );
    // A changed pendulum wakes.
    scene.restore(&snapshot).unwrap();
    scene.set_parameter_everywhere("g", 5.0).unwrap();
    assert_eq!(scene.awake().0, 41);
}

#[test]
fn what_comes_back_to_the_screen_has_not_stood_still() {
    let build = || {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        scene.set_tolerance(1e-8).unwrap();
        let joint = scene.joint(keys());
        let handles: Vec<_> = (0..3)
            .map(|_| scene.hang(joint, Hanging::new(0.1, 0.4), [0.3], [0.0]).unwrap())
            .collect();
        for &handle in &handles {
            scene.set_damping(handle, 0.5).unwrap();
            scene.set_limits(handle, [-0.2], [0.2], Stop::Soft { stiffness: 40.0 }).unwrap();
        }
        (scene, handles)
    };
    let (mut seen, shown) = build();
    let (mut hidden, handles) = build();
    for scene in [&mut seen, &mut hidden] {
        scene.advance(0.25).unwrap();
    }
    for &handle in &handles {
        hidden.hide(handle).unwrap();
    }
    let (q, _) = hidden.state(handles[0]);
    for scene in [&mut seen, &mut hidden] {
        scene.advance(1.75).unwrap();
    }
    assert_eq!(hidden.awake().0, 0);
    hidden.show(handles[0], Resume::Unchanged).unwrap();
    hidden.show(handles[1], Resume::Rest).unwrap();
    hidden.show(handles[2], Resume::CatchUp { longest: 60.0 }).unwrap();
    assert_eq!(hidden.state(handles[0]).0, q);
    assert!(hidden.state(handles[1]).0[0].abs() < 1e-12);
    let (exact, made_up) = (seen.state(shown[2]), hidden.state(handles[2]));
    assert!((exact.0[0] - made_up.0[0]).abs() < 1e-4, "{} for {}", made_up.0[0], exact.0[0]);
    assert_eq!(hidden.awake().0, 3);
}

#[test]
fn single_numbers_catch_up_too() {
    let mut scene = Scene::<f32>::new(240.0).unwrap();
    let joint = scene.joint(Sinusoid::new([0.01, 0.0], 5.0, [0.0, 0.0]));
    let handle = scene.hang(joint, Hanging::new(0.1, 0.5), [0.1], [0.0]).unwrap();
    scene.hide(handle).unwrap();
    scene.advance(3.0).unwrap();
    scene.show(handle, Resume::CatchUp { longest: 10.0 }).unwrap();
    let alone = Hanging::new(0.1, 0.5).driven_by(Sinusoid::new([0.01, 0.0], 5.0, [0.0, 0.0]));
    let exact = solve(&alone, (0.0, 3.0), [0.1], [0.0]).rtol(1e-12).atol(1e-12).run().unwrap();
    let off = f64::from(scene.state(handle).0[0]) - exact.end.q[0];
    assert!(off.abs() < 1e-4, "{off}");
}

#[test]
fn another_rest_is_another_bed() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    scene.set_sleep(Some(1e-3)).unwrap();
    // The joint moves from one rest position to another, 0.3 m away, and stays there.
    let joint = scene.joint(Curve::linear(&[20.0, 21.0], &[[0.0], [0.3]]).unwrap());
    let handle = scene.hang(joint, Strung::new(0.1, 4.0), [0.05, 0.0], [0.0, 0.0]).unwrap();
    scene.set_damping(handle, 2.0).unwrap();
    scene.advance(19.0).unwrap();
    assert_eq!(scene.status(handle), SceneStatus::Asleep(4799));
    scene.advance(1.5).unwrap();
    assert_eq!(scene.status(handle), SceneStatus::Awake);
    scene.advance(20.0).unwrap();
    assert_eq!(scene.status(handle), SceneStatus::Asleep(i64::MAX));
    let (q, _) = scene.state(handle);
    assert!(q.iter().all(|q| (q - 0.3).abs() < 1e-3), "{q:?}");
    // A pendulum wakes when its state is changed, and all pendulums wake when sleep is disabled.
    scene.set_state(handle, [0.4, 0.3], [0.0, 0.0]).unwrap();
    scene.advance(30.0).unwrap();
    assert!(matches!(scene.status(handle), SceneStatus::Asleep(_)));
    scene.mirror(handle, [-1.0, -1.0]).unwrap();
    assert_eq!(scene.status(handle), SceneStatus::Awake);
    scene.advance(30.0).unwrap();
    assert!(matches!(scene.status(handle), SceneStatus::Asleep(_)));
    scene.set_sleep(None).unwrap();
    assert_eq!(scene.awake(), (1, 1));
    scene.advance(1.0).unwrap();
    assert_eq!(scene.awake(), (1, 1));
}

#[test]
fn nobody_sleeps_who_is_about_to_be_moved() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    scene.set_sleep(Some(0.1)).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    // A weak wind that grows, although the joint is at rest.
    let blown = scene.hang(joint, Blown::new(0.1, 0.5, 0.5, 0.1), [0.0], [0.0]).unwrap();
    // Upside down, slow but not at rest.
    let high = scene.hang(joint, Hanging::new(0.1, 0.5), [std::f64::consts::PI], [0.0]).unwrap();
    // Swinging, and slow at the ends of the swing.
    let swinging = scene.hang(joint, Hanging::new(0.1, 0.5), [0.11], [0.0]).unwrap();
    // Below the tolerance.
    let hardly = scene.hang(joint, Hanging::new(0.1, 0.5), [0.09], [0.0]).unwrap();
    for _ in 0..600 {
        scene.advance_ticks(1);
        assert_eq!(
            [scene.status(blown), scene.status(high), scene.status(swinging)],
            [SceneStatus::Awake; 3]
        );
    }
    assert_eq!(scene.status(hardly), SceneStatus::Asleep(i64::MAX));
    assert!(scene.state(blown).0[0].abs() > 1e-3);
}

#[test]
fn single_numbers_fall_asleep_too() {
    let mut scene = Scene::<f32>::new(240.0).unwrap();
    scene.set_sleep(Some(5e-4)).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    let handles: Vec<Handle<Hanging<f32>, 1>> = (0..40)
        .map(|k| scene.hang(joint, Hanging::new(0.1, 0.2 + 0.02 * k as f32), [0.5], [0.0]).unwrap())
        .collect();
    for &handle in &handles {
        scene.set_damping(handle, 2.0).unwrap();
    }
    scene.advance(4.0).unwrap();
    assert_eq!(scene.awake(), (40, 40));
    scene.advance(8.0).unwrap();
    assert_eq!(scene.awake(), (0, 40));
    assert!(handles.iter().all(|&handle| scene.state(handle).0[0].abs() < 5e-4));
}

#[test]
fn joints_of_sleepers_are_not_asked() {
    let asked = Arc::new(AtomicUsize::new(0));
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let joint = scene.joint(Watched(asked.clone()));
    let handle = scene.hang(joint, Hanging::new(0.1, 0.5), [0.1], [0.0]).unwrap();
    scene.hide(handle).unwrap();
    asked.store(0, Ordering::Relaxed);
    scene.advance(60.0).unwrap();
    assert_eq!(asked.load(Ordering::Relaxed), 0);
    // Catching up a minute takes far fewer steps than its 14400 ticks.
    scene.show(handle, Resume::CatchUp { longest: 100.0 }).unwrap();
    let steps = asked.load(Ordering::Relaxed);
    assert!(steps < 4_500, "{steps}");
    let alone = Hanging::new(0.1, 0.5).driven_by(Sinusoid::new([0.01, 0.0], 5.0, [0.0, 0.0]));
    let exact = solve(&alone, (0.0, 60.0), [0.1], [0.0]).rtol(1e-12).atol(1e-12).run().unwrap();
    assert!((scene.state(handle).0[0] - exact.end.q[0]).abs() < 1e-4);
    // A pendulum that was hidden for too long starts at rest.
    scene.hide(handle).unwrap();
    scene.advance(60.0).unwrap();
    scene.show(handle, Resume::CatchUp { longest: 2.0 }).unwrap();
    let late = solve(&alone, (118.0, 120.0), [0.0], [0.0]).rtol(1e-12).atol(1e-12).run().unwrap();
    assert!((scene.state(handle).0[0] - late.end.q[0]).abs() < 1e-4);
    assert!(scene.show(handle, Resume::CatchUp { longest: -1.0 }).is_ok());
    scene.hide(handle).unwrap();
    assert!(scene.show(handle, Resume::CatchUp { longest: -1.0 }).is_err());
    assert!(matches!(scene.status(handle), SceneStatus::Hidden(_)));
}

#[test]
fn who_has_gone_round_sleeps_where_it_hangs() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    scene.set_sleep(Some(2e-3)).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    let round = scene.hang(joint, Hanging::new(0.01, 0.1), [0.0], [24.0]).unwrap();
    let put = scene.hang(joint, Hanging::new(0.01, 0.1), [0.0], [0.5]).unwrap();
    // Upside down is no rest position: the pendulum falls.
    let high = scene.hang(joint, Hanging::new(0.01, 0.1), [std::f64::consts::PI], [0.0]).unwrap();
    for handle in [round, put, high] {
        scene.set_damping(handle, 0.5).unwrap();
    }
    scene.advance(0.5).unwrap();
    scene.set_state(put, [std::f64::consts::TAU + 0.5], [0.0]).unwrap();
    scene.set_state(high, [std::f64::consts::PI], [1e-3]).unwrap();
    for _ in 0..40 {
        scene.advance(1.0).unwrap();
        for handle in [round, put, high] {
            if scene.status(handle) != SceneStatus::Awake {
                let (q, _) = scene.state(handle);
                assert!(q[0].sin().abs() < 2e-3 && 0.0 < q[0].cos(), "{q:?}");
            }
        }
    }
    assert_eq!(scene.awake(), (0, 3));
    assert!(scene.state(round).0[0] > 6.0 && scene.state(high).0[0].abs() < 7.0);
}

#[test]
fn limits_are_felt_at_rest_and_asleep() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    scene.set_sleep(Some(2e-3)).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    let mut hang = |stop| {
        let handle = scene.hang(joint, Hanging::new(0.01, 0.1), [0.0], [0.0]).unwrap();
        scene.set_damping(handle, 4.0).unwrap();
        scene.set_limits(handle, [0.3], [1.0], stop).unwrap();
        handle
    };
    let (soft, hard) =
        (hang(Stop::Soft { stiffness: 900.0 }), hang(Stop::Hard { restitution: 0.3 }));
    // The spring beyond the limit bears the weight: 900 (0.3 − θ) = 98.1 sin θ.
    let mut rest = 0.3;
    for _ in 0..50 {
        rest = 0.3 - 98.1 * f64::sin(rest) / 900.0;
    }
    // The wall holds the pendulum from the start.
    assert_eq!(scene.state(hard), ([0.3], [0.0]));
    for _ in 0..20 {
        scene.advance(0.5).unwrap();
        assert!(
            scene.status(soft) == SceneStatus::Awake
                || (scene.state(soft).0[0] - rest).abs() < 2e-3
        );
    }
    assert_eq!(scene.awake(), (0, 2));
    assert!((scene.state(hard).0[0] - 0.3).abs() < 2e-3);
    scene.set_state(soft, [2.0], [1.0]).unwrap();
    scene.set_state(hard, [2.0], [1.0]).unwrap();
    assert_eq!(scene.state(hard), ([1.0], [0.0]));
    for handle in [soft, hard] {
        scene.reset_to_rest(handle).unwrap();
    }
    assert!((scene.state(soft).0[0] - rest).abs() < 1e-12 && scene.state(hard).0[0] == 0.3);
    scene.advance(1.0).unwrap();
    assert!((scene.state(soft).0[0] - rest).abs() < 1e-12);
}

#[test]
fn catching_up_begins_at_the_rest_of_that_time() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    // The rest position of `Strung` depends on its joint, which moves by 5 m in the last second.
    let joint = scene.joint(Curve::linear(&[0.0, 9.0, 10.0], &[[0.0], [0.0], [5.0]]).unwrap());
    let handles =
        [0, 1].map(|_| scene.hang(joint, Strung::new(1.0, 40.0), [0.0, 0.0], [0.0, 0.0]).unwrap());
    for handle in handles {
        scene.set_damping(handle, 1.0).unwrap();
    }
    scene.hide(handles[1]).unwrap();
    scene.advance(10.0).unwrap();
    scene.show(handles[1], Resume::CatchUp { longest: 2.0 }).unwrap();
    let [(live, _), (caught_up, _)] = handles.map(|handle| scene.state(handle));
    assert!(
        live[0] > 1.0 && (0..2).all(|i| (live[i] - caught_up[i]).abs() < 5e-3),
        "{live:?} {caught_up:?}"
    );
}
