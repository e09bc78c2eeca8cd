//! What the passes from energies to equations work on.

use crate::algebra::expr::{Graph, Id, Symbol};
use crate::mechanics::lower::Energies;
use crate::messages::Errors;
use crate::model::Model;
use proc_macro2::Ident;

/// A block whose equations of motion are derived: its expressions, and the mistakes found so far.
pub(crate) struct Derivation<'d, 'a> {
    pub(crate) model: &'d Model<'a>,
    pub(crate) graph: &'d mut Graph,
    pub(crate) energies: &'d Energies,
    pub(crate) errors: &'d mut Errors,
}

/// Returns the first driven input of which some expressions contain the derivative of an order, or
/// the first control input without an order.
pub(super) fn named_input<'a>(
    model: &Model<'a>,
    graph: &Graph,
    roots: &[Id],
    order: Option<u8>,
) -> Option<&'a Ident> {
    let found = graph.symbols(roots).into_iter().find_map(|symbol| match symbol {
        Symbol::Control { input, .. } if order.is_none() => Some(input),
        Symbol::Input { input, order: own, .. } if order == Some(own) => Some(input),
        _ => None,
    });
    found.map(|input| model.inputs[input].name)
}
