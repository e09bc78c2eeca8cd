//! Tests of whole blocks, without running rustc.

use crate::algebra::expr::{Graph, Id, Symbol};
use crate::backend::names::Names;
use crate::backend::unicode::Side;
use crate::backend::{latex, layout};
use crate::compile::derived;
use crate::mechanics::lower;
use crate::mechanics::lower::constant;
use crate::mechanics::motion::Motion;
use crate::messages::Errors;
use crate::model;
use crate::model::Model;
use crate::syntax::parse;
use random_systems::Random;
use std::collections::BTreeMap;

mod absolute;
mod arguments;
mod attitudes;
mod clock;
mod constraints;
mod derivatives;
mod fragments;
mod frames;
mod frictions;
mod functions;
mod golden;
mod growth;
mod identities;
mod inputs;
mod matrices;
mod newcomers;
mod norms;
mod outputs;
mod points;
mod powers;
mod printed;
mod quantities;
mod random;
mod refusals;
mod rotations;
mod rules;
mod solids;
mod soup;
mod sparse;
mod states;
mod symmetries;
mod tables;
mod translations;
mod vectors;

/// Returns the messages for a block.
fn refusals(source: &str) -> Vec<String> {
    let mut errors = Errors::default();
    derived(source, &mut errors, |_, _, _, _| ());
    errors.messages()
}

/// Derives a block without mistakes.
fn derive<R>(source: &str, inspect: impl FnOnce(&Model, &mut Graph, &Motion) -> R) -> R {
    let mut errors = Errors::default();
    let result =
        derived(source, &mut errors, |model, graph, motion, _| inspect(model, graph, motion));
    assert!(errors.is_empty(), "{source}: {:?}", errors.messages());
    result.unwrap()
}

/// Returns the equations of motion in LaTeX.
fn in_latex(graph: &mut Graph, names: &Names, motion: &Motion, sides: &[Side]) -> Vec<String> {
    let formulas = layout::equations(graph, names, motion, sides);
    formulas.iter().map(|formula| latex::equation(formula)).collect()
}

/// Lowers an expression of the free scalars `a`, `b`, `c` as the potential of a block.
pub(crate) fn lowered(graph: &mut Graph, expression: &str) -> Id {
    let source = format!("::p; struct S {{ a, b, c }} coordinate q; potential = {expression};");
    let mut errors = Errors::default();
    let (_, block) = parse::all(source.parse().unwrap(), &mut errors).unwrap();
    let model = model::resolve(&block, &mut errors);
    let energies = lower::energies(&model, graph, &mut errors);
    assert!(errors.is_empty(), "{expression}: {:?}", errors.messages());
    energies.potential.unwrap()
}

/// Evaluates an expression in floating point.
fn evaluate(graph: &Graph, root: Id, value: &dyn Fn(Symbol) -> f64) -> f64 {
    let mut known: BTreeMap<Id, f64> = BTreeMap::new();
    for id in graph.reachable(&[root]) {
        let result = constant::evaluate(graph, id, |child| known[&child], value);
        known.insert(id, result);
    }
    known[&root]
}
