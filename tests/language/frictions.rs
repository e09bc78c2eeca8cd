//! Frictions: the methods and facts of generated code, in closed form.

use pendulum_runtime::motion::{Derivatives, Sample};
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::{At, MOST_FRICTIONS, MOST_LIMITS, System};

lagrangian! {
    /// A block on a belt that runs, with a brake whose force falls with the speed.
    pub struct Belted { m: kg, k: N/m, F: N, S: N, w: m/s, L: m }
    coordinate x: m;
    driven s: m;
    input u: N;
    kinetic = m/2*ẋ^2;
    potential = k/2*x^2;
    friction belt: ẋ - ṡ, force = F, static = S;
    friction brake: x*ẋ/L, force = u*exp(-ẋ^2/w^2);
}

lagrangian! {
    /// Three joints and a block on a table that turns.
    pub struct Table { m: kg, L: m, F: N, Ω: rad/s }
    coordinate p: [m; 2];
    coordinate θ[3]: rad;
    kinetic = m/2*|dot(p)|^2 + sum(k in 0..3, m/2*L^2*θ̇[k]^2);
    friction joint[k in 1..3]: θ̇[k] - θ̇[k - 1], force = k*F*L;
    friction plate: dot(p) - perp(p)*Ω*(1 + t*Ω), force = F, static = 2*F;
}

lagrangian! {
    /// A ball on a plane, with friction where it touches the plane and at a point of its surface.
    pub struct Ball { m: kg, r: m, J: kg*m^2, μ: 1, g: m/s^2 = 9.81 }
    coordinate x: [m; 3];
    coordinate R: rotation;
    kinetic = m/2*|dot(x)|^2 + J/2*|angular_velocity(R)|^2;
    friction spot: dot(x) + cross(angular_velocity(R), [0, 0, -r]), force = μ*m*g;
    friction handle: dot(x + R*[r, 0, 0]), force = μ*m*g;
}

lagrangian! {
    /// A block in a corner that rubs at both sides, and a wheel that the floor brakes.
    pub struct Corner { m: kg, L: m, μ: 1, F: N }
    coordinate p: [m; 2];
    coordinate θ: rad;
    kinetic = m/2*|dot(p)|^2 + m/2*L^2*θ̇^2;
    limit floor: p.y >= 0, restitution = 0, friction = μ along dot(p).x + L*θ̇, static = 2*μ;
    limit walls[k in 0..2]: p.x*(1 - 2*k) >= -L, restitution = 0, friction = μ/(1 + k) along dot(p).y;
    friction axle: θ̇, force = F*L + 3*L*reaction(floor) + p.x*reaction(walls[1]), static = F*L;
}

lagrangian! {
    /// A block with outputs of what rubs and pushes.
    pub struct Shown { m: kg, μ: 1, F: N, g: m/s^2 = 9.81 }
    coordinate p: [m; 2];
    kinetic = m/2*|dot(p)|^2;
    potential = m*g*p.y;
    limit floor: p.y >= 0, restitution = 0, friction = μ along dot(p).x;
    friction plate: dot(p), force = F;
    output push: N = reaction(floor);
    output rub: N = reaction(floor, friction);
    output drag: [N; 2] = reaction(plate);
    output heat: W = -inner(reaction(plate), dot(p)) - reaction(floor, friction)*dot(p).x;
    output load: N = m*dot(dot(p)).y + reaction(floor);
    output grips: m/s = dot(p).x;
}

lagrangian! {
    /// A block that slides on a floor and in a guide.
    #[derive(Clone, Debug)]
    pub struct Guided { m: kg, μ: 1, F: N, g: m/s^2 = 10 }
    coordinate p: [m; 2];
    kinetic = m/2*|dot(p)|^2;
    potential = m*g*p.y;
    limit floor: p.y >= 0, restitution = 0, friction = μ along dot(p).x;
    friction guide: dot(p).x, force = F;
    output push: N = reaction(floor);
    output rub: N = reaction(floor, friction);
    output drag: N = reaction(guide);
    output load: N = m*dot(dot(p)).x;
}

lagrangian! {
    /// A block without friction.
    pub struct Smooth { m: kg }
    coordinate x: m;
    kinetic = m/2*ẋ^2;
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-14 * (1.0 + b.abs())
}

fn sample(values: [f64; 3]) -> Sample<f64, 1> {
    let [position, velocity, acceleration] = values.map(|value| [value]);
    Sample { position, velocity, acceleration }
}

#[test]
fn slips_are_rates_and_their_derivatives_without_accelerations() {
    let belted = Belted::new(2.0, 3.0, 5.0, 7.0, 11.0, 4.0);
    let inputs = (sample([0.1, 0.2, 0.3]), sample([13.0, 0.0, 0.0]));
    let (q, v) = ([0.4], [0.5]);
    let at = At { t: 0.0, q: &q, v: &v, inputs: &inputs };
    let [rates, drifts] = belted.slips(at);
    assert!(close(rates[0], 0.5 - 0.2) && close(rates[1], 0.4 * 0.5 / 4.0), "{rates:?}");
    assert!(close(drifts[0], -0.3) && close(drifts[1], 0.25 / 4.0), "{drifts:?}");
    assert_eq!((rates[2..].to_vec(), drifts[2..].to_vec()), (vec![0.0; 14], vec![0.0; 14]));
    let jacobian = belted.slip_jacobian(at);
    assert!(jacobian[(0, 0)] == 1.0 && close(jacobian[(1, 0)], 0.4 / 4.0));
    assert!((2..MOST_FRICTIONS).all(|row| jacobian[(row, 0)] == 0.0));
}

#[test]
fn grips_are_forces_and_bounds_with_control_inputs_and_velocities() {
    let belted = Belted::new(2.0, 3.0, 5.0, 7.0, 11.0, 4.0);
    let inputs = (sample([0.1, 0.2, 0.3]), sample([13.0, 0.0, 0.0]));
    let (q, v) = ([0.4], [0.5]);
    let [forces, bounds] = belted.grips(At { t: 0.0, q: &q, v: &v, inputs: &inputs });
    assert!(forces[0] == 5.0 && close(forces[1], 13.0 * (-0.25_f64 / 121.0).exp()), "{forces:?}");
    assert_eq!((bounds[0], bounds[1]), (7.0, 0.0));
}

#[test]
fn families_and_vectors_follow_one_another() {
    let names: Vec<_> = Table::FACTS.frictions.iter().map(|friction| friction.name).collect();
    assert_eq!(names, ["joint[0]", "joint[1]", "plate.x", "plate.y"]);
    let components = Table::FACTS.frictions.iter().map(|friction| friction.components);
    assert_eq!(components.collect::<Vec<_>>(), [1, 1, 2, 2]);
    let table = Table::new(2.0, 3.0, 5.0, 0.7);
    let (q, v) = ([0.1, 0.2, 0.3, 0.4, 0.5], [1.0, 2.0, 3.0, 5.0, 8.0]);
    let [rates, drifts] = table.slips(At::of(0.5, &q, &v));
    let turn = 0.7 * (1.0 + 0.5 * 0.7);
    let expected = [2.0, 3.0, 1.0 + 0.2 * turn, 2.0 - 0.1 * turn];
    assert!(rates.iter().zip(expected).all(|(&own, expected)| close(own, expected)), "{rates:?}");
    let expected = [0.0, 0.0, 2.0 * turn + 0.2 * 0.49, -turn - 0.1 * 0.49];
    assert!(drifts.iter().zip(expected).all(|(&own, expected)| close(own, expected)), "{drifts:?}");
    let [forces, bounds] = table.grips(At::of(0.5, &q, &v));
    assert_eq!(
        (forces[..4].to_vec(), bounds[..4].to_vec()),
        (vec![15.0, 30.0, 5.0, 5.0], vec![0.0, 0.0, 10.0, 10.0],)
    );
}

/// The rates of a rotation are those of a quaternion: the slip is linear in them.
#[test]
fn slips_of_rotations_are_linear_in_the_rates_of_quaternions() {
    let ball = Ball::new(2.0, 0.3, 0.1, 0.2);
    let q = [0.0, 0.0, 0.3, 0.5, 0.5, -0.5, 0.5];
    // q̇ = ½ q Ω with the rates Ω = (1, 2, 3) about the axes of the ball.
    let v = [0.7, -0.4, 0.0, -0.5, -1.0, 0.0, 1.5];
    let at = At::of(0.0, &q, &v);
    let (jacobian, [rates, _]) = (ball.slip_jacobian(at), ball.slips(at));
    for row in 0..6 {
        let product: f64 = (0..7).map(|j| jacobian[(row, j)] * v[j]).sum();
        assert!(close(product, rates[row]), "{product} {rates:?}");
    }
    // Along a straight line of q the drift is the derivative of the rates.
    let moved = |h: f64| {
        let q = std::array::from_fn(|i| q[i] + h * v[i]);
        ball.slips(At::of(0.0, &q, &v))[0]
    };
    let (h, [_, drifts]) = (1e-5, ball.slips(at));
    for row in 0..6 {
        let slope = (moved(h)[row] - moved(-h)[row]) / (2.0 * h);
        assert!((slope - drifts[row]).abs() < 1e-8, "{slope} {drifts:?}");
    }
}

#[test]
fn shares_are_the_coefficients_of_the_reactions_of_limits() {
    let corner = Corner::new(2.0, 3.0, 0.5, 7.0);
    let (q, v) = ([0.25, 0.5, 0.1], [1.0, 2.0, 3.0]);
    let at = At::of(0.0, &q, &v);
    let names: Vec<_> = Corner::FACTS.frictions.iter().map(|friction| friction.name).collect();
    assert_eq!(names, ["floor", "walls[0]", "walls[1]", "axle"]);
    let [force, bound] = corner.grip_shares(at);
    let written = |matrix: &[[f64; 3]; 4], row: usize, column: usize| {
        matrix.get(row).and_then(|row| row.get(column)).copied().unwrap_or(0.0)
    };
    let forces = [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.25], [9.0, 0.0, 0.25]];
    let bounds = [[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3], [0.0; 3]];
    for row in 0..MOST_FRICTIONS {
        for column in 0..MOST_LIMITS {
            assert_eq!(force[(row, column)], written(&forces, row, column), "{row} {column}");
            assert_eq!(bound[(row, column)], written(&bounds, row, column), "{row} {column}");
        }
    }
    let [forces, bounds] = corner.grips(at);
    assert_eq!((forces[3], bounds[3]), (21.0, 21.0));
    assert!(forces[..3].iter().chain(&bounds[..3]).all(|&own| own == 0.0));
    let [rates, _] = corner.slips(at);
    assert_eq!(rates[..4], [10.0, 2.0, 2.0, 3.0]);
    // A block without contacts in its frictions takes the default, zero.
    let [force, _] = Table::new(2.0, 3.0, 5.0, 0.7).grip_shares(At::of(0.0, &[0.0; 5], &[0.0; 5]));
    assert!(force.iter().all(|&share| share == 0.0));
}

#[test]
fn outputs_take_the_forces_of_contacts_and_frictions() {
    let shown = Shown::new(2.0, 0.5, 7.0);
    let (q, v) = ([0.1, 0.2], [3.0, 4.0]);
    let at = At::of(0.0, &q, &v);
    let (mut contacts, mut frictions) = ([0.0; MOST_LIMITS], [0.0; MOST_FRICTIONS]);
    contacts[0] = 11.0;
    frictions[..3].copy_from_slice(&[-5.5, -4.2, -5.6]);
    let value = |index: usize| {
        let (mut pushed, mut free) = ([0.0; 2], [0.0; 2]);
        let reactions = [&[0.0; 2][..], &contacts, &frictions];
        shown.output_of(index, at, &[1.0, 2.0], reactions, &mut pushed);
        shown.output(index, at, &mut free);
        (pushed, free)
    };
    assert_eq!(value(0), ([11.0, 0.0], [0.0; 2]));
    assert_eq!(value(1), ([-5.5, 0.0], [0.0; 2]));
    assert_eq!(value(2), ([-4.2, -5.6], [0.0; 2]));
    let ([heat, _], free) = value(3);
    assert!(close(heat, 4.2 * 3.0 + 5.6 * 4.0 + 5.5 * 3.0) && free == [0.0; 2], "{heat}");
    // Without contacts it falls freely.
    assert_eq!(value(4), ([15.0, 0.0], [-2.0 * 9.81, 0.0]));
    assert_eq!(shown.drag(0.0, &q, &v), [0.0; 2]);
    // The name of a method of `System` is free.
    assert_eq!(shown.grips(0.0, &q, &v), 3.0);
    assert_eq!(System::grips(&shown, at)[0][..3], [0.0, 7.0, 7.0]);
}

/// The block comes to rest after one second.
#[test]
fn outputs_of_a_run_contain_the_forces_of_contacts_and_frictions() {
    let guided = Guided::new(2.0, 0.2, 6.0);
    let run = solve(&guided, (0.0, 2.0), [0.0; 2], [5.0, 0.0]).every(0.25).run().unwrap();
    let [push, rub, drag, load] =
        ["push", "rub", "drag", "load"].map(|name| run.output(&guided, name).unwrap());
    for (k, &t) in run.t.iter().enumerate() {
        assert!((push[k] - 20.0).abs() < 1e-9, "{t}: {push:?}");
        let (rubs, drags) = if t < 0.99 { (-4.0, -6.0) } else { (0.0, 0.0) };
        assert!(t == 1.0 || (rub[k] - rubs).abs() < 1e-9, "{t}: {rub:?}");
        assert!(t == 1.0 || (drag[k] - drags).abs() < 1e-9, "{t}: {drag:?}");
        assert!((load[k] - rub[k] - drag[k]).abs() < 1e-9, "{t}: {load:?}");
    }
}

#[test]
fn the_force_of_a_friction_is_a_power_per_unit_of_its_rate() {
    let units = |facts: &pendulum_runtime::system::Facts| {
        facts.frictions.iter().map(|own| (own.unit, own.reaction_unit)).collect::<Vec<_>>()
    };
    assert_eq!(units(&Belted::FACTS)[0], ("m/s", "kg·m/s²"));
    assert_eq!(units(&Table::FACTS)[0], ("1/s", "kg·m²/s²"));
}

#[test]
fn inputs_of_rates_and_forces_are_sampled_with_the_accelerations() {
    let needed: Vec<_> = Belted::FACTS.inputs.iter().map(|input| input.accelerations).collect();
    let rates = Derivatives::VELOCITY.union(Derivatives::ACCELERATION);
    assert_eq!(needed, [rates, Derivatives::POSITION]);
}

#[test]
fn friction_is_in_the_facts() {
    let facts = Table::FACTS;
    assert!(facts.nonconservative && !facts.velocity_free && !facts.autonomous);
    const { assert!(!Ball::FACTS.velocity_free && Ball::FACTS.autonomous) };
    assert!(Smooth::FACTS.velocity_free && Smooth::FACTS.frictions.is_empty());
    assert_eq!(Ball::FACTS.unused, ["J"]);
}
