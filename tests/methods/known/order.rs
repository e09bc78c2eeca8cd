//! The measured order of convergence of each method.

use super::systems::{DoublePendulum, Pendulum, SHAKEN, double_pendulum, pendulum, shaken};
use super::{distance, fixed};
use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::integrate::{
    Dop853, Dprkn12, Leapfrog, Rk4, Srkn6b, Srkn14a, SymplecticEuler, solve,
};
use pendulum_runtime::system::Dynamics;

/// Asserts that the error is proportional to the power `order` of the step, within a sixth, for
/// `steps` and three times as many steps.
fn assert_order(name: &str, order: f64, error: impl Fn(u64) -> f64, steps: u64) {
    let (coarse, fine) = (error(steps), error(3 * steps));
    let measured = (coarse / fine).ln() / 3.0_f64.ln();
    assert!(
        (measured - order).abs() < order / 6.0 + 0.1,
        "{name}: order {measured:.2} from {coarse:e} to {fine:e}",
    );
}

/// The pendulum at t = 10, from 1.3 at rest.
const SIMPLE: [f64; 2] = [-1.166160381932957676242545, -0.50236501011242526821132624];

/// The double pendulum at t = 10, from (0.5, −0.25) at rest.
const DOUBLE: [f64; 4] = [
    -0.317126753679008418729029697644,
    0.502495051916668693314933016851,
    -0.152579088816347670822436955186,
    -0.159373774298781573884820651113,
];

fn simple<M: Method<Pendulum<f64>, 1>>(method: M, order: u32, steps: u64) {
    let error = |steps| {
        let end = fixed(&pendulum(), 10.0, [1.3], [0.0], method, steps);
        distance(&end.q, &end.v, &SIMPLE)
    };
    assert_order(M::NAME, f64::from(order), error, steps);
}

fn driven<D: Dynamics<1, Scalar = f64>, M: Method<D, 1>>(
    shaken: &D,
    method: M,
    order: u32,
    steps: u64,
) {
    let error = |steps| {
        let end = fixed(shaken, 10.0, [0.5], [0.0], method, steps);
        distance(&end.q, &end.v, &SHAKEN)
    };
    assert_order(M::NAME, f64::from(order), error, steps);
}

fn double<M: Method<DoublePendulum<f64>, 2>>(method: M, order: u32, steps: u64) {
    let error = |steps| {
        let end = fixed(&double_pendulum(), 10.0, [0.5, -0.25], [0.0; 2], method, steps);
        distance(&end.q, &end.v, &DOUBLE)
    };
    assert_order(M::NAME, f64::from(order), error, steps);
}

#[test]
fn on_the_pendulum() {
    simple(SymplecticEuler, 1, 1000);
    simple(Leapfrog, 2, 200);
    simple(Srkn6b, 4, 40);
    simple(Srkn14a, 6, 30);
    simple(Rk4, 4, 200);
    simple(Dop853, 8, 12);
    simple(Dprkn12, 12, 6);
}

#[test]
fn with_a_driven_pivot() {
    driven(&shaken(), SymplecticEuler, 1, 2000);
    driven(&shaken(), Leapfrog, 2, 400);
    driven(&shaken(), Srkn6b, 4, 100);
    driven(&shaken(), Srkn14a, 6, 40);
    driven(&shaken(), Rk4, 4, 400);
    driven(&shaken(), Dop853, 8, 30);
    driven(&shaken(), Dprkn12, 12, 7);
}

#[test]
fn with_velocities_in_the_accelerations() {
    double(SymplecticEuler, 1, 4000);
    double(Rk4, 4, 400);
    double(Dop853, 8, 30);
}

#[test]
fn of_dense_output() {
    fn measured<M: Method<Pendulum<f64>, 1>>(method: M, steps: u64) -> (f64, f64) {
        // The error of the interpolant only: the states at the ends of the coarse steps are exact
        // by construction.
        let exact = solve(&pendulum(), (0.0, 10.0), [1.3], [0.0])
            .method(Dop853)
            .rtol(1e-14)
            .atol(1e-14)
            .dense()
            .run()
            .unwrap();
        let (mut q, mut v) = (0.0_f64, 0.0_f64);
        for k in 0..steps {
            let (start, end) =
                (10.0 * k as f64 / steps as f64, 10.0 * (k + 1) as f64 / steps as f64);
            let from = exact.at(start).unwrap();
            let step = solve(&pendulum(), (start, end), from.q, from.v)
                .method(method)
                .steps(1)
                .dense()
                .run()
                .unwrap();
            for part in 1..8 {
                let t = start + (end - start) * f64::from(part) / 8.0;
                let (state, truth) = (step.at(t).unwrap(), exact.at(t).unwrap());
                q = q.max((state.q[0] - truth.q[0]).abs());
                v = v.max((state.v[0] - truth.v[0]).abs());
            }
        }
        (q, v)
    }
    fn assert_dense<M: Method<Pendulum<f64>, 1>>(
        method: M,
        steps: u64,
        expected: f64,
        velocity_order: f64,
    ) {
        let (coarse, fine) = (measured(method, steps), measured(method, 2 * steps));
        let (q, v) = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
        assert!(expected - 0.3 < q, "{}: order {q:.2} of the coordinates", M::NAME);
        assert!(velocity_order - 0.3 < v, "{}: order {v:.2} of the velocities", M::NAME);
    }
    // In one step a method of order p makes an error of order p + 1, which the dense output may
    // share.
    assert_dense(SymplecticEuler, 100, 1.0, 1.0);
    assert_dense(Leapfrog, 100, 2.0, 2.0);
    // The velocities are the derivative of a quintic that shares the error of the step.
    assert_dense(Rk4, 30, 4.0, 4.0);
    assert_dense(Srkn6b, 20, 4.0, 4.0);
    assert_dense(Srkn14a, 20, 5.0, 5.0);
    assert_dense(Dop853, 10, 7.0, 8.0);
    assert_dense(Dprkn12, 10, 9.0, 9.0);
}
