//! Removal of pendulums, of joints, and of all that was added together.

use crate::error::SceneError;
use crate::handle::{Bundle, Handle};
use crate::sampling::joint::Joint;
use crate::scene::Scene;
use crate::system::SceneSystem;
use pendulum_core::scalar::Float;
use std::collections::{BTreeMap, BTreeSet};

impl<T: Float> Scene<T> {
    /// Removes a pendulum. Its handle names none from now on; its memory and its index are used by
    /// the next one.
    ///
    /// # Errors
    /// Returns an error if the pendulum belongs to another scene, has been removed already, or
    /// carries a joint.
    pub fn remove<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
    ) -> Result<(), SceneError> {
        let (group, world) = self.parts_of(pendulum)?;
        if let Some(carrier) = world.carriers.get(&group.place_of(pendulum.index())) {
            let (kind, index) = (S::FACTS.name, pendulum.index());
            return Err(SceneError::CarriesJoint { kind, index, joint: carrier.rides[0].joint });
        }
        let place = group.place_of(pendulum.index());
        group.take_down(world, pendulum.index());
        self.limits.bones.remove(&place);
        Ok(())
    }

    /// Removes a joint, on which nothing hangs.
    ///
    /// # Errors
    /// Returns an error if the joint belongs to another scene, has been removed already, or carries
    /// a pendulum.
    pub fn remove_joint<const D: usize>(&mut self, joint: Joint<D>) -> Result<(), SceneError> {
        let joint = joint.of(self.living())?;
        match self.world.carries[joint as usize].len() as u32 {
            0 => self.world.remove_joint(joint),
            inputs => return Err(SceneError::Carries { joint, inputs }),
        }
        Ok(())
    }

    /// Calls `add`, and returns all joints and pendulums that it adds to the scene, beside its own
    /// result. If it fails, they are removed again.
    ///
    /// ```
    /// # #![allow(mixed_script_confusables)]
    /// # use pendulum_runtime::prelude::*;
    /// # use pendulum_runtime::scene::Scene;
    /// # lagrangian! {
    /// #     pub struct Feather { m: kg, L: m, g: m/s^2 = 9.81 }
    /// #     coordinate θ: rad;
    /// #     driven x: [m; 2];
    /// #     let y = x + L * [sin(θ), -cos(θ)];
    /// #     kinetic = m/2 * |ẏ|^2;
    /// #     potential = m*g*height(y);
    /// # }
    /// let mut scene = Scene::<f64>::new(240.0)?;
    /// let (bird, wing) = scene.bundle(|scene| {
    ///     let wing = scene.live([0.0, 0.0])?;
    ///     for _ in 0..20 {
    ///         scene.hang(wing, Feather::new(0.01, 0.1), [0.0], [0.0])?;
    ///     }
    ///     Ok(wing)
    /// })?;
    /// assert!(scene.remove_joint(wing).is_err()); // it carries the feathers
    /// scene.remove_bundle(&bird)?;
    /// assert_eq!(scene.awake(), (0, 0));
    /// # Ok::<(), pendulum_runtime::scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// Returns the error of `add`.
    pub fn bundle<R>(
        &mut self,
        add: impl FnOnce(&mut Self) -> Result<R, SceneError>,
    ) -> Result<(Bundle, R), SceneError> {
        let empty = Bundle { scene: self.id, pendulums: Vec::new(), joints: Vec::new() };
        let outer = self.bundle.replace(empty.clone());
        let result = add(self);
        let bundle = core::mem::replace(&mut self.bundle, outer).unwrap_or(empty);
        match result {
            Ok(result) => {
                // What belongs to an inner bundle belongs to the outer one as well.
                if let Some(outer) = &mut self.bundle {
                    outer.pendulums.extend(&bundle.pendulums);
                    outer.joints.extend(&bundle.joints);
                }
                Ok((bundle, result))
            }
            Err(error) => {
                // If all has been removed already, nothing is left to do.
                self.remove_bundle(&bundle).or_else(|gone| match gone {
                    SceneError::Bundle => Ok(()),
                    other => Err(other),
                })?;
                Err(error)
            }
        }
    }

    /// Removes all joints and pendulums of a bundle that have not been removed one by one.
    ///
    /// # Errors
    /// Returns an error if nothing of the bundle is left in this scene, or if a pendulum that is
    /// not in the bundle hangs on one of its joints, or a joint that is not in the bundle is
    /// carried by one of its pendulums; then nothing is removed.
    pub fn remove_bundle(&mut self, bundle: &Bundle) -> Result<(), SceneError> {
        if bundle.scene != self.id {
            return Err(SceneError::Bundle);
        }
        let mut served: BTreeMap<u32, u32> = BTreeMap::new();
        let mut pendulums = Vec::new();
        for &(kind, (id, generation)) in &bundle.pendulums {
            let Some(place) = self.groups.iter().position(|(own, _)| *own == kind) else {
                continue;
            };
            let group = &self.groups[place].1;
            if group.generation(id) == Some(generation) {
                for &joint in group.joints(id) {
                    *served.entry(joint).or_default() += 1;
                }
                pendulums.push((place, id));
            }
        }
        let joints = bundle.joints.iter();
        let joints = joints
            .filter(|(joint, generation)| self.world.generations[*joint as usize] == *generation);
        let joints: Vec<u32> = joints.map(|(joint, _)| *joint).collect();
        if pendulums.is_empty() && joints.is_empty() {
            return Err(SceneError::Bundle);
        }
        for &joint in &joints {
            let own = served.get(&joint).copied().unwrap_or(0);
            let inputs = self.world.carries[joint as usize].len() as u32 - own;
            if inputs != 0 {
                return Err(SceneError::Carries { joint, inputs });
            }
        }
        let leaving: BTreeSet<u32> = joints.iter().copied().collect();
        for &(place, index) in &pendulums {
            let group = &self.groups[place].1;
            let carrier = self.world.carriers.get(&group.place_of(index));
            let mut rides = carrier.iter().flat_map(|carrier| &carrier.rides);
            if let Some(ride) = rides.find(|ride| !leaving.contains(&ride.joint)) {
                return Err(SceneError::CarriesJoint {
                    kind: group.name(),
                    index,
                    joint: ride.joint,
                });
            }
        }
        for (place, id) in pendulums {
            self.limits.bones.remove(&self.groups[place].1.place_of(id));
            self.groups[place].1.take_down(&mut self.world, id);
        }
        for joint in joints {
            self.world.remove_joint(joint);
        }
        Ok(())
    }
}
