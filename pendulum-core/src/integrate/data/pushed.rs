//! Accelerations and multipliers at states with limits in contact and dry frictions.

use crate::integrate::field::contacts::Contacts;
use crate::integrate::field::grasp::has_frictions;
use crate::integrate::field::phase::{Phase, has_states};
use crate::integrate::field::response::product;
use crate::scalar::Float;
use crate::system::{
    Dynamics, MOST_FRICTIONS as F, MOST_LIMITS as L, Purpose, System, is_constrained,
};

/// The motion at a state, with the forces of the limits in contact and of the frictions.
pub(super) struct Pushed<T, const N: usize> {
    /// The accelerations q̈.
    pub(super) accelerations: [T; N],
    /// The multipliers λ of the constraints.
    pub(super) multipliers: [T; N],
    /// The multipliers μ of the limits, zero for limits out of contact.
    pub(super) forces: [T; L],
    /// The forces φ of the dry frictions.
    pub(super) frictions: [T; F],
    /// The generalized forces Aᵀφ.
    rubbing: [T; N],
    /// The part of the multipliers λ that is due to the contacts and frictions.
    change: [T; N],
}

impl<T: Float, const N: usize> Pushed<T, N> {
    /// Solves M q̈ = f + Cᵀλ + Nᵀμ + Aᵀφ, where C q̈ = γ, and ḧ = 0 for the limits in contact.
    ///
    /// The forces μ and φ change the multipliers λ by Δλ = −(C M⁻¹Cᵀ)⁻¹ C M⁻¹(Nᵀμ + Aᵀφ).
    pub(super) fn new<D: Dynamics<N, Scalar = T>>(
        phase: &Phase<'_, D, N>,
        contacts: &Contacts,
    ) -> Self {
        let Phase { dynamics, t, side, q, v } = *phase;
        let (zero, system) = (T::from_f64(0.0), dynamics.system());
        let prepared = system.prepare();
        let free = dynamics.accelerations_with(&prepared, t, side, q, v);
        let multipliers = system.reactions(phase.at(&phase.inputs(Purpose::Accelerations)));
        let mut own = Self {
            accelerations: free,
            multipliers,
            forces: [zero; L],
            frictions: [zero; F],
            rubbing: [zero; N],
            change: [zero; N],
        };
        if !contacts.any() {
            return own;
        }
        let mut push = phase.push(&free, contacts, false);
        if push.multipliers.iter().any(|force| *force < zero) {
            // The forces of contacts whose gradients depend on each other are not unique; those
            // that push count.
            let other = phase.push(&free, contacts, true);
            if (0..L).all(|i| !contacts.has(i) || other.gaps[i] <= other.noise[i]) {
                push.multipliers = other.multipliers;
            }
        }
        if const { has_frictions::<D, N>() } {
            let grasp = phase.grasp_with(&free, contacts);
            own.frictions = phase.rubbed(&grasp, &free, contacts, &push).forces;
            own.rubbing = grasp.force(&own.frictions);
        }
        if const { is_constrained::<D, N>() } {
            let normals = phase.normals();
            own.change = phase.answer(&core::array::from_fn(|j| {
                (0..L).fold(own.rubbing[j], |sum, i| sum + normals[(i, j)] * push.multipliers[i])
            }));
        }
        (own.accelerations, own.forces) = (push.accelerations, push.multipliers);
        if const { has_states::<D, N>() } {
            own.accelerations = phase.with_rates(&own.accelerations)[1];
        }
        own.multipliers = core::array::from_fn(|k| multipliers[k] + own.change[k]);
        own
    }

    /// Returns the part of dE/dt that is due to contacts and frictions: −μ·∂h/∂t − Δλ·b + φ·A q̇,
    /// where b is the rate of the constraints at q̇ = 0.
    pub(super) fn power<D: Dynamics<N, Scalar = T>>(&self, phase: &Phase<'_, D, N>) -> T {
        let rest = Phase { v: &[T::from_f64(0.0); N], ..*phase };
        let [_, limits, _] = rest.gaps();
        let (system, inputs) = (rest.dynamics.system(), rest.momentum_inputs());
        let [_, constraints] = system.misfits(rest.at(&inputs));
        let pushed = -(product(&self.forces, &limits) + product(&self.change, &constraints));
        if const { has_frictions::<D, N>() } {
            return pushed + product(&self.rubbing, phase.v);
        }
        pushed
    }
}
