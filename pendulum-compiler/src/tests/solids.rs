//! Solids in space as parameters: integrals over them and their properties.

use super::refusals;
use super::{derive, evaluate};
use crate::algebra::diff;
use crate::algebra::expr::{Graph, Moment, Symbol};
use crate::model::Quantity;

/// Four points with their masses.
const POINTS: [(f64, [f64; 3]); 4] = [
    (1.0, [0.5, 0.25, -1.0]),
    (2.0, [-0.75, 1.5, 0.5]),
    (0.5, [1.25, -0.5, 2.0]),
    (3.0, [0.125, 0.75, 0.375]),
];

/// Returns mass, centre and central moments of the points, in the order of the scalars of a solid.
fn moments() -> Vec<f64> {
    let mass: f64 = POINTS.iter().map(|(m, _)| m).sum();
    let center = [0, 1, 2].map(|k| POINTS.iter().map(|(m, p)| m * p[k]).sum::<f64>() / mass);
    let central = |i: usize, k: usize| {
        POINTS.iter().map(|(m, p)| m * (p[i] - center[i]) * (p[k] - center[k])).sum::<f64>()
    };
    let pairs = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];
    let central = pairs.map(|[i, k]| central(i, k));
    [&[mass][..], &center, &central].concat()
}

/// Returns the value of a moment of a solid about the origin.
fn moment(moment: Moment, of: &[f64]) -> f64 {
    let second = |place: usize, i: usize, k: usize| of[4 + place] + of[0] * of[1 + i] * of[1 + k];
    match moment {
        Moment::About(axis) => {
            (0..3).filter(|&k| k != usize::from(axis)).map(|k| second(k, k, k)).sum()
        }
        Moment::Mixed(pair) => {
            let [i, k] = Moment::PAIRS[usize::from(pair)];
            second(3 + usize::from(pair), i, k)
        }
        other => panic!("{other:?}"),
    }
}

/// Returns the accelerations and the energy of a block, whose first parameter may be the solid of
/// the points, at fixed values of all symbols.
fn values(source: &str) -> Vec<f64> {
    let (solid, others) = (moments(), [9.75, 1.5]);
    derive(source, |model, graph, motion| {
        let own = model.parameters.first().filter(|first| first.is_body());
        let count = own.map_or(0, Quantity::count);
        let value = |symbol: Symbol| match symbol {
            Symbol::Parameter(index) if index < count => solid[index],
            Symbol::Parameter(index) => others[index - count],
            Symbol::Moment(0, own) => moment(own, &solid),
            Symbol::Coordinate(index) => 0.4 + index as f64 / 7.0,
            Symbol::Velocity(index) => 0.3 - index as f64 / 5.0,
            other => panic!("{other:?}"),
        };
        let roots = motion.accelerations.iter().chain([&motion.energy]);
        roots.map(|&root| evaluate(graph, root, &value)).collect()
    })
}

/// Three turns about x, y and z, and a shift.
const TURNS: &str = "coordinate α; coordinate β; coordinate γ; coordinate s;
    let a(p) = [p.x, cos(α)*p.y - sin(α)*p.z, sin(α)*p.y + cos(α)*p.z];
    let b(p) = [cos(β)*p.x + sin(β)*p.z, p.y, cos(β)*p.z - sin(β)*p.x];
    let c(p) = [cos(γ)*p.x - sin(γ)*p.y, sin(γ)*p.x + cos(γ)*p.y, p.z];
    let r(p) = c(b(a(p))) + [s, 0, 2*s];";

/// Checks that integrals over the solid give the same motion as sums over its points. Integrands
/// contain the point as the argument `(p)` of functions.
fn as_its_points(declarations: &str, kinetic: &str, potential: &str) {
    let of = |head: &str, sum: &dyn Fn(&str) -> String| {
        values(&format!(
            "struct P {{ {head} g, k }} {declarations} kinetic = {}; potential = {};",
            sum(kinetic),
            sum(potential)
        ))
    };
    let solid = of("B: solid,", &|body| format!("integral(p in B, {body})"));
    let points = of("", &|body| {
        let terms = POINTS.map(|(m, [x, y, z])| {
            format!("{m}*({})", body.replace("(p)", &format!("([{x}, {y}, {z}])")))
        });
        terms.join(" + ")
    });
    for (found, exact) in solid.iter().zip(&points) {
        assert!((found - exact).abs() < 1e-11 * exact.abs().max(1.0), "{solid:?} {points:?}");
    }
}

#[test]
fn a_solid_moves_as_the_points_of_which_it_is_made() {
    as_its_points(TURNS, "|dot(r(p))|^2/2", "g*height(r(p)) + k/2*|r(p)|^2");
}

#[test]
fn every_polynomial_of_degree_two_has_its_integral() {
    let declarations = "coordinate a; coordinate b;
        let r(p) = [(1 + a)*p.x + b*p.y, b*p.z - p.x + a*p.z, a*p.y - b*p.x];
        let w(p) = p;";
    as_its_points(
        declarations,
        "|dot(r(p))|^2/2",
        "k*(a*w(p).x^2 + b*w(p).y^2 + a^2*w(p).z^2 + a*b*w(p).x*w(p).y + a*w(p).x*w(p).z
            - b*w(p).y*w(p).z) + g*(a*w(p).x + b*w(p).y - w(p).z)*w(p).z/3",
    );
}

#[test]
fn the_energy_of_a_rotation_about_an_axis_is_one_term() {
    for (axis, name) in [("[φ̇, 0, 0]", "xx"), ("[0, φ̇, 0]", "yy"), ("[0, 0, φ̇]", "zz")] {
        let source = format!(
            "struct P {{ B: solid, k }} coordinate φ;
             kinetic = integral(p in B, |cross({axis}, p)|^2/2); potential = k*φ;"
        );
        let [lines, _] = super::printed::printed(&source);
        assert_eq!(lines, [format!("φ̈ = −k/B.inertia.{name}")]);
    }
}

#[test]
fn the_inertia_about_the_origin_is_that_of_the_integral() {
    let of = |kinetic: &str, potential: &str| {
        values(&format!(
            "struct P {{ B: solid, g, k }} coordinate α; coordinate β; coordinate γ;
             let ω = [α̇ + sin(β)*γ̇, cos(α)*β̇ - γ̇, β̇*sin(α + γ)]; let n = [α, β, γ];
             kinetic = {kinetic}; potential = {potential};"
        ))
    };
    let integral = of(
        "integral(p in B, |cross(ω, p)|^2/2)",
        "k*integral(p in B, |cross(n, p)|^2) + g*integral(p in B, inner(n, p))",
    );
    let matrix =
        of("inner(ω, B.inertia*ω)/2", "k*inner(n, B.inertia*n) + g*B.mass*inner(n, B.center)");
    for (found, exact) in matrix.iter().zip(&integral) {
        assert!((found - exact).abs() < 1e-12 * exact.abs().max(1.0), "{matrix:?} {integral:?}");
    }
}

#[test]
fn derivatives_of_moments_are_those_of_their_formulas() {
    let mut graph = Graph::new();
    let of = moments();
    let all = (0..3).map(Moment::About).chain((0..3).map(Moment::Mixed));
    for own in all {
        let id = graph.symbol(Symbol::Moment(0, own));
        for parameter in 0..10 {
            let slope = diff::derivative(&mut graph, id, Symbol::Parameter(parameter));
            let value = |symbol: Symbol| match symbol {
                Symbol::Parameter(index) => of[index],
                other => panic!("{other:?}"),
            };
            let found = evaluate(&graph, slope, &value);
            // Moments are linear in mass and central moments and quadratic in the centre, for which
            // central differences are exact.
            let shifted = |by: f64| {
                let mut of = of.clone();
                of[parameter] += by;
                moment(own, &of)
            };
            let exact = shifted(0.5) - shifted(-0.5);
            assert!((found - exact).abs() < 1e-12, "{own:?} {parameter}: {found} {exact}");
        }
    }
}

#[test]
fn what_a_solid_does_not_know_is_refused() {
    let of = |potential: &str| {
        refusals(&format!(
            "struct P {{ B: solid, k }} coordinate x: m; kinetic = B.mass/2*ẋ^2; potential = {potential};"
        ))
    };
    let cases = [
        (
            "k*integral(p in B, x*p.x*p.y*p.z)",
            "`x*p.x*p.y*p.z` is of higher degree than two in `p`, and a solid knows its moments up \
             to the second; write a polynomial of degree two or less",
        ),
        (
            "k*integral(p in B, x*sin(p.z))",
            "`x*sin(p.z)` is no polynomial in `p`, and a solid knows its moments up to the second; \
             write a polynomial of degree two or less",
        ),
        ("k*x*B.x", "unknown component `x`; there are `.mass`, `.center`, `.inertia`"),
        (
            "k*x*B",
            "`B` is a solid; write `B.mass`, `B.center`, `B.inertia` or `integral(p in B, …)`",
        ),
        (
            "k*x*B.center",
            "`k*x*B.center` is a space vector, but a scalar is needed here; write `inner(u, v)`, \
             `|u|` or a component",
        ),
    ];
    for (potential, expected) in cases {
        assert_eq!(of(potential), [expected], "{potential}");
    }
    assert_eq!(of("k*x*B.inertia").len(), 1);
    let coordinate = "struct P { m } coordinate q: solid; kinetic = m*q_dot^2;";
    assert_eq!(refusals(coordinate), ["a coordinate has a unit; write `rad` or `m`"]);
}

#[test]
fn units_of_a_solid_are_those_of_its_moments() {
    let of = |potential: &str| {
        refusals(&format!(
            "struct P {{ B: solid, g: m/s^2 }} coordinate x: m; kinetic = B.mass/2*ẋ^2; potential = {potential};"
        ))
    };
    assert_eq!(of("B.mass*g*(x + B.center.z)"), [""; 0]);
    assert_eq!(of("integral(p in B, g*(p.z + x))"), [""; 0]);
    assert_eq!(of("B.mass*g*x + B.mass").len(), 1);
    assert_eq!(of("B.mass*g*(x + B.mass)").len(), 1);
}
