//! The Euler–Lagrange equations: momenta, mass matrix, forces, accelerations, energy and power from
//! the Lagrangian.
//!
//! d/dt ∂L/∂q̇ − ∂L/∂q = Q − ∂R/∂q̇, where d/dt acts through the coordinates, the driven inputs and
//! time.

use crate::algebra::diff::{derivative, substitute};
use crate::algebra::expr::rule;
use crate::algebra::expr::{Dependencies, Graph, Id, Symbol};
use crate::algebra::number::Rational;
use crate::algebra::order;
use crate::algebra::value_numbering;
use crate::algebra::velocity_polynomial::collected;
use crate::mechanics::articulated::{self, Held, Sparse};
use crate::mechanics::attitude;
use crate::mechanics::bounds::{
    BY_PRODUCT, MOST_PART, MOST_WORK, long_derivation, long_equations, long_input, uncoupled,
};
use crate::mechanics::constraint::{self, Constraints};
use crate::mechanics::derivation::{Derivation, named_input};
use crate::mechanics::jacobian;
use crate::mechanics::lower::{
    Energies, at_rest, at_rest_controls, chain, explicit_rate, total_derivative,
};
use crate::mechanics::motion::Motion;
use crate::mechanics::sign;
use crate::mechanics::solve;
use crate::mechanics::state;
use crate::mechanics::symmetry;
use crate::messages::{Errors, message};
use crate::model::{Element, Model, Quantity};
use crate::schedule;
use proc_macro2::{Ident, Span};

/// The limit on the estimated operations of Jacobians. Larger Jacobians are computed with dual
/// numbers instead, which keeps expansions small.
const LONGEST_JACOBIAN: usize = 4000;

/// The limit on the rows of mass matrices that are always solved in dense form. Above it, the dense
/// form is derived only if there is no cheaper sparse form.
const LARGEST_DENSE: usize = 12;

/// The corresponding limit on the products of an elimination with multipliers.
const LARGEST_FILLED: usize = LARGEST_DENSE.pow(3) / 3;

/// The sparse form is used if its cost is less than this fraction of the cost of the dense form.
/// The fraction is well below 1 because the operations of the sparse form are sequential, from the
/// leaves to the root and back. Chains of nine or more links are faster in the sparse form (`cargo
/// bench -p pendulum-runtime --bench chains`).
const CLEARLY: f64 = 0.55;

/// The factor by which an energy without cancellation may cost more. The half angle requires a
/// further sine and cosine.
const DEARER: f64 = 2.5;

/// Derives the equations of motion of a block without mistakes. The result does not depend on the
/// notation of the energies.
pub(crate) fn derive(
    model: &Model,
    graph: &mut Graph,
    energies: &mut Energies,
    errors: &mut Errors,
) -> Option<Motion> {
    if !errors.is_empty() {
        return None;
    }
    *graph = order::canonicalize(graph, &mut energies.roots());
    let chained = energies.extended.as_ref().is_some_and(|own| !own.frames.is_empty());
    long_input(model, graph, energies, chained, errors);
    if !errors.is_empty() {
        return None;
    }
    let before = chained.then(|| graph.clone());
    graph.limit_work(MOST_PART);
    let mut found = Errors::default();
    let mut block = Derivation { model, graph, energies, errors: &mut found };
    let mut motion = equations(&mut block, false);
    if let (true, Some(before)) = (graph.spent(), before) {
        // The velocities of a long chain of rotations, written out in those of the coordinates, are
        // polynomials of millions of terms.
        *graph = before;
        graph.limit_work(MOST_PART);
        found = Errors::default();
        let mut block = Derivation { model, graph, energies, errors: &mut found };
        motion = equations(&mut block, true);
    }
    if graph.spent() {
        // What was found then is due to the zeros beyond the limit.
        long_derivation(model, errors);
    } else {
        found.into_iter().for_each(|error| errors.push(error));
    }
    if errors.is_empty() {
        let outputs = energies.outputs.iter().flat_map(|output| output.scalars.iter().copied());
        let roots: Vec<Id> = motion.roots().into_iter().map(|id| *id).chain(outputs).collect();
        let most = uncoupled(&motion, &motion.accelerations);
        let mut block = Derivation { model, graph, energies, errors };
        long_equations(&mut block, &most, &roots, 0);
    }
    if !errors.is_empty() {
        return None;
    }
    attitude::widen_energies(model, graph, energies);
    put_accelerations(graph, &motion, energies);
    let mut in_rates = motion.in_rates.take();
    let mut roots = motion.roots();
    roots.extend(energies.roots());
    roots.extend(in_rates.iter_mut().flat_map(|printed| printed.roots()));
    *graph = order::canonicalize(graph, &mut roots);
    motion.in_rates = in_rates;
    Some(motion)
}

/// Substitutes the accelerations and the multipliers in the outputs that contain them. Without
/// contacts and frictions, their forces are zero.
fn put_accelerations(graph: &mut Graph, motion: &Motion, energies: &mut Energies) {
    let accelerations: Vec<Id> = motion.accelerations.iter().map(|&id| graph.closed(id)).collect();
    let multipliers = &motion.constraints.multipliers;
    let multipliers: Vec<Id> = multipliers.iter().map(|&id| graph.closed(id)).collect();
    let unknown = Dependencies::ACCELERATION.or(Dependencies::MULTIPLIER);
    let value = |symbol| match symbol {
        Symbol::Acceleration(index) => accelerations.get(index).copied(),
        Symbol::Multiplier(index) => multipliers.get(index).copied(),
        Symbol::Contact(_) | Symbol::Friction(_) => Some(Graph::ZERO),
        _ => None,
    };
    let Constraints { limits, frictions, .. } = &motion.constraints;
    let pushed = !limits.is_empty() || !frictions.is_empty();
    for output in &mut energies.outputs {
        if !output.scalars.iter().any(|&scalar| graph.dependencies(scalar).any(unknown)) {
            continue;
        }
        if pushed {
            output.open.clone_from(&output.scalars);
        }
        for scalar in &mut output.scalars {
            *scalar = substitute(graph, *scalar, value);
        }
    }
}

/// Derives the equations of motion, and reports directions without kinetic energy. `long` chains
/// of rotations are derived in sparse form only.
fn equations(block: &mut Derivation, long: bool) -> Motion {
    let (model, energies) = (block.model, block.energies);
    let graph = &mut *block.graph;
    let collected = |graph: &mut Graph, id| if long { id } else { collected(graph, id) };
    let kinetic = energies.kinetic.map(|id| collected(graph, id));
    let potential = energies.potential.map(|id| collected(graph, id));
    let lagrangian = energies
        .lagrangian
        .unwrap_or_else(|| graph.sub(kinetic.unwrap_or_default(), potential.unwrap_or_default()));
    let lagrangian = collected(graph, lagrangian);
    let count = energies.forces.len();
    let dissipation = energies.dissipation.map(|id| collected(graph, id)).unwrap_or_default();
    if graph.spent() {
        return Motion::default();
    }
    graph.limit_work(MOST_WORK);

    let velocity: Vec<Id> = (0..count).map(|i| graph.symbol(Symbol::Velocity(i))).collect();
    let extended = energies.extended.as_ref();
    let in_sparse_form = |graph: &mut Graph| articulated::sparse(graph, extended?, count, long);
    let alone = if long { in_sparse_form(graph) } else { None };
    let (momenta, mut mass_matrix): (Vec<Id>, _);
    if let Some(Sparse { momenta: own, dense: Some((masses, _)), .. }) = &alone {
        (momenta, mass_matrix) = (own.clone(), masses.clone());
    } else {
        momenta = (0..count).map(|i| derivative(graph, lagrangian, Symbol::Velocity(i))).collect();
        mass_matrix = vec![vec![Graph::ZERO; count]; count];
        for i in 0..count {
            for j in 0..=i {
                let entry = derivative(graph, momenta[i], Symbol::Velocity(j));
                mass_matrix[i][j] = entry;
                mass_matrix[j][i] = entry;
            }
        }
    }
    attitude::add_radial(model, graph, &mut mass_matrix);
    let mut motion = Motion { mass_matrix, ..Motion::default() };
    if energies.extended.is_none() {
        // No sparse form replaces this elimination; the forces need not be derived to refuse it.
        let products = solve::products(&motion.mass_matrix, count);
        long_equations(block, &[], &momenta, BY_PRODUCT * products);
        if !block.errors.is_empty() {
            return motion;
        }
    }
    let jerk = has_jerk(block, lagrangian, &momenta);
    let regular = solve::regular(block, &motion.mass_matrix);
    let positive = sign::positive(block, &motion.mass_matrix);
    let dissipates = sign::dissipates(block, dissipation);
    if !regular || !positive || !dissipates || jerk {
        return motion;
    }

    let constraints = constraint::derive(block);
    if !block.errors.is_empty() {
        return motion;
    }
    motion.constraints = constraints;
    let graph = &mut *block.graph;

    // Terms with control inputs do work like a force, because the rates of the inputs are unknown.
    let own = at_rest_controls(graph, lagrangian);
    let controlled = if own == lagrangian { Graph::ZERO } else { graph.sub(lagrangian, own) };
    let mut power = Vec::new();
    let mut externals = Vec::new();
    let slopes = attitude::slopes(model, graph, lagrangian, count);
    let controls = attitude::slopes(model, graph, controlled, count);
    let turning = attitude::gyroscopic(model, graph, &momenta);
    let own_momentum = model
        .coordinates
        .iter()
        .flat_map(|coordinate| vec![coordinate.element != Element::Rotation; coordinate.count()]);
    let own_momentum: Vec<bool> = own_momentum.collect();
    for i in 0..count {
        let slope = slopes[i];
        if slope == Graph::ZERO && own_momentum[i] && !motion.constraints.bound(i) {
            motion.cyclic.push(i);
        }
        let friction = derivative(graph, dissipation, Symbol::Velocity(i));
        let external = graph.sub(energies.forces[i], friction);
        externals.push(external);
        let working = graph.add(external, controls[i]);
        power.push((graph.mul(velocity[i], working), Rational::ONE));
        if let Some(Sparse { momentum_rates, dense: Some((_, forces)), .. }) = &alone {
            motion.momentum_rates.push(momentum_rates[i]);
            motion.forces.push(forces[i]);
            continue;
        }
        let rate = graph.add(slope, external);
        motion.momentum_rates.push(rate);
        // dp/dt along the motion at constant velocities. The accelerations are in the term M q̈.
        let drift = total_derivative(graph, momenta[i], &energies.rates);
        let force = graph.sub(rate, drift);
        let force = graph.sub(force, turning[i]);
        motion.forces.push(collected(graph, force));
    }
    let sparse = if alone.is_some() { alone } else { in_sparse_form(graph) };
    // Long forces of coordinates that are not coupled make long accelerations.
    let most = uncoupled(&motion, &motion.forces);
    let mut roots = [&motion.forces[..], &momenta].concat();
    if motion.constraints.held.is_empty()
        && let Some(sparse) =
            sparse.as_ref().filter(|sparse| prevails(graph, &motion, &momenta, sparse))
    {
        roots = [&motion.forces[..], &motion.mass_matrix.concat()].concat();
        roots.extend((!long).then_some(lagrangian));
        roots.extend(sparse.roots());
    }
    let products = if sparse.is_some() { 0 } else { solve::products(&motion.mass_matrix, count) };
    long_equations(block, &most, &roots, BY_PRODUCT * products);
    if !block.errors.is_empty() {
        return motion;
    }
    let graph = &mut *block.graph;
    solved(graph, &mut motion, &momenta, sparse.as_ref());
    constrained(graph, &mut motion, sparse.as_ref());

    let action = graph.inner(&velocity, &momenta);
    let energy = graph.sub(action, own);
    motion.energy = match &sparse {
        Some(sparse) if long => sparse.energy,
        _ => collected(graph, energy),
    };
    // ∂L/∂t at constant coordinates and velocities. States change as a function of time would.
    let explicit = chain(graph, own, Vec::new(), |graph, symbol| match symbol {
        Symbol::Coordinate(index) => energies.rates.get(&index).copied(),
        other => explicit_rate(graph, other),
    });
    power.push((explicit, Rational::MINUS_ONE));
    if !motion.constraints.held.is_empty() {
        let symbols: Vec<Id> = motion.constraints.symbols(graph);
        let printed = [&power[..], &motion.constraints.power_terms(graph, &symbols)].concat();
        motion.constraints.power = Some(graph.sum(&printed));
        let multipliers = motion.constraints.multipliers.clone();
        power.extend(motion.constraints.power_terms(graph, &multipliers));
    }
    motion.power = graph.sum(&power);

    if energies.lagrangian.is_none() {
        motion.potential = Some(at_rest_controls(graph, potential.unwrap_or_default()));
    }
    motion.kinetic = kinetic.or(motion.potential.map(|_| Graph::ZERO));
    motion.nonconservative = energies.dissipation.is_some()
        || !model.forces.is_empty()
        || controlled != Graph::ZERO
        || !energies.frictions.is_empty()
        || graph.symbols(&[lagrangian]).iter().any(|symbol| {
            matches!(symbol, Symbol::Coordinate(place) if energies.rates.contains_key(place))
        });
    let directions = motion.constraints.directions();
    let forces = [std::slice::from_ref(&externals), &directions].concat();
    let rotations: Vec<usize> =
        attitude::rotations(model).into_iter().map(|(first, _)| first).collect();
    motion.conserved =
        symmetry::conserved(graph, lagrangian, &slopes, &momenta, &forces, &rotations);
    motion.momenta = momenta;
    state::widen(graph, &mut motion, &energies.rates);
    attitude::widen(model, graph, &mut motion, &turning);
    motion.find_facts(graph, energies);
    motion.jacobians = jacobians(model, graph, &motion);
    if let Some(sparse) = sparse {
        shorten(graph, &mut motion.momenta, &sparse.momenta, CLEARLY);
        if motion.constraints.held.is_empty() {
            shorten(graph, &mut motion.momentum_rates, &sparse.momentum_rates, CLEARLY);
            motion.unsolved = Some(sparse.unsolved);
        }
        shorten(graph, std::slice::from_mut(&mut motion.energy), &[sparse.energy], CLEARLY);
        if let (Some(kinetic), Some(short)) = (&mut motion.kinetic, sparse.kinetic) {
            shorten(graph, std::slice::from_mut(kinetic), &[short], CLEARLY);
        }
    }
    number(graph, &mut motion);
    for energy in
        [&mut motion.energy].into_iter().chain(&mut motion.kinetic).chain(&mut motion.potential)
    {
        let kept = rule::without_cancellation(graph, *energy);
        if kept != *energy {
            shorten(graph, std::slice::from_mut(energy), &[kept], DEARER);
        }
    }
    motion
}

/// Solves for accelerations and multipliers together, and adds the constraint forces to the rates
/// of the momenta.
fn constrained(graph: &mut Graph, motion: &mut Motion, sparse: Option<&Sparse>) {
    let constraints = &mut motion.constraints;
    if constraints.held.is_empty() {
        return;
    }
    let held = sparse.and_then(|sparse| sparse.held.as_ref());
    let matrix = constraints.matrix(graph, &motion.mass_matrix);
    let filled = solve::products(&matrix, motion.forces.len());
    let known = held.filter(|held| {
        // The dense form would take this many operations, both to derive and to evaluate.
        LARGEST_FILLED < filled && schedule::cost(graph, &held.accelerations) < filled
    });
    if known.is_none() {
        motion.accelerations = constraints.solve(graph, &motion.mass_matrix, &motion.forces);
    }
    let cheaper =
        |held: &&Held| is_cheaper(graph, &held.accelerations, &motion.accelerations, CLEARLY);
    if let Some(held) = known.or_else(|| held.filter(cheaper)) {
        motion.accelerations.clone_from(&held.accelerations);
        constraints.multipliers.clone_from(&held.multipliers);
        constraints.correction.clone_from(&held.correction);
        constraints.independence.clone_from(&held.independence);
    }
    let multipliers: Vec<Id> = constraints.multipliers.iter().map(|&id| graph.closed(id)).collect();
    let forces = constraints.forces(graph, &multipliers);
    for (rate, force) in motion.momentum_rates.iter_mut().zip(forces) {
        *rate = graph.add(*rate, force);
    }
    let symbols = constraints.symbols(graph);
    let forces = constraints.forces(graph, &symbols);
    constraints.sides =
        motion.forces.iter().zip(forces).map(|(&own, force)| graph.add(own, force)).collect();
}

/// Applies value numbering to each output if that is cheaper.
fn number(graph: &mut Graph, motion: &mut Motion) {
    let lists = [
        &mut motion.accelerations,
        &mut motion.momenta,
        &mut motion.forces,
        &mut motion.momentum_rates,
        &mut motion.constraints.multipliers,
        &mut motion.constraints.correction,
        &mut motion.constraints.independence,
    ];
    let single = [&mut motion.energy, &mut motion.power].into_iter();
    let single = single.chain(&mut motion.kinetic).chain(&mut motion.potential);
    let lists = lists.into_iter().chain(&mut motion.velocities).map(Vec::as_mut_slice);
    let all = lists.chain(single.map(std::slice::from_mut));
    for roots in all {
        let numbered = value_numbering::numbered(graph, roots);
        if numbered != roots {
            shorten(graph, roots, &numbered, 1.0);
        }
    }
}

/// Solves for the accelerations and for the velocities, in the cheaper form.
fn solved(graph: &mut Graph, motion: &mut Motion, momenta: &[Id], sparse: Option<&Sparse>) {
    if let Some(sparse) = sparse.filter(|sparse| prevails(graph, motion, momenta, sparse)) {
        motion.accelerations.clone_from(&sparse.accelerations);
        motion.velocities = Some(sparse.velocities.clone());
        return;
    }
    motion.accelerations = solve::solve(graph, &motion.mass_matrix, &motion.forces);
    motion.velocities = invert(graph, &motion.mass_matrix, momenta);
    if let Some(sparse) = sparse {
        shorten(graph, &mut motion.accelerations, &sparse.accelerations, CLEARLY);
        if let Some(velocities) = &mut motion.velocities {
            shorten(graph, velocities, &sparse.velocities, CLEARLY);
        }
    }
}

/// Returns `true` if the dense form need not be derived: its elimination would take n³/3
/// operations, both to derive and to evaluate.
fn prevails(graph: &Graph, motion: &Motion, momenta: &[Id], sparse: &Sparse) -> bool {
    let largest = solve::blocks(&motion.mass_matrix).iter().map(Vec::len).max().unwrap_or(0);
    sparse.dense.is_some()
        || LARGEST_DENSE < largest
            && !momenta.iter().any(|&momentum| graph.jumps(momentum, Dependencies::VELOCITY))
            && schedule::cost(graph, &sparse.accelerations) < largest.pow(3) / 3
}

/// Replaces `own` by `other` if the cost of `other` is less than `share` times that of `own`.
fn shorten(graph: &Graph, own: &mut [Id], other: &[Id], share: f64) {
    if is_cheaper(graph, other, own, share) {
        own.clone_from_slice(other);
    }
}

/// Returns `true` if the cost of `a` is less than `share` times that of `b`.
fn is_cheaper(graph: &Graph, a: &[Id], b: &[Id], share: f64) -> bool {
    (schedule::cost(graph, a) as f64) < share * schedule::cost(graph, b) as f64
}

/// Returns the Jacobians if they are short. Each column costs about as much as the accelerations.
fn jacobians(model: &Model, graph: &mut Graph, motion: &Motion) -> Option<[Vec<Vec<Id>>; 4]> {
    let count = motion.accelerations.len();
    let parameters: usize = model.parameters.iter().map(Quantity::count).sum();
    let operations = schedule::program(graph, &motion.accelerations).ops.len();
    // The zeros beyond the limit are short. Beside the unit sphere, M q̈ = f has other derivatives
    // than the accelerations.
    if graph.spent()
        || !attitude::rotations(model).is_empty()
        || LONGEST_JACOBIAN < operations * (2 * count + parameters)
    {
        return None;
    }
    let controls =
        model.inputs.iter().enumerate().skip(model.driven).flat_map(|(input, quantity)| {
            (0..quantity.count()).map(move |component| Symbol::Control { input, component })
        });
    let symbols: [Vec<Symbol>; 4] = [
        (0..count).map(Symbol::Coordinate).collect(),
        (0..count).map(Symbol::Velocity).collect(),
        (0..parameters).map(Symbol::Parameter).collect(),
        controls.collect(),
    ];
    // What is too long to be written out is not refused for that.
    let mut trial = graph.clone();
    trial.limit_work(MOST_PART);
    let columns = symbols.map(|symbols| jacobian::columns(&mut trial, motion, &symbols));
    if trial.spent() {
        return None;
    }
    trial.limit_work(MOST_WORK);
    *graph = trial;
    Some(columns)
}

/// Refuses Lagrangians that require a third derivative of a driven input, in the rates of the
/// momenta or in ∂L/∂t, because inputs provide two derivatives; and momenta that contain a control
/// input, because its derivative would be a force.
fn has_jerk(block: &mut Derivation, lagrangian: Id, momenta: &[Id]) -> bool {
    let input = |roots: &[Id], order| named_input(block.model, block.graph, roots, order);
    let (jerked, powered, controlled) =
        (input(momenta, Some(2)), input(&[lagrangian], Some(2)), input(momenta, None));
    let message = match (jerked, powered, controlled) {
        (Some(name), ..) => message!(
            "the momenta contain the acceleration of `{name}`, so the equations would contain its \
             third derivative; leave its second derivative out of the kinetic energy"
        ),
        (_, Some(name), _) => message!(
            "the energy contains the acceleration of `{name}`, so its power would contain a third \
             derivative; write what it does to a coordinate as a `force`"
        ),
        (.., Some(name)) => message!(
            "the momenta contain the control input `{name}`, so the equations would contain its \
             derivative; declare it `driven`, or write what it does as a `force`"
        ),
        _ => return false,
    };
    let name = jerked.or(powered).or(controlled).map_or_else(Span::call_site, Ident::span);
    block.errors.at(name, message);
    true
}

/// Returns q̇ = M⁻¹(p − b) for momenta M q̇ + b that are linear in the velocities.
pub(crate) fn invert(graph: &mut Graph, masses: &[Vec<Id>], momenta: &[Id]) -> Option<Vec<Id>> {
    let moving = |&id: &Id| graph.dependencies(id).any(Dependencies::VELOCITY);
    if masses.iter().flatten().any(moving) {
        return None;
    }
    let count = momenta.len();
    let mut right = Vec::new();
    for i in 0..count {
        let mut terms = vec![(momenta[i], Rational::MINUS_ONE)];
        for (j, &entry) in masses[i].iter().enumerate() {
            let velocity = graph.symbol(Symbol::Velocity(j));
            terms.push((graph.mul(entry, velocity), Rational::ONE));
        }
        let rest = graph.sum(&terms);
        let rest = collected(graph, rest);
        if graph.jumps(rest, Dependencies::VELOCITY) {
            return None;
        }
        // Terms that depend on velocities but do not cancel structurally vanish at q̇ = 0.
        let rest = if graph.dependencies(rest).any(Dependencies::VELOCITY) {
            at_rest(graph, rest)
        } else {
            rest
        };
        let momentum = graph.symbol(Symbol::Momentum(i));
        right.push(graph.add(momentum, rest));
    }
    Some(solve::solve(graph, masses, &right))
}
