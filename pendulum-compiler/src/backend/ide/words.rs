//! The keywords of the language with their documentation, as items for editors.

use crate::algebra::dimension::{Dimension, UNITS};
use crate::algebra::functions::{UnitRule, Word};
use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;

/// The keywords of statements, except `let`, which has documentation in Rust. Each word of these
/// tables stands before its text.
const STATEMENTS: &[&str] = &[
    "coordinate: A generalized coordinate, a vector of two or three, or a family of either.

Its velocity is `theta_dot`, `θ̇` or `dot(theta)`.

```text
coordinate theta: rad;
coordinate theta[5]: rad;
coordinate x: [m; 3];
```",
    "state: A state of first order, whose `rate` is given: a filter, a motor, a bristle, an \
     integral.

It stands anywhere, has no inertia and exerts no force.

```text
state z: V;
state z[4]: V;
state z: [V; 3];
```",
    "rate: The rate of a state, in its unit per second.

```text
rate z = (u - z)/T;
rate z[k in 0..4] = (u[k] - z[k])/T;
```",
    "driven: A driven input: a motion that `driven_by` prescribes.

The input and its velocity stand anywhere, its acceleration outside of energies.

```text
driven x: [m; 2];
```",
    "input: A control input: a value that `controlled_by` or `sampled` supplies.

It has no derivative, and stands in `force`, `potential`, `dissipation` and `output`.

```text
input u: N*m;
```",
    "table: A function through some points: a natural cubic spline.

Beyond its points it goes on along its tangents, or is refused.

```text
table f(x: m): N = [(0, 0), (0.1, 3), (0.3, 4)], outside = linear;
```",
    "kinetic: A kinetic energy; several of them add.

```text
kinetic = m/2*L^2*theta_dot^2;
```",
    "potential: A potential energy; several of them add.

```text
potential = -m*g*L*cos(theta);
```",
    "lagrangian: The Lagrangian, kinetic minus potential energy, instead of `kinetic` and \
     `potential`.

```text
lagrangian = m/2*L^2*theta_dot^2 + m*g*L*cos(theta);
```",
    "dissipation: A Rayleigh function R, whose force on each coordinate is −∂R/∂q̇.

```text
dissipation = b/2*theta_dot^2;
```",
    "force: A force on a coordinate, or on any expression that coordinates move.

Its unit is an energy per unit of what it acts on: a torque for an angle.

```text
force theta = u - b*theta_dot;
force tip = [0, -m*g];
force theta[k in 0..5] = -b*theta_dot[k];
```",
    "torque: A torque on a rotation that moves, in the components of space.

```text
torque R = -c*angular_velocity(R);
```",
    "output: A named value, which becomes a method of the system.

It may contain accelerations and reactions.

```text
output tip: [m; 2] = L*[sin(theta), -cos(theta)];
```",
    "constraint: A constraint: an equation of positions, or one that is affine in the velocities.

`reaction(rod)` is its multiplier.

```text
constraint rod: |r| = L;
```",
    "redundant: Marks a constraint that follows from others: it is checked while running, not \
     solved.

```text
redundant constraint rod: |r| = L;
```",
    "limit: A one-sided limit of positions: impacts, and contact while it pushes.

```text
limit floor: y >= 0, restitution = 0.8;
limit floor: y >= 0, restitution = 0, friction = 0.3 along x_dot;
```",
    "friction: Dry friction: a force of a known magnitude against a rate, which sticks at zero.

While the rate is zero, what holds it is at most `static` or, without it, `force`.

```text
friction shoe: x_dot, force = F, static = S;
friction joint[k in 0..3]: theta_dot[k], force = F;
```",
];

/// The options of statements.
const CHOICES: &[&str] = &[
    "restitution: The coefficient of restitution of a limit: the velocity after an impact over \
     that before, from 0 to 1.",
    "force: The magnitude of a friction while its rate is not zero, which may depend on the rate.",
    "friction: The coefficient of friction of a limit, followed by `along` and the rate that \
     slides; in a reaction, the force of this friction.",
    "along: The rate that slides in a contact with friction.",
    "outside: What a table is beyond its points: `linear` or `refused`.",
    "linear: A table goes on along its tangents.",
    "refused: The run ends with an error where the argument of a table leaves its points.",
];

/// The components of vectors and bodies.
const COMPONENTS: &[&str] = &[
    "x: The first component of a vector.",
    "y: The second component of a vector.",
    "z: The third component of a space vector.",
    "mass: The mass of a body in kg.",
    "center: The centre of mass of a body in m, at the angle zero.",
    "inertia: The moment of inertia of a body about its pivot in kg·m².",
];

/// The constants of expressions.
const CONSTANTS: &[&str] = &[
    "t: The time in seconds.",
    "pi: The number π.",
    "i: The imaginary unit, unless an index has the name.",
];

/// The forms of expressions with the syntax of calls, each with the name of its argument.
const FORMS: &[&str] = &[
    "sum(terms): The sum over an index that is known while compiling.

```text
sum(k in 0..5, m[k]*height(r[k]))
```",
    "product(factors): The product of rotations over an index, the first outermost.

```text
product(k in 0..3, rotation(n[k], phi[k]))
```",
    "integral(terms): The integral of ρ times an expression over a body, for each of its points.

The expression has degree two or less in the point.

```text
integral(p in B, |dot(cis(theta)*p)|^2/2)
```",
    "reaction(constraint): The multiplier λ of a constraint, for outputs: a force along its \
     gradient.

Likewise the force of a limit and that of a friction. In frictions: the reaction of a limit, and the
size of that of a constraint, `abs(reaction(rod))`.

```text
output tension: N = reaction(rod);
friction grip: x_dot, force = mu*reaction(floor);
```",
];

/// Returns the modules of words that [`copy`](super::copy) refers to.
pub(crate) fn modules() -> TokenStream {
    let statements = list(STATEMENTS, &quote!(Statement));
    let choices = list(CHOICES, &quote!(Choice));
    let components = list(COMPONENTS, &quote!(Component));
    let constants = list(CONSTANTS, &quote!(f64));
    let units = UNITS.iter().map(|&(name, exponents, meaning)| {
        let base = Dimension::whole(exponents).to_string();
        let derived = base != name && name != "rad";
        let base = if derived { format!("\n\n1 {name} = 1 {base}") } else { String::new() };
        item(name, &format!("{meaning}{base}"), &quote!(Unit))
    });
    let forms = rows(FORMS).map(|(form, text)| {
        let (name, argument) = form.split_once('(').unwrap_or_default();
        function(name, text, &[argument.trim_end_matches(')')])
    });
    let functions = Word::all().map(|word| {
        let text = format!("{}\n\n{}", word.meaning, rule(word.units));
        function(word.name, &text, &["x", "y"][..word.arity()])
    });
    quote! {
        /// The beginning of a statement.
        pub struct Statement;
        /// An option of a statement.
        pub struct Choice;
        /// A unit.
        pub struct Unit;
        /// A component of a vector or a body.
        pub struct Component;
        /// A constraint.
        pub struct Constraint;
        /// A scalar, a vector, a complex number or a family.
        pub trait Quantity {}
        pub mod statements {
            use super::Statement;
            #statements
        }
        pub mod choices {
            use super::Choice;
            #choices
        }
        pub mod units {
            use super::Unit;
            #(#units)*
            /// A rigid planar body, as the kind of a parameter.
            pub static body: Unit;
            /// A rigid body in space, as the kind of a parameter.
            pub static solid: Unit;
            /// A rotation in space, as the kind of a coordinate or of a driven input.
            pub static rotation: Unit;
        }
        pub mod components {
            use super::Component;
            #components
        }
        pub mod expressions {
            use super::Quantity;
            #constants #(#forms)* #(#functions)*
        }
    }
}

/// Returns a rule of units as a sentence.
fn rule(units: UnitRule) -> &'static str {
    match units {
        UnitRule::Pure => "The argument and the value are pure numbers.",
        UnitRule::Same => "The value has the unit of the argument.",
        UnitRule::Root => "The value has the root of the argument's unit.",
        UnitRule::Rate => "The value has the unit of the argument per second.",
        UnitRule::Product => "The unit of the value is the product of those of the arguments.",
        UnitRule::Any => "The argument has any unit, the value is a pure number.",
        UnitRule::Common => "The arguments and the value have one unit.",
        UnitRule::Turn => {
            "The axis has any unit and any length but zero, the angle is a pure number."
        }
        UnitRule::Ratio => "The arguments have one unit, the value is a pure number.",
    }
}

/// Returns the words of a table with their texts.
fn rows<'w>(table: &[&'w str]) -> impl Iterator<Item = (&'w str, &'w str)> {
    table.iter().filter_map(|row| row.split_once(": "))
}

fn list(table: &[&str], kind: &TokenStream) -> TokenStream {
    rows(table).map(|(name, meaning)| item(name, meaning, kind)).collect()
}

fn item(name: &str, text: &str, kind: &TokenStream) -> TokenStream {
    let name = Ident::new(name, Span::call_site());
    quote!(#[doc = #text] pub static #name: #kind;)
}

fn function(name: &str, text: &str, arguments: &[&str]) -> TokenStream {
    let name = Ident::new(name, Span::call_site());
    let arguments = arguments.iter().map(|argument| Ident::new(argument, Span::call_site()));
    quote! {
        #[doc = #text]
        pub fn #name(#(#arguments: impl Quantity),*) -> impl Quantity;
    }
}

#[cfg(test)]
mod tests {
    use super::{COMPONENTS, CONSTANTS, FORMS, STATEMENTS, UNITS, Word, modules, rows};
    use crate::algebra::dimension::Dimension;
    use crate::model::unit::unknown_unit;
    use crate::syntax::parse::statement;
    use std::collections::BTreeSet;

    #[test]
    fn every_statement_has_its_word() {
        let words: BTreeSet<&str> = rows(STATEMENTS).map(|row| row.0).chain(["let"]).collect();
        assert_eq!(words, statement::STATEMENTS.into_iter().collect());
    }

    #[test]
    fn every_unit_has_its_word() {
        // The units listed in the message.
        let message = unknown_unit("parsec").to_string();
        let list = message.split('`').filter(|part| Dimension::of(part.trim()).is_some());
        let known: BTreeSet<&str> = list.map(str::trim).collect();
        let words: BTreeSet<&str> = UNITS.iter().map(|row| row.0).collect();
        assert_eq!(known, words);
    }

    #[test]
    fn words_are_unique_and_documented() {
        let mut names = BTreeSet::new();
        let tables = [COMPONENTS, CONSTANTS, FORMS];
        assert!(tables.concat().iter().all(|row| row.contains(": ")));
        let rows = tables.into_iter().flat_map(rows);
        for (name, text) in rows.chain(Word::all().map(|word| (word.name, word.meaning))) {
            assert!(names.insert(name), "{name}");
            assert!(text.ends_with(['.', '`', '²']), "{name}: {text}");
        }
        let all = modules().to_string();
        for word in Word::all() {
            assert!(all.contains(&format!("pub fn {} (", word.name)), "{}", word.name);
        }
    }
}
