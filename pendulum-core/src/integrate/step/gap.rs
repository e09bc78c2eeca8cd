//! The gaps between the times at which a step samples accelerations and limits, and the resulting
//! bound on the length of steps.
//!
//! The error estimate does not contain a force that fits between two samples. The known time scales
//! therefore bound the length of a step: the distance between adjacent samples is at most [`APART`]
//! times the width of the narrowest function of time within the step.

// Functions that lanes use too are inlined, to be compiled for the vectors of the lanes.
#![allow(clippy::inline_always)]

use crate::scalar::{Float, Real};
use crate::system::{System, scalar_time};
use crate::time::Time;

/// The greatest distance of two samples, in widths: exp(−((t − t₀)/w)²) is sampled within ¾ w of
/// its middle, at a value of at least 0.57.
///
/// With 2.2, the middle of a kick is sampled at a value of 0.3, and in one of four hundred kicks
/// the estimate of `Dop853` accepts a step with an error of 440 tolerances.
pub(crate) const APART: f64 = 1.5;

/// The greatest length of a step over a motion of unknown resolution, as a fraction of the
/// interval.
pub(crate) const PART: f64 = 0.02;

/// The greatest length of such a step in seconds, for an integration without an interval.
pub(crate) const WITHOUT_INTERVAL: f64 = 1.0;

/// The distance of the samples of a method that bounds steps as the search for impacts requires.
/// The search samples gaps of limits at eighths of a step, which are at most half a width apart.
///
/// The error estimate corrects what a method misses of a kick; nothing corrects an impact that is
/// missed. At half a width, the curvature between two samples is that of a cubic up to a
/// thousandth of the height of a crest.
pub(crate) const SEARCHED: f64 = APART / 4.0;

/// Returns the widest gap between the nodes with weights in an estimate, including the gap between
/// the last of these nodes and the first node of the next step.
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

/// Returns a row with a weight for every node.
pub(crate) const fn all<const K: usize>() -> [(usize, f64); K] {
    let mut row = [(0, 1.0); K];
    let mut k = 0;
    while k < K {
        row[k].0 = k;
        k += 1;
    }
    row
}

/// Returns the longest step from `t` that the functions of time in `system` allow for a method
/// whose samples are `gap` of a step apart.
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
    // The accelerations are NaN in this case, too.
    if longest.is_nan() {
        f64::INFINITY
    } else if least < longest {
        longest
    } else {
        least
    }
}

/// Returns the least width that is distinguishable from zero at `t`.
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
