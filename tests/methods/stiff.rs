//! The linearly implicit method: order, digits, and stiff springs and dampers.
//!
//! The digits are those of `tests/methods/problems.rs`.

use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::motion::{Curve, Sinusoid};
use pendulum_runtime::prelude::*;

use systems::distance::distance;
use systems::problems::{DampedElastic, Double, Forced, Hung, Simple};

/// Returns two links and bobs of one metre and one kilogram, with g = 1 m/s².
fn double() -> Double<f64> {
    Double::new([1.0; 2], [1.0; 2], 1.0)
}

fn error<D: Dynamics<N, Scalar = f64>, const N: usize>(
    dynamics: &D,
    q: [f64; N],
    exact: &[f64],
    steps: u64,
) -> f64
where
    Rodas4: Method<D, N>,
{
    let end =
        solve(dynamics, (0.0, 10.0), q, [0.0; N]).method(Rodas4).steps(steps).run().unwrap().end;
    distance((end.q, end.v), exact)
}

const DOUBLE: [f64; 4] = [
    -0.317126753679008418729030,
    0.502495051916668693314933,
    -0.152579088816347670822437,
    -0.159373774298781573884821,
];
const SHAKEN: [f64; 2] = [0.0342105591464723414299261, -1.02072871213303888830643];
const FORCED: [f64; 2] = [-6.16862184561575671593007, 1.73729062797933203483616];

#[test]
fn the_order_is_four_whatever_stands_in_the_equations() {
    let shaken = Hung { l: 1.0, g: 1.0 }.driven_by(Sinusoid::new([0.25, 0.0], 2.0, [0.0; 2]));
    let cases: [(&str, &dyn Fn(u64) -> f64); 3] = [
        ("double", &|n| error(&double(), [0.5, -0.25], &DOUBLE, n)),
        ("driven", &|n| error(&shaken, [0.5], &SHAKEN, n)),
        ("forced", &|n| error(&Forced::new(0.25), [0.0], &FORCED, n)),
    ];
    for (name, error) in cases {
        // The leading term of the error is so small that the next term is still visible.
        let (coarse, fine) = (error(1600), error(3200));
        let order = (coarse / fine).log2();
        assert!(
            (3.8..4.7).contains(&order),
            "{name}: order {order:.2} from {coarse:e} to {fine:e}"
        );
    }
}

#[test]
fn tolerances_are_kept() {
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let system = double();
        let problem = solve(&system, (0.0, 10.0), [0.5, -0.25], [0.0; 2]).method(Rodas4);
        let end = problem.rtol(tolerance).atol(tolerance).run().unwrap().end;
        let error = distance((end.q, end.v), &DOUBLE);
        assert!(error < 100.0 * tolerance, "{tolerance:e}: {error:e}");
    }
}

#[test]
fn dense_output_is_of_order_three() {
    let (system, q) = (double(), [0.5, -0.25]);
    let exact =
        solve(&system, (0.0, 2.0), q, [0.0; 2]).rtol(1e-13).atol(1e-13).dense().run().unwrap();
    let largest = |steps| {
        let found = solve(&system, (0.0, 2.0), q, [0.0; 2])
            .method(Rodas4)
            .steps(steps)
            .dense()
            .run()
            .unwrap();
        let errors = (0..=400).map(|k| {
            let (a, b) =
                (exact.at(f64::from(k) / 200.0).unwrap(), found.at(f64::from(k) / 200.0).unwrap());
            (a.q[0] - b.q[0]).abs().max((a.v[1] - b.v[1]).abs())
        });
        errors.fold(0.0, f64::max)
    };
    let (coarse, fine) = (largest(40), largest(80));
    assert!(2.7 < (coarse / fine).log2(), "{coarse:e} {fine:e}");
}

#[test]
fn a_rod_that_hardly_gives_costs_no_steps() {
    let rigid = solve(&Simple::new(1.0), (0.0, 10.0), [1.0], [0.0])
        .rtol(1e-12)
        .atol(1e-12)
        .run()
        .unwrap()
        .end;
    for k in [1e4_f64, 1e6, 1e8, 1e10] {
        // The spring is so strongly damped that only the motion of the pendulum remains.
        let elastic = DampedElastic { k, c: 2.0 * k.sqrt() };
        let problem =
            solve(&elastic, (0.0, 10.0), [1.0 + 1.0_f64.cos() / k, 1.0], [0.0; 2]).method(Rodas4);
        let solution = problem.rtol(1e-7).atol(1e-9).run().unwrap();
        let error = (solution.end.q[1] - rigid.q[0]).abs();
        assert!(error < 20.0 / k + 3e-6, "k = {k:e}: {error:e}, {}", solution.stats);
        let most = if k < 1e6 { 1500 } else { 400 };
        assert!(solution.stats.accepted < most, "k = {k:e}: {}", solution.stats);
    }
}

#[test]
fn dampers_do_not_ring() {
    for (k, c) in [(1e4, 1e3), (1e4, 1e6), (1e10, 1e6), (1.0, 1e6)] {
        // The pendulum hangs straight down, and the spring is stretched by 0.1 beyond its
        // equilibrium.
        let (elastic, rest) = (DampedElastic { k, c }, 1.0 + 1.0 / k);
        let problem =
            solve(&elastic, (0.0, 2.0), [rest + 0.1, 0.0], [0.0; 2]).method(Rodas4).step(0.01);
        let solution = problem.every_step().run().unwrap();
        let mut last = 0.1;
        for q in &solution.q {
            let stretch = q[0] - rest;
            assert!(
                -1e-6 < stretch && stretch <= last + 1e-9,
                "k = {k:e}, c = {c:e}: {stretch:e} after {last:e}"
            );
            last = stretch;
        }
        // The slower of the two rates, about k/c.
        let slow = 0.5 * (c - (c * c - 4.0 * k).sqrt());
        let slow = if slow == 0.0 || 1e5 < c { k / c } else { slow };
        assert!((last - 0.1 * (-2.0 * slow).exp()).abs() < 1e-4, "k = {k:e}, c = {c:e}: {last:e}");
    }
}

#[test]
fn stiff_and_explicit_agree_where_both_can() {
    let elastic = DampedElastic { k: 1e6, c: 1e3 };
    let start = ([1.001, 1.0], [0.0; 2]);
    let exact = solve(&elastic, (0.0, 5.0), start.0, start.1)
        .method(Dop853)
        .rtol(1e-12)
        .atol(1e-14)
        .run()
        .unwrap();
    let found = solve(&elastic, (0.0, 5.0), start.0, start.1)
        .method(Rodas4)
        .rtol(1e-8)
        .atol(1e-10)
        .run()
        .unwrap();
    let error =
        (found.end.q[1] - exact.end.q[1]).abs().max((found.end.q[0] - exact.end.q[0]).abs());
    assert!(error < 1e-6, "{error:e}");
    assert!(
        10 * found.stats.accepted < exact.stats.accepted,
        "{} against {}",
        found.stats,
        exact.stats
    );
}

#[test]
fn kinks_are_carried_over() {
    let times: Vec<f64> = (0..=20).map(f64::from).collect();
    let values: Vec<[f64; 2]> = (0..=20).map(|i| [0.1 * f64::from(i * i % 7), 0.0]).collect();
    let driven = Hung { l: 1.0, g: 9.81 }.driven_by(Curve::linear(&times, &values).unwrap());
    let exact = solve(&driven, (0.0, 9.5), [0.3], [0.0]).rtol(1e-13).atol(1e-13).run().unwrap().end;
    let found = solve(&driven, (0.0, 9.5), [0.3], [0.0])
        .method(Rodas4)
        .rtol(1e-9)
        .atol(1e-9)
        .run()
        .unwrap()
        .end;
    assert!((found.q[0] - exact.q[0]).abs() < 1e-6, "{found:?} {exact:?}");
}

lagrangian! {
    /// A block that is shaken, with dry friction that is softened over a small velocity `e`.
    #[derive(Clone, Copy, Debug)]
    pub struct Softened { F: N, e: m/s, m: kg = 1, A: m = 1, w: Hz = 2*pi }
    coordinate x: m;
    kinetic = m/2*ẋ^2;
    force x = m*A*w^2*sin(w*t) - F*tanh(ẋ/e);
}

/// The Jacobians at the start of a step that begins with sticking are those of a strong damper, which
/// is weak at its end: by them alone, a step over the break-away has a small error, and the run with
/// F = 2 N at 3e-7 is off by ten thousand tolerances.
#[test]
fn a_damper_that_saturates_within_a_step_is_seen() {
    for k in [0, 2, 4, 7, 9] {
        let k = f64::from(k);
        let block = Softened::new(1.5 + 0.125 * k, 1e-6 * (1.0 + 0.5 * (k - 4.0).abs()));
        let end = |tolerance: f64| {
            let run = solve(&block, (0.0, 10.0), [0.0], [10.0]).method(Rodas4);
            run.rtol(tolerance).atol(tolerance).run().unwrap().end.q[0]
        };
        let best = end(1e-10);
        for tolerance in [1e-6, 3e-7, 1e-7] {
            let error = (end(tolerance) - best).abs() / tolerance;
            assert!(error < 30.0, "{block:?}, {tolerance:e}: {error}");
        }
    }
}
