//! Bones that spring back: hair, ears, tails, strips of cloth.

use crate::error::SceneError;
use crate::sampling::joint::{Anchored, Joint};
use crate::system::SceneSystem;
use core::f64::consts::TAU;
use pendulum_core::lagrangian;
use pendulum_core::scalar::Float;

lagrangian! {
    /// A bone that springs back to the attitude of a frame that moves and turns.
    ///
    /// The bone begins at `x` and points along the axis y of its attitude `R`; at rest `R` is the
    /// attitude `P` of the frame, unless gravity bends it. It is a point mass at its tip whose
    /// inertia about the bone itself, `m*length^2`, is that of the swing: a turn about any axis has
    /// the same frequency, and the twist springs back as the swing does. All terms are divided by
    /// `m*length^2`, because the mass has no effect.
    ///
    /// The three products of directions add up to 1 + 2 cos of the angle between both attitudes. A
    /// spring between the directions y and one between the directions x, which do not have this
    /// symmetry, would bend the direction of rest away from the sum of spring and gravity.
    ///
    /// The damping acts on the angular velocity relative to the frame, so that a frame that turns
    /// steadily takes the bone with it.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Bone {
        /// Distance from the joint to the tip.
        length: m,
        /// Torque of the spring for a sine of one, per moment of inertia: the square of the angular
        /// frequency without gravity.
        stiffness: 1/s^2,
        /// Damping torque per moment of inertia and relative angular velocity: twice the damping
        /// ratio times the angular frequency.
        damping: 1/s,
        /// Acceleration of gravity in space.
        gravity: [m/s^2; 3] = [0, 0, 0],
    }

    driven x: [m; 3];
    driven P: rotation;
    coordinate R: rotation;

    let d = R*[0, 1, 0];

    kinetic = |angular_velocity(R)|^2/2 + inner(dot(x), dot(d))/length;
    potential = -inner(gravity, d)/length - stiffness/2*(
        inner(R*[1, 0, 0], P*[1, 0, 0]) + inner(d, P*[0, 1, 0]) + inner(R*[0, 0, 1], P*[0, 0, 1])
    );
    dissipation = damping/2*|angular_velocity(R) - angular_velocity(P)|^2;

    output tip: [m; 3] = x + length*d;
    output turn: rotation = R;
}

lagrangian! {
    /// A [`Bone`] whose inertia counts in the space of a center that moves and turns, as the node
    /// `center` of VRM asks for: what the center does is not felt, only motion relative to it.
    ///
    /// The center has the place `c` and the attitude `Q`, with the angular velocity Ω. The bone
    /// moves as a `Bone` on the joint y = Qᵀ(x − c), with the frame QᵀP, under the gravity Qᵀg. In
    /// space, it therefore feels less by the acceleration c̈ + Ω̇ × r + 2Ω × ṙ − Ω × (Ω × r) of its
    /// joint, r = x − c, and turns with Ω. A center that goes half of a way takes half of it away.
    ///
    /// The coordinate `S` is the attitude relative to the center, so that a teleport of the center
    /// turns the bone too. The attitude in space is the output `turn`.
    #[derive(Clone, Debug, PartialEq)]
    pub struct CenteredBone {
        /// As for [`Bone`].
        length: m,
        /// As for [`Bone`].
        stiffness: 1/s^2,
        /// As for [`Bone`].
        damping: 1/s,
        /// As for [`Bone`], along the axes of space.
        gravity: [m/s^2; 3] = [0, 0, 0],
    }

    driven x: [m; 3];
    driven P: rotation;
    driven c: [m; 3];
    driven Q: rotation;
    coordinate S: rotation;

    let R = Q*S;
    let e = S*[0, 1, 0];
    let d = Q*e;
    let y = transpose(Q)*(x - c);

    kinetic = |angular_velocity(S)|^2/2 + inner(dot(y), dot(e))/length;
    potential = -inner(gravity, d)/length - stiffness/2*(
        inner(R*[1, 0, 0], P*[1, 0, 0]) + inner(d, P*[0, 1, 0]) + inner(R*[0, 0, 1], P*[0, 0, 1])
    );
    dissipation = damping/2*|angular_velocity(R) - angular_velocity(P)|^2;

    output tip: [m; 3] = x + length*d;
    output turn: rotation = R;
}

/// A position and an attitude.
pub(crate) type Frame = (Joint<3>, Joint<4>);

/// A bone of a scene: a [`Bone`] on a frame, or a [`CenteredBone`] on a frame and a center.
pub trait AnyBone<T: Float>:
    SceneSystem<T, 4, Inputs: Anchored<Self::Anchor>> + Framed<Self::Anchor>
{
    /// The joints on which the bone hangs.
    type Anchor: Copy;
}

/// The frame in an anchor. No other crate names this trait, because limits know these bones only.
pub trait Framed<A> {
    /// Returns the frame, and the attitude of the center.
    fn frame(anchor: A) -> (Frame, Option<Joint<4>>);

    /// Returns an anchor on another frame.
    fn on(anchor: A, frame: Frame) -> A;
}

impl<T: Float> AnyBone<T> for Bone<T> {
    type Anchor = Frame;
}

impl<T> Framed<Frame> for Bone<T> {
    fn frame(anchor: Frame) -> (Frame, Option<Joint<4>>) {
        (anchor, None)
    }

    fn on(_: Frame, frame: Frame) -> Frame {
        frame
    }
}

/// A frame and a center.
type Centered = (Joint<3>, Joint<4>, Joint<3>, Joint<4>);

impl<T: Float> AnyBone<T> for CenteredBone<T> {
    type Anchor = Centered;
}

impl<T> Framed<Centered> for CenteredBone<T> {
    fn frame((place, turn, _, center): Centered) -> (Frame, Option<Joint<4>>) {
        ((place, turn), Some(center))
    }

    fn on((.., place, turn): Centered, frame: Frame) -> Centered {
        (frame.0, frame.1, place, turn)
    }
}

impl<T: Float> Bone<T> {
    /// Creates a bone of a length in metres that swings with `frequency`, in Hz, and whose swing
    /// decays with the damping ratio `ratio`: 0 swings for ever, 1 returns without overshooting.
    ///
    /// Gravity g, which [`under`](Self::under) sets, adds to the spring: about its direction of
    /// rest the bone swings with the angular frequency √|ω²a + g/L|, where a is the direction of
    /// the frame and ω = 2π·`frequency`.
    ///
    /// # Errors
    /// Returns an error if the length or the frequency is not positive and finite, or if the ratio
    /// is negative, infinite or NaN.
    pub fn swinging(length: f64, frequency: f64, ratio: f64) -> Result<Self, SceneError> {
        let omega = TAU * positive("frequency", frequency)?;
        let damping = 2.0 * not_negative("ratio", ratio)? * omega;
        Self::springy(positive("length", length)?, omega * omega, damping)
    }

    fn springy(length: f64, stiffness: f64, damping: f64) -> Result<Self, SceneError> {
        let [length, stiffness, damping] = [length, stiffness, damping].map(T::from_f64);
        let short = T::from_f64(1.0) / length;
        let wrong = [("stiffness", stiffness), ("damping", damping), ("1/length", short)];
        match wrong.into_iter().find(|(_, value)| !value.is_finite()) {
            Some((name, value)) => {
                Err(SceneError::Setting { name, value: value.to_f64(), required: "finite" })
            }
            None => Ok(Self::new(length, stiffness, damping)),
        }
    }

    /// Returns the bone under the acceleration of gravity `gravity` in m/s², a vector in space.
    #[must_use]
    pub fn under(self, gravity: [f64; 3]) -> Self {
        Self { gravity: gravity.map(T::from_f64), ..self }
    }

    /// Returns the bone with a center, the joints of whose place and attitude follow those of the
    /// frame in the anchor.
    ///
    /// ```
    /// use pendulum_runtime::attitude::Attitude;
    /// use pendulum_runtime::scene::{Bone, Scene};
    ///
    /// let mut scene = Scene::<f64>::new(240.0)?;
    /// let hips = scene.live_frame([0.0, 1.0, 0.0], Attitude::identity())?;
    /// let head = scene.live_frame([0.0, 1.7, 0.0], Attitude::identity())?;
    /// let bone = Bone::swinging(0.1, 2.0, 0.3)?.centered();
    /// let bones = [bone.clone(), bone];
    /// let ear = scene.hang_chain((head.0, head.1, hips.0, hips.1), bones)?;
    /// // The character walks, and its ear hangs still.
    /// for frame in 1..=60 {
    ///     let z = 0.02 * f64::from(frame);
    ///     scene.move_to(hips.0, [0.0, 1.0, z])?;
    ///     scene.move_to(head.0, [0.0, 1.7, z])?;
    ///     scene.advance(1.0 / 60.0)?;
    /// }
    /// assert!(scene.state(ear[1]).0[1].abs() < 1e-12);
    /// # Ok::<(), pendulum_runtime::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn centered(self) -> CenteredBone<T> {
        let Self { length, stiffness, damping, gravity } = self;
        CenteredBone { length, stiffness, damping, gravity }
    }
}

/// The settings of a spring bone by the names of `VRMC_springBone`, with the defaults of its
/// specification.
///
/// In each frame, the formula of the specification moves the tip by the way of the last frame times
/// 1 − `dragForce`, and by `stiffness` along the direction of rest and `gravityPower` along
/// `gravityDir`, both times the *duration* of the frame, not its square. Its motion therefore
/// depends on the frame rate, and the settings are accelerations only at one rate:
/// [`frame_rate`](Self::frame_rate), for which artists have chosen them.
///
/// A [`Bone`] of the length L with the accelerations 60·`stiffness` and 60·`gravityPower` and the
/// damping 60·`dragForce` per second has the same direction of rest, and moves as the formula does
/// at 60 frames a second, up to the error of the formula. It does so at every frame rate. The drag
/// of the formula acts on the velocity in space; that of the bone on the velocity relative to its
/// frame, as if `center` were the parent.
///
/// ```
/// use pendulum_runtime::scene::{Bone, VrmSpring};
///
/// let spring = VrmSpring { stiffness: 2.0, drag_force: 0.3, ..VrmSpring::default() };
/// let bone: Bone = spring.bone(0.1)?;
/// assert_eq!((bone.stiffness, bone.damping), (1200.0, 18.0));
/// # Ok::<(), pendulum_runtime::scene::SceneError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VrmSpring {
    /// `stiffness`: the force towards the direction of rest.
    pub stiffness: f64,
    /// `gravityPower`: the magnitude of gravity.
    pub gravity_power: f64,
    /// `gravityDir`: the direction of gravity.
    pub gravity_dir: [f64; 3],
    /// `dragForce`: the deceleration, from 0 to 1.
    pub drag_force: f64,
    /// The number of frames per second at which the formula is to be matched.
    pub frame_rate: f64,
}

impl Default for VrmSpring {
    fn default() -> Self {
        Self {
            stiffness: 1.0,
            gravity_power: 0.0,
            gravity_dir: [0.0, -1.0, 0.0],
            drag_force: 0.5,
            frame_rate: 60.0,
        }
    }
}

impl VrmSpring {
    /// Returns a bone with these settings and a length in metres.
    ///
    /// # Errors
    /// Returns an error if the length or the frame rate is not positive and finite, if the
    /// stiffness or the drag is negative, infinite or NaN, or if gravity is infinite or NaN.
    pub fn bone<T: Float>(&self, length: f64) -> Result<Bone<T>, SceneError> {
        let (length, rate) = (positive("length", length)?, positive("frameRate", self.frame_rate)?);
        let stiffness = rate * not_negative("stiffness", self.stiffness)? / length;
        let damping = rate * not_negative("dragForce", self.drag_force)?;
        let gravity = self.gravity_dir.map(|part| rate * self.gravity_power * part);
        if let Some(&value) = gravity.iter().find(|part| !part.is_finite()) {
            return Err(SceneError::Setting { name: "gravity", value, required: "finite" });
        }
        Ok(Bone::springy(length, stiffness, damping)?.under(gravity))
    }
}

fn positive(name: &'static str, value: f64) -> Result<f64, SceneError> {
    if 0.0 < value && value < f64::INFINITY {
        return Ok(value);
    }
    Err(SceneError::Setting { name, value, required: "positive and finite" })
}

fn not_negative(name: &'static str, value: f64) -> Result<f64, SceneError> {
    if (0.0..f64::INFINITY).contains(&value) {
        return Ok(value);
    }
    Err(SceneError::Setting { name, value, required: "zero or positive" })
}
