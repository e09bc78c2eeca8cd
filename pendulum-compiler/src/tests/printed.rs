//! Equations as text.

use super::golden::sources_of_blocks;
use super::{derive, in_latex};
use crate::backend::{names, unicode};
use crate::compile::compile;

/// Returns the equations of a block in Unicode and in LaTeX.
pub(super) fn printed(source: &str) -> [Vec<String>; 2] {
    derive(source, |model, graph, motion| {
        let names = names::Names::new(model, &crate::mechanics::lower::Energies::default());
        let sides = unicode::sides(graph, &names, motion);
        let latex = in_latex(graph, &names, motion, &sides);
        [unicode::equations(graph, &names, motion, &sides), latex]
    })
}

#[test]
fn powers_in_latex_hold_together() {
    for (force, expected) in [
        ("(c*q)^(5/2)", "\\left(c q\\right)^{5/2}"),
        ("(c/q)^(5/2)", "\\left(\\frac{c}{q}\\right)^{5/2}"),
        ("(2/3)^(1/3)", "\\left(\\frac{2}{3}\\right)^{1/3}"),
        ("2^(1/3)", "2^{1/3}"),
        ("q^(5/2)", "q^{5/2}"),
        ("(c + q)^3", "\\left(c + q\\right)^{3}"),
        ("abs(q)^3", "\\left|q\\right|^{3}"),
        ("sqrt(c*q)", "\\sqrt{c q}"),
        ("sin(q)^2", "\\sin^{2} q"),
    ] {
        let [_, latex] = printed(&format!(
            "struct S {{ c }} coordinate q; kinetic = q_dot^2/2; force q = {force};"
        ));
        assert_eq!(latex, [format!("\\ddot{{q}} = {expected}")], "{force}");
    }
}

/// A shared value is a single node of the graph, but its text is repeated for every use.
#[test]
fn what_is_too_long_is_not_written_out() {
    let shared: Vec<String> =
        (0..40).map(|k| format!("let a{} = sin(a{k})*exp(a{k});", k + 1)).collect();
    let chain: Vec<String> = (0..1000).map(|k| format!("let a{} = sin(a{k});", k + 1)).collect();
    for (lets, last) in [(shared.concat(), "a40"), (chain.concat(), "a1000")] {
        let block = format!(
            "struct S {{ m }} coordinate q; coordinate z; coordinate w; let a0 = q; {lets} kinetic = (q_dot^2 + w_dot^2 + w_dot*z_dot + z_dot^2)/2;"
        );
        let [text, latex] = printed(&format!("{block} potential = {last} + w;"));
        assert_eq!(text[0], "q_ddot = ... (too long to write out)");
        assert_eq!(latex[0], "\\ddot{q} = \\ldots\\text{ (too long to write out)}");
        assert_eq!(
            (&text[1][..], &latex[1][..]),
            ("z_ddot + (1/2)*w_ddot = 0", "\\ddot{z} + \\frac{1}{2} \\ddot{w} = 0")
        );
        let [text, latex] = printed(&format!("{block} force z = {last};"));
        assert_eq!((&text[0][..], &latex[0][..]), ("q_ddot = 0", "\\ddot{q} = 0"));
        assert_eq!(text[1], "z_ddot = ... (too long to write out)");
        assert_eq!(latex[1], "\\ddot{z} = \\ldots\\text{ (too long to write out)}");
    }
}

/// A term with opposite signs in two brackets is not printed.
#[test]
fn terms_cancel() {
    for (force, expected) in [
        ("(w + q)*q_dot^2 - w*q_dot^2 + b", "b + q*q_dot^2"),
        ("(w + b)*sin(q) - w*sin(q) + c*cos(q)", "b*sin(q) + c*cos(q)"),
        ("sin((w + q)*b - w*b + c)", "sin(c + b*q)"),
        ("b/((w + q)*q_dot - w*q_dot + c)", "b/(c + q*q_dot)"),
        // No two terms have the same factors, or the expansion is longer.
        ("(w + q)*(b + q_dot) + c", "c + b*(w + q) + q_dot*(w + q)"),
        ("(w + q)^2*(b + sin(q)) + c", "c + (w + q)^2*(b + sin(q))"),
    ] {
        let [text, latex] = printed(&format!(
            "struct S {{ w, b, c }} coordinate q; kinetic = q_dot^2/2; force q = {force};"
        ));
        assert_eq!(text, [format!("q_ddot = {expected}")], "{force}");
        assert_eq!(latex[0].contains('w'), expected.contains('w'), "{force}: {latex:?}");
    }
}

/// Equations of a block in ASCII can be parsed and are then printed identically.
#[test]
fn what_is_printed_in_ascii_can_be_read() {
    let bare = "struct S { a, b, c } coordinate q; driven x;";
    let units = "struct S { y: [1; 4] } coordinate q: 1; driven x: [1; 2];";
    for (declarations, force) in [
        (bare, "-a*sin(q)/b"),
        (bare, "(a + q_dot)^2/(b*c^3)*q"),
        (bare, "sqrt(a + q^2) - 2^(1/3)*(a*q)^(5/2)/3"),
        (bare, "-(a - q)*abs(q - t)^3*x_ddot - x_dot^(-2)"),
        (bare, "exp(-q/2)*(1 + q^2)^(-3/2) + tanh(sin(q)^2)"),
        (bare, "atan2(a, q)*max(b, -q) - pi*sign(q)/7"),
        (units, "x_ddot.x*y[1]*cos(q - x.y) - x_dot.y^2/(1 + y[0])"),
    ] {
        let block = |force: &str| format!("{declarations} kinetic = q_dot^2/2; force q = {force};");
        let [first, _] = printed(&block(force));
        assert!(first[0].is_ascii(), "{first:?}");
        let right = first[0].strip_prefix("q_ddot = ").unwrap();
        assert_eq!(printed(&block(right))[0], first, "{force}");
    }
    let [first, _] = printed(&format!("{bare} kinetic = q_dot^2/2; potential = a*max(0, q)^3;"));
    let right = first[0].strip_prefix("q_ddot = ").unwrap();
    assert_eq!(right, "-3*a*max(0, q)^2*((1 + sign(q))/2)");
    printed(&format!("{bare} kinetic = q_dot^2/2; force q = {right};"));
}

/// If a single name is not ASCII, the equations are in Unicode. Comments do not count.
#[test]
fn a_block_in_ascii_is_printed_in_ascii() {
    for (block, expected) in [
        (
            "struct P { L, g } coordinate theta; kinetic = L*theta_dot^2/2; potential = -g*cos(theta);",
            "theta_ddot = -g*sin(theta)/L",
        ),
        (
            "/** α */ struct P { L, g } coordinate x; kinetic = L*x_dot^2/2; potential = g*x^4;",
            "x_ddot = -4*g*x^3/L",
        ),
        (
            "struct P { L, g } coordinate θ; kinetic = L*theta_dot^2/2; potential = -g*cos(θ);",
            "θ̈ = −g·sin θ/L",
        ),
        ("struct P { L, g } coordinate x; kinetic = L*ẋ^2/2; potential = g*x^4;", "ẍ = −4·g·x³/L"),
    ] {
        assert_eq!(printed(block)[0], [expected]);
    }
}

/// Returns the equation of a block in MathML, with spaces in place of their elements.
fn drawn(block: &str) -> String {
    let compiled = compile(block).unwrap_or_else(|messages| panic!("{messages:?}"));
    let text = compiled.mathml[0].strip_prefix("<math displaystyle=\"true\">").unwrap();
    text.strip_suffix("</math>").unwrap().replace("<mspace width=\"0.17em\"/>", " ")
}

#[test]
fn dots_stand_over_their_letter() {
    assert_eq!(
        drawn("struct S { g, L } coordinate θ; kinetic = L^2*θ̇^2/2; potential = -g*L*cos(θ);"),
        "<mover><mrow><mi>θ</mi></mrow><mo>..</mo></mover><mo>=</mo><mo form=\"prefix\">−</mo>\
         <mfrac><mrow><mrow><mi>g</mi> <mi>sin</mi> <mi>θ</mi></mrow><mspace depth=\"0.25em\"/>\
         </mrow><mrow><mspace height=\"0.9em\"/><mrow><mi>L</mi></mrow></mrow></mfrac>"
    );
}

#[test]
fn exponents_and_indices_belong_to_the_element_before() {
    let found = drawn(
        "struct S { m, l: [_; 4] } coordinate x; kinetic = x_dot^2/2; \
         force x = m*l[0]^2*sin(2*x)^2;",
    );
    let (_, right) = found.split_once("<mo>=</mo>").unwrap();
    assert_eq!(
        right,
        "<mi>m</mi> <msubsup><mrow><mi>l</mi></mrow><mrow><mn>0</mn></mrow>\
         <mrow><mn>2</mn></mrow></msubsup> \
         <msup><mrow><mi>sin</mi></mrow><mrow><mn>2</mn></mrow></msup><mrow>\
         <mo stretchy=\"true\">(</mo><mn>2</mn> <mi>x</mi><mo stretchy=\"true\">)</mo></mrow>"
    );
}

/// The elements are balanced in every equation of the golden files.
#[test]
fn the_equations_of_the_golden_files_are_well_formed() {
    let mut count = 0;
    for block in sources_of_blocks() {
        let compiled = compile(&block).unwrap_or_else(|messages| panic!("{messages:?}"));
        for (line, drawn) in compiled.latex.iter().zip(&compiled.mathml) {
            let mut open: Vec<&str> = Vec::new();
            for tag in drawn.split('<').skip(1).filter_map(|part| part.split('>').next()) {
                let name = tag.split(' ').next().unwrap();
                match name.strip_prefix('/') {
                    Some(name) => assert_eq!(open.pop(), Some(name), "{line}"),
                    None if tag.ends_with('/') => {}
                    None => open.push(name),
                }
            }
            assert!(open.is_empty() && !drawn.contains('\\'), "{line}\n{drawn}");
            // The numbers of dots and fractions are those of LaTeX.
            let dots = line.matches("dot{").count();
            assert_eq!(drawn.matches("<mover").count(), dots, "{line}");
            let fractions = line.matches("\\frac{").count();
            assert_eq!(drawn.matches("<mfrac>").count(), fractions, "{line}");
            count += 1;
        }
    }
    assert!(30 < count, "{count}");
}

/// The coefficient is too long for exact arithmetic, so that it is a product of numbers.
#[test]
fn a_negative_factor_stands_in_brackets() {
    let compiled = compile(
        "struct S {} coordinate x; kinetic = x_dot^2/2; potential = \
         3.14159265358979323846264338327950*x - 123456789012345678901234567*x/98765432109876543210;",
    );
    let latex = &compiled.unwrap_or_else(|messages| panic!("{messages:?}")).latex[0];
    assert!(latex.contains(" \\left(-\\frac{123456789012345678901234567}"), "{latex}");
}

#[test]
fn long_values_of_outputs_are_not_written_out() {
    let compiled = compile(
        "struct S { B: solid, a: [m; 3] } coordinate x: [m; 3]; coordinate R: rotation;
         kinetic = integral(p in B, |dot(x + R*p)|^2)/2;
         output acceleration: [m/s^2; 3] = dot(dot(x + R*a));
         output momentum: kg*m/s = B.mass*dot(x).x;",
    );
    let compiled = compiled.unwrap_or_else(|messages| panic!("{messages:?}"));
    let [long, short] = &compiled.outputs[..] else { panic!() };
    for value in &long.expressions {
        assert!(value.ends_with("(too long to write out)"), "{value}");
    }
    assert!(short.expressions[0].contains("B.mass"), "{:?}", short.expressions);
}
