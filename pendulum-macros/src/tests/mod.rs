//! Tests of whole blocks, in process.

use crate::check::Model;
use crate::error::Errors;
use crate::expr::{Graph, Id, Symbol};
use crate::lower::constant;
use crate::motion::Motion;
use crate::{check, lower, motion, parse};
use std::collections::BTreeMap;

mod derivatives;
mod golden;
mod growth;
mod identities;
mod refusals;
mod rules;
mod soup;
mod sparse;

/// What is wrong with a block.
fn refusals(source: &str) -> Vec<String> {
    let mut errors = Errors::default();
    derived(source, &mut errors, |_, _, _, _| ());
    errors.messages()
}

/// Derives a block without mistakes.
fn derive<R>(source: &str, inspect: impl FnOnce(&Model, &mut Graph, &Motion) -> R) -> R {
    let mut errors = Errors::default();
    let result = derived(source, &mut errors, |model, graph, motion, _| inspect(model, graph, motion));
    assert!(errors.is_empty(), "{source}: {:?}", errors.messages());
    result.unwrap()
}

fn derived<R>(
    source: &str,
    errors: &mut Errors,
    inspect: impl FnOnce(&Model, &mut Graph, &Motion, &lower::Energies) -> R,
) -> Option<R> {
    let tokens = format!("::pendulum_runtime; {source}").parse().unwrap();
    let (_, block) = parse::all(tokens, errors)?;
    let model = check::resolve(&block, errors);
    let mut graph = Graph::new();
    let mut energies = lower::energies(&model, &mut graph, errors);
    if errors.is_empty() {
        crate::unit::infer::check(&model, errors);
    }
    if !errors.is_empty() {
        return None;
    }
    let motion = motion::canonical(&model, &mut graph, &mut energies, errors)?;
    Some(inspect(&model, &mut graph, &motion, &energies))
}

/// An expression of the free scalars `a`, `b`, `c`, lowered through a block's potential.
pub(crate) fn lowered(graph: &mut Graph, expression: &str) -> Id {
    let source = format!("::p; struct S {{ a, b, c }} coordinate q; potential = {expression};");
    let mut errors = Errors::default();
    let (_, block) = parse::all(source.parse().unwrap(), &mut errors).unwrap();
    let model = check::resolve(&block, &mut errors);
    let energies = lower::energies(&model, graph, &mut errors);
    assert!(errors.is_empty(), "{expression}: {:?}", errors.messages());
    energies.potential.unwrap()
}

/// The value of an expression in floating point.
fn evaluate(graph: &Graph, root: Id, value: &dyn Fn(Symbol) -> f64) -> f64 {
    let mut known: BTreeMap<Id, f64> = BTreeMap::new();
    for id in graph.reachable(&[root]) {
        let result = constant::evaluate(graph, id, |child| known[&child], value);
        known.insert(id, result);
    }
    known[&root]
}

/// SplitMix64 (Steele, Lea and Flood, 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit as u64) as usize
    }

    /// In [low, high).
    fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}
