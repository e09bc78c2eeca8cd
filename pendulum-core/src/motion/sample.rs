//! Samples of motions and sets of derivatives.

use crate::scalar::Real;

/// A set of derivatives of a motion: position, velocity and acceleration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Derivatives(u8);

impl Derivatives {
    /// The empty set.
    pub const NONE: Self = Self(0);
    /// The position x.
    pub const POSITION: Self = Self(1);
    /// The velocity ẋ.
    pub const VELOCITY: Self = Self(2);
    /// The acceleration ẍ.
    pub const ACCELERATION: Self = Self(4);
    /// Position, velocity and acceleration.
    pub const ALL: Self = Self(7);

    /// Returns the union of `self` and `other`.
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns the derivatives in both sets.
    pub(super) const fn shared(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Returns these derivatives and all of lower order.
    pub(super) const fn with_lower(self) -> Self {
        Self(self.0 | self.0 >> 1 | self.0 >> 2)
    }

    /// Returns `true` if `self` contains all derivatives in `other`.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Returns the number of derivatives.
    pub const fn count(self) -> usize {
        self.0.count_ones() as usize
    }
}

/// A side of a kink.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// The limit from earlier times.
    Before,
    /// The limit from later times.
    After,
}

impl Side {
    /// Returns the opposite side.
    pub const fn opposite(self) -> Self {
        match self {
            Self::Before => Self::After,
            Self::After => Self::Before,
        }
    }
}

/// The position, velocity and acceleration of a motion at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<T, const D: usize> {
    /// x, usually in metres.
    pub position: [T; D],
    /// ẋ.
    pub velocity: [T; D],
    /// ẍ.
    pub acceleration: [T; D],
}

impl<T: Real, const D: usize> Sample<T, D> {
    /// Returns a sample with zero in all components.
    pub fn zero() -> Self {
        let zero = [T::from_f64(0.0); D];
        Self { position: zero, velocity: zero, acceleration: zero }
    }
}

impl<T: Real, const D: usize> Default for Sample<T, D> {
    fn default() -> Self {
        Self::zero()
    }
}

impl<T: Copy, const D: usize> Sample<T, D> {
    /// Maps every number.
    pub fn map<U>(&self, mut map: impl FnMut(T) -> U) -> Sample<U, D> {
        let (position, velocity) = (self.position.map(&mut map), self.velocity.map(&mut map));
        Sample { position, velocity, acceleration: self.acceleration.map(&mut map) }
    }
}
