//! The length of a step from the coefficients of its series.

// Code over lanes uses these functions too, compiled for its vector instructions.
#![allow(clippy::inline_always)]

use crate::integrate::step::fast_exp2::{digits, log2, power};
use crate::jet::{LENGTH, Path};
use crate::scalar::Float;

/// The rule for the length of a step, from the order and the tolerance.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rule {
    pub(super) tolerance: f64,
    pub(crate) order: usize,
    /// For each order k: intercept and negative slope of log₂(step) + 1023 as a function of
    /// [`digits`] of the coefficient, which are log₂ + 1023 in units of 2⁻³².
    lines: [(f64, f64); LENGTH],
}

impl Rule {
    pub(crate) fn new(order: usize, tolerance: f64) -> Self {
        let binary = log2(tolerance);
        let margin = binary / order as f64 - 0.7 * core::f64::consts::LOG2_E / (order as f64 - 1.0);
        let lines = core::array::from_fn(|k| {
            let k = k.max(1) as f64;
            (1023.0 + margin + (1023.0 - binary) / k, 1.0 / (4294967296.0 * k))
        });
        Self { tolerance, order, lines }
    }

    /// Returns log₂(step) + 1023 from the coefficient of order k over the error allowed, where step
    /// is (coefficient · rtol)^(−1/k) times the margin; infinity if the coefficient is zero.
    #[inline(always)]
    pub(crate) fn log_radius(&self, coefficient: f64, k: usize) -> f64 {
        let (most, slope) = self.lines[k];
        let radius = most - slope * digits(coefficient);
        if 0.0 < coefficient { radius } else { f64::INFINITY }
    }
}

/// The number of highest orders that determine the length of a step. For a motion from rest at a
/// symmetric position only one order in four is nonzero.
pub(crate) const LAST_ORDERS: usize = 4;

/// Returns the length of a step at whose end the last term of the series is as large as allowed;
/// infinity for a uniform motion.
#[inline]
pub(super) fn length<T: Float, const N: usize>(
    path: &Path<T, N>,
    rule: &Rule,
    weights: &[[f64; N]; 2],
) -> f64 {
    let (mut least, mut seen) = (f64::INFINITY, 0);
    for k in (1..=rule.order).rev() {
        let (coefficient, _) = largest(path, k, weights);
        let longest = rule.log_radius(coefficient, k);
        least = if longest < least { longest } else { least };
        seen += 1;
        if LAST_ORDERS <= seen && least < f64::INFINITY {
            break;
        }
    }
    if least == f64::INFINITY {
        return least;
    }
    power(least)
}

/// Returns `true` if the last orders of a series are zero: the motion is a polynomial of time.
#[cold]
pub(super) fn ends<T: Float, const N: usize>(
    path: &Path<T, N>,
    rule: &Rule,
    weights: &[[f64; N]; 2],
) -> bool {
    let last = rule.order.saturating_sub(LAST_ORDERS - 1);
    (last..=rule.order).all(|k| largest(path, k, weights).0 == 0.0)
}

/// Returns the largest coefficient of an order over the error allowed, and its coordinate.
#[inline]
pub(super) fn largest<T: Float, const N: usize>(
    path: &Path<T, N>,
    k: usize,
    weights: &[[f64; N]; 2],
) -> (f64, usize) {
    let mut largest = (0.0, 0);
    for i in 0..N {
        for (series, weights) in [(&path.q[i], &weights[0]), (&path.v[i], &weights[1])] {
            let coefficient = series[k].to_f64().abs() * weights[i];
            if largest.0 < coefficient {
                largest = (coefficient, i);
            }
        }
    }
    largest
}
