//! Tables of functions: the pieces of their splines, which the compiler has computed.

use crate::scalar::Real;

/// Computes the derivative of `order` of the spline of a table at `x`.
///
/// A row is a point and the coefficients of a polynomial in the distance from it, which holds up to
/// the point of the next row. The first row holds before the point of the second, the last one
/// behind its own. At a point of the table, the pieces on both sides agree up to the second
/// derivative.
pub fn table<T: Real>(rows: &[[f64; 5]], order: usize, x: T) -> T {
    let zero = T::from_f64(0.0);
    let [before, pieces @ ..] = rows else { return zero };
    let [start, own @ ..] = x.row(pieces);
    // The first two rows have the same point.
    let [_, outside @ ..] = before.map(T::from_f64);
    let early = T::from_f64(before[0]) - x;
    // The factor of the coefficient of degree k in a derivative is k (k − 1) ⋯ (k − order + 1).
    let factor = |degree: usize| (degree + 1 - order..=degree).product::<usize>() as f64;
    (order..own.len()).rev().fold(zero, |sum, degree| {
        let coefficient = early.where_positive(outside[degree], own[degree]);
        sum * (x - start) + T::from_f64(factor(degree)) * coefficient
    })
}

/// Computes a function of `x` that changes its sign where the interval between `knots` gets another
/// digit of this index in the Gray code, with slopes of ±1 there.
///
/// From one interval to the next, one digit changes. Steps therefore end at every knot, even if
/// there are several between two points at which arguments of switches are evaluated, and a table
/// has as many switches as the number of its intervals has binary digits.
pub fn knots<T: Real>(knots: &[f64], digit: u32, x: T) -> T {
    let own = |from: usize| {
        (from..knots.len()).find(|k| (k + 1).trailing_zeros() == digit).map(|k| (k, knots[k]))
    };
    let Some((mut index, mut knot)) = own(0) else { return T::from_f64(1.0) };
    let mut value = x - T::from_f64(knot);
    let mut sign = T::from_f64(1.0);
    loop {
        let past = x - T::from_f64(knot);
        let next = own(index + 1);
        let share = next.map_or(T::from_f64(1.0), |(_, next)| {
            (T::from_f64(next) - x) / T::from_f64(next - knot)
        });
        value = past.where_positive(sign * past * share, value);
        sign = -sign;
        match next {
            Some(next) => (index, knot) = next,
            None => return value,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{knots, table};
    use crate::scalar::{Dual, Lanes, Real};

    const ROWS: [[f64; 5]; 4] = [
        [0.0, 1.0, 2.0, 0.0, 0.0],
        [0.0, 1.0, 2.0, 0.0, 3.0],
        [1.0, 6.0, 11.0, 9.0, -3.0],
        [2.0, 23.0, 20.0, 0.0, 0.0],
    ];
    const KNOTS: [f64; 7] = [-1.0, 0.0, 0.5, 2.0, 3.0, 4.5, 5.0];

    #[test]
    fn derivatives_are_those_of_the_piece() {
        let at = |x| [0, 1, 2, 3, 4].map(|order| table(&ROWS, order, x));
        assert_eq!(at(-1.0), [-1.0, 2.0, 0.0, 0.0, 0.0]);
        assert_eq!(at(0.5), [2.375, 4.25, 9.0, 18.0, 0.0]);
        assert_eq!(at(1.5), [13.375, 17.75, 9.0, -18.0, 0.0]);
        assert_eq!(at(3.0), [43.0, 20.0, 0.0, 0.0, 0.0]);
        assert!(table(&ROWS, 0, f64::NAN).is_nan());
    }

    #[test]
    fn dual_numbers_have_the_derivative() {
        for x in [-1.0, 0.0, 0.3, 1.0, 1.7, 9.0] {
            let dual = table(&ROWS, 1, Dual::variable(x));
            assert_eq!(dual.value, table(&ROWS, 1, x));
            assert!((dual.derivative - table(&ROWS, 2, x)).abs() < 1e-14);
        }
    }

    #[test]
    fn lanes_have_the_bits_of_single_numbers() {
        let all = [-0.1, 0.0, 0.1, 1.0, 1.3, 2.0, 2.1, f64::NAN];
        for order in 0..4 {
            let lanes = table(&ROWS, order, Lanes(all));
            let bits = all.map(|x| table(&ROWS, order, x).to_bits());
            assert_eq!(lanes.0.map(f64::to_bits), bits);
        }
        for digit in 0..3 {
            let lanes = knots(&KNOTS, digit, Lanes(all));
            assert_eq!(lanes.0.map(f64::to_bits), all.map(|x| knots(&KNOTS, digit, x).to_bits()));
        }
    }

    #[test]
    fn a_search_finds_the_row_of_a_comparison() {
        for x in [-5.0, 0.0, 5e-324, 0.5, 1.0, 1.0_f64.next_up(), 2.0, 7.0, f64::INFINITY] {
            assert_eq!(x.row(&ROWS[1..]), Lanes([x]).row(&ROWS[1..]).map(|lane| lane.0[0]));
            assert_eq!(x.row(&ROWS[1..]), Dual::constant(x).row(&ROWS[1..]).map(|dual| dual.value));
            let x = x as f32;
            assert_eq!(x.row(&ROWS[1..]), Lanes([x]).row(&ROWS[1..]).map(|lane| lane.0[0]));
        }
    }

    #[test]
    fn one_digit_changes_its_sign_at_each_knot() {
        for (index, knot) in KNOTS.into_iter().enumerate() {
            for digit in 0..3 {
                let [before, at, after] =
                    [-1e-6, 0.0, 1e-6].map(|h| knots(&KNOTS, digit, knot + h));
                if (index + 1).trailing_zeros() == digit {
                    assert_eq!(at, 0.0);
                    assert!(before * after < 0.0 && ((after - before).abs() - 2e-6).abs() < 1e-11);
                } else {
                    assert!(0.0 < before * after);
                }
            }
        }
    }
}
