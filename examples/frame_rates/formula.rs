//! The tail by the formula of VRMC_springBone 1.0.

use crate::{BONES, LENGTH, SPRING, Tail, head};

/// Returns the tail at the ends of the frames.
pub(crate) fn run(times: &[f64]) -> Vec<(f64, Tail)> {
    let rest: Tail = core::array::from_fn(|k| [head(0.0)[0], -(k as f64) * LENGTH]);
    let (mut before, mut now, mut all, mut last) = (rest, rest, Vec::new(), 0.0);
    for &t in times {
        let dt = t - last;
        last = t;
        let mut next: Tail = [[head(t)[0], 0.0]; BONES + 1];
        // The direction of rest of a bone is that of its parent.
        let mut direction = [0.0, -1.0];
        for k in 1..=BONES {
            let free = [0, 1].map(|i| {
                let inertia = (now[k][i] - before[k][i]) * (1.0 - SPRING.drag_force);
                let gravity = SPRING.gravity_power * SPRING.gravity_dir[i];
                now[k][i] + inertia + dt * (SPRING.stiffness * direction[i] + gravity)
            });
            let along = [0, 1].map(|i| free[i] - next[k - 1][i]);
            let length = along[0].hypot(along[1]);
            direction = along.map(|x| x / length);
            next[k] = [0, 1].map(|i| next[k - 1][i] + LENGTH * direction[i]);
        }
        (before, now) = (now, next);
        all.push((t, next));
    }
    all
}
