//! The spring bones of VRM.

use crate::{AMPLITUDE, LENGTH, OMEGA, SECONDS, Swing};

/// Simulates the formula of VRMC_springBone 1.0: stiffness 1, drag force 0.1, no gravity.
pub(crate) fn spring_bone(rate: u32) -> Swing {
    let dt = 1.0 / f64::from(rate);
    let (mut current, mut previous, mut curve) = ([0.0, -LENGTH], [0.0, -LENGTH], Vec::new());
    for frame in 1..=SECONDS * rate {
        let t = f64::from(frame) * dt;
        let hand = AMPLITUDE * (OMEGA * t).sin();
        let inertia = [0, 1].map(|i| (current[i] - previous[i]) * (1.0 - 0.1));
        let next = [current[0] + inertia[0] - hand, current[1] + inertia[1] - dt];
        let length = next[0].hypot(next[1]);
        previous = current;
        current = [hand + LENGTH * next[0] / length, LENGTH * next[1] / length];
        curve.push((t, (current[0] - hand).atan2(-current[1]).to_degrees()));
    }
    let late = curve.iter().filter(|(t, _)| f64::from(SECONDS) / 2.0 < *t);
    let peak = late.fold(0.0f64, |peak, (_, angle)| peak.max(angle.abs()));
    (curve, peak)
}
