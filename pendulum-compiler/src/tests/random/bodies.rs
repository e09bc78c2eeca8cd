//! Random trees of one to four solids in space, on ball joints, on hinges and free, against the
//! equations of Newton and Euler. `SOLIDS_COUNT=1000` tests more of them.
//!
//! The accelerations of the block give those of every solid, and these its forces and moments. What
//! a solid and all that it carries need is transmitted by its joint, so that a ball joint has no
//! moment, a hinge none about its axis, and a free solid no force either. Nothing here is derived
//! from an energy.

use super::tests::variable;
use crate::algebra::expr::Symbol;
use crate::compile::derived;
use crate::messages::Errors;
use crate::tests::evaluate;
use random_systems::Random;
use std::fmt::Write;

type Vector = [f64; 3];

/// w, x, y, z.
type Quaternion = [f64; 4];

fn plus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] + b[k])
}

fn times(factor: f64, a: Vector) -> Vector {
    a.map(|part| factor * part)
}

fn minus(a: Vector, b: Vector) -> Vector {
    plus(a, times(-1.0, b))
}

fn inner(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn cross(a: Vector, b: Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}

fn product(a: Quaternion, b: Quaternion) -> Quaternion {
    let (u, v) = ([a[1], a[2], a[3]], [b[1], b[2], b[3]]);
    let [x, y, z] = plus(plus(times(a[0], v), times(b[0], u)), cross(u, v));
    [a[0] * b[0] - inner(u, v), x, y, z]
}

fn back([w, x, y, z]: Quaternion) -> Quaternion {
    [w, -x, -y, -z]
}

fn turned(q: Quaternion, [x, y, z]: Vector) -> Vector {
    let [_, x, y, z] = product(product(q, [0.0, x, y, z]), back(q));
    [x, y, z]
}

#[derive(Clone, Copy, PartialEq)]
enum Joint {
    Free,
    Ball,
    Hinge(Vector),
    /// A ball joint in the angles z, x, z.
    Angles,
}

/// A solid, whose origin is on its joint.
struct Solid {
    parent: Option<usize>,
    joint: Joint,
    /// `true` if the attitude is that in space, else that relative to the parent.
    absolute: bool,
    /// The joint on the parent.
    arm: Vector,
    centre: Vector,
    mass: f64,
    /// About the centre, along the axes of the solid.
    inertia: Vector,
    /// A spring from the centre to a point of space.
    stiffness: f64,
    anchor: Vector,
    /// A torque with components in space.
    torque: Vector,
}

const GRAVITY: f64 = 1.7;

/// A tree of solids, each behind its parent.
struct Tree(Vec<Solid>);

impl Tree {
    fn random(random: &mut Random, most: usize, angles: bool) -> Self {
        let count = 1 + random.below(most);
        let solid = |k: usize| {
            let vector = |random: &mut Random| [(); 3].map(|()| random.uniform(-1.0, 1.0));
            let rooted = k == 0 || random.below(4) == 0;
            let parent = (!rooted).then(|| random.below(k));
            let joint = match random.below(4) {
                0 if rooted => Joint::Free,
                0 | 1 => Joint::Hinge(vector(random)),
                _ if angles => Joint::Angles,
                _ => Joint::Ball,
            };
            Solid {
                parent,
                joint,
                absolute: joint == Joint::Ball && random.below(2) == 0,
                arm: vector(random),
                centre: vector(random),
                mass: random.uniform(0.5, 2.0),
                inertia: [(); 3].map(|()| random.uniform(0.5, 1.0)),
                stiffness: random.uniform(0.0, 2.0),
                anchor: vector(random),
                torque: vector(random),
            }
        };
        Self((0..count).map(solid).collect())
    }

    /// Returns the block, and the values of its parameters.
    fn source(&self) -> (String, Vec<f64>) {
        let mut numbers = vec![GRAVITY];
        let mut number = |value: f64| {
            numbers.push(value);
            format!("p[{}]", numbers.len() - 1)
        };
        let (mut text, mut kinetic, mut potential) = (String::new(), Vec::new(), Vec::new());
        for (k, solid) in self.0.iter().enumerate() {
            let mut vector = |value: Vector| format!("[{}]", value.map(&mut number).join(", "));
            let (arm, centre) = (vector(solid.arm), vector(solid.centre));
            let (anchor, torque) = (vector(solid.anchor), vector(solid.torque));
            let (own, declared) = match solid.joint {
                Joint::Free => (
                    format!("R{k}"),
                    format!("coordinate x{k}: [_; 3]; coordinate R{k}: rotation;"),
                ),
                Joint::Ball => (format!("R{k}"), format!("coordinate R{k}: rotation;")),
                Joint::Hinge(axis) => {
                    (format!("rotation({}, h{k})", vector(axis)), format!("coordinate h{k};"))
                }
                Joint::Angles => (
                    format!(
                        "rotation([0, 0, 1], f{k})*rotation([1, 0, 0], g{k})*rotation([0, 0, 1], h{k})"
                    ),
                    format!("coordinate f{k}; coordinate g{k}; coordinate h{k};"),
                ),
            };
            let attitude = match solid.parent {
                Some(parent) if !solid.absolute => format!("A{parent}*{own}"),
                _ => own,
            };
            let origin = match (solid.parent, solid.joint) {
                (_, Joint::Free) => format!("x{k}"),
                (None, _) => arm,
                (Some(parent), _) => format!("o{parent} + A{parent}*{arm}"),
            };
            let _ = write!(
                text,
                "{declared} let A{k} = {attitude}; let o{k} = {origin};
                 let c{k} = o{k} + A{k}*{centre}; let W{k} = transpose(A{k})*angular_velocity(A{k});
                 torque A{k} = {torque};"
            );
            let mass = number(solid.mass);
            let [x, y, z] = solid.inertia.map(&mut number);
            kinetic.push(format!(
                "{mass}*|dot(c{k})|^2/2 + ({x}*W{k}.x^2 + {y}*W{k}.y^2 + {z}*W{k}.z^2)/2"
            ));
            let stiffness = number(solid.stiffness);
            potential.push(format!("{mass}*p[0]*height(c{k}) + {stiffness}*|c{k} - {anchor}|^2/2"));
        }
        let block = format!(
            "struct Bodies {{ p: [_; {}] }} {text} kinetic = {}; potential = {};",
            numbers.len(),
            kinetic.join(" + "),
            potential.join(" + ")
        );
        (block, numbers)
    }
}

/// The motion of a frame: attitude, angular velocity and acceleration, and position with two
/// derivatives, all with components in space.
#[derive(Clone, Copy)]
struct Frame {
    attitude: Quaternion,
    velocity: Vector,
    acceleration: Vector,
    origin: [Vector; 3],
}

impl Frame {
    const SPACE: Self = Self {
        attitude: [1.0, 0.0, 0.0, 0.0],
        velocity: [0.0; 3],
        acceleration: [0.0; 3],
        origin: [[0.0; 3]; 3],
    };

    /// Returns the position of a point, its velocity and its acceleration.
    fn point(&self, point: Vector) -> [Vector; 3] {
        let arm = turned(self.attitude, point);
        let turning = cross(self.velocity, arm);
        let inward = cross(self.velocity, turning);
        let [x, v, a] = self.origin;
        [plus(x, arm), plus(v, turning), plus(a, plus(cross(self.acceleration, arm), inward))]
    }

    /// Returns the frame behind a quaternion that moves relative to this one.
    fn behind(&self, q: [Quaternion; 3]) -> Self {
        let [own, velocity, acceleration] = q;
        let vector = |[_, x, y, z]: Quaternion| times(2.0, [x, y, z]);
        let turning = turned(self.attitude, vector(product(velocity, back(own))));
        let rate = vector(product(acceleration, back(own)));
        let rate = turned(self.attitude, plus(rate, vector(product(velocity, back(velocity)))));
        Self {
            attitude: product(self.attitude, own),
            velocity: plus(self.velocity, turning),
            acceleration: plus(plus(self.acceleration, rate), cross(self.velocity, turning)),
            origin: self.origin,
        }
    }

    /// Returns the frame behind a turn about an axis that rests in this one.
    fn about(&self, axis: Vector, [angle, rate, acceleration]: [f64; 3]) -> Self {
        let unit = times(inner(axis, axis).sqrt().recip(), axis);
        let [x, y, z] = times((angle / 2.0).sin(), unit);
        let axis = turned(self.attitude, unit);
        let turning = times(rate, axis);
        let turned = plus(times(acceleration, axis), cross(self.velocity, turning));
        Self {
            attitude: product(self.attitude, [(angle / 2.0).cos(), x, y, z]),
            velocity: plus(self.velocity, turning),
            acceleration: plus(self.acceleration, turned),
            origin: self.origin,
        }
    }
}

/// Returns the largest force or moment along a free direction of a joint, relative to the largest
/// term of all.
fn unbalanced(tree: &Tree, [q, v, a]: [&[f64]; 3]) -> f64 {
    let mut place = 0;
    let mut frames: Vec<Frame> = Vec::new();
    for solid in &tree.0 {
        let base = solid.parent.map_or(Frame::SPACE, |parent| frames[parent]);
        let mut frame = Frame { origin: base.point(solid.arm), ..base };
        if solid.absolute {
            frame = Frame { origin: frame.origin, ..Frame::SPACE };
        }
        let mut next = || {
            place += 1;
            [q, v, a].map(|values| values[place - 1])
        };
        if solid.joint == Joint::Free {
            let parts = [next(), next(), next()];
            frame.origin = [0, 1, 2].map(|order| [0, 1, 2].map(|k| parts[k][order]));
        }
        frames.push(match solid.joint {
            Joint::Free | Joint::Ball => {
                let parts = [next(), next(), next(), next()];
                frame.behind([0, 1, 2].map(|order| [0, 1, 2, 3].map(|k| parts[k][order])))
            }
            Joint::Hinge(axis) => frame.about(axis, next()),
            Joint::Angles => {
                let frame = frame.about([0.0, 0.0, 1.0], next());
                frame.about([1.0, 0.0, 0.0], next()).about([0.0, 0.0, 1.0], next())
            }
        });
    }
    // Forces, and moments about the origin of space, that the solids and what they carry need.
    let mut needed = vec![[[0.0; 3]; 2]; tree.0.len()];
    let (mut worst, mut scale) = (0.0f64, 1.0f64);
    for (k, solid) in tree.0.iter().enumerate().rev() {
        let frame = &frames[k];
        let [centre, _, acceleration] = frame.point(solid.centre);
        let spring = times(solid.stiffness, minus(solid.anchor, centre));
        let applied = plus(spring, [0.0, 0.0, -GRAVITY * solid.mass]);
        let force = minus(times(solid.mass, acceleration), applied);
        let along = |u: Vector| turned(back(frame.attitude), u);
        let (rates, turning) = (along(frame.velocity), along(frame.acceleration));
        let momentum = [0, 1, 2].map(|k| solid.inertia[k] * rates[k]);
        let rate = [0, 1, 2].map(|k| solid.inertia[k] * turning[k]);
        let moment = turned(frame.attitude, plus(rate, cross(rates, momentum)));
        let moment = plus(minus(moment, solid.torque), cross(centre, force));
        needed[k] = [plus(needed[k][0], force), plus(needed[k][1], moment)];
        let [force, moment] = needed[k];
        scale =
            [force, moment].into_iter().flatten().fold(scale, |most, part| most.max(part.abs()));
        if let Some(parent) = solid.parent {
            needed[parent] = [plus(needed[parent][0], force), plus(needed[parent][1], moment)];
        }
        let moment = minus(moment, cross(frame.origin[0], force));
        let left = match solid.joint {
            Joint::Free => plus(force.map(f64::abs), moment.map(f64::abs)),
            Joint::Ball | Joint::Angles => moment,
            Joint::Hinge(axis) => {
                let unit = times(inner(axis, axis).sqrt().recip(), axis);
                [inner(moment, turned(frame.attitude, unit)), 0.0, 0.0]
            }
        };
        worst = left.iter().fold(worst, |most, part| most.max(part.abs()));
    }
    worst / scale
}

/// Returns a random state with unit quaternions that move on the sphere.
fn state(tree: &Tree, random: &mut Random) -> [Vec<f64>; 2] {
    let (mut q, mut v) = (Vec::new(), Vec::new());
    for solid in &tree.0 {
        let plain = match solid.joint {
            Joint::Ball => 0,
            Joint::Hinge(_) => 1,
            Joint::Free | Joint::Angles => 3,
        };
        q.extend((0..plain).map(|_| random.uniform(-2.0, 2.0)));
        v.extend((0..plain).map(|_| random.uniform(-2.0, 2.0)));
        if matches!(solid.joint, Joint::Free | Joint::Ball) {
            let own: Quaternion = [(); 4].map(|()| random.uniform(-1.0, 1.0));
            let length = own.iter().map(|part| part * part).sum::<f64>().sqrt();
            let own = own.map(|part| part / length);
            let [x, y, z] = [(); 3].map(|()| random.uniform(-1.0, 1.0));
            q.extend(own);
            v.extend(product(own, [0.0, x, y, z]));
        }
    }
    [q, v]
}

/// Compares random trees with the equations of Newton and Euler. A quarter may be refused
/// as too long, which is what becomes of some with four solids on hinges.
fn balanced(count: u64, most: usize, angles: bool) {
    let first = variable("RANDOM_SEED").unwrap_or(0);
    let count = variable("SOLIDS_COUNT").unwrap_or(count);
    let mut refused = 0;
    for seed in first..first + count {
        let mut random = Random(seed);
        let tree = Tree::random(&mut random, most, angles);
        let (source, numbers) = tree.source();
        let mut errors = Errors::default();
        let found = derived(&source, &mut errors, |_, graph, motion, _| {
            let [q, v] = state(&tree, &mut random);
            let value = |symbol| match symbol {
                Symbol::Parameter(index) => numbers[index],
                Symbol::Coordinate(index) => q[index],
                Symbol::Velocity(index) => v[index],
                other => panic!("{other:?}"),
            };
            let a: Vec<f64> =
                motion.accelerations.iter().map(|&id| evaluate(graph, id, &value)).collect();
            unbalanced(&tree, [&q, &v, &a])
        });
        let Some(left) = found else {
            let messages = errors.messages();
            let long = ["unfold", "too long"].iter().any(|part| messages[0].contains(part));
            assert!(long, "seed {seed}: {messages:?} for {source}");
            refused += 1;
            continue;
        };
        assert!(left < 1e-10, "seed {seed}: {left:e} for {source}");
    }
    assert!(4 * refused <= count, "{refused} of {count} are refused");
}

#[test]
fn trees_of_solids_move_by_the_equations_of_newton_and_euler() {
    balanced(20, 4, false);
}

#[test]
fn so_do_trees_in_angles() {
    balanced(10, 2, true);
}
