//! The facts of a system: its names and units, the properties of its equations and the parameters
//! that they do not contain.

use super::Emitter;
use crate::algebra::expr::{Id, Symbol};
use crate::backend::unicode::{self, Names};
use crate::mechanics::constraint::{Constraint, Constraints};
use crate::model::{Element, Quantity};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

impl Emitter<'_, '_> {
    pub(super) fn facts(&self) -> TokenStream {
        let krate = self.krate.clone();
        let names = Names::new(self.model, &self.energies);
        let name = self.model.block.name.to_string();
        let (coordinates, parameters) = (&names.coordinates, &names.parameters);
        let units = self.model.parameters.iter().flat_map(|quantity| {
            if quantity.is_body() {
                let (lengths, moments) =
                    if quantity.element == Element::Solid { (3, 6) } else { (2, 3) };
                let units = [vec!["kg"], vec!["m"; lengths], vec!["kg*m^2"; moments]];
                return units.concat().into_iter().map(String::from).collect();
            }
            vec![quantity.unit.clone(); quantity.count()]
        });
        let coordinate_units = self
            .model
            .coordinates
            .iter()
            .flat_map(|quantity| vec![quantity.unit.clone(); quantity.count()]);
        let coordinate_units = quote!(&[#(#coordinate_units),*]);
        let (inputs, outputs) = (self.inputs(), self.output_facts());
        let [constraints, limits, frictions] = self.constraint_facts();
        let Some(motion) = &self.motion else {
            return quote!(#krate::__private::facts(#krate::__private::Known {
                name: #name, coordinates: &[#(#coordinates),*], coordinate_units: #coordinate_units, parameters: &[#(#parameters),*], units: &[#(#units),*], inputs: &[#(#inputs),*], outputs: &[#(#outputs),*], constraints: &[#(#constraints),*], limits: &[#(#limits),*], frictions: &[#(#frictions),*],
                autonomous: false, explicit_time: false, separable: false, velocity_free: false, constant_mass_matrix: false, nonconservative: false,
                smooth: false, switches: &[], layers: &[], linear: false, cyclic: &[], conserved: &[], unused: &[], equations: "", latex: "",
            }));
        };
        let (
            autonomous,
            explicit_time,
            separable,
            velocity_free,
            constant_mass_matrix,
            nonconservative,
        ) = (
            motion.autonomous,
            motion.explicit_time,
            motion.separable,
            motion.velocity_free,
            motion.constant_mass_matrix,
            motion.nonconservative,
        );
        let smooth = self.graph.smooth(&motion.accelerations);
        let [switches, layers] = self.argument_facts(&names);
        let linear = motion.linear;
        let cyclic = motion.cyclic.clone();
        let conserved: Vec<String> = motion
            .conserved
            .iter()
            .map(|conserved| unicode::conserved(&names, conserved))
            .collect();
        let unused = self.unused(&names);
        let [equations, latex, _] = self.equations.each_ref().map(|lines| lines.join("\n"));
        quote!(#krate::__private::facts(#krate::__private::Known {
            name: #name, coordinates: &[#(#coordinates),*], coordinate_units: #coordinate_units, parameters: &[#(#parameters),*], units: &[#(#units),*], inputs: &[#(#inputs),*], outputs: &[#(#outputs),*], constraints: &[#(#constraints),*], limits: &[#(#limits),*], frictions: &[#(#frictions),*],
            autonomous: #autonomous, explicit_time: #explicit_time, separable: #separable, velocity_free: #velocity_free, constant_mass_matrix: #constant_mass_matrix,
            nonconservative: #nonconservative, smooth: #smooth, switches: &[#(#switches),*], layers: &[#(#layers),*], linear: #linear, cyclic: &[#(#cyclic),*], conserved: &[#(#conserved),*], unused: &[#(#unused),*], equations: #equations, latex: #latex,
        }))
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
        let purposes: Vec<Vec<Symbol>> = match &self.motion {
            None => vec![Vec::new(); 5],
            Some(motion) => {
                let of =
                    |lists: &[&[Id]]| self.graph.symbols(&lists.concat()).into_iter().collect();
                let outputs: Vec<Id> = self
                    .energies
                    .outputs
                    .iter()
                    .flat_map(|output| output.scalars.iter().chain(&output.open).copied())
                    .collect();
                let masses = motion.mass_matrix.concat();
                let rows = |rows: &[Constraint]| {
                    let roots = |row: &Constraint| {
                        [&[row.value, row.rate], &row.gradient[..], &row.scales].concat()
                    };
                    rows.iter().flat_map(roots).collect::<Vec<Id>>()
                };
                let Constraints { limits, frictions, .. } = &motion.constraints;
                let drifts: Vec<Id> = limits.iter().chain(frictions).map(|row| row.drift).collect();
                let grips: Vec<Id> = self.grips().collect();
                let energies: Vec<Id> = [Some(motion.energy), motion.kinetic, motion.potential]
                    .into_iter()
                    .flatten()
                    .collect();
                vec![
                    of(&[
                        &motion.accelerations,
                        &motion.forces,
                        &motion.constraints.multipliers,
                        // States at the ends of steps are corrected to satisfy the constraints.
                        &rows(&motion.constraints.held),
                        &rows(limits),
                        &rows(frictions),
                        &drifts,
                        &grips,
                    ]),
                    of(&[
                        &motion.momenta,
                        &motion.momentum_rates,
                        motion.velocities.as_deref().unwrap_or_default(),
                        &masses,
                        &rows(&motion.constraints.held),
                        &rows(&motion.constraints.redundant),
                        &motion.constraints.correction,
                        &motion.constraints.independence,
                    ]),
                    of(&[&energies]),
                    of(&[&[motion.power]]),
                    of(&[&outputs]),
                ]
            }
        };
        let of = |symbols: &Vec<Symbol>| {
            let mut needed = vec![[false; 3]; self.model.inputs.len()];
            for symbol in symbols {
                match *symbol {
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
