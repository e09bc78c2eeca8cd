//! Variational equations by `Picard`.

use pendulum_runtime::analysis::{Variational, variational_size};
use pendulum_runtime::motion::{Curve, Sinusoid};
use pendulum_runtime::nalgebra::DMatrix;
use pendulum_runtime::prelude::*;

use crate::variational::blocks::{Forced, Hung};

#[test]
fn picard_has_the_published_sensitivities() {
    // The digits of `tests/data/variational.py`; rounded, they agree with heyoka.py's tutorial on
    // variational equations.
    const M: usize = variational_size(1, 1);
    let system = Variational::<_, 1, M>::new(Forced::new(0.4));
    let (q, v) = system.start([0.2], [0.3]);
    let solution =
        solve(&system, (0.0, 3.0), q, v).method(Picard).rtol(1e-13).atol(1e-13).run().unwrap();
    assert_eq!(solution.stats.method, "Picard");
    let end = solution.end;
    let expected = [
        (system.by_position(&end, 0), [-0.42547799684275369339, -0.19171818343890700153]),
        (system.by_velocity(&end, 0), [0.41983648992585684417, -0.51871994406285746946]),
        (system.by_parameter(&end, 0), [-0.25807427091440042944, 0.86792700365180577626]),
    ];
    for ((q, v), expected) in expected {
        assert!((q[0] - expected[0]).abs() < 1e-13, "{} for {}", q[0], expected[0]);
        assert!((v[0] - expected[1]).abs() < 1e-13, "{} for {}", v[0], expected[1]);
    }
}

/// Returns the transition of a driven double pendulum, and its sensitivity to the first two
/// parameters.
fn hung(picard: bool) -> (DMatrix<f64>, [[f64; 2]; 2]) {
    const M: usize = variational_size(2, 2);
    let varied = Variational::<_, 2, M>::new(Hung::new(9.81, 0.7, 0.5, 0.2));
    let knots = Curve::linear(&[0.0, 0.5, 2.0], &[[0.0, 0.0], [0.1, 0.2], [-0.1, 0.0]]).unwrap();
    let (q, v) = varied.start([0.9, 0.3], [0.0, 1.0]);
    let driven = pendulum_runtime::system::Driven::new(varied.clone(), (knots,));
    let run = solve(&driven, (0.0, 1.5), q, v).rtol(1e-13).atol(1e-13);
    let end = if picard { run.method(Picard).run() } else { run.method(Dop853).run() };
    let end = end.unwrap().end;
    (varied.transition(&end), [0, 1].map(|index| varied.by_parameter(&end, index).0))
}

#[test]
fn picard_and_dop853_agree_on_driven_systems_across_kinks() {
    let ((by_start, by_parameters), (others, other_parameters)) = (hung(true), hung(false));
    assert!((&by_start - &others).norm() < 1e-10 * others.norm(), "{}", by_start - &others);
    for (a, b) in by_parameters.iter().flatten().zip(other_parameters.iter().flatten()) {
        assert!((a - b).abs() < 1e-10 * (1.0 + b.abs()), "{a} for {b}");
    }
}

#[test]
fn picard_keeps_areas_in_phase_space() {
    // Liouville's theorem: without damping, the determinant is 1 in the momenta, also on a shaken
    // pivot. In velocities, the determinant is the ratio of det M at both ends, which depends on θ₁
    // − θ₂.
    const M: usize = variational_size(2, 0);
    let system = Hung::new(9.81, 0.7, 0.5, 0.0);
    let varied = Variational::<_, 2, M>::new(system.clone());
    let (q, v) = varied.start([0.9, 0.3], [0.0, 1.0]);
    let hand = Sinusoid::new([0.05, 0.0], 6.0, [0.0, 0.0]);
    let driven = pendulum_runtime::system::Driven::new(varied.clone(), (hand,));
    let run = solve(&driven, (0.0, 1.5), q, v).method(Picard).rtol(1e-13).atol(1e-13);
    let end = run.run().unwrap().end;
    // det M = l⁴ m (1 + m sin²(θ₁ − θ₂)) up to a constant.
    let mass = |q: &[f64]| 1.0 + 0.7 * (q[0] - q[1]).sin() * (q[0] - q[1]).sin();
    let found = varied.transition(&end).determinant() * mass(&end.q) / mass(&q);
    assert!((found - 1.0).abs() < 1e-10, "{found}");
}
