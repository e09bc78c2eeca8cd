//! Bodies and bounds that close on a bone from two sides.

use pendulum_runtime::motion::{Curve, Still};
use pendulum_runtime::scene::{Bone, Bound, Collider, Handle, Scene, Shape};

type Vector = [f64; 3];

const LENGTH: f64 = 0.25;
const RADIUS: f64 = 0.005;
const IDENTITY: [f64; 4] = [1.0, 0.0, 0.0, 0.0];
const SPEEDS: [f64; 3] = [1.0, 30.0, 1000.0];
const RATES: [f64; 2] = [24.0, 240.0];

fn plus(a: Vector, by: f64, b: Vector) -> Vector {
    core::array::from_fn(|i| a[i] + by * b[i])
}

fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// The distance of a point from a line between two points.
fn off(point: Vector, [a, b]: [Vector; 2]) -> f64 {
    let (from, along) = (plus(point, -1.0, a), plus(b, -1.0, a));
    let square = dot(along, along);
    let t = if square == 0.0 { 0.0 } else { (dot(from, along) / square).clamp(0.0, 1.0) };
    length(plus(from, -t, along))
}

/// A bone that points up and two bodies that close on it from both sides, stay there for ten ticks,
/// and open again.
struct Pinch {
    scene: Scene<f64>,
    bone: Handle<Bone<f64>, 4>,
    bodies: [Collider; 2],
    /// The times at which the bodies arrive and leave.
    times: [f64; 2],
    rate: f64,
    /// The energy at rest.
    rest: f64,
}

impl Pinch {
    /// Bodies that go from one place to another with the faster one at `speed`.
    fn new(
        bone: Bone<f64>,
        shapes: [Shape; 2],
        ways: [[Vector; 2]; 2],
        [speed, rate]: [f64; 2],
    ) -> Self {
        let mut scene = Scene::new(rate).unwrap();
        let frame = (scene.joint(Still::new([0.0; 3])), scene.joint(Still::new(IDENTITY)));
        let bone = scene.hang(frame, bone, IDENTITY, [0.0; 4]).unwrap();
        let rest = scene.energy(bone);
        let far = ways.map(|[from, to]| length(plus(to, -1.0, from)));
        let time = far[0].max(far[1]) / speed;
        let times = [time, time + 10.0 / rate];
        let body = |scene: &mut Scene<f64>, shape, [from, to]: [Vector; 2]| {
            let at = [0.0, times[0], times[1], times[1] + time];
            let place = Curve::linear(&at, &[from, to, to, from]).unwrap();
            let frame = (scene.joint(place), scene.joint(Still::new(IDENTITY)));
            Collider { frame, shape }
        };
        let bodies = [0, 1].map(|k| body(&mut scene, shapes[k], ways[k]));
        scene.set_colliders(bone, RADIUS, &bodies).unwrap();
        Self { scene, bone, bodies, times, rate, rest }
    }

    /// The joint and the tip.
    fn ends(&self) -> [Vector; 2] {
        let seen = self.scene.observe(self.bone, 1.0);
        [seen.inputs.0.position, seen.system.tip(seen.t, &seen.q, &seen.v, &seen.inputs)]
    }

    /// How far the bone is from both bodies, by the points of a fine grid along it; the tip only for
    /// those that it does not leave or that are halves of space.
    fn gaps(&self) -> [f64; 2] {
        let [joint, tip] = self.ends();
        self.bodies.map(|body| {
            let place = self.scene.joint_pose(body.frame.0, 1.0);
            let line = |ends: [Vector; 2]| ends.map(|end| plus(end, 1.0, place));
            let least = |ends, radius| {
                let along = |k| plus(joint, f64::from(k) / 1e3, plus(tip, -1.0, joint));
                let all = (0..=1000).map(|k| off(along(k), line(ends)));
                all.fold(f64::INFINITY, f64::min) - radius - RADIUS
            };
            match body.shape {
                Shape::Ball { center, radius } => least([center; 2], radius),
                Shape::Capsule { ends, radius } => least(ends, radius),
                Shape::Inside { ends, radius } => radius - RADIUS - off(tip, line(ends)),
                Shape::Half { point, normal } => {
                    let from = plus(plus(tip, -1.0, point), -1.0, place);
                    dot(normal, from) / length(normal) - RADIUS
                }
                _ => unreachable!(),
            }
        })
    }

    /// Advances by a tick, and returns `true` up to the time at which the bodies leave.
    fn closed(&mut self) -> bool {
        self.scene.advance_ticks(1);
        assert!(self.scene.faults().is_empty());
        self.scene.time() <= self.times[1]
    }

    /// Opens the bodies, and asserts that the bone has hardly more energy than where it was held:
    /// while they open, they move the place where they hold it by less than a tenth of its way.
    fn opens(mut self) {
        let held = self.scene.energy(self.bone);
        let most = held + 0.2 * (held - self.rest) + 1e-9;
        for _ in 0..(self.rate * (self.times[0] + 0.5)) as u32 {
            self.closed();
            let energy = self.scene.energy(self.bone);
            assert!(energy <= most, "{energy} {held}");
        }
    }
}

fn loose() -> Bone<f64> {
    Bone::new(LENGTH, 0.0, 0.0)
}

fn springy() -> Bone<f64> {
    Bone::swinging(LENGTH, 2.0, 0.05).unwrap()
}

/// Two halves of space that come from the right and from the left.
const HALVES: [Shape; 2] = [
    Shape::Half { point: [0.0; 3], normal: [-1.0, 0.0, 0.0] },
    Shape::Half { point: [0.0; 3], normal: [1.0, 0.0, 0.0] },
];

/// The way of a body along x, at a height.
fn way(from: f64, to: f64, y: f64) -> [Vector; 2] {
    [[from, y, 0.0], [to, y, 0.0]]
}

#[test]
fn planes_without_room_between_them_hold_a_bone_in_the_middle_without_velocity() {
    for rate in RATES {
        for speed in SPEEDS {
            for bone in [loose(), springy()] {
                let ways = [way(0.2, -0.02, 0.0), way(-0.21, 0.01, 0.0)];
                let mut pinch = Pinch::new(bone, HALVES, ways, [speed, rate]);
                let mut held = None;
                while pinch.closed() {
                    let [right, left] = pinch.gaps();
                    // Together, both are as deep as the bodies overlap, and neither more than half.
                    let overlap = -(right + left);
                    assert!(right.min(left) > -0.55 * overlap.max(0.0) - 1e-6, "{right} {left}");
                    if pinch.scene.time() < pinch.times[0] {
                        continue;
                    }
                    assert!((overlap - 0.04).abs() < 1e-9);
                    let tip = pinch.ends()[1];
                    assert_eq!(pinch.scene.state(pinch.bone).1, [0.0; 4]);
                    let last = held.replace(tip).unwrap_or(tip);
                    assert!(length(plus(tip, -1.0, last)) < 1e-4, "{tip:?} {last:?}");
                }
                pinch.opens();
            }
        }
    }
}

#[test]
fn a_plane_and_a_bound_share_what_is_too_much() {
    let hinge = Bound::Hinge { axis: [0.0, 0.0, 1.0], from: -0.2, to: 0.2 };
    for bound in [Bound::Cone(0.2), hinge] {
        for rate in RATES {
            for speed in SPEEDS {
                // The plane asks for 0.4 rad, the bound for 0.2 rad.
                let goal = RADIUS - LENGTH * 0.4f64.sin();
                let ways = [way(0.2, goal, 0.0), [[0.0, -5.0, 0.0]; 2]];
                let shapes = [HALVES[0], Shape::Ball { center: [0.0; 3], radius: 0.01 }];
                let mut pinch = Pinch::new(springy(), shapes, ways, [speed, rate]);
                pinch.scene.set_bounds(pinch.bone, &[bound]).unwrap();
                while pinch.closed() {
                    let [x, y, _] = pinch.ends()[1];
                    let angle = x.atan2(y).abs();
                    assert!(angle < 0.31, "{angle}");
                    if pinch.times[0] <= pinch.scene.time() {
                        assert!((angle - 0.3).abs() < 0.01, "{angle}");
                        assert_eq!(pinch.scene.state(pinch.bone).1, [0.0; 4]);
                    }
                }
                pinch.opens();
            }
        }
    }
}

#[test]
fn between_balls_that_close_a_bone_slips_out_to_a_side() {
    for rate in RATES {
        for speed in SPEEDS {
            for (size, aside) in
                [(0.05, 0.0), (0.05, 1e-3), (0.05, 1e-2), (0.02, 0.0), (1e-3, 0.0), (1e-3, 5e-4)]
            {
                let ball = |z| Shape::Ball { center: [0.0, 0.0, z], radius: size };
                for to in [0.2 * size, -0.2] {
                    // They overlap at the end, or pass each other with the bone between them.
                    let ways = [way(0.2, to, 0.15), way(-0.2, -to, 0.15)];
                    let shapes = [ball(aside), ball(-aside)];
                    let mut pinch = Pinch::new(springy(), shapes, ways, [speed, rate]);
                    while pinch.closed() {
                        let [one, other] = pinch.gaps();
                        let depth = -one.min(other);
                        assert!(depth < 2e-6, "{rate} {speed} {size} {aside} {to}: {depth:e}");
                    }
                }
            }
        }
    }
}

#[test]
fn capsules_along_a_bone_let_it_slip_out() {
    for rate in RATES {
        for speed in SPEEDS {
            let ends = [[0.0, -0.05, 0.0], [0.0, 0.3, 0.0]];
            let shapes = [Shape::Capsule { ends, radius: 0.03 }; 2];
            let ways = [way(0.2, 0.02, 0.1), way(-0.2, -0.02, 0.1)];
            let mut pinch = Pinch::new(springy(), shapes, ways, [speed, rate]);
            while pinch.closed() {
                let [one, other] = pinch.gaps();
                assert!(-2e-6 < one.min(other), "{rate} {speed}: {one:e} {other:e}");
            }
        }
    }
}

#[test]
fn a_capsule_in_a_hollow_takes_half_of_what_is_too_much() {
    for rate in RATES {
        for speed in SPEEDS {
            // What is left between both is too narrow: by 7.2 mm, at the least, in each.
            let ends = [[0.0, 0.1, 0.0], [0.0, 0.4, 0.0]];
            let hollow = Shape::Inside { ends, radius: 0.06 };
            let bar = Shape::Capsule { ends: [[0.0, 0.1, -1.0], [0.0, 0.1, 1.0]], radius: 0.057 };
            let ways = [way(0.3, 0.0, 0.12), [[0.0; 3]; 2]];
            let mut pinch = Pinch::new(loose(), [bar, hollow], ways, [speed, rate]);
            while pinch.closed() {
                let [one, other] = pinch.gaps();
                assert!(-7.8e-3 < one.min(other), "{rate} {speed}: {one} {other}");
            }
        }
    }
}
