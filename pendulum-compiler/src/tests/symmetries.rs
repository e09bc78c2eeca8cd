//! Conserved quantities of systems with many roots.

use super::derive;
use crate::backend::{names, unicode};

/// Returns the conserved quantities of a block as printed.
fn conserved(source: &str) -> Vec<String> {
    derive(source, |model, _, motion| {
        let names = names::Names::new(model, &crate::mechanics::lower::Energies::default());
        motion.conserved.iter().map(|conserved| unicode::conserved(&names, conserved)).collect()
    })
}

/// Returns bodies in the plane, with a `potential` in terms of `r[k]`.
fn bodies(count: usize, potential: &str) -> String {
    format!(
        "struct Bodies {{ m: [kg; {count}], G, k }} coordinate x[{count}]; coordinate y[{count}]; let r[k in 0..{count}] = [x[k], y[k]];
         kinetic = sum(k in 0..{count}, m[k]/2*|ṙ[k]|^2); potential = {potential};"
    )
}

/// Returns the potential of gravity between each pair, with n(n − 1)/2 roots.
fn gravity(count: usize) -> String {
    format!("-G*sum(j in 0..{count}, sum(k in 0..j, m[j]*m[k]/|r[j] - r[k]|))")
}

/// Returns the momenta along both axes and the angular momentum of `count` bodies.
fn momenta(count: usize) -> Vec<String> {
    let sum =
        |axis: &str| (0..count).map(|k| format!("p_{axis}[{k}]")).collect::<Vec<_>>().join(" + ");
    let parts = |sign: &str, a: &str, b: &str| {
        (1..count).map(|k| format!(" {sign} {a}[{k}]·p_{b}[{k}]")).collect::<Vec<_>>().concat()
    };
    let turn = format!("x[0]·p_y[0] − y[0]·p_x[0]{}{}", parts("−", "y", "x"), parts("+", "x", "y"));
    vec![sum("x"), sum("y"), turn]
}

#[test]
fn bodies_that_attract_each_other_keep_three_momenta() {
    for count in [2, 3, 4] {
        assert_eq!(conserved(&bodies(count, &gravity(count))), momenta(count), "{count} bodies");
    }
}

#[test]
fn eight_roots_hide_no_symmetry() {
    let springs = "k*|r[0] + r[1] - r[2] - r[3]| + 2*k*|r[0] - r[1] + r[2] - r[3]|";
    assert_eq!(conserved(&bodies(4, &format!("{} + {springs}", gravity(4)))), momenta(4));
}

#[test]
fn roots_of_roots_hide_no_symmetry() {
    let nested =
        "k*sqrt(G + |r[0] - r[1]|) + k*sqrt(G + |r[1] - r[2]|) + k*sqrt(G + |r[2] - r[0]|)";
    assert_eq!(conserved(&bodies(3, nested)), momenta(3));
}

#[test]
fn what_a_symmetry_lacks_is_seen_behind_many_roots() {
    let [x, y, turn] = <[String; 3]>::try_from(momenta(4)).unwrap();
    // A weak uniform field, a pole that attracts a body, a spring to an axis.
    let with = |more: &str| conserved(&bodies(4, &format!("{} + {more}", gravity(4))));
    assert_eq!(with("k*x[0]"), [y]);
    assert_eq!(with("k/|r[3]|"), [turn]);
    assert_eq!(with("k*sqrt(1 + y[2]^2)"), [x]);
    assert!(with("k*sqrt(1 + y[2]^2) + k*sqrt(2 + x[1]^2)").is_empty());
}
