//! The scene as a resource: bones of entities in it, and their way back to the transforms.

use crate::around::{Around, Felt, Surroundings};
use crate::bone::{SpringBone, Teleported};
use crate::rig::{Led, Place, Rig, mean, other, reversed};
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
use pendulum_runtime::scene::{AnyBone, Bone, CenteredBone, Handle, Joint, Scene, SceneError};
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

/// The joints on which a bone hangs: for its position and its attitude.
pub(crate) type Frame = (Joint<3>, Joint<4>);

/// A bone in the scene, without a center or with one.
#[derive(Clone, Copy, Debug)]
pub(crate) enum BoneHandle {
    Plain(Handle<Bone<f64>, 4>),
    Centered(Handle<CenteredBone<f64>, 4>),
}

/// Evaluates an expression with the handle of a bone, whichever it is.
macro_rules! with {
    ($bone:expr, $handle:ident => $value:expr) => {
        match $bone {
            BoneHandle::Plain($handle) => $value,
            BoneHandle::Centered($handle) => $value,
        }
    };
}
pub(crate) use with;

/// A bone of an entity with what it hangs on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hung {
    pub(crate) bone: BoneHandle,
    frame: Led,
    /// The entity whose bone carries the frame.
    carrier: Option<Entity>,
    /// The entity in whose space the bone moves, and its frame.
    center: Option<(Entity, Frame)>,
    /// The turn from the axis y, along which bones of scenes point, to the direction of the tip.
    axis: DQuat,
    mirrored: bool,
    scale: f64,
    parameters: [f64; 6],
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

    /// Returns the bone of an entity in the scene, or `None` if it has none, a refused one or one
    /// with a center.
    pub fn bone(&self, entity: Entity) -> Option<Handle<Bone<f64>, 4>> {
        if let BoneHandle::Plain(bone) = self.hung(entity)?.bone { Some(bone) } else { None }
    }

    /// Returns the bone of an entity in the scene, or `None` if it has none with a center.
    pub fn centered_bone(&self, entity: Entity) -> Option<Handle<CenteredBone<f64>, 4>> {
        if let BoneHandle::Centered(bone) = self.hung(entity)?.bone { Some(bone) } else { None }
    }

    fn hung(&self, entity: Entity) -> Option<&Hung> {
        match &self.slots[*self.index.get(&entity)?].state {
            State::Hung(hung) => Some(hung),
            State::Waiting | State::Refused => None,
        }
    }

    /// Removes the bones that are gone or hang elsewhere now, with all that they carry, and adjusts
    /// the others.
    pub(crate) fn sweep(&mut self, rig: &Rig) {
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
                let removed = with!(bone, bone => self.scene.remove(bone));
                report("bone", slot.entity, removed.and_then(|()| frame.remove(&mut self.scene)));
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

    /// Finds the place of a bone that nothing carries, and sets the parameters of one whose settings
    /// or scales have changed. Returns `true` if the bone stays in the scene.
    fn stays(&mut self, index: usize, rig: &Rig, gone: &EntityHashSet) -> bool {
        let Slot { entity, parent, state, .. } = self.slots[index];
        let Ok((_, bone, transform, child_of)) = rig.bones.get(entity) else {
            return false;
        };
        let State::Hung(hung) = state else {
            return matches!(state, State::Refused) && !bone.is_changed();
        };
        let turned = || bone.scaled(1.0).is_ok() && axis(bone.tip) != Some(hung.axis);
        let another = || rig.center(entity) != hung.center.map(|(center, _)| center);
        if child_of.map(ChildOf::parent) != parent || bone.is_changed() && turned() || another() {
            return false;
        }
        let (stays, scale) = match hung.carrier {
            Some(carrier) => {
                let carrying = self.hung(carrier);
                let scale = carrying.map(|carrying| carrying.scale * mean(transform.scale));
                (!gone.contains(&carrier), scale)
            }
            None => {
                let place = rig.place(transform, parent);
                self.slots[index].place = place;
                let same = place.is_none_or(|place| place.mirrored == hung.mirrored);
                let free = parent.and_then(|parent| self.hung(parent)).is_none();
                (same && free, place.map(|place| place.scale))
            }
        };
        let scale = scale.unwrap_or(hung.scale);
        if stays
            && (other(hung.scale, scale) || bone.is_changed())
            && let State::Hung(hung) = &mut self.slots[index].state
        {
            hung.scale = scale;
            let bone = bone.scaled(scale);
            let set = bone.and_then(|bone| hung.set(&mut self.scene, parameters(&bone)));
            report("bone", entity, set);
        }
        stays
    }

    /// Hangs a bone that is not in the scene.
    fn hang(&mut self, entity: Entity, rig: &Rig) {
        let Ok((_, bone, transform, child_of)) = rig.bones.get(entity) else { return };
        let parent = child_of.map(ChildOf::parent);
        let rest = self.again.remove(&entity).unwrap_or(transform.rotation);
        let state = self.try_hang(entity, &bone, transform, (parent, rest), rig);
        let state = state.unwrap_or_else(|error| {
            report("bone", entity, Err(error));
            State::Refused
        });
        self.index.insert(entity, self.slots.len());
        let felt = Felt::default();
        self.slots.push(Slot { entity, parent, rest, place: None, state, felt });
    }

    fn try_hang(
        &mut self,
        entity: Entity,
        bone: &SpringBone,
        transform: &Transform,
        (parent, rest): (Option<Entity>, Quat),
        rig: &Rig,
    ) -> Result<State, SceneError> {
        let carrier = parent.and_then(|parent| Some((parent, *self.hung(parent)?)));
        let (scale, mirrored, place) = if let Some((_, below)) = &carrier {
            (below.scale * mean(transform.scale), below.mirrored, None)
        } else if let Some(place) = rig.place(transform, parent) {
            (place.scale, place.mirrored, Some(place))
        } else {
            return Ok(State::Waiting);
        };
        if !(0.0 < scale && scale < f64::INFINITY) {
            return Ok(State::Waiting);
        }
        let settings = bone.scaled(scale)?;
        let (parameters, axis) = (parameters(&settings), axis(bone.tip).unwrap_or_default());
        let center = rig.center(entity);
        let center = center.and_then(|own| Some((own, self.around.frames.get(&own)?.joints)));
        let (_, hung) = self.scene.bundle(|scene| {
            let frame = match (&carrier, place) {
                (Some((below, Hung { bone, scale, axis: before, .. })), _) => {
                    // The joint need not be at the tip: two bones may begin on one.
                    let tip = rig.bones.get(*below).map_or(Vec3::ZERO, |(_, below, ..)| below.tip);
                    let aside = before.inverse() * (transform.translation - tip).as_dvec3();
                    let aside = (*scale * reversed(aside, mirrored)).to_array();
                    let turn = before.inverse() * rest.as_dquat() * axis;
                    let turn = attitude(mirror(turn, mirrored));
                    let ends = ["tip", "turn"];
                    let joints = with!(*bone, bone => scene.frame_on(bone, ends, aside, turn))?;
                    Led { joints, at: <(DVec3, DQuat)>::default(), jump: None }
                }
                (None, place) => {
                    let at = place.map(|place| (place.position, turn_at(&place, rest, axis)));
                    Led::new(scene, at.unwrap_or_default())?
                }
            };
            let (place, turn) = frame.joints;
            let bone = match center {
                None => BoneHandle::Plain(at_rest(scene, (place, turn), settings)?),
                Some((_, (other, space))) => {
                    let anchor = (place, turn, other, space);
                    BoneHandle::Centered(at_rest(scene, anchor, settings.centered())?)
                }
            };
            let carrier = carrier.map(|(below, _)| below);
            Ok(Hung { bone, frame, carrier, center, axis, mirrored, scale, parameters })
        })?;
        Ok(State::Hung(hung))
    }

    /// Tells the joints that no bone carries where they are at the end of the frame. In a pause,
    /// and where they are marked, they jump with all bones of their chains.
    fn lead(&mut self, paused: bool, rig: &Rig) {
        let mut turns = EntityHashMap::default();
        for slot in &mut self.slots {
            let State::Hung(hung) = &mut slot.state else { continue };
            hung.frame.jump = hung.carrier.and_then(|on| turns.get(&on).copied());
            let mut led = Ok(());
            if let Some(place) = slot.place.filter(|_| hung.carrier.is_none()) {
                let to = (place.position, turn_at(&place, slot.rest, hung.axis));
                let jumps = [paused, rig.is_teleported(slot.entity)];
                led = hung.frame.lead(&mut self.scene, to, jumps);
            }
            turns.extend(hung.frame.jump.map(|turn| (slot.entity, turn)));
            let jump = hung.center.and_then(|(center, _)| self.around.frames.get(&center)?.jump);
            let turned = led.and_then(|()| hung.turn(&mut self.scene, jump));
            report("bone", slot.entity, turned);
        }
    }
}

impl Hung {
    /// Sets the parameters that differ, all or none.
    fn set(&mut self, scene: &mut Scene<f64>, values: [f64; 6]) -> Result<(), SceneError> {
        let (before, names) = (self.parameters, <Bone<f64> as System<4>>::FACTS.parameters);
        for ((name, value), own) in names.iter().zip(values).zip(&mut self.parameters) {
            if value != *own {
                if let Err(error) = with!(self.bone, bone => scene.set_parameter(bone, name, value))
                {
                    self.set(scene, before)?;
                    return Err(error);
                }
                *own = value;
            }
        }
        Ok(())
    }

    /// Returns the turn of the space of the bone between the last two ticks.
    fn space(&self, scene: &Scene<f64>, alpha: f64) -> DQuat {
        let pose = |(_, (_, turn)): (Entity, Frame)| quaternion(scene.joint_pose(turn, alpha));
        self.center.map_or(DQuat::IDENTITY, pose)
    }

    /// Turns the bone with its frame, and back where its center has jumped by a turn.
    fn turn(&self, scene: &mut Scene<f64>, center: Option<DQuat>) -> Result<(), SceneError> {
        if self.frame.jump.or(center).is_none() {
            return Ok(());
        }
        let space = self.space(scene, 1.0);
        let turn = self.frame.jump.unwrap_or_default() * center.unwrap_or_default().inverse();
        let turn = space.inverse() * turn * space;
        with!(self.bone, bone => {
            let (q, v) = scene.state(bone);
            let [q, v] = [q, v].map(|part| numbers(turn * quaternion(part)));
            scene.set_state(bone, q, v)
        })
    }
}

/// Hangs a bone at rest.
fn at_rest<B: AnyBone<f64>>(
    scene: &mut Scene<f64>,
    anchor: B::Anchor,
    bone: B,
) -> Result<Handle<B, 4>, SceneError> {
    let hung = scene.hang_chain(anchor, [bone])?[0];
    scene.reset_to_rest(hung)?;
    Ok(hung)
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
    let dt = time.delta_secs_f64();
    pendulums.stand(&surroundings, dt == 0.0, &rig);
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
    pendulums.lead(dt == 0.0, &rig);
    pendulums.surround(&surroundings, &rig);
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
        let alpha = scene.alpha();
        let frame = quaternion(scene.joint_pose(hung.frame.joints.1, alpha));
        let bone = quaternion(with!(hung.bone, bone => scene.pose(bone, alpha)));
        let bone = hung.space(scene, alpha) * bone.normalize();
        let turn = mirror(frame.inverse() * bone, hung.mirrored);
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
pub(crate) fn quaternion([w, x, y, z]: [f64; 4]) -> DQuat {
    DQuat::from_xyzw(x, y, z, w)
}
