//! The equations of one step, and two iterations that solve them.

use super::tableau::Tableau;
use crate::integrate::field::{Field, InputsOf};
use crate::integrate::linear::{Factors, Square, times};
use crate::integrate::state::compensated::Compensated;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, Jacobians};
use crate::time::Time;

/// The slopes q̇ and ṗ at the stages.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slopes<T, const N: usize, const S: usize> {
    /// The velocities.
    pub(super) v: [[T; N]; S],
    /// The rates of the momenta.
    pub(super) f: [[T; N]; S],
}

impl<T: Float, const N: usize, const S: usize> Slopes<T, N, S> {
    pub(super) fn zero() -> Self {
        let zero = [[T::from_f64(0.0); N]; S];
        Self { v: zero, f: zero }
    }

    /// Returns the values, one step later, of the polynomials through the slopes.
    pub(super) fn ahead(&self, weights: &[[f64; S]; S]) -> Self {
        let extrapolated = |slopes: &[[T; N]; S]| {
            weights.map(|row| combined([T::from_f64(0.0); N], slopes, &row.map(T::from_f64)))
        };
        Self { v: extrapolated(&self.v), f: extrapolated(&self.f) }
    }
}

/// The change of the slopes by one iteration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change {
    /// The largest change of a slope, times h, relative to its coordinate or momentum.
    pub(super) size: f64,
    /// The largest such change among the velocities.
    pub(super) shift: f64,
    /// The stage and the coordinate of the largest change.
    pub(super) place: (usize, usize),
}

/// The equations of one step.
#[derive(Debug)]
pub(super) struct Equations<D: Dynamics<N>, const N: usize, const S: usize> {
    h: D::Scalar,
    /// h b.
    weights: [D::Scalar; S],
    ratios: [[D::Scalar; S]; S],
    times: [Time; S],
    inputs: [InputsOf<D, N>; S],
    q: Compensated<D::Scalar, N>,
    p: Compensated<D::Scalar, N>,
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize, const S: usize> Equations<D, N, S> {
    /// Creates the equations of `interval`, which starts at the coordinates `q` and the momenta
    /// `p`.
    pub(super) fn new<const W: bool>(
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        q: Compensated<D::Scalar, N>,
        p: Compensated<D::Scalar, N>,
    ) -> Self {
        let tableau = const { &Tableau::<S>::GAUSS };
        let stages = tableau.nodes.map(|c| interval.at(c));
        Self {
            h: interval.length(),
            weights: tableau.weights.map(|b| Real::from_f64(b * interval.h)),
            ratios: tableau.ratios.map(|row| row.map(Real::from_f64)),
            times: stages.map(|(t, _)| t),
            inputs: stages.map(|(t, side)| field.inputs(t, side)),
            q,
            p,
        }
    }

    /// Returns the time of a stage.
    pub(super) fn time(&self, stage: usize) -> Time {
        self.times[stage]
    }

    /// Returns h Σ b V and h Σ b F.
    pub(super) fn increments(
        &self,
        slopes: &Slopes<D::Scalar, N, S>,
    ) -> ([D::Scalar; N], [D::Scalar; N]) {
        let zero = [D::Scalar::from_f64(0.0); N];
        (combined(zero, &slopes.v, &self.weights), combined(zero, &slopes.f, &self.weights))
    }

    /// Computes momenta from forces, velocities from momenta, coordinates from velocities, and
    /// forces from coordinates and velocities.
    ///
    /// With a constant mass matrix the two halves of a sweep contract like (h·ω)²; a sweep that
    /// evaluated everything at the old slopes would contract like h·ω.
    // Not inlined: in the loop over sweeps, eight stages would run out of registers.
    #[inline(never)]
    pub(super) fn sweep<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        old: &Slopes<D::Scalar, N, S>,
        slopes: &mut Slopes<D::Scalar, N, S>,
    ) -> Change {
        let (dq, dp) = (self.scaled(&old.v), self.scaled(&old.f));
        for i in 0..S {
            let (q, p) = (self.stage(&self.q, &dq, i), self.stage(&self.p, &dp, i));
            slopes.v[i] = field.velocities(self.times[i], &q, &p, &self.inputs[i]);
        }
        let dq = self.scaled(&slopes.v);
        for i in 0..S {
            let q = self.stage(&self.q, &dq, i);
            slopes.f[i] = field.momentum_rates(self.times[i], &q, &slopes.v[i], &self.inputs[i]);
        }
        self.change(old, slopes)
    }

    /// Takes one step of Newton's method, with M, ∂q̈/∂q and ∂q̈/∂q̇ at the start of the step
    /// instead of the Jacobian.
    ///
    /// The linearization omits the derivatives of the velocities at fixed momenta with respect to
    /// the coordinates, and of the mass matrix with respect to time: neither is stiff, and the
    /// residuals contain both.
    pub(super) fn newton<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        linearized: &Linearized<D::Scalar, N, S>,
        old: &Slopes<D::Scalar, N, S>,
        slopes: &mut Slopes<D::Scalar, N, S>,
    ) -> Change {
        let zero = [D::Scalar::from_f64(0.0); N];
        let (mut residual, mut a) = ([zero; S], [zero; S]);
        let (dq, dp) = (self.scaled(&old.v), self.scaled(&old.f));
        for i in 0..S {
            let (q, p) = (self.stage(&self.q, &dq, i), self.stage(&self.p, &dp, i));
            let v = field.velocities(self.times[i], &q, &p, &self.inputs[i]);
            let f = field.momentum_rates(self.times[i], &q, &v, &self.inputs[i]);
            residual[i] = difference(&v, &old.v[i]);
            let mut force = [difference(&f, &old.f[i])];
            linearized.mass.solve(&mut force);
            a[i] = force[0];
        }
        // α = M⁻¹ r_F + ∂q̈/∂q h Σ a δV + ∂q̈/∂q̇ h Σ a α with δV = r_V + h Σ a α.
        for i in 0..S {
            let q = combined(zero, &residual, &self.row(i));
            let change = times(&linearized.stiffness, &q);
            a[i] = core::array::from_fn(|k| a[i][k] + change[k]);
        }
        linearized.factors.solve(&mut a);
        for i in 0..S {
            let v = combined(residual[i], &a, &self.row(i));
            let f = times(&linearized.mass_matrix, &a[i]);
            slopes.v[i] = core::array::from_fn(|k| old.v[i][k] + v[k]);
            slopes.f[i] = core::array::from_fn(|k| old.f[i][k] + f[k]);
        }
        self.change(old, slopes)
    }

    /// Returns h a_ij for one i.
    fn row(&self, i: usize) -> [D::Scalar; S] {
        core::array::from_fn(|j| self.ratios[i][j] * self.weights[j])
    }

    /// Returns h b_j slope_j for each j.
    ///
    /// The products are rounded here, where the slopes differ from step to step, so that their
    /// rounding errors average out. The products h b_j m_ij would have the same rounding errors in
    /// every step, and the method would no longer be symplectic.
    fn scaled(&self, slopes: &[[D::Scalar; N]; S]) -> [[D::Scalar; N]; S] {
        core::array::from_fn(|j| slopes[j].map(|slope| self.weights[j] * slope))
    }

    /// Returns start + Σ m_ij increment_j.
    fn stage(
        &self,
        start: &Compensated<D::Scalar, N>,
        increments: &[[D::Scalar; N]; S],
        i: usize,
    ) -> [D::Scalar; N] {
        let increment = combined(start.low, increments, &self.ratios[i]);
        core::array::from_fn(|k| start.high[k] + increment[k])
    }

    /// Returns the largest difference between two sets of slopes; its size is NaN if a slope is
    /// NaN.
    fn change(&self, old: &Slopes<D::Scalar, N, S>, new: &Slopes<D::Scalar, N, S>) -> Change {
        let mut largest = Change { size: 0.0, shift: 0.0, place: (0, 0) };
        for (start, old, new) in [(&self.p, &old.f, &new.f), (&self.q, &old.v, &new.v)] {
            largest.shift = 0.0;
            for k in 0..N {
                let mut scale = start.high[k].abs();
                for slope in new {
                    scale = scale.max((self.h * slope[k]).abs());
                }
                for i in 0..S {
                    let change = (self.h * (new[i][k] - old[i][k])).abs();
                    let size =
                        if change == Real::from_f64(0.0) { 0.0 } else { (change / scale).to_f64() };
                    if largest.shift < size {
                        largest.shift = size;
                    }
                    if largest.size < size || size.is_nan() {
                        (largest.size, largest.place) = (size, (i, k));
                    }
                }
            }
        }
        largest
    }
}

/// The linearized system of Newton's method.
#[derive(Debug)]
pub(super) struct Linearized<T, const N: usize, const S: usize> {
    mass_matrix: Square<T, N>,
    mass: Factors<T, N, 1>,
    /// ∂q̈/∂q.
    stiffness: Square<T, N>,
    /// I − h A ⊗ ∂q̈/∂q̇ − h² A² ⊗ ∂q̈/∂q.
    factors: Factors<T, N, S>,
}

impl<T: Float, const N: usize, const S: usize> Linearized<T, N, S> {
    /// Linearizes the system at the start of `interval`.
    pub(super) fn new<D: Dynamics<N, Scalar = T, System: Jacobians<N>>, const W: bool>(
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &Endpoint<T, N>,
    ) -> Self {
        let tableau = const { &Tableau::<S>::GAUSS };
        let square = |matrix: &dyn Fn(usize, usize) -> T| -> Square<T, N> {
            core::array::from_fn(|i| core::array::from_fn(|j| matrix(i, j)))
        };
        let inputs = field.inputs(from.t, interval.side());
        let mass = field.mass_matrix(from.t, &from.q.high, &from.v.high, &inputs);
        let mass_matrix = square(&|i, j| mass[(i, j)]);
        let [stiffness, damping] =
            field.jacobians(from.t, interval.side(), &from.q.high, &from.v.high);
        let a = |i: usize, j: usize| tableau.ratios[i][j] * tableau.weights[j];
        let factors = Factors::new(|i, j| {
            let first = T::from_f64(interval.h * a(i, j));
            let second = T::from_f64(
                interval.h * interval.h * (0..S).map(|k| a(i, k) * a(k, j)).sum::<f64>(),
            );
            square(&|row, column| {
                let unit = T::from_f64(if i == j && row == column { 1.0 } else { 0.0 });
                unit - first * damping[(row, column)] - second * stiffness[(row, column)]
            })
        });
        let mass = Factors::new(|_, _| mass_matrix);
        Self { mass_matrix, mass, stiffness: square(&|i, j| stiffness[(i, j)]), factors }
    }
}

/// Returns start + Σ weight · slope; the products are summed before `start` is added.
fn combined<T: Float, const N: usize, const S: usize>(
    start: [T; N],
    slopes: &[[T; N]; S],
    weights: &[T; S],
) -> [T; N] {
    core::array::from_fn(|k| {
        let sum = (1..S).fold(weights[0] * slopes[0][k], |sum, j| sum + weights[j] * slopes[j][k]);
        start[k] + sum
    })
}

fn difference<T: Float, const N: usize>(x: &[T; N], y: &[T; N]) -> [T; N] {
    core::array::from_fn(|k| x[k] - y[k])
}
