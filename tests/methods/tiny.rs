//! States far below the tolerance, down to numbers without all their digits.

use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Float as _;
use pendulum_runtime::system::System;

lagrangian! {
    /// A spring, a pendulum and an unstable equilibrium in one, with a kick at the time c.
    #[derive(Clone, Copy, Debug)]
    pub struct Kicked { k, b, g, a, w, c }
    coordinate q;
    kinetic = q̇^2/2;
    potential = k*q^2/2 - g*cos(q);
    force q = b*q^3 + a/cosh((t - c)/w);
}

lagrangian! {
    /// Two springs that do not know of each other.
    #[derive(Clone, Copy, Debug)]
    pub struct Apart { k }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = k*(x^2 + y^2)/2;
}

const STILL: Kicked<f64> = Kicked { k: 0.0, b: 0.0, g: 0.0, a: 0.0, w: 1.0, c: 0.0 };

/// A system whose motion is proportional to `scale` as long as it is small.
struct Case {
    name: &'static str,
    system: Kicked<f64>,
    end: f64,
    q: f64,
    v: f64,
    /// The coordinate at the end for a scale of 1.
    exact: f64,
    /// The factor by which errors grow.
    amplification: f64,
}

/// Returns the cases and their closed forms: of the oscillator ẍ = −x + a sech((t − c)/w) from rest
/// long after c, x = π a w sech(π w/2) sin(t − c), because π w sech(π ω w/2) is the Fourier
/// transform of sech(t/w).
fn cases() -> [Case; 6] {
    let kicked = |a: f64, w: f64, after: f64| {
        let half = core::f64::consts::FRAC_PI_2 * w;
        2.0 * a * half / half.cosh() * after.sin()
    };
    let case = |name, system, end, q, v, exact| Case {
        name,
        system,
        end,
        q,
        v,
        exact,
        amplification: f64::max(1.0, exact),
    };
    let kick = Kicked { a: 3.0, c: 5.0, ..STILL };
    [
        case("spring", Kicked { k: 1.0, ..STILL }, 10.0, 1.0, 0.0, 10f64.cos()),
        case("hard", Kicked { k: 100.0, b: -1.0, ..STILL }, 2.0, 0.0, 10.0, 20f64.sin()),
        case(
            "pendulum",
            Kicked { g: 1.0, ..STILL },
            10.0,
            1.0,
            0.5,
            10f64.cos() + 0.5 * 10f64.sin(),
        ),
        case("unstable", Kicked { k: -25.0, b: 1.0, ..STILL }, 2.0, 1.0, 0.0, 10f64.cosh()),
        case("sharp", Kicked { k: 1.0, w: 0.1, ..kick }, 10.0, 0.0, 0.0, kicked(3.0, 0.1, 5.0)),
        case(
            "swinging",
            Kicked { g: 1.0, w: 0.2, ..kick },
            10.0,
            1.0,
            0.0,
            10f64.cos() + kicked(3.0, 0.2, 5.0),
        ),
    ]
}

/// The number of steps of a method and the coordinate at the end.
struct Outcome {
    name: &'static str,
    steps: u64,
    q: f64,
}

/// Runs a case by every adaptive method.
macro_rules! by_all {
    ($name:ident, $scalar:ty, $($method:expr),*) => {
        fn $name(case: &Case, scale: f64, rtol: f64, atol: f64) -> Vec<Outcome> {
            let number = <$scalar as Real>::from_f64;
            let a = case.system.a * scale;
            let system = Kicked { a, ..case.system }.map(number);
            let (q, v) = ([number(case.q * scale)], [number(case.v * scale)]);
            let mut outcomes = Vec::new();
            $({
                let run = solve(&system, (0.0, case.end), q, v).method($method).rtol(rtol).atol(atol);
                let run = run.max_steps(2000).run();
                let run = run.unwrap_or_else(|f| panic!("{} of {scale:e}: {f}", case.name));
                let steps = run.stats.accepted + run.stats.rejected;
                outcomes.push(Outcome { name: run.stats.method, steps, q: run.end.q[0].to_f64() });
            })*
            outcomes
        }
    };
}

by_all!(in_double, f64, Picard, Dop853, Taylor::new(), Dprkn12, Rodas4);
by_all!(in_single, f32, Picard, Dop853, Taylor::new(), Dprkn12, Rodas4);

/// Tests that the numbers of steps from each scale are about that from `usual`, and errors within
/// the tolerance. `atol` is the absolute tolerance for a scale.
fn check(
    run: fn(&Case, f64, f64, f64) -> Vec<Outcome>,
    scales: &[f64],
    usual: f64,
    atol: fn(f64) -> f64,
) {
    for case in cases() {
        let bound = run(&case, usual, 1e-5, atol(usual));
        for &scale in scales {
            let tolerance = atol(scale) + 1e-5 * scale;
            for (outcome, bound) in run(&case, scale, 1e-5, atol(scale)).iter().zip(&bound) {
                let (name, error) = (outcome.name, (outcome.q - scale * case.exact).abs());
                let at = format!("{} of {scale:e} by {name}", case.name);
                assert!(outcome.steps <= 2 * bound.steps + 30, "{at}: {} steps", outcome.steps);
                // `Rodas4` has the largest error, of three tolerances.
                let most = 5.0 * tolerance * case.amplification;
                assert!(error <= most, "{at}: {error:e}, above {most:e}");
            }
        }
    }
}

/// Squares of all these numbers are zero in `f64`.
#[test]
fn states_below_the_tolerance_do_not_shorten_steps() {
    let scales = [5e-324, 1e-320, 1e-310, 3e-308, 1e-290, 1e-200, 1e-163, 1e-154, 1e-100];
    check(in_double, &scales, 1e-20, |_| 1e-6);
    check(in_single, &[1e-45, 1e-42, 1e-38, 1e-30, 1e-22, 1e-19, 1e-12], 1e-8, |_| 1e-5);
}

/// A tolerance below the rounding errors of numbers of the size of one asks for digits of smaller
/// ones.
#[test]
fn tolerances_in_proportion_to_tiny_states_are_kept() {
    check(in_double, &[1e-300, 1e-250, 1e-162, 1e-150, 1e-60, 1e-30], 1e-6, |scale| 1e-5 * scale);
    check(in_single, &[3e-32, 1e-25, 1e-19, 1e-12], 1e-5, |scale| 1e-5 * scale);
}

/// Single precision has no digits for these tolerances.
#[test]
fn tolerances_without_digits_do_not_shorten_steps() {
    for case in cases() {
        for scale in [1e-44, 1e-42, 1e-40, 1e-38] {
            for outcome in in_single(&case, scale, 1e-5, 1e-5 * scale) {
                let (name, steps) = (outcome.name, outcome.steps);
                assert!(steps < 300, "{} of {scale:e} by {name}: {steps} steps", case.name);
            }
        }
    }
}

/// Expected values are from the classical method of order 4 with 100 000 steps; with half as many
/// they differ by 4e-13.
#[test]
fn a_pendulum_at_rest_gets_a_late_kick() {
    const EXPECTED: [f64; 2] = [0.1203490976190, -0.8626715544764];
    let system = Kicked { g: 9.81, a: 30.0, w: 0.01, c: 5.0, ..STILL };
    macro_rules! kicked {
        ($($method:expr),*) => {$(
            let run = solve(&system, (0.0, 20.0), [0.0], [0.0]).method($method).run().unwrap();
            let (name, steps) = (run.stats.method, run.stats.accepted);
            let error = f64::max((run.end.q[0] - EXPECTED[0]).abs(), (run.end.v[0] - EXPECTED[1]).abs());
            assert!(error < 2e-5 && steps < 500, "{name}: {error:e} after {steps} steps");
        )*};
    }
    kicked!(Picard, Dop853, Dprkn12, Rodas4);
}

by_all!(late_in_double, f64, Picard, Dop853, Taylor::new());
by_all!(late_in_single, f32, Picard, Dop853, Taylor::new());

/// Sixty springs at rest, each kicked once, with widths from 3 ms to 0.1 s.
#[test]
fn late_kicks_are_neither_missed_nor_slow() {
    // The fractional parts of multiples of four irrational numbers.
    let part = |n: u32, factor: f64| (f64::from(n + 1) * factor).fract();
    for n in 0..60 {
        let (ω, c) = (0.5 + 2.5 * part(n, 0.6180339887), 3.0 + 12.0 * part(n, 0.4142135623));
        let (w, a) =
            (0.003 * 33f64.powf(part(n, 0.7320508075)), 10.0 + 50.0 * part(n, 0.2360679775));
        let half = core::f64::consts::FRAC_PI_2 * w;
        let size = 2.0 * a * half / ((half * ω).cosh() * ω);
        let case = Case {
            name: "late",
            system: Kicked { k: ω * ω, a, w, c, ..STILL },
            end: 20.0,
            q: 0.0,
            v: 0.0,
            exact: size * (ω * (20.0 - c)).sin(),
            amplification: 1.0,
        };
        let look = |outcomes: Vec<Outcome>, rtol: f64, most: u64| {
            for Outcome { name, steps, q } in outcomes {
                let merit = (q - case.exact).abs() / (rtol * (1.0 + size * f64::max(1.0, ω)));
                let at = format!("kick {n} by {name} at {rtol:e}");
                assert!(merit < 10.0 && steps < most, "{at}: {merit} in {steps} steps");
            }
        };
        let rtol = 10f64.powf(-3.0 - 7.0 * part(n, 0.3027756377));
        look(late_in_double(&case, 1.0, rtol, rtol), rtol, 1000);
        let rtol = 10f64.powf(-3.0 - 1.5 * part(n, 0.3027756377));
        look(late_in_single(&case, 1.0, rtol, rtol), rtol, 500);
    }
}

/// Two springs, one with a large amplitude, in steps of the same number as usual.
#[test]
fn squares_that_overflow_are_no_obstacle() {
    macro_rules! far {
        ($scalar:ty, $usual:expr, $scales:expr, $($method:expr),*) => {$({
            let run = |scale: f64| {
                let number = <$scalar as Real>::from_f64;
                let system = Apart { k: 1.0 }.map(number);
                let start = [1.0, scale].map(number);
                let run = solve(&system, (0.0, 20.0), start, [number(0.0); 2]).method($method);
                let run = run.rtol(1e-5).max_steps(2000).run();
                let run = run.unwrap_or_else(|failure| panic!("{scale:e}: {failure}"));
                let error = (run.end.q[1].to_f64() / scale - 20f64.cos()).abs();
                assert!(error < 2e-4, "{} of {scale:e}: {error:e}", run.stats.method);
                run.stats.accepted + run.stats.rejected
            };
            let usual = run($usual);
            for scale in $scales {
                let steps = run(scale);
                // First steps are as short as the swing is large, and grow from there.
                assert!(steps <= 2 * usual + 100, "{steps} steps of {scale:e}, {usual} usually");
            }
        })*};
    }
    far!(f64, 1e10, [1e152, 1e155, 1e200, 1e300], Picard, Dop853, Taylor::new(), Dprkn12, Rodas4);
    far!(f32, 1e10, [1e18, 1e20, 1e30], Picard, Dop853, Taylor::new(), Dprkn12, Rodas4);
}

/// Coordinates without coupling, one of them tiny.
#[test]
fn a_tiny_coordinate_beside_another_does_not_shorten_steps() {
    let run = |y| {
        let run = solve(&Apart { k: 1.0 }, (0.0, 20.0), [1.0, y], [0.0; 2]).method(Picard).run();
        let run = run.unwrap();
        assert!((run.end.q[0] - 20f64.cos()).abs() < 1e-6, "{y}");
        run.stats.accepted
    };
    let plain = run(0.0);
    for y in [5e-324, 1e-310, 1e-200, 1e-163, 1e-100] {
        assert_eq!(run(y), plain, "{y:e}");
    }
}
