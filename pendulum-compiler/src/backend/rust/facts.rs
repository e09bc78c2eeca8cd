//! The facts of a system: its names and units, the properties of its equations and the parameters
//! that they do not contain.

use crate::algebra::dimension::Dimension;
use crate::algebra::expr::{Dependencies, Id, Node, Symbol};
use crate::algebra::functions::Function;
use crate::backend::Analysis;
use crate::backend::names::Names;
use crate::backend::unicode;
use crate::mechanics::arguments::Arguments;
use crate::mechanics::constraint::Constraint;
use crate::mechanics::motion::Motion;
use crate::model::{Element, Quantity, Table};
use crate::schedule::Program;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

impl Analysis<'_, '_> {
    pub(super) fn facts(&self, arguments: Option<&Arguments>) -> TokenStream {
        let krate = &self.krate;
        let names = Names::new(self.model, &self.energies);
        let name = self.model.block.name.to_string();
        let (coordinates, parameters) = (&names.coordinates, &names.parameters);
        let declared = |quantity: &Quantity| vec![quantity.unit.clone(); quantity.count()];
        let units = self.model.parameters.iter().flat_map(|quantity| {
            let (lengths, moments) = match quantity.element {
                Element::Body => (2, 3),
                Element::Solid => (3, 6),
                _ => return declared(quantity),
            };
            let units = [vec!["kg"], vec!["m"; lengths], vec!["kg*m^2"; moments]];
            units.concat().into_iter().map(String::from).collect()
        });
        let metres = self.metres();
        let cost = self.accelerations.as_ref().map_or(0, Program::cost);
        let coordinate_units = self.model.coordinates.iter().flat_map(declared);
        let (inputs, outputs) = (self.inputs(), self.output_facts());
        let [constraints, limits, frictions] = self.constraint_facts();
        let loads = self.energies.loads.iter().map(|[first, count]| quote!([#first, #count]));
        let none = Motion::default();
        let motion = self.motion.as_ref().unwrap_or(&none);
        let Motion { autonomous, explicit_time, separable, velocity_free, linear, .. } = motion;
        let Motion { constant_mass_matrix, nonconservative, cyclic, .. } = motion;
        let states = motion.states.len();
        let rates: Vec<Id> = motion.states.iter().map(|state| state[0]).collect();
        let dependencies = rates.iter().map(|&rate| self.graph.dependencies(rate));
        let controlled = dependencies.fold(Dependencies::default(), Dependencies::or);
        let controlled = controlled.any(Dependencies::CONTROL);
        // The third derivative of a table jumps at its knots.
        let tabulated =
            |&id: &Id| matches!(self.graph.node(id), Node::Call(Function::Table(..), _));
        let roots = [&motion.accelerations[..], &rates].concat();
        let smooth = self.motion.is_some()
            && self.graph.smooth(&roots)
            && !self.graph.reachable(&roots).iter().any(tabulated);
        let texts = |Arguments { graph, switches, layers }: &Arguments| {
            let text = |&id: &Id| unicode::short(graph, &names, id);
            [switches, layers].map(|ids| ids.iter().map(text).collect::<Vec<String>>())
        };
        let [switches, layers] = arguments.map(texts).unwrap_or_default();
        let conserved = motion.conserved.iter().map(|own| unicode::conserved(&names, own));
        let unused = self.unused(&names);
        let [equations, latex, _] = self.equations.each_ref().map(|lines| lines.join("\n"));
        quote!(#krate::__private::facts(#krate::__private::Known {
            name: #name, coordinates: &[#(#coordinates),*], coordinate_units: &[#(#coordinate_units),*], states: #states, controlled_rates: #controlled, parameters: &[#(#parameters),*], units: &[#(#units),*], metres: &[#(#metres),*], inputs: &[#(#inputs),*], outputs: &[#(#outputs),*], constraints: &[#(#constraints),*], limits: &[#(#limits),*], frictions: &[#(#frictions),*], loads: &[#(#loads),*],
            autonomous: #autonomous, explicit_time: #explicit_time, separable: #separable, velocity_free: #velocity_free, constant_mass_matrix: #constant_mass_matrix,
            nonconservative: #nonconservative, smooth: #smooth, switches: &[#(#switches),*], layers: &[#(#layers),*], linear: #linear, cyclic: &[#(#cyclic),*], conserved: &[#(#conserved),*], unused: &[#(#unused),*], cost: #cost, equations: #equations, latex: #latex,
        }))
    }

    /// Returns the powers of the metre in the units of the parameters, as options: none for a unit
    /// that is not known, and for all parameters beside a table whose points stay what they are and
    /// may have lengths.
    fn metres(&self) -> Vec<TokenStream> {
        let fixed = |table: &Table| {
            let powers = table.dimensions.map(metres);
            powers.iter().any(|power| match table.written {
                Some(_) => *power != Some(0.0),
                None => power.is_none(),
            })
        };
        let long = self.model.tables.values().any(fixed);
        let each = self.model.parameters.iter().zip(&self.units.parameters);
        let powers = each.flat_map(|(quantity, &unit)| {
            let (lengths, moments) = match quantity.element {
                Element::Body => (2, 3),
                Element::Solid => (3, 6),
                _ => return vec![metres(unit); quantity.count()],
            };
            [vec![Some(0.0)], vec![Some(1.0); lengths], vec![Some(2.0); moments]].concat()
        });
        let shown = |power: Option<f64>| match power {
            Some(power) if !long => quote!(::core::option::Option::Some(#power)),
            _ => quote!(::core::option::Option::None),
        };
        powers.map(shown).collect()
    }

    /// Returns the parameters that neither the accelerations nor the constraints, limits and
    /// frictions depend on.
    pub(super) fn unused(&self, names: &Names) -> Vec<String> {
        let Some(motion) = &self.motion else { return Vec::new() };
        let constraints = &motion.constraints;
        let rows = constraints.held.iter().chain(&constraints.redundant).chain(&constraints.limits);
        let rows = rows.chain(&constraints.frictions);
        let mut roots: Vec<Id> = rows.map(|row| row.value).collect();
        roots.extend(&motion.accelerations);
        roots.extend(motion.states.iter().flatten());
        roots.extend(self.energies.limits.iter().map(|limit| limit.restitution));
        roots.extend(self.grips());
        let mut needed = self.graph.symbols(&roots);
        for quantity in &self.model.parameters {
            // A moment about the pivot depends on all parameters of its body.
            if needed.iter().any(
                |symbol| matches!(symbol, Symbol::Moment(first, _) if *first == quantity.first),
            ) {
                needed.extend(quantity.scalars().map(Symbol::Parameter));
            }
        }
        let all = names.parameters.iter().enumerate();
        all.filter(|(index, _)| !needed.contains(&Symbol::Parameter(*index)))
            .map(|(_, name)| name.clone())
            .collect()
    }

    /// Returns for each purpose and each driven input whether its position, velocity and
    /// acceleration are needed.
    pub(super) fn needed(&self) -> Vec<Vec<[bool; 3]>> {
        let Some(motion) = &self.motion else {
            return vec![vec![[false; 3]; self.model.inputs.len()]; 5];
        };
        let constraints = &motion.constraints;
        let outputs = self.energies.outputs.iter();
        let outputs = outputs.flat_map(|output| output.scalars.iter().chain(&output.open).copied());
        let rows = |rows: &[Constraint]| {
            let roots = |row: &Constraint| {
                [&[row.value, row.rate], &row.gradient[..], &row.scales].concat()
            };
            rows.iter().flat_map(roots).collect::<Vec<Id>>()
        };
        let drifts = constraints.limits.iter().chain(&constraints.frictions).map(|row| row.drift);
        let held = rows(&constraints.held);
        let purposes = [
            [
                &motion.accelerations[..],
                &motion.forces,
                motion.states.as_flattened(),
                &constraints.multipliers,
                // States at the ends of steps are corrected to satisfy the constraints.
                &held,
                &rows(&constraints.limits),
                &rows(&constraints.frictions),
                &drifts.collect::<Vec<Id>>(),
                &self.grips().collect::<Vec<Id>>(),
            ]
            .concat(),
            [
                &motion.momenta[..],
                &motion.momentum_rates,
                motion.velocities.as_deref().unwrap_or_default(),
                &motion.mass_matrix.concat(),
                &held,
                &rows(&constraints.redundant),
                &constraints.correction,
                &constraints.independence,
            ]
            .concat(),
            [Some(motion.energy), motion.kinetic, motion.potential].into_iter().flatten().collect(),
            vec![motion.power],
            outputs.collect(),
        ];
        let of = |roots: &Vec<Id>| {
            let mut needed = vec![[false; 3]; self.model.inputs.len()];
            for symbol in self.graph.symbols(roots) {
                match symbol {
                    Symbol::Input { input, order, .. } => needed[input][usize::from(order)] = true,
                    Symbol::Control { input, .. } => needed[input][0] = true,
                    _ => {}
                }
            }
            needed
        };
        purposes.iter().map(of).collect()
    }

    /// Returns the derivatives of each driven input that each purpose needs.
    fn inputs(&self) -> Vec<TokenStream> {
        let (krate, needed) = (&self.krate, self.needed());
        let describe = |(index, quantity): (usize, &Quantity)| {
            let (name, components) = (quantity.name.to_string(), quantity.count());
            let orders = needed.iter().map(|inputs| {
                let parts = ["POSITION", "VELOCITY", "ACCELERATION"]
                    .into_iter()
                    .zip(inputs[index])
                    .filter(|&(_, needed)| needed)
                    .map(|(part, _)| format_ident!("{part}"));
                quote!(#krate::motion::Derivatives::NONE #(.union(#krate::motion::Derivatives::#parts))*)
            });
            let control = self.model.is_control(index);
            let purposes = ["accelerations", "momenta", "energy", "power", "outputs"]
                .map(|purpose| format_ident!("{purpose}"));
            quote!(#krate::system::Input { name: #name, components: #components, control: #control, #(#purposes: #orders),* })
        };
        self.model.inputs.iter().enumerate().map(describe).collect()
    }
}

/// Returns the power of the metre in a unit that is known.
pub(super) fn metres(unit: Option<Dimension>) -> Option<f64> {
    let power = unit?.0[1];
    // Long division has no end for zero.
    let size = if power.is_zero() { 0.0 } else { power.abs().words().0 };
    Some(if power.is_negative() { -size } else { size })
}
