//! Output at given times, at each step, and dense.

use super::systems::{Pendulum, double_pendulum, pendulum};
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{Dop853, Leapfrog, Rk4, Srkn14a, solve};
use pendulum_runtime::motion::Side;

const TIMES: [f64; 7] = [0.0, 0.1, 2.5, 2.5, 7.3, 9.999, 10.0];

#[test]
fn without_a_wish_there_is_the_end() {
    let solution = solve(&pendulum(), (0.0, 10.0), [1.3], [0.0]).method(Dop853).run().unwrap();
    assert_eq!(
        (solution.t.as_slice(), solution.q[0], solution.v[0]),
        ([10.0].as_slice(), solution.end.q, solution.end.v)
    );
    // Not even at the end: asking for less than `dense` is a mistake of the program.
    for t in [5.0, 10.0] {
        assert_eq!(solution.at(t), Err(Error::NoState { t, dense: None }));
    }
    let message = solution.at(5.0).unwrap_err().to_string();
    assert!(message.contains("t = 5.0; call `dense` before `run`"), "{message}");
}

#[test]
fn given_times_are_met_and_change_no_step() {
    let plain =
        solve(&pendulum(), (0.0, 10.0), [1.3], [0.0]).method(Dop853).rtol(1e-9).run().unwrap();
    let solution = solve(&pendulum(), (0.0, 10.0), [1.3], [0.0])
        .method(Dop853)
        .rtol(1e-9)
        .t_eval(&TIMES)
        .run()
        .unwrap();
    assert_eq!(solution.t, TIMES);
    assert_eq!((solution.end, solution.stats.accepted), (plain.end, plain.stats.accepted));
    assert_eq!((solution.q[0], solution.v[0]), ([1.3], [0.0]));
    assert_eq!((solution.q[6], solution.v[6]), (solution.end.q, solution.end.v));
    assert_eq!(solution.q[2], solution.q[3]);
    for (t, q) in TIMES.iter().zip(&solution.q) {
        let exact = solve(&pendulum(), (0.0, *t), [1.3], [0.0])
            .method(Dop853)
            .rtol(1e-13)
            .atol(1e-13)
            .run()
            .unwrap()
            .end;
        assert!((q[0] - exact.q[0]).abs() < 1e-7, "t = {t}");
    }
}

#[test]
fn given_times_change_no_fixed_step() {
    let plain =
        solve(&pendulum(), (0.0, 10.0), [1.3], [0.0]).method(Srkn14a).steps(50).run().unwrap();
    let solution = solve(&pendulum(), (0.0, 10.0), [1.3], [0.0])
        .method(Srkn14a)
        .steps(50)
        .t_eval(&TIMES)
        .run()
        .unwrap();
    assert_eq!((solution.end, solution.t.as_slice()), (plain.end, TIMES.as_slice()));
}

#[test]
fn stops_are_ends_of_steps() {
    let stops = [0.3, 0.3, 0.75];
    let solution = solve(&pendulum(), (0.0, 1.0), [1.3], [0.0])
        .method(Rk4)
        .step(0.25)
        .t_stops(&stops)
        .every_step()
        .run()
        .unwrap();
    assert_eq!(solution.t, [0.0, 0.15, 0.3, 0.525, 0.75, 1.0]);
    let solution = solve(&pendulum(), (0.0, 1.0), [1.3], [0.0])
        .method(Dop853)
        .t_stops(&stops)
        .every_step()
        .run()
        .unwrap();
    assert!(solution.t.contains(&0.3) && solution.t.contains(&0.75));
}

#[test]
fn regular_times_include_the_end_if_they_meet_it() {
    let run = |every| {
        solve(&pendulum(), (1.0, 2.0), [1.3], [0.0]).method(Dop853).every(every).run().unwrap().t
    };
    assert_eq!(run(0.25), [1.0, 1.25, 1.5, 1.75, 2.0]);
    assert_eq!(run(0.4), [1.0, 1.4, 1.8]);
    // 1 + 10 · 0.1 is a rounding error away from 2.
    let tenths = run(0.1);
    assert_eq!((tenths.len(), tenths[10]), (11, 2.0));
    assert_eq!(run(5.0), [1.0]);
    // Multiples far from zero also have rounding errors.
    let run = |start, end, every| {
        solve(&pendulum(), (start, end), [1.3], [0.0]).method(Dop853).every(every).run().unwrap().t
    };
    for (start, end) in
        [(1000000.01, 1000000.07), (-1000000.07, -1000000.01), (1e9, 1e9 + 0.06), (-0.06, 0.0)]
    {
        let times = run(start, end, 0.01);
        assert_eq!((times.len(), times[0], times[6]), (7, start, end));
        assert!((times[5] - (end - 0.01)).abs() < 1e-6);
    }
    assert_eq!(run(0.0, 1e-12, 0.01), [0.0]);
}

#[test]
fn short_scalars_have_late_times() {
    let system = Pendulum { length: 1.0_f32, g: 1.0 };
    let run = |t: f64| {
        solve(&system, (t, t + 1.0), [1.3], [0.0])
            .method(Dop853)
            .every(0.125)
            .dense()
            .run()
            .unwrap()
    };
    let (early, late) = (run(0.0), run(1e9));
    for k in 0..=8 {
        let t = 0.125 * f64::from(k);
        assert!((early.q[k as usize][0] - late.q[k as usize][0]).abs() < 1e-6, "{t}");
        assert!((early.at(t).unwrap().q[0] - late.at(1e9 + t).unwrap().q[0]).abs() < 1e-6, "{t}");
    }
}

#[test]
fn every_step_begins_at_the_start_and_ends_at_the_end() {
    let solution = solve(&pendulum(), (0.0, 1.0), [1.3], [0.0])
        .method(Leapfrog)
        .steps(4)
        .every_step()
        .run()
        .unwrap();
    assert_eq!(solution.t, [0.0, 0.25, 0.5, 0.75, 1.0]);
    assert_eq!((solution.q[0], solution.q[4]), ([1.3], solution.end.q));
}

#[test]
fn dense_output_is_continuous_and_meets_the_steps() {
    let system = double_pendulum();
    let run = || {
        solve(&system, (0.0, 10.0), [2.0, 2.5], [0.0; 2])
            .method(Dop853)
            .rtol(1e-8)
            .atol(1e-8)
            .every_step()
            .dense()
    };
    for solution in [run().run().unwrap(), run().method(Rk4).steps(200).run().unwrap()] {
        for ((t, q), v) in solution.t.iter().zip(&solution.q).zip(&solution.v) {
            for state in [solution.at(*t).unwrap(), solution.at_side(*t, Side::Before).unwrap()] {
                for i in 0..2 {
                    assert!(
                        (state.q[i] - q[i]).abs() < 2e-15 && (state.v[i] - v[i]).abs() < 4e-15,
                        "{}: t = {t}",
                        solution.stats
                    );
                }
            }
        }
    }
}

#[test]
fn dense_output_keeps_the_tolerance() {
    let system = double_pendulum();
    let exact = solve(&system, (0.0, 3.0), [2.0, 2.5], [0.0; 2])
        .method(Dop853)
        .rtol(1e-14)
        .atol(1e-14)
        .dense()
        .run()
        .unwrap();
    let solution = solve(&system, (0.0, 3.0), [2.0, 2.5], [0.0; 2])
        .method(Dop853)
        .rtol(1e-9)
        .atol(1e-9)
        .dense()
        .run()
        .unwrap();
    for k in 0..1000 {
        let t = 3.0 * f64::from(k) / 1000.0;
        let (state, truth) = (solution.at(t).unwrap(), exact.at(t).unwrap());
        for i in 0..2 {
            assert!(
                (state.q[i] - truth.q[i]).abs() < 1e-7 && (state.v[i] - truth.v[i]).abs() < 1e-7,
                "t = {t}"
            );
        }
    }
}

#[test]
fn dense_output_ends_where_the_motion_does() {
    let solution =
        solve(&pendulum(), (1.0, 2.0), [1.3], [0.0]).method(Dop853).dense().run().unwrap();
    for t in [0.999, 2.001] {
        assert_eq!(solution.at(t), Err(Error::NoState { t, dense: Some((1.0, 2.0)) }));
    }
    let message = solution.at(f64::NAN).unwrap_err().to_string();
    assert!(message.contains("t = NaN") && message.contains("from 1.0 to 2.0"), "{message}");
    assert_eq!(solution.at(1.0).unwrap().q, [1.3]);
    assert_eq!(solution.at(2.0).unwrap(), solution.end);
}

#[test]
fn dense_output_is_computed_only_where_it_is_needed() {
    let pendulum = pendulum();
    let run = || solve(&pendulum, (0.0, 100.0), [1.3], [0.0]).method(Dop853);
    let plain = run().run().unwrap().stats;
    let once = run().t_eval(&[50.0]).run().unwrap().stats;
    let dense = run().dense().run().unwrap().stats;
    assert_eq!(once.evaluations, plain.evaluations + 3);
    // The slope at the end of the last step is not used by a next step.
    assert_eq!(dense.evaluations, plain.evaluations + 3 * plain.accepted + 1);
}

#[test]
fn an_empty_interval_gives_the_start() {
    let solution = solve(&pendulum(), (3.0, 3.0), [1.3], [0.5])
        .method(Rk4)
        .steps(10)
        .t_eval(&[3.0])
        .dense()
        .run()
        .unwrap();
    assert_eq!((solution.end.t, solution.end.q, solution.end.v), (3.0, [1.3], [0.5]));
    assert_eq!((solution.t.as_slice(), solution.stats.evaluations), ([3.0].as_slice(), 0));
    assert_eq!(solution.at(3.0).unwrap(), solution.end);
    assert_eq!(
        solve(&pendulum(), (3.0, 3.0), [1.3], [0.5]).method(Dop853).every(1.0).run().unwrap().t,
        [3.0]
    );
}

#[test]
fn the_end_is_exact() {
    for (start, end) in
        [(0.0, 0.1), (0.1, 0.7), (1e9, 1e9 + 1.0 / 60.0), (-3.3, 1e-300), (0.3, 0.1 + 0.2)]
    {
        let adaptive = solve(&pendulum(), (start, end), [1.3], [0.0]).method(Dop853).run().unwrap();
        let fixed =
            solve(&pendulum(), (start, end), [1.3], [0.0]).method(Rk4).step(0.0013).run().unwrap();
        assert_eq!((adaptive.end.t, fixed.end.t), (end, end));
    }
}

#[test]
fn unusable_times_are_refused() {
    let run = |times: &[f64]| {
        solve(&pendulum(), (0.0, 1.0), [1.3], [0.0]).method(Dop853).t_eval(times).run().unwrap_err()
    };
    for (times, index) in
        [(&[0.5, 0.4][..], 1), (&[-0.1][..], 0), (&[0.5, 1.1][..], 1), (&[f64::NAN][..], 0)]
    {
        let failure = run(times);
        assert!(
            matches!(failure.error, Error::Times { name: "t_eval", index: i, .. } if i == index),
            "{failure}"
        );
        assert_eq!(failure.partial.end.q, [1.3]);
    }
    let failure = solve(&pendulum(), (0.0, 1.0), [1.3], [0.0])
        .method(Dop853)
        .t_stops(&[2.0])
        .run()
        .unwrap_err();
    assert!(matches!(failure.error, Error::Times { name: "t_stops", index: 0, .. }), "{failure}");
    for every in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-12] {
        let failure = solve(&pendulum(), (0.0, 1.0), [1.3], [0.0])
            .method(Dop853)
            .every(every)
            .run()
            .unwrap_err();
        assert!(matches!(failure.error, Error::Setting { name: "every", .. }), "{failure}");
    }
}
