//! The operations generated for a system: those of the accelerations at one state (after
//! preparation), the tokens of the whole expansion, and the time of the expansion.
//!
//! `cargo run --release -p pictures --features compiler --bin operations` prints a line for each
//! system: `name coordinates sincos mul add div tokens expansion_ms`. Names on the command line
//! select systems.

mod systems;

use pendulum_compiler::{Operations, compile, expand};
use proc_macro2::{TokenStream, TokenTree};
use std::time::Instant;

fn main() {
    println!("name coordinates sincos mul add div tokens expansion_ms");
    let chosen: Vec<String> = std::env::args().skip(1).collect();
    for (name, block) in
        systems::all().into_iter().filter(|(name, _)| chosen.is_empty() || chosen.contains(name))
    {
        let compiled = compile(&block).unwrap_or_else(|mistakes| panic!("{name}: {mistakes:?}"));
        let Operations { sincos, mul, add, div, .. } = compiled.operations;
        let mut tokens = 0;
        let mut times: Vec<f64> = (0..if mul < 200 { 9 } else { 3 })
            .map(|_| {
                let input = format!("::pendulum_runtime; {block}")
                    .parse()
                    .expect("a block is made of tokens");
                let start = Instant::now();
                let output = expand(input);
                let time = 1e3 * start.elapsed().as_secs_f64();
                tokens = count(output);
                time
            })
            .collect();
        times.sort_by(f64::total_cmp);
        let coordinates: usize =
            compiled.coordinates.iter().map(|coordinate| coordinate.length.unwrap_or(1)).sum();
        println!(
            "{name} {coordinates} {sincos} {mul} {add} {div} {tokens} {:.1}",
            times[times.len() / 2]
        );
    }
}

/// Counts the tokens, including brackets and the tokens inside them.
fn count(tokens: TokenStream) -> usize {
    let count = |token| match token {
        TokenTree::Group(group) => 2 + count(group.stream()),
        _ => 1,
    };
    tokens.into_iter().map(count).sum()
}
