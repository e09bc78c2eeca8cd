//! Frictions that the reactions of constraints press, as on a rough wire.
//!
//! The multipliers λ of the constraints depend on the frictions that they press. Let n be the sizes
//! of the reactions in magnitudes, |λ| or the length of several λ. While all frictions keep their
//! modes and directions, forces are affine in n, so that λ = λ₀ + D n, and n = |λ₀ + D n| line by
//! line. If the sizes of the parts of D are a matrix B whose powers vanish, the right side brings
//! any two n closer, and there is exactly one n; I − B then has positive pivots. If it holds one
//! number that is at least one, there is no n, or there are two (Painlevé 1895).

use crate::integrate::field::cone::norm;
use crate::integrate::field::contacts::{Contacts, limits};
use crate::integrate::field::grasp::Grasp;
use crate::integrate::field::phase::Phase;
use crate::integrate::field::response::{product, solved};
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, MOST_LIMITS as L, Purpose, System};
use core::ops::Range;
use nalgebra::SMatrix;

/// Far more sweeps over the sizes than they need, unless B is almost one.
const SWEEPS: usize = 1000;

/// Returns the number of reactions of constraints that press frictions of the dynamics `D`.
pub(crate) const fn loads<D: Dynamics<N>, const N: usize>() -> usize {
    <D::System as System<N>>::FACTS.loads.len()
}

/// Returns the multipliers of a load.
fn part<D: Dynamics<N>, const N: usize>(load: usize) -> Range<usize> {
    let [first, count] = <D::System as System<N>>::FACTS.loads[load];
    first..first + count
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Phase<'_, D, N> {
    /// Returns the impulses of the constraints that change their rates by `target`:
    /// (C M⁻¹Cᵀ)⁻¹ `target`.
    fn holding(&self, target: &[D::Scalar; N]) -> [D::Scalar; N] {
        let held = <D::System as System<N>>::FACTS.held_constraints();
        let (system, inputs) = (self.dynamics.system(), self.momentum_inputs());
        let masses = system.mass_matrix(self.at(&inputs));
        let gradients = system.constraint_jacobian(self.at(&inputs));
        let row = |k: usize| -> [D::Scalar; N] { core::array::from_fn(|j| gradients[(k, j)]) };
        let mut matrix = SMatrix::<D::Scalar, N, N>::from_element(D::Scalar::from_f64(0.0));
        for k in 0..N {
            if held <= k {
                matrix[(k, k)] = D::Scalar::from_f64(1.0);
                continue;
            }
            let response = solved(masses, row(k));
            for i in 0..held {
                matrix[(i, k)] = product(&row(i), &response);
            }
        }
        solved(matrix, *target)
    }

    /// Returns the change of the multipliers by generalized forces: −(C M⁻¹Cᵀ)⁻¹ C M⁻¹ `force`.
    pub(crate) fn answer(&self, force: &[D::Scalar; N]) -> [D::Scalar; N] {
        let (system, inputs) = (self.dynamics.system(), self.momentum_inputs());
        let at = self.at(&inputs);
        let rates = system.constraint_rates(at, &solved(system.mass_matrix(at), *force));
        self.holding(&rates.map(|rate| -rate))
    }

    /// Adds the parts of the loads to the magnitudes of the frictions. Returns a friction if it
    /// presses its own constraint so that no sizes of the loads fit, or several do.
    pub(super) fn load(
        &self,
        grasp: &mut Grasp<D::Scalar, N>,
        free: &[D::Scalar; N],
        contacts: &Contacts,
    ) -> Option<usize> {
        let (zero, one) = (D::Scalar::from_f64(0.0), D::Scalar::from_f64(1.0));
        let (count, behind) = (const { loads::<D, N>() }, const { limits::<D, N>() });
        let own = grasp.magnitudes;
        let set = |grasp: &mut Grasp<D::Scalar, N>, sizes: &[D::Scalar; L]| {
            for (part, own) in own.iter().enumerate() {
                grasp.magnitudes[part] = grasp.each(|k| {
                    (0..count)
                        .fold(own[k], |sum, m| sum + grasp.share(part, k, behind + m) * sizes[m])
                });
            }
        };
        let inputs = self.inputs(Purpose::Accelerations);
        let reactions = self.dynamics.system().reactions(self.at(&inputs));
        let normals = self.normals();
        let multipliers = |grasp: &Grasp<D::Scalar, N>| -> [D::Scalar; N] {
            let push = self.push_with(Some(grasp), free, contacts, false);
            let rubbing = grasp.force(&self.rubbed(grasp, free, contacts, &push).forces);
            let change = self.answer(&core::array::from_fn(|j| {
                (0..L).fold(rubbing[j], |sum, i| sum + normals[(i, j)] * push.multipliers[i])
            }));
            core::array::from_fn(|k| reactions[k] + change[k])
        };
        let base = multipliers(grasp);
        let size = |all: &[D::Scalar; N], m: usize| norm(&all[part::<D, N>(m)]);
        let most = (0..count).fold(zero, |most, m| most.max(size(&base, m)));
        let scale = if zero < most { most } else { one };
        let mut columns = [[zero; N]; L];
        for m in 0..count {
            set(grasp, &core::array::from_fn(|n| if n == m { scale } else { zero }));
            let with = multipliers(grasp);
            columns[m] = core::array::from_fn(|k| (with[k] - base[k]) / scale);
        }
        // Sizes are in units of `scale`, so that their squares neither overflow nor vanish.
        let mut sizes = [zero; L];
        (0..count).for_each(|m| sizes[m] = size(&base, m) / scale);
        let mut matrix = [[zero; L]; L];
        for m in 0..count {
            for n in 0..count {
                matrix[m][n] = size(&columns[n], m);
            }
        }
        let shared = |m: usize| {
            (0..grasp.facts.len()).find(|k| zero < grasp.share(0, *k, behind + m)).unwrap_or(0)
        };
        let mut jam = unbounded(count, &matrix).map(shared);
        for sweep in 0..SWEEPS {
            if jam.is_some() {
                break;
            }
            let before = sizes;
            for m in 0..count {
                // |c + d n| = n.
                let (mut along, mut square, mut slope) = (zero, zero, zero);
                for k in part::<D, N>(m) {
                    let d = columns[m][k];
                    let others = (0..count).filter(|n| *n != m);
                    let c = others.fold(base[k] / scale, |sum, n| sum + columns[n][k] * sizes[n]);
                    (along, square, slope) = (along + c * d, square + c * c, slope + d * d);
                }
                let root = (along * along + square * (one - slope)).sqrt();
                sizes[m] = if along < zero {
                    square / (root - along)
                } else {
                    (along + root) / (one - slope)
                };
            }
            let moved = |m: usize| {
                D::Scalar::from_f64(4.0) * D::Scalar::EPSILON * sizes[m]
                    < (sizes[m] - before[m]).abs()
            };
            match (0..count).find(|m| moved(*m)) {
                None => break,
                Some(m) if sweep + 1 == SWEEPS => jam = Some(shared(m)),
                Some(_) => {}
            }
        }
        set(grasp, &sizes.map(|size| scale * size));
        jam
    }

    /// Returns a friction that is pressed by the impulses of the constraints that bring their rates
    /// along `change`, with `offset`, to zero.
    pub(crate) fn knocked(
        &self,
        change: &[D::Scalar; N],
        offset: impl Fn(usize) -> D::Scalar,
    ) -> Option<usize> {
        let (zero, least) = (D::Scalar::from_f64(0.0), D::Scalar::EPSILON.sqrt());
        let inputs = self.momentum_inputs();
        let rows = self.dynamics.system().constraint_jacobian(self.at(&inputs));
        let mut target = [zero; N];
        for k in 0..<D::System as System<N>>::FACTS.held_constraints() {
            let size =
                (0..N).fold(offset(k).abs(), |sum, j| sum + (rows[(k, j)] * change[j]).abs());
            let rate = (0..N).fold(offset(k), |sum, j| sum + rows[(k, j)] * change[j]);
            target[k] = if least * size < rate.abs() { rate } else { zero };
        }
        let impulses = self.holding(&target);
        let most = impulses.iter().fold(zero, |most, own| most.max(own.abs()));
        let (grasp, behind) = (self.grasp(), const { limits::<D, N>() });
        let pressed = |k: usize, m: usize| {
            least * most < norm(&impulses[part::<D, N>(m)]) && grasp.is_shared(k, behind + m)
        };
        (0..grasp.facts.len()).find(|k| (0..const { loads::<D, N>() }).any(|m| pressed(*k, m)))
    }
}

/// Returns the first line in which the elimination of I − B has no positive pivot: the powers of B,
/// whose entries are not negative, do not vanish.
fn unbounded<T: Float>(count: usize, matrix: &[[T; L]; L]) -> Option<usize> {
    let (one, least) = (T::from_f64(1.0), T::EPSILON.sqrt());
    let mut rest = *matrix;
    for j in 0..count {
        let pivot = one - rest[j][j];
        if pivot <= least || !pivot.is_finite() {
            return Some(j);
        }
        for i in j + 1..count {
            let factor = rest[i][j] / pivot;
            for k in j + 1..count {
                let part = factor * rest[j][k];
                rest[i][k] += part;
            }
        }
    }
    None
}
