//! Scalars of several numbers.

#![allow(clippy::inline_always)]

use crate::scalar::real::{Float, Real};
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// `W` numbers with common operations: the scalar of many systems of one type.
///
/// Every lane has the same bits as the computation with a single number. Loops over lanes have no
/// branches, so the compiler vectorizes them with the instructions that are available to the
/// surrounding code.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes<T, const W: usize>(pub [T; W]);

impl<T: Float, const W: usize> Lanes<T, W> {
    /// Creates lanes with the same number.
    #[inline(always)]
    pub fn splat(value: T) -> Self {
        Self([value; W])
    }

    /// Creates lanes with the same constant.
    #[inline(always)]
    fn constant(value: T) -> Self {
        Self::splat(value)
    }

    /// Applies a function to each lane.
    #[inline(always)]
    fn each(self, f: impl Fn(T) -> T) -> Self {
        let mut result = self;
        for x in &mut result.0 {
            *x = f(*x);
        }
        result
    }

    /// Applies a function to each pair of lanes.
    #[inline(always)]
    fn pairs(self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        let mut result = self;
        for (x, y) in result.0.iter_mut().zip(other.0) {
            *x = f(*x, y);
        }
        result
    }
}

/// Eight numbers with common operations, as [`Lanes`], but with every operation written out instead
/// of a loop.
///
/// For functions with thousands of operations, the compiler would need half a minute to unroll all
/// loops. If there are few operations, such as in recurrences, which are loops themselves,
/// [`Lanes`] have better code.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Octet<T>(pub [T; 8]);

/// Creates an array with an element for each of eight lanes.
macro_rules! eight {
    ($k:ident => $element:expr) => {
        eight!($k => $element; 0 1 2 3 4 5 6 7)
    };
    ($k:ident => $element:expr; $($index:literal)+) => {
        Self([$({
            let $k = $index;
            $element
        }),+])
    };
}

impl<T: Float> Octet<T> {
    /// Creates lanes with the same number.
    #[inline(always)]
    pub fn splat(value: T) -> Self {
        Self([value; 8])
    }

    /// Creates lanes with the same constant.
    #[inline(always)]
    fn constant(value: T) -> Self {
        eight!(_k => value)
    }

    /// Creates lanes from eight constants.
    #[inline(always)]
    pub(crate) fn known(values: &[f64; 8]) -> Self {
        eight!(k => T::from_f64(values[k]))
    }

    /// Applies a function to each lane.
    #[inline(always)]
    fn each(self, f: impl Fn(T) -> T) -> Self {
        eight!(k => f(self.0[k]))
    }

    /// Applies a function to each pair of lanes.
    #[inline(always)]
    fn pairs(self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        eight!(k => f(self.0[k], other.0[k]))
    }
}

macro_rules! unary {
    ($($function:ident)+) => {$(
        #[inline(always)]
        fn $function(self) -> Self {
            self.each(T::$function)
        }
    )+};
}

macro_rules! binary {
    ($($function:ident)+) => {$(
        #[inline(always)]
        fn $function(self, other: Self) -> Self {
            self.pairs(other, T::$function)
        }
    )+};
}

macro_rules! operator {
    ([$($width:tt)*] $lanes:ty; $operation:ident $function:ident $assign:ident $in_place:ident $symbol:tt) => {
        impl<T: Float, $($width)*> $operation for $lanes {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                self.pairs(other, |a, b| a $symbol b)
            }
        }

        impl<T: Float, $($width)*> $assign for $lanes {
            #[inline(always)]
            fn $in_place(&mut self, other: Self) {
                *self = *self $symbol other;
            }
        }
    };
}

/// Implements [`Real`] for a type with `each`, `pairs` and `constant`.
macro_rules! number {
    ([$($width:tt)*] $lanes:ty) => {
        operator! { [$($width)*] $lanes; Add add AddAssign add_assign + }
        operator! { [$($width)*] $lanes; Sub sub SubAssign sub_assign - }
        operator! { [$($width)*] $lanes; Mul mul MulAssign mul_assign * }
        operator! { [$($width)*] $lanes; Div div DivAssign div_assign / }

        impl<T: Float, $($width)*> Neg for $lanes {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                self.each(|x| -x)
            }
        }

        impl<T: Float, $($width)*> Real for $lanes {
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                Self::constant(T::from_f64(value))
            }

            #[inline(always)]
            fn ratio(numerator: f64, denominator: f64) -> Self {
                Self::constant(T::ratio(numerator, denominator))
            }

            #[inline(always)]
            fn pi() -> Self {
                Self::constant(T::pi())
            }

            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                let (sin, cos) = T::sin_cos_lanes(&self.0);
                (Self(sin), Self(cos))
            }

            #[inline(always)]
            fn sin(self) -> Self {
                self.sin_cos().0
            }

            #[inline(always)]
            fn cos(self) -> Self {
                self.sin_cos().1
            }

            #[inline(always)]
            fn sinc(self, order: usize) -> Self {
                self.each(|x| x.sinc(order))
            }

            unary! { tan asin acos atan sinh cosh tanh sech exp ln sqrt abs sign step }
            binary! { atan2 powf max min along }

            #[inline(always)]
            fn where_positive(self, then: Self, otherwise: Self) -> Self {
                let mut result = otherwise;
                for (k, positive) in self.0.iter().enumerate() {
                    result.0[k] = positive.where_positive(then.0[k], otherwise.0[k]);
                }
                result
            }
        }
    };
}

number! { [const W: usize] Lanes<T, W> }
number! { [] Octet<T> }

#[cfg(test)]
mod tests {
    use super::{Lanes, Octet};
    use crate::scalar::Real;

    /// Returns the bits of a number, with the same bits for every NaN.
    ///
    /// Neither IEEE 754 nor Rust specifies the sign and the payload of the NaN of an operation: on
    /// x86, 0/0 computed by the compiler and 0/0 computed at run time have different signs.
    fn bits(x: f64) -> u64 {
        if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() }
    }

    /// Checks that operations on lanes have the same bits as operations on single numbers.
    fn same<const W: usize, L: Real>(
        x: [f64; W],
        y: [f64; W],
        lanes: fn([f64; W]) -> L,
        numbers: fn(L) -> [f64; W],
    ) {
        let (a, b) = (lanes(x), lanes(y));
        let check = |lanes: L, single: fn(f64, f64) -> f64, name: &str| {
            for (k, number) in numbers(lanes).into_iter().enumerate() {
                assert_eq!(
                    bits(number),
                    bits(single(x[k], y[k])),
                    "{name} of {} and {}",
                    x[k],
                    y[k]
                );
            }
        };
        check(a + b, |x, y| x + y, "sum");
        check(a - b, |x, y| x - y, "difference");
        check(a * b, |x, y| x * y, "product");
        check(a / b, |x, y| x / y, "quotient");
        check(-a, |x, _| -x, "negative");
        check(a.sin(), |x, _| Real::sin(x), "sine");
        check(a.cos(), |x, _| Real::cos(x), "cosine");
        for order in [0, 1, 2, 9] {
            let numbers = numbers(a.sinc(order));
            for (x, number) in x.into_iter().zip(numbers) {
                let single = x.sinc(order);
                assert_eq!(bits(number), bits(single), "sinc of {x}, order {order}");
            }
        }
        check(a.atan2(b), Real::atan2, "angle");
        check(a.max(b), Real::max, "larger");
        check(a.min(b), Real::min, "smaller");
        check(a.exp(), |x, _| Real::exp(x), "exponential");
        check(a.sech(), |x, _| Real::sech(x), "secant");
        check(a.abs().sqrt(), |x, _| Real::abs(x).sqrt(), "root");
        check(a.sign(), |x, _| Real::sign(x), "sign");
        check(a.where_positive(b, -a), |x, y| x.where_positive(y, -x), "choice");
        check(
            (a / b).sqrt().where_positive(b, a),
            |x, y| (x / y).sqrt().where_positive(y, x),
            "choice beside no number",
        );
    }

    #[test]
    fn lanes_have_the_bits_of_single_numbers() {
        for scale in [1.0, 1e3, 1e7] {
            let x = core::array::from_fn::<f64, 16, _>(|k| (k as f64 - 7.3) * 0.91 * scale);
            let y = core::array::from_fn::<f64, 16, _>(|k| (3.1 - k as f64) * 0.37);
            same(x, y, Lanes, |lanes| lanes.0);
            let [x, y] = [x, y].map(|numbers| *numbers.first_chunk().expect("eight of sixteen"));
            same(x, y, Octet, |lanes| lanes.0);
        }
        same([0.0, -0.0, 1e-310, f64::INFINITY], [-0.0, 0.0, 2.0, 1.0], Lanes, |lanes| lanes.0);
    }
}
