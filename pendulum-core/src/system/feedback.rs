//! The contribution of a feedback law to the Jacobians of the accelerations.

use crate::scalar::{Float, Real};
use crate::system::at::At;
use crate::system::dynamics::{Dynamics, MOST_CONTROLS};
use crate::system::equations::{Jacobians, System};
use crate::time::Time;
use nalgebra::SMatrix;

/// Computes the contribution of a feedback law u(t, q, q̇) to the Jacobians of the accelerations:
/// ∂q̈/∂u ∂u/∂q and ∂q̈/∂u ∂u/∂q̇. `t` is the time of `at` with both words.
///
/// The factor ∂q̈/∂u is exact. Only the values of the law are available, so its derivatives are
/// central differences with steps of about ∛ε and relative errors of about ε^(2/3), where ε is that
/// of `f32` or `f64`.
pub(crate) fn feedback_jacobians<D, const N: usize>(
    dynamics: &D,
    t: Time,
    at: At<'_, D::Scalar, <D::System as System<N>>::Inputs, N>,
) -> [SMatrix<D::Scalar, N, N>; 2]
where
    D: Dynamics<N, Scalar: Float, System: Jacobians<N>>,
{
    let number = D::Scalar::from_f64;
    let mut by_control = [[number(0.0); N]; MOST_CONTROLS];
    dynamics.system().control_jacobian(at, &mut by_control);
    let column =
        |a: &[D::Scalar; MOST_CONTROLS], b: &[D::Scalar; MOST_CONTROLS], over: D::Scalar| {
            let mut column = [number(0.0); N];
            for (by_control, (a, b)) in by_control.iter().zip(a.iter().zip(b)) {
                let slope = (*a - *b) / over;
                for i in 0..N {
                    column[i] += by_control[i] * slope;
                }
            }
            column
        };
    // ∛ε of `f32` or `f64`, rounded to a power of two; wider scalars use that of `f64`.
    let epsilon = if D::Scalar::EPSILON.to_f64() < 1e-10 {
        number(2f64.powi(-17))
    } else {
        number(2f64.powi(-8))
    };
    let step = |x: D::Scalar| epsilon * x.abs().max(number(1.0));
    let At { q, v, .. } = at;
    let mut jacobians = [SMatrix::<D::Scalar, N, N>::from_element(number(0.0)); 2];
    for j in 0..N {
        let h = step(q[j]);
        let (mut ahead, mut behind) = (*q, *q);
        (ahead[j], behind[j]) = (q[j] + h, q[j] - h);
        let (a, b) = (dynamics.controls(t, &ahead, v), dynamics.controls(t, &behind, v));
        let by_q = column(&a, &b, ahead[j] - behind[j]);
        let h = step(v[j]);
        let (mut ahead, mut behind) = (*v, *v);
        (ahead[j], behind[j]) = (v[j] + h, v[j] - h);
        let (a, b) = (dynamics.controls(t, q, &ahead), dynamics.controls(t, q, &behind));
        let by_v = column(&a, &b, ahead[j] - behind[j]);
        for i in 0..N {
            (jacobians[0][(i, j)], jacobians[1][(i, j)]) = (by_q[i], by_v[i]);
        }
    }
    jacobians
}
