//! Solids, bones and rotors in space: rotations, integrals, vectors and forces together.

use pendulum_runtime::motion::{Sinusoid, Still, Turning};
use pendulum_runtime::nalgebra::{Matrix3, Vector3};
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::System;

lagrangian! {
    /// A solid on its tip, in any attitude.
    pub struct Top { B: solid, g: m/s^2 = 9.81 }
    coordinate R: rotation;
    kinetic = integral(p in B, |dot(R*p)|^2 / 2);
    potential = integral(p in B, g*height(R*p));
    output spin: [rad/s; 3] = transpose(R)*angular_velocity(R);
    output middle: [m; 3] = R*B.center;
}

lagrangian! {
    /// A bone on a moving, turning parent, which springs back to its rest direction.
    pub struct Bone {
        m: kg, L: m, k: N*m, kt: N*m, c: N*m*s,
        axis: [1; 3] = [0, 1, 0], side: [1; 3] = [1, 0, 0], up: [1; 3] = [0, 1, 0], g: m/s^2 = 9.81,
    }
    driven x: [m; 3];
    driven P: rotation;
    coordinate R: rotation;
    let d = R*axis;
    let tip = x + L*d;
    kinetic = m/2*|dot(tip)|^2 + m*L^2/20*|angular_velocity(R)|^2;
    potential = m*g*inner(up, tip) - k*inner(d, P*axis) - kt*inner(R*side, P*side);
    dissipation = c/2*|angular_velocity(R) - angular_velocity(P)|^2;
    output tip: [m; 3] = tip;
}

lagrangian! {
    /// The same bone in the plane.
    pub struct Flat { m: kg, L: m, k: N*m, c: N*m*s, g: m/s^2 = 9.81 }
    driven x: [m; 2];
    driven φ: rad;
    coordinate θ: rad;
    let tip = x + L*[-sin(θ), cos(θ)];
    kinetic = m/2*|dot(tip)|^2 + m*L^2/20*θ̇^2;
    potential = m*g*height(tip) - k*cos(θ - φ);
    dissipation = c/2*(θ̇ - φ̇)^2;
    output tip: [m; 2] = tip;
}

lagrangian! {
    /// A quadrotor.
    pub struct Quadrotor { B: solid, l: m, κ: m, g: m/s^2 = 9.81 }
    coordinate x: [m; 3];
    coordinate R: rotation;
    input f: [N; 4];
    let r(p) = x + R*p;
    kinetic = integral(p in B, |dot(r(p))|^2 / 2);
    potential = integral(p in B, g*height(r(p)));
    force r([l, 0, 0]) = f[0]*(R*[0, 0, 1]);
    force r([0, l, 0]) = f[1]*(R*[0, 0, 1]);
    force r([-l, 0, 0]) = f[2]*(R*[0, 0, 1]);
    force r([0, -l, 0]) = f[3]*(R*[0, 0, 1]);
    torque R = κ*(f[0] - f[1] + f[2] - f[3])*(R*[0, 0, 1]);
}

/// A solid without symmetry, whose centre of mass is beside its axis.
fn skew() -> Solid {
    let turn = Attitude::from_euler("xyz", [0.2, 0.3, -1.0]).unwrap();
    let arm = Solid::cuboid(0.4, [0.1, 0.2, 0.05]).unwrap().rotated(turn);
    Solid::cone(1.2, 0.1, 0.2).unwrap() + arm.translated([0.05, -0.1, 0.2])
}

fn near(found: &[f64], exact: &[f64], tolerance: f64) {
    for (found, exact) in found.iter().zip(exact) {
        assert!((found - exact).abs() < tolerance, "{found:e} is not {exact:e}");
    }
}

/// Returns q̈ of a quaternion for the angular acceleration `alpha` along the axes of the body.
fn second(attitude: Attitude, rates: [f64; 3], alpha: Vector3<f64>) -> [f64; 4] {
    let half = Rates::body(alpha.into()).derivative(attitude);
    // d(q Ω/2)/dt = q̇ Ω/2 + q Ω̇/2, and q̇ Ω/2 = −|Ω|² q/4.
    let quarter = 0.25 * rates.iter().map(|part| part * part).sum::<f64>();
    let q = attitude.to_quaternion();
    core::array::from_fn(|k| half[k] - quarter * q[k])
}

#[test]
fn a_solid_on_its_tip_obeys_newton_and_euler() {
    let (solid, attitude) = (skew(), Attitude::from_euler("zxz", [0.4, 1.0, -2.0]).unwrap());
    let w = [1.0, -2.0, 15.0];
    let top = Top::new(solid);
    let (q, v) = (attitude.to_quaternion(), Rates::body(w).derivative(attitude));
    let down = Vector3::from(attitude.inverse() * [0.0, 0.0, -9.81]);
    let (inertia, rates) = (solid.inertia(), Vector3::from(w));
    let center = Vector3::from(solid.center);
    let moment = center.cross(&down) * solid.mass;
    let alpha = inertia.try_inverse().unwrap() * (moment - rates.cross(&(inertia * rates)));
    let exact = second(attitude, w, alpha);
    let scale = 1e-13 * alpha.norm();
    near(&top.accelerations(At::of(0.0, &q, &v)), &exact, scale);
    near(&top.spin(0.0, &q, &v), &w, 1e-14);
    // The energy is that of the inertia matrix, and stays.
    let energy = rates.dot(&(inertia * rates)) / 2.0 - down.dot(&center) * solid.mass;
    near(&[top.energy(At::of(0.0, &q, &v))], &[energy], 1e-13);
    let end = solve(&top, (0.0, 5.0), q, v).rtol(1e-12).run().unwrap().end;
    near(&[top.energy(At::of(end.t, &end.q, &end.v))], &[energy], 1e-10);
}

#[test]
fn a_bone_in_a_plane_is_a_pendulum() {
    let bone = Bone::new(0.3, 0.4, 0.7, 0.5, 0.02);
    let turning = || Sinusoid::new([0.6], 3.0, [0.2]);
    let shaking = Sinusoid::new([0.1, 0.05, 0.0], 5.0, [0.0, 1.0, 0.0]);
    let bone = bone.driven_by(shaking, Turning::new([0.0, 0.0, 1.0], turning()));
    let flat = Flat::new(0.3, 0.4, 1.2, 0.02)
        .driven_by(Sinusoid::new([0.1, 0.05], 5.0, [0.0, 1.0]), turning());
    let attitude = Attitude::from_axis_angle([0.0, 0.0, 1.0], 0.9);
    let v = Rates::body([0.0, 0.0, -1.3]).derivative(attitude);
    let q = attitude.to_quaternion();
    let own = solve(&bone, (0.0, 3.0), q, v).rtol(1e-11).every(0.25).run().unwrap();
    let known = solve(&flat, (0.0, 3.0), [0.9], [-1.3]).rtol(1e-11).every(0.25).run().unwrap();
    for name in ["tip.x", "tip.y"] {
        near(&own.output(&bone, name).unwrap(), &known.output(&flat, name).unwrap(), 1e-9);
    }
    near(&own.output(&bone, "tip.z").unwrap(), &[0.0; 13], 1e-12);
}

#[test]
fn a_bone_comes_to_rest_along_its_parent() {
    let parent = Attitude::from_euler("yxz", [0.3, -0.8, 1.1]).unwrap();
    let bone = Bone { g: 0.0, ..Bone::new(0.3, 0.4, 0.7, 0.5, 0.1) };
    let bone = bone.driven_by(Still::new([0.0; 3]), Still::new(parent.to_quaternion()));
    let q = Attitude::from_euler("xyz", [0.5, 0.5, 0.5]).unwrap().to_quaternion();
    let end = solve(&bone, (0.0, 60.0), q, [0.0; 4]).rtol(1e-9).run().unwrap().end;
    let exact = parent.to_quaternion();
    let sign = exact.iter().zip(&end.q).map(|(a, b)| a * b).sum::<f64>().signum();
    near(&end.q.map(|part| sign * part), &exact, 1e-6);
}

#[test]
fn rotors_lift_and_turn_a_quadrotor() {
    let body = Solid::cuboid(1.2, [0.3, 0.2, 0.1]).unwrap();
    let f = [3.0, 2.5, 3.4, 3.1];
    let (l, k) = (0.2, 0.02);
    let drone = Quadrotor::new(body, l, k).controlled_by(move |_, _, _| f);
    let attitude = Attitude::from_euler("zyx", [0.3, 0.4, -0.2]).unwrap();
    let w = [0.5, -1.0, 2.0];
    let (r, q) = (attitude.to_quaternion(), Rates::body(w).derivative(attitude));
    let q_ = [0.1, 0.2, 0.3, r[0], r[1], r[2], r[3]];
    let v = [1.0, 0.0, -1.0, q[0], q[1], q[2], q[3]];
    let run = solve(&drone, (0.0, 0.01), q_, v).rtol(1e-12).every_step().run().unwrap();
    let found = run.accelerations(&drone).unwrap()[0];
    let axis = attitude * [0.0, 0.0, 1.0];
    let lift = f.iter().sum::<f64>() / 1.2;
    near(&found[..3], &[lift * axis[0], lift * axis[1], lift * axis[2] - 9.81], 1e-12);
    let inertia: Matrix3<f64> = body.inertia();
    let rates = Vector3::from(w);
    let turn = k * (f[0] - f[1] + f[2] - f[3]);
    let moment = Vector3::new(l * (f[1] - f[3]), l * (f[2] - f[0]), turn);
    let alpha = inertia.try_inverse().unwrap() * (moment - rates.cross(&(inertia * rates)));
    near(&found[3..], &second(attitude, w, alpha), 1e-12 * alpha.norm());
}
