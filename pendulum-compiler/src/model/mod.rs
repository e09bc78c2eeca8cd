//! Name resolution: determines the meaning of every name of a block, and reports unknown names.

mod declare;
pub(crate) mod frame;
mod integer;
mod reach;
mod resolved;
mod table;
pub(crate) mod unit;
mod walk;

use crate::messages::{Errors, message, shared};
use crate::syntax::ast::{self, Block, ExprKind, Kind, Role, Statement};
use crate::syntax::name::{self, Name, plain};
use declare::{Declared, coordinate, quantity, twice};
pub(crate) use integer::integer;
use proc_macro2::Ident;
use resolved::Place;
pub(crate) use resolved::{Element, Friction, Meaning, Model, Output, Quantity, Table};
use std::collections::{BTreeMap, BTreeSet};
use walk::Walk;

/// The largest number of components of all control inputs, for which the runtime has room
/// (`MOST_CONTROLS` of the core).
const MOST_CONTROLS: usize = 24;

/// Resolves every name, and reports unknown names.
pub(crate) fn resolve<'a>(block: &'a Block, errors: &mut Errors) -> Model<'a> {
    let mut model = Model {
        block,
        parameters: Vec::new(),
        coordinates: Vec::new(),
        mechanical: 0,
        inputs: Vec::new(),
        driven: 0,
        outputs: Vec::new(),
        lets: Vec::new(),
        tables: BTreeMap::new(),
        energies: Vec::new(),
        forces: Vec::new(),
        rates: Vec::new(),
        constraints: Vec::new(),
        limits: Vec::new(),
        frictions: Vec::new(),
        names: BTreeMap::new(),
        unmentioned: BTreeSet::new(),
        unused: Vec::new(),
        of_outputs: BTreeSet::new(),
    };
    model.driven = block
        .statements
        .iter()
        .filter(|statement| matches!(statement, Statement::Input { control: false, .. }))
        .count();
    model.mechanical = block
        .statements
        .iter()
        .filter(|statement| matches!(statement, Statement::Coordinate { state: false, .. }))
        .count();
    let mut declared = Declared::default();
    let mut parameters = 0;
    let (mut states, mut controls) = (Vec::new(), Vec::new());
    for field in &block.fields {
        let meaning = match &field.kind {
            Kind::Table(_, kinds) => {
                Meaning::Table(table::table(&mut model.tables, &field.name, kinds, None, errors))
            }
            _ => Meaning::Parameter(model.parameters.len()),
        };
        declared.declare(&mut model.names, &field.name, meaning, errors);
        let quantity =
            quantity(&field.name, &field.kind, parameters, field.default.as_ref(), errors);
        parameters += quantity.count();
        model.parameters.push(quantity);
    }
    for statement in &block.statements {
        match statement {
            Statement::Coordinate { state, name, length, kind } => {
                let (list, before) = if *state {
                    (&mut states, model.mechanical)
                } else {
                    (&mut model.coordinates, 0)
                };
                let meaning = Meaning::Coordinate(before + list.len());
                declared.declare(&mut model.names, name, meaning, errors);
                list.push(coordinate(*state, name, length.as_ref(), kind, errors));
            }
            Statement::Input { control, name, kind } => {
                let (list, before) =
                    if *control { (&mut controls, model.driven) } else { (&mut model.inputs, 0) };
                let meaning = Meaning::Input(before + list.len());
                declared.declare(&mut model.names, name, meaning, errors);
                let quantity = quantity(name, kind, 0, None, errors);
                if quantity.members.is_some() && !*control {
                    let message = message!(
                        "a driven input is a scalar or a vector; write `[m; 2]` or `[m; 3]`"
                    );
                    errors.at(name.span(), message);
                }
                list.push(quantity);
            }
            Statement::Let(definition) => {
                let meaning = Meaning::Let(model.lets.len());
                declared.declare(&mut model.names, &definition.name, meaning, errors);
                twice(definition, errors);
                model.lets.push(definition);
            }
            Statement::Table(own) => {
                let ast::Table { name, kinds, .. } = &**own;
                let index = table::table(&mut model.tables, name, kinds, Some(own), errors);
                declared.declare(&mut model.names, name, Meaning::Table(index), errors);
            }
            Statement::Energy { role, expr, .. } => model.energies.push((*role, expr)),
            Statement::Force(_)
            | Statement::Rate(_)
            | Statement::Output(_)
            | Statement::Constraint(_)
            | Statement::Limit(_)
            | Statement::Friction(_) => {}
        }
    }
    model.coordinates.append(&mut states);
    model.inputs.append(&mut controls);
    for list in [&mut model.coordinates, &mut model.inputs] {
        let mut first = 0;
        for quantity in list {
            quantity.first = first;
            first += quantity.count();
        }
    }
    if let Some(ninth) = model.inputs.get(8) {
        let inputs = if model.driven < model.inputs.len() { "inputs" } else { "driven inputs" };
        let message = message!("more than eight {inputs}; join some of them into vectors");
        errors.at(ninth.name.span(), message);
    }
    let mut controls = 0;
    for quantity in &model.inputs[model.driven..] {
        controls += quantity.count();
        if MOST_CONTROLS < controls {
            let message = message!(
                "more than {MOST_CONTROLS} components of control inputs; compute their forces in \
                 fewer"
            );
            errors.at(quantity.name.span(), message);
            break;
        }
    }
    for statement in &block.statements {
        match statement {
            Statement::Force(statement) => force(&mut model, statement, errors),
            Statement::Rate(statement) => rate(&mut model, statement, errors),
            Statement::Output(statement) => output(&mut model, statement, errors),
            Statement::Constraint(own) if named_apart(&model, &own.name, errors) => {
                model.constraints.push(own);
            }
            Statement::Limit(own) if named_apart(&model, &own.name, errors) => {
                let (name, index, limit) =
                    (&own.name, own.index.as_ref(), Some(model.limits.len()));
                let friction = own.slip.as_ref().map(|slip| Friction { name, index, slip, limit });
                model.frictions.extend(friction);
                model.limits.push(own);
            }
            Statement::Friction(own) if named_apart(&model, &own.name, errors) => {
                let ast::Friction { name, index, slip } = &**own;
                let index = index.as_ref();
                model.frictions.push(Friction { name, index, slip, limit: None });
            }
            _ => {}
        }
    }
    model.constraints.sort_by_key(|constraint| constraint.redundant);
    model.of_outputs = reach::of_outputs(&model);
    roles(block, errors);
    if model.mechanical == 0 && !block.recovery.declarations {
        let message = message!("no coordinate; write `coordinate θ: rad;` below the struct");
        errors.at(block.name.span(), message);
    }
    let mut walk = Walk {
        model: &model,
        errors,
        scope: Vec::new(),
        mentioned: BTreeSet::new(),
        accelerations: false,
        place: Place::Force,
    };
    walk.block();
    let mentioned = walk.mentioned;
    let open = |meaning: Meaning| !mentioned.contains(&meaning);
    let scalars = |&index: &usize| model.parameters[index].element != Element::Table;
    let unmentioned = (0..model.parameters.len()).filter(scalars);
    model.unmentioned = unmentioned.filter(|&index| open(Meaning::Parameter(index))).collect();
    let inputs = model.inputs.iter().map(|input| input.name).enumerate();
    let inputs = inputs.filter(|&(index, _)| open(Meaning::Input(index)));
    let lets = model.lets.iter().map(|definition| &definition.name).enumerate();
    let lets = lets.filter(|&(index, _)| open(Meaning::Let(index)));
    let tables = model.tables.iter().filter(|&(&index, _)| open(Meaning::Table(index)));
    let names = inputs.chain(lets).map(|(_, name)| name);
    model.unused = names.chain(tables.map(|(_, own)| own.name)).collect();
    model
}

/// The methods of systems. An output with one of these names would hide the method.
#[rustfmt::skip]
const METHODS: &[&str] = &[
    "accelerations", "accelerations_at", "accelerations_prepared", "accelerations_staged", "accelerations_with", "across_kink",
    "at_position", "at_time", "begin", "clone", "conserved", "constraint_jacobian", "control", "control_jacobian", "controlled_by",
    "controls", "correction", "driven_by", "energy", "energy_at", "fmt", "forces", "gap_jacobian", "gaps", "hamilton", "independence",
    "inputs", "inputs_with", "kinetic_energy", "kink_before", "longest_step", "map", "mass_matrix", "misfit_scales", "misfits", "momenta",
    "momentum_rates", "new", "next_kink", "output", "output_of", "over", "parameter_jacobian", "position_jacobian", "potential_energy", "power",
    "power_at", "prepare", "reactions", "reactions_at", "redundant_misfits", "restitutions", "sample", "sampled", "system", "velocities",
    "velocity_jacobian",
];

fn output<'a>(model: &mut Model<'a>, statement: &'a ast::Output, errors: &mut Errors) {
    let name = &statement.name;
    let Name { base, dots } = name::read(&name.to_string());
    let twice = model.outputs.iter().any(|other| plain(other.declared.name) == base);
    let refusal = match model.names.get(&base) {
        _ if 0 < dots => Some(message!(
            "`{name}` is a time derivative; give the output a name without dots, as `rate`"
        )),
        _ if twice => Some(message!("two outputs are called `{name}`; rename one of the two")),
        _ if METHODS.contains(&name.to_string().as_str()) => {
            Some(shared::held_name(name, "a method of every system"))
        }
        _ if base == "FACTS" => Some(shared::held_name(name, "a constant of every system")),
        Some(Meaning::Parameter(_) | Meaning::Coordinate(_) | Meaning::Input(_)) => {
            Some(message!("`{name}` is declared already; choose another name for the output"))
        }
        Some(Meaning::Let(_) | Meaning::Table(_)) | None => None,
    };
    if let Some(message) = refusal {
        errors.at(name.span(), message);
        // A second method of this name would result in an error of rustc as well.
        return;
    }
    let declared = quantity(name, &statement.kind, 0, None, errors);
    model.outputs.push(Output { declared, statement });
}

/// Returns `true` if the name of a constraint, a limit or a friction is free, and reports it
/// otherwise.
fn named_apart(model: &Model, name: &Ident, errors: &mut Errors) -> bool {
    let Name { base, dots } = name::read(&name.to_string());
    let others = model.constraints.iter().map(|constraint| &constraint.name);
    let mut others = others.chain(model.limits.iter().map(|limit| &limit.name));
    let mut frictions = model.frictions.iter().map(|friction| friction.name);
    let refusal = match model.names.get(&base) {
        _ if 0 < dots => {
            Some(message!("`{name}` is a time derivative; write the name without dots"))
        }
        _ if others.any(|other| plain(other) == base) => {
            Some(message!("two constraints or limits are called `{name}`; rename one of the two"))
        }
        _ if frictions.any(|other| plain(other) == base) => {
            Some(message!("a friction is called `{name}` already; rename one of the two"))
        }
        Some(Meaning::Parameter(_) | Meaning::Coordinate(_) | Meaning::Input(_)) => {
            Some(message!("`{name}` is declared already; choose another name"))
        }
        Some(Meaning::Let(_) | Meaning::Table(_)) | None => None,
    };
    match refusal {
        Some(message) => errors.at(name.span(), message),
        None => return true,
    }
    false
}

fn force<'a>(model: &mut Model<'a>, statement: &'a ast::Force, errors: &mut Errors) {
    let named = match &statement.point.kind {
        ExprKind::Index(base, _) => &base.kind,
        kind => kind,
    };
    // What a torque acts on is no name of a coordinate as a rule.
    let (ExprKind::Name(name), false) = (named, statement.torque) else {
        return model.forces.push(statement);
    };
    let Name { base, dots } = name::read(&name.to_string());
    match model.names.get(&base) {
        Some(&Meaning::Coordinate(index)) if dots == 0 && index < model.mechanical => {
            model.forces.push(statement);
        }
        Some(Meaning::Let(_)) if dots == 0 => model.forces.push(statement),
        Some(Meaning::Coordinate(_)) if dots == 0 => {
            let message = message!(
                "`{name}` is a state, which nothing pushes; write what changes it into its `rate`"
            );
            errors.at(name.span(), message);
        }
        Some(_) => {
            let message = message!(
                "`{name}` is no coordinate; a force acts on a coordinate, as in `force θ = …;`"
            );
            errors.at(name.span(), message);
        }
        None if model.block.recovery.declarations => {}
        None => {
            let known = model.coordinates[..model.mechanical]
                .iter()
                .map(|coordinate| coordinate.name.to_string())
                .collect::<Vec<_>>();
            let (span, name) = (name.span(), name.to_string());
            let nearest = name::nearest(&name, known.iter().map(String::as_str));
            let declare = format!("declare it, as in `coordinate {name}: m;`");
            errors.at(span, shared::unknown("coordinate", &name, nearest, &declare));
        }
    }
}

fn rate<'a>(model: &mut Model<'a>, statement: &'a ast::Force, errors: &mut Errors) {
    let point = &statement.point;
    let named = match &point.kind {
        ExprKind::Index(base, _) => &base.kind,
        kind => kind,
    };
    let ExprKind::Name(name) = named else {
        let message = message!("a rate is that of a state; write `rate z = …;` with its name");
        errors.at(point.range, message);
        return;
    };
    let Name { base, dots } = name::read(&name.to_string());
    let message = match model.names.get(&base) {
        Some(&Meaning::Coordinate(index)) if dots == 0 && model.mechanical <= index => {
            model.rates.push(statement);
            return;
        }
        _ if 0 < dots => message!("the rate of a state has its name without dots; write `{base}`"),
        Some(Meaning::Coordinate(_)) => message!(
            "`{name}` is a coordinate, which forces move; declare it as `state {name}` to give \
             its rate, or write a `constraint` of its velocity"
        ),
        Some(_) => message!("`{name}` is no state; declare what has a rate as `state`"),
        None if model.block.recovery.declarations => return,
        None => {
            let states = model.coordinates[model.mechanical..].iter();
            let known: Vec<String> = states.map(|state| state.name.to_string()).collect();
            let nearest = name::nearest(&base, known.iter().map(String::as_str));
            let declare = format!("declare it, as in `state {name}: m;`");
            shared::unknown("state", name, nearest, &declare)
        }
    };
    errors.at(name.span(), message);
}

/// Checks that a block contains either a single `lagrangian`, or `kinetic` and `potential`.
fn roles(block: &Block, errors: &mut Errors) {
    let mut lagrangian = None;
    let mut split = None;
    for statement in &block.statements {
        if let Statement::Energy { role, keyword, .. } = statement {
            match role {
                Role::Lagrangian if lagrangian.is_some() => {
                    errors.at(*keyword, message!("`lagrangian` stands twice; write one sum"));
                }
                Role::Lagrangian => lagrangian = Some(*keyword),
                Role::Kinetic | Role::Potential => split = split.or(Some(*keyword)),
                Role::Dissipation => {}
            }
        }
    }
    if let (Some(_), Some(split)) = (lagrangian, split) {
        let message = message!(
            "`lagrangian` is kinetic minus potential energy already; write either one or the other"
        );
        errors.at(split, message);
    }
    if lagrangian.is_none() && split.is_none() && !block.recovery.energies {
        let message =
            message!("no energy; write `kinetic = …;` and `potential = …;` below the struct");
        errors.at(block.name.span(), message);
    }
}
