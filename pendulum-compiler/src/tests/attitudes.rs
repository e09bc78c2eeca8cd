//! Coordinates that are rotations, against the equations of Newton and Euler.

use super::{Random, derive, evaluate, refusals};
use crate::algebra::expr::{Graph, Id, Symbol};
use crate::backend::names::Names;
use crate::backend::unicode;
use crate::mechanics::lower::Energies;
use crate::mechanics::motion::Motion;
use crate::schedule;

type Vector = [f64; 3];

fn cross(a: Vector, b: Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}

fn plus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] + b[k])
}

fn times(factor: f64, a: Vector) -> Vector {
    a.map(|part| factor * part)
}

/// a b of two quaternions.
fn product(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    let (u, v) = ([a[1], a[2], a[3]], [b[1], b[2], b[3]]);
    let [x, y, z] = plus(plus(times(a[0], v), times(b[0], u)), cross(u, v));
    [a[0] * b[0] - u[0] * v[0] - u[1] * v[1] - u[2] * v[2], x, y, z]
}

fn back(q: [f64; 4]) -> [f64; 4] {
    [q[0], -q[1], -q[2], -q[3]]
}

fn turned(q: [f64; 4], [x, y, z]: Vector) -> Vector {
    let [_, x, y, z] = product(product(q, [0.0, x, y, z]), back(q));
    [x, y, z]
}

/// A random state of coordinates behind which rotations stand, with unit quaternions that move on
/// the sphere.
struct State {
    q: Vec<f64>,
    v: Vec<f64>,
}

impl State {
    fn new(random: &mut Random, before: usize, rotations: usize) -> Self {
        let mut number = || random.uniform(-1.0, 1.0);
        let mut q: Vec<f64> = (0..before).map(|_| number()).collect();
        let mut v: Vec<f64> = (0..before).map(|_| number()).collect();
        for _ in 0..rotations {
            let own: [f64; 4] = [(); 4].map(|()| number());
            let length = own.iter().map(|part| part * part).sum::<f64>().sqrt();
            let own = own.map(|part| part / length);
            let rates = [0.0, 2.0 * number(), 2.0 * number(), 2.0 * number()];
            q.extend(own);
            v.extend(product(own, rates).map(|part| part / 2.0));
        }
        Self { q, v }
    }

    fn attitude(&self, first: usize) -> [f64; 4] {
        [0, 1, 2, 3].map(|k| self.q[first + k])
    }

    /// The rates about the axes of the body.
    fn rates(&self, first: usize) -> Vector {
        let v = [0, 1, 2, 3].map(|k| self.v[first + k]);
        let [_, x, y, z] = product(back(self.attitude(first)), v);
        [2.0 * x, 2.0 * y, 2.0 * z]
    }

    /// The accelerations of the quaternion for given angular accelerations in the body.
    fn accelerations(&self, first: usize, [x, y, z]: Vector) -> [f64; 4] {
        let (q, v) = (self.attitude(first), [0, 1, 2, 3].map(|k| self.v[first + k]));
        let [a, b, c] = self.rates(first);
        let (one, other) = (product(v, [0.0, a, b, c]), product(q, [0.0, x, y, z]));
        [0, 1, 2, 3].map(|k| one[k].midpoint(other[k]))
    }

    fn evaluate(&self, graph: &Graph, id: Id, parameters: &[f64], momenta: &[f64]) -> f64 {
        evaluate(graph, id, &|symbol| match symbol {
            Symbol::Parameter(k) => parameters[k],
            Symbol::Coordinate(k) => self.q[k],
            Symbol::Velocity(k) => self.v[k],
            Symbol::Momentum(k) => momenta[k],
            other => panic!("{other:?}"),
        })
    }

    fn all(&self, graph: &Graph, ids: &[Id], parameters: &[f64]) -> Vec<f64> {
        ids.iter().map(|&id| self.evaluate(graph, id, parameters, &[])).collect()
    }
}

fn close(own: &[f64], known: &[f64], what: &str) {
    assert_eq!(own.len(), known.len(), "{what}");
    for (own, known) in own.iter().zip(known) {
        assert!((own - known).abs() < 1e-12 * (1.0 + known.abs()), "{what}: {own}, not {known}");
    }
}

/// A heavy body with damping, a torque of space and a force at a point, all at once.
const BODY: &str = "struct Body { A, B, C, k, c, F }
    coordinate R: rotation;
    let W = transpose(R)*angular_velocity(R);
    kinetic = (A*W.x^2 + B*W.y^2 + C*W.z^2)/2; potential = k*inner([1, 2, 3], R*[3, 2, 1]);
    dissipation = c/2*|angular_velocity(R)|^2;
    torque R = [0, F, 0]; force R*[1, 0, 2] = [F, 0, F];";
const PARAMETERS: [f64; 6] = [1.3, 2.1, 0.7, 0.4, 0.3, 0.9];

/// Euler's equations of that body, with the rates Ω: the angular accelerations in the body.
fn euler(state: &State, first: usize) -> Vector {
    let [a, b, c, k, damping, f] = PARAMETERS;
    let (q, w) = (state.attitude(first), state.rates(first));
    let moment = [a * w[0], b * w[1], c * w[2]];
    let arm = |u: Vector, force: Vector| cross(u, turned(back(q), force));
    let torque = plus(
        plus(turned(back(q), [0.0, f, 0.0]), arm([1.0, 0.0, 2.0], [f, 0.0, f])),
        plus(arm([3.0, 2.0, 1.0], times(-k, [1.0, 2.0, 3.0])), times(-damping, w)),
    );
    let sum = plus(torque, times(-1.0, cross(w, moment)));
    [sum[0] / a, sum[1] / b, sum[2] / c]
}

#[test]
fn a_body_moves_by_the_equations_of_euler() {
    derive(BODY, |_, graph, motion| {
        let mut random = Random(3);
        for _ in 0..20 {
            let state = State::new(&mut random, 0, 1);
            let known = state.accelerations(0, euler(&state, 0));
            close(&state.all(graph, &motion.accelerations, &PARAMETERS), &known, "accelerations");
        }
    });
}

/// M q̈ = f, p = M q̇ with q · p = 0, q̇ from p, the rates of the momenta, and the energy with its
/// power, for the velocities of the body.
fn consistent(graph: &mut Graph, motion: &Motion, state: &State, parameters: &[f64]) {
    let count = state.q.len();
    let all = |ids: &[Id]| state.all(graph, ids, parameters);
    let accelerations = all(&motion.accelerations);
    let masses: Vec<Vec<f64>> = motion.mass_matrix.iter().map(|row| all(row)).collect();
    let times = |vector: &[f64]| -> Vec<f64> {
        masses.iter().map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum()).collect()
    };
    let mut forces = all(&motion.forces);
    let multipliers = all(&motion.constraints.multipliers);
    for (row, multiplier) in motion.constraints.held.iter().zip(&multipliers) {
        let gradient = all(&row.gradient);
        forces.iter_mut().zip(gradient).for_each(|(force, part)| *force += part * multiplier);
    }
    close(&times(&accelerations), &forces, "M q̈ = f");
    let momenta = all(&motion.momenta);
    close(&times(&state.v), &momenta, "p = M q̇");
    if let Some(velocities) = &motion.velocities {
        let own: Vec<f64> =
            velocities.iter().map(|&id| state.evaluate(graph, id, parameters, &momenta)).collect();
        close(&own, &state.v, "q̇ = M⁻¹ p");
    }
    for row in &motion.constraints.held {
        let gradient = all(&row.gradient);
        let [rate, drift] = [row.rate, row.drift].map(|id| all(&[id])[0]);
        let along = |vector: &[f64]| gradient.iter().zip(vector).map(|(a, b)| a * b).sum::<f64>();
        close(&[along(&state.v)], &[rate], "ġ");
        close(&[along(&accelerations) + drift], &[0.0], "g̈");
    }
    // Rates along the motion, by central differences of the fourth order.
    let along = |h: f64| {
        let mut ahead = State { q: state.q.clone(), v: state.v.clone() };
        for k in 0..count {
            ahead.q[k] += h * state.v[k] + h * h / 2.0 * accelerations[k];
            ahead.v[k] += h * accelerations[k];
        }
        ahead
    };
    let rate = |id: Id| {
        let at = |h: f64| along(h).evaluate(graph, id, parameters, &[]);
        let h = 1e-3;
        (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h)
    };
    let rates = all(&motion.momentum_rates);
    for (k, &known) in rates.iter().enumerate() {
        let own = rate(motion.momenta[k]);
        assert!((own - known).abs() < 1e-7 * (1.0 + known.abs()), "ṗ: {own}, not {known}");
    }
    let (own, known) = (rate(motion.energy), all(&[motion.power])[0]);
    assert!((own - known).abs() < 1e-7 * (1.0 + known.abs()), "power: {own}, not {known}");
}

#[test]
fn matrices_momenta_and_powers_agree() {
    let blocks = [
        (BODY, 0, 1),
        (
            "struct Two { A, B, C, k, c, F } coordinate x: [_; 3]; coordinate R[2]: rotation;
             let W[j in 0..2] = transpose(R[j])*angular_velocity(R[j]);
             kinetic = |dot(x + R[0]*[1, 0, A])|^2*B/2 + |dot(x + R[1]*[A, 1, 0])|^2*C/2
                     + sum(j in 0..2, A*W[j].x^2 + B*W[j].y^2 + C*W[j].z^2);
             potential = k*height(x + R[0]*[1, 2, 3]) + k*inner(R[0]*[0, 1, 0], R[1]*[0, 1, 0]);
             dissipation = c/2*|angular_velocity(R[0]) - angular_velocity(R[1])|^2;
             torque transpose(R[0])*R[1] = [F, 0, 0];",
            3,
            2,
        ),
        (
            "struct Held { A, B, C, k, c, F } coordinate x: [_; 3]; coordinate R: rotation;
             let W = transpose(R)*angular_velocity(R);
             kinetic = |dot(x)|^2*B/2 + A*W.x^2 + B*W.y^2 + C*W.z^2;
             potential = k*height(x); constraint hinge: x = R*[1, A, 0]; constraint spin: W.z = c;",
            3,
            1,
        ),
    ];
    for (block, before, rotations) in blocks {
        derive(block, |_, graph, motion| {
            let mut random = Random(5);
            for _ in 0..5 {
                let state = State::new(&mut random, before, rotations);
                if motion.constraints.norms.len() == motion.constraints.held.len() {
                    consistent(graph, motion, &state, &PARAMETERS);
                } else {
                    held(graph, motion, &state);
                }
            }
        });
    }
}

/// The accelerations of a system with constraints fulfil M q̈ = f + Cᵀλ and C q̈ + drift = 0.
fn held(graph: &Graph, motion: &Motion, state: &State) {
    let all = |ids: &[Id]| state.all(graph, ids, &PARAMETERS);
    let accelerations = all(&motion.accelerations);
    let multipliers = all(&motion.constraints.multipliers);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut forces = all(&motion.forces);
    for (row, multiplier) in motion.constraints.held.iter().zip(multipliers) {
        let gradient = all(&row.gradient);
        close(&[dot(&gradient, &accelerations) + all(&[row.drift])[0]], &[0.0], "g̈");
        forces.iter_mut().zip(gradient).for_each(|(force, part)| *force += part * multiplier);
    }
    let left: Vec<f64> =
        motion.mass_matrix.iter().map(|row| dot(&all(row), &accelerations)).collect();
    close(&left, &forces, "M q̈ = f + Cᵀλ");
}

/// A top on its tip by its attitude and by Euler angles, with q̈ of the quaternion by the chain
/// rule.
#[test]
fn angular_accelerations_are_those_of_euler_angles() {
    let block = |coordinates: &str| {
        format!(
            "struct Top {{ A, C, m, l, g }} {coordinates}
             let W = transpose(R)*angular_velocity(R);
             kinetic = (A*(W.x^2 + W.y^2) + C*W.z^2)/2 + m/2*|dot(R*[0, 0, l])|^2;
             potential = m*g*l*height(R*[0, 0, 1]);
             output turning = dot(transpose(R)*angular_velocity(R));"
        )
    };
    let parameters = [1.3, 0.6, 0.8, 0.5, 9.81];
    let angles = [0.4f64, 1.1, -0.8];
    let rates = [0.9, -0.6, 2.2];
    let of = |source: &str, state: &State| {
        let mut errors = crate::messages::Errors::default();
        let found = crate::compile::derived(source, &mut errors, |_, graph, _, energies| {
            state.all(graph, &energies.outputs[0].scalars, &parameters)
        });
        assert!(errors.is_empty(), "{:?}", errors.messages());
        found.unwrap()
    };
    let known = of(
        &block(
            "coordinate φ; coordinate θ; coordinate ψ;
             let R = rotation([0, 0, 1], φ)*rotation([1, 0, 0], θ)*rotation([0, 0, 1], ψ);",
        ),
        &State { q: angles.to_vec(), v: rates.to_vec() },
    );
    let half = |angle: f64| ((angle / 2.0).cos(), (angle / 2.0).sin());
    let [(c, s), (d, t), (e, u)] = angles.map(half);
    let q = product(product([c, 0.0, 0.0, s], [d, t, 0.0, 0.0]), [e, 0.0, 0.0, u]);
    let [_, theta, psi] = angles;
    let w = [
        rates[0] * theta.sin() * psi.sin() + rates[1] * psi.cos(),
        rates[0] * theta.sin() * psi.cos() - rates[1] * psi.sin(),
        rates[2] + rates[0] * theta.cos(),
    ];
    let v = product(q, [0.0, w[0], w[1], w[2]]).map(|part| part / 2.0);
    let own = of(&block("coordinate R: rotation;"), &State { q: q.to_vec(), v: v.to_vec() });
    close(&own, &known, "angular accelerations");
}

#[rustfmt::skip]
const REFUSED: &[(&str, &str)] = &[
    ("struct S { J } coordinate R: rotation; kinetic = J*|angular_velocity(R)|^2*0;", "`R` has no kinetic energy, so its acceleration is undetermined; add that of its body, as `J/2*|angular_velocity(R)|^2`"),
    ("struct S { J } coordinate R: rotation; kinetic = J/2*|angular_velocity(R)|^2; output a = R.x;", "`R` is a rotation, whose entries have no names; write `inner(u, R*v)` for the entry between two directions"),
    ("struct S { J } coordinate R: rotation; kinetic = J/2*|angular_velocity(R)|^2; output a = Ṙ;", "the derivative of a rotation is no vector; write `angular_velocity(R)`, or `dot(R*u)` for a vector that it turns"),
    ("struct S { J } coordinate R: rotation; kinetic = J/2*|angular_velocity(R)|^2; output A: [1; 3] = R;", "`R` is a rotation, and `A` is none; write `output A: rotation`"),
    ("struct S { J } coordinate R: rotation; kinetic = J/2*|angular_velocity(R)|^2; output A: rotation = R*[1, 0, 0];", "`R*[1, 0, 0]` is a space vector, but `A` is declared as a rotation; write `[_; 3]`"),
    ("struct S { J: rotation } coordinate θ; kinetic = θ̇^2;", "a parameter is no rotation; declare its axis and its angle, as `n: [1; 3]` and `φ: rad`, and write `rotation(n, φ)`"),
    ("struct S { J } coordinate R: rotation; kinetic = J/2*|angular_velocity(R)|^2; constraint fix: R*[1, 0, 0] = [1, 0, 0];", "`fix.z` follows from `fix.x` and `fix.y`: leave it out, or write `redundant constraint` to have it checked"),
];

#[test]
fn mistakes_with_coordinates_of_rotation_are_told() {
    for (block, expected) in REFUSED {
        assert_eq!(refusals(block), [*expected], "{block}");
    }
}

/// The rates of a driven rotation and their derivatives follow from those of its quaternion, which
/// may have any length.
#[test]
fn driven_rotations_turn_with_the_rates_of_their_quaternions() {
    let block = "struct S { u: [_; 3] } coordinate x; driven P: rotation; kinetic = ẋ^2;
        output turned = P*u; output back = transpose(P)*u; output rate = dot(P*u);
        output turning = angular_velocity(P); output second = dot(dot(P*u));";
    let (u, mut random) = ([0.3, -1.1, 0.7], Random(9));
    let state = State::new(&mut random, 0, 1);
    let (q, w) = (state.attitude(0), state.rates(0));
    let turning = [0.4, 0.9, -1.3];
    let a = state.accelerations(0, turning);
    // The same motion with the length 1.3 + 0.4 t + 0.35 t², at t = 0.
    let length = [1.3, 0.4, 0.7];
    let [q1, v1, a1] = [&state.q[..4], &state.v[..4], &a[..]];
    let long: Vec<[f64; 3]> = (0..4)
        .map(|k| {
            let [l, dl, ddl] = length;
            [l * q1[k], l * v1[k] + dl * q1[k], l * a1[k] + 2.0 * dl * v1[k] + ddl * q1[k]]
        })
        .collect();
    let mut errors = crate::messages::Errors::default();
    crate::compile::derived(block, &mut errors, |_, graph, _, energies| {
        let value = |symbol| match symbol {
            Symbol::Parameter(k) => u[k],
            Symbol::Input { component, order, .. } => long[component][usize::from(order)],
            other => panic!("{other:?}"),
        };
        let second = plus(cross(w, cross(w, u)), cross(turning, u));
        let known = [
            turned(q, u),
            turned(back(q), u),
            turned(q, cross(w, u)),
            turned(q, w),
            turned(q, second),
        ];
        for (output, known) in energies.outputs.iter().zip(known) {
            let own: Vec<f64> =
                output.scalars.iter().map(|&id| evaluate(graph, id, &value)).collect();
            close(&own, &known, "driven");
        }
    });
    assert!(errors.is_empty(), "{:?}", errors.messages());
}

/// Bones in series, each with its attitude in space. The mass matrix is full, so that the
/// operations grow with the square of the length.
#[test]
fn bones_in_series_stay_short() {
    for (n, mul, add) in [(1, 42, 24), (2, 205, 114), (3, 501, 260)] {
        let block = format!(
            "struct Bones {{ m: [kg; {n}], l: [m; {n}], A: [kg*m^2; {n}], C: [kg*m^2; {n}], g: m/s^2 }}
             coordinate R[{n}]: rotation;
             let W[k in 0..{n}] = transpose(R[k])*angular_velocity(R[k]);
             let y[k in 0..{n}] = sum(j in 0..=k, l[j]*R[j]*[0, 0, 1]);
             kinetic = sum(k in 0..{n}, m[k]/2*|dot(y[k])|^2 + (A[k]*(W[k].x^2 + W[k].y^2) + C[k]*W[k].z^2)/2);
             potential = sum(k in 0..{n}, m[k]*g*height(y[k]));"
        );
        let count = derive(&block, |_, graph, motion| {
            schedule::program(graph, &motion.accelerations).count()
        });
        assert!(count.mul <= mul && count.add <= add && count.sincos == 0, "{n}: {count:?}");
    }
}

/// Returns the conserved quantities of a body as printed.
fn conserved(declared: &str, statements: &str) -> Vec<String> {
    let block = format!(
        "struct Body {{ A, B, C, k }} {declared} coordinate R: rotation;
         let W = transpose(R)*angular_velocity(R); {statements}"
    );
    derive(&block, |model, _, motion| {
        let names = Names::new(model, &Energies::default());
        motion.conserved.iter().map(|own| unicode::conserved(&names, own)).collect()
    })
}

#[test]
fn momenta_of_turns_are_found() {
    let skew = "kinetic = A*W.x^2 + B*W.y^2 + C*W.z^2;";
    let round = "kinetic = A*(W.x^2 + W.y^2) + C*W.z^2;";
    let all = ["L_R.x", "L_R.y", "L_R.z"];
    assert_eq!(conserved("", skew), all);
    assert_eq!(conserved("", round), [&all[..], &["Pi_R.z"]].concat());
    let up = "potential = k*height(R*[0, 0, 1]);";
    assert_eq!(conserved("", &format!("{skew} {up}")), ["L_R.z"]);
    assert_eq!(conserved("", &format!("{round} {up}")), ["L_R.z", "Pi_R.z"]);
    let aside = "potential = k*height(R*[0, 1, 1]);";
    assert_eq!(conserved("", &format!("{round} {aside}")), ["L_R.z"]);
    // A torque that does no work about one of the axes, and a damper, which does about all.
    let torque = "torque R = k*[0, 0, sin(t)];";
    assert_eq!(conserved("", &format!("{skew} {torque}")), ["L_R.x", "L_R.y"]);
    let torque = "torque R = k*(R*[1, 0, 0]);";
    assert_eq!(conserved("", &format!("{round} {torque}")), ["Pi_R.z"]);
    let damper = "dissipation = k*|angular_velocity(R)|^2;";
    assert!(conserved("", &format!("{round} {damper}")).is_empty());
}

#[test]
fn turns_of_a_body_and_of_its_centre_belong_together() {
    let centre = "coordinate x: [_; 3];";
    let energies = "kinetic = |dot(x)|^2/2 + A*W.x^2 + B*W.y^2 + C*W.z^2;
                    potential = k*|x + R*[1, 2, 0]|^2;";
    let turns = ["x", "y", "z"].map(|axis| {
        let [next, last] = match axis {
            "x" => ["y", "z"],
            "y" => ["z", "x"],
            _ => ["x", "y"],
        };
        (format!("x.{next}*p_x.{last}"), format!("x.{last}*p_x.{next}"), format!("L_R.{axis}"))
    });
    let found = conserved(centre, energies);
    assert_eq!(found.len(), 3, "{found:?}");
    for ((positive, negative, own), found) in turns.into_iter().zip(found) {
        assert!(
            [&positive, &negative, &own].iter().all(|part| found.contains(part.as_str())),
            "{found}"
        );
        assert_eq!(found.matches('-').count(), 1, "{found}");
    }
    let falling = "kinetic = |dot(x)|^2/2 + A*W.x^2 + B*W.y^2 + C*W.z^2; potential = x.z;";
    let found = conserved(centre, falling);
    for expected in ["p_x.x", "p_x.y", "L_R.x", "L_R.y", "L_R.z"] {
        assert!(found.iter().any(|own| own == expected), "{found:?}");
    }
}
