//! The tail in a scene.

use crate::{BONES, LENGTH, SPRING, SceneError, Tail, head};
use pendulum_runtime::attitude::Attitude;
use pendulum_runtime::motion::{Function, Still, Turning};
use pendulum_runtime::scene::Scene;
use std::f64::consts::PI;

/// Returns the tail at the ends of the frames.
pub(crate) fn run(times: &[f64]) -> Result<Vec<(f64, Tail)>, SceneError> {
    let mut scene = Scene::<f64>::new(240.0)?;
    let motion = Function::new(|t| [head(t)[0], 0.0, 0.0])
        .velocity(|t| [head(t)[1], 0.0, 0.0])
        .acceleration(|t| [head(t)[2], 0.0, 0.0]);
    // A chain begins along the axis y of its frame, which points down here.
    let down = Turning::new([0.0, 0.0, 1.0], Still::new([PI]));
    let joint = (scene.joint(motion), scene.joint(down));
    let tail = scene.hang_chain(joint, vec![SPRING.bone(LENGTH)?; BONES])?;
    let (mut all, mut last) = (Vec::new(), 0.0);
    for &t in times {
        scene.advance(t - last)?;
        last = t;
        let alpha = scene.alpha();
        let [x, y, _] = scene.joint_pose(joint.0, alpha);
        let mut ends = [[x, y]; BONES + 1];
        for (k, &bone) in tail.iter().enumerate() {
            let bone = Attitude::from_quaternion(scene.pose(bone, alpha)).to_matrix();
            ends[k + 1] = [0, 1].map(|i| ends[k][i] + LENGTH * bone[(i, 1)]);
        }
        // Poses are between the last two ticks, a tick late.
        all.push((t, ends));
    }
    Ok(all)
}
