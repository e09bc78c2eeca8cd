//! Frictions: rates, magnitudes, units, refusals.

use super::{derive, refusals};
use crate::compile::{compile, expand};

/// Returns a block with a point in the plane, three joints, a driven belt and control inputs.
fn block(statements: &str) -> String {
    format!(
        "struct P {{ m: kg, L: m, F: N, S: N, μ: 1, g: m/s^2, e: 1, vs: m/s }}
         coordinate x: m; coordinate y: m; coordinate θ[3]: rad;
         driven s: [m; 2]; input u: N; let r = [x, y];
         kinetic = m/2*|ṙ|^2 + sum(k in 0..3, m/2*L^2*θ̇[k]^2); potential = m*g*y; {statements}"
    )
}

#[test]
fn rates_are_affine_in_the_velocities() {
    for statements in [
        "friction shoe: ẋ, force = F;",
        "friction shoe: ẋ, force = F, static = S;",
        "friction belt: ẋ - ṡ.x, force = F;",
        "friction crank: x*θ̇[0] + L*θ̇[1] - L*g/L*t, force = F;",
        "friction seal: dot(x^2)/L, force = F;",
        "friction joint[k in 0..3]: θ̇[k], force = F*L, static = S*L;",
        "friction grip: dot(r), force = F;",
        "friction grips[k in 0..2]: ṙ - [1, k]*θ̇[k]*L, force = F;",
        "friction shoe: ẋ, force = F*exp(-ẋ^2/vs^2) + u;",
        "friction shoe: ẋ, force = F + abs(ẏ)*m*g/vs + m*height(dot(dot(s))), static = abs(u);",
        "friction shoe: ẋ, force = F; friction seal: ẋ, force = S;",
        "friction shoe: ẋ, force = 0;",
        "let slip = ẋ - L*θ̇[0]; friction shoe: slip, force = F;",
        "friction loop: ẋ, force = F;",
        "limit floor: y >= 0, restitution = e; friction grip: ẋ, force = μ*reaction(floor), static = 2*μ*reaction(floor) + F;",
        "limit floor: y >= 0, restitution = e; friction roll: θ̇[0], force = (μ + t*g/vs)*L*reaction(floor) + abs(u)*L;",
        "limit walls[k in 0..2]: x + k*L >= 0, restitution = e; friction rub[k in 0..2]: ẏ, force = (μ + x/L)*reaction(walls[k]);",
        "limit floor: y >= 0, restitution = e; friction grip: ẋ, force = μ*reaction(floor)/m*(m + m*x^2/L^2);",
        "limit floor: y >= 0, restitution = 0, friction = μ along ẋ - ṡ.x;",
        "limit floor: y >= 0, restitution = e, friction = μ + 1 along dot(r) - [ṡ.x, ẏ], static = 2*μ;",
        "limit stops[k in 1..3]: θ[k] >= -1, restitution = e, friction = μ*k along θ̇[k];",
        "limit floor: y >= 0, restitution = e; output push: N = reaction(floor);",
        "limit floor: y >= 0, restitution = e; let push = reaction(floor); output load: N = push + m*ÿ;",
        "limit walls[k in 0..2]: x + k*L >= 0, restitution = e, friction = μ along ẏ; output rub: N = reaction(walls[1], friction);",
        "limit floor: y >= 0, restitution = e, friction = μ along dot(r); output rub: [N; 2] = reaction(floor, friction);",
        "constraint rod: |r| = L; friction grip: ẋ, force = μ*abs(reaction(rod)), static = |reaction(rod)|;",
        "constraint bar: r = [L, L]; friction grip: θ̇[0], force = μ*L*|reaction(bar)| + L*abs(reaction(bar.x)) + F*L;",
        "constraint rods[k in 0..2]: x + k*y = k*L; friction grip[k in 0..2]: θ̇[k], force = abs(reaction(rods[k]))*(L + x);",
        "constraint rod: |r| = L; limit floor: y >= 0, restitution = e; friction grip: ẋ, force = abs(reaction(rod)) + reaction(floor);",
        "constraint rod: |r| = L; friction grip: ẋ, force = abs(reaction(rod)); output rub: N = abs(reaction(rod)) + reaction(grip);",
        "friction shoe: ẋ, force = F; output rub: N = reaction(shoe);",
        "friction grip: dot(r), force = F; output rub: [N; 2] = reaction(grip); output part: N = reaction(grip.y);",
        "friction joint[k in 0..3]: θ̇[k], force = F*L; output brakes: [N*m; 3] = reaction(joint);",
        "friction joint[k in 0..3]: θ̇[k], force = F*L; output heat: W = -sum(k in 0..3, reaction(joint[k])*θ̇[k]);",
    ] {
        let found = refusals(&block(statements));
        assert!(found.is_empty(), "{statements}: {found:?}");
    }
}

#[rustfmt::skip]
const REFUSED: &[(&str, &str)] = &[
    ("friction shoe: x, force = F;",              "no velocity of a coordinate stands in `x`, and a friction acts against a rate; write one, as in `dot(x)`"),
    ("friction shoe: height(ṡ), force = F;",      "no velocity of a coordinate stands in `height(ṡ)`, and a friction acts against a rate; write one, as in `dot(x)`"),
    ("friction shoe: ẋ - ẋ, force = F;",          "no velocity of a coordinate stands in `ẋ - ẋ`, and a friction acts against a rate; write one, as in `dot(x)`"),
    ("friction shoe: ẋ^2, force = F;",            "velocities enter the rate of a friction to the first power only; write a rate that is zero together with this one, as `dot(x)` for its square"),
    ("friction shoe: |ṙ|, force = F;",            "velocities enter the rate of a friction to the first power only; write a rate that is zero together with this one, as `dot(x)` for its square"),
    ("friction shoe: abs(ẋ), force = F;",         "the rate of a friction needs a derivative, and `abs`, `sign`, `min` and `max` of what moves have a corner; write it without them, because a friction acts against either sign"),
    ("friction shoe: ẋ - u, force = F;",          "`u` has no derivative; declare it `driven`"),
    ("friction shoe: ẋ + dot(dot(s)).x*L/vs, force = F;", "the derivative of this rate contains the third one of `s`, and driven inputs have two; leave its second derivative out"),
    ("friction shoe: ẍ, force = F;",              "`ẍ` is an acceleration; a constraint holds positions or velocities"),
    ("friction shoe: dot(ẋ), force = F;",         "the derivative of a velocity in `ẋ` is an acceleration; a constraint holds positions or velocities"),
    ("friction shoe: ẋ, force = m*ẍ;",            "`ẍ` is an acceleration, and a Lagrangian has none; only driven inputs have a second derivative"),
    ("friction shoe: ẋ, force = F, static = S + F*abs(ẋ)/vs;", "`S + F*abs(ẋ)/vs` contains a velocity, and `static` is a bound at rest; write in `force` what depends on velocities"),
    ("friction shoe: ẋ, force = -1;",             "`-1` is negative, and a friction always acts against its rate; write the magnitude of its force, from 0"),
    ("friction shoe: ẋ, force = F, static = 1 - π;", "`1 - π` is negative, and a friction always acts against its rate; write the magnitude of its force, from 0"),
    ("friction shoe: ẋ, force = [F, F];",         "is a plane vector, but a scalar is needed here; write `inner(u, v)`, `|u|` or a component"),
    ("friction shoe: ẋ, force = F*L;",            "`F*L` is kg·m²/s², but a friction on `ẋ` is kg·m/s², a power per unit of `ẋ`"),
    ("friction joint: θ̇[0], force = F;",          "`F` is kg·m/s², but a friction on `θ̇[0]` is kg·m²/s², a power per unit of `θ̇[0]`"),
    ("friction shoe: ẋ, force = F, static = μ;",  "`μ` is a pure number, but a friction on `ẋ` is kg·m/s², a power per unit of `ẋ`"),
    ("friction shoe: ẋ;",                         "the force is missing; write `, force = F` behind the rate of the friction `shoe`"),
    ("friction shoe: ẋ, static = S;",             "the force is missing; write `, force = F` behind the rate of the friction `shoe`"),
    ("friction shoe: ẋ, force = F, limit = S;",   "`limit` is not expected here; expected `static` behind `force`, or `;` before it"),
    ("friction: ẋ, force = F;",                   "`:` is not expected here; expected the name of a friction"),
    ("friction ẋ, force = F;",                    "a dry friction has a name; write `friction ẋ: rate, force = F;`, or `dissipation = …;` for a viscous one"),
    ("friction shoe: θ̇, force = F;",              "`θ̇` is a family; write it for one member, as `shoe[k in 0..3]: …` with `θ̇[k]`"),
    ("friction j[k in 3..1]: θ̇[k], force = F*L;", "`j` has no members; write a range such as `0..5`"),
    ("friction shoe: ẋ, force = F; friction shoe: ẏ, force = F;", "a friction is called `shoe` already; rename one of the two"),
    ("friction shoe: ẋ, force = F; limit shoe: y >= 0, restitution = 0;", "a friction is called `shoe` already; rename one of the two"),
    ("limit shoe: y >= 0, restitution = 0; friction shoe: ẋ, force = F;", "two constraints or limits are called `shoe`; rename one of the two"),
    ("friction x: ẋ, force = F;",                 "`x` is declared already; choose another name"),
    ("limit floor: y >= 0, restitution = e; friction grip: ẋ, force = μ*reaction(floor)^2/F;", "a reaction enters a friction to the first power only, times what contains no velocity; write a sum of terms such as `μ*reaction(floor)`"),
    ("limit floor: y >= 0, restitution = e; friction grip: ẋ, force = abs(reaction(floor));", "a reaction enters a friction to the first power only"),
    ("limit floor: y >= 0, restitution = e; friction grip: ẋ, force = F*sign(reaction(floor));", "a reaction enters a friction to the first power only"),
    ("limit floor: y >= 0, restitution = e; friction grip: ẋ, force = reaction(floor)*exp(-ẋ^2/vs^2);", "a reaction enters a friction to the first power only"),
    ("limit floor: y >= 0, restitution = e; friction grip: ẋ, force = L*reaction(floor);", "`L*reaction(floor)` is kg·m²/s², but a friction on `ẋ` is kg·m/s², a power per unit of `ẋ`"),
    ("limit floor: y >= 0, restitution = e; friction grip: ẋ, force = reaction(flor);", "unknown limit or constraint `flor`; did you mean `floor`?"),
    ("constraint rod: |r| = L; friction grip: ẋ, force = reaction(rod);", "the reaction of a constraint has either sign; write its size, as in `μ*abs(reaction(rod))`, or `μ*|reaction(rod)|` for a vector"),
    ("constraint rod: |r| = L; friction grip: ẋ, force = abs(reaction(rod) + F);", "the reaction of a constraint has either sign; write its size"),
    ("constraint rod: |r| = L; friction grip: ẋ, force = abs(reaction(rod))^2/F;", "a reaction enters a friction to the first power only, times what contains no velocity; write a sum of terms such as `μ*reaction(floor)`"),
    ("constraint rod: |r| = L; friction grip: ẋ, force = abs(reaction(rod))*abs(ẋ)/vs;", "a reaction enters a friction to the first power only"),
    ("constraint rod: |r| = L; friction grip: ẋ, force = L*abs(reaction(rod));", "`L*abs(reaction(rod))` is kg·m²/s², but a friction on `ẋ` is kg·m/s², a power per unit of `ẋ`"),
    ("constraint rod: |r| = L; friction grip: ẋ, force = abs(reaction(rot));", "unknown limit or constraint `rot`; did you mean `rod`?"),
    ("redundant constraint rod: |r| = L; friction grip: ẋ, force = abs(reaction(rod));", "`rod` is redundant, and its reaction is not unique; leave it out"),
    ("limit a[k in 0..16]: y + k*L >= 0, restitution = 0; constraint rod: |r| = L; friction grip: ẋ, force = abs(reaction(rod));", "frictions contain at most 16 reactions of limits and constraints; leave some out"),
    ("limit floor: y >= 0, restitution = e; friction grip: ẋ, force = reaction(floor[0]);", "`floor` is no family; write `reaction(floor)`"),
    ("limit floor: y >= 0, restitution = e; force x = reaction(floor);", "the reaction of `floor` is known only after the forces; it stands in outputs"),
    ("limit floor: y >= 0, restitution = e; friction grip: ẋ*reaction(floor)/F, force = F;", "the reaction of `floor` is known only after the forces; it stands in outputs"),
    ("limit floor: y >= 0, restitution = e, friction = μ;", "the rate is missing; write `friction = μ along dot(x)`, with what slides"),
    ("limit floor: y >= 0, restitution = e, friction = along ẋ;", "the rate is missing; write `friction = μ along dot(x)`, with what slides"),
    ("limit floor: y >= 0, restitution = e, friction = F along ẋ;", "`F` is kg·m/s², but a coefficient of friction along `ẋ` is a pure number"),
    ("limit floor: y >= 0, restitution = e, friction = μ along ẋ, static = L;", "`L` is m, but a coefficient of friction along `ẋ` is a pure number"),
    ("limit floor: y >= 0, restitution = e, friction = -1/2 along ẋ;", "`-1/2` is negative, and a friction always acts against its rate; write the magnitude of its force, from 0"),
    ("limit floor: y >= 0, restitution = e, friction = ẋ/vs along ẋ;", "a reaction enters a friction to the first power only, times what contains no velocity"),
    ("limit floor: y >= 0, restitution = e, friction = μ along x;", "no velocity of a coordinate stands in `x`, and a friction acts against a rate; write one, as in `dot(x)`"),
    ("limit floor: y >= 0, restitution = e, friction = μ along ẋ; friction floor: ẏ, force = F;", "two constraints or limits are called `floor`; rename one of the two"),
    ("friction shoe: ẋ, force = F; output rub: J = reaction(shoe);", "`reaction(shoe)` is kg·m/s², but `rub` is declared in J"),
    ("friction shoe: ẋ, force = F; output rub: N = reaction(sho);", "unknown constraint `sho`; did you mean `shoe`?"),
    ("friction shoe: ẋ, force = F; output rub = dot(reaction(shoe));", "the derivative of a reaction in `reaction(shoe)` is not known; leave the reaction out of it"),
    ("friction shoe: ẋ, force = F; friction grip: ẏ, force = reaction(shoe);", "unknown limit or constraint `shoe`; a friction contains reactions of limits and constraints only"),
    ("limit floor: y >= 0, restitution = e; output rub: N = reaction(floor, friction);", "`floor` has no friction; write `friction = μ along dot(x)` behind the limit, or `reaction(floor)`"),
    ("limit floor: y >= 0, restitution = e; output rub: N = reaction(floor, e);", "`e` is not expected here; expected `friction`, as in `reaction(floor, friction)`"),
    ("limit floor: y >= 0, restitution = e, friction = μ along ẋ; friction shoe: ẏ, force = reaction(floor, friction);", "the force of a friction depends on no other friction; leave it out"),
    ("constraint rod: |r| = L; output rub: N = reaction(rod, friction);", "`rod` is a constraint, without friction; write `reaction(rod)`"),
    ("friction a[k in 0..9]: ṙ*(1 + k), force = F;", "there are 18 scalar rates with friction, and at most 16 are kept; leave some out, or write a `force` with `tanh` for them"),
];

#[test]
fn mistakes_are_told_at_the_friction() {
    for (statements, expected) in REFUSED {
        let found = refusals(&block(statements));
        let told = matches!(&found[..], [one] if one.contains(expected));
        assert!(told, "{statements}: {found:?}");
    }
}

/// `«` and `»` enclose the place of the message.
#[test]
fn messages_stand_at_the_mistake() {
    for statements in [
        "friction shoe: «x», force = F;",
        "friction shoe: «ẋ - u», force = F;",
        "friction shoe: ẋ, force = F, static = «S + F*abs(ẋ)/vs»;",
        "friction shoe: ẋ, force = «-1»;",
        "friction shoe: ẋ, force = «F*L»;",
        "friction shoe: «ẋ»;",
        "friction shoe: ẋ, force = F; friction «shoe»: ẏ, force = F;",
        "friction «a»[k in 0..9]: ṙ*(1 + k), force = F;",
        "limit floor: y >= 0, restitution = e; friction grip: ẋ, force = «μ*reaction(floor)^2/F»;",
        "limit floor: y >= 0, restitution = e; friction grip: ẋ, force = reaction(«flor»);",
        "limit floor: y >= 0, restitution = e, friction = «μ»;",
    ] {
        let marked = block(statements).replace('\n', " ");
        let column = |mark| marked.chars().position(|letter| letter == mark).unwrap();
        let messages = compile(&marked.replace(['«', '»'], "")).unwrap_err();
        let [message] = &messages[..] else { panic!("{statements}: {messages:?}") };
        let found = [message.start.column, message.end.column];
        assert_eq!(found, [column('«'), column('»') - 1], "{statements}: {message:?}");
    }
}

#[test]
fn the_words_of_frictions_are_names_of_parameters_and_definitions() {
    let block = "struct S { friction: N, along: m, m: kg } coordinate x: m; let force = 2*along;
         kinetic = m/2*ẋ^2; potential = friction*x*force/along; friction shoe: ẋ, force = friction;
         limit floor: x >= 0, restitution = 0, friction = along/along along ẋ*along/along;";
    assert!(refusals(block).is_empty(), "{:?}", refusals(block));
}

/// The belt feeds energy, and the friction takes the momentum along it.
#[test]
fn what_friction_takes_is_not_conserved() {
    let planar = |statement: &str| {
        let source = format!(
            "struct S {{ m: kg, F: N }} coordinate x: m; coordinate y: m;
             kinetic = m/2*(ẋ^2 + ẏ^2); {statement}"
        );
        (
            compile(&source).unwrap().conserved,
            derive(&source, |_, _, motion| {
                [motion.nonconservative, motion.velocity_free, motion.separable, motion.linear]
            }),
        )
    };
    assert_eq!(planar("").1, [false, true, true, true]);
    let rubbed = planar("friction shoe: ẋ, force = F;");
    assert_eq!(rubbed, (vec!["p_y".to_owned()], [true, false, false, false]));
}

#[test]
fn a_friction_leaves_the_equations_as_they_are() {
    let plain = compile(&block("force x = u;")).unwrap();
    let rubbed = compile(&block("force x = u; friction shoe: ẋ, force = F, static = S;")).unwrap();
    assert_eq!(plain.equations, rubbed.equations);
    assert_eq!(plain.operations, rubbed.operations);
}

#[test]
fn outputs_show_the_forces_of_contacts_and_frictions() {
    let statements = "limit floor: y >= 0, restitution = e; friction grip: dot(r), force = F;
         output all: N = 2*reaction(floor) + reaction(grip.y); output load: N = m*ẍ;";
    let outputs = compile(&block(statements)).unwrap().outputs;
    assert_eq!(outputs[0].expressions, ["2·reaction(floor) + reaction(grip.y)"]);
    assert_eq!(outputs[1].expressions, ["0"]);
}

#[test]
fn the_documentation_lists_frictions_with_their_units() {
    let source = format!("::p; {}", block("friction grip: dot(r), force = F;"));
    let found = expand(source.parse().unwrap()).to_string();
    let line = "- `grip.y` acts against a rate in m/s; its force in kg·m/s²";
    assert!(found.contains(line), "{found}");
    assert!(!found.contains("does not need `F`"));
}
