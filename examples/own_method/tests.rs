//! Tests of the order of the method.

use crate::Pendulum;
use crate::bogacki_shampine::BogackiShampine;
use pendulum_runtime::error::{Error, Suspect};
use pendulum_runtime::prelude::*;

/// Returns the error of a pendulum's angle after 2 s.
fn end(method: impl Fn(&Pendulum<f64>) -> Solution<f64, 1>) -> f64 {
    let pendulum = Pendulum::new(0.5);
    let exact = solve(&pendulum, (0.0, 2.0), [1.3], [0.0]).rtol(1e-13).run().unwrap();
    (method(&pendulum).end.q[0] - exact.end.q[0]).abs()
}

#[test]
fn errors_fall_with_the_third_power_of_the_step() {
    let error = |h: f64| {
        end(|pendulum| {
            let run = solve(pendulum, (0.0, 2.0), [1.3], [0.0]).method(BogackiShampine);
            run.step(h).run().unwrap()
        })
    };
    let order = (error(0.01) / error(0.005)).log2();
    assert!((order - 3.0).abs() < 0.2, "{order}");
}

#[test]
fn errors_follow_the_tolerance() {
    for rtol in [1e-4, 1e-6, 1e-8] {
        let error = end(|pendulum| {
            let run = solve(pendulum, (0.0, 2.0), [1.3], [0.0]).method(BogackiShampine);
            run.rtol(rtol).run().unwrap()
        });
        assert!((rtol..100.0 * rtol).contains(&error), "{rtol:e}: {error:e}");
    }
}

#[test]
fn the_interpolant_meets_both_ends_of_a_step() {
    let pendulum = Pendulum::new(0.5);
    let mut run = Integrator::new(&pendulum, BogackiShampine, 0.0, [1.3], [0.0]).unwrap();
    run.advance_to(0.3).unwrap();
    let within = run.interpolant().unwrap();
    let (q, v) = within.at(1.0);
    assert!((q[0] - run.q()[0]).abs() < 1e-15 && (v[0] - run.v()[0]).abs() < 1e-15);
    assert_eq!(within.at(0.0), (within.q0, within.v0));
}

#[test]
fn a_step_that_fails_names_the_parameter() {
    let mut pendulum = Pendulum::new(0.5);
    pendulum.L = 0.0;
    let failure = solve(&pendulum, (0.0, 2.0), [1.3], [0.0])
        .method(BogackiShampine)
        .step(0.01)
        .run()
        .unwrap_err();
    assert!(
        matches!(&failure.error, Error::NotFinite { suspects, .. }
            if suspects == &[Suspect { parameter: "L", value: 0.0 }]),
        "{failure}"
    );
}
