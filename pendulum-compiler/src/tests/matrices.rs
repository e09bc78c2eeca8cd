//! Symmetric matrices of parameters.

use super::refusals;
use super::vectors::{distance, values};
use crate::compile::compile;

/// A body that turns by three angles, whose rates are the components of ω.
fn tumbling(energy: &str) -> Vec<f64> {
    values(&format!(
        "struct T {{ xx, yy, zz, xy, xz, yz, J: [_; 3, 3] }} coordinate a[3];
         let ω = [ȧ[0] + a[1]*ȧ[2], ȧ[1] - a[0]*ȧ[2], ȧ[2]]; kinetic = {energy};"
    ))
}

#[test]
fn a_matrix_multiplies_the_vector_behind_it() {
    // Values of parameters ascend by a third, so that the entries are 2 more than the six scalars.
    let entries = "(xx + 2)*ω.x^2 + (yy + 2)*ω.y^2 + (zz + 2)*ω.z^2
        + 2*((xy + 2)*ω.x*ω.y + (xz + 2)*ω.x*ω.z + (yz + 2)*ω.y*ω.z)";
    let expected = tumbling(&format!("({entries})/2"));
    for energy in ["inner(ω, J*ω)/2", "inner(J*ω, ω)/2", "inner(ω, 1/2*J*ω)", "inner(ω, -J/2*-ω)"]
    {
        let found = tumbling(energy);
        assert!(distance(&found, &expected) < 1e-12, "{energy}: {found:?} {expected:?}");
    }
}

#[test]
fn the_entries_of_a_matrix_have_names() {
    let compiled = compile(
        "struct T { J: [kg*m^2; 3, 3] } coordinate a[3]: rad; let ω = dot([a[0], a[1], a[2]]);
         kinetic = inner(ω, J*ω)/2;",
    );
    let compiled = compiled.unwrap_or_else(|messages| panic!("{messages:?}"));
    assert_eq!(compiled.momenta[0], "J.xx·ȧ[0] + J.xy·ȧ[1] + J.xz·ȧ[2]");
    assert_eq!(compiled.momenta[2], "J.zz·ȧ[2] + J.xz·ȧ[0] + J.yz·ȧ[1]");
    let declared = &compiled.parameters[0];
    assert_eq!((declared.length, declared.components), (Some(3), Some(3)));
}

#[rustfmt::skip]
const REFUSED: &[(&str, &str)] = &[
    ("potential = J;",                  "`J` is a matrix, but a scalar is needed here; write `inner(u, J*v)`"),
    ("potential = |J|;",                "`J` is a matrix, which has no length; write that of a vector `J*u`"),
    ("potential = |2*J|;",              "`J` is a matrix, which multiplies the space vector behind it; write `J*u`"),
    ("potential = |u*J|;",              "`J` is a matrix, which multiplies the space vector behind it; write `J*u`"),
    ("potential = |u/J|;",              "`J` is a matrix, which multiplies the space vector behind it; write `J*u`"),
    ("potential = u*J*u;",              "the product of two space vectors is ambiguous; write `inner(u, J*…)` or `cross(u, J*…)`"),
    ("potential = |J*[1, 2]|;",         "`J` is a matrix, which multiplies the space vector behind it; write `J*u`"),
    ("potential = |(J + J)*u|;",        "`J` is a matrix, and a sum has none; add vectors, as in `J*u + K*u`"),
    ("potential = J[0];",               "`J` is a matrix, it has no members; leave out the index"),
    ("potential = J.x;",                "`J` is a matrix, it has no `.x`; write a vector"),
    ("potential = J^2;",                "`J` is a matrix, and only scalars have powers; write `J*(J*u)`"),
    ("potential = inner(u, dot(J)*u);", "nothing in `J` moves, so its time derivative is zero; leave it out"),
    ("output I: [J; 3] = J;",           "`J` is a matrix, and an output is a vector; write `J*u`"),
    ("driven K: [m; 3, 3];",            "only a parameter is a matrix; write vectors, as in `[m; 3]`, for its columns"),
    ("input K: [m; 3, 3];",             "only a parameter is a matrix; write vectors, as in `[m; 3]`, for its columns"),
    ("coordinate K: [m; 3, 3];",        "only a parameter is a matrix; write vectors, as in `[m; 3]`, for its columns"),
    ("output K: [m; 3, 3] = u;",        "only a parameter is a matrix; write vectors, as in `[m; 3]`, for its columns"),
    ("potential = inner(u, J*u);",      "`inner(u̇, J*u̇)` is kg·m²/s⁴, but `inner(u, J*u)` is kg·m²/s²; all energies of a block have one unit"),
];

#[test]
fn a_matrix_is_no_vector() {
    for (statements, expected) in REFUSED {
        let source = format!(
            "struct T {{ J: [kg*m^2; 3, 3] }} coordinate u: [1/s; 3];
             kinetic = inner(u̇, J*u̇); {statements}"
        );
        assert_eq!(refusals(&source).first().map(String::as_str), Some(*expected), "{statements}");
    }
    for (kind, expected) in [
        ("[_; 2, 2]", "a matrix is symmetric and has three rows and columns; write `[…; 3, 3]`"),
        ("[_; 3, n]", "a matrix is symmetric and has three rows and columns; write `[…; 3, 3]`"),
        (
            "[_; 3, 3] = [1, 2, 3]",
            "the default of `J` is a list of 6 numbers; write them between brackets, as in `[1, 2, 3]`",
        ),
    ] {
        let source = format!("struct T {{ J: {kind} }} coordinate u: [_; 3]; kinetic = |u̇|^2;");
        assert_eq!(refusals(&source), [expected], "{kind}");
    }
}

/// A product of inertia may be negative, and nothing is said about the sign of the energy.
#[test]
fn an_entry_off_the_diagonal_may_be_negative() {
    let source = "struct T { J: [kg*m^2; 3, 3] } coordinate a: rad; coordinate b: rad;
        kinetic = inner([ȧ - ḃ, ḃ, 0], J*[ȧ, -ȧ + ḃ, 0]);";
    assert!(refusals(source).is_empty(), "{:?}", refusals(source));
}

/// Matrices and rotations act from the right, one after the other.
#[test]
fn a_matrix_stands_between_rotations() {
    let equations = |energy: &str| {
        let source = format!(
            "struct T {{ J: [_; 3, 3], u: [_; 3], w: [_; 3] }} coordinate a; coordinate b;
             let A = rotation([0, 0, 1], a); let B = rotation([1, 0, 0], b);
             kinetic = ȧ^2 + ḃ^2; potential = {energy};"
        );
        crate::compile::compile(&source).unwrap_or_else(|found| panic!("{found:?}")).equations
    };
    for (short, long) in [
        ("inner(w, A*J*u)", "inner(w, A*(J*u))"),
        ("inner(w, J*A*u)", "inner(w, J*(A*u))"),
        ("inner(w, -2*A*B*J*transpose(A)*u)", "-2*inner(w, A*(B*(J*(transpose(A)*u))))"),
    ] {
        assert_eq!(equations(short), equations(long), "{short}");
        assert_ne!(equations(short), equations("inner(w, A*u)"), "{short}");
    }
}
