//! What stands and blows around bones: bodies that they do not enter, and winds.

use crate::pendulums::{BoneHandle, Hung, Pendulums, State, report, with};
use crate::rig::{Led, Place, Rig, other};
use bevy_ecs::change_detection::{DetectChanges, Ref};
use bevy_ecs::component::Component;
use bevy_ecs::entity::{Entity, EntityHashMap, EntityHashSet};
use bevy_ecs::reflect::ReflectComponent;
use bevy_ecs::system::{Query, SystemParam};
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;
use pendulum_runtime::scene::{Collider, Joint, Shape};

/// A body that bones do not enter or leave, in the axes of its entity and scaled with it.
///
/// A bone keeps off the bodies that its [`SpringColliders`] name. Below a bone, a body is one frame
/// late; elsewhere it is where its entity is in this frame.
#[derive(Clone, Copy, Component, Debug, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, PartialEq)]
#[require(Transform)]
pub enum SpringCollider {
    /// A ball.
    Ball {
        /// The centre.
        center: Vec3,
        /// The radius.
        radius: f32,
    },
    /// All points within a distance of a line between two points.
    Capsule {
        /// The points.
        ends: [Vec3; 2],
        /// The distance.
        radius: f32,
    },
    /// A capsule that bones do not leave.
    Inside {
        /// The points.
        ends: [Vec3; 2],
        /// The distance.
        radius: f32,
    },
    /// The half of space on the other side of a plane than its normal.
    Half {
        /// A point of the plane.
        point: Vec3,
        /// The direction out of the half, of any length.
        normal: Vec3,
    },
}

impl SpringCollider {
    /// Returns the body in the frame of an entity that is at `place`.
    fn shape(&self, place: &Place) -> Shape {
        let point = |p: Vec3| place.vector(p).to_array();
        let both = |ends: [Vec3; 2]| ends.map(point);
        let size = |radius: f32| place.scale * f64::from(radius);
        match *self {
            Self::Ball { center, radius } => {
                Shape::Ball { center: point(center), radius: size(radius) }
            }
            Self::Capsule { ends, radius } => {
                Shape::Capsule { ends: both(ends), radius: size(radius) }
            }
            Self::Inside { ends, radius } => {
                Shape::Inside { ends: both(ends), radius: size(radius) }
            }
            Self::Half { point: at, normal } => {
                Shape::Half { point: point(at), normal: point(normal) }
            }
        }
    }
}

/// The bodies that the bone of an entity does not enter. They hold for the bones below, too, up to
/// the next one with a list of its own.
#[derive(Clone, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct SpringColliders {
    /// The radius of the ball around the tip in metres, which is not scaled.
    pub radius: f32,
    /// The coefficient of friction on the bodies.
    pub friction: f32,
    /// The entities with a [`SpringCollider`].
    #[entities]
    pub bodies: Vec<Entity>,
}

/// A wind: the acceleration in m/s² that it adds to gravity, in space, for the bones of its entity
/// and below, up to the next wind. For gusts, set it in each frame.
#[derive(Clone, Copy, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct Wind(pub Vec3);

/// A [`SpringCollider`] in the scene.
#[derive(Clone, Copy, Debug)]
struct Body {
    collider: Collider,
    /// The scale of the shape.
    scale: f64,
    mirrored: bool,
    /// The shape is another one than in the last frame.
    fresh: bool,
}

/// The bodies, centers and winds of the scene.
#[derive(Debug, Default)]
pub(crate) struct Around {
    /// The frames of bodies and centers.
    pub(crate) frames: EntityHashMap<Led>,
    bodies: EntityHashMap<Body>,
    winds: EntityHashMap<Joint<3>>,
}

/// The entities whose [`SpringColliders`] and [`Wind`] a bone has now.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Felt {
    colliders: Option<Entity>,
    wind: Option<Entity>,
}

/// The bodies, the lists of them, and the winds.
#[derive(SystemParam)]
pub(crate) struct Surroundings<'w, 's> {
    bodies: Query<'w, 's, (Entity, Ref<'static, SpringCollider>)>,
    lists: Query<'w, 's, Ref<'static, SpringColliders>>,
    winds: Query<'w, 's, (Entity, &'static Wind)>,
}

impl Pendulums {
    /// Tells the scene where bodies and centers are, or adds their frames.
    pub(crate) fn stand(&mut self, surroundings: &Surroundings, paused: bool, rig: &Rig) {
        let bodies = surroundings.bodies.iter().map(|(entity, _)| entity);
        let centers = rig.centers.iter().filter_map(|center| center.0);
        let wanted: EntityHashSet = bodies.chain(centers).collect();
        for &entity in &wanted {
            let Some(place) = rig.stand(entity) else { continue };
            let to = (place.position, place.rotation);
            let told = match self.around.frames.get_mut(&entity) {
                Some(frame) => frame.lead(&mut self.scene, to, [paused, rig.is_teleported(entity)]),
                None => Led::new(&mut self.scene, to).map(|frame| {
                    self.around.frames.insert(entity, frame);
                }),
            };
            report("frame", entity, told);
        }
        // What hung on the others has been removed before.
        self.around.frames.retain(|entity, frame| {
            wanted.contains(entity) || frame.remove(&mut self.scene).is_err()
        });
    }

    /// Tells the scene bodies and winds, and each bone which of them it feels.
    pub(crate) fn surround(&mut self, surroundings: &Surroundings, rig: &Rig) {
        let Surroundings { bodies, lists, winds } = surroundings;
        for (entity, body) in bodies {
            self.around.shape(entity, &body, rig);
        }
        for (entity, wind) in winds {
            let acceleration = wind.0.as_dvec3().to_array();
            let told = match self.around.winds.get(&entity) {
                Some(&joint) => self.scene.move_to(joint, acceleration),
                None => self.scene.live(acceleration).map(|joint| {
                    self.around.winds.insert(entity, joint);
                }),
            };
            report("wind", entity, told);
        }
        let Around { bodies: known, winds: blowing, .. } = &mut self.around;
        let mut gone = EntityHashSet::default();
        known.retain(|&entity, _| bodies.contains(entity) || !gone.insert(entity));
        // A wind of the scene carries nothing, so that it can always be removed.
        blowing.retain(|&entity, joint| {
            winds.contains(entity) || self.scene.remove_joint(*joint).is_err()
        });
        let changed = |list: &SpringColliders| {
            list.bodies.iter().any(|entity| {
                known.get(entity).is_some_and(|body| body.fresh) || gone.contains(entity)
            })
        };
        for slot in &mut self.slots {
            let State::Hung(Hung { bone, .. }) = slot.state else { continue };
            let nearest = Felt {
                colliders: rig.upwards(slot.entity).find(|&entity| lists.contains(entity)),
                wind: rig.upwards(slot.entity).find(|&entity| winds.contains(entity)),
            };
            let before = core::mem::replace(&mut slot.felt, nearest);
            let list = nearest.colliders.and_then(|entity| lists.get(entity).ok());
            let news = list.as_ref().is_some_and(|list| list.is_changed() || changed(list));
            if news || before.colliders != nearest.colliders {
                let [radius, friction] = list
                    .as_ref()
                    .map_or([0.0; 2], |list| [list.radius, list.friction].map(f64::from));
                let named = list.iter().flat_map(|list| &list.bodies);
                let own: Vec<_> =
                    named.filter_map(|entity| Some(known.get(entity)?.collider)).collect();
                let told = with!(bone, bone => self
                    .scene
                    .set_colliders(bone, radius, &own)
                    .and_then(|()| self.scene.set_friction(bone, friction)));
                report("bone", slot.entity, told);
            }
            let wind = nearest.wind.and_then(|entity| blowing.get(&entity).copied());
            if before.wind != nearest.wind {
                let told = with!(bone, bone => self.scene.set_wind(bone, wind));
                report("bone", slot.entity, told);
            }
        }
        known.values_mut().for_each(|body| body.fresh = false);
    }
}

impl Around {
    /// Finds the shape of a body that has changed, or adds it on its frame.
    fn shape(&mut self, entity: Entity, body: &Ref<SpringCollider>, rig: &Rig) {
        let (Some(place), Some(led)) = (rig.stand(entity), self.frames.get(&entity)) else {
            return;
        };
        let known = self.bodies.get(&entity);
        if body.is_changed()
            || known.is_none_or(|known| {
                known.mirrored != place.mirrored || other(known.scale, place.scale)
            })
        {
            let collider = Collider { frame: led.joints, shape: body.shape(&place) };
            let Place { scale, mirrored, .. } = place;
            self.bodies.insert(entity, Body { collider, scale, mirrored, fresh: true });
        }
    }
}
