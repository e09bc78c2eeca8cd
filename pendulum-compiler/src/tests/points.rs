//! Forces on points, beside the generalized forces that they are.

use super::refusals;
use super::vectors::{distance, values};

/// Checks that two lists of statements are one system.
fn same(start: &str, points: &str, coordinates: &str) {
    let [found, expected] = [points, coordinates].map(|rest| values(&format!("{start} {rest}")));
    assert!(distance(&found, &expected) < 1e-13, "{points}: {found:?} {expected:?}");
    let without = values(start);
    assert!(0.01 < distance(&found, &without), "{points} does nothing");
}

const PENDULUM: &str = "struct P { m, l, g } coordinate α; coordinate β; input u: [_; 2];
    let a = l*[sin(α), -cos(α)]; let b = a + 2*l*[sin(β), -cos(β)];
    kinetic = m/2*(|ȧ|^2 + |ḃ|^2); potential = m*g*(a.y + b.y);";

#[test]
fn a_force_at_a_point_acts_on_every_coordinate_that_moves_it() {
    same(
        PENDULUM,
        "force b = [3*g, t*β̇];",
        "force α = l*(3*g*cos(α) + t*β̇*sin(α)); force β = 2*l*(3*g*cos(β) + t*β̇*sin(β));",
    );
    same(PENDULUM, "force a = u;", "force α = l*(u.x*cos(α) + u.y*sin(α));");
    same(PENDULUM, "force b.y = g;", "force α = l*g*sin(α); force β = 2*l*g*sin(β);");
}

#[test]
fn a_force_on_a_difference_acts_on_both() {
    same(PENDULUM, "force (β - α) = g;", "force β = g; force α = -g;");
    same(PENDULUM, "force β - α = g;", "force β = g; force α = -g;");
    same(PENDULUM, "force -2*α = g;", "force α = -2*g;");
}

#[test]
fn a_force_has_the_moment_of_its_arm() {
    let drone = "struct D { m, J, l, g } coordinate x: [_; 2]; coordinate φ; input f: [_; 4];
        let r(p) = x + cis(φ)*p; let d = [-sin(φ), cos(φ)];
        kinetic = m/2*|ẋ|^2 + J/2*φ̇^2; potential = m*g*x.y;";
    same(
        drone,
        "force r([l, 0]) = f[0]*d; force r([-2*l, 0]) = f[3]*d;",
        "force x.x = (f[0] + f[3])*d.x; force x.y = (f[0] + f[3])*d.y;
         force φ = l*(f[0] - 2*f[3]);",
    );
    same(drone, "force x = f[1]*d;", "force x.x = f[1]*d.x; force x.y = f[1]*d.y;");
}

#[test]
fn every_member_of_a_family_has_its_force() {
    let chain = "struct C { m, g } coordinate θ[3];
        let y[k in 0..3] = sum(j in 0..=k, [sin(θ[j]), -cos(θ[j])]);
        kinetic = sum(k in 0..3, m/2*|ẏ[k]|^2);";
    let pull = "force y[k in 0..3] = [(k + 1)*g, g*t];";
    same(
        chain,
        pull,
        "force θ[j in 0..3] = sum(k in 0..3, max(0, sign(k + 1/2 - j))
            *((k + 1)*g*cos(θ[j]) + g*t*sin(θ[j])));",
    );
    same(chain, pull, "force y[0] = [g, g*t]; force y[1] = [2*g, g*t]; force y[2] = [3*g, g*t];");
    let beads =
        "struct C { m, g } coordinate x[3]: [_; 2]; kinetic = m/2*sum(k in 0..3, |ẋ[k]|^2);";
    same(beads, "force x[k in 1..3] = [k*g, g];", "force x[1] = [g, g]; force x[2] = [2*g, g];");
    same(beads, "force x[1] = [g, 3*g];", "force x[1].x = g; force x[1].y = 3*g;");
}

#[test]
fn a_motion_that_is_driven_does_not_change_the_force() {
    let cart =
        "struct C { m, l, g } coordinate θ; driven x: [_; 2]; let y = x + l*[sin(θ), -cos(θ)];
        kinetic = m/2*|ẏ|^2;";
    same(cart, "force y = [g, 0];", "force θ = l*g*cos(θ);");
}

#[rustfmt::skip]
const REFUSED: &[(&str, &str)] = &[
    ("force y = F;",              "`F` is a scalar, but `y` is a plane vector; both have one shape"),
    ("force θ = [F, F]*L;",       "`[F, F]*L` is a plane vector, but a scalar is needed here; write `inner(u, v)`, `|u|` or a component"),
    ("force y = [F, F, F];",      "`[F, F, F]` is a space vector, but `y` is a plane vector; both have one shape"),
    ("force y = [F*L, 0];",       "`[F*L, 0]` is kg·m²/s², but a force on `y` is kg·m/s², an energy per unit of `y`"),
    ("force y.x = F*L;",          "`F*L` is kg·m²/s², but a force on `y.x` is kg·m/s², an energy per unit of `y.x`"),
    ("force (θ - 1) = F;",        "`F` is kg·m/s², but a force on `θ - 1` is kg·m²/s², an energy per unit of `θ - 1`"),
    ("force dot(y) = [F, F];",    "`dot(y)` contains a velocity, and a force acts on a position; write what moves with it"),
    ("force (x + [t, 0]*w) = [F, F];", "no coordinate moves `x + [t, 0]*w`, so a force does nothing there; write a coordinate or an expression of coordinates"),
    ("force 2 = F;",              "no coordinate moves `2`, so a force does nothing there; write a coordinate or an expression of coordinates"),
    ("force u*θ = L;",            "`u` has no derivative; declare it `driven`"),
    ("force x = [F, F];",         "`x` is no coordinate; a force acts on a coordinate, as in `force θ = …;`"),
    ("force θ̇ = F;",              "`θ̇` is no coordinate; a force acts on a coordinate, as in `force θ = …;`"),
    ("force yy = [F, F];",        "unknown coordinate `yy`; declare it, as in `coordinate yy: m;`"),
    ("force y + z = [F, F];",     "unknown name `z`; declare it as a parameter, a coordinate, an input or with `let`"),
    ("force φ = F;",              "`φ` is a family; write `φ[k]`, or `φ[k in 0..2]` for all"),
    ("force φ[2] = F*L;",         "index 2 is out of range; `φ` has 2 members, `φ[0]` to `φ[1]`"),
    ("force φ[k in 0..3] = F*L;", "index 2 is out of range; `φ` has 2 members, `φ[0]` to `φ[1]`"),
    ("force θ[0] = F*L;",         "`θ` is a scalar, it has no members; leave out the index"),
    ("force y[0] = F; force y[1] = F*L;", "`F*L` is kg·m²/s², but a force on `y[1]` is kg·m/s², an energy per unit of `y[1]`"),
    ("force = F;",                "what it acts on is missing; write `force θ = …;` with a coordinate or a point, also for the torque about an angle θ"),
];

#[test]
fn a_force_fits_its_point() {
    for (statements, expected) in REFUSED {
        let source = format!(
            "struct P {{ m: kg, L: m, F: N, w: m/s }} coordinate θ: rad; coordinate φ[2]: rad;
             driven x: [m; 2]; input u: N; let y = x + L*[sin(θ), -cos(θ)];
             kinetic = m/2*(|ẏ|^2 + L^2*(φ̇[0]^2 + φ̇[1]^2)); {statements}"
        );
        assert_eq!(refusals(&source), [*expected], "{statements}");
    }
}
