//! A block with resolved names: its quantities, definitions and statements.

use crate::algebra::dimension::Dimension;
use crate::algebra::spline::Spline;
use crate::syntax::ast::{self, Binder, Block, Expr, ExprKind, Let, Role};
use crate::syntax::name::{self, Name};
use proc_macro2::Ident;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// A block with resolved names.
pub(crate) struct Model<'a> {
    pub(crate) block: &'a Block,
    pub(crate) parameters: Vec<Quantity<'a>>,
    /// The coordinates, followed by the states.
    pub(crate) coordinates: Vec<Quantity<'a>>,
    /// The number of coordinates without the states.
    pub(crate) mechanical: usize,
    /// The driven inputs, followed by the control inputs.
    pub(crate) inputs: Vec<Quantity<'a>>,
    /// The number of driven inputs.
    pub(crate) driven: usize,
    pub(crate) outputs: Vec<Output<'a>>,
    pub(crate) lets: Vec<&'a Let>,
    /// The tables by the indices of their functions.
    pub(crate) tables: BTreeMap<u8, Table<'a>>,
    pub(crate) energies: Vec<(Role, &'a Expr)>,
    pub(crate) forces: Vec<&'a ast::Force>,
    /// The rates of the states.
    pub(crate) rates: Vec<&'a ast::Force>,
    /// The constraints that are solved, followed by the redundant ones.
    pub(crate) constraints: Vec<&'a ast::Constraint>,
    pub(crate) limits: Vec<&'a ast::Limit>,
    /// The frictions of their own statements, and those of limits.
    pub(crate) frictions: Vec<Friction<'a>>,
    pub(crate) names: BTreeMap<String, Meaning>,
    /// The parameters that no statement mentions.
    pub(crate) unmentioned: BTreeSet<usize>,
    /// The inputs, definitions and tables that no other statement mentions.
    pub(crate) unused: Vec<&'a Ident>,
    /// The definitions used only by outputs. They may contain accelerations.
    pub(crate) of_outputs: BTreeSet<usize>,
}

/// The expressions of a statement that contributes to the equations of motion.
pub(super) struct Contribution<'a> {
    /// The index of a family.
    pub(super) index: Option<&'a Binder>,
    pub(super) exprs: Vec<&'a Expr>,
    pub(super) place: Place,
}

/// The kind of a statement, on which the allowed expressions and the messages depend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// An energy or a force.
    Force,
    /// A constraint, a limit or the rate of a friction.
    Row,
    /// A magnitude of a friction, which may contain reactions of limits.
    Friction,
    /// An output, which may contain accelerations and reactions.
    Output,
}

impl<'a> Model<'a> {
    /// Returns the contributions of energies, forces, rates, constraints, limits and frictions, in
    /// this order. All passes over names use this list.
    ///
    /// The names in a statement that is missing here are not checked. Every field is therefore
    /// named.
    pub(super) fn contributions(&self) -> Vec<Contribution<'a>> {
        let Self {
            energies,
            forces,
            rates,
            constraints,
            limits,
            frictions,
            // The passes over names read definitions and outputs in their own order.
            lets: _,
            outputs: _,
            // Declarations, and results of the passes.
            block: _,
            parameters: _,
            coordinates: _,
            mechanical: _,
            tables: _,
            inputs: _,
            driven: _,
            names: _,
            unmentioned: _,
            unused: _,
            of_outputs: _,
        } = self;
        let of = |index, exprs, place| Contribution { index, exprs, place };
        let energies = energies.iter().map(|&(_, expr)| of(None, vec![expr], Place::Force));
        let forces = forces
            .iter()
            .chain(rates)
            .map(|own| of(own.index.as_ref(), vec![&own.point, &own.expr], Place::Force));
        let constraints =
            constraints.iter().map(|own| of(own.index.as_ref(), vec![&own.difference], Place::Row));
        let limits = limits
            .iter()
            .map(|own| of(own.index.as_ref(), vec![&own.difference, &own.restitution], Place::Row));
        let frictions = frictions.iter().flat_map(|own| {
            let ast::Slip { rate, force, bound } = own.slip;
            let magnitudes = [force].into_iter().chain(bound).collect();
            [of(own.index, vec![rate], Place::Row), of(own.index, magnitudes, Place::Friction)]
        });
        energies.chain(forces).chain(constraints).chain(limits).chain(frictions).collect()
    }

    /// Returns the body or solid that an expression names, unless a local name hides it.
    pub(crate) fn body(&self, expr: &Expr, hides: impl FnOnce(&str) -> bool) -> Option<usize> {
        let ExprKind::Name(ident) = &expr.kind else { return None };
        let Name { base, dots: 0 } = name::read(&ident.to_string()) else { return None };
        match self.names.get(&base) {
            Some(&Meaning::Parameter(index)) if self.parameters[index].is_body() => {
                (!hides(&base)).then_some(index)
            }
            _ => None,
        }
    }

    /// Returns the number of scalar coordinates without the states, which come after them.
    pub(crate) fn freedoms(&self) -> usize {
        self.coordinates[..self.mechanical].iter().map(Quantity::count).sum()
    }

    /// Returns `true` if an input is a control input.
    pub(crate) fn is_control(&self, input: usize) -> bool {
        self.driven <= input
    }
}

/// A declared parameter, coordinate, input or output.
pub(crate) struct Quantity<'a> {
    pub(crate) name: &'a Ident,
    /// The number of members of a family.
    pub(crate) members: Option<usize>,
    /// The quantity, or each member of the family.
    pub(crate) element: Element,
    /// The number of scalars declared before it.
    pub(crate) first: usize,
    pub(crate) dimension: Option<Dimension>,
    pub(crate) unit: String,
    pub(crate) default: Option<&'a Expr>,
}

impl Quantity<'_> {
    /// Returns the number of scalars.
    pub(crate) fn count(&self) -> usize {
        self.members.unwrap_or(1) * self.element.count()
    }

    /// Returns the places of its scalars among all scalars of its kind.
    pub(crate) fn scalars(&self) -> Range<usize> {
        self.first..self.first + self.count()
    }

    /// Returns `true` for a rigid body, in the plane or in space.
    pub(crate) fn is_body(&self) -> bool {
        matches!(self.element, Element::Body | Element::Solid)
    }

    /// Returns "a body" or "a solid".
    pub(crate) fn body_kind(&self) -> &'static str {
        if self.element == Element::Solid { "a solid" } else { "a body" }
    }

    /// Returns the number of scalars of a vector, a matrix or a family of scalars.
    pub(crate) fn length(&self) -> Option<usize> {
        match self.lengths()[..] {
            [length] => Some(length),
            _ if self.element == Element::Matrix => Some(self.count()),
            _ => None,
        }
    }

    /// Returns the lengths of families, vectors and matrices, outermost first.
    pub(crate) fn lengths(&self) -> Vec<usize> {
        let own: &[usize] = match self.element {
            Element::Scalar
            | Element::Body
            | Element::Solid
            | Element::Rotation
            | Element::Table => &[],
            Element::Vector(2) => &[2],
            Element::Vector(_) => &[3],
            Element::Matrix => &[3, 3],
        };
        self.members.iter().chain(own).copied().collect()
    }

    /// Returns the default of each scalar; none without a default, or if it has another length.
    pub(crate) fn default_items(&self) -> impl Iterator<Item = &Expr> {
        let items = match (self.default, self.length()) {
            (Some(Expr { kind: ExprKind::Vector(items), .. }), Some(_)) => &items[..],
            (Some(default), None) => std::slice::from_ref(default),
            _ => &[],
        };
        items.iter().filter(|_| items.len() == self.count())
    }

    /// Returns the names of its scalars: `θ`, `c.x`, `m[3]`, `x[2].y`.
    pub(crate) fn names(&self) -> Vec<String> {
        let name = self.name;
        let members = match self.members {
            None => vec![name.to_string()],
            Some(length) => (0..length).map(|k| format!("{name}[{k}]")).collect(),
        };
        let parts = self.element.parts();
        match self.element {
            Element::Table => return Vec::new(),
            _ if parts.is_empty() => return members,
            _ => {}
        }
        let each = |name: String| parts.iter().map(move |part| format!("{name}.{part}"));
        members.into_iter().flat_map(each).collect()
    }
}

/// The shape of a quantity, or of each member of a family.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Element {
    Scalar,
    /// A vector of two or three components.
    Vector(usize),
    /// A symmetric matrix of three rows.
    Matrix,
    /// A rigid body in the plane, with mass, centre and central moments.
    Body,
    /// A rigid body in space, likewise.
    Solid,
    /// A rotation, as a quaternion.
    Rotation,
    /// A table, whose points are no scalars of the system.
    Table,
}

impl Element {
    /// Returns the names of its scalars; none for a scalar itself.
    fn parts(self) -> &'static [&'static str] {
        match self {
            Self::Scalar | Self::Table => &[],
            Self::Rotation => &["w", "x", "y", "z"],
            Self::Vector(length) => &["x", "y", "z"][..length],
            Self::Matrix => &["xx", "yy", "zz", "xy", "xz", "yz"],
            Self::Body => {
                &["mass", "center.x", "center.y", "central.xx", "central.xy", "central.yy"]
            }
            Self::Solid => &[
                "mass",
                "center.x",
                "center.y",
                "center.z",
                "central.xx",
                "central.yy",
                "central.zz",
                "central.xy",
                "central.xz",
                "central.yz",
            ],
        }
    }

    /// Returns the number of scalars.
    pub(crate) fn count(self) -> usize {
        if self == Self::Table { 0 } else { self.parts().len().max(1) }
    }
}

/// An `output` statement.
pub(crate) struct Output<'a> {
    /// The name, unit and length as declared.
    pub(crate) declared: Quantity<'a>,
    pub(crate) statement: &'a ast::Output,
}

/// A friction: a statement of its own, or a part of a limit.
#[derive(Clone, Copy)]
pub(crate) struct Friction<'a> {
    pub(crate) name: &'a Ident,
    pub(crate) index: Option<&'a Binder>,
    pub(crate) slip: &'a ast::Slip,
    /// The limit whose reaction is multiplied by the magnitudes.
    pub(crate) limit: Option<usize>,
}

/// A table: a statement, or a parameter.
pub(crate) struct Table<'a> {
    pub(crate) name: &'a Ident,
    /// The units of argument and value.
    pub(crate) dimensions: [Option<Dimension>; 2],
    /// The statement with its spline; `None` for a parameter, whose points the runtime gets.
    pub(crate) written: Option<(&'a ast::Table, Spline)>,
}

/// The meaning of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Meaning {
    Parameter(usize),
    Coordinate(usize),
    Input(usize),
    Let(usize),
    Table(u8),
}
