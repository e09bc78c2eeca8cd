//! The motion of a node: its position or its orientation in the world under moving parents.

use super::jet::{Jet, product, turned};
use super::track::{Track, Turn};
use pendulum_core::motion::{Clip, Derivatives, Motion, MotionError, Sample, Side};
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
}

impl<const D: usize> NodeMotion<D> {
    pub(super) fn new(chain: Chain, duration: f64) -> Self {
        let kinks = chain.kinks();
        Self { chain, kinks, duration }
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
    pub fn looped(self) -> Result<Clip<Self>, MotionError> {
        let period = self.duration;
        Clip::new(self).looped(period)
    }
}

impl<T: Real, const D: usize> Motion<T, D> for NodeMotion<D> {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D> {
        let mut series = [[0.0; 3]; 4];
        if wanted.contains(Derivatives::ACCELERATION) {
            series = self.chain.at::<3>(t, side).map(|jet| jet.0);
        } else if wanted.contains(Derivatives::VELOCITY) {
            series = self.chain.at::<2>(t, side).map(|Jet([x, v])| [x, v, 0.0]);
        } else if wanted.contains(Derivatives::POSITION) {
            series = self.chain.at::<1>(t, side).map(|Jet([x])| [x, 0.0, 0.0]);
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
        let index = self.kinks.partition_point(|&kink| kink < t);
        Some(self.kinks[..index].last().copied().unwrap_or(f64::NEG_INFINITY))
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        let index = self.kinks.partition_point(|&kink| kink <= t);
        self.kinks.get(index).copied()
    }

    // No bound: between the kinks of all channels, features are as wide as the distance between
    // keys.
    fn longest_step(&self, _: f64, _: f64) -> Option<f64> {
        Some(f64::INFINITY)
    }

    fn rest_until(&self, t: f64) -> f64 {
        self.chain.rest_until(t)
    }
}
