//! The gaps between the times at which a step samples accelerations, and the bound of steps that
//! follows from them.
//!
//! A force that fits between two samples is not in the error estimate. A step is therefore bounded
//! by what is known about time scales: no two of its samples lie farther apart than [`APART`] times
//! the width of the narrowest function of time that it goes over.

// Functions that lanes use too have to be compiled for their vectors.
#![allow(clippy::inline_always)]

use crate::scalar::{Float, Real};
use crate::system::{System, scalar_time};
use crate::time::Time;

/// The greatest distance of two samples, in widths: exp(−((t − t₀)/w)²) is sampled within ¾ w of
/// its middle, where it is 0.57 or more.
///
/// With 2.2, the middle of a kick is sampled where it is 0.3, and once in four hundred kicks the
/// estimate of `Dop853` accepts a step that is 440 tolerances off.
pub(crate) const APART: f64 = 1.5;

/// The part of the interval that a step over a motion of unknown resolution may take.
pub(crate) const PART: f64 = 0.02;

/// The longest such step in seconds where there is no interval.
pub(crate) const WITHOUT_INTERVAL: f64 = 1.0;

/// The widest gap between the nodes to which an estimate gives weights, and between the last of
/// them and the first of the next step.
pub(crate) const fn widest<const K: usize>(nodes: &[f64], estimate: &[(usize, f64); K]) -> f64 {
    let mut widest = 0.0;
    let mut i = 0;
    while i < K {
        let (own, mut next, mut j) = (nodes[estimate[i].0], 2.0, 0);
        while j < 2 * K {
            let other = nodes[estimate[j % K].0] + if j < K { 0.0 } else { 1.0 };
            if own < other && other < next {
                next = other;
            }
            j += 1;
        }
        if widest < next - own {
            widest = next - own;
        }
        i += 1;
    }
    widest
}

/// Every node with a weight.
pub(crate) const fn all<const K: usize>() -> [(usize, f64); K] {
    let mut row = [(0, 1.0); K];
    let mut k = 0;
    while k < K {
        row[k].0 = k;
        k += 1;
    }
    row
}

/// The longest step from `t` of a method whose samples lie `gap` of a step apart, as far as
/// `system` contains the time.
#[inline(always)]
pub(crate) fn longest<S: System<N, Scalar: Float>, const N: usize>(
    system: &S,
    t: Time,
    gap: f64,
) -> f64 {
    if !S::FACTS.explicit_time {
        return f64::INFINITY;
    }
    let longest = system.longest_step(scalar_time(t), S::Scalar::from_f64(APART / gap)).to_f64();
    let least = least(t);
    // The accelerations are no numbers then, either.
    if longest.is_nan() {
        f64::INFINITY
    } else if least < longest {
        longest
    } else {
        least
    }
}

/// The least width that can be told from a moment.
#[inline(always)]
pub(crate) fn least(t: Time) -> f64 {
    let least = 64.0 * f64::EPSILON * f64::abs(t.to_f64());
    if least < 1e-150 { 1e-150 } else { least }
}

#[cfg(test)]
mod tests {
    use super::{all, widest};
    use crate::integrate::method::Adaptive;
    use crate::integrate::{Dop853, Dprkn12, Rodas4};

    #[test]
    fn gaps_go_over_the_end_of_a_step() {
        assert_eq!(widest(&[0.5, 0.25], &all::<2>()), 0.75);
        assert_eq!(widest(&[0.0, 0.5, 0.25, 1.0], &[(0, 1.0), (2, 1.0), (3, -1.0)]), 0.75);
    }

    #[test]
    fn gaps_of_the_methods() {
        let gaps = [Dop853::GAP, Rodas4::GAP, Dprkn12::GAP];
        for (gap, expected) in gaps.into_iter().zip([0.2667, 0.37, 0.1945]) {
            assert!((gap - expected).abs() < 1e-4, "{gap} for {expected}");
        }
    }
}
