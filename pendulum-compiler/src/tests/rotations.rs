//! Rotations as values, against the same expressions written out in components.

use super::{Random, derive, evaluate, refusals};
use crate::algebra::expr::Symbol;
use crate::compile::derived;
use crate::messages::Errors;
use std::cell::RefCell;
use std::collections::BTreeMap;

/// Coordinates, rotations, and Rodrigues' formula `turn(n, φ, u)` to compare with.
const BLOCK: &str = "struct S { u: [_; 3], w: [_; 3], n: [_; 3], k }
    coordinate a; coordinate b; coordinate c; driven x: [_; 3];
    let turn(n, p, u) = u*cos(p) + cross(n, u)*sin(p) + n*inner(n, u)*(1 - cos(p));
    let m = [cos(b), sin(b)*t, k];
    let A = rotation([0, 0, 1], a); let B = rotation([3, 0, 4], b); let C = rotation(n, c);
    let D = rotation(m, a + c); let E[k in 0..3] = rotation([k, 1, 0], b*k); let F(p) = rotation([0, -1, 0], p)*A;
    kinetic = ȧ^2 + ḃ^2 + ċ^2;";

/// An expression and the same in components.
#[rustfmt::skip]
const SAME: &[(&str, &str)] = &[
    ("A*u",                            "[u.x*cos(a) - u.y*sin(a), u.x*sin(a) + u.y*cos(a), u.z]"),
    ("rotation([0, 0, -2], a)*u",      "turn([0, 0, -1], a, u)"),
    ("rotation([0, k, 0], a)*u",       "turn([0, k/abs(k), 0], a, u)"),
    ("B*u",                            "turn([3/5, 0, 4/5], b, u)"),
    ("C*u",                            "turn(n/|n|, c, u)"),
    ("D*u",                            "turn(m/|m|, a + c, u)"),
    ("transpose(B)*u",                 "turn([3/5, 0, 4/5], -b, u)"),
    ("transpose(A*B)*u",               "transpose(B)*(transpose(A)*u)"),
    ("k*A*B*C*u",                      "k*(A*(B*(C*u)))"),
    ("-A*u + 2*-B*u",                  "-(A*u) - 2*(B*u)"),
    ("A*k*u/2",                        "k/2*(A*u)"),
    ("E[2]*u",                         "turn([2, 1, 0]/sqrt(5), 2*b, u)"),
    ("product(k in 0..3, E[k])*u",     "turn([0, 1, 0], 0, turn([1, 1, 0]/sqrt(2), b, turn([2, 1, 0]/sqrt(5), 2*b, u)))"),
    ("product(k in 2..2, E[k])*u",     "u"),
    ("F(c)*u",                         "turn([0, -1, 0], c, turn([0, 0, 1], a, u))"),
    ("transpose(A)*A*u",               "u"),
    ("A*transpose(A)*B*u",             "B*u"),
    ("inner(A*u, A*w)",                "inner(u, w)"),
    ("cross(C*u, C*w)",                "turn(n/|n|, c, cross(u, w))"),
    ("|A*B*u|",                        "|u|"),
    ("|x + A*u|",                      "|x + turn([0, 0, 1], a, u)|"),
    ("(A*B*u).y",                      "inner([0, 1, 0], A*(B*u))"),
    ("(A*B*u)[2]",                     "height(A*B*u)"),
    ("inner(D*u + A*u, D*w)",          "inner(turn(m/|m|, a + c, u) + turn([0, 0, 1], a, u), turn(m/|m|, a + c, w))"),
    ("sum(k in 0..3, E[k]*u)",         "E[0]*u + E[1]*u + E[2]*u"),
    ("dot(A*B*C*u)",                   "dot(turn([0, 0, 1], a, turn([3/5, 0, 4/5], b, turn(n/|n|, c, u))))"),
    ("dot(D*u)",                       "dot(turn(m/|m|, a + c, u))"),
    ("dot(transpose(D)*x)",            "dot(turn(m/|m|, -a - c, x))"),
    ("dot(x + A*(u + B*(w + D*u)))",   "ẋ + dot(turn([0, 0, 1], a, u + turn([3/5, 0, 4/5], b, w + turn(m/|m|, a + c, u))))"),
    ("|dot(x + A*(u + D*w) - B*u)|^2", "|ẋ + dot(turn([0, 0, 1], a, u + turn(m/|m|, a + c, w)) - turn([3/5, 0, 4/5], b, u))|^2"),
    ("inner(dot(A*B*u), dot(A*D*w))",  "inner(dot(turn([0, 0, 1], a, turn([3/5, 0, 4/5], b, u))), dot(turn([0, 0, 1], a, turn(m/|m|, a + c, w))))"),
    ("dot(dot(A*B*D*u))",              "dot(dot(turn([0, 0, 1], a, turn([3/5, 0, 4/5], b, turn(m/|m|, a + c, u)))))"),
    ("angular_velocity(A)",            "[0, 0, ȧ]"),
    ("angular_velocity(B)",            "[3/5, 0, 4/5]*ḃ"),
    ("angular_velocity(rotation(n, k))", "[0, 0, 0]"),
    ("angular_velocity(A*B*C)",        "[0, 0, ȧ] + A*([3/5, 0, 4/5]*ḃ + B*(n/|n|)*ċ)"),
    ("cross(angular_velocity(A*D*B), A*D*B*u)", "dot(turn([0, 0, 1], a, turn(m/|m|, a + c, turn([3/5, 0, 4/5], b, u))))"),
    ("angular_velocity(transpose(D))", "-(transpose(D)*angular_velocity(D))"),
    ("transpose(A*B)*angular_velocity(A*B)", "transpose(B)*[0, 0, ȧ] + [3/5, 0, 4/5]*ḃ"),
    ("dot(angular_velocity(A*D))",     "dot([0, 0, ȧ] + turn([0, 0, 1], a, angular_velocity(D)))"),
];

#[test]
fn rotations_are_what_is_written_out_in_components() {
    for (own, components) in SAME {
        let block = format!("{BLOCK} output own = {own}; output components = {components};");
        let mut errors = Errors::default();
        derived(&block, &mut errors, |_, graph, _, energies| {
            let [own, other] = [0, 1].map(|k| energies.outputs[k].scalars.clone());
            assert!(!own.is_empty());
            assert_eq!(own.len(), other.len());
            let mut random = Random(7);
            for _ in 0..20 {
                let random = RefCell::new(&mut random);
                let known = RefCell::new(BTreeMap::new());
                let value = |symbol: Symbol| {
                    let mut known = known.borrow_mut();
                    *known.entry(symbol).or_insert_with(|| random.borrow_mut().uniform(-2.0, 2.0))
                };
                for (&own, &other) in own.iter().zip(&other) {
                    let [own, other] = [own, other].map(|id| evaluate(graph, id, &value));
                    let error = (own - other).abs() / (1.0 + other.abs());
                    assert!(error < 1e-12, "{components}: {own}, not {other}");
                }
            }
        });
        assert!(errors.is_empty(), "{own} = {components}: {:?}", errors.messages());
    }
}

/// The kinetic energy of a top, and the same by its Euler angles (Landau & Lifshitz §35).
#[test]
fn a_top_has_the_equations_of_its_euler_angles() {
    let block = |kinetic: &str| {
        format!(
            "struct Top {{ A: kg*m^2, C: kg*m^2, k: kg*m^2/s^2 }}
             coordinate φ; coordinate θ; coordinate ψ;
             let R = rotation([0, 0, 1], φ)*rotation([1, 0, 0], θ)*rotation([0, 0, 1], ψ);
             let W = transpose(R)*angular_velocity(R);
             kinetic = {kinetic}; potential = k*height(R*[0, 0, 1]);"
        )
    };
    let accelerations = |kinetic: &str| {
        derive(&block(kinetic), |_, graph, motion| {
            let value = |symbol| match symbol {
                Symbol::Parameter(k) => [1.3, 0.7, 2.1][k],
                Symbol::Coordinate(k) => [0.4, 1.1, -0.8][k],
                Symbol::Velocity(k) => [0.9, -0.6, 2.2][k],
                other => panic!("{other:?}"),
            };
            motion.accelerations.iter().map(|&id| evaluate(graph, id, &value)).collect::<Vec<_>>()
        })
    };
    let own = accelerations("A/2*(W.x^2 + W.y^2) + C/2*W.z^2");
    let known = accelerations("A/2*(θ̇^2 + φ̇^2*sin(θ)^2) + C/2*(ψ̇ + φ̇*cos(θ))^2");
    for (own, known) in own.iter().zip(&known) {
        assert!((own - known).abs() < 1e-12, "{own}, not {known}");
    }
}

#[rustfmt::skip]
const REFUSED: &[(&str, &str)] = &[
    ("2*A",                  "a rotation has no multiples, and no vector follows it here; write the vector that it turns behind it, as in `2*R*u`"),
    ("-A",                   "a rotation has no multiples, and no vector follows it here; write the vector that it turns behind it, as in `2*R*u`"),
    ("A*k",                  "a rotation has no multiples, and no vector follows it here; write the vector that it turns behind it, as in `2*R*u`"),
    ("A + B",                "a sum of rotations is no rotation, and `B` is one; add vectors that they turn, as in `A*u + B*u`"),
    ("u + A",                "a sum of rotations is no rotation, and `A` is one; add vectors that they turn, as in `A*u + B*u`"),
    ("A.x",                  "`A` is a rotation, whose entries have no names; write `inner(u, A*v)` for the entry between two directions"),
    ("A[0]",                 "`A` is a rotation, whose entries have no names; write `inner(u, A*v)` for the entry between two directions"),
    ("dot(A)",               "the derivative of a rotation is no vector; write `angular_velocity(A)`, or `dot(A*u)` for a vector that it turns"),
    ("Ȧ",                    "the derivative of a rotation is no vector; write `angular_velocity(A)`, or `dot(A*u)` for a vector that it turns"),
    ("sin(A)",               "`A` is a rotation, but a scalar is needed here; write `inner(u, R*v)`"),
    ("u*A",                  "`A` is a rotation, which stands before the vector that it turns and is no factor here; write `A*u`, or `transpose(A)*u` to turn back"),
    ("u/A",                  "`A` is a rotation, which stands before the vector that it turns and is no divisor here; write `A*u`, or `transpose(A)*u` to turn back"),
    ("A*[1, 2]",             "`[1, 2]` is a plane vector, and a rotation turns vectors in space; write three components, or `cis(φ)*u` in the plane"),
    ("A^2",                  "`A` is a rotation, and only scalars have powers; write `A*A`"),
    ("|A|",                  "`A` is a rotation, which has no length; write the vector that it turns, as in `|R*u|`"),
    ("A*u*w",                "the product of two space vectors is ambiguous; write `inner(u, w)` or `cross(u, w)`"),
    ("rotation([0, 0], a)*u", "`[0, 0]` is a plane vector, and a rotation turns about an axis in space; write three components, or turn plane vectors with `cis(φ)*u`"),
    ("rotation(k, a)*u",     "`k` is a scalar, and an axis is a space vector; write `rotation([0, 0, 1], φ)`"),
    ("rotation([0, 0, 0], a)*u", "`[0, 0, 0]` has no direction; write an axis that is not zero"),
    ("rotation(u - u, a)*u", "`u - u` has no direction; write an axis that is not zero"),
    ("rotation(u, w)*u",     "`w` is a space vector, but a scalar is needed here; write `inner(u, v)`, `|u|` or a component"),
    ("transpose(u)",         "`u` is a space vector, and a transpose is that of a rotation; write one, as in `rotation(n, φ)`"),
    ("angular_velocity(a)",  "`a` is a scalar, and an angular velocity is that of a rotation; write one, as in `rotation(n, φ)`"),
    ("product(k in 0..3, k)*u", "`k` is a scalar, and a `product` over an index is that of a rotation; write one, as in `rotation(n, φ)`"),
    ("product(A, B)",        "`product` runs over an index; write `product(k in 0..5, A[k])`"),
    ("product(k in 0..300, A)*u", "this is a product of more than 256 rotations; write a shorter chain"),
];

#[test]
fn mistakes_with_rotations_are_told() {
    for (expression, expected) in REFUSED {
        let messages = refusals(&format!("{BLOCK} output wrong = {expression};"));
        assert_eq!(messages, [*expected], "{expression}");
    }
    let messages = refusals(&format!("{BLOCK} constraint hold: A*B = C;"));
    let expected = "rotations are no sides of an equation; write directions that shall agree, as \
                    in `inner(A*B*u, C*v) = 0` for two or three pairs of vectors";
    assert_eq!(messages, [expected]);
    let messages =
        refusals(&format!("{BLOCK} input q; output wrong = angular_velocity(A*rotation(n, q));"));
    assert_eq!(messages.len(), 1);
    assert!(messages[0].contains("`q`"), "{messages:?}");
}

#[test]
fn rotations_are_pure_numbers() {
    let block = |axis: &str, angle: &str, output: &str| {
        refusals(&format!(
            "struct S {{ L: m, k: N/m }} coordinate x: m; kinetic = ẋ^2*1; potential = k/2*x^2;
             let R = rotation({axis}, {angle}); output own: {output};"
        ))
        .into_iter()
        .filter(|message| !message.contains("energies"))
        .collect::<Vec<_>>()
    };
    assert!(block("[L, x, L]", "x/L", "[m; 3] = R*[x, x, x]").is_empty());
    assert!(block("[L, x, L]", "x/L", "[1/s; 3] = angular_velocity(R*transpose(R)*R)").is_empty());
    assert!(block("[1, 0, 0]", "x/L", "[m/s; 3] = product(k in 0..2, R)*[ẋ, 0, 0]").is_empty());
    assert_eq!(
        block("[L, x, L]", "x", "[m; 3] = R*[x, x, x]"),
        [
            "`x` is m, but the argument of `rotation` is a pure number; divide it by a length, such as a parameter `a: m`"
        ]
    );
    assert_eq!(
        block("[L, x, L]", "x/L", "[m; 3] = angular_velocity(R)"),
        ["`angular_velocity(R)` is 1/s, but `own` is declared in m"]
    );
}

/// The generalized forces of a torque are those of forces on points: F at the ends of an arm r is
/// the torque r × F.
#[test]
fn a_torque_is_a_pair_of_forces() {
    let forces = |statements: &str| {
        derive(&format!("{BLOCK} let R = A*D*B; {statements}"), |_, graph, motion| {
            let value = |symbol| match symbol {
                Symbol::Parameter(k) => [0.3, -1.2, 0.7, 1.1, 0.4, -0.5, 0.9, 0.2, 1.4, 0.6][k],
                Symbol::Coordinate(k) => [0.4, 1.1, -0.8][k],
                Symbol::Time => 0.7,
                other => panic!("{other:?}"),
            };
            motion.accelerations.iter().map(|&id| evaluate(graph, id, &value)).collect::<Vec<_>>()
        })
    };
    let own = forces("torque R = cross(R*u, A*w);");
    let pair = forces("force R*u = A*w;");
    let other = forces("force R*(u + [1, 2, 3]) = A*w; force R*[1, 2, 3] = -A*w;");
    for ((own, pair), other) in own.iter().zip(&pair).zip(&other) {
        assert!(own.abs() > 1e-3);
        assert!((own - pair).abs() < 1e-12 && (own - other).abs() < 1e-12, "{own} {pair} {other}");
    }
}

#[rustfmt::skip]
const TORQUES: &[(&str, &str)] = &[
    ("torque u = u;",                "`u` is a space vector, and a torque acts on a rotation; write `force` for what acts on a point or an angle"),
    ("force A = u;",                 "`A` is a rotation, and a force acts on a point; write `torque` for what turns it"),
    ("torque rotation(n, k) = u;",   "no coordinate moves `rotation(n, k)`, so a torque does nothing there; write a coordinate or an expression of coordinates"),
    ("torque A = k;",                "`k` is a scalar, but `A` is a space vector; both have one shape"),
    ("torque E = u;",                "`E` is a family; write `E[k]`, or `E[k in 0..3]` for all"),
    ("torque rotation(n, ȧ) = u;",   "`rotation(n, ȧ)` contains a velocity, and a force acts on a position; write what moves with it"),
    ("torque Q = u;",                "unknown name `Q`; declare it as a parameter, a coordinate, an input or with `let`"),
];

#[test]
fn mistakes_with_torques_are_told() {
    for (statement, expected) in TORQUES {
        assert_eq!(refusals(&format!("{BLOCK} {statement}")), [*expected], "{statement}");
    }
    let block = |torque: &str| {
        refusals(&format!(
            "struct S {{ L: m, A: kg*m^2, F: N }} coordinate θ: rad; kinetic = A/2*θ̇^2;
             torque rotation([0, 0, 1], θ) = {torque};"
        ))
    };
    assert_eq!(block("[0, 0, F*L]"), [""; 0]);
    let expected = "`[0, 0, F]` is kg·m/s², but a torque on `rotation([0, 0, 1], θ)` is kg·m²/s²";
    assert_eq!(block("[0, 0, F]"), [expected]);
}
