//! The method and its implementation of the traits `Method`, `ErrorEstimate` and `Adaptive`.

use crate::tableau::{B, C, E, Stages};
use pendulum_runtime::integrate::method::{
    Adaptive, Endpoint, ErrorEstimate, Field, Interpolant, Method, Response, StepInterval, Weights,
};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Float;

/// The explicit Runge–Kutta pair of orders 3 and 2: three evaluations a step, adaptive.
///
/// Source: Bogacki and Shampine (1989), A 3(2) pair of Runge–Kutta formulas, Appl. Math. Lett. 2,
/// 321.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BogackiShampine;

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
        // The last stage of a step is the first stage of the next step.
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
