//! Coordinates that are vectors, and forces on what coordinates move.

use core::f64::consts::TAU;
use pendulum_runtime::body::symmetric;
use pendulum_runtime::motion::Side;
use pendulum_runtime::nalgebra::{Matrix3, Vector3};
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::System;
use pendulum_runtime::time::Time;
use systems::random::Random;

lagrangian! {
    /// A planet in space.
    pub struct Planet { m: kg, G: m^3/s^2 }
    coordinate p: [m; 3];
    kinetic = m/2*|ṗ|^2;
    potential = -m*G/|p|;
    output areal: [m^2/s; 3] = cross(p, ṗ);
}

lagrangian! {
    /// Two masses on a spring, in the plane.
    pub struct Dumbbell { m: [kg; 2], k: N/m, l: m }
    coordinate x[2]: [m; 2];
    kinetic = sum(k in 0..2, m[k]/2*|ẋ[k]|^2);
    potential = k/2*(|x[1] - x[0]| - l)^2;
}

lagrangian! {
    /// A bob on a rod.
    pub struct Held { L: m, g: m/s^2 = 9.81 }
    coordinate p: [m; 2];
    kinetic = |ṗ|^2/2;
    potential = g*height(p);
    constraint rod: |p|^2 = L^2;
}

#[test]
fn a_planet_in_space_follows_the_circle() {
    let planet = Planet::new(2.0, 1.0);
    // A circle with the radius one and the period 2π, inclined by an angle whose sine is 0.6.
    let at = |t: f64| [t.cos(), 0.8 * t.sin(), 0.6 * t.sin()];
    let solution = solve(&planet, (0.0, TAU), at(0.0), [0.0, 0.8, 0.6])
        .rtol(1e-12)
        .every(TAU / 8.0)
        .run()
        .unwrap();
    let columns = ["p.x", "p.y", "p.z"].map(|name| solution.column(name).unwrap());
    for (index, state) in solution.iter().enumerate() {
        for (component, expected) in at(state.t).into_iter().enumerate() {
            assert!((state.q[component] - expected).abs() < 1e-10);
            assert_eq!(columns[component][index], state.q[component]);
        }
        let areal = planet.areal(state.t, &state.q, &state.v);
        assert!((areal[1] + 0.6).abs() + (areal[2] - 0.8).abs() < 1e-11, "{areal:?}");
    }
    for name in ["ṗ.z", "p_dot.z", "dot(p).z", "dot(p.z)"] {
        assert_eq!(solution.column(name).unwrap()[0], 0.6, "{name}");
    }
}

#[test]
fn components_have_names_and_units() {
    assert_eq!(Planet::FACTS.coordinates, ["p.x", "p.y", "p.z"]);
    assert_eq!(Planet::FACTS.coordinate_units, ["m"; 3]);
    assert_eq!(Dumbbell::FACTS.coordinates, ["x[0].x", "x[0].y", "x[1].x", "x[1].y"]);
    let conserved = Dumbbell::FACTS.conserved;
    assert!(conserved.contains(&"p_x[0].x + p_x[1].x"), "{conserved:?}");
    assert_eq!(conserved.len(), 3, "{conserved:?}");
}

#[test]
fn a_stretched_dumbbell_pulls_along_its_line() {
    let dumbbell = Dumbbell::new([1.0, 2.0], 3.0, 0.5);
    // The length is 5, and the force 13.5 along [0.6, 0.8].
    let accelerations = dumbbell.accelerations(At::of(0.0, &[0.0, 0.0, 3.0, 4.0], &[0.0; 4]));
    for (found, expected) in accelerations.into_iter().zip([8.1, 10.8, -4.05, -5.4]) {
        assert!((found - expected).abs() < 1e-13, "{accelerations:?}");
    }
}

#[test]
fn a_component_is_held_by_its_name() {
    let state = assemble(&Held::new(1.0), 0.0, [0.6, -0.7], [1.0, 0.0]).hold("p.x").run().unwrap();
    assert_eq!(state.q[0], 0.6);
    assert!((state.q[1] + 0.8).abs() < 1e-15 && (state.v[1] - 0.75).abs() < 1e-15);
    let error = assemble(&Held::new(1.0), 0.0, [0.6, -0.7], [0.0; 2]).hold("p").run().unwrap_err();
    assert_eq!(error.to_string(), "there is no coordinate `p` to hold; there are `p.x`, `p.y`");
}

lagrangian! {
    /// Two links whose end is pulled, with a motor in the elbow.
    pub struct Arm { m: kg, l: m, F: N, τ: N*m, w: 1/s }
    coordinate α: rad;
    coordinate β: rad;
    let a = l*[sin(α), -cos(α)];
    let b = a + l*[sin(β), -cos(β)];
    kinetic = m/2*(|ȧ|^2 + |ḃ|^2);
    force b = F*[1, w*t];
    force (β - α) = τ;
    output work: W = inner(F*[1, w*t], ḃ) + τ*(β̇ - α̇);
}

lagrangian! {
    /// A drone in the plane, with four rotors on a bar.
    pub struct Drone { m: kg, J: kg*m^2, l: m, g: m/s^2 = 9.81 }
    coordinate x: [m; 2];
    coordinate φ: rad;
    input f: [N; 4];
    let r(p) = x + cis(φ)*p;
    let d = perp(cis(φ));
    kinetic = m/2*|ẋ|^2 + J/2*φ̇^2;
    potential = m*g*height(x);
    force r([-2*l, 0]) = f[0]*d;
    force r([-l, 0]) = f[1]*d;
    force r([l, 0]) = f[2]*d;
    force r([2*l, 0]) = f[3]*d;
}

#[test]
fn power_counts_a_force_at_a_point() {
    let (arm, mut random) = (Arm::new(1.3, 0.7, 2.0, 0.4, 0.9), Random::new(5));
    for _ in 0..1000 {
        let [q, v] = [(); 2].map(|()| [(); 2].map(|()| random.uniform(-3.0, 3.0)));
        let t = random.uniform(0.0, 2.0);
        let (power, work) = (arm.power(At::of(t, &q, &v)), arm.work(t, &q, &v));
        assert!((power - work).abs() < 1e-12 * (1.0 + work.abs()), "{power} {work}");
    }
}

#[test]
fn a_drone_obeys_newton_and_euler() {
    let mut random = Random::new(6);
    for _ in 0..1000 {
        let f = [(); 4].map(|()| random.uniform(0.0, 5.0));
        let [x, y, φ] = [(); 3].map(|()| random.uniform(-3.0, 3.0));
        let thrust: f64 = f.iter().sum();
        let moment = 0.4 * (-2.0 * f[0] - f[1] + f[2] + 2.0 * f[3]);
        let controlled = Drone::new(1.2, 0.3, 0.4).controlled_by(|_, _, _| f);
        let found =
            controlled.accelerations_at(Time::new(0.0), Side::After, &[x, y, φ], &[0.1, 0.2, 0.3]);
        let expected = [-thrust * φ.sin() / 1.2, thrust * φ.cos() / 1.2 - 9.81, moment / 0.3];
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }
}

#[test]
fn four_rotors_that_carry_the_weight_hover() {
    let drone = Drone::new(2.0, 0.3, 0.4).controlled_by(|_, _, _| [2.0 * 9.81 / 4.0; 4]);
    let solution =
        solve(&drone, (0.0, 10.0), [1.0, 2.0, 0.0], [0.5, 0.0, 0.0]).rtol(1e-10).run().unwrap();
    let end = solution.end;
    assert!((end.q[0] - 6.0).abs() + (end.q[1] - 2.0).abs() + end.q[2].abs() < 1e-9, "{end:?}");
}

lagrangian! {
    /// A particle whose inertia depends on its direction, pulled along a fixed one.
    pub struct Heavy { M: [kg; 3, 3], F: N, n: [1; 3] = [0, 0.6, -0.8], b: [1; 4] = [1, -2, 1/3, 4] }
    coordinate u: [m; 3];
    kinetic = inner(u̇, M*u̇)/2;
    potential = -F*inner(n, u)*sum(k in 0..4, b[k]);
}

#[test]
fn a_matrix_of_parameters_is_an_inertia() {
    let matrix = Matrix3::new(3.0, -0.1, 0.4, -0.1, 4.0, 0.2, 0.4, 0.2, 5.0);
    let heavy = Heavy::new(symmetric(&matrix).unwrap(), 1.5);
    assert_eq!((heavy.M, heavy.n), ([3.0, 4.0, 5.0, -0.1, 0.4, 0.2], [0.0, 0.6, -0.8]));
    assert_eq!(heavy.b, [1.0, -2.0, 1.0 / 3.0, 4.0]);
    let force = Vector3::new(0.0, 0.6, -0.8) * 1.5 * (3.0 + 1.0 / 3.0);
    let expected = matrix.lu().solve(&force).unwrap();
    let found = Vector3::from(heavy.accelerations(At::of(0.0, &[0.0; 3], &[0.0; 3])));
    assert!((found - expected).amax() < 1e-15, "{found} {expected}");
    assert_eq!(Heavy::FACTS.parameters[..6], ["M.xx", "M.yy", "M.zz", "M.xy", "M.xz", "M.yz"]);
    assert_eq!(Heavy::FACTS.units[..6], ["kg"; 6]);
    let halved = heavy.map(|parameter| (parameter / 2.0) as f32);
    assert_eq!((halved.M[3], halved.n[1]), (-0.05, 0.3));
}
