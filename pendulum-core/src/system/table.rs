//! Tables of functions: the pieces of their splines. For tables of a block, the compiler has
//! computed them.

use crate::error::Error;
use crate::motion::spline::{Ends, velocities};
use crate::scalar::Real;
use crate::system::equations::System;
use std::sync::Arc;

/// The function of a parameter `f: table(m): N`: the natural cubic spline through some points.
///
/// It ends with its points, and a run beyond them is refused, unless it is
/// [`linear`](Self::linear) there. Its derivatives are known to the equations, and steps end at its
/// points. Arguments and values are in the units that the block declares. Clones share the points;
/// a system with a table is [`Clone`], but not [`Copy`].
///
/// ```
/// use pendulum_runtime::prelude::*;
///
/// lagrangian! {
///     #[derive(Clone, Debug)]
///     pub struct Block { m: kg, f: table(m): N }
///     coordinate x: m;
///     kinetic = m/2*dot(x)^2;
///     force x = -f(x);
/// }
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // A measured spring, twice as stiff beyond 0.1 m.
/// let spring = Table::new(&[(-0.1, -3.0), (0.0, 0.0), (0.1, 3.0), (0.2, 9.0)])?;
/// let block = Block::new(0.5, spring.linear());
/// let run = solve(&block, (0.0, 1.0), [0.15], [0.0]).run()?;
/// # let _ = run;
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Table(Arc<Spline>);

#[derive(Debug)]
struct Spline {
    points: Vec<(f64, f64)>,
    linear: bool,
    /// The pieces, as [`table`] takes them, and the points that [`knots`] takes.
    rows: Vec<[f64; 5]>,
    knots: Vec<f64>,
}

impl PartialEq for Spline {
    fn eq(&self, other: &Self) -> bool {
        self.points == other.points && self.linear == other.linear
    }
}

/// The largest number of points, as in a block.
const MOST_POINTS: usize = 256;

impl Table {
    /// Creates the natural cubic spline through `points`, each an argument and a value: its second
    /// derivative is continuous, and zero at both ends.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] unless there are 2 to 256 points of finite numbers, their
    /// arguments ascend, and the spline is in the range of `f64`.
    pub fn new(points: &[(f64, f64)]) -> Result<Self, Error> {
        let setting = |name, value, required| Err(Error::Setting { name, value, required });
        if !(2..=MOST_POINTS).contains(&points.len()) {
            return setting("number of points", points.len() as f64, "from 2 to 256");
        }
        let mut numbers = points.iter().flat_map(|&(x, y)| [x, y]);
        if let Some(value) = numbers.find(|number| !number.is_finite()) {
            return setting("number of a point", value, "finite");
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[1].0 <= pair[0].0) {
            let required = "greater than that of the point before it; sort the points";
            return setting("argument of a point", pair[1].0, required);
        }
        let own = Self::through(points.to_vec(), false);
        let pieces = &own.0.rows[1..points.len()];
        match pieces.iter().flatten().find(|number| !number.is_finite()) {
            Some(&value) => {
                setting("coefficient of the spline", value, "finite; choose other units")
            }
            None => Ok(own),
        }
    }

    /// Lets the function go on along its tangents beyond the first and the last point.
    #[must_use]
    pub fn linear(self) -> Self {
        Self::through(self.0.points.clone(), true)
    }

    /// Returns the table with arguments and values multiplied by `factors`.
    pub(super) fn times(&self, [x, y]: [f64; 2]) -> Result<Self, Error> {
        let Spline { points, linear, .. } = &*self.0;
        let points: Vec<(f64, f64)> =
            points.iter().map(|point| (x * point.0, y * point.1)).collect();
        let own = Self::new(&points)?;
        Ok(if *linear { own.linear() } else { own })
    }

    fn through(points: Vec<(f64, f64)>, linear: bool) -> Self {
        let (x, y): (Vec<f64>, Vec<[f64; 1]>) = points.iter().map(|&(x, y)| (x, [y])).unzip();
        let slopes = velocities(&x, &y, &Ends::Natural);
        let pieces = (1..x.len()).map(|k| {
            let (width, [before], [after]) = (x[k] - x[k - 1], slopes[k - 1], slopes[k]);
            let chord = (y[k][0] - y[k - 1][0]) / width;
            let bend = (3.0 * chord - 2.0 * before - after) / width;
            let third = (before + after - 2.0 * chord) / (width * width);
            [x[k - 1], y[k - 1][0], before, bend, third]
        });
        let outside = |k: usize| {
            let [y, slope, zero] =
                if linear { [y[k][0], slopes[k][0], 0.0] } else { [f64::NAN; 3] };
            [x[k], y, slope, zero, zero]
        };
        let ends = [outside(0), outside(x.len() - 1)];
        let rows: Vec<[f64; 5]> = [ends[0]].into_iter().chain(pieces).chain([ends[1]]).collect();
        let jumps = |pair: &&[[f64; 5]]| pair[0][4] != pair[1][4];
        let knots = rows.windows(2).filter(jumps).map(|pair| pair[1][0]).collect();
        Self(Arc::new(Spline { points, linear, rows, knots }))
    }
}

/// Returns the tables among the parameters of a system, in the order of declaration.
pub fn tables<S: System<N>, const N: usize>(system: &S) -> Vec<Table> {
    let mut all = Vec::new();
    system.__given_tables(&mut |table| all.push(table.clone()));
    all
}

/// Returns the pieces of a table.
pub fn rows_of(table: &Table) -> &[[f64; 5]] {
    &table.0.rows
}

/// Returns the points of a table at which its third derivative jumps or ends.
pub fn knots_of(table: &Table) -> &[f64] {
    &table.0.knots
}

/// Returns the first and the last point of a table that is refused beyond them.
pub fn ends(rows: &[[f64; 5]]) -> Option<[f64; 2]> {
    let [[first, value, ..], .., [last, ..]] = rows else { return None };
    value.is_nan().then_some([*first, *last])
}

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
