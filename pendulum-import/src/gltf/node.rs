//! The motion of a node: its position or its orientation in the world under moving parents.

use super::jet::{Jet, product, turned};
use super::track::{Track, Turn, dot};
use pendulum_core::motion::{Derivatives, Motion, MotionError, Sample, Side};
use pendulum_core::scalar::Real;
use pendulum_core::time::Time;

/// A translation, a rotation x, y, z, w and a scale that rest.
pub(super) type Pose = ([f64; 3], [f64; 4], [f64; 3]);

/// The position of a node relative to its parent.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Local {
    /// Translation, rotation and scale: p ↦ x + R S p.
    Parts(Box<Parts>),
    /// A constant matrix, by rows.
    Matrix([[f64; 4]; 3]),
}

/// The parts of a position that channels move.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Parts {
    pub(super) translation: Track,
    pub(super) rotation: Turn,
    pub(super) scale: Track,
}

impl Local {
    /// Creates a position that rests.
    pub(super) fn still((at, turn, scale): Pose) -> Self {
        let [translation, scale] = [at, scale].map(Track::Still);
        Self::Parts(Box::new(Parts { translation, rotation: Turn::Still(turn), scale }))
    }

    /// Returns the place on the parent of a point of the node.
    pub(super) fn place<const N: usize>(
        &self,
        p: &[Jet<N>; 3],
        t: Time,
        side: Side,
    ) -> [Jet<N>; 3] {
        match self {
            Self::Parts(parts) => {
                let Parts { translation, rotation, scale } = &**parts;
                let scale: [Jet<N>; 3] = scale.at(t, side);
                let scaled = [0, 1, 2].map(|axis| scale[axis] * p[axis]);
                let turned = turned(&rotation.at(t, side), &scaled);
                let at: [Jet<N>; 3] = translation.at(t, side);
                [0, 1, 2].map(|axis| at[axis] + turned[axis])
            }
            Self::Matrix(rows) => rows.map(|row| {
                let [a, b, c, d] = row.map(Jet::constant);
                a * p[0] + b * p[1] + c * p[2] + d
            }),
        }
    }

    /// Returns the time until which all channels rest from `t` on.
    fn rest_until(&self, t: f64) -> f64 {
        match self {
            Self::Parts(parts) => {
                let Parts { translation, rotation, scale } = &**parts;
                Real::min(
                    Real::min(translation.rest_until(t), rotation.rest_until(t)),
                    scale.rest_until(t),
                )
            }
            Self::Matrix(_) => f64::INFINITY,
        }
    }

    pub(super) fn kinks(&self) -> impl Iterator<Item = f64> {
        let tracks: [&[f64]; 3] = match self {
            Self::Parts(parts) => {
                [parts.translation.kinks(), parts.rotation.kinks(), parts.scale.kinks()]
            }
            Self::Matrix(_) => [&[]; 3],
        };
        tracks.into_iter().flatten().copied()
    }
}

/// A node, followed by its parents outwards.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Chain {
    /// Positions.
    Places(Vec<Local>),
    /// Rotations, from the first to the last that turns a vector of the node.
    Turns(Vec<Turn>),
}

impl Chain {
    /// Returns the position in the world, or the quaternion w, x, y, z.
    pub(super) fn at<const N: usize>(&self, t: Time, side: Side) -> [Jet<N>; 4] {
        let zero = Jet::constant(0.0);
        match self {
            Self::Places(chain) => {
                let mut at = [zero; 3];
                for local in chain {
                    at = local.place(&at, t, side);
                }
                let [x, y, z] = at;
                [x, y, z, zero]
            }
            Self::Turns(chain) => {
                let mut turn = [zero, zero, zero, Jet::constant(1.0)];
                for local in chain {
                    turn = product(&local.at(t, side), &turn);
                }
                let [x, y, z, w] = turn;
                [w, x, y, z]
            }
        }
    }

    /// Returns the kinks of all channels, in order.
    fn kinks(&self) -> Vec<f64> {
        let mut kinks: Vec<f64> = match self {
            Self::Places(chain) => chain.iter().flat_map(Local::kinks).collect(),
            Self::Turns(chain) => chain.iter().flat_map(Turn::kinks).copied().collect(),
        };
        kinks.sort_by(f64::total_cmp);
        kinks.dedup();
        kinks
    }

    /// Returns the time until which all channels rest from `t` on.
    fn rest_until(&self, t: f64) -> f64 {
        let (forever, earlier) = (f64::INFINITY, Real::min);
        match self {
            Self::Places(all) => all.iter().map(|own| own.rest_until(t)).fold(forever, earlier),
            Self::Turns(all) => all.iter().map(|own| own.rest_until(t)).fold(forever, earlier),
        }
    }
}

/// The motion of a node in the world during an animation: its position, with `D` = 3, or its
/// orientation as the unit quaternion w, x, y, z, with `D` = 4. Positions are in the file's unit,
/// which is the metre unless stated otherwise.
///
/// Velocity and acceleration are exact: each channel is expanded in a Taylor series about the
/// sampled time (a polynomial, or a rotation of constant axis and speed), and the series are
/// combined through the hierarchy, x = x₀ + R₀ S₀ (x₁ + R₁ S₁ (…)), by the product rule. The kinks
/// are those of all channels of the node and its parents; of an orientation, those of rotations.
/// The node rests before the first key and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeMotion<const D: usize = 3> {
    chain: Chain,
    kinks: Vec<f64>,
    duration: f64,
    looped: bool,
    /// `true` if a period ends with the negative quaternion of its beginning, which is the same
    /// orientation: the next period then continues with the other sign.
    flips: bool,
}

impl<const D: usize> NodeMotion<D> {
    pub(super) fn new(chain: Chain, duration: f64) -> Self {
        let kinks = chain.kinks();
        Self { chain, kinks, duration, looped: false, flips: false }
    }

    /// Returns the time of the last key of all nodes of the animation, in seconds.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Repeats the motion with the period [`duration`](Self::duration); the seam is a kink unless
    /// it is smooth.
    ///
    /// # Errors
    /// If the duration of the animation is zero.
    pub fn looped(mut self) -> Result<Self, MotionError> {
        if self.duration <= 0.0 {
            let required = "positive to repeat";
            return Err(MotionError::Argument { name: "duration", value: self.duration, required });
        }
        let mut end: Sample<f64, D> =
            self.sample(Time::new(self.duration), Side::Before, Derivatives::ALL);
        let start: Sample<f64, D> = self.sample(Time::new(0.0), Side::After, Derivatives::ALL);
        if let Chain::Turns(_) = self.chain {
            let [from, to] = [start, end].map(|sample| self::array(sample.position));
            self.flips = dot(&from, &to) < 0.0;
        }
        if self.flips {
            end = end.map(|part| -part);
        }
        self.kinks.retain(|&kink| 0.0 < kink && kink < self.duration);
        let pairs = [
            (end.position, start.position),
            (end.velocity, start.velocity),
            (end.acceleration, start.acceleration),
        ];
        let smooth = pairs.iter().all(|(a, b)| {
            let size = a.iter().chain(b).fold(0.0f64, |size, value| Real::max(size, value.abs()));
            (0..D).all(|axis| (a[axis] - b[axis]).abs() <= 1e-9 * size)
        });
        if !smooth {
            self.kinks.push(self.duration);
        }
        self.looped = true;
        Ok(self)
    }

    /// Returns the time within the animation and the number of periods before it; at a kink of any
    /// period, the time of the kink itself.
    fn local(&self, t: Time, side: Side) -> (Time, f64) {
        if !self.looped {
            return (t, 0.0);
        }
        let period = self.duration;
        let turns = (t.to_f64() / period).floor();
        let local = t + -(turns * period);
        // The time of a kink in a later period has rounding errors.
        let slack = 4.0 * f64::EPSILON * (t.to_f64().abs() + period);
        if local.since(0.0) <= slack || local.since(period).abs() <= slack {
            let seam = if local.since(0.0) <= slack { turns } else { turns + 1.0 };
            return match side {
                Side::After => (Time::new(0.0), seam),
                Side::Before => (Time::new(period), seam - 1.0),
            };
        }
        let next = self.kinks.partition_point(|&kink| kink < local.to_f64());
        let near = [next.checked_sub(1), Some(next)]
            .into_iter()
            .flatten()
            .filter_map(|index| self.kinks.get(index));
        match near.copied().find(|&kink| local.since(kink).abs() <= slack) {
            Some(kink) => (Time::new(kink), turns),
            None => (local, turns),
        }
    }
}

/// Copies the components of a quaternion out of an array of a length that is not known to be four.
fn array<const D: usize>(parts: [f64; D]) -> [f64; 4] {
    core::array::from_fn(|d| parts.get(d).copied().unwrap_or(0.0))
}

impl<T: Real, const D: usize> Motion<T, D> for NodeMotion<D> {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D> {
        let (t, turns) = self.local(t, side);
        let mut series = [[0.0; 3]; 4];
        if wanted.contains(Derivatives::ACCELERATION) {
            series = self.chain.at::<3>(t, side).map(|jet| jet.0);
        } else if wanted.contains(Derivatives::VELOCITY) {
            series = self.chain.at::<2>(t, side).map(|Jet([x, v])| [x, v, 0.0]);
        } else if wanted.contains(Derivatives::POSITION) {
            series = self.chain.at::<1>(t, side).map(|Jet([x])| [x, 0.0, 0.0]);
        }
        if self.flips && turns % 2.0 != 0.0 {
            series = series.map(|part| part.map(|order| -order));
        }
        let mut sample = Sample::zero();
        if wanted.contains(Derivatives::POSITION) {
            sample.position = core::array::from_fn(|d| T::from_f64(series[d][0]));
        }
        if wanted.contains(Derivatives::VELOCITY) {
            sample.velocity = core::array::from_fn(|d| T::from_f64(series[d][1]));
        }
        if wanted.contains(Derivatives::ACCELERATION) {
            sample.acceleration = core::array::from_fn(|d| T::from_f64(2.0 * series[d][2]));
        }
        sample
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        let none = f64::NEG_INFINITY;
        if !self.looped {
            let index = self.kinks.partition_point(|&kink| kink < t);
            return Some(self.kinks[..index].last().copied().unwrap_or(none));
        }
        if self.kinks.is_empty() || !t.is_finite() {
            return Some(none);
        }
        let period = self.duration;
        let turns = (t / period).floor();
        let slack = 4.0 * f64::EPSILON * (t.abs() + period);
        let found = [turns + 1.0, turns, turns - 1.0, turns - 2.0].into_iter().find_map(|turn| {
            let kinks = self.kinks.iter().rev();
            kinks.map(|&kink| kink + turn * period).find(|&kink| kink < t - slack)
        });
        Some(found.unwrap_or(none))
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        if !self.looped {
            let index = self.kinks.partition_point(|&kink| kink <= t);
            return self.kinks.get(index).copied();
        }
        if self.kinks.is_empty() || !t.is_finite() {
            return None;
        }
        let period = self.duration;
        let turns = (t / period).floor();
        // A kink that is equal to `t` up to rounding does not count.
        let slack = 4.0 * f64::EPSILON * (t.abs() + period);
        [turns - 1.0, turns, turns + 1.0, turns + 2.0].into_iter().find_map(|turn| {
            self.kinks.iter().map(|&kink| kink + turn * period).find(|&kink| t + slack < kink)
        })
    }

    // No bound: between the kinks of all channels, features are as wide as the distance between
    // keys.
    fn longest_step(&self, _: f64, _: f64) -> Option<f64> {
        Some(f64::INFINITY)
    }

    fn rest_until(&self, t: f64) -> f64 {
        let rest = |t: f64| self.chain.rest_until(t);
        if !self.looped || !t.is_finite() {
            return rest(t);
        }
        if rest(0.0) == f64::INFINITY {
            return f64::INFINITY;
        }
        // Limited to the current period; callers repeat the call at its end.
        let turn = (t / self.duration).floor() * self.duration;
        let until = Real::min(rest(t - turn), self.duration) + turn;
        let slack = 4.0 * f64::EPSILON * (until.abs() + self.duration);
        Real::max(t, until - slack)
    }
}
