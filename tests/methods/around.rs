//! Functions that are called during steps, and integrators that own their system, iterate and
//! evaluate.

use core::ops::ControlFlow::{Break, Continue};
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{AdaptiveStep, Event, Failure, Status};
use pendulum_runtime::motion::Curve;
use pendulum_runtime::prelude::*;
use systems::problems::Simple;

lagrangian! {
    pub struct Hand { L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L * [sin(θ), -cos(θ)];
    kinetic = |ẏ|^2/2;
    potential = g*height(y);
}

/// Returns a pendulum on a pivot whose velocity jumps at 1.3 and 2.6 s.
fn moved() -> Driven<Hand<f64>, (Curve<2>,)> {
    let keys = [[0.0, 0.0], [0.4, 0.1], [0.1, 0.0], [0.1, 0.0]];
    Hand::new(1.0).driven_by(Curve::linear(&[0.0, 1.3, 2.6, 9.0], &keys).unwrap())
}

#[test]
fn functions_look_on_and_change_nothing() {
    let hand = moved();
    let problem = || solve(&hand, (0.0, 4.0), [0.3], [0.1]).method(Dop853).rtol(1e-9);
    let plain = problem().every_step().dense().run().unwrap();
    let (mut ends, mut progress, mut last) = (Vec::new(), 0.0, plain.get(0).unwrap());
    let watched = problem()
        .on_step(|step| {
            assert!(progress < step.progress() && step.progress() <= 1.0);
            progress = step.progress();
            assert_eq!(step.start, last);
            last = step.end;
            let middle = f64::midpoint(step.start.t, step.end.t);
            assert_eq!(step.at(middle), plain.at(middle).ok());
            assert_eq!(step.at(step.end.t), Some(step.end));
            assert_eq!((step.at(step.end.t + 1e-9), step.at(step.start.t - 1e-9)), (None, None));
            ends.push(step.stats.accepted);
            Continue(())
        })
        .run()
        .unwrap();
    assert_eq!((watched.end, watched.status), (plain.end, Status::Completed));
    assert_eq!(ends, (1..=plain.stats.accepted).collect::<Vec<_>>());
    assert_eq!(progress, 1.0);
}

#[test]
fn events_are_shown_with_the_step_in_which_they_happen() {
    let simple = Simple { g: 9.81 };
    let mut seen = Vec::new();
    let down = Event::new(|_t, q, _v| q[0]);
    let look = |step: &mut pendulum_runtime::integrate::Step<'_, f64, 1>| {
        for found in step.events {
            assert!(step.start.t < found.state.t && found.state.t <= step.end.t);
            seen.push(found.state);
        }
        Continue(())
    };
    let solution =
        solve(&simple, (0.0, 9.0), [1.0], [0.0]).events([down]).on_step(look).run().unwrap();
    assert_eq!(seen, solution.events.iter().map(|found| found.state).collect::<Vec<_>>());
    assert!(5 < seen.len());
}

#[test]
fn a_cancelled_run_returns_what_it_has() {
    let simple = Simple { g: 9.81 };
    let problem = || solve(&simple, (0.0, 10.0), [1.3], [0.0]).every(0.125).dense();
    let whole = problem().run().unwrap();
    let stop = 3.3;
    let cancelled = problem()
        .on_step(|step| if stop < step.end.t { Break(()) } else { Continue(()) })
        .run()
        .unwrap();
    assert_eq!(cancelled.status, Status::Cancelled);
    assert!(stop < cancelled.end.t && cancelled.end.t < 10.0);
    let kept = cancelled.t.len();
    assert!(26 < kept && cancelled.t == whole.t[..kept] && cancelled.q == whole.q[..kept]);
    assert_eq!(cancelled.at(3.1), whole.at(3.1));
    assert!(cancelled.at(cancelled.end.t + 0.01).is_err());
    // An error precedes a break. A terminal event at the end of the step determines the status, not
    // the function.
    let end = Event::new(|t, _q: &[f64; 1], _v| t - 2.0).terminal();
    let ended = problem()
        .events([end])
        .on_step(|step| if step.events.is_empty() { Continue(()) } else { Break(()) });
    assert_eq!(ended.run().unwrap().status, Status::Event(0));
}

#[test]
fn states_at_output_times_go_by_without_being_kept() {
    let simple = Simple { g: 9.81 };
    let problem = || solve(&simple, (0.0, 7.3), [1.3], [0.0]).every(0.01);
    let kept = problem().run().unwrap();
    let mut states = Vec::new();
    let streamed = problem().on_output(|state| {
        states.push(state);
        Continue(())
    });
    let streamed = streamed.run().unwrap();
    assert_eq!(states, kept.iter().collect::<Vec<_>>());
    assert_eq!((streamed.t.len(), streamed.end, streamed.q[0]), (1, kept.end, kept.end.q));
    let mut count = 0;
    let cancelled = problem().on_output(|state| {
        count += 1;
        if state.t < 1.0 { Continue(()) } else { Break(()) }
    });
    let cancelled = cancelled.run().unwrap();
    assert_eq!((cancelled.status, count), (Status::Cancelled, 101));
    assert!((1.0..7.0).contains(&cancelled.end.t));
}

/// More output times than a solution can store.
#[test]
#[ignore = "takes ten seconds: `.ci/run` runs it"]
fn eleven_million_output_times() {
    let simple = Simple { g: 9.81 };
    let problem = || solve(&simple, (0.0, 11.0), [1.3], [0.0]).rtol(1e-9).every(1e-6);
    assert!(matches!(problem().run().unwrap_err().error, Error::Setting { name: "every", .. }));
    let (mut count, mut highest) = (0_u64, 0.0_f64);
    let solution = problem().on_output(|state| {
        count += 1;
        highest = highest.max(state.v[0].abs());
        Continue(())
    });
    let solution = solution.run().unwrap();
    assert_eq!((count, solution.t.len()), (11_000_001, 1));
    // v² = 2 g (1 − cos θ₀) at the bottom.
    assert!((highest - (2.0 * 9.81 * (1.0 - 1.3_f64.cos())).sqrt()).abs() < 1e-8);
}

macro_rules! each {
    ($problem:expr, $check:expr; $([$($call:tt)*]),*) => {
        $($check(stringify!($($call)*), $problem $($call)*, $problem $($call)*.run().unwrap());)*
    };
}

#[test]
fn an_integrator_that_solve_starts_takes_its_steps() {
    let simple = Simple { g: 9.81 };
    let (stops, known) = ([0.7, 1.9, 2.0], [0.35, 2.2]);
    let down = Event::new(|_t, q, _v| q[0]).falling().then(|state| state.v[0] *= 0.9);
    let events = [down, Event::at(known)];
    macro_rules! check {
        () => {
            |method: &str,
             started: pendulum_runtime::integrate::Solve<'_, 1, _, _, _, _>,
             solution: Solution<f64, 1>| {
                let mut run = started.start().unwrap();
                let states: Vec<_> = run.steps().map(Result::unwrap).collect();
                let last = states.last().unwrap();
                assert_eq!((*last, run.stats()), (solution.end, solution.stats), "{method}");
                assert!(
                    stops
                        .iter()
                        .chain(&known)
                        .all(|stop| states.iter().any(|state| state.t == *stop))
                );
                assert_eq!(states.len() as u64, solution.stats.accepted);
                assert!(run.steps().next().is_none());
                // The run continues beyond the end.
                run.advance_to(5.0).unwrap();
                assert_eq!(run.t(), 5.0);
            }
        };
    }
    each!(solve(&simple, (0.1, 4.0), [1.3], [0.0]).t_stops(&stops).events(&events), check!();
        [], [.method(Picard).rtol(1e-10)], [.method(Dop853)], [.method(Taylor::new())], [.method(Dop853).max_step(0.05)],
        [.method(Rk4).step(0.01)], [.method(Srkn14a).steps(500)]);
    let bad = solve(&simple, (0.1, 4.0), [1.3], [0.0]).t_stops(&[5.0]).start();
    assert!(matches!(bad, Err(Error::Times { name: "t_stops", .. })));
}

struct Owner {
    run: Integrator<'static, 1, Simple<f64>, Dop853>,
    height: f64,
}

impl Owner {
    fn new(height: f64) -> Result<Self, Error> {
        let wall =
            Event::new(move |_t, q, _v| q[0] - height).falling().then(|state| state.v[0] *= -1.0);
        let run = Integrator::owning(Simple { g: 9.81 }, Dop853, 0.0, [1.0], [0.0])?;
        Ok(Self { run: run.control(AdaptiveStep::new().rtol(1e-10))?.events([wall])?, height })
    }
}

#[test]
fn a_struct_holds_the_integrator_and_its_system() {
    let mut owner = Owner::new(-0.5).unwrap();
    let system = owner.run.dynamics().clone();
    assert_eq!(system.g, 9.81);
    // The integrator can move to another thread.
    let owner = std::thread::spawn(move || {
        owner.run.advance_to(3.0).unwrap();
        owner
    });
    let owner = owner.join().unwrap();
    assert!(owner.height <= owner.run.q()[0] && owner.run.occurrences().len() == 2);
    let mut borrowed = Integrator::new(&system, Dop853, 0.0, [1.0], [0.0])
        .unwrap()
        .control(AdaptiveStep::new().rtol(1e-10))
        .unwrap()
        .events([Event::new(|_t, q, _v| q[0] + 0.5).falling().then(|state| state.v[0] *= -1.0)])
        .unwrap();
    borrowed.advance_to(3.0).unwrap();
    assert_eq!((borrowed.state(), borrowed.stats()), (owner.run.state(), owner.run.stats()));
}

#[test]
fn states_at_times_are_those_of_solve_and_come_when_asked_for() {
    let hand = moved();
    let times = [0.0, 0.1, 0.11, 1.3, 1.31, 2.0, 4.0];
    let problem = || solve(&hand, (0.0, 4.0), [0.3], [0.1]).rtol(1e-9).t_eval(&times);
    let solution = problem().run().unwrap();
    let mut run = problem().start().unwrap();
    let states: Vec<_> = run.states_at(times).map(Result::unwrap).collect();
    assert_eq!(states, solution.iter().collect::<Vec<_>>());
    // There are no states beyond the end and before the last step.
    assert_eq!(
        run.states_at([4.1]).next(),
        Some(Err(Error::Times { name: "states_at", index: 0, time: 4.1 }))
    );
    let mut run = problem().start().unwrap();
    let mut states = run.states_at([3.9, 0.1, 3.95]);
    assert!(states.next().unwrap().is_ok());
    assert!(matches!(states.next(), Some(Err(Error::Times { index: 1, .. }))));
    assert!(states.next().is_none());
    // An infinite iterator integrates only as far as states are requested.
    let simple = Simple { g: 9.81 };
    let mut run = Integrator::new(&simple, Dop853, 0.0, [1.0], [0.0]).unwrap();
    let ticks = run.states_at((0..).map(|tick| f64::from(tick) / 60.0)).take(61);
    assert_eq!(ticks.last().unwrap().unwrap().t, 1.0);
    assert!((1.0..3.0).contains(&run.t()));
    // The iterator ends at a terminal event, from which the next call continues.
    let down = Event::new(|_t, q, _v| q[0]).terminal();
    let mut run =
        Integrator::new(&simple, Dop853, 0.0, [1.0], [0.0]).unwrap().events([down]).unwrap();
    let count = run.states_at((0..).map(|tick| f64::from(tick) / 60.0)).count();
    assert_eq!(count, (run.t() * 60.0) as usize + 1);
    assert_eq!(run.terminal_event(), Some(0));
    assert!(run.states_at([run.t() + 0.1]).next().unwrap().is_ok());
}

#[test]
fn the_last_step_is_evaluated_in_seconds() {
    let simple = Simple { g: 9.81 };
    let solution = solve(&simple, (0.0, 2.0), [1.0], [0.0]).method(Dop853).dense().run().unwrap();
    let mut run = solve(&simple, (0.0, 2.0), [1.0], [0.0]).method(Dop853).start().unwrap();
    assert_eq!((run.at(0.1), run.at(0.0)), (None, Some(run.state())));
    let mut before = 0.0;
    while run.t() < 2.0 {
        run.step().unwrap();
        for part in [0.0, 0.3, 0.9] {
            let t = before + part * (run.t() - before);
            let (found, expected) = (run.at(t).unwrap(), solution.at(t).unwrap());
            assert!(
                (found.q[0] - expected.q[0]).abs() < 1e-15
                    && (found.v[0] - expected.v[0]).abs() < 1e-14
            );
        }
        assert_eq!((run.at(run.t()), run.at(before - 1e-9)), (Some(run.state()), None));
        before = run.t();
    }
    run.reset(0.5, [0.1], [0.2]).unwrap();
    assert_eq!((run.at(0.4), run.at(0.5)), (None, Some(run.state())));
}

#[test]
fn an_error_ends_the_steps() {
    let simple = Simple { g: 9.81 };
    let broken = Event::new(|_t, q: &[f64; 1], _v| (q[0] - 0.5).sqrt());
    let mut run = solve(&simple, (0.0, 5.0), [1.0], [0.0]).events([broken]).start().unwrap();
    let steps: Vec<_> = run.steps().collect();
    assert!(matches!(steps.last(), Some(Err(Error::Event { event: 0, .. }))));
    assert!(steps[..steps.len() - 1].iter().all(Result::is_ok));
    let failed: Result<Solution<f64, 1>, Failure<f64, 1>> =
        solve(&simple, (0.0, 5.0), [1.0], [0.0])
            .events([Event::new(|_t, _q, _v| f64::NAN)])
            .on_step(|_| Break(()))
            .run();
    assert!(matches!(failed.unwrap_err().error, Error::Event { t: 0.0, event: 0 }));
}
