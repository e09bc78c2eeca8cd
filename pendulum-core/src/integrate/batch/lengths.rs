//! The lengths of steps, computed from the series in all lanes at once.

// The functions of a step are inlined into code that is compiled for several instruction sets.
#![allow(clippy::inline_always)]

use super::flight::{Flight, Wide};
use super::problem::W;
use crate::integrate::methods::taylor::{LAST_ORDERS, Rule};
use crate::integrate::step::adaptive::resolution_of;
use crate::integrate::step::fast_exp2::power;
use crate::jet::Path;
use crate::scalar::{Float, Real};
use crate::time::Time;

/// Returns the reciprocals of the errors allowed.
#[inline(always)]
pub(super) fn weights<T: Float, const N: usize>(
    from: &Flight<T, N>,
    rtol: f64,
    atol: &[[f64; N]; 2],
) -> [[Wide<f64>; N]; 2] {
    let mut weights = [[Wide::from_f64(0.0); N]; 2];
    for (part, state) in [&from.q.high, &from.v.high].into_iter().enumerate() {
        for i in 0..N {
            for l in 0..W {
                weights[part][i].0[l] = 1.0 / (atol[part][i] + rtol * state[i].0[l].to_f64().abs());
            }
        }
    }
    weights
}

/// The length above which the last terms do not determine the length of a step.
pub(super) const UNTOLD: f64 = 1e300;

/// Returns 1023 plus the binary logarithms of the lengths of steps that the last terms of the
/// series allow.
#[inline(always)]
pub(super) fn log_radii<T: Float, const N: usize>(
    path: &Path<Wide<T>, N>,
    rule: &Rule,
    weights: &[[Wide<f64>; N]; 2],
) -> Wide<f64> {
    let mut least = Wide::from_f64(f64::INFINITY);
    for back in 0..LAST_ORDERS {
        least = nearest(
            least,
            log_radius_of(path, rule, weights, rule.order.saturating_sub(back).max(1)),
        );
    }
    least
}

/// Returns the lengths of steps at whose ends the last terms of the series are as large as allowed,
/// as in [`Taylor`].
#[inline(always)]
pub(super) fn lengths(log_radii: Wide<f64>) -> Wide<f64> {
    let mut wanted = log_radii;
    for l in 0..W {
        wanted.0[l] = power(log_radii.0[l]);
    }
    wanted
}

/// Returns these lengths if some of the last terms may be zero; the lanes concerned use earlier
/// terms.
pub(super) fn longer<T: Float, const N: usize>(
    path: &Path<Wide<T>, N>,
    rule: &Rule,
    weights: &[[Wide<f64>; N]; 2],
    mut log_radii: Wide<f64>,
) -> Wide<f64> {
    let mut open = log_radii.0.map(|log_radii| log_radii == f64::INFINITY);
    if !open.contains(&true) {
        return lengths(log_radii);
    }
    for k in (1..=rule.order.saturating_sub(LAST_ORDERS)).rev() {
        let earlier = log_radius_of(path, rule, weights, k);
        for l in 0..W {
            if open[l] && earlier.0[l] < f64::INFINITY {
                (log_radii.0[l], open[l]) = (earlier.0[l], false);
            }
        }
    }
    let mut wanted = lengths(log_radii);
    for l in 0..W {
        wanted.0[l] = if open[l] { f64::INFINITY } else { wanted.0[l] };
    }
    wanted
}

/// Returns 1023 plus the binary logarithms of the lengths that the coefficients of order `k` allow;
/// infinite if all coefficients are zero.
#[inline(always)]
pub(super) fn log_radius_of<T: Float, const N: usize>(
    path: &Path<Wide<T>, N>,
    rule: &Rule,
    weights: &[[Wide<f64>; N]; 2],
    k: usize,
) -> Wide<f64> {
    let mut log_radii = Wide::<f64>::from_f64(0.0);
    for i in 0..N {
        for (series, weights) in [(&path.q[i], &weights[0]), (&path.v[i], &weights[1])] {
            for l in 0..W {
                let coefficient = series[k].0[l].to_f64().abs() * weights[i].0[l];
                log_radii.0[l] =
                    if log_radii.0[l] < coefficient { coefficient } else { log_radii.0[l] };
            }
        }
    }
    for l in 0..W {
        log_radii.0[l] = rule.log_radius(log_radii.0[l], k);
    }
    log_radii
}

/// Returns the lesser number of each lane.
#[inline(always)]
pub(super) fn nearest(a: Wide<f64>, b: Wide<f64>) -> Wide<f64> {
    let mut least = a;
    for l in 0..W {
        least.0[l] = if b.0[l] < a.0[l] { b.0[l] } else { a.0[l] };
    }
    least
}

/// Returns steps of these lengths, or steps that leave no sliver before the end, as for a single
/// motion; zero in idle lanes. Marks steps that would reach the end or are too short in `unusual`.
#[inline(always)]
pub(super) fn fit<T: Float, const N: usize>(
    from: &Flight<T, N>,
    wanted: Wide<f64>,
    unusual: &mut Wide<f64>,
) -> Wide<f64> {
    let mut h = wanted;
    for l in 0..W {
        let (t, wanted) = (Time::from_words(from.high.0[l], from.low.0[l]), wanted.0[l]);
        let left = -t.since(from.end.0[l]);
        let step = if left.abs() < 2.0 * wanted { 0.5 * left } else { wanted.copysign(left) };
        h.0[l] = if 0.0 < from.live.0[l] { step } else { 0.0 };
        unusual.0[l] =
            if reaches(t, from.end.0[l], wanted) { from.live.0[l] } else { unusual.0[l] };
        unusual.0[l] =
            if is_short::<T>(t, from.end.0[l], wanted) { from.live.0[l] } else { unusual.0[l] };
    }
    h
}

/// Returns `true` if a step of this length would reach the end.
#[inline(always)]
pub(super) fn reaches(t: Time, end: f64, wanted: f64) -> bool {
    t.since(end).abs() <= 1.01 * wanted
}

/// Returns `true` if a step of this length would be too short, and not reach the end.
#[inline(always)]
pub(super) fn is_short<T: Float>(t: Time, end: f64, wanted: f64) -> bool {
    (wanted <= resolution_of::<T>(t)) & (wanted < t.since(end).abs())
}

/// Returns `true` if the number of at least one lane is not zero.
#[inline(always)]
pub(super) fn any(lanes: Wide<f64>) -> bool {
    let mut all_zero = true;
    for l in 0..W {
        all_zero &= lanes.0[l] == 0.0;
    }
    !all_zero
}
