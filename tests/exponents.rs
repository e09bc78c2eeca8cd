//! Lyapunov exponents of chaotic motions: averages over up to a million seconds, which take minutes
//! without optimization. `cargo test` leaves them out; `.ci/run` runs them in the profile `zoo`.

#![allow(confusable_idents, mixed_script_confusables, missing_docs)]

use pendulum_runtime::analysis::{Variational, lyapunov, variational_size};
use pendulum_runtime::integrate::AdaptiveStep;
use pendulum_runtime::prelude::*;
use systems::problems::Double;

lagrangian! {
    /// Ueda's oscillator.
    #[derive(Clone)]
    pub struct Ueda { b, A }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = x^4/4;
    dissipation = b*ẋ^2/2;
    force x = A*sin(t);
}

lagrangian! {
    /// A damped pendulum under a torque that follows a sine.
    #[derive(Clone)]
    pub struct Torqued { b, A, Ω }
    coordinate θ;
    kinetic = θ̇^2/2;
    potential = -cos(θ);
    dissipation = b*θ̇^2/2;
    force θ = A*sin(Ω*t);
}

const ONE: usize = variational_size(1, 0);

#[test]
fn uedas_oscillator_has_its_published_exponents() {
    // Sprott (2003), Chaos and Time-Series Analysis, A.5: b = 0.05, A = 7.5: 0.1034, 0, −0.1534 and
    // a dimension of 2.6741, including the dimension of time.
    let system = Variational::<_, 1, ONE>::new(Ueda::new(0.05, 7.5));
    let run = lyapunov(&system, 0.0, [2.5], [0.0]).transient(500.0).interval(2.0).rtol(1e-10);
    let spectrum = run.run(1e6).unwrap();
    let error = spectrum.standard_errors[0];
    assert!(error < 5e-4, "{spectrum}");
    assert!((spectrum.exponents[0] - 0.1034).abs() < 3.0 * error, "{spectrum}");
    assert!((spectrum.exponents[1] + 0.1534).abs() < 3.0 * error, "{spectrum}");
    assert!((spectrum.kaplan_yorke_dimension() + 1.0 - 2.6741).abs() < 0.005);
    assert!((spectrum.sum() + 0.05).abs() < 1e-9);
}

#[test]
fn a_driven_damped_pendulum_agrees_with_an_ensemble() {
    // The expected value is the mean over 2000 motions by the classical Runge–Kutta method in
    // NumPy: 0.14159 ± 0.00012.
    let system = Variational::<_, 1, ONE>::new(Torqued::new(0.05, 0.6, 0.7));
    let run = lyapunov(&system, 0.0, [0.0], [0.0]).transient(500.0).interval(2.0).rtol(1e-10);
    let spectrum = run.run(1e6).unwrap();
    let error = spectrum.standard_errors[0];
    assert!(error < 5e-4, "{spectrum}");
    assert!((spectrum.exponents[0] - 0.14159).abs() < 3.0 * error, "{spectrum}");
    assert!((spectrum.sum() + 0.05).abs() < 1e-9);
}

/// Returns the growth rate of a small difference, which is normalized every ten seconds (Benettin
/// et al. 1980).
fn lyapunov_exponent(seconds: u32) -> f64 {
    const M: usize = variational_size(2, 0);
    let system = Variational::<_, 2, M>::new(Double::new([1.0; 2], [1.0; 2], 1.0));
    let (mut q, mut v) = system.start([2.0, 2.5], [0.0; 2]);
    // Only the first column is needed.
    q[4..].fill(0.0);
    v[4..].fill(0.0);
    let control = AdaptiveStep::new().rtol(1e-9).atol(1e-9);
    let mut integrator =
        Integrator::new(&system, Dop853, 0.0, q, v).unwrap().control(control).unwrap();
    let mut growth = 0.0;
    for stage in 1..=seconds / 10 {
        let t = f64::from(10 * stage);
        integrator.advance_to(t).unwrap();
        (q, v) = (*integrator.q(), *integrator.v());
        let length = (q[2..4].iter().chain(&v[2..4]).map(|x| x * x).sum::<f64>()).sqrt();
        growth += length.ln();
        q[2..4].iter_mut().chain(&mut v[2..4]).for_each(|x| *x /= length);
        integrator.reset(t, q, v).unwrap();
    }
    growth / f64::from(seconds)
}

#[test]
fn the_chaotic_double_pendulum_has_its_lyapunov_exponent() {
    let found = lyapunov_exponent(20_000);
    assert!((found - 0.46).abs() < 0.01, "{found}");
}
