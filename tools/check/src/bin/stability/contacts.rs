//! Limits in contact: impacts that accumulate, and what comes to rest.

use crate::numbers::larger;
use ::systems::random::Random;
use check::report::{Report, Scale, Test};
use pendulum_runtime::integrate::Failure;
use pendulum_runtime::lagrangian;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Float;
use pendulum_runtime::system::System;

pub(crate) const TESTS: &[Test] = &[Test { id: "S29", title: "contacts", run: contacts }];

lagrangian! {
    /// A plate that stands on two edges and may rock from one to the other.
    pub(crate) struct Plate { a, b, e, f }
    coordinate y;
    coordinate θ;
    kinetic = ẏ^2/2 + (a^2+b^2)*θ̇^2/6;
    potential = 9.81*y;
    limit left: y - a*sin(θ) - b*cos(θ) >= 0, restitution = e;
    limit right: y + a*sin(θ) - b*cos(θ) >= 0, restitution = f;
}

lagrangian! {
    /// A box that tumbles on its four corners.
    pub(crate) struct Tumbling { a, b, e, f }
    coordinate x;
    coordinate y;
    coordinate θ;
    kinetic = (ẋ^2+ẏ^2)/2 + (a^2+b^2)*θ̇^2/6;
    potential = 9.81*y;
    limit first: y - a*sin(θ) - b*cos(θ) >= 0, restitution = e;
    limit second: y + a*sin(θ) - b*cos(θ) >= 0, restitution = f;
    limit third: y - a*sin(θ) + b*cos(θ) >= 0, restitution = e;
    limit fourth: y + a*sin(θ) + b*cos(θ) >= 0, restitution = f;
}

lagrangian! {
    /// A ball over three lines through one point.
    pub(crate) struct Lines { k: [1; 3], e, f }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2+ẏ^2)/2;
    potential = 9.81*y;
    limit one: y >= k[0]*x, restitution = e;
    limit two: y >= k[1]*x, restitution = f;
    limit three: y >= k[2]*x, restitution = e;
}

lagrangian! {
    /// Four blocks that fall on each other.
    pub(crate) struct Stack { m: [1; 4], d, e, f }
    coordinate z[4];
    kinetic = sum(i in 0..4, m[i]*ż[i]^2/2);
    potential = 9.81*sum(i in 0..4, m[i]*z[i]);
    limit floor: z[0] >= 0, restitution = e;
    limit first: z[1] - z[0] >= d, restitution = f;
    limit second: z[2] - z[1] >= d, restitution = e;
    limit third: z[3] - z[2] >= d, restitution = f;
}

lagrangian! {
    /// Two beads on rods over a floor, on which the rods lock them.
    pub(crate) struct Rods { h, e, f }
    coordinate x;
    coordinate y;
    coordinate u;
    coordinate w;
    kinetic = (ẋ^2 + ẏ^2 + u̇^2 + ẇ^2)/2;
    potential = 9.81*(y + w);
    constraint first: x^2 + y^2 = 1;
    constraint second: (u - x)^2 + (w - y)^2 = 1;
    limit upper: y + h >= 0, restitution = e;
    limit lower: w + h >= 0, restitution = f;
}

lagrangian! {
    /// Two balls on a rod in a corner between a floor and a wall.
    pub(crate) struct Dumbbell { L, e, f, g }
    coordinate x;
    coordinate y;
    coordinate u;
    coordinate w;
    kinetic = (ẋ^2 + ẏ^2 + u̇^2 + ẇ^2)/2;
    potential = g*(x + u) + 9.81*(y + w);
    constraint rod: (u - x)^2 + (w - y)^2 = L^2;
    limit first: y >= 0, restitution = e;
    limit second: w >= 0, restitution = f;
    limit third: x >= 0, restitution = e;
    limit fourth: u >= 0, restitution = f;
}

/// The worst of several runs.
#[derive(Default)]
struct Worst {
    /// The growth of the energy, in tolerances of its size.
    growth: f64,
    /// The depth of a gap below zero, in tolerances.
    depth: f64,
    /// The distance of the energy at the end from that at rest, in tolerances of its size.
    unrest: f64,
    failed: usize,
    /// Impacts that pull or add energy.
    wrong: usize,
}

impl Worst {
    /// Adds a run, which ends at rest with the energy `rest` if given.
    fn add<T: Float, S: System<N, Scalar = T, Inputs = ()>, const N: usize>(
        &mut self,
        system: &S,
        (q, v): ([T; N], [T; N]),
        run: Result<Solution<T, N>, Failure<T, N>>,
        tolerance: f64,
        rest: Option<f64>,
    ) {
        let energy = |state: &State<T, N>| {
            system.energy(At::of(T::from_f64(state.t), &state.q, &state.v)).to_f64()
        };
        let Ok(run) = run else {
            self.failed += 1;
            return;
        };
        let start = energy(&State { t: 0.0, q, v });
        // Errors of the state by one tolerance change the energy by about its size, at least by
        // that of a fall over a metre.
        let size = tolerance * start.abs().max(10.0);
        let mut least = start;
        for state in run.iter().chain([run.end]) {
            let now = energy(&state);
            self.growth = larger(self.growth, (now - least) / size);
            least = least.min(now);
            let [gaps, ..] = system.gaps(At::of(T::from_f64(state.t), &state.q, &state.v));
            for gap in &gaps[..S::FACTS.limits.len()] {
                self.depth = larger(self.depth, -gap.to_f64() / tolerance);
            }
        }
        for impact in &run.impacts {
            let gained = energy(&impact.after) - energy(&impact.state);
            self.wrong += usize::from(impact.impulse.to_f64() < 0.0 || size < gained);
        }
        if let Some(rest) = rest {
            self.unrest = larger(self.unrest, (energy(&run.end) - rest).abs() / size);
        }
    }
}

/// Draws a coefficient of restitution; plastic impacts are frequent.
fn restitution(random: &mut Random) -> f64 {
    if random.once_in(4) { 0.0 } else { random.uniform(0.0, 0.85) }
}

/// Runs the members of a family in one scalar.
fn family(kind: &str, random: &mut Random, count: usize, single: bool) -> Worst {
    let (mut worst, exponent) = (Worst::default(), if single { 5.0 } else { 12.0 });
    for _ in 0..count {
        let tolerance = 10f64.powf(random.uniform(-exponent, -3.0));
        macro_rules! add {
            ($system:expr, $q:expr, $v:expr, $end:expr, $rest:expr) => {{
                let (system, q, v) = ($system, $q, $v);
                if single {
                    let round = |x: f64| x as f32;
                    let (system, q, v) = (system.map(round), q.map(round), v.map(round));
                    let run = solve(&system, (0.0, $end), q, v).rtol(tolerance).every_step().run();
                    worst.add(&system, (q, v), run, tolerance, $rest);
                } else {
                    let run = solve(&system, (0.0, $end), q, v).rtol(tolerance).every_step().run();
                    worst.add(&system, (q, v), run, tolerance, $rest);
                }
            }};
        }
        let [e, f] = [restitution(random), restitution(random)];
        let [a, b] = [random.uniform(0.2, 1.0), random.uniform(0.2, 1.0)];
        let [r, s] = [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)];
        match kind {
            "plates" => {
                // A wide plate cannot fall over.
                let (b, θ) = (0.5 * a * b, 0.2 * r);
                let start = [a * θ.sin().abs() + b * θ.cos() + 1e-6, θ];
                add!(Plate::new(a, b, e, f), start, [0.0; 2], 8.0, Some(9.81 * b));
            }
            "boxes" => {
                let θ = 0.7 * r;
                let start = [0.0, a * θ.sin().abs() + b * θ.cos() + 0.2, θ];
                add!(Tumbling::new(a, b, e, f), start, [r, 0.0, s], 8.0, None);
            }
            "lines" => {
                let (lines, start) = (Lines::new([a, -b, 1.5 * r], e, f), [0.3 * s, 1.0]);
                add!(lines, start, [r, 0.0], 40.0, Some(0.0));
            }
            "stacks" => {
                let stack = Stack::new([a, b, 1.0, 2.0 * a * b], 0.1, e, f);
                let start = [0.2 * b, 0.6, 1.2, 2.0 + a];
                let rest = 9.81 * 0.1 * (b + 2.0 + 6.0 * a * b);
                add!(stack, start, [r, s, 0.0, -r], 30.0, Some(rest));
            }
            "dumbbells" => {
                let arm = [a * (3.1 * r).cos(), a * (3.1 * r).sin()];
                let [x, y] = [1.1 * a, a + 0.3 * b];
                let start = [x, y, x + arm[0], y + arm[1]];
                let rates = [s, 0.0, s - 2.0 * r * arm[1], 2.0 * r * arm[0]];
                add!(Dumbbell::new(a, e, f, 5.0 * b), start, rates, 8.0, None);
            }
            _ => {
                let [x, y] = [(0.5 + 0.9 * a).sin(), (0.5 + 0.9 * a).cos()];
                let start = [x, y, x + (0.5 + 0.9 * b).sin(), y + (0.5 + 0.9 * b).cos()];
                add!(Rods::new(0.6 + 0.3 * a, e, f), start, [0.0; 4], 10.0, None);
            }
        }
    }
    worst
}

fn contacts(scale: Scale, report: &mut Report) {
    let count = scale.pick(20, 60, 600);
    for kind in ["plates", "boxes", "lines", "stacks", "rods", "dumbbells"] {
        let mut random = Random::new(29);
        for (scalar, single) in [("f64", false), ("f32", true)] {
            let worst = family(kind, &mut random, count, single);
            let mut rows = vec![
                ("runs that fail", worst.failed as f64, 0.0),
                ("impacts that add energy", worst.wrong as f64, 0.0),
                ("growth of the energy, in tolerances", worst.growth, 10.0),
                ("depth below a limit, in tolerances", worst.depth, 10.0),
            ];
            if worst.unrest != 0.0 {
                rows.push(("distance from rest, in tolerances", worst.unrest, 10.0));
            }
            for (name, measured, bar) in rows {
                report.row(format!("{count} {kind} in {scalar}: {name}")).at_most(measured, bar);
            }
        }
    }
}
