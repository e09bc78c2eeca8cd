//! The nodes of the graph and their leaves.

use crate::algebra::functions::Function;
use crate::algebra::number::Literal;
use crate::algebra::number::Rational;

/// The index of a node in its graph.
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
    /// A number that is too large for exact arithmetic and is not folded.
    Opaque(Literal),
    Pi,
    Symbol(Symbol),
    /// Two or more terms with their coefficients. The term of a constant is `1`.
    Sum(Vec<(Id, Rational)>),
    /// A coefficient and factors with their exponents.
    Product(Rational, Vec<(Id, Rational)>),
    Call(Function, Id),
    /// The angle of the point (x, y), with the operands in the order y, x.
    Atan2(Id, Id),
    Max(Id, Id),
    /// An expression with the value of its child that is excluded from rewriting. Elimination works
    /// on these.
    Atom(Id),
}

impl Node {
    /// Returns the direct operands.
    pub(crate) fn children(&self) -> impl Iterator<Item = Id> {
        let (list, pair): (&[(Id, Rational)], _) = match self {
            Node::Number(_) | Node::Opaque(_) | Node::Pi | Node::Symbol(_) => (&[], [None; 2]),
            Node::Sum(list) | Node::Product(_, list) => (list, [None; 2]),
            Node::Call(_, a) | Node::Atom(a) => (&[], [Some(*a), None]),
            Node::Atan2(a, b) | Node::Max(a, b) => (&[], [Some(*a), Some(*b)]),
        };
        list.iter().map(|&(id, _)| id).chain(pair.into_iter().flatten())
    }
}

/// A leaf whose value is known at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Symbol {
    Parameter(usize),
    Time,
    Coordinate(usize),
    /// The velocity of a coordinate. Until the equations are derived, those of a rotation are its
    /// rates about the axes of the body, after the first, which is unused.
    Velocity(usize),
    /// An entry of the matrix of a coordinate that is a rotation, row by row, given by the first
    /// scalar of the coordinate. It becomes a function of its quaternion when the equations are
    /// derived.
    Entry(usize, usize),
    Input {
        input: usize,
        component: usize,
        order: u8,
    },
    /// A component of a control input. It has no derivatives.
    Control {
        input: usize,
        component: usize,
    },
    /// The second derivative of a coordinate, used in outputs.
    Acceleration(usize),
    /// The multiplier of a constraint, used in outputs and in printed equations.
    Multiplier(usize),
    /// The required change of a constraint, used in the function that corrects constraint
    /// violations.
    Target(usize),
    /// A generalized momentum, used in the function that computes velocities from momenta.
    Momentum(usize),
    /// A second moment about the pivot of a body, given by the first parameter of the body.
    Moment(usize, Moment),
    /// The velocity of a scalar of a `let` position, as a separate unknown.
    Auxiliary(usize),
    /// A scalar of a `let` position, used in expressions of constraints and limits.
    Position(usize),
    /// A component of the point of integration. The first number distinguishes nested integrals.
    Point(usize, usize),
    /// The reaction of a limit, used in frictions and in outputs.
    Contact(usize),
    /// The force of a friction, used in outputs.
    Friction(usize),
}

/// The second moments of a body about its pivot. With these combinations, expressions for rotations
/// are short.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Moment {
    /// S_xx + S_yy, the moment of inertia.
    Inertia,
    /// S_xx − S_yy.
    Difference,
    /// S_xy.
    Product,
    /// The moment of inertia of a solid about the axis x, y or z, the sum of the other two of S_xx,
    /// S_yy and S_zz.
    About(u8),
    /// S_xy, S_xz or S_yz of a solid.
    Mixed(u8),
}

impl Moment {
    /// The axes of [`Mixed`](Self::Mixed).
    pub(crate) const PAIRS: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];
}
