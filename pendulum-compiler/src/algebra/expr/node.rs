//! The nodes of the graph and their leaves.

use crate::algebra::functions::Function;
use crate::algebra::number::Literal;
use crate::algebra::number::Rational;

/// A node of the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Id(pub(super) u32);

impl Id {
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// The contents of a node.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Node {
    Number(Rational),
    /// A number that takes no part in folding: too large for exact arithmetic.
    Opaque(Literal),
    Pi,
    Symbol(Symbol),
    /// Two or more terms with their coefficients; `1` is the term of the constant.
    Sum(Vec<(Id, Rational)>),
    /// A coefficient and factors with their exponents.
    Product(Rational, Vec<(Id, Rational)>),
    Call(Function, Id),
    /// The angle of the point (second, first).
    Atan2(Id, Id),
    Max(Id, Id),
    /// The same value as its child, closed to all rewriting: what elimination works on.
    Atom(Id),
}

/// A leaf that has its value at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Symbol {
    Parameter(usize),
    Time,
    Coordinate(usize),
    Velocity(usize),
    Input {
        input: usize,
        component: usize,
        order: u8,
    },
    /// A control input, by the index and the component of the input; it has no derivatives.
    Control {
        input: usize,
        component: usize,
    },
    /// The second derivative of a coordinate, in outputs.
    Acceleration(usize),
    /// The multiplier of a constraint, in outputs and where equations are printed.
    Multiplier(usize),
    /// The change of a constraint that is wanted, in the function that corrects misfits.
    Target(usize),
    /// A generalized momentum, in the function that inverts them.
    Momentum(usize),
    /// A second moment about its pivot of the body whose scalars begin with this parameter.
    Moment(usize, Moment),
    /// The velocity of a scalar of a `let` position, as an unknown of its own.
    Auxiliary(usize),
    /// A scalar of a `let` position, where constraints are told what they hold.
    Position(usize),
    /// A component of the point of integration; the first number tells nested integrals apart.
    Point(usize, usize),
}

/// The second moments of a body in which rotations are short: S_xx + S_yy, S_xx − S_yy and S_xy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Moment {
    /// S_xx + S_yy, the moment of inertia.
    Inertia,
    /// S_xx − S_yy.
    Difference,
    /// S_xy.
    Product,
}
