//! Colliders, bounds and winds of bones.

use crate::bone::AnyBone;
use crate::contact::{Bound, Collider, Limit};
use crate::error::SceneError;
use crate::handle::Handle;
use crate::sampling::joint::Joint;
use crate::scene::Scene;
use pendulum_core::scalar::Float;

impl<T: Float> Scene<T> {
    /// Sets the bodies that a bone does not enter, in place of earlier ones, and the radius of the
    /// bone, a capsule from its joint to its tip.
    ///
    /// At the end of each tick, a bone that has entered a body is turned about its joint until it
    /// touches the surface, and the part of its velocity that would lead into the body again is
    /// taken away: an impact without restitution, by the impulse at the point of contact, and
    /// without friction unless [`set_friction`](Self::set_friction) sets it. What the bone gains
    /// against its forces on its way out is taken from its velocity as well, so that on bodies and
    /// frames that rest the energy never grows; those that move do work. A bone that is inside
    /// already leaves without velocity, at once or at the speed of
    /// [`set_push_out`](Self::set_push_out).
    ///
    /// No ball or capsule passes a bone, however fast: if one may do so within a tick, the tick is
    /// divided, and the body pushes the bone aside along its way, without giving it velocity. What
    /// a motion jumps over is not on its way. No body lets a bone turn faster than by a radian per
    /// tick.
    ///
    /// Between bodies that close on it, a bone slips out to a side. If there is no room, as between
    /// two planes, it stays between them without velocity, with equal depths. A ball or capsule that
    /// contains the joint of the bone, as a head does with the roots of hair, holds only the tip.
    /// States of rest, of [`reset_to_rest`](Self::reset_to_rest) and of pendulums that are shown
    /// again, know no bodies; the next tick does. Scenes with limited bones advance tick by tick.
    ///
    /// ```
    /// use pendulum_runtime::attitude::Attitude;
    /// use pendulum_runtime::scene::{Bone, Bound, Collider, Scene, Shape};
    ///
    /// let mut scene = Scene::<f64>::new(240.0)?;
    /// let aside = Attitude::from_axis_angle([0.0, 0.0, 1.0], 1.5);
    /// let head = scene.live_frame([0.0, 0.3, 0.0], aside)?;
    /// let chest = scene.live_frame([0.0; 3], Attitude::identity())?;
    /// let bone = Bone::swinging(0.25, 0.5, 0.3)?.under([0.0, -9.81, 0.0]);
    /// let hair = scene.hang_chain(head, [bone])?;
    /// let shape = Shape::Ball { center: [-0.1, 0.0, 0.0], radius: 0.15 };
    /// scene.set_colliders(hair[0], 0.01, &[Collider { frame: chest, shape }])?;
    /// scene.set_bounds(hair[0], &[Bound::Cone(1.2)])?;
    /// scene.advance(0.5)?;
    /// # Ok::<(), pendulum_runtime::scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if the bone or a joint of a collider belongs to another scene, if a number
    /// is infinite or NaN, if a radius is negative or that of
    /// [`Shape::Inside`](crate::Shape::Inside) zero, or if a collider is carried by the bone or by a
    /// pendulum that moves after it.
    pub fn set_colliders<B: AnyBone<T>>(
        &mut self,
        bone: Handle<B, 4>,
        radius: f64,
        colliders: &[Collider],
    ) -> Result<(), SceneError> {
        if !(0.0..f64::INFINITY).contains(&radius) {
            let required = "zero or positive";
            return Err(SceneError::Setting { name: "radius", value: radius, required });
        }
        let (group, _) = self.parts_of(bone)?;
        let (level, ..) = group.place_of(bone.index());
        for Collider { frame, shape } in colliders {
            shape.check()?;
            let joints = [frame.0.of(self.living())?, frame.1.of(self.living())?];
            self.check_level("level of a collider", level, &joints)?;
        }
        let colliders = colliders.to_vec();
        self.change_limit(bone, |limit| (limit.radius, limit.colliders) = (radius, colliders))
    }

    /// Sets the speed in m/s at which a bone leaves a body that contains it, as after a teleport or
    /// where a body appears: its depth decreases by so much in a second. At first the speed is
    /// infinite, and the bone leaves at once.
    ///
    /// The bone is turned out without velocity. What it has not been inside of at the beginning of
    /// a tick, it does not enter, whatever the speed.
    ///
    /// ```
    /// use pendulum_runtime::attitude::Attitude;
    /// use pendulum_runtime::scene::{Bone, Collider, Scene, Shape};
    ///
    /// let mut scene = Scene::<f64>::new(240.0)?;
    /// let head = scene.live_frame([0.0; 3], Attitude::identity())?;
    /// let ear = scene.hang_chain(head, [Bone::swinging(0.1, 2.0, 0.3)?])?;
    /// let shape = Shape::Ball { center: [0.01, 0.1, 0.0], radius: 0.04 };
    /// scene.set_colliders(ear[0], 0.0, &[Collider { frame: head, shape }])?;
    /// scene.set_push_out(ear[0], 0.1)?; // 3 cm in 0.3 s
    /// # Ok::<(), pendulum_runtime::scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if the bone belongs to another scene, or if the speed is not positive.
    pub fn set_push_out<B: AnyBone<T>>(
        &mut self,
        bone: Handle<B, 4>,
        speed: f64,
    ) -> Result<(), SceneError> {
        if speed.is_nan() || speed <= 0.0 {
            let required = "positive";
            return Err(SceneError::Setting { name: "speed", value: speed, required });
        }
        self.change_limit(bone, |limit| limit.push_out = speed)
    }

    /// Sets the coefficient of friction of a bone on its colliders, which is zero at first.
    ///
    /// Where a bone touches a body, friction takes away what it slips across itself relative to the
    /// surface, by at most the coefficient times what the contact changes along the normal
    /// (Coulomb). A bone at rest sticks, up to the slope whose tangent is the coefficient, and a
    /// body that moves or turns drags it along. Slip along the bone is left to its joint. On bodies
    /// that rest the energy never grows. A body that would have passed the bone within a tick
    /// pushes it without friction.
    ///
    /// ```
    /// use pendulum_runtime::attitude::Attitude;
    /// use pendulum_runtime::scene::{Bone, Collider, Scene, Shape};
    ///
    /// let mut scene = Scene::<f64>::new(240.0)?;
    /// let head = scene.live_frame([0.0; 3], Attitude::identity())?;
    /// let ear = scene.hang_chain(head, [Bone::swinging(0.1, 2.0, 0.3)?])?;
    /// let shape = Shape::Ball { center: [0.04, 0.1, 0.0], radius: 0.04 };
    /// scene.set_colliders(ear[0], 0.0, &[Collider { frame: head, shape }])?;
    /// scene.set_friction(ear[0], 0.4)?;
    /// # Ok::<(), pendulum_runtime::scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if the bone belongs to another scene, or if the coefficient is negative,
    /// infinite or NaN.
    pub fn set_friction<B: AnyBone<T>>(
        &mut self,
        bone: Handle<B, 4>,
        coefficient: f64,
    ) -> Result<(), SceneError> {
        if !(0.0..f64::INFINITY).contains(&coefficient) {
            let required = "zero or positive";
            return Err(SceneError::Setting { name: "friction", value: coefficient, required });
        }
        self.change_limit(bone, |limit| limit.friction = coefficient)
    }

    /// Sets the bounds of a bone, a cone, a hinge or a twist, in place of earlier ones.
    ///
    /// A bone beyond a bound is turned back at the end of each tick, and loses the velocity relative
    /// to its frame that leads out of it. Bounds and bodies take turns, as bodies do.
    ///
    /// ```
    /// use pendulum_runtime::attitude::Attitude;
    /// use pendulum_runtime::scene::{Bone, Bound, Scene};
    ///
    /// let mut scene = Scene::<f64>::new(240.0)?;
    /// let head = scene.live_frame([0.0; 3], Attitude::identity())?;
    /// let ear = scene.hang_chain(head, [Bone::swinging(0.1, 2.0, 0.3)?])?;
    /// // Up to 0.4 rad to all sides, and no more than 0.1 rad of twist.
    /// scene.set_bounds(ear[0], &[Bound::Cone(0.4), Bound::Twist(0.1)])?;
    /// // Forwards only, as a lid.
    /// scene.set_bounds(ear[0], &[Bound::Hinge { axis: [1.0, 0.0, 0.0], from: 0.0, to: 1.2 }])?;
    /// # Ok::<(), pendulum_runtime::scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if the bone belongs to another scene, if an angle is not in its range, or if
    /// an axis has no direction.
    pub fn set_bounds<B: AnyBone<T>>(
        &mut self,
        bone: Handle<B, 4>,
        bounds: &[Bound],
    ) -> Result<(), SceneError> {
        bounds.iter().try_for_each(|bound| bound.check())?;
        self.change_limit(bone, |limit| limit.bounds = bounds.to_vec())
    }

    /// Lets a wind blow on a bone: the position of a joint is the acceleration in m/s² that the wind
    /// adds to gravity, in space. `None` is calm.
    ///
    /// Any motion is a wind: a function of time with gusts, or a live joint that the program moves;
    /// one joint may blow on all bones. The bone feels it once a tick. A gust that is not finite is
    /// not felt, and it is calm when the joint is removed.
    ///
    /// ```
    /// use pendulum_runtime::attitude::Attitude;
    /// use pendulum_runtime::motion::Function;
    /// use pendulum_runtime::scene::{Bone, Scene};
    ///
    /// let mut scene = Scene::<f64>::new(240.0)?;
    /// let head = scene.live_frame([0.0; 3], Attitude::identity())?;
    /// let ear = scene.hang_chain(head, [Bone::swinging(0.1, 2.0, 0.3)?])?;
    /// let gusts = |t: f64| [4.0 + 2.0 * (1.7 * t).sin() * (0.6 * t).sin(), 0.0, 1.0];
    /// let wind = scene.joint(Function::new(gusts));
    /// scene.set_wind(ear[0], Some(wind))?;
    /// # Ok::<(), pendulum_runtime::scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if the bone or the joint belongs to another scene, or if the joint is carried
    /// by the bone or by a pendulum that moves after it.
    pub fn set_wind<B: AnyBone<T>>(
        &mut self,
        bone: Handle<B, 4>,
        wind: Option<Joint<3>>,
    ) -> Result<(), SceneError> {
        let (level, ..) = self.parts_of(bone)?.0.place_of(bone.index());
        if let Some(wind) = wind {
            let joint = wind.of(self.living())?;
            self.check_level("level of a wind", level, &[joint])?;
        }
        self.change_limit(bone, |limit| limit.wind = wind)
    }

    /// Returns an error if joints are carried by pendulums that move after those of a level.
    fn check_level(
        &self,
        name: &'static str,
        level: u32,
        joints: &[u32],
    ) -> Result<(), SceneError> {
        let later = self.world.level(joints);
        if later <= level {
            return Ok(());
        }
        let required =
            "at most that of the bone, because pendulums that hang on others move after them";
        Err(SceneError::Setting { name, value: f64::from(later), required })
    }

    fn change_limit<B: AnyBone<T>>(
        &mut self,
        bone: Handle<B, 4>,
        change: impl FnOnce(&mut Limit),
    ) -> Result<(), SceneError> {
        let (group, world) = self.parts_of(bone)?;
        let place = group.place_of(bone.index());
        group.wake(world, bone.index());
        let limit = self.limits.bones.entry(place).or_insert(Limit {
            radius: 0.0,
            bounds: Vec::new(),
            push_out: f64::INFINITY,
            friction: 0.0,
            wind: None,
            colliders: Vec::new(),
        });
        change(limit);
        let least = limit.push_out == f64::INFINITY && limit.wind.is_none();
        let least = least && limit.friction == 0.0;
        if least && limit.colliders.is_empty() && limit.bounds.is_empty() {
            self.limits.bones.remove(&place);
        }
        Ok(())
    }
}
