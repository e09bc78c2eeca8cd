//! Intervals of stick and slip, as listed in solutions.

/// An interval in which a dry friction sticks, or slides in one direction.
///
/// While it slides, its force `force` acts against the rate. While it sticks, the rate is held at
/// zero as by a constraint, with a force of at most `static`, or `force` if this is greater. A step
/// ends where the rate becomes zero or the force exceeds its bound, and it is decided there what
/// follows: which frictions stick is the solution of a complementarity problem.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Slip {
    /// The index of the friction in the order of declaration.
    pub friction: usize,
    /// The name of the friction.
    pub name: &'static str,
    /// The time at the start in seconds.
    pub start: f64,
    /// The time at the end, or that reached.
    pub end: f64,
    /// The sign of the rate: 1, −1, or 0 while the friction sticks. For the components of a vector
    /// that slides, 1.
    pub direction: i8,
}
