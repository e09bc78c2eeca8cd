//! What the macro makes of a system: operations of the accelerations at one state (after preparation), tokens of the whole expansion,
//! and the time that the expansion takes.
//!
//! `cargo run --release --example operations` prints one line a system:
//! `name coordinates sincos mul add div tokens expansion_ms`. Names on the command line choose some of them.

// Not all of the compiler is called.
#![allow(dead_code)]

mod systems;

include!("compiler.rs");

use proc_macro2::{TokenStream, TokenTree};
use std::time::Instant;

fn main() {
    println!("name coordinates sincos mul add div tokens expansion_ms");
    let chosen: Vec<String> = std::env::args().skip(1).collect();
    for (name, block) in systems::all().into_iter().filter(|(name, _)| chosen.is_empty() || chosen.contains(name)) {
        let operations = operations(&block);
        let mut tokens = 0;
        let mut times: Vec<f64> = (0..if operations.mul < 200 { 9 } else { 3 })
            .map(|_| {
                let input = block.parse().expect("a block is made of tokens");
                let start = Instant::now();
                let output = expand::expand(input);
                let time = 1e3 * start.elapsed().as_secs_f64();
                tokens = count(output);
                time
            })
            .collect();
        times.sort_by(f64::total_cmp);
        let Operations { coordinates, sincos, mul, add, div } = operations;
        println!("{name} {coordinates} {sincos} {mul} {add} {div} {tokens} {:.1}", times[times.len() / 2]);
    }
}

struct Operations {
    coordinates: usize,
    sincos: usize,
    mul: usize,
    add: usize,
    div: usize,
}

/// The operations of the accelerations of a block.
fn operations(block: &str) -> Operations {
    let mut errors = error::Errors::default();
    let tokens = block.parse().expect("a block is made of tokens");
    let (_, block) = parse::all(tokens, &mut errors).expect("a block");
    let model = check::resolve(&block, &mut errors);
    let mut graph = expr::Graph::new();
    let mut energies = lower::energies(&model, &mut graph, &mut errors);
    let motion = motion::canonical(&model, &mut graph, &mut energies, &mut errors).expect("a block without mistakes");
    let count = schedule::program(&graph, &motion.accelerations).count();
    assert_eq!(count.functions, 0, "only sines and cosines stand in these systems");
    Operations { coordinates: motion.accelerations.len(), sincos: count.sincos, mul: count.mul, add: count.add, div: count.div }
}

/// The number of tokens, those within brackets and the brackets themselves included.
fn count(tokens: TokenStream) -> usize {
    let count = |token| match token {
        TokenTree::Group(group) => 2 + count(group.stream()),
        _ => 1,
    };
    tokens.into_iter().map(count).sum()
}
