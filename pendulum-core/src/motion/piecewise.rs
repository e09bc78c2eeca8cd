//! The cubic pieces of a curve: their coefficients, kinks and times.

use crate::motion::curve::Curve;
use crate::motion::error::MotionError;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::scalar::Real;
use crate::time::Time;

/// The kind of the pieces of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// Constants, with jumps between them.
    Steps,
    /// Straight lines.
    Lines,
    /// Cubics whose accelerations jump at keys.
    Cubic,
    /// Cubics with keys at which nothing jumps.
    Smooth,
}

impl Kind {
    /// Returns `true` if the accelerations are zero.
    pub(super) fn is_straight(self) -> bool {
        matches!(self, Self::Steps | Self::Lines)
    }
}

/// The number of pieces ahead that limit a step.
const MOST_AHEAD: u32 = 64;

/// Returns the shortest time between two keys.
fn finest(times: &[f64]) -> f64 {
    times
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .fold(f64::INFINITY, |a, b| if b < a { b } else { a })
}

/// The position of a time among the keys.
enum Place {
    /// Before the first key, or after the last.
    Rest { after: bool },
    /// The index of a piece and the time since its start.
    Piece(usize, f64),
}

/// Checks that there are keys, as many times as values, that the times increase, and that all
/// numbers are finite.
pub(super) fn checked<const D: usize>(
    times: &[f64],
    values: &[[f64; D]],
) -> Result<(), MotionError> {
    if times.len() != values.len() {
        return Err(MotionError::Lengths { times: times.len(), values: values.len() });
    }
    if times.is_empty() {
        let required = "1 or more; use `Still` for a point at rest";
        return Err(MotionError::Argument { name: "number of keys", value: 0.0, required });
    }
    for key in 0..times.len() {
        if !times[key].is_finite() || values[key].iter().any(|value| !value.is_finite()) {
            return Err(MotionError::NotFinite { key });
        }
        if 0 < key && times[key] <= times[key - 1] {
            return Err(MotionError::NotIncreasing { key, time: times[key] });
        }
    }
    Ok(())
}

impl<const D: usize> Curve<D> {
    /// Creates a curve without kinks.
    fn of(times: &[f64], pieces: Vec<[[f64; D]; 4]>, last: [f64; D], kind: Kind) -> Self {
        let (times, finest) = (times.to_vec(), finest(times));
        Self { times, pieces, last, kind, looped: false, kinks: Vec::new(), finest }
    }

    /// Creates cubics from the `values` at the keys and the velocities `slopes` at both ends of
    /// each piece.
    pub(super) fn cubics(
        times: &[f64],
        values: &[[f64; D]],
        slopes: &[[[f64; D]; 2]],
        kind: Kind,
    ) -> Self {
        let mut pieces = Vec::with_capacity(slopes.len());
        for (index, [from, to]) in slopes.iter().enumerate() {
            let h = times[index + 1] - times[index];
            let mut piece = [[0.0; D]; 4];
            for d in 0..D {
                let chord = (values[index + 1][d] - values[index][d]) / h;
                piece[0][d] = values[index][d];
                piece[1][d] = from[d];
                // Without rounding errors for lines.
                if !kind.is_straight() {
                    piece[2][d] = (3.0 * chord - 2.0 * from[d] - to[d]) / h;
                    piece[3][d] = (from[d] + to[d] - 2.0 * chord) / (h * h);
                }
            }
            pieces.push(piece);
        }
        let mut curve = Self::of(times, pieces, values[values.len() - 1], kind);
        curve.find_kinks();
        curve
    }

    /// Creates straight lines.
    pub(super) fn lines(times: &[f64], values: &[[f64; D]]) -> Self {
        let slope = |key: usize| {
            let h = times[key + 1] - times[key];
            let mut slope = [0.0; D];
            for d in 0..D {
                slope[d] = (values[key + 1][d] - values[key][d]) / h;
            }
            [slope, slope]
        };
        let slopes: Vec<_> = (0..times.len() - 1).map(slope).collect();
        Self::cubics(times, values, &slopes, Kind::Lines)
    }

    /// Creates a piecewise constant curve that jumps at the keys.
    pub(super) fn constants(times: &[f64], values: &[[f64; D]]) -> Self {
        let last = values.len() - 1;
        let rest = [0.0; D];
        let pieces = values[..last].iter().map(|&value| [value, rest, rest, rest]).collect();
        let mut curve = Self::of(times, pieces, values[last], Kind::Steps);
        let jumps = (0..last).filter(|&key| values[key] != values[key + 1]);
        curve.kinks = jumps.map(|key| times[key + 1]).collect();
        curve
    }

    /// Returns the times in the range of the keys at which position, velocity or acceleration
    /// jumps.
    pub fn kinks(&self) -> &[f64] {
        &self.kinks
    }

    /// Returns the pieces as coefficients of 1, u, u², u³, with the time u since the key, and their
    /// durations.
    pub fn pieces(&self) -> impl Iterator<Item = (&[[f64; D]; 4], f64)> {
        self.pieces.iter().zip(self.times.windows(2).map(|pair| pair[1] - pair[0]))
    }

    /// Finds the keys at which velocity or acceleration jumps. The keys between the first and the
    /// last of a smooth curve are none: differences there are rounding errors.
    fn find_kinks(&mut self) {
        let count = self.times.len();
        if self.pieces.is_empty() {
            return;
        }
        let rest = [[0.0; D]; 3];
        for key in 0..count {
            let inner = 0 < key && key + 1 < count;
            let before = if key == 0 { rest } else { self.end_of(key - 1) };
            let after = if key + 1 == count { rest } else { self.start_of(key) };
            if before[1..] != after[1..] && !(inner && self.kind == Kind::Smooth) {
                self.kinks.push(self.times[key]);
            }
        }
    }

    /// Repeats a curve of two keys or more; the seam is a kink unless it is smooth.
    pub(super) fn close_loop(&mut self) {
        let count = self.times.len();
        let (first, last) = (self.times[0], self.times[count - 1]);
        self.kinks.retain(|&kink| first < kink && kink < last);
        if !close(&self.end_of(count - 2), &self.start_of(0)) {
            self.kinks.push(last);
        }
        self.looped = true;
    }

    /// Returns the curve with its keys at other times, passed `speed` times as fast. `time` returns
    /// the new time of a key.
    pub(super) fn retimed(
        self,
        time: impl Fn(f64) -> f64,
        speed: f64,
    ) -> Result<Self, MotionError> {
        let times: Vec<f64> = self.times.iter().map(|&key| time(key)).collect();
        let mut values: Vec<_> = self.pieces.iter().map(|piece| piece[0]).collect();
        values.push(self.last);
        checked(&times, &values)?;
        // The pieces are created anew, because the rounding of times changes their lengths.
        let mut curve = match self.kind {
            Kind::Steps => Self::constants(&times, &values),
            Kind::Lines => Self::lines(&times, &values),
            Kind::Cubic | Kind::Smooth => {
                let faster = |end: [[f64; D]; 3]| end[1].map(|part| speed * part);
                let ends = |piece| [self.start_of(piece), self.end_of(piece)].map(faster);
                let slopes: Vec<_> = (0..self.pieces.len()).map(ends).collect();
                Self::cubics(&times, &values, &slopes, self.kind)
            }
        };
        curve.kinks = self.kinks.iter().map(|&kink| time(kink)).collect();
        curve.looped = self.looped;
        Ok(curve)
    }

    /// Returns position, velocity and acceleration at the start of a piece.
    fn start_of(&self, piece: usize) -> [[f64; D]; 3] {
        let [a, b, c, _] = self.pieces[piece];
        [a, b, c.map(|value| 2.0 * value)]
    }

    /// Returns position, velocity and acceleration at the end of a piece.
    fn end_of(&self, piece: usize) -> [[f64; D]; 3] {
        let h = self.times[piece + 1] - self.times[piece];
        let sample: Sample<f64, D> = evaluate(&self.pieces[piece], h, Derivatives::ALL);
        let next = match self.kind {
            Kind::Steps => self.pieces[piece][0],
            _ => self.pieces.get(piece + 1).map_or(self.last, |next| next[0]),
        };
        [next, sample.velocity, sample.acceleration]
    }

    fn period(&self) -> f64 {
        self.times[self.times.len() - 1] - self.times[0]
    }

    /// Returns the number of whole periods before `t`.
    fn turns(&self, t: Time) -> f64 {
        (t.since(self.times[0]) / self.period()).floor()
    }

    fn place(&self, t: Time, side: Side) -> Place {
        let count = self.times.len();
        if !self.looped {
            let passed = passed(&self.times, t.to_f64(), |key| match side {
                Side::After => 0.0 <= t.since(key),
                Side::Before => 0.0 < t.since(key),
            });
            return match passed {
                0 => Place::Rest { after: false },
                passed if passed == count => Place::Rest { after: true },
                passed => Place::Piece(passed - 1, t.since(self.times[passed - 1])),
            };
        }
        let turns = self.turns(t);
        let local = t + -(turns * self.period());
        // The time of a kink in a later period has rounding errors; close to it `side` decides.
        let slack = 4.0 * f64::EPSILON * (t.to_f64().abs() + self.period());
        let key = passed(&self.times, local.to_f64(), |key| key <= local.to_f64());
        let near = [key.saturating_sub(1), key.min(count - 1)]
            .into_iter()
            .find(|&key| local.since(self.times[key]).abs() <= slack);
        if let Some(key) = near {
            return match side {
                Side::After if key + 1 == count => Place::Piece(0, 0.0),
                Side::After => Place::Piece(key, 0.0),
                Side::Before => {
                    let piece = if key == 0 { count - 2 } else { key - 1 };
                    Place::Piece(piece, self.times[piece + 1] - self.times[piece])
                }
            };
        }
        let piece = key.saturating_sub(1).min(count - 2);
        Place::Piece(piece, local.since(self.times[piece]))
    }

    #[inline]
    pub(super) fn at<T: Real>(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D> {
        match self.place(t, side) {
            Place::Rest { after } => {
                let mut sample = Sample::zero();
                if wanted.contains(Derivatives::POSITION) {
                    let value =
                        if after || self.pieces.is_empty() { self.last } else { self.pieces[0][0] };
                    sample.position = value.map(T::from_f64);
                }
                sample
            }
            Place::Piece(piece, u) => evaluate(&self.pieces[piece], u, wanted),
        }
    }

    /// Returns the coefficients of 1, u, u², u³ of one component, with the time u since `t`.
    pub(super) fn cubic(&self, t: Time, side: Side, component: usize) -> [f64; 4] {
        match self.place(t, side) {
            Place::Rest { after } => {
                let value =
                    if after || self.pieces.is_empty() { self.last } else { self.pieces[0][0] };
                [value[component], 0.0, 0.0, 0.0]
            }
            Place::Piece(piece, u) => {
                let [a, b, c, d] = self.pieces[piece].map(|coefficient| coefficient[component]);
                [
                    a + u * (b + u * (c + u * d)),
                    b + u * (2.0 * c + u * (3.0 * d)),
                    c + u * (3.0 * d),
                    d,
                ]
            }
        }
    }

    /// Returns the longest step from `t` that cannot miss a piece: `widths` times the length of any
    /// piece that it may reach.
    pub(super) fn longest_within_keys(&self, t: f64, widths: f64) -> f64 {
        let length = |key: Option<f64>, other: Option<f64>| Some(widths * (key? - other?).abs());
        // The current piece; no bound beyond the keys.
        let next = self.next(&self.times, t);
        let ahead =
            length(next, next.and_then(|key| self.last(&self.times, key))).unwrap_or(f64::INFINITY);
        if ahead <= 1.5 * widths * self.finest {
            return widths * self.finest;
        }
        let longest = Self::longest_past(t, widths, ahead, next, |key| self.next(&self.times, key));
        // The step may go backwards in time. If `t` is a key, the current piece is then another
        // one.
        let last = self.last(&self.times, t);
        let behind =
            length(last, last.and_then(|key| self.next(&self.times, key))).unwrap_or(f64::INFINITY);
        let longest = if behind < longest { behind } else { longest };
        Self::longest_past(t, widths, longest, last, |key| self.last(&self.times, key))
    }

    /// Returns `longest`, or less if the pieces beyond the key `from` require it. `beyond` returns
    /// the key that follows a key.
    fn longest_past(
        t: f64,
        widths: f64,
        mut longest: f64,
        from: Option<f64>,
        beyond: impl Fn(f64) -> Option<f64>,
    ) -> f64 {
        let Some(mut from) = from else { return longest };
        for _ in 0..MOST_AHEAD {
            let distance = 0.5 * (from - t).abs();
            if longest <= distance {
                return longest;
            }
            let Some(to) = beyond(from) else { return longest };
            let own = widths * (to - from).abs();
            let own = if own < distance { distance } else { own };
            longest = if own < longest { own } else { longest };
            from = to;
        }
        // A longer step could reach pieces beyond `MOST_AHEAD`.
        let distance = 0.5 * (from - t).abs();
        if distance < longest { distance } else { longest }
    }

    /// Returns the first of `times`, repeated if the curve is looped, after `t`.
    pub(super) fn next(&self, times: &[f64], t: f64) -> Option<f64> {
        if !self.looped {
            return times.get(passed(times, t, |time| time <= t)).copied();
        }
        if times.is_empty() || !t.is_finite() {
            return None;
        }
        let turns = self.turns(Time::new(t));
        // A time that is equal to `t` up to rounding does not count.
        let slack = 4.0 * f64::EPSILON * (t.abs() + self.period());
        for turn in [turns - 1.0, turns, turns + 1.0, turns + 2.0] {
            let shift = turn * self.period();
            let index = passed(times, t - shift, |time| time + shift <= t + slack);
            if let Some(time) = times.get(index) {
                return Some(time + shift);
            }
        }
        None
    }

    /// Returns the last of `times`, repeated if the curve is looped, before `t`.
    pub(super) fn last(&self, times: &[f64], t: f64) -> Option<f64> {
        if !self.looped {
            return times[..passed(times, t, |time| time < t)].last().copied();
        }
        if times.is_empty() || !t.is_finite() {
            return None;
        }
        let turns = self.turns(Time::new(t));
        let slack = 4.0 * f64::EPSILON * (t.abs() + self.period());
        for turn in [turns + 1.0, turns, turns - 1.0, turns - 2.0] {
            let shift = turn * self.period();
            let index = passed(times, t - shift, |time| time + shift < t - slack);
            if let Some(time) = times[..index].last() {
                return Some(time + shift);
            }
        }
        None
    }

    /// Returns the time until which the curve is constant from `t` on.
    pub(super) fn rests_until(&self, t: f64) -> f64 {
        let rests = |piece: usize| {
            self.pieces[piece][1..].iter().flatten().all(|&coefficient| coefficient == 0.0)
        };
        // For steps, pieces are constant on both sides of a jump.
        let value = |piece: usize| self.pieces.get(piece).map_or(self.last, |piece| piece[0]);
        let count = self.pieces.len();
        // The first key from a piece on at which the curve starts to move or jumps.
        let moves = |from: usize| {
            (from..=count).find(|&key| {
                key < count && !rests(key) || from < key && value(key) != value(key - 1)
            })
        };
        if count == 0 || moves(0).is_none() {
            return f64::INFINITY;
        }
        if self.looped {
            // Limited to the current period; callers repeat the call at its end.
            let turn = self.turns(Time::new(t)) * self.period();
            let local = t - turn;
            let piece =
                self.times.partition_point(|&key| key <= local).saturating_sub(1).min(count - 1);
            let until = self.times[moves(piece).unwrap_or(count)] + turn;
            return if t < until && rests(piece) {
                until - 4.0 * f64::EPSILON * (until.abs() + self.period())
            } else {
                t
            };
        }
        let passed = self.times.partition_point(|&key| key <= t);
        if passed == self.times.len() {
            return f64::INFINITY;
        }
        match moves(passed.saturating_sub(1)) {
            Some(piece) if t < self.times[piece] => self.times[piece],
            Some(_) => t,
            None => f64::INFINITY,
        }
    }
}

/// Counts the `times` for which `before` is `true`. The times increase, and `t` is close to the
/// last one counted.
///
/// Most keys are equidistant, so the count is searched near its expected value first. A bisection
/// over all times would access memory in about ten more places.
#[inline]
fn passed(times: &[f64], t: f64, before: impl Fn(f64) -> bool) -> usize {
    let (&[first, .., last], count) = (times, times.len()) else {
        return times.partition_point(|&time| before(time));
    };
    if before(last) {
        return count;
    }
    let guess = (((t - first) / (last - first) * (count - 1) as f64) as usize).min(count - 1);
    let (low, high) = (guess.saturating_sub(1), (guess + 3).min(count));
    let within = (low == 0 || before(times[low - 1])) && (high == count || !before(times[high]));
    let (low, high) = if within { (low, high) } else { (0, count) };
    low + times[low..high].partition_point(|&time| before(time))
}

fn evaluate<T: Real, const D: usize>(
    piece: &[[f64; D]; 4],
    u: f64,
    wanted: Derivatives,
) -> Sample<T, D> {
    let [a, b, c, d] = piece;
    let mut sample = Sample::zero();
    for k in 0..D {
        if wanted.contains(Derivatives::POSITION) {
            sample.position[k] = T::from_f64(a[k] + u * (b[k] + u * (c[k] + u * d[k])));
        }
        if wanted.contains(Derivatives::VELOCITY) {
            sample.velocity[k] = T::from_f64(b[k] + u * (2.0 * c[k] + u * (3.0 * d[k])));
        }
        if wanted.contains(Derivatives::ACCELERATION) {
            sample.acceleration[k] = T::from_f64(2.0 * c[k] + u * (6.0 * d[k]));
        }
    }
    sample
}

/// Returns `true` if the derivatives at two ends are equal up to rounding.
fn close<const D: usize>(a: &[[f64; D]; 3], b: &[[f64; D]; 3]) -> bool {
    (0..3).all(|order| {
        let size =
            a[order].iter().chain(&b[order]).fold(0.0f64, |size, value| size.max(value.abs()));
        (0..D).all(|k| (a[order][k] - b[order][k]).abs() <= 1e-9 * size)
    })
}

#[cfg(test)]
mod tests {
    use super::passed;
    use crate::motion::{Curve, Motion};
    use crate::scalar::Real;

    #[test]
    fn keys_are_found_wherever_they_stand() {
        let even: Vec<f64> = (0..100).map(|key| 0.7 + f64::from(key) / 24.0).collect();
        let crowded: Vec<f64> = (0..100).map(|key| -3.0 + f64::from(key * key) / 9.0).collect();
        let late: Vec<f64> = (0..100).map(|key| Real::sqrt(f64::from(key))).collect();
        for times in [&even[..], &crowded, &late, &even[..3], &even[..2], &even[..1], &[]] {
            let near = times
                .iter()
                .flat_map(|&time| [time.next_down(), time, time.next_up(), time + 1e-3]);
            for t in near.chain([f64::NEG_INFINITY, -1e300, -1.0, 0.0, 1e300, f64::INFINITY]) {
                let before = times.iter().filter(|&&time| time <= t).count();
                assert_eq!(passed(times, t, |time| time <= t), before, "{t}");
                // The result is correct for a wrong `t`, too.
                assert_eq!(passed(times, 2.0, |time| time <= t), before, "{t}");
                assert_eq!(passed(times, f64::NAN, |time| time <= t), before, "{t}");
            }
        }
    }

    #[test]
    fn kinks_of_a_loop_come_again() {
        let times: Vec<f64> = (0..50).map(|key| 0.3 + f64::from(key * key) / 70.0).collect();
        let values: Vec<[f64; 1]> = (0..50).map(|key| [f64::from(key * 7 % 5)]).collect();
        let curve = Curve::linear(&times, &values).unwrap().looped().unwrap();
        let all: Vec<f64> = (-3..6)
            .flat_map(|turn| {
                curve.kinks.iter().map(move |kink| kink + f64::from(turn) * (49.0 * 49.0 / 70.0))
            })
            .collect();
        assert!(45 < curve.kinks.len() && all.is_sorted());
        let next_kink = |t| Motion::<f64, 1>::next_kink(&curve, t);
        let last_kink = |t| Motion::<f64, 1>::kink_before(&curve, t);
        for index in 60..all.len() - 60 {
            let near = |a: Option<f64>, b: f64| (a.unwrap() - b).abs() < 1e-12;
            let between = 0.5 * (all[index] + all[index + 1]);
            assert!(
                near(next_kink(between), all[index + 1]) && near(last_kink(between), all[index]),
                "{between}"
            );
            let kink = next_kink(between).unwrap();
            assert!(
                near(next_kink(kink), all[index + 2]) && near(last_kink(kink), all[index]),
                "{kink}"
            );
        }
    }
}
