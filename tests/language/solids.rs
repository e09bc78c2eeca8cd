//! Solids in space: integrals, the inertia matrix, outputs and derivatives by parameters.

use pendulum_runtime::body::Body;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Dual;
use pendulum_runtime::system::System;

lagrangian! {
    /// A top in Euler's angles, by the integral over its points.
    pub struct Top { B: solid, g: m/s^2 = 9.81 }

    coordinate φ: rad;
    coordinate θ: rad;
    coordinate ψ: rad;

    let spun(p) = [cos(ψ)*p.x - sin(ψ)*p.y, sin(ψ)*p.x + cos(ψ)*p.y, p.z];
    let bent(p) = [p.x, cos(θ)*p.y - sin(θ)*p.z, sin(θ)*p.y + cos(θ)*p.z];
    let led(p)  = [cos(φ)*p.x - sin(φ)*p.y, sin(φ)*p.x + cos(φ)*p.y, p.z];
    let r(p) = led(bent(spun(p)));
    kinetic   = integral(p in B, |dot(r(p))|^2 / 2);
    potential = integral(p in B, g*height(r(p)));
    output middle: [m; 3] = r(B.center);
}

lagrangian! {
    /// The same top by Euler's kinematic equations and its inertia matrix.
    pub struct Rigid { B: solid, g: m/s^2 = 9.81 }

    coordinate φ: rad;
    coordinate θ: rad;
    coordinate ψ: rad;

    let ω = [
        φ̇*sin(θ)*sin(ψ) + θ̇*cos(ψ),
        φ̇*sin(θ)*cos(ψ) - θ̇*sin(ψ),
        φ̇*cos(θ) + ψ̇,
    ];
    let up = [sin(θ)*sin(ψ), sin(θ)*cos(ψ), cos(θ)];
    kinetic   = inner(ω, B.inertia*ω)/2;
    potential = B.mass*g*inner(up, B.center);
}

lagrangian! {
    /// A solid on an axle along y.
    pub struct Swinging { B: solid, g: m/s^2 = 9.81 }

    coordinate θ: rad;

    let r(p) = [cos(θ)*p.x + sin(θ)*p.z, p.y, cos(θ)*p.z - sin(θ)*p.x];
    kinetic   = integral(p in B, |dot(r(p))|^2 / 2);
    potential = integral(p in B, g*height(r(p)));
}

lagrangian! {
    /// The same axle in the plane, with x to the right and z up.
    pub struct Flat { B: body, g: m/s^2 = 9.81 }

    coordinate θ: rad;

    let r(p) = cis(-θ)*p;
    kinetic   = integral(p in B, |dot(r(p))|^2 / 2);
    potential = integral(p in B, g*height(r(p)));
}

const Q: [f64; 3] = [0.3, 0.7, -0.4];
const V: [f64; 3] = [1.0, -0.5, 20.0];

/// A solid without symmetry.
fn skew() -> Solid {
    let turn = Attitude::from_euler("xyz", [0.2, 0.3, -1.0]).unwrap();
    let arm = Solid::cuboid(0.4, [0.1, 0.2, 0.05]).unwrap().rotated(turn);
    Solid::cone(1.2, 0.1, 0.2).unwrap() + arm.translated([0.05, -0.1, 0.2])
}

fn close(a: &[f64], b: &[f64]) {
    for (a, b) in a.iter().zip(b) {
        assert!((a - b).abs() < 1e-12 * (1.0 + b.abs()), "{a} is not {b}");
    }
}

#[test]
fn the_integral_over_a_top_is_that_of_its_inertia_matrix() {
    let (top, rigid) = (Top::new(skew()), Rigid::new(skew()));
    close(&top.accelerations(At::of(0.0, &Q, &V)), &rigid.accelerations(At::of(0.0, &Q, &V)));
    close(&[top.energy(At::of(0.0, &Q, &V))], &[rigid.energy(At::of(0.0, &Q, &V))]);
    close(&top.momenta(At::of(0.0, &Q, &V)), &rigid.momenta(At::of(0.0, &Q, &V)));
}

#[test]
fn angles_of_euler_are_those_of_an_attitude() {
    let attitude = Attitude::from_euler("zxz", Q).unwrap();
    close(&Top::new(skew()).middle(0.0, &Q, &V), &(attitude * skew().center));
}

#[test]
fn energies_are_those_of_the_attitude_and_its_rates() {
    let angles = core::array::from_fn(|k| Dual { value: Q[k], derivative: V[k] });
    let parts = Attitude::from_euler("zxz", angles).unwrap().to_quaternion();
    let attitude = Attitude::from_quaternion(parts.map(|part| part.value));
    let rates = Rates::from_derivative(attitude, parts.map(|part| part.derivative));
    let omega = pendulum_runtime::nalgebra::Vector3::from(rates.in_body(attitude));
    let kinetic = 0.5 * omega.dot(&(skew().inertia() * omega));
    let potential = skew().mass * 9.81 * (attitude * skew().center)[2];
    close(&[Top::new(skew()).energy(At::of(0.0, &Q, &V))], &[kinetic + potential]);
}

#[test]
fn a_solid_on_an_axle_is_a_body_in_the_plane() {
    let solid = skew();
    let [xx, _, zz, _, xz, _] = solid.central;
    let [x, _, z] = solid.center;
    let body = Body { mass: solid.mass, center: [x, z], central: [xx, xz, zz] };
    for θ in [-2.0, 0.1, 1.0, 4.0] {
        let space = Swinging::new(solid).accelerations(At::of(0.0, &[θ], &[0.4]));
        close(&space, &Flat::new(body).accelerations(At::of(0.0, &[θ], &[0.4])));
    }
}

#[test]
fn accelerations_differentiate_by_every_moment() {
    let numbers = |solid: Solid| {
        let mut list = Vec::new();
        let _ = solid.map(|number| list.push(number));
        list
    };
    for index in 0..numbers(skew()).len() {
        let mut place = 0;
        let dual = skew().map(|value| {
            let derivative = if place == index { 1.0 } else { 0.0 };
            place += 1;
            Dual { value, derivative }
        });
        let (q, v) = (Q.map(Dual::constant), V.map(Dual::constant));
        let at = At::of(Dual::constant(0.0), &q, &v);
        let exact = Rigid::new(dual).accelerations(at);
        let found = Top::new(dual).accelerations(at);
        for k in 0..3 {
            let (found, exact) = (found[k].derivative, exact[k].derivative);
            assert!((found - exact).abs() < 1e-9 * (1.0 + exact.abs()), "{index} {found} {exact}");
        }
    }
}

#[test]
fn moments_are_named_in_the_facts() {
    let names = Top::<f64>::FACTS.parameters;
    assert_eq!(names[..4], ["B.mass", "B.center.x", "B.center.y", "B.center.z"]);
    assert_eq!(names[4..7], ["B.central.xx", "B.central.yy", "B.central.zz"]);
    assert_eq!(names[7..], ["B.central.xy", "B.central.xz", "B.central.yz", "g"]);
    assert_eq!(Top::<f64>::FACTS.cyclic, [0]);
}
