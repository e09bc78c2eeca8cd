//! Pendulums with constraints in scenes, compared with `solve`.

use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::assemble;
use pendulum_runtime::motion::{Curve, Sinusoid, Still};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scene::{Preserve, Resume, Scene, SceneError, SceneStatus};
use pendulum_runtime::system::System;

lagrangian! {
    /// A feather on a wing that is a four-bar linkage: its shoulder moves.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Wing { l: [m; 3], d: m, m: [kg; 3], f: m, w: kg, k: N*m, g: m/s^2 = 9.81 }
    coordinate α: rad;
    coordinate β: rad;
    coordinate γ: rad;
    coordinate φ: rad;
    driven shoulder: [m; 2];
    let elbow = l[0]*cis(α);
    let tip = elbow + l[1]*cis(β);
    let feather = tip + f*[sin(φ), -cos(φ)];
    kinetic = m[0]/2*|dot(shoulder + elbow/2)|^2 + m[1]/2*|dot(shoulder + elbow + l[1]/2*cis(β))|^2
        + m[2]/6*l[2]^2*γ̇^2 + w/2*|dot(shoulder + feather)|^2;
    potential = g*(m[0]*height(elbow)/2 + m[1]*height(elbow + tip)/2 + w*height(feather))
        + k/2*(α - 1)^2;
    constraint loop: tip = [d, 0] + l[2]*cis(γ);
}

lagrangian! {
    /// A bead on a rod whose other end is driven, in absolute coordinates.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Bead { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    driven p: [m; 2];
    kinetic = m/2*(ẋ^2 + ẏ^2);
    potential = m*g*y;
    constraint rod: |[x, y] - p| = L;
}

fn wing<T: Real>() -> Wing<T> {
    let number = T::from_f64;
    Wing::new(
        [0.4, 1.1, 0.8].map(number),
        number(1.0),
        [0.5, 1.2, 0.7].map(number),
        number(0.3),
        number(0.05),
        number(30.0),
    )
}

fn flap() -> Sinusoid<2> {
    Sinusoid::new([0.02, 0.1], 9.0, [0.0, 0.4])
}

fn posed() -> ([f64; 4], [f64; 4]) {
    let wing = wing::<f64>().driven_by(flap());
    let start = assemble(&wing, 0.0, [1.0, 0.4, 1.8, 0.3], [0.0; 4]).hold("α").hold("φ").run();
    let start = start.unwrap();
    (start.q, start.v)
}

#[test]
fn a_feather_on_a_four_bar_wing_follows_solve() {
    let ((q, v), driven) = (posed(), wing::<f64>().driven_by(flap()));
    let exact = solve(&driven, (0.0, 2.0), q, v).rtol(1e-10).run().unwrap().end;
    let off = |rate: f64| {
        let mut scene = Scene::<f64>::new(rate).unwrap();
        scene.set_tolerance(1e-6).unwrap();
        let shoulder = scene.joint(flap());
        let hung = scene.hang(shoulder, wing(), q, v).unwrap();
        scene.advance(2.0).unwrap();
        assert_eq!(scene.status(hung), SceneStatus::Awake, "{:?}", scene.faults());
        let (end, rates) = scene.state(hung);
        let inputs = Dynamics::inputs(
            &driven,
            pendulum_runtime::time::Time::new(2.0),
            pendulum_runtime::motion::Side::After,
            pendulum_runtime::system::Purpose::Momenta,
        );
        let [misfits, speeds] =
            scene.system(hung).misfits(At { t: 2.0, q: &end, v: &rates, inputs: &inputs });
        assert!(
            misfits.iter().chain(&speeds).all(|off| off.abs() < 1e-14),
            "{misfits:?} {speeds:?}"
        );
        (0..4).map(|i| (end[i] - exact.q[i]).abs()).fold(0.0, f64::max)
    };
    let (coarse, fine) = (off(240.0), off(960.0));
    assert!(coarse < 1e-4 && fine < coarse / 30.0, "{coarse} {fine}");
}

#[test]
fn every_frame_rate_and_lane_has_the_same_bits() {
    let (q, v) = posed();
    let (q, v) = (q.map(|q| q as f32), v.map(|v| v as f32));
    let single = wing::<f32>().driven_by(flap());
    let start = assemble(&single, 0.0, q, v).run().unwrap();
    let run = |frame: f64, count: usize| {
        let mut scene = Scene::<f32>::new(240.0).unwrap();
        let shoulder = scene.joint(flap());
        let hang = |_| scene.hang(shoulder, wing(), start.q, start.v).unwrap();
        let hung: Vec<_> = (0..count).map(hang).collect();
        while scene.tick() < 240 {
            scene.advance(frame).unwrap();
        }
        hung.iter().map(|&hung| scene.state(hung)).collect::<Vec<_>>()
    };
    let (alone, many) = (run(1.0, 1), run(1.0 / 60.0, 40));
    assert!(many.iter().all(|state| *state == alone[0]));
}

#[test]
fn a_kink_of_the_joint_is_felt() {
    let line = Curve::linear(&[0.0, 0.501, 1.0], &[[0.0, 0.0], [0.3, 0.0], [0.0, 0.2]]).unwrap();
    let bead = Bead::new(0.2, 0.5).driven_by(line.clone());
    let speed = 0.3 / 0.501;
    let (q, v) = ([0.0, -0.5], [speed, 0.0]);
    let exact = solve(&bead, (0.0, 1.0), q, v).rtol(1e-10).run().unwrap().end;
    let mut scene = Scene::<f64>::new(480.0).unwrap();
    scene.set_tolerance(1e-8).unwrap();
    let hook = scene.joint(line);
    let hung = scene.hang(hook, Bead::new(0.2, 0.5), q, v).unwrap();
    scene.advance(1.0).unwrap();
    let (end, rates) = scene.state(hung);
    for i in 0..2 {
        assert!((end[i] - exact.q[i]).abs() < 1e-6, "{end:?} {:?}", exact.q);
        assert!((rates[i] - exact.v[i]).abs() < 1e-5, "{rates:?} {:?}", exact.v);
    }
}

#[test]
fn states_that_do_not_fit_are_refused() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let hook = scene.joint(Still::new([1.0, 2.0]));
    let refused = scene.hang(hook, Bead::new(0.2, 0.5), [1.0, 1.6], [0.0; 2]).unwrap_err();
    assert!(matches!(
        &refused,
        SceneError::Constraint(Error::Inconsistent { constraint: "rod", .. })
    ));
    assert!(refused.to_string().contains("the constraint rod is off by 0.1"), "{refused}");
    let hung = scene.hang(hook, Bead::new(0.2, 0.5), [1.0, 1.5], [0.2, 0.0]).unwrap();
    assert!(scene.set_state(hung, [1.0, 1.5], [0.2, 0.1]).is_err());
    assert_eq!(scene.state(hung), ([1.0, 1.5], [0.2, 0.0]));
    assert!(scene.mirror(hung, [-1.0, 1.0]).is_err());
    scene.set_state(hung, [0.5, 2.0], [0.0, 0.3]).unwrap();
    assert_eq!(scene.state(hung).0, [0.5, 2.0]);
}

#[test]
fn changes_put_pendulums_back_onto_their_constraints() {
    let mut scene = Scene::<f64>::new(240.0).unwrap();
    let hook = scene.joint(Still::new([0.0, 0.0]));
    let hung = scene.hang(hook, Bead::new(0.2, 0.5), [0.3, -0.4], [0.4, 0.3]).unwrap();
    let length = |scene: &Scene<f64>, [a, b]: [f64; 2]| {
        let [x, y] = scene.state(hung).0;
        (x - a).hypot(y - b)
    };
    scene.set_parameter(hung, "L", 0.6).unwrap();
    assert!((length(&scene, [0.0; 2]) - 0.6).abs() < 1e-15);
    scene.set_parameter_everywhere("L", 0.55).unwrap();
    assert!((length(&scene, [0.0; 2]) - 0.55).abs() < 1e-15);
    // A rod of length zero has no direction.
    assert!(scene.set_parameter(hung, "L", 0.0).is_err());
    assert_eq!(scene.system(hung).L, 0.55);
    scene.set_motion(hook, Still::new([2.0, 1.0]), Preserve::Swing).unwrap();
    assert!((length(&scene, [2.0, 1.0]) - 0.55).abs() < 1e-14);
    scene.advance(0.5).unwrap();
    assert!((length(&scene, [2.0, 1.0]) - 0.55).abs() < 1e-14);
    scene.set_motion(hook, Still::new([0.0, 0.0]), Preserve::Nothing).unwrap();
    let (q, v) = scene.state(hung);
    assert!(q[0].abs() < 1e-9 && (q[1] + 0.55).abs() < 1e-12 && v == [0.0; 2], "{q:?}");
}

#[test]
fn one_that_is_lost_is_frozen_with_its_reason() {
    let mut scene = Scene::<f64>::new(60.0).unwrap();
    let hook = scene.joint(Still::new([0.0, 0.0]));
    // Too fast for any step.
    let hung = scene.hang(hook, Bead::new(0.2, 0.5), [0.0, -0.5], [900.0, 0.0]).unwrap();
    let other = scene.hang(hook, Bead::new(0.2, 0.5), [0.0, -0.5], [0.1, 0.0]).unwrap();
    scene.advance(0.2).unwrap();
    assert_eq!(scene.status(hung), SceneStatus::Failed);
    let [x, y] = scene.state(hung).0;
    assert!((x.hypot(y) - 0.5).abs() < 1e-7);
    assert_eq!(scene.status(other), SceneStatus::Awake);
    let fault = scene.faults()[0].to_string();
    assert!(fault.contains("rod"), "{fault}");
}

#[test]
fn hidden_ones_catch_up_and_come_to_rest() {
    let mut scene = Scene::<f64>::new(960.0).unwrap();
    scene.set_tolerance(1e-8).unwrap();
    let hook = scene.joint(Sinusoid::new([0.1, 0.0], 3.0, [0.0, 0.0]));
    let hang = |scene: &mut Scene<f64>| {
        scene.hang(hook, Bead::new(0.2, 0.5), [0.0, -0.5], [0.3, 0.0]).unwrap()
    };
    let (seen, hidden, resting) = (hang(&mut scene), hang(&mut scene), hang(&mut scene));
    scene.hide(hidden).unwrap();
    scene.hide(resting).unwrap();
    scene.advance(1.0).unwrap();
    scene.show(hidden, Resume::CatchUp { longest: 10.0 }).unwrap();
    let ((a, _), (b, _)) = (scene.state(seen), scene.state(hidden));
    assert!((a[0] - b[0]).abs() < 1e-4 && (a[1] - b[1]).abs() < 1e-4, "{a:?} {b:?}");
    scene.show(resting, Resume::Rest).unwrap();
    let [x, y] = scene.state(resting).0;
    let pivot = 0.1 * 3.0_f64.sin();
    assert!((x - pivot).abs() < 1e-6 && (y + 0.5).abs() < 1e-9, "{x} {pivot} {y}");
    scene.advance(0.1).unwrap();
    assert_eq!(scene.status(resting), SceneStatus::Awake, "{:?}", scene.faults());
}

lagrangian! {
    /// A bob on a rod, without angles.
    #[derive(Clone, Debug)]
    pub struct Bob { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate u: m;
    coordinate w: m;
    kinetic = m/2 * (u̇^2 + ẇ^2);
    potential = m*g*w;
    constraint rod: u^2 + w^2 = L^2;
}

#[test]
fn a_bob_on_a_rod_sleeps_if_it_swings_by_less_than_the_tolerance() {
    let tolerance = 1e-3;
    for (swing, sleeps) in [(0.9 * tolerance, true), (1.1 * tolerance, false)] {
        let mut scene = Scene::<f64>::new(240.0).unwrap();
        let (sin, cos) = (swing / 0.5f64).asin().sin_cos();
        let start = [0.5 * sin, -0.5 * cos];
        let bob = scene.hang((), Bob::new(1.0, 0.5), start, [0.0, 0.0]).unwrap();
        scene.set_sleep(Some(tolerance)).unwrap();
        scene.advance_ticks(40);
        assert_eq!(matches!(scene.status(bob), SceneStatus::Asleep(_)), sleeps, "{swing}");
    }
}
