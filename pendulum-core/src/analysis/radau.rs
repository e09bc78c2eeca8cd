//! Radau's rules: collocation within the steps of a motion.

use super::sensitivity::{Column, Part};
use crate::integrate::interpolant::dense::Functions;
use crate::scalar::{Float, Real};

/// The numbers of Radau's nodes in steps whose polynomials have at most eight terms, and in
/// others. The columns are as smooth as the motion. Six nodes have the order 11; with five, of the
/// order 9, the columns along [`Dop853`](crate::integrate::Dop853) were forty times less accurate
/// than the motion at the tolerance 1e-13. Eight nodes have the order 15 of the estimate by which
/// [`Picard`](crate::integrate::Picard) chooses its steps. Gauss's nodes have one order more, but do
/// not damp: what is stiff would remain in the columns where the motion itself is slow and the
/// steps are long.
pub(super) const NODES: [usize; 2] = [6, 8];

/// Radau's nodes on [0, 1], the last of which is 1, and the integrals of the polynomials through
/// values at them.
pub(super) struct Rule<T, const S: usize> {
    pub(super) nodes: [T; S],
    /// The values of the functions of dense output at each node.
    pub(super) functions: [Functions<T>; S],
    /// The Legendre coefficient k of a polynomial, for its value 1 at node j: `basis[k][j]`.
    basis: [[T; S]; S],
    /// The integrals to each node of the polynomials that are 1 at a node: `once[i][j]`.
    pub(super) once: [[T; S]; S],
    /// The integrals of these integrals.
    pub(super) twice: [[T; S]; S],
}

impl<T: Float, const S: usize> Rule<T, S> {
    pub(super) fn new() -> Self {
        let number = T::from_f64;
        let (zero, one) = (number(0.0), number(1.0));
        let mut rule = Self {
            nodes: [zero; S],
            functions: [Functions::new(zero); S],
            basis: [[zero; S]; S],
            once: [[zero; S]; S],
            twice: [[zero; S]; S],
        };
        let size = number(S as f64);
        for j in 0..S {
            // The nodes are the zeros of P_S − P_{S−1}. Newton's method starts from the zeros of the
            // same difference of Chebyshev's polynomials, which are good to two digits; the last two
            // steps are for scalars of two words.
            let from_end = 2.0 * (S - 1 - j) as f64;
            let mut x = Real::cos(T::pi() * T::ratio(from_end, 2.0 * S as f64 - 1.0));
            let steps = if from_end == 0.0 { 0 } else { 6 };
            for _ in 0..steps {
                let p = legendre(x);
                let slope = size * (x * p[S] - p[S - 1]) - (size - one) * (x * p[S - 1] - p[S - 2]);
                x -= (p[S] - p[S - 1]) * (x * x - one) / slope;
            }
            let p = legendre(x);
            let weight = (one + x) / (number(2.0) * size * size * p[S - 1] * p[S - 1]);
            for k in 0..S {
                rule.basis[k][j] = number((2 * k + 1) as f64) * weight * p[k];
            }
            rule.nodes[j] = (one + x) / number(2.0);
            rule.functions[j] = Functions::new(rule.nodes[j]);
        }
        for i in 0..S {
            [rule.once[i], rule.twice[i]] = rule.weights(rule.nodes[i]);
        }
        rule
    }

    /// Returns the weights of the values at the nodes in the integral from 0 to θ, and in the
    /// integral of this integral.
    fn weights(&self, theta: T) -> [[T; S]; 2] {
        let number = T::from_f64;
        let p = legendre(theta + theta - number(1.0));
        // ∫ P_k dθ = (P_{k+1} − P_{k−1}) / (4k + 2), and the same once more.
        let (mut once, mut twice) = ([theta; MOST], [theta * theta / number(2.0); S]);
        for k in 1..=S {
            once[k] = (p[k + 1] - p[k - 1]) / number((4 * k + 2) as f64);
        }
        for k in 1..S {
            twice[k] = (once[k + 1] - once[k - 1]) / number((4 * k + 2) as f64);
        }
        let sum = |values: &[T]| {
            core::array::from_fn(|j| {
                (0..S).fold(number(0.0), |sum, k| sum + values[k] * self.basis[k][j])
            })
        };
        [sum(&once), sum(&twice)]
    }

    /// Returns the columns when θ of a part of a step has passed.
    pub(super) fn at<const N: usize, const K: usize>(
        &self,
        theta: T,
        part: &Part<'_, T, N>,
        columns: &[Column<T, N>; K],
        accelerations: &[[[T; N]; S]; K],
    ) -> [Column<T, N>; K] {
        let ([once, twice], h) = (self.weights(theta), part.length());
        core::array::from_fn(|k| {
            advanced(theta * h, h, &columns[k], &accelerations[k], (&once, &twice))
        })
    }
}

/// Returns a column after the time `elapsed` of a step, from the weights of its accelerations.
pub(super) fn advanced<T: Float, const N: usize, const S: usize>(
    elapsed: T,
    h: T,
    [q, v]: &Column<T, N>,
    a: &[[T; N]; S],
    (once, twice): (&[T; S], &[T; S]),
) -> Column<T, N> {
    let zero = T::from_f64(0.0);
    let (mut first, mut second) = ([zero; N], [zero; N]);
    for j in 0..S {
        for i in 0..N {
            first[i] += once[j] * a[j][i];
            second[i] += twice[j] * a[j][i];
        }
    }
    [
        core::array::from_fn(|i| q[i] + elapsed * v[i] + h * h * second[i]),
        core::array::from_fn(|i| v[i] + h * first[i]),
    ]
}

/// The number of Legendre's polynomials that the larger rule needs.
const MOST: usize = NODES[1] + 2;

/// Returns the values of Legendre's polynomials P₀, P₁, ….
fn legendre<T: Real>(x: T) -> [T; MOST] {
    let mut values = [T::from_f64(1.0); MOST];
    values[1] = x;
    for k in 1..MOST - 1 {
        let (n, more) = (T::from_f64(k as f64), T::from_f64((k + 1) as f64));
        values[k + 1] = ((n + more) * x * values[k] - n * values[k - 1]) / more;
    }
    values
}
