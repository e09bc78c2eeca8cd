//! Generated constraints against dual numbers and dense algebra.

use nalgebra::{DMatrix, DVector};
use pendulum_runtime::scalar::Dual;
use pendulum_runtime::system::{At, Jacobians, System};
use systems::constrained::{
    ANDREWS_START, Andrews, Arms, Ball, Bob, Disc, Garland, Loops2, Loops10, Sleigh, andrews,
    car_axis, four_bar,
};
use systems::random::Random;

/// Compares accelerations, multipliers, correction, power and Jacobians with a dense solution of
/// the equations with multipliers, whose rates are computed by dual numbers. Returns the largest
/// relative error.
fn worst<S, const N: usize>(system: &S, states: usize, seed: u64) -> f64
where
    S: System<N, Scalar = f64, Inputs = ()> + Jacobians<N>,
    S::Over<Dual<f64>>: System<N, Scalar = Dual<f64>, Inputs = ()>,
{
    let held = S::FACTS.held_constraints();
    assert!(0 < held);
    let lifted = system.over(Dual::constant);
    let mut random = Random::new(seed);
    let mut worst = 0.0f64;
    for _ in 0..states {
        let q: [f64; N] = core::array::from_fn(|_| random.uniform(-1.5, 1.5));
        let v: [f64; N] = core::array::from_fn(|_| random.uniform(-2.0, 2.0));
        let t = random.uniform(0.0, 1.0);
        // Rates along the motion at constant velocities.
        let dual = |t_rate: f64, q_rate: [f64; N], v_rate: [f64; N]| {
            let t = Dual { value: t, derivative: t_rate };
            let q = core::array::from_fn(|j| Dual { value: q[j], derivative: q_rate[j] });
            let v = core::array::from_fn(|j| Dual { value: v[j], derivative: v_rate[j] });
            lifted.misfits(At::of(t, &q, &v))
        };
        let at = At::of(t, &q, &v);
        let along = dual(1.0, v, [0.0; N]);
        let [values, rates] = system.misfits(at);
        let jacobian = system.constraint_jacobian(at);
        for k in 0..held {
            if S::FACTS.constraints[k].holonomic {
                // The rate of g is the derivative of g.
                assert!((along[0][k].derivative - rates[k]).abs() < 1e-12 * (1.0 + rates[k].abs()));
            } else {
                assert_eq!(values[k], 0.0);
            }
        }
        for j in 0..N {
            let mut unit = [0.0; N];
            unit[j] = 1.0;
            let by = dual(0.0, [0.0; N], unit)[1];
            for k in 0..held {
                assert!((by[k].derivative - jacobian[(k, j)]).abs() < 1e-12, "C[{k}][{j}]");
            }
        }
        let masses = system.mass_matrix(at);
        let forces = system.forces(at);
        let size = N + held;
        let mut matrix = DMatrix::zeros(size, size);
        let (mut right, mut targets) = (DVector::zeros(size), DVector::zeros(size));
        let target: [f64; N] = core::array::from_fn(|_| random.uniform(-1.0, 1.0));
        for j in 0..N {
            right[j] = forces[j];
            for i in 0..N {
                matrix[(i, j)] = masses[(i, j)];
            }
            for k in 0..held {
                matrix[(j, N + k)] = -jacobian[(k, j)];
                matrix[(N + k, j)] = -jacobian[(k, j)];
            }
        }
        for k in 0..held {
            right[N + k] = along[1][k].derivative;
            targets[N + k] = -target[k];
        }
        // The condition number limits the accuracy of the dense solution.
        let inverse = matrix.clone().try_inverse().expect("a regular matrix");
        let condition = (matrix.norm() * inverse.norm()).max(1.0);
        if 1e7 < condition {
            continue;
        }
        let lu = matrix.full_piv_lu();
        let solution = lu.solve(&right).unwrap();
        let correction = lu.solve(&targets).unwrap();
        let accelerations = system.accelerations(at);
        let reactions = system.reactions(at);
        let corrected = system.correction(at, &target);
        let scale = solution.amax().max(1.0);
        let change = correction.rows(0, N).amax().max(1e-3);
        let mut error = 0.0f64;
        for j in 0..N {
            error = error.max((accelerations[j] - solution[j]).abs() / scale);
            error = error.max((corrected[j] - correction[j]).abs() / change);
        }
        for k in 0..held {
            error = error.max((reactions[k] - solution[N + k]).abs() / scale);
        }
        for independence in system.independence(at) {
            assert!(0.0 < independence && independence <= 1.0 + 1e-12, "{independence}");
        }
        // dE/dt is the power minus the contribution of velocities that violate the constraints.
        let q_along = core::array::from_fn(|j| Dual { value: q[j], derivative: v[j] });
        let v_along = core::array::from_fn(|j| Dual { value: v[j], derivative: accelerations[j] });
        let moving = At::of(Dual { value: t, derivative: 1.0 }, &q_along, &v_along);
        let energy = lifted.energy(moving);
        let misfit: f64 = (0..held).map(|k| reactions[k] * rates[k]).sum();
        let power = system.power(at) + misfit;
        let size = energy.derivative.abs().max(energy.value.abs()).max(misfit.abs()).max(1.0);
        error = error.max((energy.derivative - power).abs() / size);
        // The derivatives of the momenta are their rates.
        let momenta = lifted.momenta(moving);
        let momentum_rates = system.momentum_rates(at);
        for j in 0..N {
            error = error.max((momenta[j].derivative - momentum_rates[j]).abs() / scale);
        }
        let by_q = system.position_jacobian(at);
        for j in 0..N {
            let moved = core::array::from_fn(|i| Dual {
                value: q[i],
                derivative: if i == j { 1.0 } else { 0.0 },
            });
            let by =
                lifted.accelerations(At::of(Dual::constant(t), &moved, &v.map(Dual::constant)));
            for i in 0..N {
                let own = by[i].derivative;
                error =
                    error.max((by_q[(i, j)] - own).abs() / own.abs().max(scale * condition.sqrt()));
            }
        }
        worst = worst.max(error / condition.sqrt());
    }
    worst
}

#[test]
fn equations_agree_with_dense_algebra() {
    let one = |name: &str, error: f64| {
        println!("{name}: {error:.1e}");
        assert!(error < 1e-12, "{name}: {error:e}");
    };
    one("bob", worst(&Bob::new(1.3, 0.7), 300, 1));
    one("four bars", worst(&four_bar(), 300, 2));
    one("car axis", worst(&car_axis(), 300, 3));
    one("sleigh", worst(&Sleigh::new(1.2, 0.4, 0.3), 300, 4));
    one("disc", worst(&Disc::new(1.2, 0.5, 0.1, 0.2), 300, 5));
    one("ball", worst(&Ball::new(1.2, 0.5, 0.1, 0.7), 300, 6));
    one("two loops", worst(&Loops2::new(1.2, 0.5), 300, 7));
    one("garland", worst(&Garland::new(1.2, 0.5, 2.0), 40, 9));
    one("arms", worst(&Arms::new(1.2, 0.5, 2.0, 7.0), 40, 10));
    one("ten loops", worst(&Loops10::new(1.2, 0.5), 20, 8));
}

/// Compares with the digits of Hairer and Wanner at the start, where all other accelerations and
/// multipliers are zero. Their multipliers have the other sign.
#[test]
fn andrews_starts_with_the_published_accelerations() {
    let (system, v) = (andrews(), [0.0; 7]);
    let a = system.accelerations(At::of(0.0, &ANDREWS_START, &v));
    let λ = system.reactions(At::of(0.0, &ANDREWS_START, &v));
    let expected = [14222.4439199541138705911625887, -10666.8329399655854029433719415];
    let multipliers = [-98.5668703962410896057654982170, 6.12268834425566265503114393122];
    for k in 0..7 {
        let wanted = expected.get(k).copied().unwrap_or(0.0);
        assert!((a[k] - wanted).abs() < 1e-9 * 14222.0, "{k}: {} {wanted}", a[k]);
        let wanted = multipliers.get(k).copied().unwrap_or(0.0);
        assert!((λ[k] - wanted).abs() < 1e-9 * 98.0, "λ {k}: {} {wanted}", λ[k]);
    }
    assert_eq!(Andrews::FACTS.constraints.len(), 6);
    assert_eq!(Andrews::FACTS.constraints[3].name, "second.y");
    assert_eq!(Andrews::FACTS.constraints[3].unit, "m");
    assert_eq!(Andrews::FACTS.constraints[3].reaction_unit, "kg·m/s²");
}
