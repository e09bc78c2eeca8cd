//! Lyapunov spectra: closed forms and Liouville's theorem; `tests/exponents.rs` has the
//! published values.

use pendulum_runtime::analysis::{Variational, lyapunov, variational_size};
use pendulum_runtime::prelude::*;
use systems::problems::{Double, HenonHeiles};

pub(crate) mod blocks {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        #[derive(Clone)]
        pub struct Damped { k, c }
        coordinate x;
        kinetic = ẋ^2/2;
        potential = k*x^2/2;
        dissipation = c*ẋ^2/2;
    }

    lagrangian! {
        /// A motion that ends in a pole.
        #[derive(Clone)]
        pub struct Falling { k }
        coordinate x;
        kinetic = ẋ^2/2;
        potential = -k/x;
    }
}

use blocks::*;

const ONE: usize = variational_size(1, 0);
const TWO: usize = variational_size(2, 0);

#[test]
fn linear_systems_have_the_real_parts_of_their_eigenvalues() {
    // λ² + 3 λ + 2 = 0.
    let node = Variational::<_, 1, ONE>::new(Damped::new(2.0, 3.0));
    let spectrum = lyapunov(&node, 0.0, [1.0], [0.0]).transient(30.0).run(20.0).unwrap();
    assert!((spectrum.exponents[0] + 1.0).abs() < 1e-10, "{spectrum}");
    assert!((spectrum.exponents[1] + 2.0).abs() < 1e-10, "{spectrum}");
    assert!(spectrum.standard_errors.iter().all(|&error| error < 1e-9), "{spectrum}");
    assert_eq!((spectrum.time, spectrum.kaplan_yorke_dimension()), (20.0, 0.0));
    // A focus: both exponents are −c/2, but in a finite interval only their sum is exact.
    let focus = Variational::<_, 1, ONE>::new(Damped::new(4.0, 0.5));
    let spectrum = lyapunov(&focus, 0.0, [1.0], [0.0]).method(Dop853).run(2000.0).unwrap();
    assert!((spectrum.sum() + 0.5).abs() < 1e-12);
    assert!((spectrum.exponents[0] + 0.25).abs() < 1e-3, "{spectrum}");
}

/// Asserts that the sum is zero to rounding, the exponents form pairs, and two exponents vanish.
fn conservative(exponents: &[f64], errors: &[f64], sum: f64) {
    assert!(sum.abs() < 1e-9, "{sum:e}");
    for i in 0..2 {
        let pair = exponents[i] + exponents[3 - i];
        assert!(pair.abs() <= errors[i] + errors[3 - i], "{exponents:?} ± {errors:?}");
    }
    assert!(exponents[1].abs() < 0.01 && 5.0 * errors[0] < exponents[0], "{exponents:?}");
}

#[test]
fn henon_and_heiles_have_pairs_that_add_up_to_zero() {
    let system = Variational::<_, 2, TWO>::new(HenonHeiles::new(1.0));
    let run = lyapunov(&system, 0.0, [0.0, -0.25], [0.42, 0.0]).transient(200.0).interval(2.0);
    let spectrum = run.run(2000.0).unwrap();
    conservative(&spectrum.exponents, &spectrum.standard_errors, spectrum.sum());
    // A regular motion at the same energy has no positive exponent.
    let px = (0.25_f64 - 0.3 * 0.3 + 2.0 / 3.0 * 0.3 * 0.3 * 0.3).sqrt();
    let run = lyapunov(&system, 0.0, [0.0, 0.3], [px, 0.0]).transient(1000.0).interval(2.0);
    let spectrum = run.run(2000.0).unwrap();
    assert!(spectrum.exponents[0] < 0.005, "{spectrum}");
}

#[test]
fn a_double_pendulum_has_pairs_that_add_up_to_zero() {
    // Velocities are not canonical coordinates here: the mass matrix depends on the angles.
    let system = Variational::<_, 2, TWO>::new(Double::new([1.0; 2], [1.0; 2], 1.0));
    let run = lyapunov(&system, 0.0, [2.0, 2.0], [0.0; 2]).transient(100.0);
    let spectrum = run.run(500.0).unwrap();
    conservative(&spectrum.exponents, &spectrum.standard_errors, spectrum.sum());
    let (time, last) = spectrum.running().last().unwrap();
    assert_eq!(time, 500.0);
    for (running, exponent) in last.iter().zip(&spectrum.exponents) {
        assert!((running - exponent).abs() < 1e-13);
    }
}

#[test]
fn errors_name_the_setting_or_the_time_and_keep_what_was_found() {
    let node = Variational::<_, 1, ONE>::new(Damped::new(2.0, 3.0));
    let start = || lyapunov(&node, 0.0, [1.0], [0.0]);
    let message = start().interval(0.0).run(1.0).unwrap_err().to_string();
    assert!(message.contains("interval") && message.contains("positive"), "{message}");
    assert!(start().transient(-1.0).run(10.0).is_err() && start().run(1.2).is_err());
    assert!(start().run(f64::NAN).is_err() && start().run(f64::INFINITY).is_err());
    // Directions that diverge by exp(40) are parallel in `f64`.
    let error = start().interval(40.0).run(400.0).unwrap_err();
    assert!(error.to_string().contains("shorten it"), "{error}");
    assert_eq!(error.partial, None);

    // From rest at 1, the fall takes π/√8 seconds.
    let falling = Variational::<_, 1, ONE>::new(Falling::new(1.0));
    let error = lyapunov(&falling, 0.0, [1.0], [0.0]).interval(0.25).run(10.0).unwrap_err();
    assert_eq!(error.t, 1.0);
    assert_eq!(error.partial.as_ref().map(|partial| partial.time), Some(1.0));
    assert!(error.to_string().starts_with("the Lyapunov spectrum ended at t = 1: "), "{error}");
}
