//! Random tokens: the expansion neither panics nor hangs.

use crate::compile::expand;
use proc_macro2::{TokenStream, TokenTree};
use random_systems::Random;
use random_systems::tokens::{BLOCKS, mutate, soup, transplant};

/// Returns the number of inputs of each kind: `SOUP=50000` in `.ci/run`, or any other number.
fn rounds() -> u64 {
    std::env::var("SOUP").ok().and_then(|text| text.parse().ok()).unwrap_or(2000)
}

#[test]
fn random_tokens_do_not_panic() {
    let [path, head]: [TokenStream; 2] =
        ["::p;", "struct S { m, L: m }"].map(|text| text.parse().unwrap());
    for seed in 0..rounds() {
        let mut random = Random(seed);
        let mut tokens = path.clone();
        if random.below(2) == 0 {
            tokens.extend(head.clone());
        }
        tokens.extend(soup(&mut random, 0));
        expand(tokens);
    }
}

#[test]
fn mutated_blocks_do_not_panic() {
    let blocks: Vec<TokenStream> = BLOCKS.iter().map(|block| block.parse().unwrap()).collect();
    for seed in 0..rounds() {
        let mut random = Random(seed);
        let block = blocks[random.below(blocks.len())].clone();
        expand(if seed % 2 == 0 {
            mutate(block, &mut random)
        } else {
            transplant(block, &mut random)
        });
    }
}

/// After a single mistake, the items are still emitted: the struct, its constructor and its
/// `System`.
#[test]
fn the_items_survive_a_mistake() {
    let good = expand(BLOCKS[0].parse().unwrap()).to_string();
    let bad = expand(BLOCKS[0].replace("height(y)", "hight(y)").parse().unwrap()).to_string();
    for item in [
        "pub struct M <",
        "impl < T : :: p :: scalar :: Real > M <",
        "System < 1usize > for M",
        "SplitEnergy < 1usize > for M",
        "fn driven_by",
        "pub static θ : f64",
        "pub static x : [f64]",
        "let _ = __block :: scope0 :: L ;",
    ] {
        assert!(good.contains(item), "{item} in {good}");
        assert!(bad.contains(item), "{item} in {bad}");
    }
    assert!(bad.contains("compile_error"));
}

/// If any token of a block is removed, doubled or replaced, the items required by an editor are
/// still emitted: the struct with its fields, its constructor, its `System`, and names for hover
/// texts.
#[test]
fn the_shape_survives_any_broken_token() {
    let block =
        "::p; pub struct M { m: kg, L: m = 1, g: m/s^2 } coordinate θ: rad; driven x: [m; 2];
                 let y = x + L*[sin(θ), -cos(θ)]; kinetic = m/2*|ẏ|^2; potential = m*g*height(y);";
    let tokens: TokenStream = block.parse().unwrap();
    let count = leaves(&tokens);
    // The tokens before the body of the struct define its shape and are not changed.
    for index in 7..count {
        for change in [Change::Remove, Change::Double, Change::Replace] {
            let broken = changed(&tokens, index, change, &mut 0);
            let found = expand(broken.clone()).to_string();
            for item in
                ["pub struct M <", "system :: System <", "fn new", "fn __names ()", "mod __block {"]
            {
                assert!(found.contains(item), "{item} is missing for {broken}");
            }
        }
    }
}

#[derive(Clone, Copy)]
enum Change {
    Remove,
    Double,
    Replace,
}

fn leaves(tokens: &TokenStream) -> usize {
    let count = |tree| match tree {
        TokenTree::Group(group) => leaves(&group.stream()),
        _ => 1,
    };
    tokens.clone().into_iter().map(count).sum()
}

/// Returns a stream with one of its leaves changed.
fn changed(tokens: &TokenStream, index: usize, change: Change, next: &mut usize) -> TokenStream {
    let mut result = Vec::new();
    for tree in tokens.clone() {
        if let TokenTree::Group(group) = &tree {
            let inner = changed(&group.stream(), index, change, next);
            result.push(TokenTree::Group(proc_macro2::Group::new(group.delimiter(), inner)));
            continue;
        }
        let here = *next == index;
        *next += 1;
        match change {
            Change::Remove if here => {}
            Change::Double if here => result.extend([tree.clone(), tree]),
            Change::Replace if here => result
                .push(TokenTree::Punct(proc_macro2::Punct::new('?', proc_macro2::Spacing::Alone))),
            _ => result.push(tree),
        }
    }
    result.into_iter().collect()
}

/// Powers of powers whose exponents exceed exact arithmetic.
#[test]
fn huge_exponents_do_not_hang() {
    let large = [
        "10000000000000000000000",
        "1e17",
        "-1e17",
        "(1/1e17)",
        "(3/7)",
        "(1e17/3e16)",
        "2e9",
        "(1/2e9)",
    ];
    for a in large {
        for b in large {
            for base in [
                "x",
                "(m*x)",
                "(2*m*x)",
                "|x|",
                "(x + m)",
                "(x^2 + m*x^1e17)",
                "3",
                "(-m*x^2)",
                "sin(x)",
            ] {
                let block = format!(
                    "::p; struct S {{ m }} coordinate x; kinetic = ẋ^2; potential = m*({base}^{a})^{b} + ({base}*x^{b})^{a}/x^{a};"
                );
                expand(block.parse().unwrap());
            }
        }
    }
}

#[test]
fn deep_nesting_is_refused() {
    let deep = format!(
        "::p; struct S {{ m }} coordinate q; kinetic = {}m{};",
        "(".repeat(1000),
        ")".repeat(1000)
    );
    let found = expand(deep.parse().unwrap()).to_string();
    assert!(found.contains("nested too deeply"));
    let signs = format!("::p; struct S {{ m }} coordinate q; kinetic = {}m;", "-".repeat(10_000));
    assert!(expand(signs.parse().unwrap()).to_string().contains("too many signs"));
}

/// Nested definitions: definitions before their uses are evaluated before them.
#[test]
fn deep_definitions_are_refused() {
    let deep = |count: usize, sines: usize, down: bool| {
        let nested = |k: usize| {
            format!("let a{k} = {}a{}{};", "sin(".repeat(sines), k + 1, ")".repeat(sines))
        };
        let mut lets: Vec<String> = (0..count).map(nested).collect();
        if !down {
            lets.reverse();
        }
        let (before, after) = if down { ("", "let a_last = q;") } else { ("let a_last = q;", "") };
        let lets = lets.concat().replace(&format!("a{count}"), "a_last");
        super::refusals(&format!(
            "struct S {{ m }} coordinate q; kinetic = m*q_dot^2; {before} {lets} {after} potential = a0;"
        ))
    };
    let message = "definitions within definitions are nested too deeply here; write each `let` above its uses, and call fewer functions by functions";
    assert_eq!(deep(500, 4, true), [message]);
    assert_eq!(deep(60, 100, true), [message]);
    assert!(deep(400, 1, true).is_empty());
    assert!(deep(250, 4, false).is_empty());
    let message = "this unfolds to more than 1200 functions and operations within one another; write a shorter chain";
    assert_eq!(deep(500, 4, false), [message]);
}
