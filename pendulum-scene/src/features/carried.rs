//! Joints that pendulums carry, and chains of bones.

use crate::bone::AnyBone;
use crate::error::SceneError;
use crate::group::carry::frames;
use crate::handle::Handle;
use crate::sampling::carried::{Carried, Carrier, Ride};
use crate::sampling::joint::{Joint, erase};
use crate::sampling::live::check_position;
use crate::sampling::world::MOST_NUMBERS;
use crate::scene::Scene;
use crate::system::{Layouts, ORDERS, SceneSystem};
use pendulum_core::attitude::Attitude;
use pendulum_core::motion::Sample;
use pendulum_core::scalar::Float;

impl<T: Float> Scene<T> {
    /// Adds a joint that a pendulum carries: its position is the output of this name, a vector of
    /// `D` components or, for a `Joint<4>`, a rotation. What hangs on the joint acts not back.
    ///
    /// The joint is where the output is at the beginning and at the end of each tick, with its
    /// velocity and acceleration, and on a polynomial of degree five in between. It is never late:
    /// in each tick a pendulum moves before all that hangs on it. A joint exists only after the
    /// pendulum that carries it, and a pendulum after its joints, so nothing hangs on itself.
    /// Scenes with such joints advance tick by tick.
    ///
    /// While its pendulum sleeps, is hidden or has failed, the joint is fixed to it. What a program
    /// changes between ticks, such as the state of the pendulum or the place of its own joint,
    /// moves the joint without being felt, as a [teleport](Self::teleport). A jump in the velocity
    /// of a motion is felt where the pendulum hangs at its time, and on the joint within the tick.
    ///
    /// # Errors
    /// Returns an error if the pendulum belongs to another scene, if it has no output of this name
    /// and shape, if the output depends on velocities or control inputs, or if a motion that drives
    /// the pendulum has no velocity or acceleration.
    pub fn joint_on<S: SceneSystem<T, N>, const N: usize, const D: usize>(
        &mut self,
        pendulum: Handle<S, N>,
        output: &str,
    ) -> Result<Joint<D>, SceneError> {
        self.carry_output(pendulum, output, None)
    }

    /// Adds a frame that a pendulum carries, as [`joint_on`](Self::joint_on) does: a joint at the
    /// place `aside` from the position of one output, along the axes of another output, a rotation,
    /// and one with the attitude of the latter after a first turn by `rest`. The pair is an anchor
    /// of systems with two driven inputs, such as a [`Bone`](crate::Bone), whose attitude at rest
    /// relative to the pendulum is `rest`.
    ///
    /// # Errors
    /// As for [`joint_on`](Self::joint_on), or if `aside` or `rest` is infinite or NaN.
    pub fn frame_on<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulum: Handle<S, N>,
        [position, attitude]: [&str; 2],
        aside: [f64; 3],
        rest: Attitude,
    ) -> Result<(Joint<3>, Joint<4>), SceneError> {
        let rest = rest.to_quaternion();
        check_position(self.world.next_joint(), &aside)?;
        check_position(self.world.next_joint(), &rest)?;
        let (_, frame) = self.bundle(|scene| {
            let position = scene.carry_output(pendulum, position, None)?;
            Ok((position, scene.carry_output(pendulum, attitude, Some(rest))?))
        })?;
        let place = self.parts_of(pendulum)?.0.place_of(pendulum.index());
        if aside != [0.0; 3]
            && let Some(carrier) = self.world.carriers.get_mut(&place)
            && let [.., position, attitude] = &mut carrier.rides[..]
        {
            position.aside = Some((attitude.output, aside));
            carrier.known[0].clear();
            self.carry_from(place);
        }
        Ok(frame)
    }

    fn carry_output<S: SceneSystem<T, N>, const N: usize, const D: usize>(
        &mut self,
        pendulum: Handle<S, N>,
        name: &str,
        rest: Option<[f64; 4]>,
    ) -> Result<Joint<D>, SceneError> {
        const {
            assert!(
                Layouts::<S, N>::EVERYTHING.width <= MOST_NUMBERS,
                "a pendulum that carries joints has at most 32 components of driven inputs"
            );
        };
        let (group, world) = self.parts_of(pendulum)?;
        let wrong = |required| SceneError::Output { name: name.to_owned(), required };
        let outputs = S::FACTS.outputs;
        let Some(index) = outputs.iter().position(|output| output.name == name) else {
            return Err(wrong("an output of the pendulum"));
        };
        let output = outputs[index];
        if output.members.is_some() || output.components.unwrap_or(1) != D || 4 < D {
            return Err(wrong("a vector with the components of the joint, and no family"));
        }
        if rest.is_some() && !output.rotation {
            return Err(wrong("a rotation"));
        }
        if group.output_of_more(world, pendulum.index(), index) {
            return Err(wrong("independent of velocities and control inputs"));
        }
        for (input, drive) in world.drives(group.joints(pendulum.index())).enumerate() {
            let missing = ORDERS.iter().position(|order| !drive.has().contains(*order));
            if let Some(derivative) = missing {
                let input = S::FACTS.inputs.get(input).map_or("", |input| input.name);
                return Err(SceneError::Derivative { input, derivative });
            }
        }
        let place = group.place_of(pendulum.index());
        let slot = erase(Carried::<D>::new(world.now()), world.clock.rate());
        let joint = world.add_joint(slot);
        let states = [Sample::zero(); 2];
        world.carried[joint.0 as usize] = Some(place);
        let carrier = world.carriers.entry(place);
        let (frames, known) = (frames::<S, T, N>, [Vec::new(), Vec::new()]);
        let carrier = carrier.or_insert(Carrier { frames, rides: Vec::new(), known });
        carrier.known[0].clear();
        carrier.rides.push(Ride { joint: joint.0, output: index, rest, aside: None, states });
        if let Some(bundle) = &mut self.bundle {
            bundle.joints.push(joint);
        }
        self.carry_from(place);
        Ok(Joint::new(self.id, joint))
    }

    /// Hangs a chain of bones: the first one on the frame of `anchor`, each other one on the tip of
    /// the one before, all with its center if they have one. Settings along the chain, such as
    /// lengths or frequencies, are those of the bones. The bones begin at rest along the axis y of
    /// the frame; [`reset_to_rest`](Self::reset_to_rest), called from the first bone to the last
    /// one, lets them hang under gravity.
    ///
    /// Each bone acts on the next one and not back. For a chain that bends at its joints at rest,
    /// hang each bone on [`frame_on`](Self::frame_on).
    ///
    /// ```
    /// use pendulum_runtime::attitude::Attitude;
    /// use pendulum_runtime::scene::{Bone, Scene, SceneError};
    ///
    /// let mut scene = Scene::<f64>::new(240.0)?;
    /// let head = scene.live_frame([0.0, 1.7, 0.0], Attitude::identity())?;
    /// // Softer towards the tip.
    /// let bones = (0..5).map(|k| Bone::swinging(0.06, 3.0 - 0.4 * f64::from(k), 0.3));
    /// let ear = scene.hang_chain(head, bones.collect::<Result<Vec<_>, _>>()?)?;
    /// for frame in 1..=10 {
    ///     scene.move_to(head.0, [0.01 * f64::from(frame), 1.7, 0.0])?;
    ///     scene.advance(1.0 / 60.0)?;
    /// }
    /// let attitudes = ear.iter().map(|&bone| scene.pose(bone, scene.alpha()));
    /// # assert_eq!(attitudes.count(), 5);
    /// # assert!(scene.state(ear[0]).0[0] < 1.0);
    /// # Ok::<(), SceneError>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if a joint of the frame belongs to another scene, or if a bone is too fast;
    /// then no bone is hung.
    pub fn hang_chain<B: AnyBone<T>>(
        &mut self,
        anchor: B::Anchor,
        bones: impl IntoIterator<Item = B>,
    ) -> Result<Vec<Handle<B, 4>>, SceneError> {
        let ((_, turn), center) = B::frame(anchor);
        turn.of(self.living())?;
        if let Some(center) = center {
            center.of(self.living())?;
        }
        let (_, handles) = self.bundle(|scene| {
            let mut handles: Vec<Handle<B, 4>> = Vec::new();
            for bone in bones {
                let anchor = match handles.last() {
                    None => anchor,
                    Some(&last) => {
                        let identity = Attitude::identity();
                        B::on(anchor, scene.frame_on(last, ["tip", "turn"], [0.0; 3], identity)?)
                    }
                };
                let ((_, turn), center) = B::frame(anchor);
                let mut attitude = scene.joint_pose(turn, 1.0);
                if let Some(center) = center {
                    let [center, turn] = [scene.joint_pose(center, 1.0), attitude]
                        .map(|pose| Attitude::from_quaternion(pose.map(Float::to_f64)));
                    attitude = (center.inverse() * turn).to_quaternion().map(T::from_f64);
                }
                handles.push(scene.hang(anchor, bone, attitude, [T::from_f64(0.0); 4])?);
            }
            Ok(handles)
        })?;
        Ok(handles)
    }
}
