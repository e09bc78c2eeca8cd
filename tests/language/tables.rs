//! Tables: motions beside piecewise closed forms, knots, ends, derivatives.

use pendulum_runtime::ensemble::Ensemble;
use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::Failure;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{Dual, Lanes, Real};
use pendulum_runtime::system::System;
use systems::random::Random;

/// A spring that is stiff at its ends, pulls more to one side, and has almost no force between.
const SPRING: [[f64; 2]; 9] = [
    [-1.0, -9.0],
    [-0.75, -4.0],
    [-0.5, -2.5],
    [-0.25, -0.25],
    [0.0, 0.125],
    [0.375, 0.25],
    [0.5, 2.0],
    [0.8, 3.5],
    [1.0, 12.0],
];

lagrangian! {
    /// A block on the spring.
    #[derive(Clone, Copy, Debug)]
    pub struct Block { m: kg }
    coordinate x: m;
    table f(x: m): N = [
        (-1, -9), (-0.75, -4), (-1/2, -2.5), (-1/4, -0.25), (0, 0.125), (0.375, 0.25), (0.5, 2),
        (0.8, 3.5), (1, 12),
    ], outside = linear;
    kinetic = m/2*ẋ^2;
    force x = -f(x);
    output push: N = f(x);
    output stiffness: N/m = dot(f(x))/ẋ;
}

lagrangian! {
    /// The same spring as the potential of a bob on a rod, which moves its argument.
    #[derive(Clone, Copy, Debug)]
    pub struct Bob { m: kg, L: m, b: 1, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    coordinate s: m;
    table E(x: m): J = [(-1, 3), (-0.5, 1), (0, 0.25), (0.25, 0.3), (0.75, 2), (1, 5)], outside = linear;
    let p = [s + L*sin(θ), -L*cos(θ)];
    kinetic = m/2*|ṗ|^2 + m/2*ṡ^2*(1 + E(s)/(m*g*L))^2;
    potential = m*g*p.y + E(p.x) + E(s)/2;
    dissipation = b*sqrt(g/L)*E(s/2)/(g*L)*ṡ^2;
}

lagrangian! {
    /// A body on a spring that a table describes up to 1 m.
    #[derive(Clone, Debug)]
    pub struct Spring { a: 1 }
    coordinate x: m;
    table pull(x: m): m/s^2 = [(-2, 8), (-1, 4), (0, 0), (1, -4)], outside = refused;
    kinetic = ẋ^2/2;
    force x = a*pull(x);
}

lagrangian! {
    /// A block that moves freely up to the end of a table.
    #[derive(Clone, Copy, Debug)]
    pub struct Edge { m: kg, u: N }
    coordinate x: m;
    table soft(x: m): 1 = [(-1, 0), (0, 0), (2, 0)], outside = refused;
    kinetic = m/2*ẋ^2;
    force x = u*soft(2*x);
}

lagrangian! {
    /// A block that is pushed for a hundredth of a second after a long rest.
    #[derive(Clone, Copy, Debug)]
    pub struct Pushed { m: kg }
    coordinate x: m;
    table push(t: s): N = [(0, 0), (50, 0), (50.01, 100), (50.02, 100), (50.03, 0), (100, 0)], outside = linear;
    kinetic = m/2*ẋ^2;
    force x = push(t);
}

/// The natural cubic spline through some points: its second derivatives solve a dense system.
struct Dense {
    points: Vec<[f64; 2]>,
    curvature: Vec<f64>,
}

impl Dense {
    fn new(points: &[[f64; 2]]) -> Self {
        let n = points.len();
        let mut rows = vec![vec![0.0; n + 1]; n];
        (rows[0][0], rows[n - 1][n - 1]) = (1.0, 1.0);
        for k in 1..n - 1 {
            let [[a, ya], [b, yb], [c, yc]] = [points[k - 1], points[k], points[k + 1]];
            rows[k][k - 1] = (b - a) / 6.0;
            rows[k][k] = (c - a) / 3.0;
            rows[k][k + 1] = (c - b) / 6.0;
            rows[k][n] = (yc - yb) / (c - b) - (yb - ya) / (b - a);
        }
        for pivot in 0..n {
            for row in (0..n).filter(|&row| row != pivot) {
                let factor = rows[row][pivot] / rows[pivot][pivot];
                for column in 0..=n {
                    rows[row][column] -= factor * rows[pivot][column];
                }
            }
        }
        let curvature = (0..n).map(|k| rows[k][n] / rows[k][k]).collect();
        Self { points: points.to_vec(), curvature }
    }

    fn value(&self, x: f64) -> f64 {
        let last = self.points.len() - 2;
        let k = (0..last).rev().find(|&k| self.points[k][0] <= x).unwrap_or(0);
        let k = if self.points[last][0] <= x { last } else { k };
        let [[a, ya], [b, yb]] = [self.points[k], self.points[k + 1]];
        let (h, before, after) = (b - a, (b - x) / (b - a), (x - a) / (b - a));
        let bent = |share: f64, curvature: f64| (share.powi(3) - share) * curvature * h * h / 6.0;
        before * ya
            + after * yb
            + bent(before, self.curvature[k])
            + bent(after, self.curvature[k + 1])
    }

    /// Integrates a function from `a` to `b`, piece by piece, by the rule of Gauss with five nodes
    /// on many parts.
    fn integral(&self, [a, b]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
        const NODES: [[f64; 2]; 5] = [
            [0.0, 0.568888888888888888889],
            [-0.538469310105683091036, 0.478628670499366468041],
            [0.538469310105683091036, 0.478628670499366468041],
            [-0.906179845938663992798, 0.236926885056189087514],
            [0.906179845938663992798, 0.236926885056189087514],
        ];
        let inner = self.points.iter().map(|point| point[0]).filter(|&x| a < x && x < b);
        let bounds: Vec<f64> = [a].into_iter().chain(inner).chain([b]).collect();
        let part = |low: f64, high: f64| -> f64 {
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            NODES.iter().map(|[x, weight]| half * weight * f(middle + half * x)).sum()
        };
        let parts = 64;
        bounds
            .windows(2)
            .flat_map(|pair| (0..parts).map(move |k| (pair, k)))
            .map(|(pair, k)| {
                let at = |k: i32| pair[0] + (pair[1] - pair[0]) * f64::from(k) / f64::from(parts);
                part(at(k), at(k + 1))
            })
            .sum()
    }
}

fn at<'a, T: Real, const N: usize>(q: &'a [T; N], v: &'a [T; N]) -> At<'a, T, (), N> {
    At { t: T::from_f64(0.0), q, v, inputs: &() }
}

#[test]
fn a_table_is_the_natural_spline_through_its_points() {
    let (block, spline) = (Block::new(2.0), Dense::new(&SPRING));
    let push = |x: f64| -2.0 * block.accelerations(at(&[x], &[0.0]))[0];
    for [x, y] in SPRING {
        assert!((push(x) - y).abs() < 1e-15 * (1.0 + y.abs()), "{x}");
    }
    for k in 0..=400 {
        let x = -1.0 + f64::from(k) / 200.0;
        assert!((push(x) - spline.value(x)).abs() < 1e-14 * 12.0, "{x}");
    }
}

#[test]
fn a_table_goes_on_along_its_tangents() {
    let (block, spline) = (Block::new(1.0), Dense::new(&SPRING));
    let push = |x: f64| -block.accelerations(at(&[x], &[0.0]))[0];
    for (end, sign) in [(-1.0, -1.0), (1.0, 1.0)] {
        // The second derivative is zero at the ends.
        let h = 1e-4;
        let slope = (spline.value(end) - spline.value(end - sign * h)) / (sign * h);
        for beyond in [0.5, 3.0, 1e6] {
            let line = spline.value(end) + sign * beyond * slope;
            assert!((push(end + sign * beyond) - line).abs() < 1e-5 * beyond.max(1.0) * 10.0);
        }
    }
}

/// The time from one place to another is an integral over the energy, and where the block is after
/// this time is the other place.
#[test]
fn a_block_on_a_tabulated_spring_is_where_its_energy_says() {
    let (mass, start, end, speed, spline) = (0.5, -0.9, 0.95, 5.0, Dense::new(&SPRING));
    let velocity = |x: f64| {
        let work = spline.integral([start, x], |x| spline.value(x));
        (speed * speed - 2.0 / mass * work).sqrt()
    };
    let time = spline.integral([start, end], |x| 1.0 / velocity(x));
    let check = |name: &str, run: Result<Solution<f64, 1>, Failure<f64, 1>>| {
        let State { q, v, .. } = run.unwrap().end;
        let errors = [q[0] - end, v[0] - velocity(end)];
        assert!(errors.iter().all(|error| error.abs() < 1e-10), "{name}: {errors:?}");
    };
    let block = Block::new(mass);
    let problem = || solve(&block, (0.0, time), [start], [speed]).rtol(1e-12);
    check("Picard", problem().method(Picard).run());
    check("Dop853", problem().method(Dop853).run());
    check("Auto", problem().run());
    check("Taylor", problem().method(Taylor::new()).run());
}

/// The starts are points of the table, where a series has the third derivative of one side.
#[test]
fn a_motion_may_start_at_a_point_of_the_table() {
    let (mass, end, spline) = (1.0, 0.2, Dense::new(&SPRING));
    for start in [-0.25, 0.0] {
        let speed = 1.0;
        let velocity = |x: f64| {
            let work = spline.integral([start, x], |x| spline.value(x));
            f64::sqrt(speed * speed - 2.0 / mass * work)
        };
        let time = spline.integral([start, end], |x| 1.0 / velocity(x));
        let block = Block::new(mass);
        let problem = || solve(&block, (0.0, time), [start], [speed]).rtol(1e-12);
        let ends = [
            problem().method(Picard).run(),
            problem().method(Dop853).run(),
            problem().method(Taylor::new()).run(),
        ];
        let errors = ends.map(|run| run.unwrap().end.q[0] - end);
        assert!(errors.iter().all(|error| error.abs() < 1e-10), "{start}: {errors:?}");
    }
}

#[test]
fn energy_is_kept_over_many_knots() {
    let bob = Bob::new(0.7, 0.6, 0.0);
    let (q, v) = ([1.2, 0.1], [0.0, 2.0]);
    let energy = bob.energy(at(&q, &v));
    for run in [
        solve(&bob, (0.0, 30.0), q, v).rtol(1e-11).run().unwrap(),
        solve(&bob, (0.0, 30.0), q, v).rtol(1e-11).method(Dop853).run().unwrap(),
    ] {
        let change = bob.energy(at(&run.end.q, &run.end.v)) - energy;
        assert!(change.abs() < 1e-8 * energy.abs(), "{change}");
        assert!(run.stats.accepted < 3000, "{:?}", run.stats);
    }
}

#[test]
fn jacobians_are_those_of_dual_numbers() {
    let bob = Bob::new(0.7, 0.6, 0.1);
    for (q, v) in [([0.3, 0.4], [1.0, -2.0]), ([-1.0, 1.7], [0.1, 3.0]), ([2.0, -0.6], [0.0, 1.0])]
    {
        let dual = bob.map(Dual::constant);
        let jacobian = bob.position_jacobian(at(&q, &v));
        for column in 0..2 {
            let mut moved = q.map(Dual::constant);
            moved[column] = Dual::variable(q[column]);
            let slopes = dual.accelerations(at(&moved, &v.map(Dual::constant)));
            for row in 0..2 {
                let (found, expected) = (jacobian[(row, column)], slopes[row].derivative);
                assert!((found - expected).abs() < 1e-11 * (1.0 + expected.abs()));
                // Central differences do not know the rules of derivatives.
                let h = 1e-5;
                let [low, high] = [-h, h].map(|h| {
                    let mut moved = q;
                    moved[column] += h;
                    bob.accelerations(at(&moved, &v))[row]
                });
                let slope = (high - low) / (2.0 * h);
                assert!((found - slope).abs() < 1e-6 * (1.0 + found.abs()), "{found} {slope}");
            }
        }
    }
}

#[test]
fn lanes_have_the_bits_of_single_systems() {
    let bob = Bob::new(0.7, 0.6, 0.1);
    let lanes = bob.map(|x| Lanes([x; 8]));
    let starts: [[f64; 4]; 8] = core::array::from_fn(|k| {
        [0.0, 1.0, 2.0, 3.0].map(|j| (k as f64 * 0.7 + j * 1.3).sin() * 2.0)
    });
    let lane = |part: usize| Lanes(starts.map(|start| start[part]));
    let all = lanes.accelerations(at(&[lane(0), lane(1)], &[lane(2), lane(3)]));
    for (k, [a, b, c, d]) in starts.into_iter().enumerate() {
        let single = bob.accelerations(at(&[a, b], &[c, d]));
        assert_eq!(all.map(|lane| lane.0[k].to_bits()), single.map(f64::to_bits));
    }
}

fn block(k: usize) -> Problem<Block, 1> {
    let k = k as f64;
    let (time, q, v) = ((0.0, 2.0 + 0.3 * k), [-0.9 + 0.05 * k], [5.0 - k]);
    Problem { system: Block::new(0.5 + 0.1 * k), time, q, v }
}

#[test]
fn members_of_an_ensemble_have_the_bits_of_single_motions() {
    let end = |_: usize, solution: &Solution<f64, 1>| solution.end;
    let ends = Ensemble::new(0..12, block).rtol(1e-10).map(end).collect().unwrap();
    for (k, end) in ends.value.into_iter().enumerate() {
        let Problem { system, time, q, v } = block(k);
        assert_eq!(end, Some(solve(&system, time, q, v).rtol(1e-10).run().unwrap().end));
    }
}

/// The lanes of a batch do not look for switches. They compare accelerations with those of the
/// series, which leaves a part of the tolerance at a knot.
#[test]
fn a_batch_follows_single_motions_within_the_tolerance() {
    let problems: Vec<Problem<Block, 1>> = (0..12).map(block).collect();
    let runs = Batch::new().rtol(1e-10).run(&problems).unwrap();
    for (Problem { system, time, q, v }, run) in problems.iter().zip(runs) {
        let alone = solve(system, *time, *q, *v).method(Taylor::new()).rtol(1e-10).run();
        let apart = run.unwrap().end.q[0] - alone.unwrap().end.q[0];
        assert!(apart.abs() < 1e-8, "{apart}");
    }
}

#[test]
fn single_precision_follows_double_precision() {
    let double = solve(&Block::new(0.5), (0.0, 0.5), [-0.9], [5.0]).run().unwrap();
    let single = solve(&Block::new(0.5_f32), (0.0, 0.5), [-0.9], [5.0]).run().unwrap();
    assert!((f64::from(single.end.q[0]) - double.end.q[0]).abs() < 1e-4);
}

#[test]
fn outputs_contain_tables_and_their_slopes() {
    let (block, spline) = (Block::new(2.0), Dense::new(&SPRING));
    let (x, h) = (0.3, 1e-5);
    let slope = (spline.value(x + h) - spline.value(x - h)) / (2.0 * h);
    let [push, stiffness] = [block.push(0.0, &[x], &[0.7]), block.stiffness(0.0, &[x], &[0.7])];
    assert!((push - spline.value(x)).abs() < 1e-14 && (stiffness - slope).abs() < 1e-7);
}

/// Eleven steps would pass the push without a sample in it.
#[test]
fn a_short_push_after_a_long_rest_is_not_missed() {
    let points =
        [[0.0, 0.0], [50.0, 0.0], [50.01, 100.0], [50.02, 100.0], [50.03, 0.0], [100.0, 0.0]];
    let spline = Dense::new(&points);
    let expected = spline.integral([0.0, 100.0], |t| spline.value(t)) / 2.0;
    let block = Pushed::new(2.0);
    let problem = || solve(&block, (0.0, 100.0), [0.0], [0.0]).rtol(1e-10);
    for run in [problem().run(), problem().method(Picard).run(), problem().method(Dop853).run()] {
        let run = run.unwrap();
        assert!((run.end.v[0] - expected).abs() < 1e-7 * expected.abs().max(1.0));
    }
}

#[test]
fn a_refused_table_ends_the_run_at_its_end() {
    let edge = Edge::new(1.0, 1.0);
    let problem = || solve(&edge, (0.0, 10.0), [0.0], [0.5]).rtol(1e-9);
    let runs = [
        problem().run(),
        problem().method(Picard).run(),
        problem().method(Dop853).run(),
        problem().method(Taylor::new()).run(),
        solve(&edge, (0.0, 10.0), [0.0], [0.5]).method(Rk4).step(0.01).run(),
    ];
    for run in runs {
        let error = run.unwrap_err().error;
        let Error::Table { t, name, argument, ends } = error else { panic!("{error}") };
        assert_eq!((name, ends), ("soft", [-1.0, 2.0]));
        assert!((t - 2.0).abs() < 0.011 && (argument - 2.0).abs() < 0.011, "{t} {argument}");
    }
}

#[test]
fn a_refused_table_refuses_a_start_beyond_it() {
    let edge = Edge::new(1.0, 1.0);
    let error = solve(&edge, (0.0, 10.0), [1.5], [0.0]).run().unwrap_err().error;
    let expected = Error::Table { t: 0.0, name: "soft", argument: 3.0, ends: [-1.0, 2.0] };
    assert_eq!(error, expected);
    let message = "at t = 0.0 the argument 3.0 of the table `soft` leaves its points, from -1.0 to 2.0; \
                   add points, or let it go on along its tangents by `outside = linear` or \
                   `Table::linear`";
    assert_eq!(error.to_string(), message);
}

/// A body on a spring, whose force is a table that ends at 1 m, turns a little behind its end.
#[test]
fn a_refused_table_refuses_a_short_visit_beyond_it() {
    let spring = Spring { a: 1.0 };
    let mut random = Random::new(5);
    for _ in 0..40 {
        let (beyond, start) = (10f64.powf(random.uniform(-7.0, -2.0)), random.uniform(0.2, 3.0));
        let far = 1.0 + beyond;
        let (q, v) = ([far * start.cos()], [2.0 * far * start.sin()]);
        let turns = 0.5 * start;
        macro_rules! check {
            ($($method:expr),*) => {$(
                let run = solve(&spring, (0.0, 3.0), q, v).method($method).rtol(1e-9).atol(1e-9);
                let error = run.run().unwrap_err().error;
                let Error::Table { t, argument, .. } = error else { panic!("{error}") };
                assert!((t - turns).abs() < 2.0 * beyond.sqrt(), "{beyond} {start}: {t}");
                assert!((argument - 1.0).abs() < 1e-5, "{beyond} {start}: {argument}");
            )*};
        }
        check!(Auto, Dop853, Picard, Taylor::new());
    }
}

#[test]
fn a_motion_may_touch_the_end_of_a_refused_table() {
    let edge = Edge::new(1.0, 1.0);
    let run = solve(&edge, (0.0, 2.0), [0.0], [0.5]).rtol(1e-9).run().unwrap();
    assert!((run.end.q[0] - 1.0).abs() < 1e-15);
}
