//! Simulates the feathers until their motion repeats with the dance, and records one period.

use crate::dance::PERIOD;
use crate::feather::{Feather, frequency};
use crate::rig::{Angle, Rig};
use indicatif::ProgressBar;
use pendulum_runtime::motion::{Derivatives, Motion, Sample, Side};
use pendulum_runtime::scene::{Handle, Scene};
use std::error::Error;

/// Frames per second and per period, and ticks of the scene per frame.
pub(crate) const RATE: usize = 30;
pub(crate) const FRAMES: usize = RATE * PERIOD as usize;
const TICKS: u32 = 8;

/// The largest difference between the start and the end of a closed loop, in radians.
const CLOSED: f64 = 1e-9;

/// The largest number of loops. Feathers whose loops are not closed after it are used as they are,
/// and the gap is printed.
const LONGEST: u32 = 60;

/// The settings of the page's sliders.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    /// The gravitational acceleration in m/s².
    pub(crate) gravity: f64,
    /// The damping ratio, 1 for critical damping.
    pub(crate) damping: f64,
}

/// The angles of one feather relative to its joint at each frame of a period, in radians from the
/// drawn position.
#[derive(Clone, Debug)]
pub(crate) struct Course(Vec<f64>);

/// The result of a simulation.
#[derive(Clone, Debug)]
pub(crate) struct Baked {
    /// The courses of all feathers for each of the settings.
    pub(crate) courses: Vec<Vec<Course>>,
    pub(crate) loops: u32,
    /// The largest difference between the start and the end of the last loop, in radians.
    pub(crate) gap: f64,
}

impl Course {
    pub(crate) fn swings(&self) -> &[f64] {
        &self.0
    }
}

/// Simulates the feathers under several settings at once, with separate joints for each of the
/// settings.
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

    // Angles are relative to the joints, which also turn.
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
