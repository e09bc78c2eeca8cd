//! What is fed with random input.

use crate::bvh::Bvh;
use crate::expand::expand;
use crate::files::mutated;
use crate::random::generate::{self, Manner};
use crate::random::tokens::{BLOCKS, mutate, soup, transplant};
use crate::random::{Outcome, Random, outcome};
use proc_macro2::TokenStream;

/// What became of a case.
pub(crate) enum Verdict {
    Taken,
    Refused,
    Wrong(String),
}

/// Something that reads.
pub(crate) struct Target {
    pub(crate) name: &'static str,
    /// The case of a seed.
    pub(crate) case: fn(u64) -> Verdict,
}

/// All targets.
pub(crate) const TARGETS: &[Target] = &[
    Target { name: "tokens", case: tokens },
    Target { name: "mutated-blocks", case: mutated_blocks },
    Target { name: "blocks", case: blocks },
    Target { name: "equations", case: equations },
    Target { name: "motion-capture", case: motion_capture },
];

/// Any tokens, now and then behind a struct.
fn tokens(seed: u64) -> Verdict {
    let mut random = Random(seed);
    let mut tokens = parsed("::p;");
    if random.once_in(2) {
        tokens.extend(parsed("struct S { m, L: m }"));
    }
    tokens.extend(soup(&mut random, 0));
    expansion(tokens)
}

/// Blocks of the tests and random ones, with some of their tokens changed.
fn mutated_blocks(seed: u64) -> Verdict {
    let mut random = Random(seed);
    let block = if random.once_in(2) {
        parsed(random.of(BLOCKS))
    } else {
        parsed(&format!("::p; {}", generate::system(seed, Manner::Wild).source("S")))
    };
    expansion(if random.once_in(2) { mutate(block, &mut random) } else { transplant(block, &mut random) })
}

/// Random systems of any kind, expanded.
fn blocks(seed: u64) -> Verdict {
    expansion(parsed(&format!("::p; {}", generate::system(seed, Manner::Wild).source("S"))))
}

/// Random systems whose equations are compared with those of the reference.
fn equations(seed: u64) -> Verdict {
    match outcome(&generate::system(seed, Manner::Tame)) {
        Outcome::Refused(messages) => Verdict::Wrong(format!("refused: {messages}")),
        Outcome::Unsound => Verdict::Refused,
        Outcome::Compared(findings) => match findings.wrong().as_slice() {
            [] => Verdict::Taken,
            wrong => Verdict::Wrong(format!("{wrong:?}")),
        },
    }
}

const JUMPS: &[u8] = include_bytes!("../data/jumps.bvh");

/// A motion capture with something wrong in it.
fn motion_capture(seed: u64) -> Verdict {
    let mut random = Random(seed);
    // Most of the file is rows of numbers.
    let length = if random.once_in(2) { JUMPS.len() } else { 4000 + random.below(6000) };
    let bytes = mutated(&JUMPS[..length], &mut random);
    match Bvh::read(&String::from_utf8_lossy(&bytes)) {
        Ok(_) => Verdict::Taken,
        Err(_) => Verdict::Refused,
    }
}

/// The expansion, which is there whatever is wrong.
fn expansion(tokens: TokenStream) -> Verdict {
    let refused = expand(tokens).into_iter().any(|token| token.to_string().contains("compile_error"));
    if refused { Verdict::Refused } else { Verdict::Taken }
}

fn parsed(text: &str) -> TokenStream {
    text.parse().unwrap_or_else(|error| panic!("{error}: {text}"))
}
