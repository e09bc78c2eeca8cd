//! A scalar that counts its operations.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use pendulum_runtime::scalar::Real;
use std::cell::Cell;

/// A number whose operations are counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Counted(pub(crate) f64);

/// The operations counted so far.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    pub(crate) mul: f64,
    pub(crate) add: f64,
    pub(crate) div: f64,
    pub(crate) sin_cos: f64,
}

impl Tally {
    /// Returns multiplications, additions and divisions.
    pub(crate) fn operations(&self) -> [f64; 3] {
        [self.mul, self.add, self.div]
    }
}

thread_local! {
    static TALLY: Cell<Tally> = const { Cell::new(Tally { mul: 0.0, add: 0.0, div: 0.0, sin_cos: 0.0 }) };
}

/// Returns the operations that `work` executes in this thread.
pub(crate) fn count<T>(work: impl FnOnce() -> T) -> Tally {
    TALLY.set(Tally::default());
    std::hint::black_box(work());
    TALLY.get()
}

/// Increments one of the counts.
fn note(kind: impl FnOnce(&mut Tally) -> &mut f64) {
    let mut tally = TALLY.get();
    *kind(&mut tally) += 1.0;
    TALLY.set(tally);
}

macro_rules! operator {
    ($($operation:ident $function:ident $assign:ident $in_place:ident $symbol:tt $kind:ident)+) => {$(
        impl $operation for Counted {
            type Output = Self;

            fn $function(self, other: Self) -> Self {
                note(|tally| &mut tally.$kind);
                Self(self.0 $symbol other.0)
            }
        }

        impl $assign for Counted {
            fn $in_place(&mut self, other: Self) {
                *self = *self $symbol other;
            }
        }
    )+};
}

operator! {
    Add add AddAssign add_assign + add
    Sub sub SubAssign sub_assign - add
    Mul mul MulAssign mul_assign * mul
    Div div DivAssign div_assign / div
}

impl Neg for Counted {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! unary {
    ($($function:ident)+) => {$(
        fn $function(self) -> Self {
            Self(Real::$function(self.0))
        }
    )+};
}

macro_rules! binary {
    ($($function:ident)+) => {$(
        fn $function(self, other: Self) -> Self {
            Self(Real::$function(self.0, other.0))
        }
    )+};
}

impl Real for Counted {
    fn from_f64(value: f64) -> Self {
        Self(value)
    }

    fn ratio(numerator: f64, denominator: f64) -> Self {
        Self(numerator / denominator)
    }

    fn pi() -> Self {
        Self(core::f64::consts::PI)
    }

    fn sin_cos(self) -> (Self, Self) {
        note(|tally| &mut tally.sin_cos);
        let (sin, cos) = Real::sin_cos(self.0);
        (Self(sin), Self(cos))
    }

    fn sinc(self, order: usize) -> Self {
        note(|tally| &mut tally.sin_cos);
        Self(self.0.sinc(order))
    }

    unary! { tan asin acos atan sinh cosh tanh exp ln sqrt abs sign step }
    binary! { atan2 powf max min }
}
