//! The multistep methods of Quinlan and Tremaine: order, digits, starts and restarts.
//!
//! The digits are those of `tests/methods/problems.rs`.

use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::Event;
use pendulum_runtime::integrate::FixedStep;
use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::motion::{Linear, Sinusoid};
use pendulum_runtime::prelude::*;

use systems::distance::distance;
use systems::problems::{HenonHeiles, Hung, Simple};

fn error<D: Dynamics<N, Scalar = f64>, const N: usize>(
    dynamics: &D,
    (q, v): ([f64; N], [f64; N]),
    end: f64,
    exact: &[f64],
    method: impl Method<D, N>,
    steps: u64,
) -> f64 {
    let end = solve(dynamics, (0.0, end), q, v).method(method).steps(steps).run().unwrap().end;
    distance((end.q, end.v), exact)
}

const SHAKEN: [f64; 2] = [0.0342105591464723414299261, -1.02072871213303888830643];

fn simple(method: impl Method<Simple<f64>, 1>, steps: u64) -> f64 {
    let exact = [0.0294296671795643777888240, -1.21001499988647025461485];
    error(&Simple { g: 1.0 }, ([1.3], [0.0]), 100.0, &exact, method, steps)
}

fn driven(method: impl Method<Driven<Hung<f64>, (Sinusoid<2>,)>, 1>, steps: u64) -> f64 {
    let shaken = Hung { l: 1.0, g: 1.0 }.driven_by(Sinusoid::new([0.25, 0.0], 2.0, [0.0; 2]));
    error(&shaken, ([0.5], [0.0]), 10.0, &SHAKEN, method, steps)
}

fn henon_heiles(method: impl Method<HenonHeiles<f64>, 2>, steps: u64) -> f64 {
    let exact = [
        -0.0401942378760688167944025,
        0.679016921772021642134722,
        0.0384509289518598345020332,
        0.0485948315530036422431066,
    ];
    error(&HenonHeiles::new(1.0), ([0.1, 0.0], [0.0, 0.5]), 100.0, &exact, method, steps)
}

fn assert_order(order: f64, steps: u64, error: impl Fn(u64) -> f64) {
    let (coarse, fine) = (error(steps), error(steps * 3 / 2));
    let found = (coarse / fine).ln() / 1.5_f64.ln();
    assert!(
        (found - order).abs() < 0.2 * order,
        "order {found:.2} instead of {order} from {coarse:e} to {fine:e}"
    );
}

#[test]
fn the_order_is_the_parameter() {
    assert_order(8.0, 1600, |n| simple(QuinlanTremaine::<8>::new(), n));
    assert_order(10.0, 1200, |n| simple(QuinlanTremaine::<10>::new(), n));
    assert_order(12.0, 1000, |n| simple(QuinlanTremaine::<12>::new(), n));
    assert_order(8.0, 400, |n| driven(QuinlanTremaine::<8>::new(), n));
    assert_order(10.0, 200, |n| driven(QuinlanTremaine::<10>::new(), n));
    assert_order(8.0, 1600, |n| henon_heiles(QuinlanTremaine::<8>::new(), n));
    assert_order(10.0, 1200, |n| henon_heiles(QuinlanTremaine::<10>::new(), n));
    assert_order(12.0, 1200, |n| henon_heiles(QuinlanTremaine::<12>::new(), n));
}

#[test]
fn rounding_is_the_limit() {
    assert!(
        simple(QuinlanTremaine::<12>::new(), 10_000) < 1e-13,
        "{:e}",
        simple(QuinlanTremaine::<12>::new(), 10_000)
    );
    assert!(
        driven(QuinlanTremaine::<12>::new(), 3_000) < 1e-14,
        "{:e}",
        driven(QuinlanTremaine::<12>::new(), 3_000)
    );
    assert!(henon_heiles(QuinlanTremaine::<12>::new(), 10_000) < 1e-13);
}

#[test]
fn a_thousand_seconds_with_one_evaluation_a_step() {
    let (system, exact) = (Simple { g: 9.8 }, 1.2960573950636069);
    let run = |steps| {
        solve(&system, (0.0, 1000.0), [1.3], [0.0])
            .method(QuinlanTremaine::<12>::new())
            .steps(steps)
            .run()
            .unwrap()
    };
    let solution = run(35_000);
    assert!((solution.end.q[0] - exact).abs() < 2e-9, "{:e}", solution.end.q[0] - exact);
    // The start takes eleven steps of four parts with twelve evaluations each.
    assert!(solution.stats.evaluations < 35_000 + 12 * 4 * 12, "{}", solution.stats);
    assert!((run(50_000).end.q[0] - exact).abs() < 1e-11);
}

#[test]
fn energy_does_not_drift() {
    let system = Simple { g: 1.0 };
    let energy = |q: &[f64; 1], v: &[f64; 1]| system.energy(0.0, q, v, &());
    let largest = |steps: u64| {
        let start = energy(&[1.3], &[0.0]);
        let mut integrator =
            Integrator::new(&system, QuinlanTremaine::<10>::new(), 0.0, [1.3], [0.0])
                .unwrap()
                .control(FixedStep::new(0.1))
                .unwrap();
        let mut largest = 0.0_f64;
        for _ in 0..steps {
            integrator.step().unwrap();
            largest = largest.max((energy(integrator.q(), integrator.v()) - start).abs());
        }
        largest
    };
    let (short, long) = (largest(2_000), largest(200_000));
    assert!(short < 1e-7 && long < 1.5 * short, "{short:e} {long:e}");
}

#[test]
fn kinks_and_new_steps_begin_a_new_grid() {
    let times: Vec<f64> = (0..=20).map(f64::from).collect();
    let values: Vec<[f64; 2]> = (0..=20).map(|i| [0.1 * f64::from(i * i % 7), 0.0]).collect();
    let driven = Hung { l: 1.0, g: 9.81 }.driven_by(Linear::new(&times, &values).unwrap());
    let exact = solve(&driven, (0.0, 9.5), [0.3], [0.0]).rtol(1e-14).atol(1e-14).run().unwrap().end;
    let found = solve(&driven, (0.0, 9.5), [0.3], [0.0])
        .method(QuinlanTremaine::<12>::new())
        .step(0.02)
        .run()
        .unwrap();
    assert!(
        (found.end.q[0] - exact.q[0]).abs() < 1e-11 && (found.end.v[0] - exact.v[0]).abs() < 1e-11,
        "{:?} {exact:?}",
        found.end
    );
    assert_eq!(found.stats.kinks, 9);
    // No stop lies on the grid, and the steps between stops are fewer than a grid needs.
    let stops: Vec<f64> = (1..40).map(|i| f64::from(i) * 0.0937).collect();
    let system = Simple { g: 9.8 };
    let exact =
        solve(&system, (0.0, 10.0), [1.3], [0.0]).rtol(1e-14).atol(1e-14).run().unwrap().end;
    let problem =
        solve(&system, (0.0, 10.0), [1.3], [0.0]).method(QuinlanTremaine::<12>::new()).step(0.02);
    let found = problem.t_stops(&stops).run().unwrap().end;
    assert!((found.q[0] - exact.q[0]).abs() < 1e-11, "{found:?} {exact:?}");
}

#[test]
fn an_integration_by_hand_is_the_same() {
    let system = Simple { g: 9.8 };
    let whole = solve(&system, (0.0, 4.0), [1.3], [0.0])
        .method(QuinlanTremaine::<8>::new())
        .step(1.0 / 64.0)
        .run()
        .unwrap();
    let mut integrator = Integrator::new(&system, QuinlanTremaine::<8>::new(), 0.0, [1.3], [0.0])
        .unwrap()
        .control(FixedStep::new(1.0 / 64.0))
        .unwrap();
    for _ in 0..256 {
        integrator.step().unwrap();
    }
    assert_eq!(integrator.state(), whole.end);
    assert_eq!(integrator.stats().evaluations, whole.stats.evaluations);
    // A reset starts a new grid, even if the time is the same.
    integrator.reset(4.0, [1.0], [0.0]).unwrap();
    integrator.advance_to(6.0).unwrap();
    let exact = solve(&system, (4.0, 6.0), [1.0], [0.0]).rtol(1e-14).atol(1e-14).run().unwrap().end;
    assert!((integrator.q()[0] - exact.q[0]).abs() < 1e-9, "{} {}", integrator.q()[0], exact.q[0]);
}

/// The recurrence does not contain the velocities of the state, and events may already have
/// evaluated the accelerations.
#[test]
fn other_velocities_begin_a_new_grid() {
    let system = Simple { g: 9.8 };
    let never = |_: f64, _: &[f64; 1], _: &[f64; 1]| 1.0;
    let events = [Event::new(never)];
    let integrator =
        Integrator::new(&system, QuinlanTremaine::<8>::new(), 0.0, [0.0], [0.0]).unwrap();
    let mut integrator =
        integrator.control(FixedStep::new(1.0 / 128.0)).unwrap().events(&events).unwrap();
    integrator.advance_to(0.25).unwrap();
    integrator.reset(0.25, [0.0], [1.0]).unwrap();
    integrator.advance_to(0.5).unwrap();
    let exact =
        solve(&system, (0.25, 0.5), [0.0], [1.0]).rtol(1e-14).atol(1e-14).run().unwrap().end;
    assert!((integrator.q()[0] - exact.q[0]).abs() < 1e-11, "{} {}", integrator.q()[0], exact.q[0]);
}

#[test]
fn dense_output_is_as_good_as_the_steps() {
    let system = Simple { g: 1.0 };
    let exact =
        solve(&system, (0.0, 20.0), [1.3], [0.0]).rtol(1e-14).atol(1e-14).dense().run().unwrap();
    let found = solve(&system, (0.0, 20.0), [1.3], [0.0])
        .method(QuinlanTremaine::<12>::new())
        .step(0.05)
        .dense()
        .run()
        .unwrap();
    for k in 0..=1999 {
        let t = 0.01 * f64::from(k);
        let (a, b) = (exact.at(t).unwrap(), found.at(t).unwrap());
        // The quintic of the first seven steps: h⁶/46080, and h⁵/2000 in the velocities.
        let (q, v) = if t < 0.4 { (1e-12, 2e-9) } else { (1e-12, 5e-12) };
        assert!((a.q[0] - b.q[0]).abs() < q && (a.v[0] - b.v[0]).abs() < v, "{t}: {a:?} {b:?}");
    }
}

#[test]
fn a_failed_step_keeps_the_state() {
    let times = [0.0, 1.0, 2.0];
    let broken = Hung { l: 0.0, g: 1.0 }.driven_by(Linear::new(&times, &[[0.0; 2]; 3]).unwrap());
    let failure = solve(&broken, (0.0, 2.0), [0.3], [0.0])
        .method(QuinlanTremaine::<8>::new())
        .step(0.01)
        .run()
        .unwrap_err();
    assert!(
        matches!(failure.error, Error::NotFinite { .. }) && failure.to_string().contains("`l`"),
        "{failure}"
    );
    assert_eq!(failure.partial.end.q, [0.3]);
}

#[test]
fn single_precision() {
    let system = Simple { g: 1.0_f32 };
    let end = solve(&system, (0.0, 10.0), [1.3], [0.0])
        .method(QuinlanTremaine::<8>::new())
        .steps(200)
        .run()
        .unwrap()
        .end;
    assert!((f64::from(end.q[0]) + 1.16616038193295767624254).abs() < 2e-6, "{end:?}");
}
