//! Natural cubic splines, the functions of tables.

/// A natural cubic spline: it goes through some points, with continuous second derivatives that are
/// zero at both ends.
#[derive(Clone, Debug, Default)]
pub(crate) struct Spline {
    /// The pieces, with the one before the first point and the one behind the last point: a point
    /// and the coefficients of a polynomial in the distance from it.
    pub(crate) rows: Vec<[f64; 5]>,
    /// The points at which the third derivative jumps or ends.
    pub(crate) knots: Vec<f64>,
}

impl Spline {
    /// The number of [`digits`](Self::digits) of a table with as many points as one may have, 256.
    pub(crate) const MOST_DIGITS: u8 = 9;

    /// Computes the spline through two or more points with ascending abscissas, which goes on along
    /// its tangents if `linear` is set and has no value beyond its ends otherwise.
    pub(crate) fn natural(points: &[[f64; 2]], linear: bool) -> Self {
        let Some(last) = points.len().checked_sub(1).filter(|&last| 0 < last) else {
            return Self::default();
        };
        let width = |k: usize| points[k + 1][0] - points[k][0];
        let slope = |k: usize| (points[k + 1][1] - points[k][1]) / width(k);
        // The second derivatives are those of a tridiagonal system whose diagonal is twice the sum
        // of the entries beside it, so that no pivot is small.
        let mut curvature = vec![0.0; points.len()];
        let mut shares = vec![0.0; points.len()];
        for k in 1..last {
            let pivot = 2.0 * (width(k - 1) + width(k)) - width(k - 1) * shares[k - 1];
            shares[k] = width(k) / pivot;
            let right = 6.0 * (slope(k) - slope(k - 1)) - width(k - 1) * curvature[k - 1];
            curvature[k] = right / pivot;
        }
        for k in (1..last).rev() {
            curvature[k] -= shares[k] * curvature[k + 1];
        }
        let piece = |k: usize| {
            let [x, y] = points[k];
            let bend = curvature[k + 1] - curvature[k];
            let tangent = slope(k) - width(k) * (0.5 * curvature[k] + bend / 6.0);
            [x, y, tangent, 0.5 * curvature[k], bend / (6.0 * width(k))]
        };
        let outside = |[x, y]: [f64; 2], tangent: f64| {
            if linear {
                [x, y, tangent, 0.0, 0.0]
            } else {
                [x, f64::NAN, f64::NAN, f64::NAN, f64::NAN]
            }
        };
        let tangent = slope(last - 1) + width(last - 1) * curvature[last - 1] / 6.0;
        let mut rows = vec![outside(points[0], piece(0)[2])];
        rows.extend((0..last).map(piece));
        rows.push(outside(points[last], tangent));
        let jump = |pair: &[[f64; 5]]| pair[0][4] != pair[1][4];
        let knots = rows.windows(2).filter(|pair| jump(pair)).map(|pair| pair[1][0]).collect();
        Self { rows, knots }
    }

    /// Returns the value at `x`.
    pub(crate) fn value(&self, x: f64) -> f64 {
        let [before, pieces @ ..] = &self.rows[..] else { return 0.0 };
        let own = pieces.iter().rev().find(|row| row[0] < x).or(pieces.first());
        let [start, coefficients @ ..] = own.filter(|row| row[0] <= x).unwrap_or(before);
        coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * (x - start) + coefficient)
    }

    /// Returns the number of binary digits that tell the intervals between the knots apart.
    pub(crate) fn digits(&self) -> u8 {
        (usize::BITS - self.knots.len().leading_zeros()).try_into().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::Spline;

    /// Burden and Faires, Numerical Analysis, section 3.5: e^x at 0, 1, 2 and 3.
    #[test]
    fn published_coefficients() {
        let points = [0.0, 1.0, 2.0, 3.0].map(|x: f64| [x, x.exp()]);
        let Spline { rows, knots } = Spline::natural(&points, true);
        let expected =
            [[1.46600, 0.0, 0.25228], [2.22285, 0.75685, 1.69107], [8.80977, 5.83007, -1.94336]];
        for ((row, point), expected) in rows[1..4].iter().zip(points).zip(expected) {
            assert_eq!(row[..2], point);
            for (found, expected) in row[2..].iter().zip(expected) {
                assert!((found - expected).abs() < 6e-6, "{found} {expected}");
            }
        }
        assert_eq!(knots, [0.0, 1.0, 2.0, 3.0]);
    }

    #[test]
    fn two_derivatives_are_continuous_and_the_ends_straight() {
        let points: Vec<[f64; 2]> =
            (0..40).map(f64::from).map(|k| [k + 0.4 * k.sin(), (k * k).cos()]).collect();
        let Spline { rows, .. } = Spline::natural(&points, true);
        for (pair, point) in rows.windows(2).zip(&points) {
            let [x, a, b, c, d] = pair[0];
            let h = pair[1][0] - x;
            let end =
                [a + h * (b + h * (c + h * d)), b + h * (2.0 * c + 3.0 * h * d), c + 3.0 * h * d];
            for (before, after) in end.into_iter().zip(&pair[1][1..4]) {
                assert!((before - after).abs() < 1e-13, "{before} {after} at {x}");
            }
            assert_eq!(pair[1][..2], *point);
        }
        assert_eq!((rows[1][3], rows[40][3]), (0.0, 0.0));
    }

    #[test]
    fn values_inside_and_outside() {
        let points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]];
        let linear = Spline::natural(&points, true);
        // y'' is −3 in the middle, and y' is 3/2 and −3/2 at the ends.
        assert_eq!(
            [0.0, 0.5, 1.0, 1.5, 2.0].map(|x| linear.value(x)),
            [0.0, 0.6875, 1.0, 0.6875, 0.0]
        );
        assert_eq!([-2.0, 4.0].map(|x| linear.value(x)), [-3.0, -3.0]);
        let refused = Spline::natural(&points, false);
        assert_eq!([0.0, 1.0, 2.0].map(|x| refused.value(x)), [0.0, 1.0, 0.0]);
        assert!([-0.1, 2.1].iter().all(|&x| refused.value(x).is_nan()));
        assert_eq!((linear.knots, refused.knots), (vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 2.0]));
    }

    #[test]
    fn a_straight_line_has_no_knots() {
        let spline = Spline::natural(&[[1.0, 2.0], [3.0, 8.0]], true);
        assert_eq!((spline.value(2.0), spline.value(5.0), spline.digits()), (5.0, 14.0, 0));
    }

    #[test]
    fn digits_tell_all_intervals_apart() {
        let digits = |count: usize| Spline { rows: Vec::new(), knots: vec![0.0; count] }.digits();
        assert_eq!([1, 2, 3, 4, 255, 256].map(digits), [1, 2, 2, 3, 8, 9]);
    }
}
