//! Polynomials through given values and slopes, in the form of an
//! [`Interpolant`](crate::integrate::interpolant::Interpolant).

use crate::integrate::interpolant::TERMS;
use crate::integrate::linear::Factors;
use crate::scalar::Float;

/// A condition at a place θ.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Condition {
    /// The value y − y₀.
    Value(f64),
    /// The slope dy/dθ.
    Slope(f64),
}

/// Computes one term per condition, in addition to the first term, which is known. The conditions
/// must be independent.
pub(crate) fn fit<T: Float, const N: usize>(
    terms: &mut [[T; N]; TERMS],
    conditions: &[(Condition, [T; N])],
) {
    let row = |condition: &Condition| match *condition {
        Condition::Value(theta) => basis(theta).map(|[value, _]| value),
        Condition::Slope(theta) => basis(theta).map(|[_, slope]| slope),
    };
    let factors = Factors::<f64, TERMS, 1>::new(|_, _| {
        core::array::from_fn(|index| match conditions.get(index) {
            Some((condition, _)) => {
                let row = row(condition);
                core::array::from_fn(|k| if k < conditions.len() { row[k + 1] } else { 0.0 })
            }
            None => core::array::from_fn(|k| f64::from(u8::from(k == index))),
        })
    });
    for i in 0..N {
        let mut x = [[0.0; TERMS]];
        for (index, (condition, value)) in conditions.iter().enumerate() {
            x[0][index] = (value[i] - terms[0][i] * T::from_f64(row(condition)[0])).to_f64();
        }
        factors.solve(&mut x);
        for index in 0..conditions.len() {
            terms[index + 1][i] = T::from_f64(x[0][index]);
        }
    }
}

/// Returns value and slope of each of the polynomials θ, θ(1−θ), θ²(1−θ), ….
fn basis(theta: f64) -> [[f64; 2]; TERMS] {
    let [mut value, mut slope] = [1.0, 0.0];
    core::array::from_fn(|term| {
        let (factor, rise) = if term % 2 == 0 { (theta, 1.0) } else { (1.0 - theta, -1.0) };
        [value, slope] = [value * factor, slope * factor + value * rise];
        [value, slope]
    })
}

#[cfg(test)]
mod tests {
    use super::{Condition, TERMS, fit};
    use crate::integrate::interpolant::Basis;

    #[test]
    fn a_polynomial_is_found_again() {
        // 1 + θ − θ³ + θ⁶/2, from its value at 1 and the conditions below.
        let y = |x: f64| 1.0 + x - x.powi(3) + 0.5 * x.powi(6);
        let slope = |x: f64| 1.0 - 3.0 * x * x + 3.0 * x.powi(5);
        let mut terms = [[0.0]; TERMS];
        terms[0] = [y(1.0) - y(0.0)];
        let conditions = [
            (Condition::Slope(0.0), [slope(0.0)]),
            (Condition::Slope(1.0), [slope(1.0)]),
            (Condition::Value(0.25), [y(0.25) - y(0.0)]),
            (Condition::Value(-1.0), [y(-1.0) - y(0.0)]),
            (Condition::Slope(-2.0), [slope(-2.0)]),
        ];
        fit(&mut terms, &conditions);
        for x in [0.1_f64, 0.5, 0.9] {
            let [found] = Basis::Nested.at(&[y(0.0)], &terms[..6], x);
            assert!((found - y(x)).abs() < 1e-14, "{found} {}", y(x));
        }
    }
}
