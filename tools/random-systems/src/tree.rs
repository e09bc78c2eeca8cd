//! Blocks as the generator makes them: a language of its own that is printed for the macro and
//! evaluated without it.

use super::nilpotent::Function;

/// A system to be written as a block.
#[derive(Clone, Debug, Default)]
pub struct System {
    /// The seed it was made from.
    pub seed: u64,
    /// True if everything is a pure number, velocities are divided by a rate, and units are
    /// written.
    pub units: bool,
    pub parameters: Vec<Parameter>,
    pub coordinates: Vec<Coordinate>,
    pub inputs: Vec<Input>,
    pub lets: Vec<Let>,
    /// L = Σ kinetic − Σ potential; written as one `lagrangian` if `joined`.
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
    /// One for each index below the count; the index is [`INDICES`]\[0\].
    Indexed(usize),
    /// With arguments of these types.
    Function(Vec<Type>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    Scalar,
    Plane,
    /// A plane vector that is written as a complex number.
    Complex,
    Space,
}

/// A generalized force on a coordinate, on one of its members, or on each of them.
#[derive(Clone, Debug)]
pub struct Force {
    pub coordinate: usize,
    pub member: Option<usize>,
    pub expr: Expr,
}

/// The names of indices, by how deep they are bound.
pub const INDICES: [&str; 3] = ["k", "j", "n"];

/// A member of a family.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Index {
    Number(usize),
    /// The value of an index.
    Bound(usize),
    /// One less than what an index is bound to counts from the end: `count - 1 - k`.
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
pub enum Property {
    Mass,
    Center,
    Inertia,
}

impl System {
    /// The number of scalar coordinates.
    pub fn count(&self) -> usize {
        self.coordinates.iter().map(|coordinate| coordinate.length.unwrap_or(1)).sum()
    }

    /// The number of scalars before a coordinate.
    pub fn first_coordinate(&self, index: usize) -> usize {
        self.coordinates[..index].iter().map(|coordinate| coordinate.length.unwrap_or(1)).sum()
    }

    /// The number of scalars before a parameter.
    pub fn first_parameter(&self, index: usize) -> usize {
        self.parameters[..index].iter().map(|parameter| parameter.kind.count()).sum()
    }
}

impl Expr {
    /// Changes every part, from the leaves up.
    pub fn each(&mut self, change: &impl Fn(&mut Expr)) {
        let boxed = |inner: &mut Box<Expr>| inner.each(change);
        match self {
            Expr::Sum(items) | Expr::Product(items) => {
                for (_, item) in items.iter_mut() {
                    item.each(change);
                }
            }
            Expr::Vector(items) | Expr::Apply(_, items) => {
                for item in items.iter_mut() {
                    item.each(change);
                }
            }
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
pub fn sum(a: Expr, b: Expr) -> Expr {
    Expr::Sum(vec![(false, a), (false, b)])
}

/// `a * b`.
pub fn product(a: Expr, b: Expr) -> Expr {
    Expr::Product(vec![(false, a), (false, b)])
}

/// `a / b`.
pub fn quotient(a: Expr, b: Expr) -> Expr {
    Expr::Product(vec![(false, a), (true, b)])
}

/// `a ^ n`.
pub fn power(a: Expr, exponent: i64) -> Expr {
    Expr::Power(Box::new(a), exponent, 1)
}

pub fn number(value: i64) -> Expr {
    Expr::Number(value, 1)
}
