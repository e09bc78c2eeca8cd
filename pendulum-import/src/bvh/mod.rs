//! Motions from BVH files, a format of motion capture: a skeleton with offsets and channels, and a
//! row of numbers for each frame.
//!
//! ```
//! use pendulum_runtime::import::bvh::Bvh;
//! use pendulum_runtime::motion::{Derivatives, Motion, Projected, Sample, Side};
//! use pendulum_runtime::time::Time;
//!
//! let text = "HIERARCHY
//! ROOT shoulder {
//!   OFFSET 0 140 0
//!   CHANNELS 1 Zrotation
//!   JOINT hand { OFFSET 60 0 0 CHANNELS 0 }
//! }
//! MOTION
//! Frames: 3
//! Frame Time: 0.5
//! 0
//! 90
//! 0";
//! let arm = Bvh::read(text)?;
//! // The raised hand, in centimetres as in the file.
//! assert!((arm.pose(1)[1][1] - 200.0).abs() < 1e-12);
//! // Its orientation, for a system with a `driven` rotation: a quarter turn about z.
//! let turn = arm.orientation("hand")?;
//! let at: Sample<f64, 4> = turn.sample(Time::new(0.5), Side::After, Derivatives::POSITION);
//! let [w, x, y, z] = at.position;
//! assert!((w - z).abs() + x.abs() + y.abs() < 1e-15);
//! // The joint of a pendulum in the plane: the hand in metres, seen along z.
//! let hand = Projected::new(arm.motion("hand", 0.01)?, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The position channels of a joint replace its offset. Rotations are applied in the order of the
//! channels: `Zrotation Yrotation Xrotation` is R_z R_y R_x, in degrees. Meredith and Maddock,
//! "Motion Capture File Formats Explained" (2001), section 3.
//!
//! Many clips do not begin with their motion: those of the CMU database, converted to BVH, begin
//! with a T-pose one frame before it. A curve through both swings about for a dozen frames, and what
//! hangs on it flies away. [`Bvh::jumps`] finds such frames, [`Bvh::cut`] leaves them out:
//!
//! ```no_run
//! # use pendulum_runtime::import::bvh::Bvh;
//! let mut clip = Bvh::open("01_01.bvh")?;
//! if clip.jumps() == [1] {
//!     clip = clip.cut(1..)?;
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod error;
mod read;
#[cfg(test)]
mod tests;

pub use error::BvhError;
pub use read::SkeletonJoint;

use crate::contents;
use core::ops::{Bound, RangeBounds};
use pendulum_core::attitude::Attitude;
use pendulum_core::motion::{Attitudes, Curve};
use pendulum_core::scalar::Real;
use read::{Channel, Reader};
use std::path::Path;

/// The greatest number of names in an error.
const LISTED: usize = 12;

/// A skeleton and its motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Bvh {
    joints: Vec<SkeletonJoint>,
    frame_time: f64,
    /// The values of the channels of all joints, frame by frame.
    rows: Vec<f64>,
    /// The number of channels.
    width: usize,
    note: Option<BvhError>,
}

impl Bvh {
    /// Reads a file.
    ///
    /// # Errors
    /// If the file cannot be opened or is not text, and the errors of [`read`](Self::read).
    pub fn open(path: impl AsRef<Path>) -> Result<Self, BvhError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let text = contents(path, u64::MAX)
            .and_then(|bytes| String::from_utf8(bytes).map_err(std::io::Error::other));
        let text = text.map_err(|error| {
            BvhError::of_call(format!("{name}: {error}"), "give the path of a BVH file")
        })?;
        let mut read = Self::read(&text).map_err(|error| error.within(&name))?;
        read.note = read.note.map(|note| note.within(&name));
        Ok(read)
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// The first error in the text, with its line and column.
    pub fn read(text: &str) -> Result<Self, BvhError> {
        let mut reader = Reader::new(text);
        let joints = reader.hierarchy()?;
        let width = joints.iter().map(|joint| joint.channels.len()).sum();
        let (frame_time, rows, note) = reader.motion(width)?;
        Ok(Self { joints, frame_time, rows, width, note })
    }

    /// Returns what the file contradicts itself in, if it is read all the same: it may have one row
    /// more than it announces, which is left out.
    pub fn note(&self) -> Option<&BvhError> {
        self.note.as_ref()
    }

    /// Returns the joints and the end sites, with parents before their children.
    pub fn joints(&self) -> &[SkeletonJoint] {
        &self.joints
    }

    /// Returns the index of the first joint of this name.
    ///
    /// # Errors
    /// If there is no joint of this name; the error lists the existing names.
    pub fn joint(&self, name: &str) -> Result<usize, BvhError> {
        self.joints.iter().position(|joint| joint.name == name).ok_or_else(|| {
            let names: Vec<String> = self
                .joints
                .iter()
                .filter(|joint| !joint.end)
                .map(|joint| format!("`{}`", joint.name))
                .collect();
            let listed = names[..names.len().min(LISTED)].join(", ");
            let more = match names.len().saturating_sub(LISTED) {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            let what = format!("no joint is called `{name}`; there are {listed}{more}");
            BvhError::of_call(what, "give one of these names")
        })
    }

    /// Returns the number of frames, at least one.
    pub fn frames(&self) -> usize {
        self.rows.len() / self.width
    }

    /// Returns the time between two frames in seconds.
    pub fn frame_time(&self) -> f64 {
        self.frame_time
    }

    /// Returns the clip of these frames only, of which the first is at t = 0.
    ///
    /// # Errors
    /// If there are no such frames.
    pub fn cut(mut self, frames: impl RangeBounds<usize>) -> Result<Self, BvhError> {
        let count = self.frames();
        let start = match frames.start_bound() {
            Bound::Included(&first) => Some(first),
            Bound::Excluded(&before) => before.checked_add(1),
            Bound::Unbounded => Some(0),
        };
        let end = match frames.end_bound() {
            Bound::Included(&last) => last.checked_add(1),
            Bound::Excluded(&end) => Some(end),
            Bound::Unbounded => Some(count),
        };
        match start.zip(end).filter(|&(start, end)| start < end && end <= count) {
            Some((start, end)) => {
                self.rows = self.rows[start * self.width..end * self.width].to_vec();
                Ok(self)
            }
            None => Err(BvhError::of_call(
                format!("there are {count} frames, counted from 0, and not all of those asked for"),
                "give a range of at least one frame, as `1..`",
            )),
        }
    }

    /// Returns the frames to which a joint jumps from the frame before, as from a T-pose to the
    /// first frame of a motion. A curve through both is no motion of a body: [`cut`](Self::cut) the
    /// clip there.
    ///
    /// A jump is a step of a joint that is longer than a twentieth of the skeleton, and than five
    /// times the median of the longest steps of up to five frames around it. Motions that begin or
    /// end suddenly are none, because the steps on one side of them are as long.
    pub fn jumps(&self) -> Vec<usize> {
        let distance = |a: &[f64; 3], b: &[f64; 3]| {
            Real::sqrt((0..3).map(|axis| (a[axis] - b[axis]) * (a[axis] - b[axis])).sum::<f64>())
        };
        let mut before = self.pose(0);
        let size = before.iter().map(|at| distance(at, &before[0])).fold(0.0, Real::max);
        let steps: Vec<f64> = (1..self.frames())
            .map(|frame| {
                let pose = self.pose(frame);
                let longest = pose.iter().zip(&before).map(|(a, b)| distance(a, b));
                let longest = longest.fold(0.0, Real::max);
                before = pose;
                longest
            })
            .collect();
        (0..steps.len())
            .filter(|&step| {
                let mut near = steps[step.saturating_sub(2)..steps.len().min(step + 3)].to_vec();
                near.sort_by(f64::total_cmp);
                let median = near[(near.len() - 1) / 2];
                size / 20.0 < steps[step] && 5.0 * median < steps[step]
            })
            .map(|step| step + 1)
            .collect()
    }

    /// Returns the positions of all joints in a frame, or in the last frame if `frame` is too
    /// large, in the file's unit of length.
    pub fn pose(&self, frame: usize) -> Vec<[f64; 3]> {
        self.places(frame).into_iter().map(|place| place.at).collect()
    }

    /// Returns the positions and rotations of all joints in a frame.
    fn places(&self, frame: usize) -> Vec<Place> {
        let row = frame.min(self.frames() - 1) * self.width;
        let mut values = self.rows[row..][..self.width].iter();
        let mut places: Vec<Place> = Vec::with_capacity(self.joints.len());
        for joint in &self.joints {
            let mut local = Place { turn: IDENTITY, at: joint.offset };
            for (channel, &value) in joint.channels.iter().zip(&mut values) {
                match *channel {
                    Channel::Position(axis) => local.at[axis] = value,
                    Channel::Rotation(axis) => {
                        local.turn = product(&local.turn, &rotation(axis, value));
                    }
                }
            }
            places.push(match joint.parent {
                Some(parent) => places[parent].then(&local),
                None => local,
            });
        }
        places
    }

    /// Returns the motion of a joint: a natural cubic spline through its positions at all frames,
    /// with the first frame at t = 0. `metres` is the file's unit of length in metres.
    ///
    /// Captured motion is noisy: a [`Curve`] through every second or fourth pose is smoother. A
    /// spline through a jump is no motion of a body: see [`jumps`](Self::jumps).
    ///
    /// # Errors
    /// If there is no joint of this name, or if `metres` is infinite or NaN.
    pub fn motion(&self, joint: &str, metres: f64) -> Result<Curve<3>, BvhError> {
        let joint = self.joint(joint)?;
        let positions: Vec<[f64; 3]> = (0..self.frames())
            .map(|frame| self.pose(frame)[joint].map(|value| value * metres))
            .collect();
        Curve::spline(&self.times(), &positions).map_err(|error| {
            BvhError::of_call(error.to_string(), "give the metres in a unit of the file, as 0.01")
        })
    }

    /// Returns the orientation of a joint in the world: a spline through its orientations at all
    /// frames, with the first frame at t = 0. In a pose whose channels are all zero, the axes of
    /// every joint are those of the world; an end site has those of its joint.
    ///
    /// # Errors
    /// If there is no joint of this name, or if it turns by almost half a turn from frame to frame,
    /// so that no spline is found.
    pub fn orientation(&self, joint: &str) -> Result<Attitudes, BvhError> {
        let joint = self.joint(joint)?;
        let fail = |what: String| BvhError::of_call(what, "cut the clip at its jumps");
        let attitudes: Result<Vec<Attitude>, _> = (0..self.frames())
            .map(|frame| {
                let rows = self.places(frame)[joint].turn;
                // The columns of a matrix are the axes.
                Attitude::from_matrix([0, 1, 2].map(|axis| rows.map(|row| row[axis])).into())
            })
            .collect();
        let attitudes = attitudes.map_err(|error| fail(error.to_string()))?;
        Attitudes::spline(&self.times(), &attitudes).map_err(|error| fail(error.to_string()))
    }

    /// Returns the times of all frames.
    fn times(&self) -> Vec<f64> {
        let rate = 1.0 / self.frame_time;
        (0..self.frames()).map(|frame| frame as f64 / rate).collect()
    }
}

type Matrix = [[f64; 3]; 3];

const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The position and the rotation of a joint.
struct Place {
    turn: Matrix,
    at: [f64; 3],
}

impl Place {
    fn then(&self, local: &Self) -> Self {
        let mut at = self.at;
        for (value, row) in at.iter_mut().zip(&self.turn) {
            *value += row[0] * local.at[0] + row[1] * local.at[1] + row[2] * local.at[2];
        }
        Self { turn: product(&self.turn, &local.turn), at }
    }
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let mut c = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
        }
    }
    c
}

/// Returns the right-handed rotation about an axis, in degrees.
fn rotation(axis: usize, degrees: f64) -> Matrix {
    // Whole turns are removed first, so that right angles remain exact.
    let (sin, cos) = Real::sin_cos((degrees % 360.0).to_radians());
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut matrix = [[0.0; 3]; 3];
    matrix[axis][axis] = 1.0;
    matrix[next][next] = cos;
    matrix[last][last] = cos;
    matrix[next][last] = -sin;
    matrix[last][next] = sin;
    matrix
}
