//! The motion within one step, as polynomials.

pub(crate) mod dense;
pub(crate) mod fit;
pub(crate) mod hermite;

use crate::integrate::state::State;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::jet::MAX_ORDER;
use crate::scalar::Float;

/// The maximum number of terms of an [`Interpolant`].
pub(crate) const TERMS: usize = MAX_ORDER;

/// Coordinates and velocities within a step as polynomials in θ = (t − start)/h.
#[derive(Clone, Copy, Debug)]
pub struct Interpolant<T, const N: usize> {
    /// The interval of the step.
    pub interval: StepInterval,
    /// The coordinates at the start of the step.
    pub q0: [T; N],
    /// The velocities at the start of the step.
    pub v0: [T; N],
    /// The terms of the coordinates.
    pub q: [[T; N]; TERMS],
    /// The terms of the velocities.
    pub v: [[T; N]; TERMS],
    /// The number of terms in use.
    pub terms: usize,
    /// The functions that multiply the terms.
    pub basis: Basis,
}

/// The functions that multiply the terms of an [`Interpolant`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Basis {
    /// y(θ) = y₀ + θ(F₀ + (1−θ)(F₁ + θ(F₂ + (1−θ)(F₃ + …)))), the form of Hairer, Nørsett and
    /// Wanner (1993), II.6: F₀ is the increment, so that the polynomial meets both ends exactly,
    /// and F₁ and F₂ follow from the slopes at the ends.
    Nested,
    /// y(θ) = y₀ + θ(F₀ + θ(F₁ + θ(F₂ + …))): a Taylor polynomial.
    Powers,
    /// y(θ) = y₀ + Σ F_k (P_{k+1}(2θ − 1) − P_{k+1}(−1)) with Legendre's polynomials P.
    Legendre,
}

impl Basis {
    /// Returns the value at θ of the polynomial with these terms.
    pub(crate) fn at<T: Float, const N: usize>(
        self,
        y0: &[T; N],
        terms: &[[T; N]],
        theta: T,
    ) -> [T; N] {
        if self == Self::Legendre {
            return legendre(y0, terms, theta);
        }
        let other = if self == Self::Nested { T::from_f64(1.0) - theta } else { theta };
        let factors = [theta, other];
        core::array::from_fn(|i| {
            let zero = T::from_f64(0.0);
            let sum = terms
                .iter()
                .enumerate()
                .rev()
                .fold(zero, |sum, (k, term)| (sum + term[i]) * factors[k % 2]);
            y0[i] + sum
        })
    }
}

/// The number of terms whose functions are [known](Basis::known) beforehand: all of every method
/// but [`Taylor`](crate::integrate::Taylor).
pub(crate) const KNOWN: usize = 18;

impl Basis {
    /// Returns the functions at θ.
    pub(crate) fn known<T: Float>(self, theta: T) -> [T; KNOWN] {
        let one = T::from_f64(1.0);
        let mut functions = [theta; KNOWN];
        let other = match self {
            Self::Nested => one - theta,
            Self::Powers => theta,
            Self::Legendre => {
                for_legendre(theta, KNOWN, |k, function| functions[k] = function);
                return functions;
            }
        };
        for k in 1..KNOWN {
            functions[k] = functions[k - 1] * if k % 2 == 0 { theta } else { other };
        }
        functions
    }
}

/// Returns y₀ + Σ terms_k (P_{k+1}(2θ − 1) − P_{k+1}(−1)).
fn legendre<T: Float, const N: usize>(y0: &[T; N], terms: &[[T; N]], theta: T) -> [T; N] {
    let mut sums = [T::from_f64(0.0); N];
    for_legendre(theta, terms.len(), |k, function| {
        for i in 0..N {
            sums[i] += terms[k][i] * function;
        }
    });
    core::array::from_fn(|i| y0[i] + sums[i])
}

/// Calls `each` with P_{k+1}(2θ − 1) − P_{k+1}(−1) for each `k` below `count`, where (k + 1)
/// P_{k+1}(x) = (2k + 1) x P_k(x) − k P_{k−1}(x).
#[inline]
fn for_legendre<T: Float>(theta: T, count: usize, mut each: impl FnMut(usize, T)) {
    let one = T::from_f64(1.0);
    let x = theta - (one - theta);
    let (mut before, mut now, mut sign) = (one, x, -one);
    for index in 0..count {
        each(index, now - sign);
        let k = (index + 1) as f64;
        let next = T::ratio(2.0 * k + 1.0, k + 1.0) * (x * now) - T::ratio(k, k + 1.0) * before;
        (before, now, sign) = (now, next, -sign);
    }
}

impl<T: Float, const N: usize> Interpolant<T, N> {
    /// Creates the cubics through the states at both ends of `interval` with the given slopes
    /// there: velocities for the coordinates, accelerations for the velocities.
    pub fn hermite(
        interval: &StepInterval,
        from: &Endpoint<T, N>,
        to: &Endpoint<T, N>,
        a0: &[T; N],
        a1: &[T; N],
    ) -> Self {
        let mut interpolant = Self::linear(interval, from, to);
        let h = interval.length::<T>();
        clamp(&mut interpolant.q, h, &from.v.high, &to.v.high);
        clamp(&mut interpolant.v, h, a0, a1);
        interpolant.terms = 3;
        interpolant
    }

    /// Creates the straight line between the states at both ends.
    pub fn linear(interval: &StepInterval, from: &Endpoint<T, N>, to: &Endpoint<T, N>) -> Self {
        let zero = [[T::from_f64(0.0); N]; TERMS];
        let mut interpolant = Self {
            interval: *interval,
            q0: from.q.high,
            v0: from.v.high,
            q: zero,
            v: zero,
            terms: 1,
            basis: Basis::Nested,
        };
        interpolant.q[0] = to.q.since(&from.q);
        interpolant.v[0] = to.v.since(&from.v);
        interpolant
    }

    /// Sets the slopes of the coordinates at the ends to `v0` and `v1`.
    pub(crate) fn clamp_coordinates(&mut self, h: T, v0: &[T; N], v1: &[T; N]) {
        clamp(&mut self.q, h, v0, v1);
    }

    /// Adds cubics to both polynomials so that they end in the state `to`. The values at the start
    /// and the slopes at both ends stay the same, except for the slope of the coordinates at the
    /// end, which changes as the velocities there.
    pub(crate) fn end_at(&mut self, to: &Endpoint<T, N>) {
        let number = T::from_f64;
        let (q, v) = self.at(number(1.0));
        let h = self.interval.length::<T>();
        for i in 0..N {
            let (by_q, by_v) = (to.q.high[i] - q[i], to.v.high[i] - v[i]);
            bend(&mut self.q, self.basis, i, by_q, h * by_v);
            bend(&mut self.v, self.basis, i, by_v, number(0.0));
        }
        self.terms = self.terms.max(3);
    }

    /// Returns the coordinates and the velocities at θ.
    pub fn at(&self, theta: T) -> ([T; N], [T; N]) {
        (
            self.basis.at(&self.q0, &self.q[..self.terms], theta),
            self.basis.at(&self.v0, &self.v[..self.terms], theta),
        )
    }
}

/// Returns the state at `t` within a step from the time `start` to the state `end`, or `None`
/// outside.
pub(crate) fn within<'i, T: Float, const N: usize>(
    start: f64,
    end: State<T, N>,
    t: f64,
    interpolant: impl FnOnce() -> Option<&'i Interpolant<T, N>>,
) -> Option<State<T, N>> {
    if t == end.t {
        return Some(end);
    }
    if !(start <= t && t < end.t || end.t < t && t <= start) {
        return None;
    }
    let interpolant = interpolant()?;
    let (zero, one, theta) =
        (T::from_f64(0.0), T::from_f64(1.0), interpolant.interval.fraction::<T>(t));
    let theta = if theta < zero { zero } else { theta };
    let (q, v) = interpolant.at(if theta < one { theta } else { one });
    Some(State { t, q, v })
}

/// Adds d(3θ² − 2θ³) + s(θ³ − θ²) to one polynomial: its value at the end changes by d, its slope
/// by s.
fn bend<T: Float, const N: usize>(
    terms: &mut [[T; N]; TERMS],
    basis: Basis,
    index: usize,
    d: T,
    s: T,
) {
    let number = T::from_f64;
    // The coefficients of θ² and θ³.
    let (square, cube) = (number(3.0) * d - s, s - number(2.0) * d);
    let added = match basis {
        Basis::Nested => [d, -d, number(2.0) * d - s],
        Basis::Powers => [number(0.0), square, cube],
        Basis::Legendre => [
            T::ratio(1.0, 2.0) * square + T::ratio(9.0, 20.0) * cube,
            T::ratio(1.0, 6.0) * square + T::ratio(1.0, 4.0) * cube,
            T::ratio(1.0, 20.0) * cube,
        ],
    };
    for (term, added) in terms.iter_mut().zip(added) {
        term[index] += added;
    }
}

/// Computes F₁ and F₂ from the slopes at both ends.
fn clamp<T: Float, const N: usize>(
    terms: &mut [[T; N]; TERMS],
    h: T,
    slope0: &[T; N],
    slope1: &[T; N],
) {
    for i in 0..N {
        let increment = terms[0][i];
        terms[1][i] = h * slope0[i] - increment;
        terms[2][i] = (increment - h * slope1[i]) - terms[1][i];
    }
}
