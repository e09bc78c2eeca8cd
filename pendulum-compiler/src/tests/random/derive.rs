//! A block as text to its equations of motion.

use crate::check::Model;
use crate::error::Errors;
use crate::expr::Graph;
use crate::motion::Motion;
use crate::{check, lower, motion, parse, unit};

/// Derives a block and hands over what came out; `None` if it was refused.
pub(crate) fn derived<R>(
    source: &str,
    errors: &mut Errors,
    inspect: impl FnOnce(&Model, &mut Graph, &Motion, &lower::Energies) -> R,
) -> Option<R> {
    let tokens = format!("::pendulum_runtime; {source}").parse().ok()?;
    let (_, block) = parse::all(tokens, errors)?;
    let model = check::resolve(&block, errors);
    let mut graph = Graph::new();
    let mut energies = lower::energies(&model, &mut graph, errors);
    if errors.is_empty() {
        unit::infer::check(&model, errors);
    }
    if !errors.is_empty() {
        return None;
    }
    let motion = motion::canonical(&model, &mut graph, &mut energies, errors)?;
    Some(inspect(&model, &mut graph, &motion, &energies))
}
