//! Random systems written to a source file that is compiled and run, with reference values for each
//! system.

use super::check::{Derived, compare};
use super::interpret::Values;
use crate::compile::derived;
use pendulum_runtime::scalar::{DoubleDouble, Dual, Float, Real};
use random_systems::generate::{self, Manner};
use random_systems::reference::{Reference, State, reference};
use random_systems::state::{precise, state};
use random_systems::tree::{Kind, System};
use std::fmt::Write;

/// The number of systems.
const COUNT: usize = 40;

/// Returns the content of the file.
pub(crate) fn file() -> String {
    let mut text = String::from(
        "//! Random systems and what they do at a random state, in 31 digits. Written by the generator in `tools/random-systems`:\n\
         //! `UPDATE_GOLDEN=1 cargo test -p pendulum-compiler written` writes it anew.\n\n\
         use super::{Case, words};\nuse pendulum_runtime::body::Body;\nuse pendulum_runtime::scalar::Real;\nuse pendulum_runtime::motion::Sample;\n",
    );
    let mut names = Vec::new();
    for seed in 0.. {
        let system = generate::system(seed, Manner::Tame);
        if let Some(module) = module(&system) {
            text.push_str(&module);
            names.push(format!("seed_{seed}"));
        }
        if names.len() == COUNT {
            break;
        }
    }
    let _ = writeln!(text, "\n/// All of them.\nmacro_rules! each {{\n    ($check:ident) => {{");
    for name in names {
        let _ = writeln!(text, "        $check!({name});");
    }
    text.push_str("    };\n}\npub(crate) use each;\n");
    text
}

/// Returns the module of a system; `None` if its source is long or has no value at the state.
fn module(system: &System) -> Option<String> {
    let source = system.source("Random");
    let plain = state(system, system.seed);
    let precise: State<DoubleDouble> = precise(system, &plain);
    let mut errors = crate::messages::Errors::default();
    let (findings, jerk, snap) = derived(&source, &mut errors, |model, graph, motion, _| {
        let derived = Derived { model, graph, motion };
        let [jerk, snap] = higher(&derived, &Values::new(&precise));
        (compare(system, &derived, system.seed), jerk, snap)
    })?;
    if !findings.sound() || findings.pivot < 0.05 || 1200 < source.len() {
        return None;
    }
    let truth = reference(system, &precise);
    let accelerations = solved(&truth);
    let rates: Vec<DoubleDouble> =
        truth.slopes.iter().zip(&truth.externals).map(|(&a, &b)| a + b).collect();
    let dot = |a: &[DoubleDouble], b: &[DoubleDouble]| {
        a.iter().zip(b).fold(DoubleDouble::from(0.0), |sum, (&a, &b)| sum + a * b)
    };
    let energy = dot(&precise.v, &truth.momenta) - truth.lagrangian;
    let power = dot(&precise.v, &truth.externals) - truth.explicit;
    let mut text = String::new();
    let count = system.count();
    let _ = writeln!(text, "\npub(crate) mod seed_{} {{\n    use super::*;\n", system.seed);
    let _ = writeln!(text, "    pendulum_runtime::lagrangian! {{\n        #[derive(Clone, Debug)]");
    for line in source.lines() {
        let _ = writeln!(text, "        {line}");
    }
    let _ = writeln!(
        text,
        "    }}\n\n    pub(crate) fn system<T: Real>() -> Random<T> {{\n        Random::new({})\n    }}\n",
        arguments(system, &precise)
    );
    let (kind, value) = inputs(&precise);
    let _ = writeln!(
        text,
        "    #[rustfmt::skip]\n    pub(crate) fn inputs<T: Real>() -> {kind} {{\n        {value}\n    }}\n"
    );
    let jerks: Vec<String> =
        precise.inputs.iter().flatten().map(|orders| plain_number(orders[3])).collect();
    let _ = writeln!(text, "    pub(crate) const CASE: Case<{count}, {}> = Case {{", jerks.len());
    let _ = writeln!(
        text,
        "        t: {:?},\n        q: {:?},\n        v: {:?},\n        jerks: [{}],",
        plain.t,
        plain.q,
        plain.v,
        jerks.join(", ")
    );
    let lists = [
        ("accelerations", &accelerations),
        ("momenta", &truth.momenta),
        ("momentum_rates", &rates),
        ("third", &jerk),
        ("fourth", &snap),
    ];
    for (name, values) in lists {
        let values: Vec<String> = values.iter().map(|value| digits(*value)).collect();
        let _ = writeln!(text, "        {name}: [{}],", values.join(", "));
    }
    let _ = writeln!(
        text,
        "        energy: {},\n        power: {},\n    }};\n}}",
        digits(energy),
        digits(power)
    );
    Some(text)
}

/// Returns M⁻¹ f of the reference, by elimination.
fn solved(truth: &Reference<DoubleDouble>) -> Vec<DoubleDouble> {
    let count = truth.momenta.len();
    let force = |i: usize| truth.slopes[i] + truth.externals[i] - truth.drifts[i];
    let mut rows: Vec<Vec<DoubleDouble>> =
        (0..count).map(|i| truth.masses[i].iter().copied().chain([force(i)]).collect()).collect();
    for pivot in 0..count {
        for row in 0..count {
            if row != pivot {
                let factor = rows[row][pivot] / rows[pivot][pivot];
                for column in pivot..=count {
                    let part = factor * rows[pivot][column];
                    rows[row][column] -= part;
                }
            }
        }
    }
    (0..count).map(|i| rows[i][count] / rows[i][i]).collect()
}

/// Returns the third and fourth derivatives of the coordinates along the motion.
fn higher(derived: &Derived<'_, '_>, values: &Values<DoubleDouble>) -> [Vec<DoubleDouble>; 2] {
    let of = |values: &Values<DoubleDouble>| {
        values.of(derived.model, derived.graph, &derived.motion.accelerations)
    };
    let second = of(values);
    let first = later(values, &second);
    let third: Vec<DoubleDouble> = first
        .of(derived.model, derived.graph, &derived.motion.accelerations)
        .iter()
        .map(|a| a.derivative)
        .collect();
    // The accelerations have known rates now, so that their second derivatives can be computed.
    let pairs: Vec<Dual<DoubleDouble>> =
        second.iter().zip(&third).map(|(&value, &derivative)| Dual { value, derivative }).collect();
    let twice = later(&first, &pairs);
    let found = twice.of(derived.model, derived.graph, &derived.motion.accelerations);
    let fourth = found.iter().map(|a| a.derivative.derivative).collect();
    [third, fourth]
}

/// Returns all values with their rates.
fn later<T: Real>(values: &Values<T>, accelerations: &[T]) -> Values<Dual<T>> {
    let dual = |value: T, derivative: T| Dual { value, derivative };
    let pairs = |a: &[T], b: &[T]| a.iter().zip(b).map(|(&a, &b)| dual(a, b)).collect::<Vec<_>>();
    let input = |&[x, v, a, j]: &[T; 4]| [dual(x, v), dual(v, a), dual(a, j), Dual::constant(j)];
    Values {
        parameters: values.parameters.iter().map(|&value| Dual::constant(value)).collect(),
        time: Dual::variable(values.time),
        q: pairs(&values.q, &values.v),
        v: pairs(&values.v, accelerations),
        p: Vec::new(),
        inputs: values
            .inputs
            .iter()
            .map(|components| components.iter().map(input).collect())
            .collect(),
    }
}

/// Returns the arguments of `new`.
fn arguments(system: &System, state: &State<DoubleDouble>) -> String {
    let mut arguments = Vec::new();
    for (index, parameter) in system.parameters.iter().enumerate() {
        let first = system.first_parameter(index);
        let own: Vec<String> = (first..first + parameter.kind.count())
            .map(|k| number(state.constants.parameters[k]))
            .collect();
        arguments.push(match parameter.kind {
            Kind::Body => {
                format!(
                    "Body {{ mass: {}, center: [{}], central: [{}] }}",
                    own[0],
                    own[1..3].join(", "),
                    own[3..].join(", ")
                )
            }
            Kind::Vector(_) | Kind::Family(_) => format!("[{}]", own.join(", ")),
            _ => own[0].clone(),
        });
    }
    arguments.join(", ")
}

/// Returns the type and the value of the samples of the driven inputs.
fn inputs(state: &State<DoubleDouble>) -> (String, String) {
    let (mut kinds, mut values) = (String::new(), String::new());
    for components in &state.inputs {
        let order = |order: usize| {
            let parts: Vec<String> =
                components.iter().map(|orders| number(orders[order])).collect();
            parts.join(", ")
        };
        let _ = write!(kinds, "Sample<T, {}>, ", components.len());
        let _ = write!(
            values,
            "Sample {{ position: [{}], velocity: [{}], acceleration: [{}] }}, ",
            order(0),
            order(1),
            order(2)
        );
    }
    (format!("({kinds})"), format!("({values})"))
}

/// Returns the text of a number as the words of a double-double.
fn number(value: DoubleDouble) -> String {
    format!("words({:?}, {:?})", value.high(), (value - DoubleDouble::from(value.high())).to_f64())
}

fn plain_number(value: DoubleDouble) -> String {
    format!("{:?}", value.high())
}

fn digits(value: DoubleDouble) -> String {
    format!("\"{value:.31e}\"")
}
