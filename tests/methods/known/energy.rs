//! Energy over long times.

use super::systems::{henon_heiles, pendulum};
use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::integrate::{FixedStep, Integrator, Leapfrog, Rk4, Srkn6b, Srkn14a};
use pendulum_runtime::system::{At, System, VelocityFree};

/// Returns the largest relative change of the energy over `steps` steps of length `h`, checked at
/// every tenth step.
fn drift<S, const N: usize>(
    system: &S,
    q: [f64; N],
    v: [f64; N],
    method: impl Method<S, N>,
    h: f64,
    steps: u64,
) -> f64
where
    S: VelocityFree<N> + System<N, Scalar = f64, Inputs = ()>,
{
    let start = system.energy(At::of(0.0, &q, &v));
    let mut integrator =
        Integrator::new(system, method, 0.0, q, v).unwrap().control(FixedStep::new(h)).unwrap();
    let mut largest = 0.0_f64;
    for step in 0..steps {
        integrator.step().unwrap();
        if step % 10 == 0 {
            let energy = system.energy(At::of(0.0, integrator.q(), integrator.v()));
            largest = largest.max(((energy - start) / start).abs());
        }
    }
    largest
}

#[test]
fn of_the_pendulum_stays_within_rounding() {
    // Without compensated sums, the drift is 1.6e-13.
    let drift = drift(&pendulum(), [1.3], [0.0], Srkn14a, 1.0 / 32.0, 320_000);
    assert!(drift < 2e-15, "{drift:e}");
}

#[test]
fn of_symplectic_methods_does_not_drift() {
    let leapfrog = |steps| drift(&pendulum(), [1.3], [0.0], Leapfrog, 0.1, steps);
    let splitting = |steps| drift(&henon_heiles(), [0.1, 0.0], [0.0, 0.5], Srkn6b, 0.25, steps);
    assert!(leapfrog(200_000) < 1.01 * leapfrog(2_000));
    assert!(splitting(200_000) < 1.3 * splitting(2_000));
    assert!(1e-3 < leapfrog(100) && leapfrog(100) < 1e-2);
}

#[test]
fn of_rk4_does() {
    let (short, long) = (
        drift(&pendulum(), [1.3], [0.0], Rk4, 0.1, 2_000),
        drift(&pendulum(), [1.3], [0.0], Rk4, 0.1, 20_000),
    );
    assert!(5.0 * short < long, "{short:e} {long:e}");
}

#[test]
fn reversed_symplectic_motion_returns() {
    let there = super::fixed(&pendulum(), 100.0, [1.3], [0.0], Srkn14a, 1000);
    let back = super::fixed(&pendulum(), 100.0, there.q, there.v.map(|v| -v), Srkn14a, 1000);
    assert!((back.q[0] - 1.3).abs() < 1e-13 && back.v[0].abs() < 1e-13);
}
