//! Blocks of the generator: a separate language that is printed for the macro and evaluated without
//! it.

use super::nilpotent::Function;

/// A system that can be written as a block.
#[derive(Clone, Debug, Default)]
pub struct System {
    /// The seed of the system.
    pub seed: u64,
    /// `true` if units are written. In that case all quantities are pure numbers, and velocities
    /// are divided by a rate.
    pub units: bool,
    pub parameters: Vec<Parameter>,
    pub coordinates: Vec<Coordinate>,
    pub inputs: Vec<Input>,
    pub lets: Vec<Let>,
    /// The terms of L = Σ kinetic − Σ potential, written as a single `lagrangian` if `joined` is
    /// set.
    pub kinetic: Vec<Expr>,
    pub potential: Vec<Expr>,
    pub joined: bool,
    pub dissipation: Vec<Expr>,
    pub forces: Vec<Force>,
}

#[derive(Clone, Debug)]
pub struct Parameter {
    pub name: String,
    pub kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A pure number.
    Scalar,
    /// The unit of rates.
    Rate,
    /// The units of mass and length for bodies.
    Mass,
    Length,
    Vector(usize),
    Family(usize),
    Body,
}

impl Kind {
    /// Returns the number of scalars.
    pub fn count(self) -> usize {
        match self {
            Self::Scalar | Self::Rate | Self::Mass | Self::Length => 1,
            Self::Vector(count) | Self::Family(count) => count,
            Self::Body => 6,
        }
    }
}

#[derive(Clone, Debug)]
pub struct Coordinate {
    pub name: String,
    pub length: Option<usize>,
}

#[derive(Clone, Debug)]
pub struct Input {
    pub name: String,
    pub components: usize,
}

/// A definition.
#[derive(Clone, Debug)]
pub struct Let {
    pub name: String,
    pub shape: Shape,
    pub kind: Type,
    pub expr: Expr,
}

#[derive(Clone, Debug)]
pub enum Shape {
    Plain,
    /// One definition for each index below the count. The index is [`INDICES`]\[0\].
    Indexed(usize),
    /// A function with arguments of these types.
    Function(Vec<Type>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    Scalar,
    Plane,
    /// A plane vector written as a complex number.
    Complex,
    Space,
}

/// A generalized force on a coordinate, on one of its members, or on each member.
#[derive(Clone, Debug)]
pub struct Force {
    pub coordinate: usize,
    pub member: Option<usize>,
    pub expr: Expr,
}

/// The names of indices, by the depth of their binding.
pub const INDICES: [&str; 3] = ["k", "j", "n"];

/// A member of a family.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Index {
    Number(usize),
    /// The value of a bound index.
    Bound(usize),
    /// A bound index counted from the end: `count - 1 - k`.
    Reversed(usize, usize),
}

#[derive(Clone, Debug)]
pub enum Expr {
    Number(i64, i64),
    Pi,
    Imaginary,
    Time,
    Parameter(usize),
    Member(usize, Index),
    /// `B.mass`, `B.center` or `B.inertia`.
    Property(usize, Property),
    Coordinate(usize, Option<Index>),
    /// A velocity, in one of three spellings.
    Velocity(usize, Option<Index>, usize),
    /// A driven input of order 0, 1 or 2.
    Input(usize, usize),
    /// Terms; `true` is minus.
    Sum(Vec<(bool, Expr)>),
    /// Factors; `true` for divisors.
    Product(Vec<(bool, Expr)>),
    Negative(Box<Expr>),
    /// A power with a rational exponent.
    Power(Box<Expr>, i64, i64),
    Vector(Vec<Expr>),
    Call(Function, Box<Expr>),
    Of(Operation, Vec<Expr>),
    Component(Box<Expr>, usize),
    /// `cis(φ)`, or `exp(i*φ)` if `true`.
    Cis(Box<Expr>, bool),
    Let(usize),
    /// The derivative of a definition, written as a dot above its name.
    LetDot(usize),
    LetMember(usize, Index),
    Apply(usize, Vec<Expr>),
    Argument(usize),
    /// An index as a number.
    Bound(usize),
    /// Σ over an index below a count, written as `0..=count-1` if `true`.
    Over(usize, usize, bool, Box<Expr>),
    /// ∫ over a body.
    Integral(usize, Box<Expr>),
    /// The point of integration.
    Point,
}

/// A function of several numbers or of vectors, in the notation of calls, but for powers and bars.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    Power,
    Atan2,
    Max,
    Min,
    Inner,
    Cross,
    Perp,
    Height,
    Magnitude,
    Dot,
}

impl Operation {
    pub fn of(self, items: impl Into<Vec<Expr>>) -> Expr {
        Expr::Of(self, items.into())
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    Mass,
    Center,
    Inertia,
}

impl System {
    /// Returns the number of scalar coordinates.
    pub fn count(&self) -> usize {
        self.coordinates.iter().map(|coordinate| coordinate.length.unwrap_or(1)).sum()
    }

    /// Returns the terms of the energies, then the forces.
    pub fn terms(&mut self) -> impl Iterator<Item = &mut Expr> {
        let lists = [&mut self.kinetic, &mut self.potential, &mut self.dissipation];
        let forces = self.forces.iter_mut().map(|force| &mut force.expr);
        lists.into_iter().flatten().chain(forces)
    }

    /// Returns the number of scalars before a coordinate.
    pub fn first_coordinate(&self, index: usize) -> usize {
        self.coordinates[..index].iter().map(|coordinate| coordinate.length.unwrap_or(1)).sum()
    }

    /// Returns the number of scalars before a parameter.
    pub fn first_parameter(&self, index: usize) -> usize {
        self.parameters[..index].iter().map(|parameter| parameter.kind.count()).sum()
    }
}

impl Expr {
    /// Changes every part of an expression, beginning with the leaves.
    pub fn each(&mut self, change: &impl Fn(&mut Expr)) {
        let parts: Vec<&mut Expr> = match self {
            Expr::Sum(items) | Expr::Product(items) => {
                items.iter_mut().map(|(_, item)| item).collect()
            }
            Expr::Vector(items) | Expr::Apply(_, items) | Expr::Of(_, items) => {
                items.iter_mut().collect()
            }
            Expr::Negative(a)
            | Expr::Power(a, ..)
            | Expr::Call(_, a)
            | Expr::Component(a, _)
            | Expr::Cis(a, _)
            | Expr::Over(_, _, _, a)
            | Expr::Integral(_, a) => vec![a],
            _ => Vec::new(),
        };
        for part in parts {
            part.each(change);
        }
        change(self);
    }
}

/// Returns `a + b`.
pub fn sum(a: Expr, b: Expr) -> Expr {
    Expr::Sum(vec![(false, a), (false, b)])
}

/// Returns `a * b`.
pub fn product(a: Expr, b: Expr) -> Expr {
    Expr::Product(vec![(false, a), (false, b)])
}

/// Returns `a / b`.
pub fn quotient(a: Expr, b: Expr) -> Expr {
    Expr::Product(vec![(false, a), (true, b)])
}

/// Returns `a ^ n`.
pub fn power(a: Expr, exponent: i64) -> Expr {
    Expr::Power(Box::new(a), exponent, 1)
}

/// Returns a function of `a`.
pub fn call(function: Function, a: Expr) -> Expr {
    Expr::Call(function, Box::new(a))
}

pub fn number(value: i64) -> Expr {
    Expr::Number(value, 1)
}
