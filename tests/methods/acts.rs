//! Events that change the state: a ball on the floor, a double pendulum at a stop.

use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::{Event, Failure, Status, impact};
use pendulum_runtime::motion::Side;
use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Ball { m, g = 9.81 }
    coordinate y;
    kinetic = m*ẏ^2/2;
    potential = m*g*y;
}

lagrangian! {
    pub struct Double { m: [kg; 2], L: [m; 2], g: m/s^2 = 9.81 }
    coordinate φ: rad;
    coordinate ψ: rad;
    let x = L[0] * [sin(φ), -cos(φ)];
    let y = x + L[1] * [sin(ψ), -cos(ψ)];
    kinetic = m[0]/2 * |ẋ|^2 + m[1]/2 * |ẏ|^2;
    potential = g*(m[0]*height(x) + m[1]*height(y));
}

lagrangian! {
    pub struct Puck { m }
    coordinate x;
    coordinate y;
    kinetic = m*(ẋ^2 + ẏ^2)/2;
    potential = 0;
}

/// Returns the times and speeds of the impacts of a ball that falls from `height`, with the
/// coefficient of restitution `e`.
fn impacts(height: f64, e: f64) -> impl Iterator<Item = (f64, f64)> {
    let (g, mut v) = (9.81, (2.0 * 9.81 * height).sqrt());
    let mut t = v / g;
    std::iter::from_fn(move || {
        let now = (t, v);
        v *= e;
        t += 2.0 * v / g;
        Some(now)
    })
}

/// Returns a floor event whose closures own their captured values.
fn floor(height: f64, e: f64) -> Event<'static, f64, 1> {
    let floor = Event::new(move |_t, y, _v| y[0] - height);
    floor.falling().then(move |ball| ball.v[0] *= -e)
}

/// Runs the same checks for each method. The brackets contain the calls that select the method.
macro_rules! each {
    ($problem:expr, $check:expr) => {
        each!($problem, $check; [], [.method(Dop853)], [.method(Rodas4)], [.method(Dprkn12)],
            [.method(Picard)], [.method(Taylor::new())], [.method(Rk4).step(0.01)], [.method(Leapfrog).step(0.01)],
            [.method(Gauss::<2>::new()).step(0.01)])
    };
    ($problem:expr, $check:expr; $([$($call:tt)*]),*) => {
        $($check(stringify!($($call)*), $problem $($call)*.run());)*
    };
}

#[test]
fn a_ball_bounces_within_one_solve_by_every_method() {
    let ball = Ball::new(1.0);
    let check = |method: &str, found: Result<Solution<f64, 1>, Failure<f64, 1>>| {
        let solution = found.unwrap();
        assert_eq!((solution.status, solution.events.len()), (Status::Completed, 6), "{method}");
        for (found, (t, v)) in solution.events.iter().zip(impacts(1.0, 0.8)) {
            assert!((found.state.t - t).abs() < 1e-8, "{method}: {found:?} at {t}");
            assert!((found.state.v[0] + v).abs() < 1e-7, "{method}: {found:?}");
            assert_eq!(found.after.v[0], -0.8 * found.state.v[0]);
            let side = |side| solution.at_side(found.state.t, side).unwrap();
            let (before, after) = (side(Side::Before), side(Side::After));
            assert!((before.v[0] + v).abs() < 1e-7 && (after.v[0] - 0.8 * v).abs() < 1e-7);
            assert!(before.q[0].abs() < 1e-8 && after.q[0].abs() < 1e-8);
        }
        // Half-way between two impacts, the ball is at its highest point.
        let [top, next] = [1, 2].map(|k| solution.events[k].state.t);
        let height = (9.81_f64 * (next - top) / 2.0).powi(2) / (2.0 * 9.81);
        let found = solution.at(f64::midpoint(top, next)).unwrap();
        assert!((found.q[0] - height).abs() < 1e-7 && found.v[0].abs() < 1e-7, "{method}");
    };
    each!(solve(&ball, (0.0, 3.0), [1.0], [0.0]).events([floor(0.0, 0.8)]).dense(), check);
}

#[test]
fn it_is_what_a_loop_of_resets_gives() {
    let ball = Ball::new(1.0);
    let solution = solve(&ball, (0.0, 2.0), [1.7], [0.3])
        .method(Dop853)
        .events([floor(0.5, 0.7)])
        .run()
        .unwrap();
    let stop = Event::new(|_, y, _| y[0] - 0.5).falling().terminal();
    let mut run =
        Integrator::new(&ball, Dop853, 0.0, [1.7], [0.3]).unwrap().events([stop]).unwrap();
    let mut bounces = 0;
    loop {
        run.advance_to(2.0).unwrap();
        if run.terminal_event().is_none() {
            break;
        }
        let at = run.state();
        assert_eq!(at, solution.events[bounces].state);
        run.reset(at.t, at.q, [-0.7 * at.v[0]]).unwrap();
        bounces += 1;
    }
    assert_eq!((bounces, solution.events.len()), (3, 3));
    assert_eq!(run.state(), solution.end);
    assert_eq!(run.stats().accepted, solution.stats.accepted);
}

#[test]
fn output_shows_both_sides_of_a_jump() {
    let ball = Ball::new(1.0);
    let solution = solve(&ball, (0.0, 1.0), [1.0], [0.0])
        .events([floor(0.0, 0.5)])
        .every_step()
        .run()
        .unwrap();
    let at = solution.events[0].state.t;
    let there: Vec<usize> = (0..solution.t.len()).filter(|&k| solution.t[k] == at).collect();
    let [before, after] = there[..] else { panic!("{there:?}") };
    assert_eq!(solution.v[after], [-0.5 * solution.v[before][0]]);
    assert_eq!(solution.events[0].after.v, solution.v[after]);
    // States near the jump come from the correct side.
    let times = [at - 1e-3, at, at + 1e-3];
    let solution = solve(&ball, (0.0, 1.0), [1.0], [0.0])
        .events([floor(0.0, 0.5)])
        .t_eval(&times)
        .run()
        .unwrap();
    assert!(solution.v[0][0] < -4.0 && 2.0 < solution.v[1][0] && 2.0 < solution.v[2][0]);
}

/// Tests a double pendulum whose lower angle cannot exceed the upper angle by more than 0.3.
#[test]
fn a_double_pendulum_hits_a_stop_with_the_mass_matrix() {
    let arm = Double::new([1.3, 0.7], [0.9, 0.6]);
    let e = 0.4;
    let check = |method: &str, found: Result<Solution<f64, 2>, Failure<f64, 2>>| {
        let solution = found.unwrap();
        assert!(3 <= solution.events.len(), "{method}: {}", solution.events.len());
        for found in &solution.events {
            let (q, v, w) = (found.state.q, found.state.v, found.after.v);
            // The mass matrix by hand.
            let (a, b, c) = (2.0 * 0.81, 0.7 * 0.54 * (q[0] - q[1]).cos(), 0.7 * 0.36);
            let momenta = |v: [f64; 2]| [a * v[0] + b * v[1], b * v[0] + c * v[1]];
            let energy = |v: [f64; 2]| {
                let p = momenta(v);
                0.5 * (p[0] * v[0] + p[1] * v[1])
            };
            // n = (1, −1), and M⁻¹ by cofactors.
            let compliance = (a + c + 2.0 * b) / (a * c - b * b);
            let speed = v[0] - v[1];
            assert!(((w[0] - w[1]) + e * speed).abs() < 1e-12 * (1.0 + speed.abs()), "{method}");
            let loss = (1.0 - e * e) * speed * speed / (2.0 * compliance);
            assert!(1e-6 < loss, "{method}: {loss}");
            assert!((energy(v) - energy(w) - loss).abs() < 1e-12 * energy(v), "{method}");
            // The impulse is along n: the sum of the momenta is kept.
            let (p, r) = (momenta(v), momenta(w));
            assert!(((p[0] + p[1]) - (r[0] + r[1])).abs() < 1e-12, "{method}");
            assert!((q[0] - q[1] + 0.3).abs() < 1e-12, "{method}");
        }
    };
    let stop = || {
        let stop = Event::new(|_t, q, _v| q[0] - q[1] + 0.3).falling();
        stop.then(|state| state.bounce(&arm, &[1.0, -1.0], e))
    };
    each!(solve(&arm, (0.0, 4.0), [0.2, -0.5], [0.0, 3.0]).events([stop()]), check;
        [], [.method(Dop853)], [.method(Picard)], [.method(Taylor::new())],
        [.method(Rk4).step(0.01)], [.method(Gauss::<2>::new()).step(0.01)]);
    // `bounce` adds the velocity that `impact` returns.
    let (q, v) = ([0.2, 0.5], [1.0, 2.0]);
    let mut state = solve(&arm, (0.0, 0.0), q, v).run().unwrap().end;
    state.bounce(&arm, &[1.0, -1.0], e);
    let change = impact(&arm, 0.0, &q, &v, &[1.0, -1.0], e);
    assert_eq!(state.v, [v[0] + change[0], v[1] + change[1]]);
    // The length of the normal does not matter.
    let longer = impact(&arm, 0.0, &q, &v, &[-3.0, 3.0], e);
    assert!((0..2).all(|i| (longer[i] - change[i]).abs() < 1e-15));
}

#[test]
fn simultaneous_events_act_in_the_order_of_the_list() {
    let puck = Puck::new(1.0);
    // Both walls are reached at t = 1/3, where neither root is an `f64`.
    for (slow, fast) in [(1.0, 1.0), (0.3, 0.7), (1.1, 1e-3)] {
        let start = [slow / 3.0, fast / 3.0];
        let left = Event::new(|_, q, _| q[0]).falling();
        let below = Event::new(|_, q, _| 5.0 * q[1]).falling();
        let run = |events: [Event<'_, f64, 2>; 2]| {
            let problem = solve(&puck, (0.0, 1.0), start, [-slow, -fast]).method(Dop853);
            problem.max_step(0.2).events(events).run().unwrap()
        };
        let double =
            |state: &mut State<f64, 2>| (state.v[0], state.v[1]) = (-2.0 * state.v[0], 1.0);
        let add = |state: &mut State<f64, 2>| state.v[0] += 1.0;
        let first = run([left.clone().then(double), below.clone().then(add)]);
        assert_eq!(first.events.iter().map(|found| found.event).collect::<Vec<_>>(), [0, 1]);
        assert_eq!(first.end.v[0], 2.0 * slow + 1.0);
        let second = run([below.then(add), left.then(double)]);
        assert_eq!(second.events.iter().map(|found| found.event).collect::<Vec<_>>(), [0, 1]);
        assert_eq!(second.events[0].time, second.events[1].time);
        assert_eq!(second.end.v[0], -2.0 * (1.0 - slow));
    }
}

/// All bounces of a ball together take √(2h/g)(1 + e)/(1 − e).
#[test]
fn acts_that_accumulate_are_an_error_with_their_limit() {
    let ball = Ball::new(1.0);
    for (height, e) in [(0.0, 0.8), (0.5, 0.6), (1e4, 0.3)] {
        let end = (2.0_f64 / 9.81).sqrt() * (1.0 + e) / (1.0 - e);
        let check = |method: &str, found: Result<Solution<f64, 1>, Failure<f64, 1>>| {
            let failure = found.unwrap_err();
            let Error::Accumulation { t, event: 0 } = failure.error else {
                panic!("{method} {height}: {failure:?}")
            };
            assert!((t - end).abs() < 1e-5, "{method} {height}: {t} for {end}");
            let text = failure.to_string();
            assert!(text.contains("event 0") && text.contains(".rest_below("), "{text}");
            // The partial solution ends before the limit.
            assert!((failure.partial.end.t - end).abs() < 1e-4 && 3 < failure.partial.events.len());
        };
        each!(solve(&ball, (0.0, 10.0), [1.0 + height], [0.0]).events([floor(height, e)]), check);
    }
    // The same number of acts at equal time intervals is not an error.
    let solution =
        solve(&ball, (0.0, 100.0), [1e-4], [0.0]).events([floor(0.0, 1.0)]).run().unwrap();
    assert_eq!((solution.status, solution.events.len()), (Status::Completed, 11_074));
}

#[test]
fn slow_impacts_end_at_rest_if_the_event_says_so() {
    let ball = Ball::new(1.0);
    let check = |method: &str, found: Result<Solution<f64, 1>, Failure<f64, 1>>| {
        let solution = found.unwrap();
        assert_eq!(solution.status, Status::Rest(0), "{method}");
        let (t, v) = impacts(1.0, 0.8).find(|(_, v)| *v < 0.05).unwrap();
        assert!((solution.end.t - t).abs() < 1e-6, "{method}: {} for {t}", solution.end.t);
        assert!((solution.end.v[0] - 0.8 * v).abs() < 1e-6, "{method}");
    };
    each!(
        solve(&ball, (0.0, 10.0), [1.0], [0.0]).events([floor(0.0, 0.8).rest_below(0.05)]),
        check
    );
    // After an impact without restitution, the ball is at rest for every speed.
    let dead = floor(0.0, 0.0).rest_below(1e-9);
    let solution = solve(&ball, (0.0, 10.0), [1.0], [0.0]).events([dead.clone()]).run().unwrap();
    assert_eq!((solution.status, solution.end.v), (Status::Rest(0), [0.0]));
    let mut run =
        Integrator::new(&ball, Dop853, 0.0, [1.0], [0.0]).unwrap().events([dead]).unwrap();
    run.advance_to(10.0).unwrap();
    assert_eq!((run.terminal_event(), run.t() < 1.0), (Some(0), true));
}

#[test]
fn a_motion_that_stays_on_the_surface_is_an_error() {
    let ball = Ball::new(1.0);
    let fall = |event: Event<'static, f64, 1>| {
        solve(&ball, (0.0, 10.0), [1.0], [0.0]).events([event]).run().unwrap_err()
    };
    let failure = fall(floor(0.0, 0.0));
    let Error::EventStays { t, event: 0 } = failure.error else { panic!("{failure:?}") };
    assert!((t - (2.0_f64 / 9.81).sqrt()).abs() < 1e-8);
    let text = failure.to_string();
    assert!(text.contains("event 0") && text.contains("`.rest_below(speed)`"), "{text}");
    // The act puts the ball back above the floor with its downward velocity.
    let floor = Event::new(|_, y, _| y[0]).falling();
    let failure = fall(floor.clone().then(|ball| ball.q[0] = 1e-13));
    assert!(matches!(failure.error, Error::EventStays { event: 0, .. }), "{failure:?}");
    // A slow passage is not an error, and neither is a stop from which gravity accelerates away.
    let through = floor.clone().then(|ball| ball.v[0] *= 1e-3);
    let solution = solve(&ball, (0.0, 1.0), [1.0], [0.0]).events([through]).run().unwrap();
    assert!(solution.events.len() == 1 && solution.end.q[0] < 0.0);
    let ceiling = Event::new(|_, y, _| 1.0 - y[0]).falling().then(|ball| ball.v[0] = 0.0);
    let solution = solve(&ball, (0.0, 1.0), [0.0], [5.0]).events([ceiling]).run().unwrap();
    assert!(solution.events.len() == 1 && solution.end.q[0] < 1.0);
}

#[test]
fn an_action_without_numbers_is_an_error_and_keeps_the_state() {
    let ball = Ball::new(1.0);
    let broken = Event::new(|_, y, _| y[0]).falling().then(|ball| ball.v[0] = f64::NAN);
    let failure = solve(&ball, (0.0, 1.0), [1.0], [0.0]).events([broken]).run().unwrap_err();
    assert!(matches!(failure.error, Error::Action { event: 0, .. }), "{failure:?}");
    assert!(failure.to_string().contains("velocity of `y`"), "{failure}");
    assert!(failure.partial.end.v[0] < -4.0);
    // A wall without a normal.
    let arm = Double::new([1.3, 0.7], [0.9, 0.6]);
    let flat =
        Event::new(|_, q: &[f64; 2], _| q[0]).then(|state| state.bounce(&arm, &[0.0; 2], 1.0));
    let failure = solve(&arm, (0.0, 5.0), [0.2, 0.0], [0.0; 2]).events([flat]).run().unwrap_err();
    assert!(matches!(failure.error, Error::Action { event: 0, .. }), "{failure:?}");
}

#[test]
fn known_times_act_and_actions_may_move_the_coordinates() {
    let puck = Puck::new(1.0);
    let kick = Event::at([0.25, 0.5]).then(|puck| puck.v[1] += 1.0);
    // A torus: a puck that leaves on the right returns on the left.
    let edge = Event::new(|_, q, _| q[0] - 1.0).rising().then(|puck| puck.q[0] -= 1.0);
    let solution = solve(&puck, (0.0, 2.0), [0.0, 0.0], [1.7, 0.0])
        .method(Dop853)
        .events([kick, edge])
        .run()
        .unwrap();
    assert_eq!(solution.events.iter().filter(|found| found.event == 0).count(), 2);
    assert_eq!(solution.events.iter().filter(|found| found.event == 1).count(), 3);
    assert!((solution.end.q[0] - 0.4).abs() < 1e-12 && solution.end.v == [1.7, 2.0]);
    assert!((solution.end.q[1] - 3.25).abs() < 1e-12, "{}", solution.end.q[1]);
}
