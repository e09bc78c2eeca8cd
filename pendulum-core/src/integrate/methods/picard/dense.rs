//! Dense output: the motion between the ends of a step.

use super::kernel::{Equations, FIXED, Within};
use super::lanes::LaneDynamics;
use super::tableau::S;
use super::workspace::WorkspaceOf;
use crate::integrate::field::Field;
use crate::integrate::interpolant::{Basis, Interpolant, TERMS};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::{Octet, Real};
use crate::simd;

/// The number of coefficients of the accelerations.
const COUNT: usize = 2 * S;

/// Returns the collocation polynomial at sixteen nodes. The one at eight nodes has order 16 at the
/// ends, but only order 9 between them.
pub(super) fn interpolant<D: LaneDynamics<N>, const N: usize>(
    field: &mut Field<'_, D, N>,
    interval: &StepInterval,
    from: &Endpoint<D::Scalar, N>,
    to: &Endpoint<D::Scalar, N>,
    workspace: &mut WorkspaceOf<D, N>,
) -> Interpolant<D::Scalar, N> {
    let (number, h) = (D::Scalar::from_f64, interval.length::<D::Scalar>());
    let zero = number(0.0);
    let (mut series, mut count) = ([[Octet::splat(zero); N]; 2], 0);
    simd::wide(Within {
        equations: Equations {
            dynamics: field.dynamics,
            prepared: &workspace.prepared,
            interval,
            from,
            weights: &workspace.weights,
            least: 2,
            most: FIXED,
            guessed: true,
            closing: false,
        },
        a: &workspace.a[workspace.last],
        series: &mut series,
        scaled: &mut workspace.within,
        count: &mut count,
    });
    field.evaluations += u64::from(count) * S as u64;
    let mut interpolant = Interpolant {
        basis: Basis::Legendre,
        terms: COUNT + 1,
        q: [[zero; N]; TERMS],
        v: [[zero; N]; TERMS],
        ..Interpolant::linear(interval, from, to)
    };
    // ∫ P_k = (P_{k+1} − P_{k−1})/(4k + 2), so that the integral of the series α_k has the
    // coefficients h (α_{k−1}/(4k − 2) − α_{k+1}/(4k + 6)).
    let integrated = |series: &[D::Scalar; COUNT + 3], k: usize| {
        h * (series[k - 1] / number((4 * k - 2) as f64)
            - series[k + 1] / number((4 * k + 6) as f64))
    };
    for i in 0..N {
        let (mut a, mut v) = ([zero; COUNT + 3], [zero; COUNT + 3]);
        for k in 0..COUNT {
            a[k] = series[k / S][i].0[k % S];
        }
        v[0] = from.v.high[i];
        for k in 1..=COUNT {
            v[k] = integrated(&a, k);
            interpolant.v[k - 1][i] = v[k];
        }
        // P_k(−1) is 1 for even k and −1 for odd ones.
        for k in 1..=COUNT / 2 {
            v[0] += v[2 * k - 1];
            v[0] -= v[2 * k];
        }
        for k in 1..=COUNT + 1 {
            interpolant.q[k - 1][i] = integrated(&v, k);
        }
        // The remaining difference between the ends, which is less than the error of the step, is
        // added as a linear term: both ends are exact.
        for (terms, [start, end]) in [
            (&mut interpolant.q, [from.q.high[i], to.q.high[i]]),
            (&mut interpolant.v, [from.v.high[i], to.v.high[i]]),
        ] {
            let mut half = zero;
            for k in 0..=COUNT / 2 {
                half += terms[2 * k][i];
            }
            terms[0][i] += (end - start) / number(2.0) - half;
        }
    }
    interpolant
}
