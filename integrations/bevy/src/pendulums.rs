//! The scene as a resource: bones of entities in it, and their way back to the transforms.

use crate::around::{Around, Felt, Surroundings};
use crate::bone::{SpringBone, Teleported};
use crate::rig::{Place, Rig, mean, other, reversed};
use bevy_ecs::change_detection::DetectChanges;
use bevy_ecs::entity::{Entity, EntityHashMap, EntityHashSet};
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::resource::Resource;
use bevy_ecs::system::{Commands, Query, Res, ResMut};
use bevy_math::{DQuat, DVec3, Quat, Vec3};
use bevy_time::{Time, Virtual};
use bevy_transform::components::Transform;
use log::warn;
use pendulum_runtime::attitude::Attitude;
use pendulum_runtime::scene::{Bone, Handle, Joint, Scene, SceneError};
use pendulum_runtime::system::System;

/// The scene in which the bones of all entities hang, and whatever else an app hangs there.
///
/// Its numbers are `f64`, although transforms are `f32`: joints that bones carry follow polynomials
/// from tick to tick. A hundred metres from the origin, numbers of `f32` are 8 µm apart, and a step
/// of this size within a tick of 1/240 s takes an acceleration of 2 m/s², which would be seen.
#[derive(Debug, Resource)]
pub struct Pendulums {
    pub(crate) scene: Scene<f64>,
    /// Each bone after the one that carries it.
    pub(crate) slots: Vec<Slot>,
    /// The indices in `slots`.
    index: EntityHashMap<usize>,
    /// The rotations at rest of entities that have no bone any more, to be written to them.
    released: Vec<(Entity, Quat)>,
    /// Those of entities whose bones are to be hung again.
    again: EntityHashMap<Quat>,
    pub(crate) around: Around,
}

/// An entity with a bone.
#[derive(Debug)]
pub(crate) struct Slot {
    pub(crate) entity: Entity,
    parent: Option<Entity>,
    /// The rotation relative to the parent at rest.
    rest: Quat,
    /// Where a joint that no bone carries is in this frame.
    place: Option<Place>,
    pub(crate) state: State,
    pub(crate) felt: Felt,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum State {
    /// The transforms above the bone are incomplete or have no size.
    Waiting,
    /// The settings make no bone.
    Refused,
    Hung(Hung),
}

impl State {
    /// Returns the bone in the scene.
    pub(crate) fn bone(&self) -> Option<Handle<Bone<f64>, 4>> {
        if let Self::Hung(hung) = self { Some(hung.bone) } else { None }
    }
}

/// The joints on which a bone hangs: for its position and its attitude.
pub(crate) type Frame = (Joint<3>, Joint<4>);

/// A bone in the scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hung {
    bone: Handle<Bone<f64>, 4>,
    frame: Frame,
    on: On,
    /// The turn from the axis y, along which bones of scenes point, to the direction of the tip.
    axis: DQuat,
    mirrored: bool,
    scale: f64,
    parameters: [f64; 6],
}

/// What moves the frame of a bone.
#[derive(Clone, Copy, Debug)]
pub(crate) enum On {
    /// The bone of this entity.
    Bone(Entity),
    /// The transforms above the bone; it was last told to be here.
    Place(DVec3, DQuat),
}

impl Pendulums {
    pub(crate) fn new(scene: Scene<f64>) -> Self {
        Self {
            scene,
            slots: Vec::new(),
            index: EntityHashMap::default(),
            released: Vec::new(),
            again: EntityHashMap::default(),
            around: Around::default(),
        }
    }

    /// Returns the scene.
    pub fn scene(&self) -> &Scene<f64> {
        &self.scene
    }

    /// Returns the scene for settings such as `set_sleep` and `set_bounds`, and for
    /// pendulums of other types. The plugin advances the scene. The bones of entities belong to
    /// their components: if they are removed here, the next frame panics. What a program hangs on
    /// them has to be removed before they are despawned, or they stay, and a warning says so.
    pub fn scene_mut(&mut self) -> &mut Scene<f64> {
        &mut self.scene
    }

    /// Returns the bone of an entity in the scene, or `None` if it has none or a refused one.
    pub fn bone(&self, entity: Entity) -> Option<Handle<Bone<f64>, 4>> {
        self.hung(entity).map(|hung| hung.bone)
    }

    fn hung(&self, entity: Entity) -> Option<&Hung> {
        match &self.slots[*self.index.get(&entity)?].state {
            State::Hung(hung) => Some(hung),
            State::Waiting | State::Refused => None,
        }
    }

    /// Removes the bones that are gone or hang elsewhere now, with all that they carry.
    fn sweep(&mut self, rig: &Rig) {
        let mut gone = EntityHashSet::default();
        for index in 0..self.slots.len() {
            if !self.stays(index, rig, &gone) {
                gone.insert(self.slots[index].entity);
            }
        }
        if gone.is_empty() {
            return;
        }
        for slot in self.slots.iter().rev().filter(|slot| gone.contains(&slot.entity)) {
            if let State::Hung(Hung { bone, frame, .. }) = slot.state {
                let removed = self.scene.remove(bone);
                let removed = removed.and_then(|()| self.scene.remove_joint(frame.0));
                report(
                    "bone",
                    slot.entity,
                    removed.and_then(|()| self.scene.remove_joint(frame.1)),
                );
            }
            if rig.bones.contains(slot.entity) {
                self.again.insert(slot.entity, slot.rest);
            } else {
                self.released.push((slot.entity, slot.rest));
            }
        }
        self.slots.retain(|slot| !gone.contains(&slot.entity));
        self.index.clear();
        self.index.extend(self.slots.iter().enumerate().map(|(index, slot)| (slot.entity, index)));
    }

    /// Finds the place of a bone that nothing carries, and returns `true` if the bone stays in the
    /// scene as it is, except for its parameters.
    fn stays(&mut self, index: usize, rig: &Rig, gone: &EntityHashSet) -> bool {
        let Slot { entity, parent, state, .. } = self.slots[index];
        let Ok((_, bone, transform, child_of)) = rig.bones.get(entity) else {
            return false;
        };
        let State::Hung(hung) = state else {
            return matches!(state, State::Refused) && !bone.is_changed();
        };
        let turned = || bone.scaled(1.0).is_ok() && axis(bone.tip) != Some(hung.axis);
        if child_of.map(ChildOf::parent) != parent || bone.is_changed() && turned() {
            return false;
        }
        match hung.on {
            On::Bone(carrier) => !gone.contains(&carrier),
            On::Place(..) => {
                let place = rig.place(transform, parent);
                self.slots[index].place = place;
                place.is_none_or(|place| place.mirrored == hung.mirrored)
                    && parent.and_then(|parent| self.hung(parent)).is_none()
            }
        }
    }

    /// Sets the parameters of bones whose settings or scales have changed.
    fn adjust(&mut self, rig: &Rig) {
        for index in 0..self.slots.len() {
            let Slot { entity, place, state: State::Hung(hung), .. } = self.slots[index] else {
                continue;
            };
            let Ok((_, bone, transform, _)) = rig.bones.get(entity) else { continue };
            let scale = match hung.on {
                On::Bone(carrier) => {
                    self.hung(carrier).map(|carrier| carrier.scale * mean(transform.scale))
                }
                On::Place(..) => place.map(|place| place.scale),
            }
            .unwrap_or(hung.scale);
            if !other(hung.scale, scale) && !bone.is_changed() {
                continue;
            }
            let State::Hung(hung) = &mut self.slots[index].state else { continue };
            hung.scale = scale;
            report(
                "bone",
                entity,
                bone.scaled(scale).and_then(|bone| hung.set(&mut self.scene, &bone)),
            );
        }
    }

    /// Hangs a bone that is not in the scene.
    fn hang(&mut self, entity: Entity, rig: &Rig) {
        let Ok((_, bone, transform, child_of)) = rig.bones.get(entity) else { return };
        let parent = child_of.map(ChildOf::parent);
        let rest = self.again.remove(&entity).unwrap_or(transform.rotation);
        let state = self.try_hang(&bone, transform, parent, rest, rig).unwrap_or_else(|error| {
            report("bone", entity, Err(error));
            State::Refused
        });
        self.index.insert(entity, self.slots.len());
        let felt = Felt::default();
        self.slots.push(Slot { entity, parent, rest, place: None, state, felt });
    }

    fn try_hang(
        &mut self,
        bone: &SpringBone,
        transform: &Transform,
        parent: Option<Entity>,
        rest: Quat,
        rig: &Rig,
    ) -> Result<State, SceneError> {
        let hung = if let Some(entity) = parent
            && let Some(carrier) = self.hung(entity)
        {
            let &Hung { bone: below, axis: before, mirrored, .. } = carrier;
            let scale = carrier.scale * mean(transform.scale);
            if !(0.0 < scale && scale < f64::INFINITY) {
                return Ok(State::Waiting);
            }
            // The joint need not be at the tip: two bones may begin on one.
            let tip = rig.bones.get(entity).map_or(Vec3::ZERO, |(_, below, ..)| below.tip);
            let aside = (transform.translation - tip).as_dvec3();
            let aside = carrier.scale * reversed(before.inverse() * aside, mirrored);
            self.add(bone, scale, mirrored, |scene, axis| {
                let turn = mirror(before.inverse() * rest.as_dquat() * axis, mirrored);
                let aside = aside.to_array();
                let frame = scene.frame_on(below, ["tip", "turn"], aside, attitude(turn))?;
                Ok((frame, On::Bone(entity)))
            })
        } else if let Some(place) = rig.place(transform, parent) {
            self.add(bone, place.scale, place.mirrored, |scene, axis| {
                let turn = turn_at(&place, rest, axis);
                let frame = scene.live_frame(place.position.to_array(), attitude(turn))?;
                Ok((frame, On::Place(place.position, turn)))
            })
        } else {
            return Ok(State::Waiting);
        };
        hung.map(State::Hung)
    }

    /// Hangs a bone on the frame that `frame` adds for its axis.
    fn add(
        &mut self,
        bone: &SpringBone,
        scale: f64,
        mirrored: bool,
        frame: impl FnOnce(&mut Scene<f64>, DQuat) -> Result<(Frame, On), SceneError>,
    ) -> Result<Hung, SceneError> {
        let settings = bone.scaled(scale)?;
        let (parameters, axis) = (parameters(&settings), axis(bone.tip).unwrap_or_default());
        let (_, hung) = self.scene.bundle(|scene| {
            let (frame, on) = frame(scene, axis)?;
            let start = scene.joint_pose(frame.1, 1.0);
            let bone = scene.hang(frame, settings, start, [0.0; 4])?;
            scene.reset_to_rest(bone)?;
            Ok(Hung { bone, frame, on, axis, mirrored, scale, parameters })
        })?;
        Ok(hung)
    }

    /// Tells the joints that no bone carries where they are at the end of the frame. In a pause,
    /// and where they are marked, they jump with all bones of their chains.
    fn lead(&mut self, paused: bool, rig: &Rig) {
        let mut turns = EntityHashMap::default();
        for slot in &mut self.slots {
            let State::Hung(hung) = &mut slot.state else { continue };
            let turn = match (hung.on, slot.place) {
                (On::Bone(carrier), _) => Ok(turns.get(&carrier).copied()),
                (On::Place(..), None) => Ok(None),
                (On::Place(position, turn), Some(place)) => {
                    let goal = (place.position, turn_at(&place, slot.rest, hung.axis));
                    hung.on = On::Place(goal.0, goal.1);
                    let jumps =
                        paused && goal != (position, turn) || rig.is_teleported(slot.entity);
                    hung.move_to(&mut self.scene, goal, jumps)
                }
            };
            let turned = turn.and_then(|turn| {
                let Some(turn) = turn else { return Ok(()) };
                turns.insert(slot.entity, turn);
                let (q, v) = self.scene.state(hung.bone);
                let [q, v] = [q, v].map(|part| numbers(turn * quaternion(part)));
                self.scene.set_state(hung.bone, q, v)
            });
            report("bone", slot.entity, turned);
        }
    }
}

impl Hung {
    /// Sets the parameters that differ, all or none.
    fn set(&mut self, scene: &mut Scene<f64>, bone: &Bone<f64>) -> Result<(), SceneError> {
        let before = self.parameters;
        let changed = self.set_each(scene, parameters(bone));
        if changed.is_err() {
            self.set_each(scene, before)?;
        }
        changed
    }

    fn set_each(&mut self, scene: &mut Scene<f64>, values: [f64; 6]) -> Result<(), SceneError> {
        let names = <Bone<f64> as System<4>>::FACTS.parameters;
        for ((name, value), own) in names.iter().zip(values).zip(&mut self.parameters) {
            if value != *own {
                scene.set_parameter(self.bone, name, value)?;
                *own = value;
            }
        }
        Ok(())
    }

    /// Moves the joints of the bone. If they jump, returns the turn of their attitude.
    fn move_to(
        &self,
        scene: &mut Scene<f64>,
        (position, turn): (DVec3, DQuat),
        jumps: bool,
    ) -> Result<Option<DQuat>, SceneError> {
        let (position, attitude) = (position.to_array(), numbers(turn));
        if !jumps {
            scene.move_to(self.frame.0, position)?;
            scene.move_to(self.frame.1, attitude)?;
            return Ok(None);
        }
        let before = quaternion(scene.joint_pose(self.frame.1, 1.0));
        scene.teleport(self.frame.0, position)?;
        scene.teleport(self.frame.1, attitude)?;
        Ok(Some(turn * before.inverse()))
    }
}

/// Removes what is gone from the scene.
pub(crate) fn sweep(mut pendulums: ResMut<Pendulums>, rig: Rig) {
    pendulums.sweep(&rig);
}

/// Gives entities without a bone their rotation at rest again.
pub(crate) fn release(mut pendulums: ResMut<Pendulums>, mut transforms: Query<&mut Transform>) {
    for (entity, rest) in pendulums.released.drain(..) {
        if let Ok(mut transform) = transforms.get_mut(entity) {
            transform.rotation = rest;
        }
    }
}

/// Hangs new bones, tells the scene settings and joints, and advances it by the frame.
pub(crate) fn advance(
    mut pendulums: ResMut<Pendulums>,
    time: Res<Time<Virtual>>,
    rig: Rig,
    surroundings: Surroundings,
    mut commands: Commands,
) {
    let pendulums = &mut *pendulums;
    pendulums.adjust(&rig);
    let mut path = Vec::new();
    for (entity, ..) in &rig.bones {
        // Bones hang after those above them, which may carry them.
        let mut next = Some(entity);
        while let Some(entity) = next.filter(|next| !pendulums.index.contains_key(next))
            && rig.bones.contains(entity)
        {
            path.push(entity);
            next = rig.parent(entity);
        }
        while let Some(entity) = path.pop() {
            pendulums.hang(entity, &rig);
        }
    }
    let dt = time.delta_secs_f64();
    pendulums.lead(dt == 0.0, &rig);
    pendulums.surround(&surroundings, dt == 0.0, &rig);
    for entity in &rig.teleported {
        commands.entity(entity).try_remove::<Teleported>();
    }
    match pendulums.scene.advance(dt) {
        Ok(advanced) => {
            let faults = pendulums.scene.faults();
            faults[faults.len() - advanced.failed..].iter().for_each(|fault| warn!("{fault}"));
        }
        Err(error) => warn!("{error}"),
    }
}

/// Writes the poses of bones to the rotations of their entities.
pub(crate) fn pose(pendulums: Res<Pendulums>, mut transforms: Query<&mut Transform>) {
    let scene = &pendulums.scene;
    for slot in &pendulums.slots {
        let State::Hung(hung) = &slot.state else { continue };
        // Both are one tick behind the frame. The turn between them is put on the parent where it
        // is now, so that a stiff bone stays on a parent that turns.
        let frame = quaternion(scene.joint_pose(hung.frame.1, scene.alpha()));
        let bone = quaternion(scene.pose(hung.bone, scene.alpha()));
        let turn = mirror(frame.inverse() * bone.normalize(), hung.mirrored);
        let rotation = slot.rest.as_dquat() * hung.axis * turn * hung.axis.inverse();
        let rotation = rotation.normalize().as_quat();
        if let Ok(mut transform) = transforms.get_mut(slot.entity)
            && transform.rotation != rotation
        {
            transform.rotation = rotation;
        }
    }
}

/// Reports what the scene refuses of an entity.
pub(crate) fn report(what: &str, entity: Entity, result: Result<(), SceneError>) {
    if let Err(error) = result {
        warn!("the {what} of entity {entity}: {error}");
    }
}

/// Returns the turn from the axis y to the direction of a tip.
fn axis(tip: Vec3) -> Option<DQuat> {
    let direction = tip.as_dvec3().try_normalize()?;
    Some(DQuat::from_rotation_arc(DVec3::Y, direction))
}

/// Returns a turn in mirrored axes, the first of which is reversed.
///
/// With F = diag(−1, 1, 1), the axes of an entity below a mirrored parent are R·F for a rotation R.
/// The bone of the scene has the attitude R, and its direction, the axis y, is that of the entity.
fn mirror(turn: DQuat, mirrored: bool) -> DQuat {
    if mirrored { DQuat::from_xyzw(turn.x, -turn.y, -turn.z, turn.w) } else { turn }
}

/// Returns the attitude at rest of a bone at a place.
fn turn_at(place: &Place, rest: Quat, axis: DQuat) -> DQuat {
    place.rotation * mirror(rest.as_dquat() * axis, place.mirrored)
}

/// Returns the parameters in the order of the system.
fn parameters(bone: &Bone<f64>) -> [f64; 6] {
    let [x, y, z] = bone.gravity;
    [bone.length, bone.stiffness, bone.damping, x, y, z]
}

pub(crate) fn attitude(turn: DQuat) -> Attitude {
    Attitude::from_quaternion(numbers(turn))
}

/// Returns the numbers of a quaternion, the real part first.
pub(crate) fn numbers(q: DQuat) -> [f64; 4] {
    [q.w, q.x, q.y, q.z]
}

/// Returns the quaternion with these numbers, the real part first.
fn quaternion([w, x, y, z]: [f64; 4]) -> DQuat {
    DQuat::from_xyzw(x, y, z, w)
}
