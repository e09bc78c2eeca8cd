//! Events: their times, order, number, and the end of runs.

use super::systems::{DoublePendulum, MovingPendulum, Pendulum, double_pendulum, pendulum};
use core::f64::consts::PI;
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{
    Dop853, Event, FixedStep, Integrator, Leapfrog, Occurrence, Rk4, Srkn14a, Status,
    SymplecticEuler, solve,
};
use pendulum_runtime::motion::Curve;
use pendulum_runtime::scalar::{DoubleDouble, Float, Real};
use pendulum_runtime::system::Driven;

/// The period of the pendulum from 1.3: 2π/agm(1, cos 0.65).
const PERIOD: f64 = 7.01925031184454654977054;

fn times<T: Copy, const N: usize>(events: &[Occurrence<T, N>], event: usize) -> Vec<f64> {
    events.iter().filter(|found| found.event == event).map(|found| found.state.t).collect()
}

fn assert_times(found: &[f64], expected: &[f64], within: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() <= within,
            "{found} instead of {expected}, off by {:e}",
            found - expected
        );
    }
}

#[test]
fn the_first_flip_of_the_chaotic_double_pendulum() {
    let flip = |_: f64, q: &[f64; 2], _: &[f64; 2]| q[0] - PI;
    let events = [Event::new(flip).rising().terminal()];
    let run = |tolerance| {
        solve(&double_pendulum(), (0.0, 20.0), [2.0, 2.5], [0.0; 2])
            .method(Dop853)
            .rtol(tolerance)
            .atol(tolerance)
            .events(&events)
            .run()
            .unwrap()
    };
    for (tolerance, within) in [(1e-14, 1e-12), (1e-12, 1e-10), (1e-9, 1e-6)] {
        let solution = run(tolerance);
        assert_eq!((solution.status, solution.events.len()), (Status::Event(0), 1));
        assert_eq!(solution.end, solution.events[0].state);
        assert_times(&[solution.end.t], &[12.5762618679385806941741444011], within);
        assert!((solution.end.q[0] - PI).abs() < 1e-15);
    }
}

#[test]
fn zeros_and_turns_of_the_pendulum_follow_its_period() {
    let zero = |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0];
    let turn = |_: f64, _: &[f64; 1], v: &[f64; 1]| v[0];
    let events =
        [Event::new(zero), Event::new(zero).rising(), Event::new(turn), Event::new(turn).falling()];
    let quarters = |first: usize, step: usize| -> Vec<f64> {
        (first..).step_by(step).map(|k| k as f64 * PERIOD / 4.0).take_while(|t| *t < 50.0).collect()
    };
    let solution = solve(&pendulum(), (0.0, 50.0), [1.3], [0.0])
        .method(Dop853)
        .rtol(1e-14)
        .atol(1e-14)
        .events(&events)
        .run()
        .unwrap();
    assert_eq!(solution.status, Status::Completed);
    assert_times(&times(&solution.events, 0), &quarters(1, 2), 4e-14);
    assert_times(&times(&solution.events, 1), &quarters(3, 4), 4e-14);
    // The turning point at the start is not an event.
    assert_times(&times(&solution.events, 2), &quarters(2, 2), 4e-14);
    assert_times(&times(&solution.events, 3), &quarters(4, 4), 4e-14);
    assert!(solution.events.windows(2).all(|pair| pair[0].state.t <= pair[1].state.t));
}

#[test]
fn every_method_finds_them() {
    let zero = |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0];
    let events = [Event::new(zero)];
    let expected: Vec<f64> = (0..5).map(|k| f64::from(2 * k + 1) * PERIOD / 4.0).collect();
    let system = pendulum();
    let problem = || solve(&system, (0.0, 18.0), [1.3], [0.0]).method(Dop853).events(&events);
    for (solution, within) in [
        (problem().method(SymplecticEuler).step(1e-3).run(), 2e-2),
        (problem().method(Leapfrog).step(1e-2).run(), 2e-4),
        (problem().method(Srkn14a).step(1e-1).run(), 1e-6),
        (problem().method(Rk4).step(1e-2).run(), 1e-8),
        (problem().rtol(1e-9).atol(1e-9).run(), 1e-7),
    ] {
        let solution = solution.unwrap();
        assert_times(&times(&solution.events, 0), &expected, within);
    }
}

#[test]
fn several_in_one_step_come_in_order() {
    // One step over 3 seconds without gravity: q = t.
    let [first, second, third] = [2.25, 0.75, 0.7501];
    let f =
        move |_: f64, q: &[f64; 1], _: &[f64; 1]| (q[0] - first) * (q[0] - second) * (q[0] - third);
    let g = |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0] - 1.5;
    let h = |t: f64, _: &[f64; 1], _: &[f64; 1]| t - 0.75005;
    let events = [Event::new(f), Event::new(g), Event::new(h).rising()];
    let free = Pendulum { length: 1.0, g: 0.0 };
    let solution =
        solve(&free, (0.0, 3.0), [0.0], [1.0]).method(Rk4).steps(1).events(&events).run().unwrap();
    let found: Vec<(usize, f64)> =
        solution.events.iter().map(|found| (found.event, found.state.t)).collect();
    assert_eq!(found.iter().map(|found| found.0).collect::<Vec<_>>(), [0, 2, 0, 1, 0]);
    assert_times(
        &found.iter().map(|found| found.1).collect::<Vec<_>>(),
        &[second, 0.75005, third, 1.5, first],
        1e-12,
    );
    assert_eq!(solution.stats.accepted, 1);
}

#[test]
fn roots_that_only_touch_are_found() {
    // The pendulum reaches −1.3 and turns back.
    let touch = |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0] + 1.3;
    let miss = |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0] + 1.3 + 1e-6;
    let cross = |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0] + 1.3 - 1e-8;
    let events = [
        Event::new(touch),
        Event::new(touch).falling().touching(0.0),
        Event::new(miss),
        Event::new(cross).touching(0.0),
        Event::new(miss).touching(1e-5),
    ];
    let expected: Vec<f64> =
        (0..14).map(|k| f64::from(2 * k + 1) * PERIOD / 2.0).take_while(|t| *t < 50.0).collect();
    let system = pendulum();
    // With steps of many lengths, the extremum lies at many positions within a step, including its
    // ends.
    for step in (1..60).map(|k| 0.02 * f64::from(k)).chain([
        PERIOD / 8.0,
        PERIOD / 32.0,
        PERIOD / 2.0 - 1e-5,
        PERIOD / 2.0 + 1e-5,
    ]) {
        let run = solve(&system, (0.0, 50.0), [1.3], [0.0])
            .method(Dop853)
            .max_step(step)
            .first_step(step)
            .rtol(1e-13)
            .atol(1e-13)
            .events(&events);
        let solution = run.run().unwrap();
        assert_times(&times(&solution.events, 0), &expected, 1e-9);
        assert!(times(&solution.events, 1).len() <= expected.len());
        assert!(times(&solution.events, 2).is_empty());
        let pairs = times(&solution.events, 3);
        assert_eq!(pairs.len(), 2 * expected.len());
        for (pair, expected) in pairs.chunks(2).zip(&expected) {
            // q + 1.3 = a/2 δ², where a = sin 1.3.
            let half = (2e-8 / 1.3_f64.sin()).sqrt();
            assert_times(pair, &[expected - half, expected + half], 1e-8);
        }
        assert_times(&times(&solution.events, 4), &expected, 1e-9);
    }
}

#[test]
fn a_shallow_dip_of_an_accurate_solution_is_two_roots() {
    // cos t = ±(1 − d) holds twice around every multiple of π.
    let system = super::systems::oscillator(1.0);
    for depth in [1e-6, 1e-9, 1e-10] {
        let high = move |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0] - (1.0 - depth);
        let low = move |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0] + (1.0 - depth);
        let events = [Event::new(high), Event::new(low), Event::new(high).touching(1e-5)];
        let solution = solve(&system, (0.0, 20.0), [1.0], [0.0])
            .method(Dop853)
            .rtol(1e-13)
            .atol(1e-13)
            .events(&events)
            .run()
            .unwrap();
        let half = (2.0 * depth).sqrt();
        let around = |k: i32| [f64::from(k) * PI - half, f64::from(k) * PI + half];
        let expected: Vec<f64> =
            [half].into_iter().chain([2, 4, 6].into_iter().flat_map(around)).collect();
        assert_times(&times(&solution.events, 0), &expected, 1e-6);
        let expected: Vec<f64> = [1, 3, 5].into_iter().flat_map(around).collect();
        assert_times(&times(&solution.events, 1), &expected, 1e-6);
        assert_eq!(times(&solution.events, 2).len(), 4);
    }
}

#[test]
fn what_ends_at_an_event_goes_on_without_finding_it_again() {
    let zero = |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0];
    let turn = |_: f64, _: &[f64; 1], v: &[f64; 1]| v[0];
    let events = [Event::new(zero).terminal(), Event::new(turn).terminal()];
    let system = pendulum();
    let (mut t, mut q, mut v) = (0.0, [1.3], [0.0]);
    for k in 1..=40 {
        let solution = solve(&system, (t, 100.0), q, v)
            .method(Dop853)
            .rtol(1e-13)
            .atol(1e-13)
            .events(&events)
            .run()
            .unwrap();
        assert_eq!(solution.status, Status::Event((k + 1) % 2));
        (t, q, v) = (solution.end.t, solution.end.q, solution.end.v);
        assert_times(&[t], &[k as f64 * PERIOD / 4.0], 1e-11);
    }
}

#[test]
fn a_pendulum_bounces_off_a_wall() {
    fn bounce(integrator: &mut Integrator<'_, 1, Pendulum<f64>, Dop853>) -> f64 {
        integrator.advance_to(1e3).unwrap();
        assert_eq!(integrator.terminal_event(), Some(0));
        let state = integrator.state();
        assert_eq!(integrator.occurrences().last().unwrap().state, state);
        integrator.reset(state.t, state.q, [-state.v[0]]).unwrap();
        state.t
    }
    let wall = |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0];
    let events = [Event::new(wall).terminal()];
    let system = pendulum();
    let mut integrator = Integrator::new(&system, Dop853, 0.0, [1.3], [0.0]).unwrap();
    integrator = integrator
        .control(pendulum_runtime::integrate::AdaptiveStep::new().rtol(1e-13).atol(1e-13))
        .unwrap()
        .events(&events)
        .unwrap();
    for k in 0..20 {
        let t = bounce(&mut integrator);
        assert_times(&[t], &[PERIOD * (0.25 + 0.5 * f64::from(k))], 1e-11);
    }
}

#[test]
fn an_integrator_stops_and_goes_on() {
    let zero = |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0];
    let events = [Event::new(zero).terminal_after(2), Event::at([1.0, 3.0])];
    let system = pendulum();
    let integrator = Integrator::new(&system, Rk4, 0.0, [1.3], [0.0]).unwrap();
    let mut integrator = integrator.control(FixedStep::new(0.01)).unwrap().events(&events).unwrap();
    integrator.advance_to(50.0).unwrap();
    assert_eq!(integrator.terminal_event(), Some(0));
    assert_times(&[integrator.t()], &[0.75 * PERIOD], 1e-8);
    assert_eq!(times(integrator.occurrences(), 1), [1.0, 3.0]);
    assert_eq!(times(integrator.occurrences(), 0).len(), 2);
    // The third event is also terminal.
    integrator.advance_to(50.0).unwrap();
    assert_times(&[integrator.t()], &[1.25 * PERIOD], 1e-8);
    assert_eq!(integrator.occurrences().len(), 1);
    // A refused call has no events.
    assert!(integrator.advance_to(f64::NAN).is_err());
    assert_eq!((integrator.terminal_event(), integrator.occurrences().len()), (None, 0));
    integrator.advance_to(9.0).unwrap();
    assert_eq!(
        (integrator.t(), integrator.terminal_event(), integrator.occurrences().len()),
        (9.0, None, 0)
    );
}

#[test]
fn known_times_are_met_exactly() {
    let when = [0.1, 0.3, 0.7];
    let system = pendulum();
    let problem = || solve(&system, (0.1, 1.0), [1.3], [0.0]).method(Dop853).every_step();
    for (events, end) in [([Event::at(when)], 1.0), ([Event::at(when).terminal_after(2)], 0.7)] {
        for solution in [
            problem().events(&events).run(),
            problem().events(&events).method(Leapfrog).step(0.09).run(),
        ] {
            let solution = solution.unwrap();
            assert_eq!(times(&solution.events, 0), when[1..]);
            assert!(when[1..].iter().all(|time| solution.t.contains(time)));
            assert_eq!((solution.end.t, *solution.t.last().unwrap()), (end, end));
        }
    }
    let failure = solve(&system, (0.0, 1.0), [1.3], [0.0])
        .method(Dop853)
        .events([Event::at([0.5, 0.4])])
        .run()
        .unwrap_err();
    assert!(matches!(failure.error, Error::Times { name: "events", index: 1, .. }), "{failure}");
}

#[test]
fn output_ends_at_a_terminal_event() {
    let zero = |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0];
    let events = [Event::new(zero).terminal()];
    let system = pendulum();
    let problem = || {
        solve(&system, (0.0, 10.0), [1.3], [0.0])
            .method(Dop853)
            .rtol(1e-12)
            .atol(1e-12)
            .events(&events)
    };
    let plain = solve(&system, (0.0, 10.0), [1.3], [0.0])
        .method(Dop853)
        .rtol(1e-12)
        .atol(1e-12)
        .every(0.125)
        .dense()
        .run()
        .unwrap();
    let regular = problem().every(0.125).dense().run().unwrap();
    assert_eq!(regular.t.len(), 15);
    assert!(regular.t.iter().zip(&regular.q).all(|(t, q)| plain.at(*t).unwrap().q == *q));
    assert_eq!(regular.at(regular.end.t), Ok(regular.end));
    assert_eq!(regular.at(1.75), plain.at(1.75));
    assert!(regular.at(1.76).is_err());
    let steps = problem().every_step().run().unwrap();
    assert_eq!(*steps.t.last().unwrap(), regular.end.t);
    assert!(steps.t.windows(2).all(|pair| pair[0] < pair[1]));
    assert_eq!(problem().run().unwrap().t, [regular.end.t]);
}

#[test]
fn events_change_no_step() {
    let zero = |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0];
    let events = [Event::new(zero)];
    let system = pendulum();
    let plain =
        solve(&system, (0.0, 10.0), [1.3], [0.0]).method(Dop853).every_step().run().unwrap();
    let watched = solve(&system, (0.0, 10.0), [1.3], [0.0])
        .method(Dop853)
        .every_step()
        .events(&events)
        .run()
        .unwrap();
    assert_eq!((plain.t, plain.q, plain.end), (watched.t, watched.q, watched.end));
    assert_eq!(plain.stats.evaluations + 3 * plain.stats.accepted + 1, watched.stats.evaluations);
}

#[test]
fn a_velocity_that_jumps_over_zero_is_an_event_at_the_kink() {
    let system = Driven::new(
        MovingPendulum { length: 1.0, g: 1.0 },
        (Curve::linear(&[0.0, 1.0, 2.0], &[[0.0; 2], [0.0; 2], [1.0, 0.0]]).unwrap(),),
    );
    let turn = |_: f64, _: &[f64; 1], v: &[f64; 1]| v[0] + 0.5;
    let before = |t: f64, _: &[f64; 1], _: &[f64; 1]| t - 0.96875;
    for (step, count) in [(0.25, 1), (0.125, 1)] {
        let events = [Event::new(turn), Event::new(before)];
        let solution = solve(&system, (0.0, 1.5), [0.0], [0.2])
            .method(Rk4)
            .step(step)
            .events(&events)
            .run()
            .unwrap();
        assert_eq!(times(&solution.events, 0), vec![1.0; count]);
        assert!(solution.events[1].state.v[0] < -0.5);
        // A terminal event in the step before the kink ends the run before the kink, and the kink
        // still follows.
        let events = [Event::new(before).terminal()];
        let mut integrator = Integrator::new(&system, Rk4, 0.0, [0.0], [0.2])
            .unwrap()
            .control(FixedStep::new(step))
            .unwrap()
            .events(&events)
            .unwrap();
        integrator.advance_to(1.5).unwrap();
        assert_times(&[integrator.t()], &[0.96875], 1e-15);
        assert_eq!(integrator.stats().kinks, 0);
        integrator.advance_to(1.5).unwrap();
        assert_eq!((integrator.t(), integrator.stats().kinks), (1.5, 1));
        assert!((integrator.v()[0] - solution.end.v[0]).abs() < 1e-4);
    }
}

#[test]
fn a_function_that_gives_no_number_is_an_error() {
    let root = |_: f64, q: &[f64; 1], _: &[f64; 1]| (q[0] - 0.5).sqrt();
    let fine = |_: f64, q: &[f64; 1], _: &[f64; 1]| q[0];
    let events = [Event::new(fine), Event::new(root)];
    let system = pendulum();
    let failure =
        solve(&system, (0.0, 10.0), [1.3], [0.0]).method(Dop853).events(&events).run().unwrap_err();
    let Error::Event { t, event: 1 } = failure.error else { panic!("{failure}") };
    assert!(failure.to_string().contains("event 1"));
    assert_eq!(failure.partial.status, Status::Failed);
    // A failed step has no events.
    let late = |t: f64, _: &[f64; 1], _: &[f64; 1]| (1.75 - t).sqrt() + 1.0;
    let events = [Event::at([1.75]).terminal(), Event::new(late)];
    let integrator = Integrator::new(&system, Rk4, 0.0, [1.3], [0.0]).unwrap();
    let mut integrator = integrator.control(FixedStep::new(0.25)).unwrap().events(&events).unwrap();
    integrator.advance_to(10.0).unwrap();
    assert_eq!(integrator.terminal_event(), Some(0));
    assert!(integrator.step().is_err());
    assert_eq!((integrator.terminal_event(), integrator.occurrences().len()), (None, 0));
    // The last state is the one before the step.
    assert!(failure.partial.end.t < t && 0.5 <= failure.partial.end.q[0]);
    let start = |_: f64, _: &[f64; 1], _: &[f64; 1]| f64::NAN;
    let failure = solve(&system, (0.0, 10.0), [1.3], [0.0])
        .method(Dop853)
        .events([Event::new(start)])
        .run()
        .unwrap_err();
    assert_eq!(failure.error, Error::Event { t: 0.0, event: 0 });
    let poles = |_: f64, q: &[f64; 1], _: &[f64; 1]| 1.0 / q[0];
    let solution = solve(&system, (0.0, 5.0), [1.3], [0.0])
        .method(Dop853)
        .rtol(1e-12)
        .atol(1e-12)
        .events([Event::new(poles)])
        .run()
        .unwrap();
    assert_times(&times(&solution.events, 0), &[PERIOD / 4.0], 1e-10);
}

#[test]
fn events_in_two_words() {
    // Motion without gravity: q = t, so that the root is known.
    let free = Pendulum { length: DoubleDouble::from(1.0), g: 0.0.into() };
    let third = DoubleDouble::ratio(1.0, 3.0);
    let f = move |_: DoubleDouble, q: &[DoubleDouble; 1], _: &[DoubleDouble; 1]| q[0] - third;
    let solution = solve(&free, (0.0, 1.0), [0.0.into()], [1.0.into()])
        .method(Rk4)
        .steps(3)
        .events([Event::of(f)])
        .run()
        .unwrap();
    let found = solution.events[0];
    let time = DoubleDouble::sum(found.time.to_f64(), found.time.low());
    assert!(
        (time - third).abs().to_f64() < 1e-31 && (found.state.q[0] - third).abs().to_f64() < 1e-31
    );
}

#[test]
fn a_loose_tolerance_finds_what_its_own_motion_does() {
    // Events agree with the dense output, independent of its error.
    let system: DoublePendulum<f64> = double_pendulum();
    let f = |_: f64, q: &[f64; 2], _: &[f64; 2]| (3.0 * q[0] + q[1]).sin();
    let solution = solve(&system, (0.0, 30.0), [2.0, 2.5], [0.0; 2])
        .method(Dop853)
        .rtol(1e-5)
        .dense()
        .events([Event::new(f)])
        .run()
        .unwrap();
    let g = |t: f64| solution.at(t).map(|state| f(t, &state.q, &state.v)).unwrap();
    let count = 300_000;
    let signs: Vec<f64> =
        (0..=count).map(|k| g(30.0 * f64::from(k) / f64::from(count)).signum()).collect();
    let changes = signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert_eq!(solution.events.len(), changes);
    for found in &solution.events {
        assert!(f(0.0, &found.state.q, &found.state.v).abs() < 1e-13);
        assert!(g(found.state.t).abs() < 1e-13);
    }
}
