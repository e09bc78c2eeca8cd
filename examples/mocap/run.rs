//! Swings a pendulum through a whole clip.

use pendulum_runtime::motion::Side;
use pendulum_runtime::prelude::*;
use pendulum_runtime::time::Time;

/// The longest step in seconds: a few hundredths of the quickest swing.
const STEP: f64 = 1.0 / 960.0;

/// A pendulum at the times it was asked for.
#[derive(Clone, Debug)]
pub(crate) struct Swing {
    /// θ in radians.
    pub(crate) angles: Vec<f64>,
    /// θ̇ in rad/s.
    pub(crate) speeds: Vec<f64>,
}

/// From rest, through `times`, by the classical method of Runge and Kutta; steps end on kinks.
pub(crate) fn swing<D: Dynamics<1, Scalar = f64>>(dynamics: &D, times: &[f64]) -> Swing {
    let mut swing = Swing { angles: vec![0.0], speeds: vec![0.0] };
    let (mut t, mut q, mut v) = (times[0], 0.0, 0.0);
    let mut kink = dynamics.next_kink(t);
    for &end in &times[1..] {
        while t < end {
            let stop = kink.filter(|&kink| kink < end).unwrap_or(end);
            let count = ((stop - t) / STEP).ceil().max(1.0);
            let h = (stop - t) / count;
            for step in 0..count as usize {
                (q, v) = rk4(dynamics, t + step as f64 * h, h, q, v);
            }
            t = stop;
            if Some(t) == kink {
                [v] = dynamics.across_kink(Time::new(t), &[q], &[v]);
                kink = dynamics.next_kink(t);
            }
        }
        swing.angles.push(q);
        swing.speeds.push(v);
    }
    swing
}

fn rk4<D: Dynamics<1, Scalar = f64>>(dynamics: &D, t: f64, h: f64, q: f64, v: f64) -> (f64, f64) {
    let at = |c: f64, side, q, v| dynamics.accelerations_at(Time::new(t) + c * h, side, &[q], &[v])[0];
    let a1 = at(0.0, Side::After, q, v);
    let (q2, v2) = (q + h / 2.0 * v, v + h / 2.0 * a1);
    let a2 = at(0.5, Side::After, q2, v2);
    let (q3, v3) = (q + h / 2.0 * v2, v + h / 2.0 * a2);
    let a3 = at(0.5, Side::After, q3, v3);
    let (q4, v4) = (q + h * v3, v + h * a3);
    let a4 = at(1.0, Side::Before, q4, v4);
    (q + h / 6.0 * (v + 2.0 * (v2 + v3) + v4), v + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4))
}
