//! Channels: the translation, scale or rotation of a node through its keys.

use super::jet::Jet;
use pendulum_core::motion::{Curve, Derivatives, Motion, Sample, Side};
use pendulum_core::scalar::Real;
use pendulum_core::time::Time;

/// A translation or a scale.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Track {
    /// A constant value, without a channel.
    Still([f64; 3]),
    Keyed(Curve<3>),
}

/// A rotation: a unit quaternion (x, y, z, w).
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Turn {
    /// A constant value, without a channel.
    Still([f64; 4]),
    /// A piecewise constant quaternion.
    Steps(Curve<4>),
    /// Cubics through quaternions, normalized.
    Cubic(Curve<4>),
    /// Arcs of great circles.
    Arcs(Arcs),
}

/// Arcs of great circles between unit quaternions: between two keys the axis and the speed of the
/// rotation are constant.
///
/// Shoemake, "Animating Rotation with Quaternion Curves" (1985): q(u) = (q₀ sin((1 − u) φ) + q₁
/// sin(u φ))/sin φ, so that q̈ = −(φ/h)² q.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Arcs {
    times: Vec<f64>,
    /// The keys, each with a sign so that it is on the same hemisphere as the key before.
    keys: Vec<[f64; 4]>,
    /// The angle φ between each key and the next.
    angles: Vec<f64>,
    kinks: Vec<f64>,
}

impl Track {
    pub(super) fn at<const N: usize>(&self, t: Time, side: Side) -> [Jet<N>; 3] {
        match self {
            Self::Still(value) => value.map(Jet::constant),
            Self::Keyed(curve) => jets(curve, t, side),
        }
    }

    pub(super) fn kinks(&self) -> &[f64] {
        match self {
            Self::Still(_) => &[],
            Self::Keyed(curve) => curve.kinks(),
        }
    }

    /// Returns the time until which the value is constant from `t` on.
    pub(super) fn rest_until(&self, t: f64) -> f64 {
        match self {
            Self::Still(_) => f64::INFINITY,
            Self::Keyed(curve) => Motion::<f64, 3>::rest_until(curve, t),
        }
    }
}

impl Turn {
    pub(super) fn at<const N: usize>(&self, t: Time, side: Side) -> [Jet<N>; 4] {
        match self {
            Self::Still(value) => value.map(Jet::constant),
            Self::Steps(curve) => jets(curve, t, side),
            Self::Cubic(curve) => {
                let raw: [Jet<N>; 4] = jets(curve, t, side);
                let square = raw[0] * raw[0] + raw[1] * raw[1] + raw[2] * raw[2] + raw[3] * raw[3];
                let scale = square.reciprocal_root();
                raw.map(|part| part * scale)
            }
            Self::Arcs(arcs) => arcs.at(t, side),
        }
    }

    pub(super) fn kinks(&self) -> &[f64] {
        match self {
            Self::Still(_) => &[],
            Self::Steps(curve) | Self::Cubic(curve) => curve.kinks(),
            Self::Arcs(arcs) => &arcs.kinks,
        }
    }

    /// Returns the time until which the rotation is constant from `t` on.
    pub(super) fn rest_until(&self, t: f64) -> f64 {
        match self {
            Self::Still(_) => f64::INFINITY,
            Self::Steps(curve) | Self::Cubic(curve) => Motion::<f64, 4>::rest_until(curve, t),
            Self::Arcs(arcs) => arcs.rest_until(t),
        }
    }
}

/// Returns the Taylor series of a curve of cubics.
fn jets<const D: usize, const N: usize>(curve: &Curve<D>, t: Time, side: Side) -> [Jet<N>; D] {
    let mut wanted = Derivatives::POSITION;
    if 1 < N {
        wanted = wanted.union(Derivatives::VELOCITY);
    }
    if 2 < N {
        wanted = wanted.union(Derivatives::ACCELERATION);
    }
    let sample: Sample<f64, D> = curve.sample(t, side, wanted);
    core::array::from_fn(|d| {
        let all = [sample.position[d], sample.velocity[d], 0.5 * sample.acceleration[d]];
        Jet(core::array::from_fn(|order| all[order]))
    })
}

impl Arcs {
    /// Creates arcs through unit quaternions, each along the shorter way.
    pub(super) fn new(times: &[f64], keys: &[[f64; 4]]) -> Self {
        let mut keys = keys.to_vec();
        let mut angles = Vec::with_capacity(keys.len());
        for key in 1..keys.len() {
            if dot(&keys[key - 1], &keys[key]) < 0.0 {
                keys[key] = keys[key].map(|part| -part);
            }
            let (from, to) = (keys[key - 1], keys[key]);
            let [apart, together] = [-1.0, 1.0].map(|sign| {
                let sum: [f64; 4] = core::array::from_fn(|d| to[d] + sign * from[d]);
                Real::sqrt(dot(&sum, &sum))
            });
            // Accurate also for small angles, unlike the arc cosine.
            angles.push(2.0 * Real::atan2(apart, together));
        }
        let mut arcs = Self { times: times.to_vec(), keys, angles, kinks: Vec::new() };
        for &time in times {
            let [before, after] =
                [Side::Before, Side::After].map(|side| arcs.at::<3>(Time::new(time), side));
            let differ = |order: usize| {
                let size = before
                    .iter()
                    .chain(&after)
                    .fold(0.0f64, |size, jet| Real::max(size, jet.0[order].abs()));
                (0..4).any(|d| 1e-9 * size < (before[d].0[order] - after[d].0[order]).abs())
            };
            if differ(1) || differ(2) {
                arcs.kinks.push(time);
            }
        }
        arcs
    }

    fn rest_until(&self, t: f64) -> f64 {
        let passed = self.times.partition_point(|&key| key <= t);
        if passed == self.times.len() {
            return f64::INFINITY;
        }
        match (passed.saturating_sub(1)..self.angles.len()).find(|&arc| self.angles[arc] != 0.0) {
            Some(arc) if t < self.times[arc] => self.times[arc],
            Some(_) => t,
            None => f64::INFINITY,
        }
    }

    fn at<const N: usize>(&self, t: Time, side: Side) -> [Jet<N>; 4] {
        let passed = self.times.partition_point(|&key| match side {
            Side::After => 0.0 <= t.since(key),
            Side::Before => 0.0 < t.since(key),
        });
        if passed == 0 || passed == self.times.len() {
            let rest = if passed == 0 { 0 } else { passed - 1 };
            return self.keys[rest].map(Jet::constant);
        }
        let (from, to, angle) =
            (&self.keys[passed - 1], &self.keys[passed], self.angles[passed - 1]);
        if angle == 0.0 {
            return from.map(Jet::constant);
        }
        let since = t.since(self.times[passed - 1]);
        let speed = angle / (self.times[passed] - self.times[passed - 1]);
        let done = speed * since;
        let (sin, cos) = Real::sin_cos(done);
        let (sin_rest, cos_rest) = Real::sin_cos(angle - done);
        let whole = Real::sin(angle);
        core::array::from_fn(|d| {
            let value = (from[d] * sin_rest + to[d] * sin) / whole;
            let first = speed * (to[d] * cos - from[d] * cos_rest) / whole;
            let all = [value, first, -0.5 * speed * speed * value];
            Jet(core::array::from_fn(|order| all[order]))
        })
    }
}

/// Returns the first piece of a curve of quaternions that comes close to zero, where it defines no
/// rotation.
pub(super) fn vanishing(curve: &Curve<4>) -> Option<usize> {
    curve.pieces().position(|(piece, h)| {
        // Far below the values for rotations of less than half a turn, and large enough for a quick
        // decision.
        let size = |coefficient: &[f64; 4]| Real::sqrt(dot(coefficient, coefficient));
        let least = 1e-4
            * (size(&piece[0])
                + h * (size(&piece[1]) + h * (size(&piece[2]) + h * size(&piece[3]))));
        !away(piece, h, least)
    })
}

/// Returns `true` if |c(u)| > `least` for u from 0 to h. Intervals are bisected until the value in
/// the middle and a bound of |ċ| decide.
fn away(piece: &[[f64; 4]; 4], h: f64, least: f64) -> bool {
    let [a, b, c, d] = piece;
    let mut spans = vec![[0.0, h]];
    // Curves from rotations need about a dozen intervals.
    for _ in 0..4096 {
        let Some([low, high]) = spans.pop() else { return true };
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let value: [f64; 4] =
            core::array::from_fn(|k| a[k] + middle * (b[k] + middle * (c[k] + middle * d[k])));
        let size = Real::sqrt(dot(&value, &value));
        // The farther end bounds each term of ċ.
        let slope: [f64; 4] = core::array::from_fn(|k| {
            b[k].abs() + high * (2.0 * c[k].abs() + high * 3.0 * d[k].abs())
        });
        let change = half * Real::sqrt(dot(&slope, &slope));
        if size <= least {
            return false;
        }
        if size - least <= change || change.is_nan() {
            spans.extend([[low, middle], [middle, high]]);
        }
    }
    false
}

/// Computes the dot product of two quaternions as vectors.
pub(super) fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}
