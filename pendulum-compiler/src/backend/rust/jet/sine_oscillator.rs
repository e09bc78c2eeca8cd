//! Sine oscillators: coordinates with q̈ = κ sin q + λ cos q, where κ and λ depend only on
//! parameters.
//!
//! Their jets store neither sine nor cosine as a series. With a = q̈ and b = κ cos q − λ sin q, ȧ =
//! b q̇ and ḃ = −a q̇ = −(q̇²/2)˙. These are one product and one square, in which each term is
//! computed once, instead of two products.

use super::writer::Writer;
use crate::algebra::expr::Symbol;
use crate::algebra::functions::Function;
use crate::schedule::{Op, Place, Program, operands};
use proc_macro2::TokenStream;
use quote::quote;
use std::collections::BTreeSet;

/// Returns the operations from a coordinate to its acceleration if the coordinate is a sine
/// oscillator and if no other operation uses them.
pub(super) fn oscillator_operations(
    program: &Program,
    parameter_only: &[bool],
    coordinate: usize,
    acceleration: Place,
) -> Option<BTreeSet<Place>> {
    let mut own = BTreeSet::new();
    if !combines(program, parameter_only, coordinate, acceleration, &mut own) {
        return None;
    }
    let read_outside = |(place, op): (usize, &Op)| {
        !own.contains(&Place(place))
            && operands(op)
                .iter()
                .any(|operand| own.contains(operand) && !parameter_only[operand.0])
    };
    let results = program.results.iter().filter(|result| own.contains(result)).count();
    let alone = results == 1 && !program.ops.iter().enumerate().any(read_outside);
    alone.then_some(own)
}

impl Writer<'_, '_, '_> {
    /// Writes the acceleration of a sine oscillator.
    pub(super) fn sine_oscillator(&mut self, row: usize, place: Place) {
        let (combination, slot) = (self.combination(place), self.slot());
        self.halves += 3;
        self.lines.extend(quote! {
            if k == 0 {
                let (s, c) = path.q[#row][0].sin_cos();
                path.a[#row][0] = #combination;
                let (s, c) = (c, -s);
                #slot[0] = #combination;
            } else {
                series::sine_oscillator(path, #row, &mut #slot, order);
            }
        });
    }

    /// Writes a combination of sine and cosine as an expression in `s` and `c`.
    fn combination(&self, place: Place) -> TokenStream {
        match self.program.ops[place.0] {
            Op::Call(Function::Sin, _) | Op::Part(Function::Sin, _) => quote!(s),
            Op::Call(..) | Op::Part(..) => quote!(c),
            Op::Negative(a) => {
                let a = self.combination(a);
                quote!(-(#a))
            }
            Op::Add(a, b) | Op::Sub(a, b) => {
                let plus = matches!(self.program.ops[place.0], Op::Add(..));
                let (a, b) = (self.combination(a), self.combination(b));
                if plus { quote!(#a + #b) } else { quote!(#a - (#b)) }
            }
            Op::Mul(a, b) if self.parameter_only[a.0] => {
                let (a, b) = (self.constant(a), self.combination(b));
                quote!(#a * (#b))
            }
            Op::Mul(a, b) => {
                let (a, b) = (self.combination(a), self.constant(b));
                quote!((#a) * #b)
            }
            Op::Div(a, b) => {
                let (a, b) = (self.combination(a), self.constant(b));
                quote!((#a) / #b)
            }
            _ => TokenStream::new(),
        }
    }
}

/// Returns `true` if a place is a sum of multiples of the sine and the cosine of the coordinate,
/// and collects the operations that depend on more than parameters.
fn combines(
    program: &Program,
    parameter_only: &[bool],
    coordinate: usize,
    place: Place,
    own: &mut BTreeSet<Place>,
) -> bool {
    if parameter_only[place.0] {
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
        Op::Negative(a) => combines(program, parameter_only, coordinate, a, own),
        Op::Add(a, b) | Op::Sub(a, b) => {
            combines(program, parameter_only, coordinate, a, own)
                && combines(program, parameter_only, coordinate, b, own)
        }
        Op::Mul(a, b) if parameter_only[a.0] => {
            combines(program, parameter_only, coordinate, b, own)
        }
        Op::Mul(a, b) | Op::Div(a, b) if parameter_only[b.0] => {
            combines(program, parameter_only, coordinate, a, own)
        }
        _ => false,
    }
}
