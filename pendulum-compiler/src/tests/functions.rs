//! Every row of the table of functions: its columns, and the coverage by other tests.

use super::{Random, derive, evaluate, in_latex, lowered, refusals};
use crate::algebra::diff::derivative;
use crate::algebra::expr::{Graph, Id, Node, Symbol};
use crate::algebra::functions::{Function, Kinks, Parity, Row, UnitRule, Word};
use crate::backend::names::Names;
use crate::backend::unicode::{self, Side};
use pendulum_runtime::scalar::Dual;
use std::collections::BTreeSet;

/// Returns arguments in the domain of a function, away from its ends and from a kink at zero.
fn arguments(function: Function) -> Vec<f64> {
    let Row { domain: [least, greatest], kinks, .. } = function.row();
    let (least, greatest) = (least.max(-4.0), greatest.min(4.0));
    let (middle, half) = (f64::midpoint(least, greatest), 0.45 * (greatest - least));
    let mut random = Random(29);
    let all = (0..200).map(|_| random.uniform(middle - half, middle + half));
    all.filter(|x| kinks == Kinks::Smooth || 0.01 < x.abs()).collect()
}

/// Returns f(a) of the free scalar a.
fn call(graph: &mut Graph, function: Function) -> Id {
    let a = graph.symbol(Symbol::Parameter(0));
    graph.call(function, a)
}

/// Returns `true` if the difference of two numbers is at most `tolerance` times the larger
/// magnitude or one.
fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * 1f64.max(a.abs()).max(b.abs())
}

#[test]
fn values_are_those_of_the_runtime() {
    for &function in Function::ALL {
        for x in arguments(function) {
            let (folded, computed) = (function.value(x), function.of(x));
            assert!(close(folded, computed, 1e-14), "{function:?} of {x}: {folded}, {computed}");
        }
    }
}

/// The first, second and third derivatives in the graph agree with those of dual numbers.
#[test]
fn derivatives_are_those_of_dual_numbers() {
    type Thrice = Dual<Dual<Dual<f64>>>;
    for &function in Function::ALL {
        let mut graph = Graph::new();
        let mut slopes = vec![call(&mut graph, function)];
        for order in 0..3 {
            slopes.push(derivative(&mut graph, slopes[order], Symbol::Parameter(0)));
        }
        for x in arguments(function) {
            let value = function.of(Thrice::variable(Dual {
                value: Dual::variable(x),
                derivative: Dual::constant(1.0),
            }));
            let expected = [
                value.value.value.value,
                value.value.value.derivative,
                value.value.derivative.derivative,
                value.derivative.derivative.derivative,
            ];
            for (order, (&slope, expected)) in slopes.iter().zip(expected).enumerate() {
                let found = evaluate(&graph, slope, &|_| x);
                assert!(
                    close(found, expected, 1e-10),
                    "derivative {order} of {function:?} at {x}: {found}, not {expected}"
                );
            }
        }
    }
}

#[test]
fn derivatives_are_the_limits_of_differences() {
    for &function in Function::ALL {
        let mut graph = Graph::new();
        let value = call(&mut graph, function);
        let slope = derivative(&mut graph, value, Symbol::Parameter(0));
        for x in arguments(function) {
            let (at, h) = (|x: f64| function.value(x), 1e-4);
            let difference =
                (8.0 * (at(x + h) - at(x - h)) - (at(x + 2.0 * h) - at(x - 2.0 * h))) / (12.0 * h);
            let found = evaluate(&graph, slope, &|_| x);
            assert!(close(found, difference, 1e-7), "{function:?}′({x}): {found}, {difference}");
        }
    }
}

#[test]
fn values_stay_in_their_range() {
    for &function in Function::ALL {
        let [least, greatest] = function.row().range;
        for x in arguments(function) {
            let y = function.value(x);
            assert!(least <= y && y <= greatest, "{function:?} of {x} is {y}");
        }
    }
}

#[test]
fn values_at_zero_and_parities_are_those_of_the_values() {
    for &function in Function::ALL {
        let Row { at_zero, parity, domain, .. } = function.row();
        let mut graph = Graph::new();
        let zero = graph.call(function, Graph::ZERO);
        if let Some(value) = at_zero {
            assert_eq!(zero, graph.number(value), "{function:?} of 0");
        }
        if domain[0] < 0.0 {
            let expected = function.value(0.0);
            assert!(close(evaluate(&graph, zero, &|_| f64::NAN), expected, 1e-15), "{function:?}");
        }
        let value = call(&mut graph, function);
        let (a, minus_value) = (graph.symbol(Symbol::Parameter(0)), graph.negative(value));
        let minus = graph.negative(a);
        let opposite = graph.call(function, minus);
        match parity {
            Parity::Odd => assert_eq!(opposite, minus_value, "{function:?}"),
            Parity::Even => assert_eq!(opposite, value, "{function:?}"),
            Parity::Neither => assert!(matches!(graph.node(opposite), Node::Call(..))),
        }
        for x in arguments(function) {
            let (left, right) = (function.value(-x), function.value(x));
            match parity {
                Parity::Odd => assert_eq!(left, -right, "{function:?} of {x}"),
                Parity::Even => assert_eq!(left, right, "{function:?} of {x}"),
                Parity::Neither => {}
            }
        }
    }
}

/// Values jump at jumps, slopes jump at corners, and there are no other jumps.
#[test]
fn kinks_are_at_zero() {
    for &function in Function::ALL {
        let Row { kinks, domain, .. } = function.row();
        let mut graph = Graph::new();
        let value = call(&mut graph, function);
        let slope = derivative(&mut graph, value, Symbol::Parameter(0));
        let middle = if domain[0] < 0.0 { 0.0 } else { 1.0 };
        let jump = |id: Id| {
            let at = |x: f64| evaluate(&graph, id, &|_| x);
            (at(middle + 1e-9) - at(middle - 1e-9)).abs() > 0.1
        };
        let expected = match kinks {
            Kinks::Smooth => [false, false],
            Kinks::Corner => [false, true],
            Kinks::Jump => [true, false],
        };
        assert_eq!([jump(value), jump(slope)], expected, "{function:?}");
    }
}

/// Every function is printed in every notation of equations.
#[test]
fn equations_show_every_function() {
    for word in Word::all().filter(|word| word.is_scalar()) {
        let call = call_of(word);
        for (x, dot) in [("θ", "θ̇"), ("theta", "theta_dot")] {
            let source = format!(
                "struct S {{ b }} coordinate {x}; kinetic = {dot}^2/2; let a = {x}/3; force {x} = {call};"
            );
            let [lines, latex] = derive(&source, |model, graph, motion| {
                let names = Names::new(model, &crate::mechanics::lower::Energies::default());
                let sides = [Side::Own];
                [
                    unicode::equations(graph, &names, motion, &sides),
                    in_latex(graph, &names, motion, &sides),
                ]
            });
            assert_eq!((lines.len(), latex.len()), (1, 1));
            for line in [&lines[0], &latex[0]] {
                let (_, right) = line.split_once(" = ").unwrap();
                assert!(!right.is_empty() && right != "0", "{source}: {line}");
                assert_eq!(right.matches('{').count(), right.matches('}').count(), "{line}");
                assert_eq!(right.matches('(').count(), right.matches(')').count(), "{line}");
            }
            assert!(x == "θ" || lines[0].is_ascii(), "{source}: {}", lines[0]);
        }
    }
}

/// Returns the call of a function with the arguments a and b.
fn call_of(word: Word) -> String {
    format!("{}({})", word.name, ["a", "b"][..word.arity()].join(", "))
}

/// Equations in ASCII are expressions of the language.
#[test]
fn equations_in_ascii_are_read_back() {
    for &function in Function::ALL {
        let mut graph = Graph::new();
        let mut id = call(&mut graph, function);
        for order in 0..3 {
            let text = derive(
                "struct S { a } coordinate q; kinetic = q_dot^2/2; potential = 0;",
                |model, _, _| {
                    unicode::expression(
                        &graph,
                        &Names::new(model, &crate::mechanics::lower::Energies::default()),
                        id,
                    )
                },
            );
            let mut own = Graph::new();
            let read = lowered(&mut own, &text);
            for x in arguments(function) {
                let (found, expected) =
                    (evaluate(&own, read, &|_| x), evaluate(&graph, id, &|_| x));
                assert!(
                    close(found, expected, 1e-9),
                    "{text}, derivative {order}, at {x}: {found}, {expected}"
                );
            }
            id = derivative(&mut graph, id, Symbol::Parameter(0));
        }
    }
}

#[test]
fn every_function_is_lowered() {
    for word in Word::all().filter(|word| word.is_scalar()) {
        let mut graph = Graph::new();
        let root = lowered(&mut graph, &call_of(word));
        assert!(!graph.symbols(&[root]).is_empty(), "{}", word.name);
    }
}

/// Lengths are refused where pure numbers or a common unit are required.
#[test]
fn units_are_checked() {
    for word in Word::all().filter(|word| word.is_scalar()) {
        let block = |argument: &str, other: &str| {
            let arguments = [argument, other][..word.arity()].join(", ");
            refusals(&format!(
                "struct S {{ m: kg, L: m, k: N/m }} coordinate x: m; kinetic = m/2*ẋ^2; potential = k*L^2*({0}({arguments}) + {0}({arguments}));",
                word.name
            ))
        };
        let pure = block("x/L", "1");
        assert!(pure.is_empty(), "{}: {pure:?}", word.name);
        let lengths = block("x", "L").join(" ");
        let pure = format!("the argument of `{}` is a pure number", word.name);
        match word.units {
            UnitRule::Any | UnitRule::Ratio => assert_eq!(lengths, "", "{}", word.name),
            UnitRule::Pure => assert!(lengths.contains(&pure), "{}: {lengths}", word.name),
            _ => assert_ne!(lengths, "", "{}", word.name),
        }
    }
}

/// The series of generated systems are tested in the crate that generates them. This test searches
/// the text of those tests.
#[test]
fn the_series_of_every_function_is_tested() {
    let tested = include_str!("../../../tests/language/jets.rs");
    for word in Word::all().filter(|word| word.is_scalar()) {
        assert!(
            tested.contains(&format!("{}(", word.name)),
            "tests/language/jets.rs has no {}",
            word.name
        );
    }
}

/// The page on the language lists every word.
#[test]
fn every_function_is_in_the_guide() {
    let guide = include_str!("../../../pendulum-core/src/language.md");
    let words: BTreeSet<&str> =
        guide.split(|letter: char| !letter.is_alphanumeric() && letter != '_').collect();
    for word in Word::all() {
        assert!(words.contains(word.name), "language.md has no {}", word.name);
    }
}

#[test]
fn every_function_is_there_once() {
    let names: BTreeSet<&str> = Word::all().map(|word| word.name).collect();
    assert_eq!(names.len(), Word::all().count());
}
