//! A method written outside of the crate: the Runge–Kutta pair of Bogacki and Shampine, with its
//! error estimate and its interpolant, beside `Tsit5`.
//!
//! `cargo run --release --example own_method`

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::integrate::Event;
use pendulum_runtime::integrate::Solution;
use pendulum_runtime::integrate::method::{
    Adaptive, Endpoint, ErrorEstimate, Field, Interpolant, Method, Response, StepInterval, Weights,
};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{Float, Real};

lagrangian! {
    pub struct Pendulum { L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    let r = L*[sin(θ), -cos(θ)];
    kinetic = |ṙ|^2/2;
    potential = g*height(r);
}

/// The explicit Runge–Kutta pair of orders 3 and 2: three evaluations a step, adaptive.
///
/// Source: Bogacki and Shampine (1989), A 3(2) pair of Runge–Kutta formulas, Appl. Math. Lett. 2,
/// 321.
#[derive(Clone, Copy, Debug)]
pub struct BogackiShampine;

/// The slopes at the four stages: velocities and accelerations.
#[derive(Clone, Copy, Debug)]
pub struct Stages<T, const N: usize> {
    v: [[T; N]; 4],
    a: [[T; N]; 4],
}

impl<T: Real, const N: usize> Stages<T, N> {
    /// Σ weight · slope.
    fn weighted(&self, weights: &[f64; 4]) -> ([T; N], [T; N]) {
        let sum = |slopes: &[[T; N]; 4]| {
            core::array::from_fn(|i| {
                let terms = weights.iter().zip(slopes);
                terms.fold(T::from_f64(0.0), |sum, (&w, slope)| sum + T::from_f64(w) * slope[i])
            })
        };
        (sum(&self.v), sum(&self.a))
    }
}

const C: [f64; 3] = [0.0, 0.5, 0.75];
const B: [f64; 4] = [2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0, 0.0];
/// The difference of the weights of both orders.
const E: [f64; 4] = [-5.0 / 72.0, 1.0 / 12.0, 1.0 / 9.0, -1.0 / 8.0];

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Method<D, N> for BogackiShampine {
    const NAME: &'static str = "BogackiShampine";
    type Workspace = Stages<D::Scalar, N>;

    fn workspace(&self, _: &D) -> Self::Workspace {
        let zero = [[D::Scalar::from_f64(0.0); N]; 4];
        Stages { v: zero, a: zero }
    }

    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        stages: &mut Self::Workspace,
    ) -> Endpoint<D::Scalar, N> {
        let h = interval.length::<D::Scalar>();
        (stages.v[0], stages.a[0]) = (from.v.high, from.start_acceleration(field));
        for k in 1..3 {
            let part = D::Scalar::from_f64(C[k]) * h;
            let (v, a) = (stages.v[k - 1], stages.a[k - 1]);
            let q = core::array::from_fn(|i| from.q.high[i] + part * v[i]);
            stages.v[k] = core::array::from_fn(|i| from.v.high[i] + part * a[i]);
            let (t, side) = interval.at(C[k]);
            stages.a[k] = field.at(t, side, &q, &stages.v[k]);
        }
        let (dq, dv) = stages.weighted(&B);
        let mut to = from.advanced(interval, &dq, &dv);
        // The last stage is the first of the next step.
        (stages.v[3], stages.a[3]) = (to.v.high, to.end_acceleration(field));
        to
    }

    fn interpolant(
        &self,
        _: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        stages: &mut Self::Workspace,
    ) -> Interpolant<D::Scalar, N> {
        Interpolant::hermite(interval, from, to, &stages.a[0], &stages.a[3])
    }
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize> ErrorEstimate<D, N> for BogackiShampine {
    fn error(&self, stages: &Self::Workspace, h: f64, weights: &Weights<N>) -> f64 {
        let (q, v) = stages.weighted(&E);
        h * (weights.square_sum(&q, &v) / (2 * N) as f64).sqrt()
    }
}

impl Adaptive for BogackiShampine {
    const ORDER: u32 = 3;
    const RESPONSE: Response =
        Response { alpha: 1.0 / 3.0, beta: 0.0, safety: 0.8, least: 0.2, greatest: 5.0 };
    const GAP: f64 = 0.5;
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let pendulum = Pendulum::new(0.5);
    let run = || solve(&pendulum, (0.0, 10.0), [1.3], [0.0]);
    let exact = run().rtol(1e-13).dense().run()?;
    println!("A pendulum over 10 s from 1.3 rad; largest errors at 1000 times, rad\n");
    println!("   rtol   BogackiShampine  steps    Tsit5     steps");
    for rtol in [1e-3, 1e-5, 1e-7, 1e-9] {
        let own = run().method(BogackiShampine).rtol(rtol).dense().run()?;
        let other = run().method(Tsit5).rtol(rtol).dense().run()?;
        let error = |solution: &Solution<f64, 1>| {
            (0..=1000).map(|k| f64::from(k) / 100.0).fold(0.0_f64, |largest, t| {
                match (solution.at(t), exact.at(t)) {
                    (Some(state), Some(truth)) => largest.max((state.q[0] - truth.q[0]).abs()),
                    _ => f64::NAN,
                }
            })
        };
        let steps = |solution: &Solution<f64, 1>| solution.stats.accepted;
        println!(
            "{rtol:7.0e}   {:13.1e}  {:6}   {:9.1e} {:6}",
            error(&own),
            steps(&own),
            error(&other),
            steps(&other)
        );
    }
    let equal = run().method(BogackiShampine).step(0.001).run()?;
    let difference = (equal.end.q[0] - exact.end.q[0]).abs();
    println!("\nSteps of 1 ms: {difference:.1e} rad at the end.");

    // Events are found on the interpolant.
    let hanging = Event::new(|_, θ, _| θ[0]);
    let swing = run().method(BogackiShampine).rtol(1e-8).events([hanging]).run()?;
    let times: Vec<f64> = swing.events.iter().map(|event| event.time.to_f64()).collect();
    println!("{} times through θ = 0; the period is {:.6} s.", times.len(), times[2] - times[0]);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{BogackiShampine, Pendulum};
    use pendulum_runtime::error::{Error, Suspect};
    use pendulum_runtime::prelude::*;

    /// A pendulum's angle after 2 s, from steps of `h` and at a relative tolerance.
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
}
