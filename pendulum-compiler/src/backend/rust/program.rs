//! The statements of a scheduled program.

use super::local;
use crate::algebra::expr::Id;
use crate::algebra::number::Rational;
use crate::backend::Analysis;
use crate::mechanics::motion::Motion;
use crate::schedule::{self, Op, Place, Program};
use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;

/// The limit on the zeros of an array that are written. Most of the code of a large family would be
/// zeros of its mass matrix.
const MOST_ZEROS: usize = 100;

impl Analysis<'_, '_> {
    /// Returns a block that computes an array of roots; `None` if these roots do not exist.
    pub(super) fn output(&self, pick: impl Fn(&Motion) -> Option<Vec<Id>>) -> Option<TokenStream> {
        match &self.motion {
            None => Some(quote!(::core::unimplemented!())),
            Some(motion) => Some(self.roots(&pick(motion)?)),
        }
    }

    /// Returns a block that computes an array of these roots.
    pub(super) fn roots(&self, roots: &[Id]) -> TokenStream {
        self.body(&schedule::program(&self.graph, roots))
    }

    /// Returns the statements of a program. An operation that is used once is inlined.
    pub(super) fn body(&self, program: &Program) -> TokenStream {
        self.body_after(program, &program.results, &[])
    }

    /// Returns the statements that compute `results`, given arrays of known values.
    pub(crate) fn body_after(
        &self,
        program: &Program,
        results: &[Place],
        arrays: &[(&str, &[Place])],
    ) -> TokenStream {
        let given = |index: usize| {
            arrays.iter().find_map(|(name, places)| {
                let place = places.iter().position(|place| place.0 == index)?;
                let name = Ident::new(name, Span::call_site());
                Some(quote!(#name[#place]))
            })
        };
        let mut readers = vec![0usize; program.ops.len()];
        for result in results {
            readers[result.0] += 1;
        }
        for (index, op) in program.ops.iter().enumerate().rev() {
            if 0 < readers[index] && given(index).is_none() {
                for place in schedule::operands(op) {
                    readers[place.0] += 1;
                }
            }
        }
        let mut statements = TokenStream::new();
        let mut values: Vec<TokenStream> = Vec::with_capacity(program.ops.len());
        let mut depths: Vec<usize> = Vec::with_capacity(program.ops.len());
        for (index, op) in program.ops.iter().enumerate() {
            if let Some(value) = given(index) {
                values.push(value);
                depths.push(0);
                continue;
            }
            if readers[index] == 0 {
                values.push(TokenStream::new());
                depths.push(0);
                continue;
            }
            let at = |place: Place| values[place.0].clone();
            let depth =
                1 + schedule::operands(op).iter().map(|place| depths[place.0]).max().unwrap_or(0);
            if let Op::SinCos(angle) = op {
                let (sin, cos) = (local("s", index), local("c", index));
                let angle = at(*angle);
                statements.extend(quote!(let (#sin, #cos) = #angle.sin_cos();));
                values.push(TokenStream::new());
                depths.push(0);
                continue;
            }
            let value = self.operation(op, at);
            let free = matches!(op, Op::Load(_) | Op::Part(..));
            if free || readers[index] < 2 && depth < 16 {
                values.push(value);
                depths.push(if free { 0 } else { depth });
            } else {
                let name = local("v", index);
                statements.extend(quote!(let #name = #value;));
                values.push(quote!(#name));
                depths.push(0);
            }
        }
        let zero = |place: &&Place| matches!(program.ops[place.0], Op::Number(Rational::ZERO));
        if results.iter().filter(zero).count() <= MOST_ZEROS {
            let results = results.iter().map(|place| values[place.0].clone());
            return quote!({ #statements [#(#results),*] });
        }
        let (scalar, size) = (self.scalar(), results.len());
        let written = results.iter().enumerate().filter(|(_, place)| !zero(place));
        let (places, written): (Vec<usize>, Vec<TokenStream>) =
            written.map(|(index, place)| (index, values[place.0].clone())).unzip();
        let length = places.len();
        quote! {{
            #statements
            let written: [#scalar; #length] = [#(#written),*];
            let places: [usize; #length] = [#(#places),*];
            let mut all = [#scalar::from_f64(0.0); #size];
            for k in 0..#length {
                all[places[k]] = written[k];
            }
            all
        }}
    }
}
