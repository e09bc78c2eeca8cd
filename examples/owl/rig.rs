//! The keyed joints of a drawing as motions in the plane, and their feathers.

use crate::{UNITS, dance};
use pendulum_runtime::body::Body;
use pendulum_runtime::import::svg::{Drawing, DrawnJoint, Role};
use pendulum_runtime::motion::{Curve, Derivatives, Motion, Sample, Side};
use pendulum_runtime::prelude::*;
use pendulum_runtime::time::Time;
use std::error::Error;
use std::sync::Arc;

/// The keyed joints and the feathers of a drawing.
#[derive(Clone, Debug)]
pub(crate) struct Rig<'a> {
    pub(crate) keyed: Vec<Keyed<'a>>,
    pub(crate) feathers: Vec<Hung<'a>>,
}

/// A joint moved by keys.
#[derive(Clone, Debug)]
pub(crate) struct Keyed<'a> {
    pub(crate) joint: &'a DrawnJoint,
    /// The turn relative to the parent.
    pub(crate) turn: Arc<Curve<1>>,
    /// The path of a root; other joints have a constant path.
    pub(crate) way: Arc<Curve<2>>,
    /// The absolute angle.
    pub(crate) angle: Angle,
    /// The absolute position of the pivot.
    pub(crate) place: Pivot,
}

/// A feather on a keyed joint.
#[derive(Clone, Debug)]
pub(crate) struct Hung<'a> {
    pub(crate) joint: &'a DrawnJoint,
    /// The index of the keyed joint.
    pub(crate) on: usize,
    pub(crate) body: Body,
    /// The quill relative to the keyed joint, as drawn.
    pub(crate) quill: [f64; 2],
}

/// The angle of a joint: the sum of the turns of the joints from the root to this joint.
#[derive(Clone, Debug, Default)]
pub(crate) struct Angle(Vec<Arc<Curve<1>>>);

/// The pivot of a joint: x(t) + Σ e^{iφ_k} d_k over the joints from the root to its parent.
#[derive(Clone, Debug)]
pub(crate) struct Pivot {
    start: [f64; 2],
    way: Arc<Curve<2>>,
    arms: Vec<(Angle, [f64; 2])>,
}

impl<'a> Rig<'a> {
    /// Combines the joints of a drawing with the motions of the dance.
    pub(crate) fn new(drawing: &'a Drawing) -> Result<Self, Box<dyn Error>> {
        let mut rig = Self { keyed: Vec::new(), feathers: Vec::new() };
        // The index of the keyed joint for each joint of the drawing, if any.
        let mut numbers: Vec<Option<usize>> = Vec::new();
        for joint in &drawing.joints {
            let parent = joint.parent.map(|parent| numbers[parent]);
            match (joint.role, parent, joint.body) {
                (Role::Keyed, None, _) => {
                    let turn = Arc::new(dance::turn(&joint.name)?);
                    let way = Arc::new(dance::way(&joint.name, UNITS.pixel)?);
                    let angle = Angle(vec![turn.clone()]);
                    let place = Pivot { start: joint.pivot, way: way.clone(), arms: Vec::new() };
                    numbers.push(Some(rig.keyed.len()));
                    rig.keyed.push(Keyed { joint, turn, way, angle, place });
                }
                (Role::Keyed, Some(Some(parent)), _) => {
                    let under: &Keyed<'_> = &rig.keyed[parent];
                    let turn = Arc::new(dance::turn(&joint.name)?);
                    let way = Arc::new(dance::way("", UNITS.pixel)?);
                    let mut angle = under.angle.clone();
                    angle.0.push(turn.clone());
                    let mut place = under.place.clone();
                    place.arms.push((under.angle.clone(), between(under.joint, joint)));
                    numbers.push(Some(rig.keyed.len()));
                    rig.keyed.push(Keyed { joint, turn, way, angle, place });
                }
                (Role::Pendulum, Some(Some(on)), Some(body)) => {
                    numbers.push(None);
                    rig.feathers.push(Hung {
                        joint,
                        on,
                        body,
                        quill: between(rig.keyed[on].joint, joint),
                    });
                }
                _ => {
                    return Err(format!(
                        "`{}` does not hang on a keyed joint; put its group into that of one",
                        joint.name
                    )
                    .into());
                }
            }
        }
        if rig.feathers.is_empty() {
            return Err(
                "no pendulum; give a group a shape whose id is the group's and `.pendulum`".into(),
            );
        }
        Ok(rig)
    }
}

fn between(from: &DrawnJoint, to: &DrawnJoint) -> [f64; 2] {
    [to.pivot[0] - from.pivot[0], to.pivot[1] - from.pivot[1]]
}

impl Angle {
    fn at(&self, t: Time, side: Side, wanted: Derivatives) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for turn in &self.0 {
            let Sample { position, velocity, acceleration }: Sample<f64, 1> =
                turn.sample(t, side, wanted);
            for (sum, part) in sum.iter_mut().zip([position, velocity, acceleration]) {
                *sum += part[0];
            }
        }
        sum
    }
}

impl<T: Real> Motion<T, 1> for Angle {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, 1> {
        let [position, velocity, acceleration] =
            self.at(t, side, wanted).map(|value| [T::from_f64(value)]);
        Sample { position, velocity, acceleration }
    }

    /// Returns `None`: periodic splines have no kinks.
    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

impl<T: Real> Motion<T, 2> for Pivot {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, side: Side, wanted: Derivatives) -> Sample<T, 2> {
        let mut sum: Sample<f64, 2> = self.way.sample(t, side, wanted);
        for (axis, start) in self.start.into_iter().enumerate() {
            sum.position[axis] += start;
        }
        for (angle, [a, b]) in &self.arms {
            let [angle, speed, change] = angle.at(t, side, Derivatives::ALL);
            let (sin, cos) = Real::sin_cos(angle);
            let arm = [cos * a - sin * b, sin * a + cos * b];
            let turned = [-arm[1], arm[0]];
            for axis in 0..2 {
                sum.position[axis] += arm[axis];
                sum.velocity[axis] += speed * turned[axis];
                sum.acceleration[axis] += change * turned[axis] - speed * speed * arm[axis];
            }
        }
        let kept = |order: Derivatives, value: [f64; 2]| {
            if wanted.contains(order) { value } else { [0.0; 2] }
        };
        Sample {
            position: kept(Derivatives::POSITION, sum.position),
            velocity: kept(Derivatives::VELOCITY, sum.velocity),
            acceleration: kept(Derivatives::ACCELERATION, sum.acceleration),
        }
        .map(T::from_f64)
    }

    /// Returns `None`: periodic splines have no kinks.
    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::Rig;
    use crate::UNITS;
    use pendulum_runtime::import::svg::Drawing;
    use pendulum_runtime::motion::{Derivatives, Motion, Sample, Side};

    fn drawing() -> Drawing {
        Drawing::read(include_str!("../data/owl.svg"), UNITS).unwrap()
    }

    #[test]
    fn the_owl_has_nine_joints_and_more_than_eighty_feathers() {
        let drawing = drawing();
        let rig = Rig::new(&drawing).unwrap();
        assert_eq!(rig.keyed.len(), 9);
        assert!(80 <= rig.feathers.len());
        // Feathers hang from their ends: the centre is between the quill and the tip.
        for feather in &rig.feathers {
            let [x, y] = feather.body.center;
            let arm = (x * x + y * y).sqrt();
            assert!(0.02 < arm && arm < 0.11, "{}: {arm}", feather.joint.name);
        }
    }

    /// Tests the velocities of the hand of a wing, which depends on three joints, against
    /// differences of its positions.
    #[test]
    fn pivots_have_the_derivatives_of_their_positions() {
        let drawing = drawing();
        let rig = Rig::new(&drawing).unwrap();
        for keyed in &rig.keyed {
            for k in 0..40 {
                let (t, h) = (0.1 * f64::from(k) + 0.013, 1e-4);
                let [before, now, after]: [Sample<f64, 2>; 3] = [t - h, t, t + h]
                    .map(|t| keyed.place.sample(t.into(), Side::After, Derivatives::ALL));
                for axis in 0..2 {
                    let slope = (after.position[axis] - before.position[axis]) / (2.0 * h);
                    let bend = (after.velocity[axis] - before.velocity[axis]) / (2.0 * h);
                    assert!((slope - now.velocity[axis]).abs() < 1e-4, "{}", keyed.joint.name);
                    assert!((bend - now.acceleration[axis]).abs() < 1e-2, "{}", keyed.joint.name);
                }
            }
        }
    }
}
