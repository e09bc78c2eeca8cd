//! Damped modes against closed forms.

use pendulum_runtime::analysis::{DampedMode, Linearization, ModeError, linearize};
use pendulum_runtime::nalgebra::Complex;

mod blocks {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        pub struct Damped { m, c, k }
        coordinate x;
        kinetic = m/2*ẋ^2;
        potential = k/2*x^2;
        dissipation = c/2*ẋ^2;
    }

    lagrangian! {
        /// Masses between walls; the damping is α M + β K.
        pub struct Line { m, k, α, β }
        coordinate x[3];
        kinetic = sum(i in 0..3, m/2*ẋ[i]^2);
        potential = k/2*(x[0]^2 + (x[1] - x[0])^2 + (x[2] - x[1])^2 + x[2]^2);
        dissipation = α*sum(i in 0..3, m/2*ẋ[i]^2)
            + β*k/2*(ẋ[0]^2 + (ẋ[1] - ẋ[0])^2 + (ẋ[2] - ẋ[1])^2 + ẋ[2]^2);
    }

    lagrangian! {
        /// An isotropic oscillator, seen from a frame that turns.
        pub struct Turning { ω, Ω }
        coordinate x;
        coordinate y;
        kinetic = ((ẋ - Ω*y)^2 + (ẏ + Ω*x)^2)/2;
        potential = ω^2*(x^2 + y^2)/2;
    }

    lagrangian! {
        /// An oscillator with a force across its displacement, as of a shaft in a fluid.
        pub struct Shaft { ω, a }
        coordinate x;
        coordinate y;
        kinetic = (ẋ^2 + ẏ^2)/2;
        potential = ω^2*(x^2 + y^2)/2;
        force x = -a*y;
        force y = a*x;
    }

    lagrangian! {
        /// Links of unequal mass with a damper at one joint.
        pub struct Links { m: [1; 3], c, g }
        coordinate θ[3];
        let y[k in 0..3] = sum(j in 0..=k, [sin(θ[j]), -cos(θ[j])]);
        kinetic = sum(k in 0..3, m[k]/2*|ẏ[k]|^2);
        potential = sum(k in 0..3, g*m[k]*height(y[k]));
        dissipation = c/2*(θ̇[1] - θ̇[0])^2;
    }

    lagrangian! {
        pub struct Cart { M, m, L, g }
        coordinate s;
        coordinate θ;
        let tip = [s, 0] + L*[sin(θ), cos(θ)];
        kinetic = M/2*ṡ^2 + m/2*|dot(tip)|^2;
        potential = m*g*height(tip);
    }
}

use blocks::*;

fn close(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within, "{found} instead of {expected}");
}

/// Returns (λ² M + λ C + K) φ relative to the size of its terms.
fn residual<const N: usize>(system: &Linearization<N>, mode: &DampedMode<N>) -> f64 {
    let (λ, φ) = (mode.eigenvalue, mode.shape);
    let complex = |matrix: pendulum_runtime::nalgebra::SMatrix<f64, N, N>| {
        matrix.map(|entry| Complex::new(entry, 0.0)) * φ
    };
    let terms =
        [complex(system.mass) * λ * λ, complex(system.damping) * λ, complex(system.stiffness)];
    let size: f64 = terms[0].norm() + terms[1].norm() + terms[2].norm();
    (terms[0] + terms[1] + terms[2]).norm() / size
}

#[test]
fn one_damped_mass_has_its_closed_form() {
    let modes =
        |c: f64| linearize(&Damped::new(2.0, c, 8.0), 0.0, &[0.0], &[0.0]).damped_modes().unwrap();
    let weak = modes(1.0);
    assert_eq!(weak.len(), 1);
    close(weak[0].eigenvalue.re, -0.25, 1e-15);
    close(weak[0].damped_frequency(), (4.0_f64 - 1.0 / 16.0).sqrt(), 1e-15);
    close(weak[0].frequency(), 2.0, 1e-15);
    close(weak[0].damping_ratio(), 0.125, 1e-15);
    close(weak[0].shape[0].re, 1.0 / 2.0_f64.sqrt(), 1e-15);
    assert_eq!(weak[0].to_string(), "2.0000 rad/s, damping ratio 0.1250, λ = -0.2500 ± 1.9843i");

    // 2 λ² + 20 λ + 8 = 0.
    let strong = modes(20.0);
    assert_eq!(strong.len(), 2);
    for (mode, sign) in strong.iter().zip([1.0, -1.0]) {
        close(mode.eigenvalue.re, -5.0 + sign * 21.0_f64.sqrt(), 1e-14);
        assert_eq!((mode.eigenvalue.im, mode.damping_ratio()), (0.0, 1.0));
    }
    assert_eq!(strong[0].to_string(), "0.4174 rad/s, damping ratio 1.0000, λ = -0.4174");

    for mode in modes(8.0) {
        close(mode.eigenvalue.re, -2.0, 1e-7);
    }
    for mode in modes(0.0) {
        close(mode.damping_ratio(), 0.0, 1e-16);
    }
    assert!(modes(-1.0)[0].is_unstable());
}

#[test]
fn proportional_damping_keeps_shapes_and_gives_the_ratios() {
    // ω_j = 2 √(k/m) sin(jπ/8), ζ = α/(2 ω) + β ω/2 (Rayleigh).
    let (m, k, α, β) = (0.3, 20.0, 0.7, 0.004);
    let small = linearize(&Line::new(m, k, α, β), 0.0, &[0.0; 3], &[0.0; 3]);
    let (modes, normal) = (small.damped_modes().unwrap(), small.normal_modes().unwrap());
    assert_eq!(modes.len(), 3);
    for (j, mode) in modes.iter().enumerate() {
        let ω = 2.0 * (k / m).sqrt() * ((j + 1) as f64 * std::f64::consts::PI / 8.0).sin();
        close(mode.frequency(), ω, 1e-13 * ω);
        close(mode.damping_ratio(), α / (2.0 * ω) + β * ω / 2.0, 1e-14);
        for i in 0..3 {
            close(mode.shape[i].im, 0.0, 1e-13);
            close(mode.shape[i].re.abs(), normal.shapes[(i, j)].abs(), 1e-13);
        }
    }
}

/// z = x + i y: z̈ = (i a − ω²) z.
#[test]
fn forces_without_a_potential_leave_no_normal_modes() {
    let (ω, a) = (3.0, 0.4);
    let small = linearize(&Shaft::new(ω, a), 0.0, &[0.0; 2], &[0.0; 2]);
    assert_eq!(small.normal_modes(), Err(ModeError::Circulatory));
    let modes = small.damped_modes().unwrap();
    assert_eq!(modes.len(), 2);
    for mode in &modes {
        let square = mode.eigenvalue * mode.eigenvalue;
        close(square.re, -ω * ω, 1e-12);
        close(square.im.abs(), a, 1e-12);
    }
    assert_eq!(modes.iter().filter(|mode| mode.is_unstable()).count(), 1);
    let still = linearize(&Shaft::new(ω, 0.0), 0.0, &[0.0; 2], &[0.0; 2]);
    close(still.normal_modes().unwrap().squared_frequencies[0], 9.0, 1e-14);
}

#[test]
fn a_turning_frame_splits_the_frequencies() {
    let small = linearize(&Turning::new(3.0, 0.4), 0.0, &[0.0; 2], &[0.0; 2]);
    let modes = small.damped_modes().unwrap();
    assert_eq!(modes.len(), 2);
    // ω² of both without the forces of Coriolis, 8.84, is the frequency of nothing.
    assert_eq!(small.normal_modes(), Err(ModeError::Gyroscopic));
    let still = linearize(&Turning::new(3.0, 0.0), 0.0, &[0.0; 2], &[0.0; 2]);
    close(still.normal_modes().unwrap().squared_frequencies[1], 9.0, 1e-14);
    for (mode, expected) in modes.iter().zip([2.6, 3.4]) {
        close(mode.frequency(), expected, 1e-14);
        close(mode.damping_ratio(), 0.0, 1e-15);
        // The motions are circles: the components differ by a quarter turn.
        let ratio = mode.shape[1] / mode.shape[0];
        close(ratio.re, 0.0, 1e-13);
        close(ratio.im.abs(), 1.0, 1e-13);
    }
    close(
        (modes[0].shape[1] / modes[0].shape[0]).im,
        -(modes[1].shape[1] / modes[1].shape[0]).im,
        1e-12,
    );
}

#[test]
fn equal_frequencies_have_independent_shapes() {
    let small = linearize(&Turning::new(3.0, 0.0), 0.0, &[0.0; 2], &[0.0; 2]);
    let modes = small.damped_modes().unwrap();
    let [a, b] = [modes[0].shape, modes[1].shape];
    close((a[0] * b[1] - a[1] * b[0]).norm(), 1.0, 1e-12);
}

#[test]
fn general_damping_solves_the_quadratic_eigenproblem() {
    let small = linearize(&Links::new([1.0, 0.2, 3.0], 2.0, 9.81), 0.0, &[0.0; 3], &[0.0; 3]);
    let modes = small.damped_modes().unwrap();
    let mut trace = 0.0;
    for mode in &modes {
        assert!(residual(&small, mode) < 1e-14, "{}", residual(&small, mode));
        assert!(!mode.is_unstable() && 0.0 < mode.damping_ratio());
        trace += if mode.eigenvalue.im == 0.0 { 1.0 } else { 2.0 } * mode.eigenvalue.re;
        let norm: f64 = (0..3)
            .map(|i| {
                let row: Complex<f64> = (0..3).map(|j| mode.shape[j] * small.mass[(i, j)]).sum();
                (mode.shape[i].conj() * row).re
            })
            .sum();
        close(norm, 1.0, 1e-13);
    }
    // Σ λ = −tr M⁻¹C.
    let damping = small.mass.try_inverse().unwrap() * small.damping;
    close(trace, -damping.trace(), 1e-12 * damping.trace());
}

#[test]
fn an_upright_pole_on_a_cart_falls_at_its_rate() {
    let small = linearize(&Cart::new(2.0, 0.3, 0.5, 9.81), 0.0, &[0.0; 2], &[0.0; 2]);
    let modes = small.damped_modes().unwrap();
    // The eigenvalues are two zeros of the free cart, and ±√((1 + m/M) g/L).
    let rate = (1.15_f64 * 9.81 / 0.5).sqrt();
    assert_eq!(modes.len(), 4);
    close(modes[0].frequency(), 0.0, 1e-7);
    close(modes[1].frequency(), 0.0, 1e-7);
    let mut rates = [modes[2].eigenvalue.re, modes[3].eigenvalue.re];
    rates.sort_by(f64::total_cmp);
    close(rates[0], -rate, 1e-13);
    close(rates[1], rate, 1e-13);
}

#[test]
fn what_is_not_finite_or_has_no_inertia_is_refused() {
    let small = linearize(&Damped::new(1.0, f64::NAN, 1.0), 0.0, &[0.0], &[0.0]);
    assert!(small.damped_modes().unwrap_err().to_string().contains("not finite"));
    let small = linearize(&Damped::new(-1.0, 1.0, 1.0), 0.0, &[0.0], &[0.0]);
    assert!(small.damped_modes().unwrap_err().to_string().contains("positive definite"));
}
