//! Checks of joints and states, and the inputs of a system on its joints.

use crate::error::Coordinate;
use crate::motion::{Derivatives, Side};
use crate::scalar::{Float, Lane};
use crate::scene::error::SceneError;
use crate::scene::sampling::joint::JointSlot;
use crate::scene::system::{Layout, ORDERS, needed};
use crate::scene::system::SceneSystem;
use crate::scene::system::{By, FromNumbers};
use crate::system::{Facts, Purpose};
use crate::time::Time;

/// Returns the inputs of a system on joints, with the derivatives that `purpose` needs. If
/// `at_rest` is `true`, velocities and accelerations are zero.
pub(crate) fn inputs_at<S: SceneSystem<T, N>, T: Lane + Float, const N: usize>(
    joint_slots: &[JointSlot<T>],
    joints: &[u32],
    t: Time,
    side: Side,
    purpose: Purpose,
    at_rest: bool,
) -> S::Inputs {
    let components = <S::Inputs as FromNumbers<T>>::COMPONENTS;
    let layout = Layout::new(S::FACTS.inputs, components, purpose);
    let mut record = vec![T::from_f64(0.0); layout.width];
    let mut at = 0;
    for ((&joint, &components), &needed) in joints.iter().zip(components).zip(&layout.wanted) {
        let drive = &joint_slots[joint as usize].drive;
        let own = components * needed.count();
        if !at_rest {
            drive.sample(t, side, needed, &mut record[at..at + own]);
        } else if needed.contains(Derivatives::POSITION) {
            drive.sample(t, side, Derivatives::POSITION, &mut record[at..at + components]);
        }
        at += own;
    }
    FromNumbers::from_numbers(&mut By(|input, derivative, component| {
        layout.place(input, derivative, component).map_or(T::from_f64(0.0), |place| record[place])
    }))
}

/// Returns an error if a state is not finite.
pub(crate) fn check_state<T: Float, const N: usize>(
    facts: &Facts,
    values: &[T; N],
) -> Result<(), SceneError> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(index) => {
            let name = facts.coordinates.get(index).copied().unwrap_or("");
            Err(SceneError::State {
                coordinate: Coordinate { index, name },
                value: values[index].to_f64(),
            })
        }
    }
}

/// Returns an error if the motion of a joint lacks a derivative that the equations or the outputs
/// need.
pub(crate) fn check_joints<S: SceneSystem<T, N>, T: Lane + Float, const N: usize>(
    joint_slots: &[JointSlot<T>],
    joints: &[u32],
) -> Result<(), SceneError> {
    joints.iter().enumerate().try_for_each(|(input, &joint)| {
        check_motion(&S::FACTS, input, joint_slots[joint as usize].drive.has())
    })
}

/// Returns an error if a motion with the derivatives `has` lacks one that the equations or the
/// outputs need of an input.
pub(crate) fn check_motion(
    facts: &Facts,
    input: usize,
    has: Derivatives,
) -> Result<(), SceneError> {
    let needs = [Purpose::Accelerations, Purpose::Momenta, Purpose::Outputs]
        .map(|purpose| needed(facts.inputs, input, purpose));
    for (derivative, order) in ORDERS.into_iter().enumerate() {
        if needs.iter().any(|needed| needed.contains(order)) && !has.contains(order) {
            let input = facts.inputs.get(input).map_or("", |input| input.name);
            return Err(SceneError::Derivative { input, derivative });
        }
    }
    Ok(())
}
