//! Impacts with dry friction against those along the path of impulses in another language.

use pendulum_runtime::attitude::{Attitude, Rates};
use pendulum_runtime::prelude::*;
use systems::random::Random;

lagrangian! {
    /// A body whose tip strikes a rough floor.
    #[derive(Clone, Debug)]
    pub struct Striker { m: kg, J: [kg*m^2; 3], c: [m; 3], μ: 1, e: 1 }
    coordinate x: [m; 3];
    coordinate R: rotation;
    let tip = x + R*c;
    let Ω = transpose(R)*angular_velocity(R);
    kinetic = m/2*|dot(x)|^2 + (J.x*Ω.x^2 + J.y*Ω.y^2 + J.z*Ω.z^2)/2;
    limit floor: tip.z >= c.z, restitution = e, friction = μ along [dot(tip).x, dot(tip).y];
}

lagrangian! {
    /// The same in a plane, with another bound for a tip that sticks.
    #[derive(Clone, Debug)]
    pub struct Flat { m: kg, J: kg*m^2, a: m, b: m, μ: 1, ν: 1, e: 1 }
    coordinate x: m;
    coordinate y: m;
    coordinate θ: rad;
    let tip = [x + a*cos(θ) - b*sin(θ), y + a*sin(θ) + b*cos(θ)];
    kinetic = (m*(ẋ^2 + ẏ^2) + J*θ̇^2)/2;
    limit floor: height(tip) >= b, restitution = e;
    friction shoe: dot(tip).x, force = μ*reaction(floor), static = ν*reaction(floor);
}

/// Rates that slide on while they turn, stop and stick, and leave again in another direction.
#[test]
#[allow(non_snake_case)]
fn impacts_in_space_follow_the_path_of_impulses() {
    let mut count = 0;
    for line in include_str!("../data/impacts.txt").lines().filter(|line| !line.starts_with('#')) {
        let mut numbers = line.split(' ').map(|number| number.parse::<f64>().unwrap());
        let mut number = || numbers.next().unwrap();
        let [J, c] = [(); 2].map(|()| [(); 3].map(|()| number()));
        let [μ, e] = [(); 2].map(|()| number());
        let [v, w, after, turn] = [(); 4].map(|()| [(); 3].map(|()| number()));
        let striker = Striker { m: 1.0, J, c, μ, e };
        let start = Striker::start().x([0.0; 3], v);
        let start = start.R(Attitude::identity(), Rates::body(w));
        let run = solve(&striker, (0.0, 1e-6), start.q, start.v).run().unwrap();
        let impact = &run.impacts[0];
        let found = impact.after.v;
        for i in 0..3 {
            assert!((found[i] - after[i]).abs() < 1e-10, "{line}: {found:?}");
            // The rates of the quaternion 1 are half of the angular velocity.
            assert!((2.0 * found[4 + i] - turn[i]).abs() < 1e-10, "{line}: {found:?}");
        }
        assert!((impact.impulse - number()).abs() < 1e-10, "{line}: {impact:?}");
        count += 1;
    }
    assert_eq!(count, 14);
}

/// Returns the velocities after an impact of `flat` in many small impulses.
fn in_small_impulses(flat: &Flat<f64>, mut v: [f64; 3]) -> [f64; 3] {
    let Flat { m, J, a, b, μ, ν, e } = *flat;
    let mix = -a * b / J;
    let (own, along) = (1.0 / m + a * a / J, 1.0 / m + b * b / J);
    let rates = |v: &[f64; 3]| [v[0] - b * v[2], v[1] + a * v[2]];
    let (mut work, mut least) = (0.0, 0.0_f64);
    let step = -rates(&v)[1] / own * 3e-5;
    while rates(&v)[1] < 0.0 || work < least * (1.0 - e * e) {
        let [slip, _] = rates(&v);
        // What ends the slip within the step, if that is not too much for it.
        let hold = -(slip / step + mix) / along;
        let most = if slip.abs() < 1e-12 { μ.max(ν) } else { μ };
        let force = if hold.abs() <= most { hold } else { μ * hold.signum() };
        let before = rates(&v)[1];
        v[0] += step * force / m;
        v[1] += step / m;
        v[2] += step * (a - b * force) / J;
        work += step * (before + rates(&v)[1]) / 2.0;
        least = least.min(work);
    }
    v
}

#[test]
#[allow(non_snake_case)]
fn impacts_in_the_plane_follow_the_path_of_impulses() {
    let mut random = Random::new(7);
    let mut slipped = [0; 2];
    for member in 0..80 {
        let mut number = |low, high| random.uniform(low, high);
        let [m, J, a] = [number(0.5, 2.0), number(0.05, 1.0), number(-1.0, 1.0)];
        let [b, μ, e] = [number(-1.0, -0.1), number(0.0, 1.2), number(0.0, 1.0)];
        let ν = if member % 2 == 0 { μ } else { μ * number(1.0, 2.0) };
        let flat = Flat { m, J, a, b, μ, ν, e };
        let mut v = [(); 3].map(|()| number(-3.0, 3.0));
        v[1] = -v[1].abs() - a * v[2] - 0.1;
        let run = solve(&flat, (0.0, 1e-6), [0.0; 3], v).run().unwrap();
        let found = run.impacts[0].after.v;
        let expected = in_small_impulses(&flat, v);
        for i in 0..3 {
            let distance = (found[i] - expected[i]).abs();
            assert!(distance < 1e-3, "{member} {flat:?} {v:?}: {found:?} {expected:?}");
        }
        slipped[usize::from((found[0] - b * found[2]).abs() < 1e-12)] += 1;
        let energy = |v: &[f64; 3]| m * (v[0] * v[0] + v[1] * v[1]) + J * v[2] * v[2];
        assert!(energy(&found) <= energy(&v) * (1.0 + 1e-13), "{member} {flat:?} {v:?}");
    }
    assert!(slipped.iter().all(|count| 15 < *count), "{slipped:?}");
}
