//! Swings: coordinates with q̈ = κ sin q + λ cos q, where κ and λ do not move.
//!
//! Their jets need neither sine nor cosine as a series. With a = q̈ and b = κ cos q − λ sin q is ȧ = b q̇ and ḃ = −a q̇ = −(q̇²/2)˙:
//! one product and one square, each of whose terms comes once, in place of two products.

use crate::expr::{Function, Symbol};
use crate::schedule::{Op, Place, Program, operands};
use std::collections::BTreeSet;

/// The operations between the coordinate and its acceleration, if they make it swing and nothing else reads them.
pub(crate) fn swing(program: &Program, still: &[bool], coordinate: usize, acceleration: Place) -> Option<BTreeSet<Place>> {
    let mut own = BTreeSet::new();
    if !combines(program, still, coordinate, acceleration, &mut own) {
        return None;
    }
    let read_outside = |(place, op): (usize, &Op)| {
        !own.contains(&Place(place)) && operands(op).iter().any(|operand| own.contains(operand) && !still[operand.0])
    };
    let results = program.results.iter().filter(|result| own.contains(result)).count();
    let alone = results == 1 && !program.ops.iter().enumerate().any(read_outside);
    alone.then_some(own)
}

/// Whether a place is a sum of multiples of the sine and the cosine of the coordinate; collects what moves on the way there.
fn combines(program: &Program, still: &[bool], coordinate: usize, place: Place, own: &mut BTreeSet<Place>) -> bool {
    if still[place.0] {
        return false;
    }
    own.insert(place);
    let angle = |angle: Place| matches!(program.ops[angle.0], Op::Load(Symbol::Coordinate(index)) if index == coordinate);
    match program.ops[place.0] {
        Op::Call(Function::Sin | Function::Cos, a) => angle(a),
        Op::Part(Function::Sin | Function::Cos, pair) => {
            own.insert(pair);
            matches!(program.ops[pair.0], Op::SinCos(a) if angle(a))
        }
        Op::Negative(a) => combines(program, still, coordinate, a, own),
        Op::Add(a, b) | Op::Sub(a, b) => {
            combines(program, still, coordinate, a, own) && combines(program, still, coordinate, b, own)
        }
        Op::Mul(a, b) if still[a.0] => combines(program, still, coordinate, b, own),
        Op::Mul(a, b) | Op::Div(a, b) if still[b.0] => combines(program, still, coordinate, a, own),
        _ => false,
    }
}
