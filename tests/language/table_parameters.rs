//! Tables among the parameters: they do what tables of the block with the same points do, in all
//! methods, and nothing shares the points of others.

use pendulum_runtime::analysis::Variational;
use pendulum_runtime::ensemble::Ensemble;
use pendulum_runtime::error::Error;
use pendulum_runtime::motion::Still;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{Dual, Lanes};
use pendulum_runtime::scene::{Scene, SceneError};
use pendulum_runtime::system::tables;

lagrangian! {
    /// A block between two springs, pushed as time goes by.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Given { m: kg, f: table(m): N, b: kg/s = 0, L: m = 1, push: table(s): N }
    coordinate x: m;
    kinetic = m/2*ẋ^2;
    dissipation = b/2*ẋ^2*(2 + f(L/4)/f(L));
    force x = -f(x) + push(t);
    output pull: N = f(x);
    output stiffness: N/m = dot(f(x))/ẋ;
}

lagrangian! {
    /// The same system with its points in the block.
    #[derive(Clone, Copy, Debug)]
    pub struct Written { m: kg, b: kg/s = 0, L: m = 1 }
    coordinate x: m;
    table f(x: m): N = [(-1, -9), (-0.5, -2.5), (0, 0.125), (0.375, 0.25), (0.8, 3.5), (1, 12)], outside = linear;
    table push(t: s): N = [(0, 0), (1, 2), (1.5, -1), (4, 0)], outside = linear;
    kinetic = m/2*ẋ^2;
    dissipation = b/2*ẋ^2*(2 + f(L/4)/f(L));
    force x = -f(x) + push(t);
    output pull: N = f(x);
    output stiffness: N/m = dot(f(x))/ẋ;
}

lagrangian! {
    /// A bob on a joint whose rod rubs by a table of its speed; a table in the kinetic energy.
    #[derive(Clone, Debug)]
    pub struct Bob { L: m, drag: table(rad/s): N*m, mass: table(rad): kg, g: m/s^2 = 9.81 }
    driven x: [m; 2];
    coordinate θ: rad;
    let p = x + L*[sin(θ), -cos(θ)];
    kinetic = mass(θ)/2*|ṗ|^2;
    potential = mass(θ)*g*p.y;
    force θ = -drag(θ̇);
}

lagrangian! {
    /// A block that moves freely up to the end of a table.
    #[derive(Clone, Debug)]
    pub struct Edge { m: kg, u: N, soft: table(m): 1 }
    coordinate x: m;
    kinetic = m/2*ẋ^2;
    force x = u*soft(2*x);
}

lagrangian! {
    /// A table alone.
    #[derive(Clone, Debug)]
    pub struct Only { f: table(m): m/s^2 }
    coordinate x: m;
    lagrangian = ẋ^2/2 + f(x)*x;
}

fn spring() -> Table {
    let points = [(-1.0, -9.0), (-0.5, -2.5), (0.0, 0.125), (0.375, 0.25), (0.8, 3.5), (1.0, 12.0)];
    Table::new(&points).unwrap().linear()
}

fn push() -> Table {
    Table::new(&[(0.0, 0.0), (1.0, 2.0), (1.5, -1.0), (4.0, 0.0)]).unwrap().linear()
}

fn line(slope: f64) -> Table {
    Table::new(&[(-1.0, -slope), (0.0, 0.0), (1.0, slope)]).unwrap().linear()
}

fn at<'a, T: pendulum_runtime::scalar::Real, const N: usize>(
    t: f64,
    q: &'a [T; N],
    v: &'a [T; N],
) -> At<'a, T, (), N> {
    At { t: T::from_f64(t), q, v, inputs: &() }
}

#[test]
fn a_table_parameter_does_what_a_table_of_the_block_does() {
    let (given, written) = (Given::new(0.5, spring(), push()), Written::new(0.5));
    for k in 0..200 {
        let (q, v, t) = ([-1.5 + 0.015 * f64::from(k)], [0.7], 0.05 * f64::from(k));
        let [own, other] =
            [given.accelerations(at(t, &q, &v))[0], written.accelerations(at(t, &q, &v))[0]];
        assert!((own - other).abs() < 1e-12 * (1.0 + other.abs()), "{q:?}: {own} {other}");
        let [own, other] = [given.stiffness(t, &q, &v), written.stiffness(t, &q, &v)];
        assert!((own - other).abs() < 1e-11 * (1.0 + other.abs()), "{q:?}: {own} {other}");
    }
    let (given, written) = (Given { b: 0.3, ..given }, Written { b: 0.3, ..written });
    macro_rules! compare {
        ($method:expr) => {
            let own = solve(&given, (0.0, 6.0), [-0.9], [3.0]).rtol(1e-11).method($method).run();
            let other =
                solve(&written, (0.0, 6.0), [-0.9], [3.0]).rtol(1e-11).method($method).run();
            let (own, other) = (own.unwrap(), other.unwrap());
            let apart = (own.end.q[0] - other.end.q[0]).abs();
            assert!(apart < 1e-8, "{}: {apart}", stringify!($method));
            assert!(own.stats.accepted < 2 * other.stats.accepted + 50, "{:?}", own.stats);
        };
    }
    compare!(Picard);
    compare!(Dop853);
    compare!(Taylor::new());
    compare!(Rodas4);
}

#[test]
fn a_table_of_the_state_is_known_to_jacobians_and_lanes() {
    let given = Given { b: 0.3, ..Given::new(0.5, spring(), push()) };
    let lanes = given.map(|x| Lanes([x; 8]));
    let starts: [f64; 8] = core::array::from_fn(|k| -1.2 + 0.31 * k as f64);
    let all = lanes.accelerations(at(0.4, &[Lanes(starts)], &[Lanes([1.0; 8])]));
    for (k, x) in starts.into_iter().enumerate() {
        let single = given.accelerations(at(0.4, &[x], &[1.0]))[0];
        assert_eq!(all[0].0[k].to_bits(), single.to_bits());
        let dual = given.map(Dual::constant);
        let slope = dual.accelerations(at(0.4, &[Dual::variable(x)], &[Dual::constant(1.0)]))[0];
        let jacobian = given.position_jacobian(at(0.4, &[x], &[1.0]))[(0, 0)];
        assert!((slope.derivative - jacobian).abs() < 1e-12 * (1.0 + jacobian.abs()));
    }
}

/// f(x) = −k x is a table of two points, and the swing of a block on it a cosine.
#[test]
fn straight_tables_are_springs() {
    let rest = Table::new(&[(0.0, 0.0), (1.0, 0.0)]).unwrap().linear();
    for k in [1.0, 4.0, 90.0] {
        let block = Given::new(1.0, line(k), rest.clone());
        let run = solve(&block, (0.0, 2.0), [0.7], [0.0]).rtol(1e-11).run().unwrap();
        let expected = 0.7 * (2.0 * f64::sqrt(k)).cos();
        assert!((run.end.q[0] - expected).abs() < 1e-9);
    }
}

/// L = ẋ²/2 − k x² with the table f(x) = −k x.
#[test]
fn a_table_may_be_the_only_parameter() {
    let run = solve(&Only::new(line(-8.0)), (0.0, 2.0), [0.5], [0.0]).rtol(1e-11).run().unwrap();
    assert!((run.end.q[0] - 0.5 * f64::cos(8.0)).abs() < 1e-9);
    let run = solve(&Only::<f32>::new(line(-8.0)), (0.0, 2.0), [0.5], [0.0]).run().unwrap();
    assert!((run.end.q[0] - 0.5 * f32::cos(8.0)).abs() < 1e-4);
}

#[test]
fn a_table_parameter_ends_with_its_points() {
    let zero = Table::new(&[(-1.0, 0.0), (0.0, 0.0), (2.0, 0.0)]).unwrap();
    let edge = Edge::new(1.0, 1.0, zero.clone());
    let problem = |method: usize| {
        let problem = solve(&edge, (0.0, 10.0), [0.0], [0.5]).rtol(1e-9);
        match method {
            0 => problem.run(),
            1 => problem.method(Dop853).run(),
            _ => problem.method(Taylor::new()).run(),
        }
    };
    for method in 0..3 {
        let error = problem(method).unwrap_err().error;
        let Error::Table { t, name, argument, ends } = error else { panic!("{error}") };
        assert_eq!((name, ends), ("soft", [-1.0, 2.0]));
        assert!((t - 2.0).abs() < 0.01 && (argument - 2.0).abs() < 0.01, "{t} {argument}");
    }
    let on = Edge::new(1.0, 1.0, zero.linear());
    let run = solve(&on, (0.0, 10.0), [0.0], [0.5]).rtol(1e-9).run().unwrap();
    assert!((run.end.q[0] - 5.0).abs() < 1e-9);
}

#[test]
fn members_of_an_ensemble_have_their_own_tables() {
    let member = |k: usize| Problem {
        system: Given::new(1.0, line(1.0 + k as f64), push()),
        time: (0.0, 3.0),
        q: [0.5],
        v: [0.0],
    };
    let end = |_: usize, solution: &Solution<f64, 1>| solution.end;
    let ends = Ensemble::new(0..12, member).rtol(1e-10).map(end).collect().unwrap();
    for (k, end) in ends.value.into_iter().enumerate() {
        let Problem { system, time, q, v } = member(k);
        assert_eq!(end, Some(solve(&system, time, q, v).rtol(1e-10).run().unwrap().end));
    }
}

#[test]
fn a_batch_takes_one_table_and_refuses_others() {
    let member = |k: usize, table: Table| Problem {
        system: Given::new(1.0 + 0.1 * k as f64, table, push()),
        time: (0.0, 3.0),
        q: [0.5],
        v: [0.0],
    };
    let mut problems: Vec<_> = (0..20).map(|k| member(k, spring())).collect();
    problems[7] = member(7, line(3.0));
    let runs = Batch::new().rtol(1e-10).run(&problems).unwrap();
    for (k, (run, Problem { system, time, q, v })) in runs.into_iter().zip(&problems).enumerate() {
        if k == 7 {
            assert_eq!(run.unwrap_err().error, Error::OtherTables);
            continue;
        }
        let alone = solve(system, *time, *q, *v).method(Taylor::new()).rtol(1e-10).run().unwrap();
        assert!((run.unwrap().end.q[0] - alone.end.q[0]).abs() < 1e-8);
    }
}

#[test]
fn a_scene_takes_one_table_and_refuses_others() {
    let table = |points: &[(f64, f64)]| Table::new(points).unwrap().linear();
    let drag = || table(&[(-5.0, -0.5), (0.0, 0.0), (5.0, 0.5)]);
    let mass = || table(&[(-1.0, 1.0), (0.0, 1.2), (1.0, 1.1)]);
    let mut scene = Scene::new(240.0).unwrap();
    let joint = scene.joint(Still::new([0.0, 0.0]));
    let first = scene.hang(joint, Bob::new(0.5, drag(), mass()), [0.8], [0.0]).unwrap();
    scene.hang(joint, Bob::new(0.7, drag(), mass()), [0.8], [0.0]).unwrap();
    let error = scene.hang(joint, Bob::new(0.5, line(1.0), mass()), [0.8], [0.0]).unwrap_err();
    assert_eq!(error, SceneError::Tables { kind: "Bob" });
    scene.advance_ticks(240);
    let bob = Bob::new(0.5, drag(), mass()).driven_by(Still::new([0.0, 0.0]));
    let run = solve(&bob, (0.0, 1.0), [0.8], [0.0]).rtol(1e-10).run().unwrap();
    let (q, _) = scene.state(first);
    assert!((q[0] - run.end.q[0]).abs() < 2e-3, "{} {}", q[0], run.end.q[0]);
}

#[test]
fn columns_of_sensitivities_pass_through_tables() {
    let end = |m: f64| {
        let block = Given { m, ..Given::new(0.5, spring(), push()) };
        solve(&block, (0.0, 2.0), [-0.9], [3.0]).rtol(1e-12).run().unwrap().end.q[0]
    };
    let block = Given::new(0.5, spring(), push());
    let run = solve(&block, (0.0, 2.0), [-0.9], [3.0]).rtol(1e-12).dense().run().unwrap();
    let [columns] = run.sensitivities(&block, ["m"]).unwrap();
    let slope = (end(0.5 + 1e-5) - end(0.5 - 1e-5)) / 2e-5;
    let found = columns.last().unwrap().q[0];
    assert!((found - slope).abs() < 1e-6 * (1.0 + slope.abs()), "{found} {slope}");
}

#[test]
fn single_precision_takes_the_same_table() {
    let double = solve(&Given::new(0.5, spring(), push()), (0.0, 1.0), [-0.9], [3.0]).run();
    let single = solve(&Given::new(0.5_f32, spring(), push()), (0.0, 1.0), [-0.9], [3.0]).run();
    let apart = f64::from(single.unwrap().end.q[0]) - double.unwrap().end.q[0];
    assert!(apart.abs() < 1e-4, "{apart}");
}

/// Forces grow with the scale as lengths do: newtons contain one metre.
#[test]
fn tables_change_by_the_metres_in_their_units() {
    let end = |block: Given, scale: f64| {
        let run = solve(&block, (0.0, 2.0), [-0.9 * scale], [3.0 * scale]).method(Rk4).steps(300);
        run.run().unwrap().end.q[0] / scale
    };
    let small = || Given::new(0.5, spring(), push());
    let here = end(small(), 1.0);
    for scale in [0.25, 4.0, 1.7] {
        let off = (end(small().resized(scale).unwrap(), scale) - here).abs();
        // Powers of two change exponents only.
        assert!(if scale == 1.7 { off < 1e-13 } else { off == 0.0 }, "{scale}: {off:e}");
    }
    assert!(1e-3 < (end(small(), 4.0) - here).abs(), "the size matters");
    let Given { f, push: own, .. } = small().resized(4.0).unwrap();
    let forces = Table::new(&[(0.0, 0.0), (1.0, 8.0), (1.5, -4.0), (4.0, 0.0)]);
    assert_eq!(own, forces.unwrap().linear());
    assert_ne!(f, spring());
    let error = small().resized(1e-200).unwrap_err();
    assert!(matches!(error, Error::Setting { .. }), "{error}");
    let with_columns = Variational::<_, 1, 3>::new(small()).resized(4.0).unwrap();
    assert_eq!(tables(&with_columns), [f, own]);
}

#[test]
fn points_that_make_no_table_are_refused() {
    let refusal = |points: &[(f64, f64)]| Table::new(points).unwrap_err().to_string();
    assert_eq!(refusal(&[(1.0, 2.0)]), "`number of points` is 1.0, but has to be from 2 to 256");
    assert_eq!(
        refusal(&[(0.0, 1.0), (f64::NAN, 1.0)]),
        "`number of a point` is NaN, but has to be finite"
    );
    let expected = "`argument of a point` is 0.0, but has to be greater than that of the point \
                    before it; sort the points";
    assert_eq!(refusal(&[(0.0, 1.0), (0.0, 2.0)]), expected);
    assert!(refusal(&[(0.0, 1e300), (1e-300, -1e300)]).contains("choose other units"));
    let many: Vec<(f64, f64)> = (0..257).map(|k| (f64::from(k), 0.0)).collect();
    assert!(refusal(&many).contains("257"));
    assert!(Table::new(&many[..256]).is_ok());
}

#[test]
fn tables_are_equal_if_their_points_and_ends_are() {
    let points = [(0.0, 1.0), (1.0, 2.0), (2.0, 1.0)];
    let own = Table::new(&points).unwrap();
    assert_eq!(own, Table::new(&points).unwrap());
    assert_ne!(own, own.clone().linear());
    assert_ne!(own, line(1.0));
}
