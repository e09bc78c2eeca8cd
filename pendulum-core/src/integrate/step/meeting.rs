//! The search of a step for its first meeting: with a limit whose gap closes or whose contact ends,
//! or with a change of a dry friction.

use crate::integrate::interpolant::Interpolant;
use crate::integrate::state::endpoint::Endpoint;
use crate::scalar::Float;
use crate::system::MOST_LIMITS as L;
use crate::time::Time;

/// The number of parts of a step at whose ends gaps and multipliers are checked.
pub const PARTS: usize = 8;
/// The number of halvings that find a root to the precision of a step.
pub(super) const HALVINGS: usize = 60;
/// The number of halvings of a part in search of a gap that closes and opens within it.
pub(super) const FINEST: u32 = 6;
/// The multiple of the deviation of a gap from a cubic that the gap must exceed in a part, or the
/// part is halved. The deviation in the middle is the largest for a quartic; a gap that oscillates
/// faster may be much lower elsewhere.
const UNRESOLVED: f64 = 8.0;

/// The meeting of a step with a limit or with a change of a dry friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Meeting {
    /// The fraction of the step before the meeting.
    pub(crate) theta: f64,
    pub(crate) what: Met,
}

/// What a step has met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Met {
    /// The gap of a limit closes.
    Closes(usize),
    /// The contact of a limit ends.
    Opens(usize),
    /// The rate of a friction becomes zero.
    Stops(usize),
    /// The rate of a friction against a vector turns too fast for the step, or has left zero.
    Turns,
    /// A friction that sticks breaks away.
    Breaks { friction: usize, forwards: bool },
}

/// Returns the state at a place within the step of `interpolant` that ends in `end`.
pub(super) fn place<T: Float, const N: usize>(
    interpolant: &Interpolant<T, N>,
    end: &Endpoint<T, N>,
    theta: f64,
) -> (Time, [T; N], [T; N]) {
    if theta == 1.0 {
        return (end.t, end.q.high, end.v.high);
    }
    let (q, v) = interpolant.at(T::from_f64(theta));
    (interpolant.interval.start + theta * interpolant.interval.h, q, v)
}

/// The gap of a limit and its rate at a place within a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) theta: f64,
    pub(super) gap: f64,
    pub(super) rate: f64,
}

impl Place {
    /// Creates a place with the gap above `least`.
    pub(super) fn of<T: Float>(theta: f64, gaps: &[[T; L]; 3], limit: usize, least: f64) -> Self {
        Self { theta, gap: gaps[0][limit].to_f64() - least, rate: gaps[1][limit].to_f64() }
    }
}

/// Returns a place between `from` and `to` with a gap below zero, before which the gap closes once,
/// in a step of the length `h`; `None` if there is none before `to`.
///
/// Between the two places the gap is approximately the cubic with these values and rates. If both
/// rates have the same sign, it turns twice or not at all; it may turn twice if its mean rate is
/// less than a third of the sum of both rates, which is half of this sum for a parabola. Halves of
/// such a part are searched, unless the gap is larger than its curvature can close. They are also
/// searched where the gap in the middle is so far off the cubic that the gap may close elsewhere: a
/// ball may fly over many ridges of a floor in one step.
pub(super) fn dip(
    look: &impl Fn(f64) -> Place,
    from: Place,
    to: Place,
    h: f64,
    halvings: u32,
) -> Option<f64> {
    let closed = to.gap < 0.0;
    if !closed && from.rate < 0.0 && 0.0 < to.rate {
        let lowest = falling(|theta| -look(theta).rate, from.theta, to.theta, 0.0);
        if look(lowest).gap < 0.0 {
            return Some(lowest);
        }
    }
    if halvings == 0 {
        return None;
    }
    let middle = look(from.theta + 0.5 * (to.theta - from.theta));
    let length = h * (to.theta - from.theta);
    if !is_unresolved(length, [from, middle, to].map(|place| [place.gap, place.rate])) {
        return None;
    }
    let first = dip(look, from, middle, h, halvings - 1);
    let first = first.or_else(|| (middle.gap < 0.0).then_some(middle.theta));
    first.or_else(|| dip(look, middle, to, h, halvings - 1))
}

/// Returns how far a gap with these values and rates at both ends of a part of this length bends
/// away from a line.
fn bend(length: f64, [gap, rate]: [f64; 2], [end, end_rate]: [f64; 2]) -> f64 {
    let mean = (end - gap) / length;
    0.5 * length * ((rate - mean).abs() + (end_rate - mean).abs())
}

/// Returns `true` if halves of a part of this length have to be searched for a gap below zero; its
/// values and rates are given at the start, in the middle and at the end.
fn is_unresolved(length: f64, [from, middle, to]: [[f64; 2]; 3]) -> bool {
    let bend = bend(length, from, to);
    let ([from, rate], [to, end_rate]) = (from, to);
    let mean = (to - from) / length;
    let along = if rate < 0.0 { -mean } else { mean };
    let turns = 0.0 < rate * end_rate && 3.0 * along < (rate + end_rate).abs();
    // Before a closed place, an opening gap turns only once.
    let may_close = if to < 0.0 { rate < 0.0 } else { from <= bend || to <= bend };
    let cubic = 0.5 * (from + to) + 0.125 * length * (rate - end_rate);
    let off = (middle[0] - cubic).abs();
    let least = f64::min(f64::min(from, middle[0]), to.abs());
    turns && may_close || least < UNRESOLVED * off
}

/// Returns `true` if a step finds an open gap open throughout a part of this length, one of
/// [`PARTS`] of the step, without a search: from the values and rates of the gap at the start, in the
/// middle and at the end.
///
/// A gap that turns within the part is at most as far below the lower end as it bends.
pub fn stays_open(length: f64, places: [[f64; 2]; 3]) -> bool {
    let [from, middle, to] = places;
    let turns = from[1] < 0.0 && 0.0 < to[1];
    let apart = bend(length, from, to);
    let above = [from, middle, to].iter().all(|[gap, _]| 0.0 < *gap);
    let far = apart < from[0] && apart < to[0];
    above && (!turns || far) && !is_unresolved(length, places)
}

/// Returns the first place between `from` and `to` at which the decreasing `function` is below
/// `level`, up to rounding.
pub(super) fn falling<T: Float>(
    mut function: impl FnMut(f64) -> T,
    from: f64,
    to: f64,
    level: T,
) -> f64 {
    let (mut above, mut below) = (from, to);
    for _ in 0..HALVINGS {
        let middle = above + 0.5 * (below - above);
        if middle <= above || below <= middle {
            break;
        }
        if function(middle) < level {
            below = middle;
        } else {
            above = middle;
        }
    }
    below
}

#[cfg(test)]
mod tests {
    use super::{FINEST, Place, dip, stays_open};

    /// A gap with the rate (θ − 0.1)(θ − 0.9) is lowest at 0.9, by 0.081 lower than at 0.
    #[test]
    fn a_gap_that_turns_twice_closes_between() {
        for (start, closes) in [(0.05, true), (0.08, true), (0.0809, true), (0.0811, false)] {
            let look = |θ: f64| Place {
                theta: θ,
                gap: start + θ * (θ * (θ / 3.0 - 0.5) + 0.09),
                rate: (θ - 0.1) * (θ - 0.9),
            };
            let low = dip(&look, look(0.0), look(1.0), 1.0, FINEST);
            // The end of 0.05 is below zero itself.
            let low = low.or((look(1.0).gap < 0.0).then_some(1.0));
            assert_eq!(low.is_some_and(|low| look(low).gap < 0.0), closes, "{start}");
        }
    }

    #[test]
    fn no_search_finds_a_part_closed_that_stays_open() {
        let (mut open, mut all) = (0, 0);
        let grid = || (-4..=4).map(f64::from);
        for (start, a) in
            [0.02, 0.3, 2.0].into_iter().flat_map(|start| grid().map(move |a| (start, a)))
        {
            for (b, c, d) in
                grid().flat_map(|b| grid().flat_map(move |c| grid().map(move |d| (b, c, d))))
            {
                let look = |θ: f64| Place {
                    theta: θ,
                    gap: start + θ * (a + θ * (b + θ * (c + θ * d))),
                    rate: a + θ * (2.0 * b + θ * (3.0 * c + θ * 4.0 * d)),
                };
                let places = [0.0, 0.5, 1.0].map(|θ| [look(θ).gap, look(θ).rate]);
                all += 1;
                if stays_open(1.0, places) {
                    open += 1;
                    assert_eq!(dip(&look, look(0.0), look(1.0), 1.0, FINEST), None);
                }
            }
        }
        assert!(all / 8 < open && open < all, "{open} of {all}");
    }
}
