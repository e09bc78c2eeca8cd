//! Feathers swing until their motion repeats with the dance, and one period is written down.

use crate::dance::PERIOD;
use crate::feather::{Feather, frequency};
use crate::rig::{Angle, Rig};
use indicatif::ProgressBar;
use pendulum_runtime::motion::{Derivatives, Motion, Sample, Side};
use pendulum_runtime::scene::{Handle, Scene};
use std::error::Error;

/// Frames a second, in a period, and ticks of the scene in a frame.
pub(crate) const RATE: usize = 30;
pub(crate) const FRAMES: usize = RATE * PERIOD as usize;
const TICKS: u32 = 8;

/// A loop is closed when no feather ends farther from where it began, in radians.
const CLOSED: f64 = 1e-9;

/// Feathers that do not close within so many loops are shown as they are; the gap is printed.
const LONGEST: u32 = 60;

/// The settings of the page's sliders.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    /// In m/s².
    pub(crate) gravity: f64,
    /// As a share of critical damping.
    pub(crate) damping: f64,
}

/// One feather through a period, by frames: its angle on its joint, in radians from how it is
/// drawn.
#[derive(Clone, Debug)]
pub(crate) struct Course(Vec<f64>);

/// The result.
#[derive(Clone, Debug)]
pub(crate) struct Baked {
    /// By settings, then by feathers.
    pub(crate) courses: Vec<Vec<Course>>,
    pub(crate) loops: u32,
    /// The largest difference between beginning and end of the last loop, in radians.
    pub(crate) gap: f64,
}

impl Course {
    pub(crate) fn swings(&self) -> &[f64] {
        &self.0
    }
}

/// Lets the feathers swing under several settings at once, each on joints of its own frame.
pub(crate) fn swing(
    rig: &Rig<'_>,
    settings: &[Settings],
    bar: &ProgressBar,
) -> Result<Baked, Box<dyn Error>> {
    let mut scene = Scene::<f64>::new((RATE as u32 * TICKS).into())?;
    scene.set_tolerance(1e-6)?;
    let joints: Vec<_> = rig
        .keyed
        .iter()
        .map(|keyed| (scene.joint(keyed.place.clone()), scene.joint(keyed.angle.clone())))
        .collect();
    let mut handles: Vec<Handle<Feather, 1>> = Vec::new();
    for &Settings { gravity, damping } in settings {
        for (number, hung) in rig.feathers.iter().enumerate() {
            let swings = frequency(&hung.joint.name, number);
            let feather = Feather::swinging(hung.body, hung.quill, swings, damping, gravity);
            let start = angle(&rig.keyed[hung.on].angle, 0.0);
            handles.push(scene.hang(joints[hung.on], feather, [start], [0.0])?);
        }
    }

    // One loop at a time, so that the bar can move.
    let (mut gap, mut loops) = (f64::INFINITY, 0);
    bar.set_position(0);
    bar.set_length(2);
    while CLOSED < gap && loops < LONGEST {
        let closed = scene.close_loop(FRAMES as u32 * TICKS, 1, CLOSED)?;
        (gap, loops) = (closed.gap, loops + closed.turns);
        bar.set_length(u64::from(loops) + 2);
        bar.inc(1);
    }
    let mut angles = vec![Vec::with_capacity(FRAMES); handles.len()];
    for _ in 0..FRAMES {
        for (angles, &handle) in angles.iter_mut().zip(&handles) {
            angles.push(scene.state(handle).0[0]);
        }
        let failed = scene.advance_ticks(TICKS).failed;
        if failed != 0 {
            return Err(format!(
                "{failed} feathers failed at {} s: {}",
                scene.time(),
                scene.faults()[0]
            )
            .into());
        }
    }
    bar.inc(1);

    // Seen from the joint on which it hangs, which turns too.
    let turns: Vec<Vec<f64>> = rig
        .keyed
        .iter()
        .map(|keyed| {
            (0..FRAMES).map(|frame| angle(&keyed.angle, frame as f64 / RATE as f64)).collect()
        })
        .collect();
    let mut all = angles.into_iter();
    let courses = settings
        .iter()
        .map(|_| {
            let owl = rig.feathers.iter().zip(&mut all);
            owl.map(|(hung, angles)| {
                Course(angles.iter().zip(&turns[hung.on]).map(|(a, b)| a - b).collect())
            })
            .collect()
        })
        .collect();
    Ok(Baked { courses, loops, gap })
}

fn angle(angle: &Angle, t: f64) -> f64 {
    let sample: Sample<f64, 1> = angle.sample(t.into(), Side::After, Derivatives::POSITION);
    sample.position[0]
}
