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

/// 1/(4k − 2) and 1/(4k + 6): ∫ P_k = (P_{k+1} − P_{k−1})/(4k + 2), so that the integral of the
/// series α_k has the coefficients h (α_{k−1}/(4k − 2) − α_{k+1}/(4k + 6)).
const INTEGRALS: [[f64; 2]; COUNT + 2] = {
    let (mut all, mut k) = ([[0.0; 2]; COUNT + 2], 1);
    while k < COUNT + 2 {
        all[k] = [1.0 / (4 * k - 2) as f64, 1.0 / (4 * k + 6) as f64];
        k += 1;
    }
    all
};

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
            blind: 1,
            earlier: zero,
            closing: false,
        },
        a: &workspace.a[workspace.last],
        between: workspace.between_known.then_some(&workspace.between[workspace.last]),
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
    // A row for each coefficient: the numbers of all coordinates lie side by side.
    let integrated = |series: &[[D::Scalar; N]; COUNT + 3], k: usize| {
        let [below, above] = INTEGRALS[k].map(number);
        let mut row = series[k - 1];
        for i in 0..N {
            row[i] = h * (row[i] * below - series[k + 1][i] * above);
        }
        row
    };
    let (mut a, mut v) = ([[zero; N]; COUNT + 3], [[zero; N]; COUNT + 3]);
    for k in 0..COUNT {
        for i in 0..N {
            a[k][i] = series[k / S][i].0[k % S];
        }
    }
    v[0] = from.v.high;
    for k in 1..=COUNT {
        v[k] = integrated(&a, k);
        interpolant.v[k - 1] = v[k];
    }
    // P_k(−1) is 1 for even k and −1 for odd ones.
    for k in 1..=COUNT / 2 {
        for i in 0..N {
            v[0][i] += v[2 * k - 1][i];
            v[0][i] -= v[2 * k][i];
        }
    }
    for k in 1..=COUNT + 1 {
        interpolant.q[k - 1] = integrated(&v, k);
    }
    // The remaining difference between the ends, which is less than the error of the step, is added
    // as a linear term: both ends are exact.
    for (terms, start, end) in [
        (&mut interpolant.q, &from.q.high, &to.q.high),
        (&mut interpolant.v, &from.v.high, &to.v.high),
    ] {
        let mut half = [zero; N];
        for k in 0..=COUNT / 2 {
            for i in 0..N {
                half[i] += terms[2 * k][i];
            }
        }
        for i in 0..N {
            terms[0][i] += (end[i] - start[i]) / number(2.0) - half[i];
        }
    }
    interpolant
}
