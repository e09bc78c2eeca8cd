//! Straight-line programs: binary operations in order, each of which reads results of earlier
//! operations.

use crate::algebra::expr::Symbol;
use crate::algebra::functions::Function;
use crate::algebra::number::Literal;
use crate::algebra::number::Rational;
use std::collections::BTreeMap;

/// The index of an operation in its program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Place(pub(crate) usize);

/// An operation, which follows its operands in the program.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Op {
    Number(Rational),
    Literal(Literal),
    Pi,
    Load(Symbol),
    Negative(Place),
    Add(Place, Place),
    Sub(Place, Place),
    Mul(Place, Place),
    Div(Place, Place),
    Sqrt(Place),
    Powf(Place, Place),
    Atan2(Place, Place),
    Max(Place, Place),
    Call(Function, Place),
    /// Sine and cosine of one angle, extracted by `Part`.
    SinCos(Place),
    Part(Function, Place),
}

/// The operations of one output.
#[derive(Debug, Default)]
pub(crate) struct Program {
    pub(crate) ops: Vec<Op>,
    pub(crate) results: Vec<Place>,
    places: BTreeMap<Op, Place>,
}

impl Program {
    /// Returns a program with the same values in which quotients by parameters are replaced by
    /// products with reciprocals.
    pub(super) fn with_reciprocals(self) -> Self {
        let parameter_only = self.parameter_only();
        let mut program = Self::default();
        let mut moved: Vec<Place> = Vec::with_capacity(self.ops.len());
        for (index, op) in self.ops.into_iter().enumerate() {
            let place = match op {
                Op::Div(a, b) if !parameter_only[index] && parameter_only[b.0] => {
                    let one = program.push(Op::Number(Rational::ONE));
                    let reciprocal = program.push(Op::Div(one, moved[b.0]));
                    program.push(mul(moved[a.0], reciprocal))
                }
                op => program.push(renumber(op, &moved)),
            };
            moved.push(place);
        }
        program.results = self.results.iter().map(|result| moved[result.0]).collect();
        program
    }

    pub(super) fn push(&mut self, op: Op) -> Place {
        if let Some(&place) = self.places.get(&op) {
            return place;
        }
        let place = Place(self.ops.len());
        self.ops.push(op.clone());
        self.places.insert(op, place);
        place
    }
}

/// Returns the places that an operation reads.
pub(crate) fn operands(op: &Op) -> Vec<Place> {
    let mut places = Vec::new();
    mapped(op.clone(), |place| {
        places.push(place);
        place
    });
    places
}

/// Returns an operation that reads other places.
fn mapped(op: Op, mut at: impl FnMut(Place) -> Place) -> Op {
    match op {
        Op::Number(_) | Op::Literal(_) | Op::Pi | Op::Load(_) => op,
        Op::Negative(a) => Op::Negative(at(a)),
        Op::Sqrt(a) => Op::Sqrt(at(a)),
        Op::Call(function, a) => Op::Call(function, at(a)),
        Op::SinCos(a) => Op::SinCos(at(a)),
        Op::Part(function, a) => Op::Part(function, at(a)),
        Op::Add(a, b) => Op::Add(at(a), at(b)),
        Op::Sub(a, b) => Op::Sub(at(a), at(b)),
        Op::Mul(a, b) => Op::Mul(at(a), at(b)),
        Op::Div(a, b) => Op::Div(at(a), at(b)),
        Op::Powf(a, b) => Op::Powf(at(a), at(b)),
        Op::Atan2(a, b) => Op::Atan2(at(a), at(b)),
        Op::Max(a, b) => Op::Max(at(a), at(b)),
    }
}

/// Creates a product with its operands in ascending order, so that equal products are found. The
/// same holds for `add`.
pub(super) fn mul(a: Place, b: Place) -> Op {
    Op::Mul(a.min(b), a.max(b))
}

pub(super) fn add(a: Place, b: Place) -> Op {
    Op::Add(a.min(b), a.max(b))
}

/// Removes operations that no result depends on.
pub(super) fn prune(program: Program) -> Program {
    let mut needed = vec![false; program.ops.len()];
    for result in &program.results {
        needed[result.0] = true;
    }
    for index in (0..program.ops.len()).rev() {
        if needed[index] {
            for operand in operands(&program.ops[index]) {
                needed[operand.0] = true;
            }
        }
    }
    let mut moved = vec![Place(0); program.ops.len()];
    let mut pruned = Program::default();
    for (index, op) in program.ops.into_iter().enumerate() {
        if needed[index] {
            moved[index] = pruned.push(renumber(op, &moved));
        }
    }
    pruned.results = program.results.iter().map(|result| moved[result.0]).collect();
    pruned
}

fn renumber(op: Op, moved: &[Place]) -> Op {
    mapped(op, |place| moved[place.0])
}
