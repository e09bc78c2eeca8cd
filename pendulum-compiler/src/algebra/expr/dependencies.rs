//! Dependencies of an expression: the kinds of its symbols.

use super::node::Symbol;

/// A set of kinds of symbols: those that occur in an expression.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Dependencies(u16);

impl Dependencies {
    pub(crate) const PARAMETER: Self = Self(1);
    pub(crate) const TIME: Self = Self(2);
    pub(crate) const COORDINATE: Self = Self(4);
    pub(crate) const VELOCITY: Self = Self(8);
    pub(crate) const POSITION_INPUT: Self = Self(16);
    pub(crate) const VELOCITY_INPUT: Self = Self(32);
    pub(crate) const ACCELERATION_INPUT: Self = Self(64);
    pub(crate) const MOMENTUM: Self = Self(128);
    pub(crate) const POINT: Self = Self(256);
    pub(crate) const AUXILIARY: Self = Self(512);
    pub(crate) const ACCELERATION: Self = Self(1024);
    pub(crate) const CONTROL: Self = Self(2048);
    pub(crate) const MULTIPLIER: Self = Self(4096);
    pub(crate) const TARGET: Self = Self(8192);
    /// Driven and control inputs.
    pub(crate) const INPUT: Self = Self(16 | 32 | 64 | 2048);
    /// All kinds except parameters.
    pub(crate) const STATE: Self = Self(!1);

    pub(crate) const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns `true` if `self` and `other` have a kind in common.
    pub(crate) const fn any(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    pub(crate) fn of(symbol: Symbol) -> Self {
        match symbol {
            Symbol::Parameter(_) | Symbol::Moment(..) => Self::PARAMETER,
            Symbol::Point(..) => Self::POINT,
            Symbol::Time => Self::TIME,
            Symbol::Coordinate(_) | Symbol::Entry(..) | Symbol::Position(_) => Self::COORDINATE,
            Symbol::Velocity(_) => Self::VELOCITY,
            Symbol::Input { order: 0, .. } => Self::POSITION_INPUT,
            Symbol::Input { order: 1, .. } => Self::VELOCITY_INPUT,
            Symbol::Input { .. } => Self::ACCELERATION_INPUT,
            Symbol::Control { .. } => Self::CONTROL,
            Symbol::Acceleration(_) => Self::ACCELERATION,
            Symbol::Multiplier(_) | Symbol::Contact(_) | Symbol::Friction(_) => Self::MULTIPLIER,
            Symbol::Target(_) => Self::TARGET,
            Symbol::Momentum(_) => Self::MOMENTUM,
            Symbol::Auxiliary(_) => Self::AUXILIARY,
        }
    }
}
