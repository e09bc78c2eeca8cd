//! Outputs, reactions and power with limits in contact, compared with closed forms.

use pendulum_runtime::integrate::Integrator;
use pendulum_runtime::motion::Sinusoid;
use pendulum_runtime::prelude::*;

lagrangian! {
    /// A bob on a rod, and a wall that it may lean on.
    #[derive(Clone, Debug)]
    pub struct Leaning { m: kg, L: m, w: m, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    kinetic = m/2*(ẋ^2 + ẏ^2);
    potential = m*g*y;
    constraint rod: |[x, y]| = L;
    limit wall: x >= w, restitution = 0;
    output tension: N = -reaction(rod);
    output force: [N; 2] = m*[dot(ẋ), dot(ẏ) + g];
    output height: m = y;
}

lagrangian! {
    /// A load on a table that is driven up and down.
    #[derive(Clone, Debug)]
    pub struct Table { m: kg, g: m/s^2 = 9.81 }
    coordinate y: m;
    driven table: m;
    kinetic = m/2*ẏ^2;
    potential = m*g*y;
    limit top: y >= table, restitution = 0;
    output lift: m/s^2 = dot(ẏ);
}

lagrangian! {
    /// A bob on a rod whose length is driven by time, on a wall.
    #[derive(Clone, Debug)]
    pub struct Hoisted { m: kg, L: m, u: m/s, w: m, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    kinetic = m/2*(ẋ^2 + ẏ^2);
    potential = m*g*y;
    constraint rod: |[x, y]| = L - u*t;
    limit wall: x >= w, restitution = 0;
}

const LEANING: Leaning<f64> = Leaning { m: 0.7, L: 2.0, w: 1.2, g: 9.81 };

#[test]
fn a_bob_leans_on_a_wall() {
    // At rest, the force of the rod is m g/cos θ, and that of the wall is m g tan θ.
    let y = -1.6;
    let solution =
        solve(&LEANING, (0.0, 1.0), [1.2, y], [0.0; 2]).method(Dop853).every(0.25).run().unwrap();
    let weight = 0.7 * 9.81;
    let [wall] = &solution.contact_forces(&LEANING).unwrap()[..] else { panic!() };
    let [rod] = &solution.reactions(&LEANING).unwrap()[..] else { panic!() };
    let tension = solution.output(&LEANING, "tension").unwrap();
    let [fx, fy] = ["force.x", "force.y"].map(|name| solution.output(&LEANING, name).unwrap());
    let a = solution.accelerations(&LEANING).unwrap();
    for k in 0..solution.len() {
        assert!((wall[k] - weight * 1.2 / 1.6).abs() < 1e-12, "{}", wall[k]);
        assert!((tension[k] - weight * 2.0 / 1.6).abs() < 1e-12, "{}", tension[k]);
        assert_eq!(-rod[k], tension[k]);
        // The body does not move: rod and wall carry its weight.
        assert!(fx[k].abs() < 1e-12 && (fy[k] - weight).abs() < 1e-12, "{} {}", fx[k], fy[k]);
        assert!(a[k].iter().all(|a| a.abs() < 1e-12), "{a:?}");
    }
}

#[test]
fn contacts_begin_at_the_impact() {
    let solution =
        solve(&LEANING, (0.0, 1.0), [2.0, 0.0], [0.0; 2]).method(Dop853).every(0.05).run().unwrap();
    let met = solution.impacts[0].time.to_f64();
    let [wall] = &solution.contact_forces(&LEANING).unwrap()[..] else { panic!() };
    let tension = solution.output(&LEANING, "tension").unwrap();
    assert!(0.3 < met && met < 0.9, "{met}");
    for (k, state) in solution.iter().enumerate() {
        let ([x, y], [u, v]) = (state.q, state.v);
        let speed = u * u + v * v;
        // Newton's second law along the rod, including the force of the wall.
        let expected = 0.35 * (speed - 9.81 * y) + 0.5 * wall[k] * x;
        assert_eq!(met < state.t, 0.0 < wall[k]);
        assert!((tension[k] - expected).abs() < 1e-9, "{} {expected}", tension[k]);
    }
}

#[test]
fn a_table_lifts_with_power() {
    let table = Table::new(0.4).driven_by(Sinusoid::new([0.1], 5.0, [0.0]));
    let (start, speed) = (0.0, 0.5);
    let solution =
        solve(&table, (0.0, 0.9), [start], [speed]).method(Dop853).every(0.09).run().unwrap();
    let lift = solution.output(&table, "lift").unwrap();
    let [force] = &solution.contact_forces(&table).unwrap()[..] else { panic!() };
    let power = solution.power(&table).unwrap();
    for (k, &t) in solution.t.iter().enumerate() {
        // y = a sin ωt, which never falls faster than a free body.
        let (ẏ, ÿ) = (0.5 * (5.0 * t).cos(), -2.5 * (5.0 * t).sin());
        assert!((lift[k] - ÿ).abs() < 1e-9, "{} {ÿ}", lift[k]);
        assert!((force[k] - 0.4 * (ÿ + 9.81)).abs() < 1e-9);
        assert!((power[k] - 0.4 * (ÿ + 9.81) * ẏ).abs() < 1e-9);
    }
}

#[test]
fn a_rod_hoists_along_a_wall() {
    // y = −√(L(t)² − w²): the power of the rod is the rate of the energy.
    let hoisted = Hoisted::new(0.7, 2.0, 0.1, 1.2);
    let (l, w) = (|t: f64| 2.0 - 0.1 * t, 1.2);
    let speed = |t: f64| 0.1 * l(t) / (l(t) * l(t) - w * w).sqrt();
    let solution = solve(&hoisted, (0.0, 2.0), [w, -1.6], [0.0, speed(0.0)])
        .method(Dop853)
        .rtol(1e-11)
        .every(0.5)
        .run()
        .unwrap();
    let power = solution.power(&hoisted).unwrap();
    let accelerations = solution.accelerations(&hoisted).unwrap();
    for (k, &t) in solution.t.iter().enumerate() {
        let d = 1e-5;
        let a = (speed(t + d) - speed(t - d)) / (2.0 * d);
        assert!(accelerations[k][0].abs() < 1e-9 && (accelerations[k][1] - a).abs() < 1e-8);
        assert!((power[k] - 0.7 * (a + 9.81) * speed(t)).abs() < 1e-7, "{} at {t}", power[k]);
    }
}

#[test]
fn integrators_know_their_contacts() {
    let mut run = Integrator::new(&LEANING, Dop853, 0.0, [2.0, 0.0], [0.0; 2]).unwrap();
    assert!(!run.in_contact(0));
    while run.impacts().is_empty() {
        run.step().unwrap();
    }
    assert!(run.in_contact(0) && !run.in_contact(1) && !run.in_contact(99));
}
