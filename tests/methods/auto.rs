//! The method that `solve` chooses.

use pendulum_runtime::integrate::Event;
use pendulum_runtime::integrate::{AdaptiveStep, FixedStep};
use pendulum_runtime::motion::{
    Analytic, Curve, Derivatives, Function, Motion, Projected, Sample, Side, Sinusoid,
};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::DoubleDouble;
use pendulum_runtime::time::Time;

lagrangian! {
    pub struct Simple { L, g = 9.8 }
    coordinate q;
    kinetic = L^2*q̇^2/2;
    potential = -g*L*cos(q);
}

lagrangian! {
    pub struct Moving { L, g = 9.8 }
    coordinate q;
    driven x: [m; 2];
    let r = x + L*[sin(q), -cos(q)];
    kinetic = |ṙ|^2/2;
    potential = g*height(r);
}

lagrangian! {
    pub struct Damped { L, c, g = 9.8 }
    coordinate q;
    driven x: [m; 2];
    let r = x + L*[sin(q), -cos(q)];
    kinetic = |ṙ|^2/2;
    potential = g*height(r);
    dissipation = c*q̇^2/2;
}

lagrangian! {
    pub struct Double { g }
    coordinate q[2];
    kinetic = q̇[0]^2 + q̇[1]^2/2 + q̇[0]*q̇[1]*cos(q[0] - q[1]);
    potential = -2*g*cos(q[0]) - g*cos(q[1]);
}

lagrangian! {
    pub struct Rubbed { c }
    coordinate q;
    kinetic = q̇^2/2;
    potential = q^2/2;
    force q = -c*abs(q̇)*q̇;
}

lagrangian! {
    /// Two masses between springs.
    pub struct Coupled { k }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = x^2/2 + k*(x - y)^2/2;
    dissipation = ẋ^2/20;
}

lagrangian! {
    /// Its force has no slope and is not linear.
    pub struct Relay { k }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k*abs(x);
}

/// θ after 1000 s from 1.3 at rest with g/L = 9.8: 2 asin(k sn(K − ωt | k²)) with k = sin 0.65.
const AFTER_1000_S: f64 = 1.2960573950636069;

fn lift() -> impl Motion<f64, 2> {
    Function::new(|t| [0.0, 0.5 * t * t]).velocity(|t| [0.0, t]).acceleration(|_| [0.0, 1.0])
}

#[test]
fn series_where_they_converge_everywhere() {
    let method = |rtol| {
        solve(&Simple::new(1.0), (0.0, 1.0), [1.3], [0.0]).rtol(rtol).run().unwrap().stats.method
    };
    assert_eq!([1e-3, 1e-6, 1e-12, 1e-14, 1e-18].map(method), ["Picard"; 5]);
    let method = |rtol| {
        solve(&Coupled::new(2.0), (0.0, 1.0), [1.3, 0.0], [0.0; 2])
            .rtol(rtol)
            .run()
            .unwrap()
            .stats
            .method
    };
    assert_eq!([1e-3, 1e-9, 1e-14].map(method), ["Taylor"; 3]);

    let end = solve(&Simple::new(1.0), (0.0, 1000.0), [1.3], [0.0]).rtol(1e-14).run().unwrap().end;
    assert!((end.q[0] - AFTER_1000_S).abs() < 1e-12, "{}", end.q[0]);
}

#[test]
fn two_words_stand_in_no_lanes() {
    let simple = Simple::new(1.0).map(DoubleDouble::from_f64);
    let method = |rtol| {
        let (q, v) = ([DoubleDouble::from_f64(1.3)], [DoubleDouble::from_f64(0.0)]);
        solve(&simple, (0.0, 1.0), q, v).rtol(rtol).run().unwrap().stats.method
    };
    assert_eq!([1e-3, 1e-28].map(method), ["Taylor", "Taylor"]);
    let double = Double::new(1.0).map(DoubleDouble::from_f64);
    let method = |rtol| {
        let (q, v) = ([2.0, 2.5].map(DoubleDouble::from_f64), [0.0; 2].map(DoubleDouble::from_f64));
        solve(&double, (0.0, 1.0), q, v).rtol(rtol).run().unwrap().stats.method
    };
    assert_eq!([1e-4, 1e-6, 1e-9].map(method), ["Dop853", "Dop853", "Taylor"]);
}

#[test]
fn what_it_chooses_keeps_the_tolerance() {
    let run = |rtol: f64| {
        solve(&Double::new(1.0), (0.0, 5.0), [2.0, 2.5], [0.0; 2]).rtol(rtol).run().unwrap().end.q
    };
    let [loose, tight, tighter] = [1e-6, 1e-12, 1e-15].map(run);
    assert!((loose[0] - tight[0]).abs() < 1e-4 && (tight[0] - tighter[0]).abs() < 1e-10);
}

#[test]
fn what_has_no_series_goes_without() {
    let closed = Moving::new(0.5).driven_by(lift());
    let open = Moving::new(0.5).driven_by(Sinusoid::new([0.1, 0.0], 3.0, [0.0, 0.0]));
    let by_closure = solve(&closed, (0.0, 1.0), [0.3], [0.0]).rtol(1e-14).run().unwrap();
    let by_sinusoid = solve(&open, (0.0, 1.0), [0.3], [0.0]).rtol(1e-14).run().unwrap();
    assert_eq!((by_closure.stats.method, by_sinusoid.stats.method), ("Picard", "Picard"));
    // A lift with the acceleration 1 increases gravity by 1.
    let heavier = solve(&Simple { g: 10.8, ..Simple::new(0.5) }, (0.0, 1.0), [0.3], [0.0])
        .rtol(1e-12)
        .run()
        .unwrap();
    assert!((by_closure.end.q[0] - heavier.end.q[0]).abs() < 1e-8);
    let rubbed = solve(&Rubbed::new(0.5), (0.0, 10.0), [1.0], [0.0]).rtol(1e-14).run().unwrap();
    assert_eq!(rubbed.stats.method, "Picard");
    let trusted = solve(&Rubbed::new(0.5), (0.0, 10.0), [1.0], [0.0])
        .method(Dop853)
        .rtol(1e-13)
        .atol(1e-13)
        .run()
        .unwrap();
    let error = (rubbed.end.q[0] - trusted.end.q[0]).abs();
    assert!(error < 1e-11, "{error:e} {} {}", rubbed.stats, trusted.stats);
}

#[test]
fn facts_tell_corners_apart() {
    let smooth = [Simple::<f64>::FACTS, Double::<f64>::FACTS, Rubbed::<f64>::FACTS]
        .map(|facts| facts.smooth);
    assert_eq!(smooth, [true, true, false]);
    let linear = [Simple::<f64>::FACTS, Coupled::<f64>::FACTS, Relay::<f64>::FACTS]
        .map(|facts| facts.linear);
    assert_eq!(linear, [false, true, false]);
}

#[test]
fn fixed_steps_are_symplectic_where_they_can_be() {
    let simple =
        solve(&Simple::new(1.0), (0.0, 100.0), [1.3], [0.0]).step(0.02).every(0.37).run().unwrap();
    let named = solve(&Simple::new(1.0), (0.0, 100.0), [1.3], [0.0])
        .method(Srkn14a)
        .step(0.02)
        .every(0.37)
        .run()
        .unwrap();
    assert_eq!((simple.stats, simple.q), (named.stats, named.q));
    let double =
        solve(&Double::new(1.0), (0.0, 1.0), [2.0, 2.5], [0.0; 2]).step(0.02).run().unwrap();
    assert_eq!(double.stats.method, "Dop853");
}

#[test]
fn it_is_the_method_it_names() {
    let times = [0.3, 1.7, 2.0];
    let double = Double::new(1.0);
    let chosen = || solve(&double, (0.0, 2.0), [2.0, 2.5], [0.0; 2]).t_eval(&times);
    let [a, b] = [chosen().run().unwrap(), chosen().method(Picard).run().unwrap()];
    assert_eq!((a.q, a.v, a.stats), (b.q, b.v, b.stats));
    let linear = || solve(&Coupled::<f64> { k: 2.0 }, (0.0, 2.0), [2.0, 2.5], [0.0; 2]).rtol(1e-15);
    let [a, b] = [linear().run().unwrap(), linear().method(Taylor::new()).run().unwrap()];
    assert_eq!((a.q, a.v, a.stats), (b.q, b.v, b.stats));
}

#[test]
fn back_in_time_by_series_if_there_are_some() {
    let there = solve(&Double::new(1.0), (0.0, 3.0), [1.0, 0.5], [0.0; 2]).run().unwrap().end;
    let back = solve(&Double::new(1.0), (3.0, 0.0), there.q, there.v).run().unwrap();
    assert_eq!(back.stats.method, "Taylor");
    assert!((back.end.q[0] - 1.0).abs() < 1e-4, "{:?}", back.end);
    let closed = Moving::new(0.5).driven_by(lift());
    let there = solve(&closed, (0.0, 1.0), [0.3], [0.0]).rtol(1e-9).run().unwrap().end;
    let back = solve(&closed, (1.0, 0.0), there.q, there.v).rtol(1e-9).run().unwrap();
    assert_eq!(back.stats.method, "Picard");
    assert!((back.end.q[0] - 0.3).abs() < 1e-7, "{:?}", back.end);
}

#[test]
fn fixed_steps_back_in_time_see_kinks_from_their_side() {
    let keys = Curve::catmull_rom(
        &[-0.5, 0.7, 1.3, 2.5],
        &[[0.0, 0.0], [0.3, 0.0], [-0.2, 0.1], [0.4, 0.0]],
    )
    .unwrap();
    let damped = Damped::new(0.5, 0.1).driven_by(keys);
    let there = solve(&damped, (0.0, 2.0), [0.3], [0.0])
        .method(Taylor::new())
        .rtol(1e-15)
        .run()
        .unwrap()
        .end;
    let back = solve(&damped, (2.0, 0.0), there.q, there.v).step(0.02).run().unwrap();
    assert_eq!(back.stats.method, "Taylor");
    assert!((back.end.q[0] - 0.3).abs() < 1e-12 && back.end.v[0].abs() < 1e-12, "{:?}", back.end);
}

#[test]
fn step_by_step_it_says_what_it_uses() {
    let double = Double::new(1.0);
    let mut integrator = Integrator::new(&double, Auto, 0.0, [1.0, 0.5], [0.0; 2]).unwrap();
    assert_eq!(integrator.stats().method, "Auto");
    integrator.advance_to(1.0).unwrap();
    assert_eq!(integrator.stats().method, "Picard");
    integrator.advance_to(0.0).unwrap();
    assert_eq!(integrator.stats().method, "Taylor");
    assert!((integrator.q()[0] - 1.0).abs() < 1e-5);
}

/// A parabola that implements `Motion::analytic` if `KNOWN`.
struct Parabola<const KNOWN: bool>;

impl<const KNOWN: bool> Motion<f64, 2> for Parabola<KNOWN> {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, _: Side, _: Derivatives) -> Sample<f64, 2> {
        let t = t.to_f64();
        Sample { position: [0.0, 0.5 * t * t], velocity: [0.0, t], acceleration: [0.0, 1.0] }
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }

    fn analytic(&self) -> Option<&dyn Analytic<f64, 2>> {
        KNOWN.then_some(self)
    }
}

impl<const KNOWN: bool> Analytic<f64, 2> for Parabola<KNOWN> {
    fn series(&self, t: Time, _: Side, component: usize, count: usize, position: &mut [f64; 32]) {
        let t = t.to_f64();
        position[..count].fill(0.0);
        if component == 1 {
            position[..3].copy_from_slice(&[0.5 * t * t, t, 0.5]);
        }
    }

    fn next_break(&self, _: f64) -> Option<f64> {
        None
    }

    fn last_break(&self, _: f64) -> Option<f64> {
        None
    }

    fn last_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

#[test]
fn motions_of_ones_own_say_whether_they_have_series() {
    let silent = Moving::new(0.5).driven_by(Parabola::<false>);
    let known = Moving::new(0.5).driven_by(Parabola::<true>);
    let silent = solve(&silent, (0.0, 1.0), [0.3], [0.0]).rtol(1e-14).run().unwrap();
    let there = solve(&known, (0.0, 1.0), [0.3], [0.0]).rtol(1e-14).run().unwrap();
    assert_eq!((silent.stats.method, silent.end.q), (there.stats.method, there.end.q));
    let back = solve(&known, (1.0, 0.0), there.end.q, there.end.v).rtol(1e-14).run().unwrap();
    assert_eq!(back.stats.method, "Taylor");
    assert!((back.end.q[0] - 0.3).abs() < 1e-12, "{:?}", back.end);
}

#[test]
fn what_is_seen_of_a_motion_knows_as_much_as_the_motion() {
    let frames: Vec<[f64; 3]> = (0..25)
        .map(|k| [0.1 * f64::sin(0.7 * f64::from(k)), 0.3, 0.05 * f64::cos(f64::from(k))])
        .collect();
    let times: Vec<f64> = (0..25).map(|k| f64::from(k) / 24.0).collect();
    let rows = [[0.6, 0.0, 0.8], [0.0, 2.0, 0.0]];
    let flat: Vec<[f64; 2]> = frames
        .iter()
        .map(|frame| rows.map(|row| (0..3).map(|axis| row[axis] * frame[axis]).sum()))
        .collect();
    let seen = Projected::new(Curve::spline(&times, &frames).unwrap(), rows);
    let system = || Moving { L: 0.5, g: 9.8 };
    let series = solve(&system().driven_by(seen.clone()), (0.0, 1.0), [0.3], [0.0])
        .method(Taylor::new())
        .rtol(1e-14)
        .run();
    let (seen, flat) =
        (system().driven_by(seen), system().driven_by(Curve::spline(&times, &flat).unwrap()));
    for rtol in [1e-4, 1e-12] {
        let runs = [
            solve(&seen, (0.0, 1.0), [0.3], [0.0]).rtol(rtol).run().unwrap(),
            solve(&flat, (0.0, 1.0), [0.3], [0.0]).rtol(rtol).run().unwrap(),
        ];
        assert_eq!(runs[0].stats.accepted, runs[1].stats.accepted);
        assert!((runs[0].end.q[0] - runs[1].end.q[0]).abs() < 1e-13);
        assert!((runs[0].end.q[0] - series.as_ref().unwrap().end.q[0]).abs() < 10.0 * rtol);
    }
    // The projection of a function is a function.
    let thrown = Function::new(|t| [0.0, t, t * t])
        .velocity(|t| [0.0, 1.0, 2.0 * t])
        .acceleration(|_| [0.0, 0.0, 2.0]);
    assert!(Motion::<f64, 2>::analytic(&Projected::new(thrown, rows)).is_none());
}

lagrangian! {
    pub struct Ball { m, g = 9.81 }
    coordinate y;
    kinetic = m*ẏ^2/2;
    potential = m*g*y;
}

#[test]
fn a_ball_that_is_put_back_bounces_as_if_it_began_there() {
    let ball = Ball::new(1.0);
    let floor = [Event::new(|_, y, _| y[0]).falling().terminal()];
    macro_rules! bounces {
        ($($method:expr),+) => {$({
            let mut run = Integrator::new(&ball, $method, 0.0, [1.0], [0.0]).unwrap().events(&floor).unwrap();
            // A ball falls from 1 m and keeps four fifths of its speed at each bounce: all bounces
            // take 4.06 s.
            let (mut t, mut v) = ((2.0_f64 / 9.81).sqrt(), (2.0_f64 * 9.81).sqrt());
            for _ in 0..20 {
                run.advance_to(60.0).unwrap();
                assert_eq!(run.terminal_event(), Some(0));
                let at = run.state();
                assert!((at.t - t).abs() < 1e-6 && (at.v[0] + v).abs() < 1e-6, "{at:?} at {t}");
                run.reset(at.t, at.q, [-0.8 * at.v[0]]).unwrap();
                v *= 0.8;
                t += 2.0 * v / 9.81;
            }
        })+};
    }
    bounces!(Auto, Dop853, Picard, Taylor::new());
}

#[test]
fn what_fixed_steps_took_is_not_kept_for_adaptive_ones() {
    lagrangian! {
        pub struct Duffing {}
        coordinate x;
        kinetic = ẋ^2/2;
        potential = x^4/4 - x^2/2;
    }
    let duffing = Duffing::new();
    let one = Integrator::new(&duffing, Auto, 0.0, [1.2], [0.0]).unwrap();
    let mut one = one.control(FixedStep::new(0.05)).unwrap();
    one.step().unwrap();
    let mut one = one.control(AdaptiveStep::default().rtol(1e-9)).unwrap();
    one.advance_to(2.0).unwrap();
    assert_eq!(one.stats().method, "Picard");
}

#[test]
fn the_choice_follows_the_tolerance() {
    let double = Double::new(DoubleDouble::from(9.8));
    let [q, v] = [1.3, 0.0].map(|x| [DoubleDouble::from(x); 2]);
    let one = Integrator::new(&double, Auto, 0.0, q, v).unwrap();
    let mut one = one.control(AdaptiveStep::default().rtol(1e-2)).unwrap();
    one.step().unwrap();
    assert_eq!(one.stats().method, "Dop853");
    let mut one = one.control(AdaptiveStep::default().rtol(1e-25).atol(1e-25)).unwrap();
    one.step().unwrap();
    assert_eq!(one.stats().method, "Taylor");
}
