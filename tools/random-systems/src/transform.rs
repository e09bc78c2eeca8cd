//! Equivalent forms of a system: a gauge term, another scale of energy, other coordinates, time
//! reversal.

use super::generate;
use super::nilpotent::Function;
use super::reference::State;
use super::tree::{
    Coordinate, Expr, Index, Kind, Let, Operation, Shape, System, Type, call, number, product,
    quotient, sum,
};
use systems::random::Random;

/// Returns the system with L + dF/dt for a random F(q, t).
pub fn gauged(system: &System) -> System {
    let mut gauged = system.clone();
    let term = generate::gauge(system, &mut Random(system.seed ^ 0xf0));
    let rate = Operation::Dot.of([term]);
    let rate =
        if system.units { quotient(rate, generate::measure(system, Kind::Rate)) } else { rate };
    gauged.kinetic.push(rate);
    gauged
}

/// The factor of [`scaled`].
pub const SCALE: f64 = 0.75;

/// Returns the system with energies and forces multiplied by [`SCALE`].
pub fn scaled(system: &System) -> System {
    let mut scaled = system.clone();
    for expr in scaled.terms() {
        *expr = product(Expr::Number(3, 4), expr.clone());
    }
    scaled
}

/// Returns the time-reversed system: L(−t, q, −q̇), −R(−q̇), forces as functions of −t and −q̇, and
/// reversed driven inputs.
pub fn reversed(system: &System) -> System {
    let mut reversed = system.clone();
    let turn = |expr: &mut Expr| {
        // A quantity with an odd number of time derivatives changes its sign.
        if let Expr::Time
        | Expr::Velocity(..)
        | Expr::Input(_, 1)
        | Expr::Of(Operation::Dot, _)
        | Expr::LetDot(_) = expr
        {
            *expr = Expr::Negative(Box::new(expr.clone()));
        }
    };
    for definition in &mut reversed.lets {
        definition.expr.each(&turn);
    }
    reversed.terms().for_each(|expr| expr.each(&turn));
    for expr in &mut reversed.dissipation {
        *expr = Expr::Negative(Box::new(expr.clone()));
    }
    reversed
}

/// Returns the state of [`reversed`] that corresponds to `state`.
pub fn turned(state: &State<f64>) -> State<f64> {
    let mut turned = state.clone();
    turned.t = -state.t;
    for v in &mut turned.v {
        *v = -*v;
    }
    for [_, velocity, _, jerk] in turned.inputs.iter_mut().flatten() {
        (*velocity, *jerk) = (-*velocity, -*jerk);
    }
    turned
}

/// Returns the system without its forces in coordinates Q with q = Q + sin(Q₁)/3, where Q₁ is the
/// first scalar of the coordinates declared next.
pub fn moved(system: &System) -> System {
    let mut moved = system.clone();
    moved.forces.clear();
    let count = system.coordinates.len();
    for coordinate in &mut moved.coordinates {
        coordinate.name = format!("{}1", coordinate.name);
    }
    let old = |index: usize, bound: Option<Index>| Expr::Coordinate(index, bound);
    moved.lets = (0..count)
        .map(|index| {
            let Coordinate { name, length } = &system.coordinates[index];
            let next = (index + 1) % count;
            let first = old(next, system.coordinates[next].length.map(|_| Index::Number(0)));
            let bend = quotient(call(Function::Sin, first), number(3));
            let expr = sum(old(index, length.map(|_| Index::Bound(0))), bend);
            let shape = length.map_or(Shape::Plain, Shape::Indexed);
            Let { name: name.clone(), shape, kind: Type::Scalar, expr }
        })
        .collect();
    let replace = |expr: &mut Expr| replaced(expr, count);
    moved.lets.extend(system.lets.iter().cloned().map(|mut definition| {
        definition.expr.each(&replace);
        definition
    }));
    moved.terms().for_each(|expr| expr.each(&replace));
    moved
}

/// Returns the old coordinates, velocities and accelerations from those of [`moved`].
pub fn back(system: &System, [q, v, a]: [&[f64]; 3]) -> [Vec<f64>; 3] {
    let mut old = [q.to_vec(), v.to_vec(), a.to_vec()];
    for index in 0..system.coordinates.len() {
        let next = system.first_coordinate((index + 1) % system.coordinates.len());
        let (sin, cos) = pendulum_runtime::scalar::Real::sin_cos(q[next]);
        let first = system.first_coordinate(index);
        for scalar in first..first + system.coordinates[index].length.unwrap_or(1) {
            old[0][scalar] += sin / 3.0;
            old[1][scalar] += cos * v[next] / 3.0;
            old[2][scalar] += (cos * a[next] - sin * v[next] * v[next]) / 3.0;
        }
    }
    old
}

/// Replaces coordinates by definitions, which precede all other definitions.
fn replaced(expr: &mut Expr, count: usize) {
    let definition = |index: usize, member: Option<Index>| match member {
        None => Expr::Let(index),
        Some(member) => Expr::LetMember(index, member),
    };
    match expr {
        Expr::Coordinate(index, member) => *expr = definition(*index, *member),
        Expr::Velocity(index, None, 0) => *expr = Expr::LetDot(*index),
        Expr::Velocity(index, member, _) => {
            *expr = Operation::Dot.of([definition(*index, *member)]);
        }
        Expr::Let(index)
        | Expr::LetDot(index)
        | Expr::LetMember(index, _)
        | Expr::Apply(index, _) => *index += count,
        _ => {}
    }
}
