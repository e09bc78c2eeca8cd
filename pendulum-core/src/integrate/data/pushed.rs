//! Accelerations and multipliers at states with limits in contact.

use crate::integrate::field::contacts::{self, Contacts};
use crate::integrate::field::response::{product, solved};
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::{Dynamics, MOST_LIMITS as L, Purpose, System, scalar_time};
use crate::time::Time;
use nalgebra::SMatrix;

/// The motion at a state, with the forces of the limits in contact.
pub(super) struct Pushed<T, const N: usize> {
    /// The accelerations q̈.
    pub(super) accelerations: [T; N],
    /// The multipliers λ of the constraints.
    pub(super) multipliers: [T; N],
    /// The multipliers μ of the limits, zero for limits out of contact.
    pub(super) forces: [T; L],
    /// The part of the multipliers λ that is due to the contacts.
    change: [T; N],
}

impl<T: Float, const N: usize> Pushed<T, N> {
    /// Solves M q̈ = f + Cᵀλ + Nᵀμ, where C q̈ = γ, and ḧ = 0 for the limits in contact.
    ///
    /// The multipliers μ change the multipliers λ by Δλ = −(C M⁻¹Cᵀ)⁻¹ C M⁻¹Nᵀμ.
    pub(super) fn new<D: Dynamics<N, Scalar = T>>(
        dynamics: &D,
        t: Time,
        side: Side,
        q: &[T; N],
        v: &[T; N],
        contacts: &Contacts,
    ) -> Self {
        let (zero, system, time) = (T::from_f64(0.0), dynamics.system(), scalar_time::<T>(t));
        let prepared = system.prepare();
        let free = dynamics.accelerations_with(&prepared, t, side, q, v);
        let inputs = dynamics.inputs_with(t, side, Purpose::Accelerations, q, v);
        let multipliers = system.reactions(time, q, v, &inputs);
        let none = Self { accelerations: free, multipliers, forces: [zero; L], change: [zero; N] };
        if !contacts.any() {
            return none;
        }
        let mut push = contacts::pushed(dynamics, t, side, q, v, &free, contacts);
        if push.multipliers.iter().any(|force| *force < zero) {
            // The forces of contacts whose gradients depend on each other are not unique; those
            // that push count.
            let other = contacts::supported(dynamics, t, side, q, v, &free, contacts);
            if (0..L).all(|i| !contacts.has(i) || other.gaps[i] <= other.noise[i]) {
                push.multipliers = other.multipliers;
            }
        }
        let held = <D::System as System<N>>::FACTS.held_constraints();
        let mut change = [zero; N];
        if 0 < held {
            let inputs = dynamics.inputs(t, side, Purpose::Momenta);
            let masses = system.mass_matrix(time, q, v, &inputs);
            let gradients = system.constraint_jacobian(time, q, v, &inputs);
            let row = |k: usize| -> [T; N] { core::array::from_fn(|j| gradients[(k, j)]) };
            let mut matrix = SMatrix::<T, N, N>::from_element(zero);
            for k in 0..N {
                if held <= k {
                    matrix[(k, k)] = T::from_f64(1.0);
                    continue;
                }
                let response = solved(masses, row(k));
                for i in 0..held {
                    matrix[(i, k)] = product(&row(i), &response);
                }
            }
            let normals = contacts::normals(dynamics, t, side, q, v);
            let force: [T; N] = core::array::from_fn(|j| {
                (0..L).fold(zero, |sum, i| sum + normals[(i, j)] * push.multipliers[i])
            });
            let response = solved(masses, force);
            let target =
                core::array::from_fn(
                    |k| {
                        if k < held { -product(&row(k), &response) } else { zero }
                    },
                );
            change = solved(matrix, target);
        }
        Self {
            accelerations: push.accelerations,
            multipliers: core::array::from_fn(|k| multipliers[k] + change[k]),
            forces: push.multipliers,
            change,
        }
    }

    /// Returns the part of dE/dt that is due to the contacts: −μ·∂h/∂t − Δλ·b, where b is the rate
    /// of the constraints at q̇ = 0.
    pub(super) fn power<D: Dynamics<N, Scalar = T>>(
        &self,
        dynamics: &D,
        t: Time,
        side: Side,
        q: &[T; N],
    ) -> T {
        let (zero, time) = (T::from_f64(0.0), scalar_time::<T>(t));
        let rest = [zero; N];
        let [_, limits, _] = contacts::gaps(dynamics, t, side, q, &rest);
        let inputs = dynamics.inputs(t, side, Purpose::Momenta);
        let [_, constraints] = dynamics.system().misfits(time, q, &rest, &inputs);
        -(product(&self.forces, &limits) + product(&self.change, &constraints))
    }
}
