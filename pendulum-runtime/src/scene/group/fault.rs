//! Causes of states that are not finite.

use crate::error::{Error, Quantity};
use crate::integrate::field::diagnose::suspects;
use crate::integrate::field::{coordinate, first_in_inputs};
use crate::motion::Side;
use crate::scalar::{Float, Lane};
use crate::scene::group::constraints::OnJoints;
use crate::scene::group::joints::inputs_at;
use crate::scene::lanes::detached::Detached;
use crate::scene::sampling::joint::JointSlot;
use crate::scene::system::SceneSystem;
use crate::system::{Purpose, scalar_time};
use crate::time::Time;

/// Returns the error of the tick of length `step` that begins at `t` with the state of `detached`.
/// The error names the value that is not finite, or the violated constraint.
pub(super) fn diagnose<S: SceneSystem<T, N>, T: Lane + Float, const N: usize>(
    system: &S,
    joint_slots: &[JointSlot<T>],
    detached: &Detached<T, N>,
    t: f64,
    step: f64,
) -> Error {
    let [q, _, v, ..] = &detached.state;
    let on_joints = OnJoints { system, joint_slots, joints: &detached.joints };
    if let Some(lost) = on_joints.lost(t, q, v, step) {
        return lost;
    }
    let time = Time::new(t);
    let inputs = inputs_at::<S, T, N>(
        joint_slots,
        &detached.joints,
        time,
        Side::After,
        Purpose::Accelerations,
        false,
    );
    let mut what = first_in_inputs(&S::FACTS, &inputs);
    if what.is_none() {
        let a = system.accelerations(scalar_time(time), q, v, &inputs);
        what = a
            .iter()
            .position(|a| !a.is_finite())
            .map(|index| Quantity::Acceleration(coordinate(&S::FACTS, index)));
    }
    // If all values are finite at the beginning of the tick, the velocity diverges within the tick.
    let fastest = |i: &usize, j: &usize| v[*i].to_f64().abs().total_cmp(&v[*j].to_f64().abs());
    let what = what.unwrap_or_else(|| {
        Quantity::Velocity(coordinate(&S::FACTS, (0..N).max_by(fastest).unwrap_or(0)))
    });
    let suspects = if let Quantity::Acceleration(_) = what { suspects(system) } else { Vec::new() };
    Error::NotFinite { t, what, suspects }
}
