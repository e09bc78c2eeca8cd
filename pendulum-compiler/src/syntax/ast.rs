//! A block as written: names with their spans, before name resolution.

use crate::algebra::number::Literal;
use crate::messages::Range;
use proc_macro2::{Ident, TokenStream};
use syn::{Attribute, Visibility};

/// A whole `lagrangian!` block.
pub(crate) struct Block {
    pub(crate) attributes: Vec<Attribute>,
    pub(crate) visibility: Visibility,
    pub(crate) name: Ident,
    pub(crate) fields: Vec<Field>,
    pub(crate) statements: Vec<Statement>,
    pub(crate) recovery: Recovery,
    /// `true` if all names are ASCII.
    pub(crate) ascii: bool,
}

impl Block {
    /// Returns the `cfg` attributes of the struct. They apply to all generated items as well.
    pub(crate) fn conditions(&self) -> impl Iterator<Item = &Attribute> {
        self.attributes.iter().filter(|attribute| attribute.path().is_ident("cfg"))
    }
}

/// The kinds of statements that could not be parsed. Their absence is not reported as a further
/// mistake.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Recovery {
    pub(crate) declarations: bool,
    pub(crate) energies: bool,
}

/// `m: kg,` or `g: m/s^2 = 9.81,`.
pub(crate) struct Field {
    pub(crate) attributes: Vec<Attribute>,
    pub(crate) name: Ident,
    pub(crate) kind: Kind,
    pub(crate) default: Option<Expr>,
}

/// The kind of a declaration, after its colon.
#[derive(Debug)]
pub(crate) enum Kind {
    /// A scalar with or without a unit.
    Scalar(Option<Expr>),
    /// `[unit; length]`, with `None` for the unit `_`.
    Array { unit: Option<Expr>, length: Expr },
    /// `[unit; 3, 3]`, a symmetric matrix.
    Matrix { unit: Option<Expr>, sizes: Box<[Expr; 2]> },
    /// `body`.
    Body(Range),
    /// `solid`.
    Solid(Range),
    /// `rotation`.
    Rotation(Range),
    /// `table(m): N`, with the units of argument and value.
    Table(Range, Box<[Kind; 2]>),
}

/// A statement that ends in `;`.
#[derive(Debug)]
pub(crate) enum Statement {
    /// `coordinate x[5]: [m; 2]` or, if `state` is set, `state z[5]: [m; 2]`; `length` is that of a
    /// family.
    Coordinate {
        state: bool,
        name: Ident,
        length: Option<Expr>,
        kind: Kind,
    },
    /// `driven x: m` or, if `control` is set, `input u: N`.
    Input {
        control: bool,
        name: Ident,
        kind: Kind,
    },
    Let(Let),
    Table(Box<Table>),
    Energy {
        role: Role,
        keyword: Range,
        expr: Expr,
    },
    Force(Box<Force>),
    /// `rate z = …` or `rate z[k in 0..5] = …`; the state stands in place of the point.
    Rate(Box<Force>),
    Output(Box<Output>),
    Constraint(Box<Constraint>),
    Limit(Box<Limit>),
    Friction(Box<Friction>),
}

/// `output tip: [m; 2] = …` or `output tip[k in 0..5]: [m; 2] = …`.
#[derive(Debug)]
pub(crate) struct Output {
    /// The `doc` attributes.
    pub(crate) documentation: TokenStream,
    pub(crate) name: Ident,
    pub(crate) index: Option<Binder>,
    pub(crate) kind: Kind,
    pub(crate) expr: Expr,
}

/// `constraint loop: a = b` or `redundant constraint rod[k in 0..5]: a = b`.
#[derive(Debug)]
pub(crate) struct Constraint {
    pub(crate) redundant: bool,
    pub(crate) name: Ident,
    pub(crate) index: Option<Binder>,
    /// `a - b`, a sum of two terms.
    pub(crate) difference: Expr,
}

/// `limit rail: a >= b, restitution = e` or `limit rail: …, friction = μ along rate, static = μs`.
#[derive(Debug)]
pub(crate) struct Limit {
    pub(crate) name: Ident,
    pub(crate) index: Option<Binder>,
    /// `a - b`, a sum of two terms.
    pub(crate) difference: Expr,
    pub(crate) restitution: Expr,
    /// A friction whose magnitudes are coefficients of the reaction of the limit.
    pub(crate) slip: Option<Slip>,
}

/// `friction shoe: rate, force = F, static = S`.
#[derive(Debug)]
pub(crate) struct Friction {
    pub(crate) name: Ident,
    pub(crate) index: Option<Binder>,
    pub(crate) slip: Slip,
}

/// The rate and the magnitudes of a friction.
#[derive(Debug)]
pub(crate) struct Slip {
    pub(crate) rate: Expr,
    /// The magnitude of the force while the rate is not zero.
    pub(crate) force: Expr,
    /// The bound on the magnitude while the rate is zero, `static`.
    pub(crate) bound: Option<Expr>,
}

/// `let y = …`, `let y[k in 0..5] = …` or `let r(p) = …`.
#[derive(Debug)]
pub(crate) struct Let {
    pub(crate) name: Ident,
    pub(crate) index: Option<Binder>,
    pub(crate) arguments: Option<Vec<Ident>>,
    pub(crate) expr: Expr,
}

/// `table f(x: m): N = [(0, 0), (0.1, 3)], outside = linear`.
#[derive(Debug)]
pub(crate) struct Table {
    pub(crate) name: Ident,
    pub(crate) argument: Ident,
    /// The units of argument and value.
    pub(crate) kinds: [Kind; 2],
    pub(crate) points: Vec<[Expr; 2]>,
    /// The brackets around the points.
    pub(crate) range: Range,
    /// `true` if the function goes on along its tangents, `false` if it ends with its points.
    pub(crate) linear: bool,
}

/// `k in 0..5`.
#[derive(Debug)]
pub(crate) struct Binder {
    pub(crate) name: Ident,
    pub(crate) low: Expr,
    pub(crate) high: Expr,
    pub(crate) inclusive: bool,
}

/// `force point = …`, `force y[k in 0..5] = …` or `torque R = …`.
#[derive(Debug)]
pub(crate) struct Force {
    /// The coordinate, or the expression of coordinates, on which the force acts. That of a family
    /// is its member, `y[k]`.
    pub(crate) point: Expr,
    pub(crate) index: Option<Binder>,
    /// `true` if `point` is a rotation.
    pub(crate) torque: bool,
    pub(crate) expr: Expr,
}

/// The energy or function to which an expression contributes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    Kinetic,
    Potential,
    Lagrangian,
    Dissipation,
}

/// An expression. `source` is its number within the block.
#[derive(Debug)]
pub(crate) struct Expr {
    pub(crate) kind: ExprKind,
    pub(crate) range: Range,
    pub(crate) source: usize,
}

#[derive(Debug)]
pub(crate) enum ExprKind {
    Number(Literal),
    Name(Ident),
    /// Terms with their signs; `true` is minus.
    Sum(Vec<(bool, Expr)>),
    /// Factors; `true` for divisors.
    Product(Vec<(bool, Expr)>),
    Negative(Box<Expr>),
    Power(Box<Expr>, Box<Expr>),
    Call(Ident, Vec<Expr>),
    Index(Box<Expr>, Box<Expr>),
    Component(Box<Expr>, Ident),
    Vector(Vec<Expr>),
    Magnitude(Box<Expr>),
    SumOver(Box<Binder>, Box<Expr>),
    /// `product(k in 0..5, A[k])`.
    ProductOver(Box<Binder>, Box<Expr>),
    Integral {
        point: Ident,
        body: Ident,
        integrand: Box<Expr>,
    },
    /// `reaction(loop)` or `reaction(rod[2])`; with `true` `reaction(floor, friction)`.
    Reaction(Ident, Option<Box<Expr>>, bool),
}

impl Expr {
    /// Returns the two terms of a sum, which are the sides of a constraint or a limit.
    pub(crate) fn sides(&self) -> [&Expr; 2] {
        match self.parts()[..] {
            [left, right] => [left, right],
            _ => [self, self],
        }
    }

    /// Returns the operands of an expression, without the ends of ranges.
    pub(crate) fn parts(&self) -> Vec<&Expr> {
        match &self.kind {
            ExprKind::Number(_) | ExprKind::Name(_) => Vec::new(),
            ExprKind::Sum(items) | ExprKind::Product(items) => {
                items.iter().map(|(_, item)| item).collect()
            }
            ExprKind::Negative(a) | ExprKind::Magnitude(a) | ExprKind::Component(a, _) => vec![a],
            ExprKind::Power(a, b) | ExprKind::Index(a, b) => vec![a, b],
            ExprKind::Call(_, items) | ExprKind::Vector(items) => items.iter().collect(),
            ExprKind::SumOver(_, term) | ExprKind::ProductOver(_, term) => vec![term],
            ExprKind::Integral { integrand, .. } => vec![integrand],
            ExprKind::Reaction(_, index, _) => index.iter().map(|index| &**index).collect(),
        }
    }
}
