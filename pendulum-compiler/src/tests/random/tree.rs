//! Blocks as the generator makes them: a language of its own that is printed for the macro and evaluated without it.

use super::nilpotent::Function;

/// A system to be written as a block.
#[derive(Clone, Debug, Default)]
pub(crate) struct System {
    /// The seed it was made from.
    pub(crate) seed: u64,
    /// Whether everything is a pure number, velocities are divided by a rate, and units are written.
    pub(crate) units: bool,
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) coordinates: Vec<Coordinate>,
    pub(crate) inputs: Vec<Input>,
    pub(crate) lets: Vec<Let>,
    /// L = Σ kinetic − Σ potential; written as one `lagrangian` if `joined`.
    pub(crate) kinetic: Vec<Expr>,
    pub(crate) potential: Vec<Expr>,
    pub(crate) joined: bool,
    pub(crate) dissipation: Vec<Expr>,
    pub(crate) forces: Vec<Force>,
}

#[derive(Clone, Debug)]
pub(crate) struct Parameter {
    pub(crate) name: String,
    pub(crate) kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A pure number.
    Scalar,
    /// The rate that velocities are measured in.
    Rate,
    /// The mass and the length that bodies are measured in.
    Mass,
    Length,
    Vector(usize),
    Family(usize),
    Body,
}

impl Kind {
    /// The number of its scalars.
    pub(crate) fn count(self) -> usize {
        match self {
            Self::Scalar | Self::Rate | Self::Mass | Self::Length => 1,
            Self::Vector(count) | Self::Family(count) => count,
            Self::Body => 6,
        }
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Coordinate {
    pub(crate) name: String,
    pub(crate) length: Option<usize>,
}

#[derive(Clone, Debug)]
pub(crate) struct Input {
    pub(crate) name: String,
    pub(crate) components: usize,
}

/// A definition.
#[derive(Clone, Debug)]
pub(crate) struct Let {
    pub(crate) name: String,
    pub(crate) shape: Shape,
    pub(crate) kind: Type,
    pub(crate) expr: Expr,
}

#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Plain,
    /// One for each index below the count; the index is [`INDICES`]\[0\].
    Indexed(usize),
    /// With arguments of these types.
    Function(Vec<Type>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Type {
    Scalar,
    Plane,
    /// A plane vector that is written as a complex number.
    Complex,
    Space,
}

/// A generalized force on a coordinate, on one of its members, or on each of them.
#[derive(Clone, Debug)]
pub(crate) struct Force {
    pub(crate) coordinate: usize,
    pub(crate) member: Option<usize>,
    pub(crate) expr: Expr,
}

/// The names of indices, by how deep they are bound.
pub(crate) const INDICES: [&str; 3] = ["k", "j", "n"];

/// A member of a family.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Index {
    Number(usize),
    /// What an index is bound to.
    Bound(usize),
    /// One less than what an index is bound to counts from the end: `count - 1 - k`.
    Reversed(usize, usize),
}

#[derive(Clone, Debug)]
pub(crate) enum Expr {
    Number(i64, i64),
    Pi,
    Imaginary,
    Time,
    Parameter(usize),
    Member(usize, Index),
    /// `B.mass`, `B.center`, `B.inertia`.
    Property(usize, Property),
    Coordinate(usize, Option<Index>),
    /// A velocity, in one of three spellings.
    Velocity(usize, Option<Index>, usize),
    /// A driven input of order 0, 1 or 2.
    Input(usize, usize),
    /// True is minus.
    Sum(Vec<(bool, Expr)>),
    /// True is divided by.
    Product(Vec<(bool, Expr)>),
    Negative(Box<Expr>),
    /// A power by a fraction.
    Power(Box<Expr>, i64, i64),
    GeneralPower(Box<Expr>, Box<Expr>),
    Call(Function, Box<Expr>),
    Atan2(Box<Expr>, Box<Expr>),
    Max(Box<Expr>, Box<Expr>),
    Min(Box<Expr>, Box<Expr>),
    Vector(Vec<Expr>),
    Inner(Box<Expr>, Box<Expr>),
    Cross(Box<Expr>, Box<Expr>),
    Perp(Box<Expr>),
    Height(Box<Expr>),
    Magnitude(Box<Expr>),
    Component(Box<Expr>, usize),
    /// `cis(φ)` or, if true, `exp(i*φ)`.
    Cis(Box<Expr>, bool),
    Dot(Box<Expr>),
    Let(usize),
    /// The derivative of a definition by a dot over its name.
    LetDot(usize),
    LetMember(usize, Index),
    Apply(usize, Vec<Expr>),
    Argument(usize),
    /// An index as a number.
    Bound(usize),
    /// Σ over an index below a count; `0..=count-1` if true.
    Over(usize, usize, bool, Box<Expr>),
    /// ∫ over a body.
    Integral(usize, Box<Expr>),
    /// The point of integration.
    Point,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Property {
    Mass,
    Center,
    Inertia,
}

impl System {
    /// The number of scalar coordinates.
    pub(crate) fn count(&self) -> usize {
        self.coordinates.iter().map(|coordinate| coordinate.length.unwrap_or(1)).sum()
    }

    /// The number of scalars before a coordinate.
    pub(crate) fn first_coordinate(&self, index: usize) -> usize {
        self.coordinates[..index].iter().map(|coordinate| coordinate.length.unwrap_or(1)).sum()
    }

    /// The number of scalars before a parameter.
    pub(crate) fn first_parameter(&self, index: usize) -> usize {
        self.parameters[..index].iter().map(|parameter| parameter.kind.count()).sum()
    }
}

impl Expr {
    /// Changes every part, from the leaves up.
    pub(crate) fn each(&mut self, change: &impl Fn(&mut Expr)) {
        let boxed = |inner: &mut Box<Expr>| inner.each(change);
        match self {
            Expr::Sum(items) | Expr::Product(items) => items.iter_mut().for_each(|(_, item)| item.each(change)),
            Expr::Vector(items) | Expr::Apply(_, items) => items.iter_mut().for_each(|item| item.each(change)),
            Expr::Negative(a)
            | Expr::Power(a, ..)
            | Expr::Call(_, a)
            | Expr::Perp(a)
            | Expr::Height(a)
            | Expr::Magnitude(a)
            | Expr::Component(a, _)
            | Expr::Cis(a, _)
            | Expr::Dot(a)
            | Expr::Over(_, _, _, a)
            | Expr::Integral(_, a) => boxed(a),
            Expr::GeneralPower(a, b)
            | Expr::Atan2(a, b)
            | Expr::Max(a, b)
            | Expr::Min(a, b)
            | Expr::Inner(a, b)
            | Expr::Cross(a, b) => [a, b].into_iter().for_each(boxed),
            _ => {}
        }
        change(self);
    }
}

/// `a + b`.
pub(crate) fn sum(a: Expr, b: Expr) -> Expr {
    Expr::Sum(vec![(false, a), (false, b)])
}

/// `a * b`.
pub(crate) fn product(a: Expr, b: Expr) -> Expr {
    Expr::Product(vec![(false, a), (false, b)])
}

/// `a / b`.
pub(crate) fn quotient(a: Expr, b: Expr) -> Expr {
    Expr::Product(vec![(false, a), (true, b)])
}

/// `a ^ n`.
pub(crate) fn power(a: Expr, exponent: i64) -> Expr {
    Expr::Power(Box::new(a), exponent, 1)
}

pub(crate) fn number(value: i64) -> Expr {
    Expr::Number(value, 1)
}
