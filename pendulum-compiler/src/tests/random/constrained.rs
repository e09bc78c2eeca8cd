//! Random constrained systems: trees of links closed by random loops.
//!
//! The tests check that accelerations satisfy the second derivatives of the constraints, computed
//! by dual numbers of dual numbers, and the equations with multipliers. Trees whose links are rods
//! between Cartesian points have the same motion as the same trees in angles. `RANDOM_COUNT=10000`
//! tests more systems.

use super::interpret::Values;
use super::tests::variable;
use crate::compile::derived;
use crate::messages::Errors;
use pendulum_runtime::scalar::{Dual, Real};
use random_systems::Random;
use std::fmt::Write;

/// A random tree: the parent, the length and the mass of each link.
struct Tree {
    links: Vec<(Option<usize>, f64, f64)>,
    gravity: f64,
}

impl Tree {
    fn random(random: &mut Random, most: usize) -> Self {
        let count = 2 + random.below(most - 1);
        let links = (0..count)
            .map(|k| {
                let parent = (0 < k && !random.once_in(6))
                    .then(|| if random.once_in(2) { k - 1 } else { random.below(k) });
                (parent, random.uniform(0.4, 1.6), random.uniform(0.3, 2.0))
            })
            .collect();
        Self { links, gravity: random.uniform(5.0, 12.0) }
    }

    fn parameters(&self) -> Vec<f64> {
        let lengths = self.links.iter().map(|link| link.1);
        let masses = self.links.iter().map(|link| link.2);
        lengths.chain(masses).chain([self.gravity]).collect()
    }

    fn head(&self) -> String {
        let n = self.links.len();
        format!("struct Random {{ L: [m; {n}], m: [kg; {n}], g: m/s^2 }}\n")
    }

    /// Returns the tree in angles, which are the first coordinates, attached to a slider.
    fn angles(&self) -> String {
        let n = self.links.len();
        let mut text = self.head();
        let _ = writeln!(text, "coordinate θ[{n}]: rad; coordinate s: m;");
        for (k, (parent, ..)) in self.links.iter().enumerate() {
            let root = parent.map_or("[s, 0]".into(), |parent| format!("y{parent}"));
            let _ = writeln!(text, "let y{k} = {root} + L[{k}]*cis(θ[{k}]);");
        }
        text.push_str("kinetic = m[0]*ṡ^2;\n");
        self.energies(text)
    }

    /// Returns the tree in Cartesian coordinates, with a constraint for each link.
    fn points(&self) -> String {
        let n = self.links.len();
        let mut text = self.head();
        let _ = writeln!(text, "coordinate a[{n}]: m; coordinate b[{n}]: m; coordinate s: m;");
        for k in 0..n {
            let _ = writeln!(text, "let y{k} = [a[{k}], b[{k}]];");
        }
        text.push_str("kinetic = m[0]*ṡ^2;\n");
        let mut text = self.energies(text);
        for (k, (parent, ..)) in self.links.iter().enumerate() {
            let root = parent.map_or("[s, 0]".into(), |parent| format!("y{parent}"));
            let _ = writeln!(text, "constraint rod{k}: |y{k} - {root}|^2 = L[{k}]^2;");
        }
        text
    }

    fn energies(&self, mut text: String) -> String {
        for k in 0..self.links.len() {
            let _ = writeln!(
                text,
                "kinetic = m[{k}]/2*|dot(y{k})|^2; potential = m[{k}]*g*height(y{k});"
            );
        }
        text
    }

    /// Returns random constraints, fewer than coordinates.
    fn constraints(&self, random: &mut Random) -> String {
        let n = self.links.len();
        let mut text = String::new();
        let mut left = n - 1;
        for index in 0..=random.below(3) {
            let (a, b) = (random.below(n), random.below(n));
            let (kind, rows) = random.of(&[
                ("point", 2),
                ("rod", 1),
                ("slope", 1),
                ("moving", 2),
                ("blade", 1),
                ("gear", 1),
                ("guide", 1),
            ]);
            if left < rows {
                break;
            }
            left -= rows;
            let _ = match kind {
                "point" if a != b => {
                    writeln!(text, "constraint c{index}: y{a} = y{b} + L[{a}]*[1/3, -1/2];")
                }
                "rod" if a != b => writeln!(text, "constraint c{index}: |y{a} - y{b}| = L[{b}];"),
                "moving" => writeln!(
                    text,
                    "constraint c{index}: y{a} = L[{b}]*[sin(t*t*g/L[0]), cos(2*t*t*g/L[0])];"
                ),
                "blade" => writeln!(
                    text,
                    "constraint c{index}: height(dot(y{a}))*cos(θ[{a}]) = dot(y{a}).x*sin(θ[{a}]);"
                ),
                "gear" if a != b => writeln!(
                    text,
                    "constraint c{index}: θ̇[{a}] = 2*θ̇[{b}] + sin(θ[{b}])*g*t/L[{a}];"
                ),
                "guide" => {
                    writeln!(text, "constraint c{index}: height(y{a}) = L[{a}]*sin(y{b}.x/L[{b}]);")
                }
                _ => writeln!(text, "constraint c{index}: height(y{a}) = y{a}.x/3 + L[{b}]/5;"),
            };
        }
        text
    }
}

/// The derived values of a constrained block at a state.
struct Found {
    accelerations: Vec<f64>,
    /// The largest residual of the equations relative to their terms; `independence` is the
    /// smallest independence of the constraints.
    residual: f64,
    independence: f64,
}

/// Returns the accelerations and the residual of the equations, or the errors of a refused block.
fn examine(source: &str, values: &Values<f64>) -> Result<Found, Vec<String>> {
    let mut errors = Errors::default();
    let found = derived(source, &mut errors, |model, graph, motion, _| {
        let constraints = &motion.constraints;
        let of = |roots: &[_]| values.of(model, graph, roots);
        let accelerations = of(&motion.accelerations);
        let multipliers = of(&constraints.multipliers);
        let independence = of(&constraints.independence).into_iter().fold(1.0, f64::min);
        let (n, forces) = (accelerations.len(), of(&motion.forces));
        let mut worst = 0.0f64;
        let mut compare = |sum: f64, scale: f64| {
            let own = sum.abs() / scale.max(1.0);
            worst = if own.is_nan() { own } else { worst.max(own) };
        };
        // C, by dual numbers of the constraints.
        let mut gradients = vec![vec![0.0; n]; constraints.held.len()];
        for j in 0..n {
            let mut pushed = map(values, Dual::constant);
            let constant = pushed.clone();
            pushed.q[j].derivative = 1.0;
            let mut rates = constant;
            rates.v[j].derivative = 1.0;
            for (row, constraint) in gradients.iter_mut().zip(&constraints.held) {
                let at = if constraint.holonomic { &pushed } else { &rates };
                row[j] = at.of(model, graph, &[constraint.value])[0].derivative;
            }
        }
        for j in 0..n {
            let row = of(&motion.mass_matrix[j]);
            let mut terms: Vec<f64> = row.iter().zip(&accelerations).map(|(m, a)| m * a).collect();
            terms.push(-forces[j]);
            terms.extend(gradients.iter().zip(&multipliers).map(|(c, λ)| -c[j] * λ));
            let scale = terms.iter().fold(0.0, |scale: f64, term| scale.max(term.abs()));
            compare(terms.iter().sum(), scale);
        }
        // Second derivatives along the motion, by dual numbers of dual numbers.
        let second = |value: f64, rate: f64, second: f64| Dual {
            value: Dual { value, derivative: rate },
            derivative: Dual { value: rate, derivative: second },
        };
        let mut along = map(values, |value| Dual::constant(Dual::constant(value)));
        along.time = second(values.time, 1.0, 0.0);
        for j in 0..n {
            along.q[j] = second(values.q[j], values.v[j], accelerations[j]);
            // Only the first derivative of the velocities is known.
            along.v[j] = second(values.v[j], accelerations[j], 0.0);
        }
        let largest = accelerations.iter().fold(0.0, |largest: f64, a| largest.max(a.abs()));
        for (constraint, gradient) in constraints.held.iter().zip(&gradients) {
            let found = along.of(model, graph, &[constraint.value])[0];
            let rate = if constraint.holonomic {
                found.derivative.derivative
            } else {
                found.derivative.value
            };
            let size = gradient.iter().fold(1.0, |size: f64, entry| size.max(entry.abs()));
            compare(rate, size * largest);
            let own = values.of(model, graph, &[constraint.rate])[0];
            let expected =
                if constraint.holonomic { found.derivative.value } else { found.value.value };
            compare(own - expected, size);
        }
        // The correction changes the constraints by the target.
        let change = of(&constraints.correction);
        for (k, gradient) in gradients.iter().enumerate() {
            let terms: Vec<f64> = gradient.iter().zip(&change).map(|(c, d)| c * d).collect();
            let scale = terms.iter().fold(0.0, |scale: f64, term| scale.max(term.abs()));
            compare(terms.iter().sum::<f64>() - values.p[k], scale);
        }
        Found { accelerations, residual: worst, independence }
    });
    found.ok_or_else(|| errors.messages())
}

fn map<T: Real>(values: &Values<f64>, lift: impl Fn(f64) -> T) -> Values<T> {
    let all = |values: &[f64]| values.iter().map(|&value| lift(value)).collect::<Vec<T>>();
    Values {
        parameters: all(&values.parameters),
        time: lift(values.time),
        q: all(&values.q),
        v: all(&values.v),
        p: all(&values.p),
        inputs: Vec::new(),
    }
}

/// Returns the seeds of a test.
fn seeds(count: u64) -> std::ops::Range<u64> {
    let first = variable("RANDOM_SEED").unwrap_or(0);
    first..first + variable("RANDOM_COUNT").unwrap_or(count)
}

#[test]
fn closed_trees_fulfil_their_equations() {
    let (mut compared, mut refused) = (0, 0);
    for seed in seeds(30) {
        let mut random = Random(seed);
        let tree = Tree::random(&mut random, 8);
        let source = format!("{}{}", tree.angles(), tree.constraints(&mut random));
        if variable("RANDOM_COUNT") == Some(1) {
            println!("{source}");
        }
        let n = tree.links.len() + 1;
        let values = Values {
            parameters: tree.parameters(),
            time: random.uniform(0.1, 1.0),
            q: (0..n).map(|_| random.uniform(-3.0, 3.0)).collect(),
            v: (0..n).map(|_| random.uniform(-2.0, 2.0)).collect(),
            p: (0..n).map(|_| random.uniform(-1.0, 1.0)).collect(),
            inputs: Vec::new(),
        };
        match examine(&source, &values) {
            Ok(found) => {
                compared += 1;
                // Precision is lost if constraints are nearly dependent.
                let allowed = 1e-12 / found.independence.min(1e-2);
                assert!(
                    found.residual < allowed.min(1e-7),
                    "seed {seed}: {:e} with independence {:e} for\n{source}",
                    found.residual,
                    found.independence
                );
            }
            Err(messages) => {
                // A random constraint may follow from others.
                let known =
                    |text: &String| text.contains("follows from") || text.contains("nothing");
                assert!(messages.iter().all(known), "seed {seed}: {messages:?} for\n{source}");
                refused += 1;
            }
        }
    }
    assert!(refused * 4 < compared, "{refused} of {compared} are refused");
}

#[test]
fn points_on_rods_move_as_angles_do() {
    for seed in seeds(20) {
        let mut random = Random(seed);
        let tree = Tree::random(&mut random, 7);
        let n = tree.links.len();
        let state = |random: &mut Random| (0..=n).map(|_| random.uniform(-2.0, 2.0)).collect();
        let minimal: Values<f64> = Values {
            parameters: tree.parameters(),
            time: 0.3,
            q: state(&mut random),
            v: state(&mut random),
            p: Vec::new(),
            inputs: Vec::new(),
        };
        let source = tree.angles();
        let mut errors = Errors::default();
        let a = derived(&source, &mut errors, |model, graph, motion, _| {
            minimal.of(model, graph, &motion.accelerations)
        })
        .unwrap_or_else(|| panic!("{:?}", errors.messages()));
        // Cartesian positions, velocities and accelerations of the points.
        let mut places: Vec<[[f64; 3]; 2]> = Vec::new();
        for (k, &(parent, length, _)) in tree.links.iter().enumerate() {
            let root = parent
                .map_or([[minimal.q[n], minimal.v[n], a[n]], [0.0; 3]], |parent| places[parent]);
            let (sin, cos) = minimal.q[k].sin_cos();
            let (v, a) = (minimal.v[k], a[k]);
            let own =
                [[cos, -sin * v, -sin * a - cos * v * v], [sin, cos * v, cos * a - sin * v * v]];
            places.push(core::array::from_fn(|i| {
                core::array::from_fn(|order| root[i][order] + length * own[i][order])
            }));
        }
        let all = |order: usize, last: f64| {
            let mut all: Vec<f64> = places.iter().map(|place| place[0][order]).collect();
            all.extend(places.iter().map(|place| place[1][order]));
            all.push(last);
            all
        };
        let points = tree.points();
        let cartesian = Values {
            q: all(0, minimal.q[n]),
            v: all(1, minimal.v[n]),
            p: vec![1.0; n],
            ..minimal.clone()
        };
        let found = examine(&points, &cartesian).unwrap_or_else(|errors| panic!("{errors:?}"));
        let expected = all(2, a[n]);
        let scale = expected.iter().fold(1.0, |scale: f64, a| scale.max(a.abs()));
        for (found, expected) in found.accelerations.iter().zip(&expected) {
            let error = (found - expected).abs() / scale;
            assert!(error < 1e-10, "seed {seed}: {error:e} for\n{points}");
        }
        assert!(found.residual < 1e-10, "seed {seed}: {:e}", found.residual);
    }
}
