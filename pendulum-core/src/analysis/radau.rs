//! Radau's rule: collocation within the steps of a motion.

// Compiled for several instruction sets, with the functions that call these.
#![allow(clippy::inline_always)]

use crate::integrate::interpolant::dense::{DenseStep, Functions};
use crate::scalar::{Float, Octet, Real};

/// The number of Radau's nodes in a step, one in each lane. The columns are as smooth as the
/// motion, and eight nodes have the order 15 of the estimate by which
/// [`Picard`](crate::integrate::Picard) chooses its steps. With five, of the order 9, the columns
/// along [`Dop853`](crate::integrate::Dop853) were forty times less accurate than the motion at the
/// tolerance 1e-13. Gauss's nodes have one order more, but do not damp: what is stiff would remain in
/// the columns where the motion itself is slow and the steps are long.
pub(super) const NODES: usize = 8;

/// Numbers at each of the nodes, for each coordinate.
pub(super) type Nodes<T, const N: usize> = [Octet<T>; N];

/// The derivatives of the coordinates and of the velocities.
pub(super) type Column<T, const N: usize> = [[T; N]; 2];

/// Radau's nodes on [0, 1], the last of which is 1, and the integrals of the polynomials through
/// values at them.
pub(super) struct Rule<T> {
    pub(super) nodes: Octet<T>,
    /// The values of the functions of dense output at the nodes.
    pub(super) functions: Functions<T>,
    /// The Legendre coefficient k of a polynomial, for its value 1 at node j: `basis[k][j]`.
    basis: [[T; NODES]; NODES],
    /// The integrals to each node of the polynomial that is 1 at node j: `once[j]`.
    pub(super) once: [Octet<T>; NODES],
    /// The integrals of these integrals.
    pub(super) twice: [Octet<T>; NODES],
}

impl<T: Float> Rule<T> {
    pub(super) fn new() -> Self {
        let number = T::from_f64;
        let (zero, one, size) = (number(0.0), number(1.0), number(NODES as f64));
        let mut basis = [[zero; NODES]; NODES];
        let nodes = core::array::from_fn(|j| {
            // The nodes are the zeros of P_S − P_{S−1}. Newton's method starts from the zeros of the
            // same difference of Chebyshev's polynomials, which are good to two digits; the last two
            // steps are for scalars of two words.
            let from_end = 2.0 * (NODES - 1 - j) as f64;
            let mut x = Real::cos(T::pi() * T::ratio(from_end, 2.0 * NODES as f64 - 1.0));
            let steps = if from_end == 0.0 { 0 } else { 6 };
            for _ in 0..steps {
                let p = legendre(x);
                let slope = size * (x * p[NODES] - p[NODES - 1])
                    - (size - one) * (x * p[NODES - 1] - p[NODES - 2]);
                x -= (p[NODES] - p[NODES - 1]) * (x * x - one) / slope;
            }
            let p = legendre(x);
            let weight = (one + x) / (number(2.0) * size * size * p[NODES - 1] * p[NODES - 1]);
            for k in 0..NODES {
                basis[k][j] = number((2 * k + 1) as f64) * weight * p[k];
            }
            (one + x) / number(2.0)
        });
        let [once, twice] = [[Octet::splat(zero); NODES]; 2];
        let functions = Functions::new(&nodes);
        let mut rule = Self { nodes: Octet(nodes), functions, basis, once, twice };
        for i in 0..NODES {
            let [once, twice] = rule.weights(nodes[i]);
            for j in 0..NODES {
                (rule.once[j].0[i], rule.twice[j].0[i]) = (once[j], twice[j]);
            }
        }
        rule
    }

    /// Returns the weights of the values at the nodes in the integral from 0 to θ, and in the
    /// integral of this integral.
    fn weights(&self, theta: T) -> [[T; NODES]; 2] {
        let number = T::from_f64;
        let p = legendre(theta + theta - number(1.0));
        // ∫ P_k dθ = (P_{k+1} − P_{k−1}) / (4k + 2), and the same once more.
        let (mut once, mut twice) = ([theta; MOST], [theta * theta / number(2.0); NODES]);
        for k in 1..=NODES {
            once[k] = (p[k + 1] - p[k - 1]) / number((4 * k + 2) as f64);
        }
        for k in 1..NODES {
            twice[k] = (once[k + 1] - once[k - 1]) / number((4 * k + 2) as f64);
        }
        let sum = |values: &[T]| {
            core::array::from_fn(|j| {
                (0..NODES).fold(number(0.0), |sum, k| sum + values[k] * self.basis[k][j])
            })
        };
        [sum(&once), sum(&twice)]
    }

    /// Returns the coordinates and the velocities of a column at the nodes of a step of length `h`,
    /// from the accelerations there.
    #[inline(always)]
    pub(super) fn at_nodes<const N: usize>(
        &self,
        h: T,
        [q, v]: &Column<T, N>,
        a: &Nodes<T, N>,
    ) -> [Nodes<T, N>; 2] {
        let wide = Octet::splat(h);
        let elapsed = self.nodes * wide;
        let mut all = [[Octet::splat(T::from_f64(0.0)); N]; 2];
        for i in 0..N {
            let (mut once, mut twice) = (all[0][i], all[1][i]);
            for j in 0..NODES {
                let a = Octet::splat(a[i].0[j]);
                once += self.once[j] * a;
                twice += self.twice[j] * a;
            }
            let rate = Octet::splat(v[i]);
            all[0][i] = Octet::splat(q[i]) + (elapsed * rate + wide * (wide * twice));
            all[1][i] = rate + wide * once;
        }
        all
    }

    /// Returns the columns when θ of a part of a step has passed.
    pub(super) fn at<const N: usize, const K: usize>(
        &self,
        theta: T,
        part: &Part<'_, T, N>,
        columns: &[Column<T, N>; K],
        accelerations: &[Nodes<T, N>; K],
    ) -> [Column<T, N>; K] {
        let h = part.length();
        let [once, twice] = if theta == T::from_f64(1.0) {
            [&self.once, &self.twice].map(|weights| weights.map(|weight| weight.0[NODES - 1]))
        } else {
            self.weights(theta)
        };
        let sum = |weights: &[T; NODES], a: &Octet<T>| {
            weights.iter().zip(&a.0).fold(T::from_f64(0.0), |sum, (weight, a)| sum + *weight * *a)
        };
        core::array::from_fn(|k| {
            let ([q, v], a) = (&columns[k], &accelerations[k]);
            [
                core::array::from_fn(|i| q[i] + theta * h * v[i] + h * h * sum(&twice, &a[i])),
                core::array::from_fn(|i| v[i] + h * sum(&once, &a[i])),
            ]
        })
    }
}

/// One of several parts of equal length of a step.
pub(super) struct Part<'a, T, const N: usize> {
    pub(super) step: &'a DenseStep<'a, T, N>,
    pub(super) index: usize,
    pub(super) parts: usize,
}

impl<T: Float, const N: usize> Part<'_, T, N> {
    /// Returns the length in seconds.
    pub(super) fn length(&self) -> T {
        self.step.interval.length::<T>() / T::from_f64(self.parts as f64)
    }

    /// Returns the fraction of the step that has passed when θ of the part has.
    pub(super) fn of_step(&self, theta: T) -> T {
        (T::from_f64(self.index as f64) + theta) / T::from_f64(self.parts as f64)
    }

    /// Returns the fraction of the part that has passed at `t`.
    pub(super) fn fraction(&self, t: f64) -> T {
        let passed = self.step.interval.fraction::<T>(t);
        passed * T::from_f64(self.parts as f64) - T::from_f64(self.index as f64)
    }

    /// Returns `true` if the part does not end before `t`.
    pub(super) fn contains(&self, t: f64) -> bool {
        self.fraction(t) <= T::from_f64(1.0)
    }

    /// Returns the coordinates and the velocities at the nodes.
    #[inline(always)]
    pub(super) fn at_nodes(&self, rule: &Rule<T>) -> [Nodes<T, N>; 2]
    where
        T: Float,
    {
        if self.parts == 1 {
            return self.step.at_known(&rule.functions);
        }
        let mut all = [[Octet::splat(T::from_f64(0.0)); N]; 2];
        for (node, theta) in rule.nodes.0.into_iter().enumerate() {
            let (q, v) = self.step.at(self.of_step(theta));
            for i in 0..N {
                (all[0][i].0[node], all[1][i].0[node]) = (q[i], v[i]);
            }
        }
        all
    }
}

/// The number of Legendre's polynomials that the integrals need.
const MOST: usize = NODES + 2;

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
