//! The Nyström pair of Dormand, El-Mikkawy and Prince of order 12.

mod tableau;

use crate::integrate::field::Field;
use crate::integrate::interpolant::{Interpolant, hermite};
use crate::integrate::method::{Adaptive, ErrorEstimate, Method, Response, Weights};
use crate::integrate::schemes::runge_kutta::{Row, weighted};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::gap::widest;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, VelocityFree};
use tableau::{
    A1, A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, A12, A13, A14, A15, A16, C, DQ, DV, EQ, EV, Q, V,
};

/// The Runge–Kutta–Nyström pair of orders 12 and 10 of Dormand, El-Mikkawy and Prince: seventeen
/// evaluations per step, adaptive.
///
/// The method is the choice for equations written by hand. For the same error it takes 0.3 to 0.75
/// of the time of [`Dop853`](crate::integrate::Dop853), and the fraction falls with the error. On a
/// Kepler orbit of eccentricity 0.5, for errors above 1e-5, it takes 0.75 to 1 of that time. On
/// such an orbit it is also faster than [`Taylor`](crate::integrate::Taylor), with three quarters
/// of the time of `Taylor` at 1e-10. For pendulums on a driven pivot `Taylor` takes two thirds to
/// four fifths of the time of `Dprkn12`, for undriven pendulums about half. `Dprkn12` is not
/// symplectic: over very many periods the energy drifts, at tight tolerances by rounding only.
///
/// The method requires a constant mass matrix and accelerations without velocities, and does not
/// compile for other systems. Dense output uses the accelerations of the step and takes no further
/// evaluations. Its error falls with the tenth power of the step in the coordinates and the ninth
/// in the velocities, slower than that of the steps: if the state at a few times has to be as
/// accurate as the steps, end steps there by `t_stops`.
///
/// Source: Dormand, El-Mikkawy and Prince (1987), High-order embedded Runge–Kutta–Nyström formulae,
/// IMA J. Numer. Anal. 7, 423.
///
/// ```compile_fail,E0277
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).method(Dprkn12).rtol(1e-9).run()?.end.q[0])
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dprkn12;

impl<D: Dynamics<N, Scalar: Float, System: VelocityFree<N>>, const N: usize> Method<D, N>
    for Dprkn12
{
    const NAME: &'static str = "Dprkn12";
    /// The accelerations at the stages of a step, and at its end.
    type Workspace = [[D::Scalar; N]; 18];

    fn workspace(&self, _: &D) -> Self::Workspace {
        [[D::Scalar::from_f64(0.0); N]; 18]
    }

    #[inline]
    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        a: &mut Self::Workspace,
    ) -> Endpoint<D::Scalar, N> {
        a[0] = from.start_acceleration(field);
        stage(a, field, interval, from, 1, A1);
        stage(a, field, interval, from, 2, A2);
        stage(a, field, interval, from, 3, A3);
        stage(a, field, interval, from, 4, A4);
        stage(a, field, interval, from, 5, A5);
        stage(a, field, interval, from, 6, A6);
        stage(a, field, interval, from, 7, A7);
        stage(a, field, interval, from, 8, A8);
        stage(a, field, interval, from, 9, A9);
        stage(a, field, interval, from, 10, A10);
        stage(a, field, interval, from, 11, A11);
        stage(a, field, interval, from, 12, A12);
        stage(a, field, interval, from, 13, A13);
        stage(a, field, interval, from, 14, A14);
        stage(a, field, interval, from, 15, A15);
        stage(a, field, interval, from, 16, A16);
        let h = interval.length::<D::Scalar>();
        let sum = weighted(a, Q);
        let mut to = Endpoint { t: interval.end, a: None, ..*from };
        for i in 0..N {
            // The drift is by far the largest part, so that its product has both words.
            to.q.add_product(i, h, from.v.high[i], h * (from.v.low[i] + h * sum[i]));
        }
        to.v.add(h, &weighted(a, V));
        to
    }

    /// Beyond the quintic, the coordinates have the terms h² Σ weight · acceleration from the sixth
    /// term on, and the velocities have the terms h Σ weight · acceleration from the fourth on.
    fn interpolant(
        &self,
        field: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        a: &mut Self::Workspace,
    ) -> Interpolant<D::Scalar, N> {
        a[17] = to.end_acceleration(field);
        let h = interval.length::<D::Scalar>();
        let mut interpolant = hermite::quintic(interval, from, to, &a[0], &a[17]);
        for (term, row) in DQ.into_iter().enumerate() {
            interpolant.q[5 + term] = weighted(a, row).map(|sum| h * h * sum);
        }
        for (term, row) in DV.into_iter().enumerate() {
            interpolant.v[3 + term] = weighted(a, row).map(|sum| h * sum);
        }
        interpolant.terms = 5 + DQ.len();
        interpolant
    }
}

/// Computes stage `index` at `start + c h`, with the coordinates q + c h q̇ + h² Σ weight ·
/// acceleration.
// A row is a constant. After inlining, its indices and weights are constants too.
#[allow(clippy::inline_always)]
#[inline(always)]
fn stage<T: Float, const N: usize, const K: usize, const W: bool>(
    a: &mut [[T; N]; 18],
    field: &mut Field<'_, impl Dynamics<N, Scalar = T>, N, W>,
    interval: &StepInterval,
    from: &Endpoint<T, N>,
    index: usize,
    row: Row<K>,
) {
    let h = interval.length::<T>();
    let (drift, kick) = (T::from_f64(C[index]) * h, h * h);
    let sum = weighted(a, row);
    let q = core::array::from_fn(|i| (from.q.high[i] + drift * from.v.high[i]) + kick * sum[i]);
    let (t, side) = interval.at(C[index]);
    // The accelerations of velocity-free systems do not depend on the velocities.
    a[index] = field.at(t, side, &q, &from.v.high);
}

impl<D: Dynamics<N, Scalar: Float, System: VelocityFree<N>>, const N: usize> ErrorEstimate<D, N>
    for Dprkn12
{
    /// The root mean square of the error, from the differences of the weights of both orders.
    #[inline]
    fn error(&self, a: &Self::Workspace, h: f64, weights: &Weights<N>) -> f64 {
        let q = weighted(a, EQ).map(|difference| D::Scalar::from_f64(h) * difference);
        h * (weights.square_sum(&q, &weighted(a, EV)) / (2 * N) as f64).sqrt()
    }
}

impl Adaptive for Dprkn12 {
    const ORDER: u32 = 12;
    const RESPONSE: Response =
        Response { alpha: 0.08, beta: 0.015, safety: 0.8, least: 0.2, greatest: 6.0 };
    const GAP: f64 = widest(&C, &EV);
}
