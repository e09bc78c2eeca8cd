//! The backends: Rust, equations in Unicode, LaTeX and MathML, and a copy of the block for editors.

mod cancel;
pub(crate) mod compiled;
pub(crate) mod ide;
pub(crate) mod latex;
pub(crate) mod layout;
pub(crate) mod mathml;
pub(crate) mod names;
pub(crate) mod rust;
pub(crate) mod unicode;

use crate::algebra::expr::Graph;
use crate::mechanics::lower::Energies;
use crate::mechanics::motion::Motion;
use crate::model::Model;
use crate::model::unit::infer::RowUnits;
use crate::schedule::Program;
use proc_macro2::{Ident, Span, TokenStream};

/// The results of the analysis of a block, which backends write.
pub(crate) struct Analysis<'m, 'a> {
    /// The path of the runtime.
    pub(crate) krate: TokenStream,
    pub(crate) model: &'m Model<'a>,
    pub(crate) graph: Graph,
    pub(crate) energies: Energies,
    /// The equations of motion; `None` after a mistake.
    pub(crate) motion: Option<Motion>,
    /// The equations in Unicode, in LaTeX and in MathML, in lines.
    pub(crate) equations: [Vec<String>; 3],
    /// The program of the accelerations.
    pub(crate) accelerations: Option<Program>,
    /// The inferred units.
    pub(crate) units: RowUnits,
}

/// Returns the same name with a span outside the block.
fn unlocated(name: &Ident) -> Ident {
    let mut name = name.clone();
    name.set_span(Span::call_site());
    name
}
