//! Chains of N links from Cartesian input: the count of operations and the time of the expansion.

use super::derive;
use crate::schedule;

fn chain(n: usize) -> String {
    format!(
        "struct C {{ m: [kg; {n}], l: [m; {n}], g }} coordinate θ[{n}]; let y[k in 0..{n}] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
         kinetic = sum(k in 0..{n}, m[k]/2*|ẏ[k]|^2); potential = sum(k in 0..{n}, m[k]*g*height(y[k]));"
    )
}

/// Dense elimination by hand takes ≈ N³/3 multiplications (2 links 17, 3 links 47, 5 links 160, 10
/// links 845, 32 links 16 432, with 3, 6, 15, 55 and 528 divisions). The sparse form is used for
/// nine or more links; each further link then has the same cost.
#[test]
fn chains_grow_linearly() {
    let known = [
        (1, 1, 0, 0),
        (2, 17, 7, 2),
        (3, 44, 22, 5),
        (5, 141, 80, 14),
        (6, 213, 125, 20),
        (10, 304, 193, 9),
        (16, 496, 325, 15),
        (32, 1008, 677, 31),
    ];
    for (n, mul, add, div) in known {
        let count = derive(&chain(n), |_, graph, motion| {
            schedule::program(graph, &motion.accelerations).count()
        });
        assert!(
            count.mul <= mul && count.add <= add && count.div <= div && count.sincos == n,
            "{n} links: {count:?}"
        );
    }
}

#[test]
fn expansions_stay_small() {
    let tokens = |n| flat(crate::compile::expand(format!("::p; {}", chain(n)).parse().unwrap()));
    assert!(tokens(2) < 10_000);
    assert!(tokens(10) < 100_000);
}

fn flat(tokens: proc_macro2::TokenStream) -> usize {
    tokens
        .into_iter()
        .map(|token| match token {
            proc_macro2::TokenTree::Group(group) => 2 + flat(group.stream()),
            _ => 1,
        })
        .sum()
}

/// Long sums are expanded quickly, and blocks that would not compile in reasonable time are refused
/// before they are derived.
#[test]
#[ignore = "takes ten seconds: `.ci/run` runs it"]
fn long_sums_expand_or_are_refused() {
    let message = "this unfolds to more than 8000 different expressions; write a shorter sum";
    let endless = "this block unfolds to more than a million expressions; write shorter sums";
    let long = "the equations of this block are too long to be compiled in a few seconds; write \
                shorter sums or smaller families, or nest fewer functions";
    let cases = [
        ("", "sum(k in 0..1000, sin(k*θ))", None),
        ("", "sum(k in 0..1000, θ^k)", None),
        ("", "sum(k in 0..250, sin(k*θ)*θ^k)", None),
        ("", "sum(k in 0..1000, sin(k*θ)*θ^k)", Some(long)),
        ("", "height(sum(k in 0..1000, [sin(k*θ), cos(k*θ)]))", None),
        ("", "sum(k in 0..65536, sin(k*θ))", Some(message)),
        ("", "sum(k in 0..65536, θ^k)", Some(message)),
        ("let y[k in 0..500] = sum(j in 0..=k, sin(j*θ));", "y[499]", None),
        ("let y[k in 0..65536] = sum(j in 0..=k, sin(j*θ));", "y[65535]", Some(endless)),
    ];
    for (definitions, sum, refusal) in cases {
        let block = format!(
            "struct S {{ m }} coordinate θ; kinetic = m*θ̇^2; {definitions} potential = {sum};"
        );
        assert_eq!(super::refusals(&block), refusal.into_iter().collect::<Vec<_>>(), "{sum}");
    }
}

fn definitions(count: usize, next: &str) -> String {
    let lets =
        (0..count).map(|k| format!("let y{} = {};", k + 1, next.replace('#', &format!("y{k}"))));
    format!("let y0 = θ; {}", lets.collect::<String>())
}

/// A search for sums of angles that makes a product for each pair of factors has no work left for
/// the Jacobians.
#[test]
fn products_of_many_sines_are_searched_for_sums_of_angles_without_making_products() {
    let lets = definitions(18, "sin(#)*#");
    let block = format!("struct S {{ m }} coordinate θ; {lets} kinetic = m*θ̇^2; potential = y18;");
    assert!(derive(&block, |_, _, motion| motion.jacobians.is_some()));
}

/// An argument that is shared in the graph is repeated in its text for every use.
#[test]
fn long_arguments_are_not_written_out() {
    for next in ["tanh(#)*#", "tanh(#/0.01) + #", "abs(# - 1) + #/2"] {
        let lets = definitions(14, next);
        let block =
            format!("::p; struct S {{ m }} coordinate θ; {lets} kinetic = m*θ̇^2; force θ = y14;");
        let text = crate::compile::expand(block.parse().unwrap()).to_string();
        assert!(text.contains("… (too long to write out)"), "{next}");
        assert!(text.len() < 100_000, "{next}: {}", text.len());
    }
}

/// Bodies in a plane, each of which attracts every other one.
fn bodies(n: usize) -> String {
    format!(
        "struct B {{ m, G }} coordinate x[{n}]; coordinate y[{n}]; \
         kinetic = m/2*sum(i in 0..{n}, ẋ[i]^2 + ẏ[i]^2); \
         potential = -G*sum(i in 0..{n}, sum(j in i+1..{n}, 1/|[x[i] - x[j], y[i] - y[j]]|));"
    )
}

/// What is beyond the limit is zero, and a coordinate without inertia is no second mistake.
#[test]
fn blocks_that_are_too_long_get_one_message() {
    let pushed = "struct S { m } coordinate x[100]; kinetic = m*sum(i in 0..100, ẋ[i]^2); \
                  force x[i in 0..100] = sum(j in 0..100, sin(x[i] - x[j])*ẋ[j]);";
    let seen = "struct S { m } coordinate x[100]; kinetic = m*sum(i in 0..100, ẋ[i]^2); \
                output e[i in 0..100] = sum(j in 0..100, cos(x[i]*(2 + x[j])));";
    let coupled = "struct S { m } coordinate x[40]; kinetic = m*sum(i in 0..40, ẋ[i]^2) \
                   + m*sum(i in 0..40, sum(j in 0..40, ẋ[i]*ẋ[j]*cos(x[i] - x[j])))/40;";
    for block in
        [chain(34), chain(60), chain(100), bodies(50), pushed.into(), seen.into(), coupled.into()]
    {
        let messages = super::refusals(&block);
        assert_eq!(messages.len(), 1, "{messages:?}: {block}");
        let long = ["millions of expressions", "too long to be compiled in a few seconds"];
        assert!(long.iter().any(|text| messages[0].contains(text)), "{messages:?}: {block}");
    }
}

/// The square of a link's speed is a long polynomial in the velocities, and its root is none: for
/// no force is it multiplied out, which alone would go through more operands than are allowed.
#[test]
fn roots_of_long_polynomials_are_not_multiplied_out() {
    let block = format!("{} force y[k in 0..30] = -m[k]/l[k]*|ẏ[k]|*ẏ[k];", chain(30));
    let messages = super::refusals(&block);
    assert_eq!(messages.len(), 1, "{messages:?}");
    assert!(messages[0].contains("too long to be compiled in a few seconds"), "{messages:?}");
}

#[test]
fn pairs_of_twenty_bodies_are_short_enough() {
    assert!(derive(&bodies(20), |_, _, motion| motion.accelerations.len() == 40));
}

/// The text of each equation is bounded, and so is that of all equations together.
#[test]
fn long_equations_of_many_coordinates_are_not_all_written_out() {
    let block = "struct S { m } coordinate x[100]; kinetic = m*sum(i in 0..100, ẋ[i]^2); \
                 let s = sum(j in 0..100, sin(x[j])); force x[i in 0..100] = s*x[i];";
    let compiled = crate::compile::compile(block).unwrap();
    let short = compiled.equations.iter().filter(|line| line.contains("too long")).count();
    assert!((1..100).contains(&short), "{short} of 100");
    for written in [&compiled.equations, &compiled.latex, &compiled.mathml] {
        let text: usize = written.iter().map(String::len).sum();
        assert!(text < 2_000_000, "{text}");
    }
}

/// Few lines that unfold to much are derived at once or refused at once. A second in an optimized
/// build is a few seconds here.
#[test]
#[ignore = "takes ten seconds: `.ci/run` runs it"]
fn few_lines_take_little_time() {
    let nested =
        |n: usize, open: &str, close: &str| format!("{}θ{}", open.repeat(n), close.repeat(n));
    let pairs = |n: usize, term: &str| {
        format!(
            "struct S {{ m }} coordinate x[{n}]; kinetic = m*sum(k in 0..{n}, ẋ[k]^2); \
             potential = sum(j in 0..{n}, sum(i in 0..{n}, {term}));"
        )
    };
    let one = |definitions: &str, potential: &str| {
        format!(
            "struct S {{ m }} coordinate θ; {definitions} kinetic = m*θ̇^2; potential = {potential};"
        )
    };
    let blocks = [
        one("", &nested(30, "sin(", ")")),
        one("", &nested(100, "sin(", ")")),
        one("", &nested(100, "exp(sin(", "))")),
        one("", &nested(60, "1/(1 + (", ")^2)")),
        one("", &nested(60, "sqrt(1 + (", ")^2)")),
        one("", &nested(60, "(1 + ", ")^2")),
        one(&definitions(40, "sin(#)*#"), "y40"),
        one(&definitions(40, "# + sin(#)"), "y40"),
        one(&definitions(40, "#/(1 + #^2)"), "y40"),
        pairs(500, "cos(x[j] - x[i])"),
        pairs(1024, "cos(x[j] - x[i])"),
        pairs(500, "2*cos(x[j] - x[i])"),
        pairs(500, "(x[j] - x[i])^2"),
        "struct S { m, k } coordinate x[500]; kinetic = m/2*sum(i in 0..500, ẋ[i]^2); \
         potential = k/2*sum(i in 0..500, x[i]^2);"
            .into(),
        one(&definitions(18, "sin(#)*#"), "y18"),
        one(&definitions(18, "abs(# - 1) + #/2"), "y18"),
        one(&definitions(18, "max(#, min(1 - #, #^2))"), "y18"),
    ];
    for block in blocks {
        let start = std::time::Instant::now();
        let messages = super::refusals(&block);
        let time = start.elapsed().as_secs_f64();
        assert!(messages.len() < 2 && time < 20.0, "{time} s: {messages:?}: {block}");
    }
}
