//! Crossings of the curves of an outline.

use super::Outline;
use super::curve::Point;
use super::curve::{CHORDS, Curve};
use pendulum_core::body::BodyError;
use pendulum_core::scalar::Real;

/// The greatest number of crossings, and of pairs of chords that might cross.
pub(super) const CROSSINGS: usize = 1 << 16;
const PAIRS: usize = 1 << 28;

impl Outline {
    /// Returns the parameters of the crossings of each curve of each ring, in ascending order.
    pub(super) fn cuts(&self) -> Result<Vec<Vec<Vec<f64>>>, BodyError> {
        let mut cuts: Vec<Vec<Vec<f64>>> =
            self.rings.iter().map(|ring| vec![Vec::new(); ring.len()]).collect();
        let mut chords = Vec::new();
        for (ring, curves) in self.rings.iter().enumerate() {
            for (curve, shape) in curves.iter().enumerate() {
                chords.extend(shape.chords().enumerate().map(|(index, ends)| Chord {
                    ends,
                    ring,
                    curve,
                    index,
                }));
            }
        }
        let left = |chord: &Chord| Real::min(chord.ends[0][0], chord.ends[1][0]);
        let right = |chord: &Chord| Real::max(chord.ends[0][0], chord.ends[1][0]);
        chords.sort_by(|a, b| left(a).total_cmp(&left(b)));
        let [mut pairs, mut crossings] = [0, 0];
        for (k, one) in chords.iter().enumerate() {
            if PAIRS < pairs {
                return Err(BodyError::Tangled { pairs: PAIRS });
            }
            for other in chords[k + 1..].iter().take_while(|other| left(other) <= right(one)) {
                pairs += 1;
                let together = (one.ring, one.curve) == (other.ring, other.curve);
                if together && one.index.abs_diff(other.index) <= 1 {
                    continue;
                }
                let Some(at) = crossing(&one.ends, &other.ends) else { continue };
                crossings += 1;
                if CROSSINGS < crossings {
                    return Err(BodyError::Tangled { pairs: CROSSINGS });
                }
                let curves = [one, other].map(|chord| &self.rings[chord.ring][chord.curve]);
                let guess = [(one, at[0]), (other, at[1])].map(|(chord, at)| {
                    (chord.index as f64 + at) / self.rings[chord.ring][chord.curve].count() as f64
                });
                let found = refined(curves, guess);
                let ends = found.map(|parameter| {
                    if parameter <= 1e-9 {
                        0.0
                    } else if 1.0 - 1e-9 <= parameter {
                        1.0
                    } else {
                        parameter
                    }
                });
                // The end of a curve and the start of the next curve do not cross; another curve
                // through this point does.
                let count = self.rings[one.ring].len();
                let goes_on = |from: usize, to: usize| ends[from] == 1.0 && ends[to] == 0.0;
                let next = |from: &Chord, to: &Chord| {
                    from.ring == to.ring && (from.curve + 1) % count == to.curve
                };
                if next(one, other) && goes_on(0, 1) || next(other, one) && goes_on(1, 0) {
                    continue;
                }
                for (chord, parameter) in [one, other].into_iter().zip(ends) {
                    cuts[chord.ring][chord.curve].push(parameter);
                }
            }
        }
        for cuts in cuts.iter_mut().flatten() {
            cuts.sort_by(f64::total_cmp);
            cuts.dedup_by(|later, earlier| *later - *earlier < 1e-9);
        }
        Ok(cuts)
    }
}

/// A straight piece of a curve, with its index.
#[derive(Clone, Copy)]
struct Chord {
    ends: [Point; 2],
    ring: usize,
    curve: usize,
    index: usize,
}

/// Returns the crossing of two chords, as fractions of both; ends are included.
fn crossing(one: &[Point; 2], other: &[Point; 2]) -> Option<[f64; 2]> {
    let [low, high] = [Real::min, Real::max]
        .map(|pick: fn(f64, f64) -> f64| [one, other].map(|ends| pick(ends[0][1], ends[1][1])));
    if high[0] < low[1] || high[1] < low[0] {
        return None;
    }
    let along = |ends: &[Point; 2]| [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
    let cross = |a: Point, b: Point| a[0] * b[1] - a[1] * b[0];
    let (u, v) = (along(one), along(other));
    let between = [other[0][0] - one[0][0], other[0][1] - one[0][1]];
    let area = cross(u, v);
    let size = Real::sqrt((u[0] * u[0] + u[1] * u[1]) * (v[0] * v[0] + v[1] * v[1]));
    if area.abs() <= 1e-12 * size {
        return None;
    }
    let at = [cross(between, v) / area, cross(between, u) / area];
    at.iter().all(|share| (-1e-9..=1.0 + 1e-9).contains(share)).then_some(at)
}

/// Computes the parameters of the crossing of two curves by Newton's method, starting from the
/// crossing of their chords.
fn refined(curves: [&Curve; 2], guess: [f64; 2]) -> [f64; 2] {
    let mut at = guess;
    for _ in 0..8 {
        let (p, q) = (curves[0].at(at[0]), curves[1].at(at[1]));
        let (u, v) = (curves[0].slope(at[0]), curves[1].slope(at[1]));
        let apart = [q[0] - p[0], q[1] - p[1]];
        let area = u[0] * v[1] - u[1] * v[0];
        let step = [
            (apart[0] * v[1] - apart[1] * v[0]) / area,
            (apart[0] * u[1] - apart[1] * u[0]) / area,
        ];
        let next = [at[0] + step[0], at[1] + step[1]];
        // Curves that touch may have no crossing; the crossing of the chords is then used.
        if !(0..2).all(|k| (next[k] - guess[k]).abs() < 2.0 / CHORDS as f64) {
            return guess;
        }
        at = next;
    }
    at
}
