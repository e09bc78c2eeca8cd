//! The default of the absolute tolerance, and its effect on work and error.

use pendulum_runtime::prelude::*;
use pendulum_runtime::system::System;

use systems::pendulums::Simple;
use systems::problems::Kepler;

lagrangian! {
    /// A pendulum that friction brings to rest.
    pub struct Damped { k: 1/s^2, c: 1/s }
    coordinate θ: rad;
    kinetic = θ̇^2/2;
    potential = -k*cos(θ);
    dissipation = c/2*θ̇^2;
}

/// Tests that the default of `atol` is `rtol` for all methods.
#[test]
fn the_absolute_tolerance_is_the_relative_one_unless_said() {
    let pendulum = Simple::new(1.0, 0.5);
    macro_rules! same {
        ($($method:expr),+) => {$(
            for rtol in [1e-3, 1e-5, 1e-11] {
                let run = || solve(&pendulum, (0.0, 3.0), [1.3], [0.0]).method($method).rtol(rtol);
                let (silent, said, other) = (run().run().unwrap(), run().atol(rtol).run().unwrap(), run().atol(1e-8).run().unwrap());
                let name = silent.stats.method;
                assert_eq!((silent.end, silent.stats), (said.end, said.stats), "{name} at {rtol:e}");
                assert_ne!(silent.end, other.end, "{name} at {rtol:e} does not look at `atol`");
            }
        )+};
    }
    same!(Auto, Picard, Taylor::new(), Dop853, Dprkn12, Rodas4);
    let pendulum = Simple::new(1.0_f32, 0.5);
    let run = || solve(&pendulum, (0.0, 3.0), [1.3], [0.0]).method(Dop853);
    let least = 100.0 * f64::from(f32::EPSILON);
    assert_eq!(run().run().unwrap().end, run().rtol(least).atol(least).run().unwrap().end);
}

/// Returns the number of evaluations and the largest error at the end.
fn work<S: System<N, Scalar = f64, Inputs = ()>, const N: usize>(
    system: &S,
    end: f64,
    (q, v): ([f64; N], [f64; N]),
    rtol: f64,
    atol: f64,
) -> (u64, f64) {
    let exact =
        solve(system, (0.0, end), q, v).method(Dop853).rtol(3e-15).atol(1e-16).run().unwrap().end;
    let found = solve(system, (0.0, end), q, v).method(Dop853).rtol(rtol).atol(atol).run().unwrap();
    let pairs = exact.q.iter().chain(&exact.v).zip(found.end.q.iter().chain(&found.end.v));
    (found.stats.evaluations, pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs())))
}

/// The figures of `pendulum-runtime/src/guide/accuracy.md`: with an absolute tolerance of 1e-9, and
/// with the default.
#[test]
fn a_tolerance_that_follows_keeps_the_error_at_it() {
    for rtol in [1e-3, 1e-6, 1e-9, 1e-12] {
        let both = |name: &str, run: &dyn Fn(f64) -> (u64, f64), amplified: f64| {
            let [fixed, follows] = [1e-9, rtol].map(run);
            println!(
                "| {name} | {rtol:e} | {} | {:.1e} | {} | {:.1e} |",
                fixed.0, fixed.1, follows.0, follows.1
            );
            assert!(follows.1 < amplified * rtol, "{name} at {rtol:e}: {:e}", follows.1);
            // With a loose `rtol` the default costs no more than a fixed tolerance, and with a
            // tight `rtol` the accuracy justifies the cost.
            if 1e-9 < rtol {
                assert!(follows.0 <= fixed.0, "{name} at {rtol:e}: {} and {}", follows.0, fixed.0);
            } else if rtol < 1e-9 {
                assert!(
                    follows.1 < fixed.1,
                    "{name} at {rtol:e}: {:e} and {:e}",
                    follows.1,
                    fixed.1
                );
            }
        };
        // The measured errors are at most 16, 0.12 and 110 tolerances.
        both(
            "swinging",
            &|atol| work(&Simple::new(1.0, 0.5), 10.0, ([1.3], [0.0]), rtol, atol),
            30.0,
        );
        both(
            "coming to rest",
            &|atol| work(&Damped::new(10.0, 0.6), 60.0, ([1.3], [0.0]), rtol, atol),
            0.5,
        );
        both(
            "orbit",
            &|atol| work(&Kepler::new(1.0), 20.0, ([0.1, 0.0], [0.0, 19.0_f64.sqrt()]), rtol, atol),
            400.0,
        );
    }
}
