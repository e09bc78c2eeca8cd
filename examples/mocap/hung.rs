//! A feather that hangs from a joint, and its swing during the clip.

use crate::hand::Hand;
use crate::{Tag, TagOutputs};
use indicatif::ProgressBar;
use pendulum_runtime::body::Polygon;
use pendulum_runtime::motion::{Curve, Derivatives, Side};
use pendulum_runtime::prelude::*;
use pendulum_runtime::time::Time;
use std::error::Error;

/// The area density of thin leather in kg/m².
const DENSITY: f64 = 1.1;

/// The time in seconds in which friction reduces a swing to 1/e. It is short because the joints
/// accelerate with many times gravity.
const DECAY: f64 = 0.3;

/// The relative and the absolute tolerance, the latter in radians.
const TOLERANCE: f64 = 1e-10;

/// The right half of a feather of length one that hangs from the origin, from the quill down.
const FEATHER: [[f64; 2]; 9] = [
    [0.012, 0.0],
    [0.018, -0.16],
    [0.09, -0.24],
    [0.14, -0.36],
    [0.16, -0.52],
    [0.15, -0.68],
    [0.11, -0.84],
    [0.05, -0.95],
    [0.0, -1.0],
];

/// The position of a pendulum on the body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) label: &'static str,
    /// The possible names of the joint, in lower-case letters only.
    pub(crate) names: &'static [&'static str],
    /// The length in metres.
    pub(crate) length: f64,
    pub(crate) color: &'static str,
}

/// A pendulum and its swings.
#[derive(Clone, Debug)]
pub(crate) struct Hung {
    pub(crate) place: Place,
    pub(crate) joint: usize,
    pub(crate) outline: Vec<[f64; 2]>,
    /// The mass in kilograms.
    pub(crate) mass: f64,
    /// The positions of the joint on its spline.
    pub(crate) pivot: Vec<[f64; 2]>,
    /// The positions of the tip, for the swing on the spline.
    pub(crate) tips: Vec<[f64; 2]>,
    pub(crate) spline: Swing,
    pub(crate) linear: Swing,
    /// The swing on the spline by the hand-written equation.
    pub(crate) hand: Swing,
    /// The largest difference between the generated and the hand-written acceleration along the
    /// swing on the spline, in rad/s².
    pub(crate) difference: f64,
    /// The largest acceleration along this swing, in rad/s².
    pub(crate) acceleration: f64,
}

/// θ and θ̇ at the requested times.
#[derive(Clone, Debug)]
pub(crate) struct Swing {
    pub(crate) angles: Vec<f64>,
    pub(crate) speeds: Vec<f64>,
}

impl Hung {
    /// Simulates a feather on a joint that passes through `keys` at `rate` keys a second. The
    /// feather starts at rest, and the swing is sampled at the given times.
    pub(crate) fn swing(
        place: Place,
        joint: usize,
        keys: &[[f64; 2]],
        rate: f64,
        times: &[f64],
        bar: &ProgressBar,
    ) -> Result<Self, Box<dyn Error>> {
        let outline = feather(place.length);
        let body = Polygon::new(&outline)?.body(DENSITY)?;
        let damping = 2.0 * body.inertia() / DECAY;
        let frames: Vec<f64> = (0..keys.len()).map(|key| key as f64 / rate).collect();
        let (curve, lines) = (Curve::spline(&frames, keys)?, Curve::linear(&frames, keys)?);

        let tag = || Tag::new(body, [0.0, -place.length], damping);
        let generated = tag().driven_by(curve.clone());
        let by_hand = Driven::new(Hand { body, damping, g: 9.81 }, (curve.clone(),));
        let spline = Swing::run(&generated, times, bar)?;
        let linear = Swing::run(&tag().driven_by(lines), times, bar)?;
        let hand = Swing::run(&by_hand, times, bar)?;

        let (mut difference, mut acceleration) = (0.0f64, 0.0f64);
        let mut tips = Vec::new();
        for ((&t, &q), &v) in times.iter().zip(&spline.angles).zip(&spline.speeds) {
            tips.push(generated.tip(t, &[q], &[v]));
            let [ours] = generated.accelerations_at(Time::new(t), Side::Before, &[q], &[v]);
            let [theirs] = by_hand.accelerations_at(Time::new(t), Side::Before, &[q], &[v]);
            difference = difference.max((ours - theirs).abs());
            acceleration = acceleration.max(ours.abs());
        }
        let at = |&t: &f64| {
            Motion::<f64, 2>::sample(&curve, Time::new(t), Side::Before, Derivatives::POSITION)
                .position
        };
        let pivot = times.iter().map(at).collect();
        Ok(Self {
            place,
            joint,
            outline,
            mass: body.mass,
            pivot,
            tips,
            spline,
            linear,
            hand,
            difference,
            acceleration,
        })
    }
}

impl Swing {
    /// Integrates from rest and samples the swing at all `times`.
    fn run<D: Dynamics<1, Scalar = f64>>(
        dynamics: &D,
        times: &[f64],
        bar: &ProgressBar,
    ) -> Result<Self, Box<dyn Error>>
    where
        Dop853: pendulum_runtime::integrate::method::Method<D, 1>,
    {
        let span = (times[0], times[times.len() - 1]);
        let solution = solve(dynamics, span, [0.0], [0.0])
            .method(Dop853)
            .rtol(TOLERANCE)
            .atol(TOLERANCE)
            .t_eval(times)
            .run()
            .map_err(|failure| failure.to_string())?;
        bar.inc(1);
        let flat = |values: &[[f64; 1]]| values.iter().map(|value| value[0]).collect();
        Ok(Self { angles: flat(&solution.q), speeds: flat(&solution.v) })
    }

    /// Returns the largest angle.
    pub(crate) fn peak(&self) -> f64 {
        self.angles.iter().fold(0.0, |peak, angle| peak.max(angle.abs()))
    }

    /// Returns the largest difference of the angles and their difference at the end.
    pub(crate) fn apart(&self, other: &Self) -> (f64, f64) {
        let differences = || self.angles.iter().zip(&other.angles).map(|(a, b)| (a - b).abs());
        (differences().fold(0.0, f64::max), differences().next_back().unwrap_or(0.0))
    }
}

/// Returns the outline of a feather that hangs from the origin by its quill.
fn feather(length: f64) -> Vec<[f64; 2]> {
    let left = FEATHER.iter().rev().skip(1).map(|&[x, y]| [-x, y]);
    FEATHER.into_iter().chain(left).map(|point| point.map(|value| value * length)).collect()
}

#[cfg(test)]
mod tests {
    use super::{DENSITY, Hand, Polygon, Tag, feather};
    use pendulum_runtime::body::Body;
    use pendulum_runtime::motion::Sample;
    use pendulum_runtime::system::{At, System};

    fn body() -> Body {
        Polygon::new(&feather(0.16)).unwrap().body(DENSITY).unwrap()
    }

    #[test]
    fn a_feather_weighs_some_grams_and_hangs_straight() {
        let body = body();
        assert!(0.002 < body.mass && body.mass < 0.01, "{}", body.mass);
        assert!(body.center[0].abs() < 1e-15 && body.center[1] < -0.05, "{:?}", body.center);
    }

    /// Compares each function of both systems for a body whose centre of mass is not below the
    /// pivot.
    #[test]
    fn the_hand_written_equations_are_the_generated_ones() {
        let body = body().rotated(0.7);
        let (tag, hand) = (Tag::new(body, [0.0; 2], 3e-4), Hand { body, damping: 3e-4, g: 9.81 });
        for k in 0..50 {
            let k = f64::from(k);
            let (t, q, v) = (0.1 * k, [0.37 * k - 9.0], [11.0 - 0.45 * k]);
            let x = (Sample {
                position: [0.1 * k, 1.0],
                velocity: [2.0 - 0.1 * k, 0.2 * k],
                acceleration: [k - 25.0, 9.0 - k],
            },);
            let at = At { t, q: &q, v: &v, inputs: &x };
            let pairs = [
                (tag.accelerations(at)[0], hand.accelerations(at)[0]),
                (tag.forces(at)[0], hand.forces(at)[0]),
                (tag.energy(at), hand.energy(at)),
                (tag.power(at), hand.power(at)),
                (tag.momenta(at)[0], hand.momenta(at)[0]),
                (tag.velocities(t, &q, &v, &x)[0], hand.velocities(t, &q, &v, &x)[0]),
                (tag.momentum_rates(at)[0], hand.momentum_rates(at)[0]),
                (tag.mass_matrix(at)[(0, 0)], hand.mass_matrix(at)[(0, 0)]),
            ];
            for (index, (ours, theirs)) in pairs.into_iter().enumerate() {
                assert!(
                    (ours - theirs).abs() < 1e-12 * ours.abs().max(1e-3),
                    "{index}: {ours} and {theirs}"
                );
            }
        }
    }
}
