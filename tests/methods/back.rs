//! Back in time: every method, over kinks and with events.

use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{Event, Failure};
use pendulum_runtime::motion::{
    Curve, Derivatives, Function, Motion, Sample, Side, Sinusoid, Still,
};
use pendulum_runtime::prelude::*;
use pendulum_runtime::time::Time;
use systems::problems::{Double, Simple};

lagrangian! {
    pub struct Hand { L: m, c: 1/s, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L * [sin(θ), -cos(θ)];
    kinetic = |ẏ|^2/2;
    potential = g*height(y);
    dissipation = c*L^2/2 * θ̇^2;
}

lagrangian! {
    pub struct Free { L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L * [sin(θ), -cos(θ)];
    kinetic = |ẏ|^2/2;
    potential = g*height(y);
}

const KEYS: [f64; 6] = [0.0, 0.31, 0.72, 1.5, 2.6, 4.0];
const PLACES: [[f64; 2]; 6] =
    [[0.0, 0.0], [0.3, 0.1], [0.1, 0.0], [0.0, -0.2], [0.2, 0.0], [0.0, 0.0]];

/// Makes the same calls forwards and back in time.
macro_rules! each {
    ($there:expr, $back:expr, $check:expr; $([$($call:tt)*] $within:expr),+ $(,)?) => {
        $({
            let there = $there $($call)*.run().unwrap();
            let back = ($back)(there.end) $($call)*.run().unwrap();
            $check(stringify!($($call)*), there, back, $within);
        })+
    };
}

#[test]
fn every_method_comes_back_over_kinks() {
    // Velocities jump at every key.
    let hand = Hand::new(1.0, 0.1).driven_by(Curve::linear(&KEYS, &PLACES).unwrap());
    let check = |method: &str, there: Solution<f64, 1>, back: Solution<f64, 1>, within: f64| {
        let error = (back.end.q[0] - 0.3).abs().max((back.end.v[0] - 0.2).abs());
        assert!(error < within, "{method}: {error:e}");
        assert_eq!((there.stats.kinks, back.stats.kinks, back.end.t), (4, 4, 0.1), "{method}");
    };
    each!(
        solve(&hand, (0.1, 3.7), [0.3], [0.2]),
        |end: State<f64, 1>| solve(&hand, (3.7, 0.1), end.q, end.v), check;
        [.rtol(1e-11)] 1e-8, [.method(Picard).rtol(1e-11)] 1e-8, [.method(Dop853).rtol(1e-11)] 1e-8,
        [.method(Rodas4).rtol(1e-7)] 1e-4, [.method(Taylor::new()).rtol(1e-11)] 1e-8,
        [.method(Rk4).step(1e-3)] 1e-8, [.method(Gauss::<3>::new()).step(1e-2)] 1e-9,
        [.method(Gauss::<3>::new().newton()).step(1e-2)] 1e-9, [.step(1e-2)] 1e-9,
    );
}

#[test]
fn every_method_comes_back_over_accelerations_that_jump() {
    let hand = Free::new(1.0).driven_by(Curve::catmull_rom(&KEYS, &PLACES).unwrap());
    let check = |method: &str, _: Solution<f64, 1>, back: Solution<f64, 1>, within: f64| {
        let error = (back.end.q[0] - 0.3).abs().max((back.end.v[0] - 0.2).abs());
        assert!(error < within, "{method}: {error:e}");
    };
    // A wrong side at the ends of steps on kinks would cause large errors.
    each!(
        solve(&hand, (0.1, 3.7), [0.3], [0.2]),
        |end: State<f64, 1>| solve(&hand, (3.7, 0.1), end.q, end.v), check;
        [.method(Picard).rtol(1e-12)] 1e-9, [.method(Dop853).rtol(1e-12)] 1e-9,
        [.method(Rodas4).rtol(1e-7)] 1e-4, [.method(Dprkn12).rtol(1e-12)] 1e-9,
        [.method(Leapfrog).step(1e-3)] 1e-12, [.method(SymplecticEuler).step(1e-3)] 2e-2, [.method(Rk4).step(1e-3)] 1e-9,
    );
}

#[test]
fn events_are_the_same_both_ways() {
    let double = Double::new([1.0; 2], [1.0; 2], 9.81);
    let known = [0.25, 0.8, 1.9];
    let events = || {
        [
            Event::new(|_t, q, _v| q[0]),
            Event::new(|_t, q, _v| q[1] - 0.1).rising(),
            Event::new(|_t, _q, v| v[0]).falling(),
            Event::at(known),
        ]
    };
    let check = |method: &str, there: Solution<f64, 2>, back: Solution<f64, 2>, within: f64| {
        assert!(6 <= there.events.len(), "{method}: {}", there.events.len());
        assert_eq!(there.events.len(), back.events.len(), "{method}");
        for (found, expected) in back.events.iter().rev().zip(&there.events) {
            assert_eq!(found.event, expected.event, "{method}");
            assert!((found.state.t - expected.state.t).abs() < within, "{method}");
        }
        // The dense output covers runs back in time.
        let (found, expected) = (back.at(1.1).unwrap(), there.at(1.1).unwrap());
        assert!((found.q[0] - expected.q[0]).abs() < within, "{method}");
    };
    each!(
        solve(&double, (0.1, 2.3), [0.7, 0.3], [0.3, 0.1]).events(events()).dense(),
        |end: State<f64, 2>| solve(&double, (2.3, 0.1), end.q, end.v).events(events()).dense(), check;
        [.rtol(1e-11)] 1e-8, [.method(Picard).rtol(1e-11)] 1e-8, [.method(Dop853).rtol(1e-11)] 1e-8,
        [.method(Rodas4).rtol(1e-7)] 1e-4, [.method(Rk4).step(1e-3)] 1e-6,
    );
}

#[test]
fn an_integrator_turns_round() {
    let simple = Simple::new(9.81);
    let known = [0.5, 1.5];
    let events = [Event::new(|_t, q, _v| q[0]), Event::at(known)];
    let mut run =
        Integrator::new(&simple, Dop853, 0.0, [1.0], [0.0]).unwrap().events(events).unwrap();
    run.advance_to(2.0).unwrap();
    let there: Vec<f64> = run.occurrences().iter().map(|found| found.state.t).collect();
    for _ in 0..2 {
        run.advance_to(0.0).unwrap();
        let back: Vec<f64> = run.occurrences().iter().rev().map(|found| found.state.t).collect();
        assert!(
            there.len() == back.len() && there.iter().zip(&back).all(|(a, b)| (a - b).abs() < 1e-4)
        );
        run.advance_to(2.0).unwrap();
        assert_eq!(run.occurrences().len(), there.len());
    }
    // A terminal event also ends a run back in time.
    let down = Event::new(|_t, q, _v| q[0]).terminal();
    let end = run.state();
    let back =
        solve(&simple, (2.0, 0.0), end.q, end.v).method(Dop853).events([down]).run().unwrap();
    assert!(0.0 < back.end.t && back.end.q[0].abs() < 1e-12);
}

#[test]
fn what_acts_or_has_unknown_kinks_has_no_way_back() {
    let simple = Simple::new(9.81);
    let wall = || [Event::new(|_t, q, _v| q[0]).then(|state| state.v[0] *= -1.0)];
    let failure = solve(&simple, (1.0, 0.0), [0.1], [0.0]).events(wall()).run().unwrap_err();
    assert_eq!(failure.error, Error::Backwards { t: 1.0, event: 0 });
    assert!(failure.to_string().contains("`then`"), "{failure}");
    let mut run =
        Integrator::new(&simple, Dop853, 1.0, [0.1], [0.0]).unwrap().events(wall()).unwrap();
    assert_eq!(run.advance_to(0.0), Err(Error::Backwards { t: 1.0, event: 0 }));
    let hand = Hand::new(1.0, 0.0).driven_by(Silent);
    let failed: Failure<f64, 1> =
        solve(&hand, (1.0, 0.0), [0.1], [0.0]).method(Dop853).run().unwrap_err();
    assert_eq!(failed.error, Error::Interval { start: 1.0, end: 0.0 });
    assert!(failed.to_string().contains("`kink_before`"), "{failed}");
}

/// A motion that does not implement `kink_before`.
struct Silent;

impl Motion<f64, 2> for Silent {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, _: Time, _: Side, _: Derivatives) -> Sample<f64, 2> {
        Sample::zero()
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

#[test]
fn kinks_before_a_time_are_those_after_an_earlier_one() {
    fn check(motion: &impl Motion<f64, 2>) {
        let (mut kinks, mut t) = (Vec::new(), -5.0);
        while let Some(kink) = motion.next_kink(t).filter(|kink| *kink < 10.0) {
            kinks.push(kink);
            t = kink;
        }
        let mut t = 10.0;
        for &kink in kinks.iter().rev() {
            t = motion.kink_before(t).unwrap();
            assert_eq!(t, kink);
        }
        assert!(motion.kink_before(t).unwrap() < -5.0);
    }
    check(&Curve::linear(&KEYS, &PLACES).unwrap());
    check(&Curve::catmull_rom(&KEYS, &PLACES).unwrap());
    check(&Curve::spline(&KEYS, &PLACES).unwrap());
    check(&Sinusoid::new([0.1, 0.0], 2.0, [0.0, 0.0]));
    check(&Still::new([0.1, 0.0]));
    check(&Function::new(|t| [t.abs(), (t - 1.0).abs()]).kinks(&[1.0, 0.0]));
}

#[test]
fn a_motion_that_turns_faster_and_faster_ends_long_before_ten_million_steps() {
    for (c, time) in [(-300.0, (0.0, 10.0)), (-3000.0, (0.0, 10.0)), (300.0, (0.0, -20.0))] {
        let damped = Hand { L: 1.0, c, g: 9.81 }.driven_by(Still::new([0.0; 2]));
        let mut taken = 0;
        let run = solve(&damped, time, [1.0], [0.0]).rtol(1e-9).on_step(|step| {
            taken = step.stats.accepted + step.stats.rejected;
            core::ops::ControlFlow::Continue(())
        });
        let error = run.run().unwrap_err().error;
        assert!(
            matches!(error, Error::MaxSteps { .. } | Error::StepSizeUnderflow { .. }),
            "{error}"
        );
        assert!(taken < 40_000, "{taken}");
    }
}
