//! Constraints and limits: shapes, equations, units, refusals.

use super::refusals;
use crate::backend::compiled::Compiled;
use crate::compile::compile;

/// Returns a block with a bob in Cartesian coordinates, beads around it and a driven point.
fn block(statements: &str) -> String {
    format!(
        "struct P {{ m: kg, L: m, g: m/s^2, e: 1 }} coordinate x: m; coordinate y: m; coordinate φ[3]: rad;
         driven s: [m; 2]; input u: N; let r = [x, y]; let z[k in 0..3] = r + L*cis(φ[k]);
         kinetic = m/2*|ṙ|^2 + sum(k in 0..3, m/2*|ż[k]|^2); potential = m*g*height(r); {statements}"
    )
}

fn compiled(source: &str) -> Compiled {
    compile(source).unwrap_or_else(|messages| panic!("{source}: {messages:?}"))
}

#[test]
fn all_shapes_are_taken() {
    for statements in [
        "constraint rod: |r| = L;",
        "constraint rod: |r|^2 = L^2; output pull: N/m = reaction(rod);",
        "constraint loop: z[0] = [L, 0]; output pull: [N; 2] = reaction(loop);",
        "constraint loop: z[0] = [L, 0]; output pull: N = reaction(loop).x;",
        "constraint loop: z[0] = [L, 0]; output pull: N = reaction(loop.y);",
        "constraint rods[k in 0..3]: |z[k]| = 2*L; output pulls: [N; 3] = reaction(rods);",
        "constraint rods[k in 0..3]: |z[k]| = 2*L; output pull: N = reaction(rods[1]);",
        "constraint pins[k in 0..2]: z[k] = s; output pulls[k in 0..2]: [N; 2] = reaction(pins[k]);",
        "constraint pins[k in 0..2]: z[k] = s; let p = reaction(pins[1]); output pull: N = |p|;",
        "constraint turns: φ̇ = [1, 2, 3]*x/L;",
        "constraint r: x = 0; redundant constraint again: 2*x = 0;",
        "constraint blade: ẋ*sin(φ[0]) = ẏ*cos(φ[0]);",
        "constraint roll: ẋ = L*φ̇[0];",
        "constraint track: x = L*sin(t*g*t/L);",
        "constraint carried: x = s.x + height(s);",
        "constraint conveyed: ẋ = height(ṡ);",
        "limit floor: y >= 0, restitution = e;",
        "limit walls[k in 0..3]: L >= height(z[k]), restitution = 1/2;",
    ] {
        let turns = statements.contains("turns");
        let found = refusals(&block(statements));
        assert_eq!(found.is_empty(), !turns, "{statements}: {found:?}");
    }
}

#[rustfmt::skip]
const REFUSED: &[(&str, &str)] = &[
    ("constraint rod: |r| = m;",              "`m` is kg, but `|r|` is m; a constraint needs one unit"),
    ("constraint rod: ẋ^2 + ẏ^2 = g*L;",      "velocities enter a constraint to the first power only; solve it for a velocity, or write a `force`"),
    ("constraint rod: ẍ = g;",                "`ẍ` is an acceleration; a constraint holds positions or velocities"),
    ("constraint rod: dot(ẋ) = g;",           "the derivative of a velocity in `ẋ` is an acceleration; a constraint holds positions or velocities"),
    ("constraint rod: L = height(s);",        "no coordinate stands in `L = height(s)`: nothing here can move to fulfil it; leave it out"),
    ("constraint rod: |r| = L; constraint again: |r|^2 = L^2;", "`again` follows from `rod`: leave it out, or write `redundant constraint` to have it checked"),
    ("constraint a: x = y; constraint b: x = L*φ[0]; constraint c: y = L*φ[0];", "`c` follows from `a` and `b`: leave it out, or write `redundant constraint` to have it checked"),
    ("constraint a: r = s; constraint b: φ[0] = 1; constraint c: φ[1] = 1; constraint d: φ[2] = 1;", "5 scalar constraints for 5 coordinates: nothing is left to move; leave a constraint out"),
    ("constraint rod: |r| <= L;",             "a constraint holds with `=`; write `limit rod: a >= b, restitution = 0;` for one side"),
    ("constraint rod: |r| == L;",             "the two sides of a constraint stand beside one `=`; write `a = b`"),
    ("constraint rod: abs(x) = L;",           "a constraint and a limit need two derivatives, and `abs`, `sign`, `min` and `max` of what moves have a corner; write both sides without them, and two limits for a bound on both sides"),
    ("constraint rod: max(x, y) = L;",        "a constraint and a limit need two derivatives, and `abs`, `sign`, `min` and `max` of what moves have a corner; write both sides without them, and two limits for a bound on both sides"),
    ("constraint rod: x = u*L/m/g;",          "`u` has no derivative; declare it `driven`"),
    ("constraint rod: x*g*L = height(ṡ)^2*L;", "the second derivative of this constraint contains the third one of `s`, and driven inputs have two; leave its derivative out"),
    ("constraint rod: |r| = L; force x = reaction(rod);", "the reaction of `rod` is known only after the forces; it stands in outputs"),
    ("constraint rod: |r| = L; output pull = reaction(rid);", "unknown constraint `rid`; did you mean `rod`?"),
    ("output pull = reaction(rod);",          "unknown constraint `rod`; declare it, as in `constraint rod: a = b;`"),
    ("constraint rod: |r| = L; output pull: J = reaction(rod);", "`reaction(rod)` is kg·m/s², but `pull` is declared in J"),
    ("constraint rod: |r| = L; output pull = reaction(rod[1]);", "`rod` is no family; write `reaction(rod)`"),
    ("constraint rod: |r| = L; redundant constraint again: |r|^2 = L^2; output pull = reaction(again);", "`again` is redundant, and its reaction is not unique; leave it out"),
    ("constraint x: y = L;",                  "`x` is declared already; choose another name"),
    ("constraint a: y = L; constraint a: x = L;", "two constraints or limits are called `a`; rename one of the two"),
    ("constraint a: r = L;",                  "`r` is a plane vector, but `L` is a scalar; both sides have one shape"),
    ("constraint a: z = s;",                  "`z` is a family; write it for one member, as `a[k in 0..3]: …` with `z[k]`"),
    ("constraint: y = L;",                    "`:` is not expected here; expected the name of a constraint"),
    ("constraint y = L;",                     "a constraint has a name; write `constraint y: …`"),
    ("redundant y = L;",                      "`y` is not expected here; expected `constraint`, as in `redundant constraint`"),
    ("limit floor: y >= 0;",                  "the restitution is missing; write `, restitution = 0` behind the limit `floor`, or a number up to 1"),
    ("limit floor: y <= 0, restitution = 0;", "a limit is a smallest value; write `limit floor: 0 >= y, restitution = 0;`"),
    ("limit floor: y < 2*L, restitution = e/2;", "a limit is a smallest value; write `limit floor: 2*L >= y, restitution = e/2;`"),
    ("limit floor: y = L, restitution = 0.5;", "a limit is a smallest value; write `limit floor: y >= L, restitution = 0.5;`"),
    ("limit floor: y <= L;",                  "a limit is a smallest value; write `limit floor: L >= y, restitution = 0;`"),
    ("limit a[k in 0..3]: φ[k] <= 1, restitution = e;", "a limit is a smallest value; write `limit a[k in 0..3]: 1 >= φ[k], restitution = e;`"),
    ("limit floor: y >= 0, restitution = m;", "`m` is kg, but a restitution is a pure number; divide it by a quantity in kg"),
    ("limit floor: y >= 0, restitution = x/L;", "`x/L` moves, and a restitution is made of parameters and numbers"),
    ("constraint a[k in 3..1]: φ[k] = 1;",     "`a` has no members; write a range such as `0..5`"),
    ("limit floor: y >= 0, restitution = 2;", "`2` is no restitution; write a number from 0, no rebound, to 1, no loss"),
    ("constraint rod: |r| = L; output pull = dot(reaction(rod));", "the derivative of a reaction in `reaction(rod)` is not known; leave the reaction out of it"),
    ("limit floor: ẏ >= 0, restitution = 0;", "a limit holds positions; leave the velocities out"),
    ("limit floor: r >= s, restitution = e;", "is a plane vector, and a limit is one number; write a component"),
    ("limit floor: r >= s, restitution = 0;", "is a plane vector, and a limit is one number; write a component"),
    ("limit floor: y >= m, restitution = e;", "`m` is kg, but `y` is m; a limit needs one unit"),
];

#[test]
fn mistakes_are_told_at_the_constraint() {
    for (statements, expected) in REFUSED {
        let found = refusals(&block(statements));
        let told = matches!(&found[..], [one] if one.contains(expected));
        assert!(told, "{statements}: {found:?}");
    }
}

#[test]
fn equations_show_multipliers() {
    let bob = "struct Bob { m: kg, L: m, g: m/s^2 } coordinate x: m; coordinate y: m;
        kinetic = m/2*(ẋ^2 + ẏ^2); potential = m*g*y; constraint rod: |[x, y]|^2 = L^2;";
    assert_eq!(
        compiled(bob).equations,
        ["m·ẍ = 2·λ_rod·x", "m·ÿ = −(m·g − 2·λ_rod·y)", "L² − x² − y² = 0 (rod)"]
    );
    let ascii = bob.replace('ẋ', "x_dot").replace('ẏ', "y_dot");
    assert_eq!(compiled(&ascii).equations[0], "m*x_ddot = 2*lambda_rod*x");
    assert_eq!(compiled(bob).power, "0");
    let driven = bob.replace("coordinate x", "driven l: m; coordinate x").replace("L^2", "l^2");
    assert!(compiled(&driven).power.contains('l'), "{}", compiled(&driven).power);
}

/// A quantity conserved without a constraint is conserved with it only if the constraint does no
/// work along its symmetry.
#[test]
fn conserved_momenta_are_those_that_constraints_leave() {
    let planar = |statement: &str| {
        compiled(&format!(
            "struct S {{ m: kg, L: m, J: kg*m^2 }} coordinate x: m; coordinate y: m; coordinate θ: rad;
             kinetic = m/2*(ẋ^2 + ẏ^2) + J/2*θ̇^2; {statement}"
        ))
        .conserved
    };
    assert_eq!(planar("").len(), 4);
    // A rod about the origin preserves both rotations. A blade preserves only the common rotation
    // of point and angle.
    assert_eq!(planar("constraint rod: |[x, y]| = L;"), ["p_θ", "x·p_y − y·p_x"]);
    assert_eq!(planar("constraint blade: ẋ*sin(θ) = ẏ*cos(θ);"), ["p_θ"]);
    assert_eq!(planar("constraint wheel: ẋ = L*θ̇;"), ["p_y"]);
}

/// The operations of N loops in a row, and of a chain with both ends held.
#[test]
#[ignore = "takes ten seconds: `.ci/run` runs it"]
fn operations_grow_with_the_number_of_loops() {
    let total = |source: &str| {
        let count = compiled(source).operations;
        count.mul + count.add + 4 * count.div + 10 * count.sincos + 10 * count.functions
    };
    let loops = |n: usize| {
        total(&format!(
            "struct Loops {{ m: kg, L: m, g: m/s^2 }} coordinate φ[{}]: rad; coordinate ψ[{n}]: rad;
             let a[k in 0..{}] = L*[k, 0] + L*cis(φ[k]);
             kinetic = sum(k in 0..={n}, m*L^2/6*φ̇[k]^2) + sum(k in 0..{n}, m/2*|dot(a[k] + L/2*cis(ψ[k]))|^2 + m*L^2/24*ψ̇[k]^2);
             potential = sum(k in 0..={n}, m*g*L/2*sin(φ[k])) + sum(k in 0..{n}, m*g*height(a[k] + L/2*cis(ψ[k])));
             constraint loop[k in 0..{n}]: a[k] + L*cis(ψ[k]) = a[k + 1];",
            n + 1,
            n + 1
        ))
    };
    let chain = |n: usize| {
        total(&format!(
            "struct Chain {{ m: kg, L: m, d: m, g: m/s^2 }} coordinate θ[{n}]: rad;
             let y[k in 0..{n}] = sum(j in 0..=k, L*[cos(θ[j]), sin(θ[j])]);
             kinetic = sum(k in 0..{n}, m/2*|ẏ[k]|^2); potential = sum(k in 0..{n}, m*g*height(y[k]));
             constraint end: y[{}] = [d, 0];",
            n - 1
        ))
    };
    let beads = |n: usize| {
        total(&format!(
            "struct Beads {{ m: kg, L: m, g: m/s^2 }} coordinate x[{n}]: m; coordinate y[{n}]: m;
             kinetic = sum(k in 0..{n}, m/2*(ẋ[k]^2 + ẏ[k]^2)); potential = sum(k in 0..{n}, m*g*y[k]);
             constraint first: x[0]^2 + y[0]^2 = L^2;
             constraint rod[k in 1..{n}]: (x[k] - x[k - 1])^2 + (y[k] - y[k - 1])^2 = L^2;"
        ))
    };
    // A further loop, link or bead has the same cost at every position.
    assert_eq!(loops(16) - loops(8), 2 * (loops(8) - loops(4)));
    assert_eq!(beads(32) - beads(16), 2 * (beads(16) - beads(8)));
    let links = chain(20) - chain(16);
    assert!(10 * links < 11 * (chain(16) - chain(12)), "{:?}", [12, 16, 20].map(chain));
}
