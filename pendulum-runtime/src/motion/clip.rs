//! Motions sampled at a frame rate.

use crate::motion::analytic::Analytic;
use crate::motion::catmull_rom::CatmullRom;
use crate::motion::error::MotionError;
use crate::motion::linear::Linear;
use crate::motion::piecewise::{Piecewise, analytic_pieces};
use crate::motion::prescribed::Motion;
use crate::motion::sample::{Derivatives, Sample, Side};
use crate::motion::spline::Spline;
use crate::scalar::Real;
use crate::time::Time;

/// A motion sampled at a frame rate, such as a captured one.
///
/// Second differences of captured motion are noise: decimate the frames before interpolating them
/// with a spline, or interpolate them linearly, with small jumps of the velocity.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip<const D: usize> {
    frames: Vec<[f64; D]>,
    times: Vec<f64>,
    curve: Curve<D>,
}

#[derive(Clone, Debug, PartialEq)]
enum Curve<const D: usize> {
    Linear(Linear<D>),
    CatmullRom(CatmullRom<D>),
    Spline(Spline<D>),
}

/// The interpolation between the frames of a clip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// A Catmull–Rom curve.
    CatmullRom,
    /// A natural cubic spline.
    #[default]
    Spline,
}

impl<const D: usize> Clip<D> {
    /// Creates a motion from `frames` at `rate` frames per second, the first at t = 0. Only every
    /// `every`-th frame and the last are kept.
    ///
    /// # Errors
    /// If there are no frames, if the rate is not positive, if `every` is zero, or if a number is
    /// not finite.
    pub fn new(
        rate: f64,
        frames: &[[f64; D]],
        every: usize,
        interpolation: Interpolation,
    ) -> Result<Self, MotionError> {
        if !(0.0 < rate && rate.is_finite()) {
            return Err(MotionError::Rate(rate));
        }
        if every == 0 {
            return Err(MotionError::Every);
        }
        let last = frames.len().checked_sub(1).ok_or(MotionError::NoKeys)?;
        let mut kept: Vec<usize> = (0..=last).step_by(every).collect();
        if kept.last() != Some(&last) {
            // Merges a short last piece with the piece before it.
            if 1 < kept.len() && (last - kept[kept.len() - 1]) * 2 < every {
                kept.pop();
            }
            kept.push(last);
        }
        let times: Vec<f64> = kept.iter().map(|&frame| frame as f64 / rate).collect();
        let frames: Vec<[f64; D]> = kept.iter().map(|&frame| frames[frame]).collect();
        let curve = match interpolation {
            Interpolation::Linear => Curve::Linear(Linear::new(&times, &frames)?),
            Interpolation::CatmullRom => Curve::CatmullRom(CatmullRom::new(&times, &frames)?),
            Interpolation::Spline => Curve::Spline(Spline::natural(&times, &frames)?),
        };
        Ok(Self { frames, times, curve })
    }

    /// Returns the kept frames.
    pub fn frames(&self) -> &[[f64; D]] {
        &self.frames
    }

    /// Returns the cubic pieces of the curve.
    pub(super) fn pieces(&self) -> &Piecewise<D> {
        match &self.curve {
            Curve::Linear(curve) => curve.pieces(),
            Curve::CatmullRom(curve) => curve.pieces(),
            Curve::Spline(curve) => curve.pieces(),
        }
    }

    /// Returns the times of the kept frames in seconds.
    pub fn times(&self) -> &[f64] {
        &self.times
    }
}

impl<T: Real, const D: usize> Motion<T, D> for Clip<D> {
    const HAS: Derivatives = Derivatives::ALL;

    #[inline]
    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, D> {
        match &self.curve {
            Curve::Linear(curve) => curve.sample(t, side, wanted),
            Curve::CatmullRom(curve) => curve.sample(t, side, wanted),
            Curve::Spline(curve) => curve.sample(t, side, wanted),
        }
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        match &self.curve {
            Curve::Linear(curve) => Motion::<T, D>::next_kink(curve, t),
            Curve::CatmullRom(curve) => Motion::<T, D>::next_kink(curve, t),
            Curve::Spline(curve) => Motion::<T, D>::next_kink(curve, t),
        }
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        Some(self.pieces().last_kink(t).unwrap_or(f64::NEG_INFINITY))
    }

    fn longest_step(&self, t: f64, widths: f64) -> Option<f64> {
        match &self.curve {
            Curve::Linear(curve) => Motion::<T, D>::longest_step(curve, t, widths),
            Curve::CatmullRom(curve) => Motion::<T, D>::longest_step(curve, t, widths),
            Curve::Spline(curve) => Motion::<T, D>::longest_step(curve, t, widths),
        }
    }

    fn analytic(&self) -> Option<&dyn Analytic<T, D>> {
        Some(self)
    }

    fn rest_until(&self, t: f64) -> f64 {
        match &self.curve {
            Curve::Linear(curve) => Motion::<T, D>::rest_until(curve, t),
            Curve::CatmullRom(curve) => Motion::<T, D>::rest_until(curve, t),
            Curve::Spline(curve) => Motion::<T, D>::rest_until(curve, t),
        }
    }
}

analytic_pieces!(Clip);
