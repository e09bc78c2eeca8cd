//! Numbers with infinitesimals: derivatives of any order without formulas for them.
//!
//! A number with k infinitesimals ε₁, …, ε_k, whose squares are zero, has 2ᵏ coefficients. The
//! coefficient of ε₁ε₂ in f(x + ε₁ + ε₂) is f″(x). A function of a + bε is f(a) + f′(a) b ε, where
//! a and b contain the other infinitesimals, so that the first derivative of each function is
//! sufficient.

use pendulum_runtime::scalar::Float;

/// The coefficients of a number. Bit j of an index is set for the coefficients of εⱼ.
#[derive(Clone, Debug)]
pub struct Nilpotent<T>(pub Vec<T>);

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    Sqrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Abs,
    Sign,
}

impl Function {
    /// Returns the name in the language.
    pub fn name(self) -> String {
        format!("{self:?}").to_lowercase()
    }
}

impl<T: Float> Nilpotent<T> {
    /// Creates a constant with a given number of infinitesimals.
    pub fn constant(value: T, infinitesimals: usize) -> Self {
        let mut coefficients = vec![T::from_f64(0.0); 1 << infinitesimals];
        coefficients[0] = value;
        Self(coefficients)
    }

    /// Returns the number of infinitesimals.
    pub fn infinitesimals(&self) -> usize {
        self.0.len().trailing_zeros() as usize
    }

    /// Returns `self` + `slope` ε for a new ε.
    pub fn join(mut self, slope: Self) -> Self {
        self.0.extend(slope.0);
        self
    }

    /// Returns a and b of a + bε, where ε is the newest infinitesimal.
    pub fn split(&self) -> (Self, Self) {
        let (a, b) = self.0.split_at(self.0.len() / 2);
        (Self(a.to_vec()), Self(b.to_vec()))
    }

    pub fn add(&self, other: &Self) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(&a, &b)| a + b).collect())
    }

    pub fn sub(&self, other: &Self) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(&a, &b)| a - b).collect())
    }

    pub fn neg(&self) -> Self {
        Self(self.0.iter().map(|&a| -a).collect())
    }

    pub fn mul(&self, other: &Self) -> Self {
        let coefficient = |all: usize| {
            let mut sum = self.0[0] * other.0[all];
            let mut part = all;
            while part != 0 {
                sum += self.0[part] * other.0[all ^ part];
                part = (part - 1) & all;
            }
            sum
        };
        Self((0..self.0.len()).map(coefficient).collect())
    }

    pub fn div(&self, other: &Self) -> Self {
        self.mul(&other.reciprocal())
    }

    pub fn reciprocal(&self) -> Self {
        if let [value] = self.0[..] {
            return Self(vec![T::from_f64(1.0) / value]);
        }
        let (a, b) = self.split();
        let value = a.reciprocal();
        let slope = value.mul(&value).neg();
        value.join(slope.mul(&b))
    }

    /// Returns the power with an integer exponent.
    pub fn whole_power(&self, exponent: i64) -> Self {
        let one = self.like(1.0);
        let power = (0..exponent.unsigned_abs()).fold(one, |power, _| power.mul(self));
        if exponent < 0 { power.reciprocal() } else { power }
    }

    /// Returns `self` to a non-constant power: exp(b ln a).
    pub fn power(&self, exponent: &Self) -> Self {
        exponent.mul(&self.call(Function::Ln)).call(Function::Exp)
    }

    /// Returns `self` to the power of a fraction, computed with the powers of the scalar.
    pub fn rational_power(&self, top: i64, bottom: i64) -> Self {
        if top % bottom == 0 {
            return self.whole_power(top / bottom);
        }
        let exponent = T::from_f64(top as f64) / T::from_f64(bottom as f64);
        if let [value] = self.0[..] {
            return Self(vec![if bottom == 2 {
                Self(vec![value.sqrt()]).whole_power(top).0[0]
            } else {
                value.powf(exponent)
            }]);
        }
        let (a, b) = self.split();
        let slope = a
            .rational_power(top - bottom, bottom)
            .mul(&Self::constant(exponent, a.infinitesimals()));
        a.rational_power(top, bottom).join(slope.mul(&b))
    }

    /// Returns the larger number, or the first of two equal numbers. An `other` that is not finite
    /// is always returned.
    pub fn max(&self, other: &Self) -> Self {
        if self.0[0] < other.0[0] || other.undefined() { other.clone() } else { self.clone() }
    }

    /// Returns the smaller number, or the first of two equal numbers. An `other` that is not finite
    /// is always returned.
    pub fn min(&self, other: &Self) -> Self {
        if other.0[0] < self.0[0] || other.undefined() { other.clone() } else { self.clone() }
    }

    fn undefined(&self) -> bool {
        !self.0[0].is_finite()
    }

    /// Returns the angle of the point (`x`, `self`).
    pub fn atan2(&self, x: &Self) -> Self {
        if let ([y], [x]) = (&self.0[..], &x.0[..]) {
            return Self(vec![y.atan2(*x)]);
        }
        let ((y, dy), (x, dx)) = (self.split(), x.split());
        let square = x.mul(&x).add(&y.mul(&y));
        let slope = x.mul(&dy).sub(&y.mul(&dx)).div(&square);
        y.atan2(&x).join(slope)
    }

    pub fn call(&self, function: Function) -> Self {
        if let [value] = self.0[..] {
            return Self(vec![of_scalar(function, value)]);
        }
        let (a, b) = self.split();
        let slope = a.slope(function);
        a.call(function).join(slope.mul(&b))
    }

    /// Returns the derivative of a function at `self`.
    fn slope(&self, function: Function) -> Self {
        let one = || self.like(1.0);
        let square = || self.mul(self);
        match function {
            Function::Sqrt => self.call(Function::Sqrt).mul(&self.like(2.0)).reciprocal(),
            Function::Exp => self.call(Function::Exp),
            Function::Ln => self.reciprocal(),
            Function::Sin => self.call(Function::Cos),
            Function::Cos => self.call(Function::Sin).neg(),
            Function::Tan => self.call(Function::Cos).whole_power(-2),
            Function::Asin => one().sub(&square()).call(Function::Sqrt).reciprocal(),
            Function::Acos => one().sub(&square()).call(Function::Sqrt).reciprocal().neg(),
            Function::Atan => one().add(&square()).reciprocal(),
            Function::Sinh => self.call(Function::Cosh),
            Function::Cosh => self.call(Function::Sinh),
            Function::Tanh => self.call(Function::Cosh).whole_power(-2),
            Function::Abs => self.call(Function::Sign),
            Function::Sign => self.like(0.0),
        }
    }

    /// Creates a constant with the same number of infinitesimals.
    fn like(&self, value: f64) -> Self {
        Self::constant(T::from_f64(value), self.infinitesimals())
    }
}

fn of_scalar<T: Float>(function: Function, x: T) -> T {
    match function {
        Function::Sqrt => x.sqrt(),
        Function::Exp => x.exp(),
        Function::Ln => x.ln(),
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tan => x.tan(),
        Function::Asin => x.asin(),
        Function::Acos => x.acos(),
        Function::Atan => x.atan(),
        Function::Sinh => x.sinh(),
        Function::Cosh => x.cosh(),
        Function::Tanh => x.tanh(),
        Function::Abs => x.abs(),
        Function::Sign => x.sign(),
    }
}
