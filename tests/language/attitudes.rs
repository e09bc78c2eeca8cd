//! Coordinates that are rotations, in motion.

use pendulum_runtime::attitude::{Attitude, Rates};
use pendulum_runtime::motion::Still;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Dual;
use pendulum_runtime::system::{At, Jacobians, Output, System};

use systems::random::Random;

lagrangian! {
    /// A symmetric top on its tip, in any attitude.
    #[derive(Clone, Debug)]
    pub struct Top { A: kg*m^2, C: kg*m^2, k: N*m }
    coordinate R: rotation;
    let W = transpose(R)*angular_velocity(R);
    kinetic = (A*(W.x^2 + W.y^2) + C*W.z^2)/2;
    potential = k*height(R*[0, 0, 1]);
    output axis: [1; 3] = R*[0, 0, 1];
    output side: [1; 3] = R*[1, 0, 0];
    output spin: [rad/s; 3] = W;
}

lagrangian! {
    /// The same in Euler angles.
    #[derive(Clone, Debug)]
    pub struct Angles { A: kg*m^2, C: kg*m^2, k: N*m }
    coordinate φ: rad;
    coordinate θ: rad;
    coordinate ψ: rad;
    let R = rotation([0, 0, 1], φ)*rotation([1, 0, 0], θ)*rotation([0, 0, 1], ψ);
    let W = transpose(R)*angular_velocity(R);
    kinetic = (A*(W.x^2 + W.y^2) + C*W.z^2)/2;
    potential = k*height(R*[0, 0, 1]);
    output axis: [1; 3] = R*[0, 0, 1];
    output side: [1; 3] = R*[1, 0, 0];
}

lagrangian! {
    /// A body with a damping and a torque.
    #[derive(Clone, Debug)]
    pub struct Driven { A: kg*m^2, B: kg*m^2, C: kg*m^2, c: N*m*s, F: N*m }
    coordinate R: rotation;
    let W = transpose(R)*angular_velocity(R);
    kinetic = (A*W.x^2 + B*W.y^2 + C*W.z^2)/2;
    dissipation = c/2*|angular_velocity(R)|^2;
    torque R = F*[1, cos(2), -1];
}

lagrangian! {
    /// A body on a ball joint beside its centre.
    #[derive(Clone, Debug)]
    pub struct Held { m: kg, J: kg*m^2, l: m }
    coordinate x: [m; 3];
    coordinate R: rotation;
    kinetic = m/2*|dot(x)|^2 + J/2*|angular_velocity(R)|^2;
    constraint joint: x = l*R*[1, 0, 0];
}

lagrangian! {
    /// A body whose tip rests on the ground, with the centre on its first axis.
    #[derive(Clone, Debug)]
    pub struct Tip { J: [kg*m^2; 3, 3], k: N*m }
    coordinate R: rotation;
    let W = transpose(R)*angular_velocity(R);
    kinetic = inner(W, J*W)/2;
    potential = k*height(R*[1, 0, 0]);
    output spin: [rad/s; 3] = W;
    output up: [1; 3] = transpose(R)*[0, 0, 1];
}

lagrangian! {
    /// A camera on a joint of a body, and a ship below.
    #[derive(Clone, Debug)]
    pub struct Gaze { J: kg*m^2, n: [1; 3] }
    driven S: rotation;
    coordinate R[2]: rotation;
    coordinate φ: rad;
    let head[k in 0..2] = R[k]*rotation(n, φ);
    kinetic = J/2*(|angular_velocity(R[0])|^2 + |angular_velocity(R[1])|^2 + φ̇^2);
    output head: rotation = head[1];
    output aboard[k in 0..2]: rotation = transpose(S)*head[k];
    output view: [1; 3] = head[1]*[1, 2, 3];
    output none = product(k in 0..0, R[k]);
}

/// a b of two quaternions.
fn product(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] + a[2] * b[0] + a[3] * b[1] - a[1] * b[3],
        a[0] * b[3] + a[3] * b[0] + a[1] * b[2] - a[2] * b[1],
    ]
}

/// The quaternion of a turn about an axis of any length by its length times `angle`.
fn turn(axis: [f64; 3], angle: f64) -> [f64; 4] {
    let length = axis.iter().map(|part| part * part).sum::<f64>().sqrt();
    let (sine, cosine) = (length * angle / 2.0).sin_cos();
    let [x, y, z] = axis.map(|part| part / length * sine);
    [cosine, x, y, z]
}

fn turned(q: [f64; 4], [x, y, z]: [f64; 3]) -> [f64; 3] {
    let back = [q[0], -q[1], -q[2], -q[3]];
    let [_, x, y, z] = product(product(q, [0.0, x, y, z]), back);
    [x, y, z]
}

/// The velocities of a quaternion for rates about the axes of the body.
fn rates(q: [f64; 4], [x, y, z]: [f64; 3]) -> [f64; 4] {
    product(q, [0.0, x / 2.0, y / 2.0, z / 2.0])
}

fn near(own: &[f64], known: &[f64], tolerance: f64) {
    for (own, known) in own.iter().zip(known) {
        assert!((own - known).abs() < tolerance, "{own:e}, not {known:e}: {:e}", own - known);
    }
}

#[test]
fn a_top_moves_as_in_euler_angles() {
    let (top, angles) = (Top::new(1.1, 0.7, 2.0), Angles::new(1.1, 0.7, 2.0));
    let (start, speeds) = ([0.4f64, 0.6, -0.8], [0.9, -0.6, 5.2]);
    let [_, theta, psi] = start;
    let w = [
        speeds[0] * theta.sin() * psi.sin() + speeds[1] * psi.cos(),
        speeds[0] * theta.sin() * psi.cos() - speeds[1] * psi.sin(),
        speeds[2] + speeds[0] * theta.cos(),
    ];
    let z = [0.0, 0.0, 1.0];
    let q = product(product(turn(z, start[0]), turn([1.0, 0.0, 0.0], theta)), turn(z, psi));
    let own = solve(&top, (0.0, 10.0), q, rates(q, w)).rtol(1e-12).run().unwrap().end;
    let known = solve(&angles, (0.0, 10.0), start, speeds).rtol(1e-12).run().unwrap().end;
    let [t, ends] = [own.t, known.t];
    near(&top.axis(t, &own.q, &own.v), &angles.axis(ends, &known.q, &known.v), 1e-11);
    near(&top.side(t, &own.q, &own.v), &angles.side(ends, &known.q, &known.v), 1e-11);
}

/// A free symmetric body turns by R = exp(L t/A) R₀ exp((1 − C/A) Ω₃ t e₃) with its angular
/// momentum L.
#[test]
fn a_free_symmetric_body_precesses() {
    let (a, c) = (1.1, 0.7);
    let top = Top::new(a, c, 0.0);
    let q = turn([0.3, -1.0, 0.4], 1.2);
    let w = [0.4, -0.9, 2.3];
    let moment = turned(q, [a * w[0], a * w[1], c * w[2]]);
    let run = solve(&top, (0.0, 100.0), q, rates(q, w)).rtol(1e-13).every(1.0).run().unwrap();
    for own in &run {
        let t = own.t;
        let spin = turn([0.0, 0.0, 1.0], (1.0 - c / a) * w[2] * t);
        let known = product(turn(moment, t / a), product(q, spin));
        near(&top.axis(t, &own.q, &own.v), &turned(known, [0.0, 0.0, 1.0]), 1e-11);
        near(&top.side(t, &own.q, &own.v), &turned(known, [1.0, 0.0, 0.0]), 1e-11);
        let length = own.q.iter().map(|part| part * part).sum::<f64>().sqrt();
        assert!((length - 1.0).abs() <= 4.5e-16, "{:e}", length - 1.0);
    }
}

/// S. Kovalevskaya, Acta Mathematica 12 (1889) 177: with the moments of inertia 2, 2 and 1,
/// |(Ω₁ + iΩ₂)² − k (γ₁ + iγ₂)|² is constant, where γ are the components of the vertical in the body.
#[test]
fn kovalevskayas_top_keeps_its_fourth_integral() {
    let tip = Tip::new([2.0, 2.0, 1.0, 0.0, 0.0, 0.0], 1.5);
    for (q, w) in [
        ([1.0, 0.0, 0.0, 0.0], [0.3, -0.4, 1.2]),
        ([0.5, 0.5, -0.5, 0.5], [1.0, 2.0, 3.0]),
        ([0.6, 0.0, 0.8, 0.0], [0.0, 0.1, 5.0]),
    ] {
        let start = rates(q, w);
        let run = solve(&tip, (0.0, 100.0), q, start).rtol(1e-13).atol(1e-13).every(1.0).run();
        let integral = |q: &[f64; 4], v: &[f64; 4]| {
            let ([x, y, _], [up, side, _]) = (tip.spin(0.0, q, v), tip.up(0.0, q, v));
            (x * x - y * y - 1.5 * up).powi(2) + (2.0 * x * y - 1.5 * side).powi(2)
        };
        for state in &run.unwrap() {
            let change = integral(&state.q, &state.v) / integral(&q, &start) - 1.0;
            assert!(change.abs() < 1e-12, "{change:e} at {}", state.t);
        }
    }
}

/// Returns sn, cn and dn of u for the parameter m, by descending Landen transformations; Abramowitz
/// and Stegun (1964), 16.4.
fn jacobi(u: f64, m: f64) -> [f64; 3] {
    let (mut means, mut b) = (vec![(1.0, m.sqrt())], (1.0 - m).sqrt());
    while let Some(&(a, c)) = means.last()
        && 1e-17 < c
    {
        means.push((0.5 * (a + b), 0.5 * (a - b)));
        b = (a * b).sqrt();
    }
    let last = means.len() - 1;
    let angle = f64::from(1 << last) * means[last].0 * u;
    let angle = means[1..]
        .iter()
        .rev()
        .fold(angle, |angle: f64, (a, c)| 0.5 * (angle + (c / a * angle.sin()).asin()));
    [angle.sin(), angle.cos(), (1.0 - m * angle.sin().powi(2)).sqrt()]
}

/// L. D. Landau and E. M. Lifshitz, Mechanics (1976), § 37, equations 37.10.
#[test]
fn a_free_body_turns_by_elliptic_functions() {
    let [a, b, c] = [1.0, 2.0, 3.0];
    let free = Tip::new([a, b, c, 0.0, 0.0, 0.0], 0.0);
    let (q, start) = (turn([1.0, -0.4, 2.0], 0.8), [0.4, 0.0, 1.1]);
    let energy = a * start[0] * start[0] + c * start[2] * start[2];
    let moment = a * a * start[0] * start[0] + c * c * start[2] * start[2];
    let (slow, fast) = (energy * c - moment, moment - energy * a);
    let m = (b - a) * slow / ((c - b) * fast);
    let rate = ((c - b) * fast / (a * b * c)).sqrt();
    let most = [slow / (a * (c - a)), slow / (b * (c - b)), fast / (c * (c - a))].map(f64::sqrt);
    let run = solve(&free, (0.0, 100.0), q, rates(q, start)).rtol(1e-13).atol(1e-13).every(0.5);
    for state in &run.run().unwrap() {
        let [sn, cn, dn] = jacobi(rate * state.t, m);
        let known = [most[0] * cn, most[1] * sn, most[2] * dn];
        near(&free.spin(0.0, &state.q, &state.v), &known, 1e-11);
    }
}

#[test]
fn the_energy_balance_counts_torques_and_damping() {
    let body = Driven::new(1.1, 1.9, 0.7, 0.2, 0.9);
    let q = turn([0.3, -1.0, 0.4], 1.2);
    let v = rates(q, [0.4, -0.9, 2.3]);
    let run = solve(&body, (0.0, 10.0), q, v).rtol(1e-12).every(0.005).run().unwrap();
    let energies: Vec<f64> =
        run.iter().map(|state| body.energy(At::of(state.t, &state.q, &state.v))).collect();
    let powers: Vec<f64> =
        run.iter().map(|state| body.power(At::of(state.t, &state.q, &state.v))).collect();
    // Simpson's rule.
    let parts = powers.windows(3).step_by(2);
    let work: f64 = parts.map(|part| 0.005 / 3.0 * (part[0] + 4.0 * part[1] + part[2])).sum();
    let change = energies[energies.len() - 1] - energies[0];
    assert!(0.1 < change.abs());
    near(&[work], &[change], 1e-8);
}

#[test]
fn jacobians_are_those_of_dual_numbers() {
    let top = Top::new(1.1, 0.7, 2.0);
    let lifted = top.over(Dual::constant);
    let mut random = Random::new(3);
    for _ in 0..20 {
        let q = turn([(); 3].map(|()| random.uniform(-1.0, 1.0)), 1.0);
        let v = rates(q, [(); 3].map(|()| random.uniform(-1.0, 1.0)));
        let column = |q: [Dual; 4], v: [Dual; 4]| {
            lifted.accelerations(At::of(Dual::constant(0.0), &q, &v)).map(|a| a.derivative)
        };
        let (positions, velocities) = (
            top.position_jacobian(At::of(0.0, &q, &v)),
            top.velocity_jacobian(At::of(0.0, &q, &v)),
        );
        for k in 0..4 {
            let (mut moved, mut rated) = (q.map(Dual::constant), v.map(Dual::constant));
            moved[k].derivative = 1.0;
            rated[k].derivative = 1.0;
            near(positions.column(k).as_slice(), &column(moved, v.map(Dual::constant)), 1e-12);
            near(velocities.column(k).as_slice(), &column(q.map(Dual::constant), rated), 1e-12);
        }
    }
}

#[test]
fn a_start_near_the_sphere_is_that_of_the_unit_quaternion() {
    let top = Top::new(1.1, 0.7, 2.0);
    let q = turn([0.3, -1.0, 0.4], 1.2);
    let w = [0.4, -0.9, 2.3];
    let v = rates(q, w);
    let from = |q, v| solve(&top, (0.0, 1.0), q, v).rtol(1e-12).run().map(|run| run.end);
    let known = from(q, v).unwrap();
    // Too long by 9e-7, with a rate of the length of 8e-7.
    let long = q.map(|part| part * (1.0 + 9e-7));
    let faster: [f64; 4] = core::array::from_fn(|k| (1.0 + 9e-7) * (v[k] + 8e-7 * q[k]));
    let own = from(long, faster).unwrap();
    near(&own.q, &known.q, 1e-11);
    near(&own.v, &known.v, 1e-11);
    for (length, rate) in [(1.0 + 2e-6, 0.0), (1.0, 3e-6), (1.0 - 2e-6, 0.0)] {
        let q_ = q.map(|part| length * part);
        let v_ = core::array::from_fn(|k| v[k] + rate * q[k]);
        assert!(from(q_, v_).unwrap_err().to_string().contains("|R|"), "{length} {rate}");
    }
}

#[test]
fn a_start_near_the_sphere_and_off_another_constraint_is_told() {
    let held = Held::new(1.0, 0.1, 0.5);
    // So fast that the rate of the length is never zero to rounding.
    let r = turn([0.3, -1.0, 0.4], 1.2);
    let w = rates(r, [4e5, -9e5, 2e5]);
    let [a, b, c, d] = r.map(|part| part * (1.0 + 4e-7));
    let start = [0.0, 0.0, 0.0, a, b, c, d];
    let speeds = [0.0, 0.0, 0.0, w[0], w[1], w[2], w[3]];
    let message = solve(&held, (0.0, 1.0), start, speeds).run().unwrap_err().to_string();
    assert!(message.contains("the constraint joint"), "{message}");
}

#[test]
fn a_start_off_the_sphere_is_told() {
    let top = Top::new(1.1, 0.7, 2.0);
    let q = turn([0.3, -1.0, 0.4], 1.2);
    let v = rates(q, [0.4, -0.9, 2.3]);
    let from = |factor: f64| solve(&top, (0.0, 1.0), q.map(|part| factor * part), v).run();
    assert!(from(1.0 + 1e-12).is_ok());
    let message = from(1.1).unwrap_err().to_string();
    assert!(message.starts_with("at t = 0.0 the constraint |R| is off by 0.21"), "{message}");
}

#[test]
fn outputs_are_attitudes_with_the_quaternion_of_the_product() {
    let axis = [1.0, -2.0, 2.0];
    let ship = Attitude::from_axis_angle([0.3, 1.0, 0.2], 0.7);
    // Of another length than one.
    let still = Still::new(ship.to_quaternion().map(|part| 3.0 * part));
    let system = Gaze::new(2.0, axis).driven_by(still);
    let bodies = [([1.0, 0.2, 0.0], 2.0), ([0.1, -0.4, 1.0], -1.1)]
        .map(|(axis, angle)| Attitude::from_axis_angle(axis, angle));
    let angle = 0.9;
    let [a, b] = bodies.map(Attitude::to_quaternion);
    let q = [a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3], angle];
    let heads = bodies.map(|body| body * Attitude::from_axis_angle(axis, angle));
    let apart = |a: Attitude, b: Attitude| {
        let [a, b] = [a, b].map(Attitude::to_quaternion);
        (0..4).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max)
    };
    assert!(apart(system.head(0.0, &q, &[0.0; 9]), heads[1]) < 1e-15);
    for (own, head) in system.aboard(0.0, &q, &[0.0; 9]).into_iter().zip(heads) {
        assert!(apart(own, ship.inverse() * head) < 1e-15);
    }
    assert_eq!(system.none(0.0, &q, &[0.0; 9]), Attitude::identity());
    let view = system.head(0.0, &q, &[0.0; 9]) * [1.0, 2.0, 3.0];
    for (own, view) in system.view(0.0, &q, &[0.0; 9]).into_iter().zip(view) {
        assert!((own - view).abs() < 1e-14);
    }
    let names: Vec<String> = Gaze::FACTS.outputs.iter().flat_map(Output::names).collect();
    assert_eq!(names[..6], ["head.w", "head.x", "head.y", "head.z", "aboard[0].w", "aboard[0].x"]);
    let solution = solve(&system, (0.0, 0.1), q, [0.0; 9]).run().unwrap();
    let table = solution.table_with_outputs(&system).unwrap();
    let last = system.head(0.1, &solution.end.q, &solution.end.v).to_quaternion();
    for (name, part) in ["head.w", "head.x", "head.y", "head.z"].into_iter().zip(last) {
        assert!((table.column(name).unwrap().last().unwrap() - part).abs() < 1e-15);
    }
}

#[test]
fn starts_are_set_by_name() {
    let attitude = Attitude::from_euler("zyx", [0.3, 0.1, -0.2]).unwrap();
    let rates = [Rates::body([0.1, 0.2, 0.3]), Rates::space([-1.0, 2.0, 0.5])];
    let start = Gaze::start().φ(0.4, -0.1).R([Attitude::identity(), attitude], rates);
    let parts = [Attitude::identity(), attitude].map(Attitude::to_quaternion);
    assert_eq!(start.q[..4], parts[0]);
    assert_eq!(start.q[4..], [parts[1][0], parts[1][1], parts[1][2], parts[1][3], 0.4]);
    assert_eq!(start.v[..4], rates[0].derivative(Attitude::identity()));
    assert_eq!(start.v[4..8], rates[1].derivative(attitude));
    assert_eq!(start.v[8], -0.1);
    let start = Held::start().x([1.0, 2.0, 3.0], [0.5; 3]);
    assert_eq!(start.q, [1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.0]);
    assert_eq!(start.v, [0.5, 0.5, 0.5, 0.0, 0.0, 0.0, 0.0]);
    let at_rest = Top::start();
    let top = Top::new(1.0, 2.0, 0.0);
    let end = solve(&top, (0.0, 1.0), at_rest.q, at_rest.v).run().unwrap().end;
    assert_eq!(end.q, at_rest.q);
}

#[test]
fn conserved_momenta_of_turns_are_those_of_the_body() {
    assert_eq!(Top::FACTS.conserved, ["L_R.z", "Pi_R.z"]);
    let (a, c) = (1.3, 0.4);
    let top = Top::new(a, c, 2.0);
    let attitude = Attitude::from_euler("zxz", [0.4, 1.0, -2.0]).unwrap();
    let start = Top::start().R(attitude, Rates::body([0.3, -1.0, 2.0]));
    let run = solve(&top, (0.0, 5.0), start.q, start.v).rtol(1e-12).every(0.5).run().unwrap();
    for (q, v) in run.q.iter().zip(&run.v) {
        let mut values = [0.0; 2];
        top.conserved(At::of(0.0, q, v), &mut values);
        let [x, y, z] = top.spin(0.0, q, v);
        let space = Attitude::from_quaternion(*q) * [a * x, a * y, c * z];
        assert!((values[0] - space[2]).abs() < 1e-14 && (values[1] - c * z).abs() < 1e-14);
        let start = attitude * [a * 0.3, -a, c * 2.0];
        assert!((values[0] - start[2]).abs() < 1e-10 && (values[1] - 2.0 * c).abs() < 1e-10);
    }
}
