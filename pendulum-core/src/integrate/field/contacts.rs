//! Limits in contact: their forces, and the corrections that keep a state on the limits.
//!
//! The accelerations are q̈ = q̈₀ + K Nᵀμ, with the accelerations q̈₀ without contacts, the
//! gradients N = ∂h/∂q of the gaps h of the limits in contact, and the response K = M⁻¹ − M⁻¹Cᵀ(C
//! M⁻¹Cᵀ)⁻¹C M⁻¹ to forces. The multipliers μ solve N K Nᵀ μ = −ḧ(q̈₀). The number of contacts is
//! small, so that dense elimination at run time is sufficient.
//!
//! Which limits stay in contact is a complementarity problem: μ ≥ 0, ḧ ≥ 0, and one of the two is
//! zero.

use crate::integrate::field::complementarity::{MOST, complementary};
use crate::integrate::field::grasp::{Grasp, Grip, has_frictions};
use crate::integrate::field::phase::{Phase, has_states};
use crate::integrate::field::response::{product, solved, solved_where};
use crate::scalar::{Float, Real};
use crate::system::{
    Dynamics, MOST_FRICTIONS as F, MOST_LIMITS as L, Purpose, System, is_constrained,
};
use nalgebra::SMatrix;

/// The rounding errors of a gap, or of the rate of a friction, below which it counts as zero.
pub(crate) const CLOSED: f64 = 64.0;

/// Returns the number of limits of the dynamics `D`.
pub(crate) const fn limits<D: Dynamics<N>, const N: usize>() -> usize {
    <D::System as System<N>>::FACTS.limits.len()
}

/// Returns `true` if a system has limits or dry frictions: forces that contacts begin and end.
#[inline]
pub(crate) const fn has_contacts<D: Dynamics<N>, const N: usize>() -> bool {
    0 < limits::<D, N>() || has_frictions::<D, N>()
}

/// The limits in contact, and the modes of the dry frictions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Contacts {
    on: [bool; L],
    pub(crate) grips: [Grip; F],
    any: bool,
}

impl Contacts {
    pub(crate) const NONE: Self = Self { on: [false; L], grips: [Grip::Absent; F], any: false };

    pub(crate) fn new(on: [bool; L], grips: [Grip; F]) -> Self {
        Self { any: on.contains(&true) || grips[0] != Grip::Absent, on, grips }
    }

    /// Returns the frictions alone.
    pub(crate) fn open(&self) -> Self {
        Self::new([false; L], self.grips)
    }

    /// Returns the limits with other modes of the frictions.
    pub(crate) fn with(&self, grips: [Grip; F]) -> Self {
        Self::new(self.on, grips)
    }

    /// Returns `true` if at least one limit is in contact, or if there are frictions.
    #[inline]
    pub(crate) fn any(&self) -> bool {
        self.any
    }

    /// Returns `true` if a limit is in contact or a friction sticks.
    #[inline]
    pub(crate) fn hold(&self) -> bool {
        self.any && (self.touching() > 0 || self.sticks())
    }

    /// Returns `true` if a friction sticks.
    #[inline]
    pub(crate) fn sticks(&self) -> bool {
        self.grips.contains(&Grip::Sticks)
    }

    /// Returns the number of limits in contact.
    pub(crate) fn touching(&self) -> usize {
        self.on.iter().filter(|on| **on).count()
    }

    pub(crate) fn has(&self, limit: usize) -> bool {
        self.on[limit]
    }

    /// Returns the mode of a friction.
    pub(crate) fn grip(&self, friction: usize) -> Grip {
        self.grips[friction]
    }

    /// Returns a word with one bit per limit, followed by two bits per friction.
    pub(crate) fn bits(&self) -> u64 {
        let limits = (0..L).fold(0, |bits, limit| bits | u64::from(self.on[limit]) << limit);
        (0..F).fold(limits, |bits, k| bits | (self.grips[k] as u64) << (L + 2 * k))
    }

    /// Creates the set of the limits whose bits are set, with the modes of the frictions.
    pub(crate) fn from_bits(bits: u64) -> Self {
        let grip = |k: usize| Grip::ALL[(bits >> (L + 2 * k) & 3) as usize];
        Self::new(core::array::from_fn(|limit| bits >> limit & 1 == 1), core::array::from_fn(grip))
    }

    /// Adds a limit to the contacts, or removes it.
    pub(crate) fn set(&mut self, limit: usize, on: bool) {
        self.on[limit] = on;
        *self = Self::new(self.on, self.grips);
    }
}

/// Returns a row of the gradients.
pub(crate) fn row<T: Float, const R: usize, const N: usize>(
    matrix: &SMatrix<T, R, N>,
    index: usize,
) -> [T; N] {
    core::array::from_fn(|j| matrix[(index, j)])
}

/// The effect of limits in contact on the accelerations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Push<T, const N: usize> {
    /// The accelerations with the contacts.
    pub(crate) accelerations: [T; N],
    /// The multipliers μ, positive for forces that push.
    pub(crate) multipliers: [T; L],
    /// The accelerations ḧ of all gaps with the contacts.
    pub(crate) gaps: [T; L],
    /// The rounding errors of `gaps`; too small with constraints if no contact may open.
    pub(crate) noise: [T; L],
}

/// The responses K nᵢ of the limits in contact, and their matrix N K Nᵀ.
struct Responses<T, const N: usize> {
    changes: [[T; N]; L],
    matrix: SMatrix<T, L, L>,
}

impl<T: Float, const N: usize> Responses<T, N> {
    fn new<D: Dynamics<N, Scalar = T>>(
        phase: &Phase<'_, D, N>,
        normals: &SMatrix<T, L, N>,
        contacts: &Contacts,
        rub: impl Fn(usize, [T; N]) -> [T; N],
    ) -> Self {
        let zero = T::from_f64(0.0);
        let mut changes = [[zero; N]; L];
        let mut matrix = SMatrix::from_element(zero);
        for i in (0..limits::<D, N>()).filter(|i| contacts.has(*i)) {
            changes[i] = rub(i, phase.response(&row(normals, i)));
        }
        for i in 0..L {
            for j in 0..L {
                if contacts.has(i) && contacts.has(j) {
                    matrix[(i, j)] = product(&row(normals, i), &changes[j]);
                }
            }
        }
        Self { changes, matrix }
    }

    /// Returns the multipliers that change the rates of the contacts by `target`. The multiplier of
    /// a contact that depends on earlier contacts is zero.
    fn multipliers(&self, contacts: &Contacts, target: &[T; L]) -> [T; L] {
        solved_where(self.matrix, *target, |i, pivot| {
            contacts.has(i) && T::EPSILON.sqrt() * self.matrix[(i, i)] < pivot
        })
    }

    /// Returns the least multipliers μ ≥ 0 that keep every contact whose rate is `rates` without
    /// them from closing: the rates w afterwards are at least −`noise`, and zero where μ > 0.
    ///
    /// These multipliers minimize the change in the metric of the mass matrix (Gauss's principle
    /// for accelerations, Moreau's plastic impact for velocities), so that the change is unique
    /// even if the multipliers are not. The dual method of D. Goldfarb and A. Idnani, Mathematical
    /// Programming 27 (1983) 1, adds one closing contact after the other and drops those that
    /// would pull; it needs no independent gradients. A contact that cannot be kept from closing,
    /// between limits that approach each other, keeps what the others leave it.
    fn pushing(&self, contacts: &Contacts, rates: &[T; L], noise: &[T; L]) -> [T; L] {
        let zero = T::from_f64(0.0);
        let mut multipliers = [zero; L];
        let (mut active, mut hopeless) = (Contacts::NONE, Contacts::NONE);
        // Far more rounds than the method takes; they end a cycle of rounding errors.
        for _ in 0..4 * L {
            let after = self.after(rates, &multipliers);
            let mut worst: Option<(usize, T)> = None;
            for i in (0..L).filter(|i| contacts.has(*i) && !active.has(*i) && !hopeless.has(*i)) {
                let closing = after[i] / self.matrix[(i, i)].sqrt();
                if after[i] < -noise[i] && worst.is_none_or(|(_, least)| closing < least) {
                    worst = Some((i, closing));
                }
            }
            let Some((added, _)) = worst else { break };
            loop {
                let after = self.after(rates, &multipliers)[added];
                let column = core::array::from_fn(|i| self.matrix[(i, added)]);
                let share = self.multipliers(&active, &column);
                let rest = (0..L).fold(column[added], |rest, i| rest - column[i] * share[i]);
                let independent = T::EPSILON.sqrt() * column[added] < rest;
                let mut step = independent.then(|| -after / rest);
                let mut dropped = None;
                for i in (0..L).filter(|i| active.has(*i) && zero < share[*i]) {
                    let most = multipliers[i] / share[i];
                    if step.is_none_or(|step| most < step) {
                        (step, dropped) = (Some(most), Some(i));
                    }
                }
                let Some(step) = step else {
                    hopeless.set(added, true);
                    break;
                };
                for i in 0..L {
                    let part = step * share[i];
                    multipliers[i] -= part;
                }
                multipliers[added] += step;
                let Some(dropped) = dropped else {
                    active.set(added, true);
                    break;
                };
                multipliers[dropped] = zero;
                active.set(dropped, false);
            }
        }
        multipliers.map(|multiplier| if multiplier < zero { zero } else { multiplier })
    }

    /// Returns the multipliers μ ≥ 0 after which no contact closes with the rates w, and which are
    /// zero where w > 0, for a matrix that need not be symmetric.
    fn balancing(&self, contacts: &Contacts, rates: &[T; L]) -> Option<[T; L]> {
        let zero = T::from_f64(0.0);
        let (mut matrix, mut q) = ([[zero; MOST]; MOST], [zero; MOST]);
        let unit = |i: usize| if contacts.has(i) { self.matrix[(i, i)].abs().sqrt() } else { zero };
        for i in (0..L).filter(|i| contacts.has(*i)) {
            for j in (0..L).filter(|j| contacts.has(*j)) {
                matrix[i][j] = self.matrix[(i, j)] / (unit(i) * unit(j));
            }
            q[i] = rates[i] / unit(i);
        }
        let [_, multipliers] = complementary(L, &matrix, &q)?;
        Some(core::array::from_fn(
            |i| {
                if contacts.has(i) { multipliers[i] / unit(i) } else { zero }
            },
        ))
    }

    /// Returns the rates after a change by `multipliers`.
    fn after(&self, rates: &[T; L], multipliers: &[T; L]) -> [T; L] {
        core::array::from_fn(|i| {
            (0..L).fold(rates[i], |sum, j| sum + self.matrix[(i, j)] * multipliers[j])
        })
    }

    /// Returns K Nᵀμ.
    fn change(&self, multipliers: &[T; L]) -> [T; N] {
        core::array::from_fn(|j| {
            (0..L).fold(T::from_f64(0.0), |sum, i| sum + self.changes[i][j] * multipliers[i])
        })
    }
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Phase<'_, D, N> {
    /// Returns the gaps h, their rates, and their second rates at q̈ = 0.
    pub(crate) fn gaps(&self) -> [[D::Scalar; L]; 3] {
        let inputs = self.inputs(Purpose::Accelerations);
        self.dynamics.system().gaps(self.at(&inputs))
    }

    /// Returns the gradients of the gaps, one per row.
    pub(crate) fn normals(&self) -> SMatrix<D::Scalar, L, N> {
        let inputs = self.momentum_inputs();
        self.dynamics.system().gap_jacobian(self.at(&inputs))
    }

    /// Computes the accelerations with contacts, from the accelerations `free` without contacts.
    ///
    /// All contacts are held, or, if they `may_open`, only those that push: contacts that would
    /// pull open.
    pub(crate) fn push(
        &self,
        free: &[D::Scalar; N],
        contacts: &Contacts,
        may_open: bool,
    ) -> Push<D::Scalar, N> {
        if const { has_frictions::<D, N>() } {
            let grasp = self.grasp_with(free, contacts);
            return self.push_with(Some(&grasp), free, contacts, may_open);
        }
        self.push_with(None, free, contacts, may_open)
    }

    /// Returns the accelerations alone, with all contacts held.
    pub(crate) fn pushed(&self, free: &[D::Scalar; N], contacts: &Contacts) -> [D::Scalar; N] {
        let a = self.pushed_alone(free, contacts);
        // Rates of states depend on the velocities that contacts change.
        if const { has_states::<D, N>() } { self.with_rates(&a)[1] } else { a }
    }

    /// Returns the same accelerations, with those `free` of contacts in the places of states.
    #[inline]
    fn pushed_alone(&self, free: &[D::Scalar; N], contacts: &Contacts) -> [D::Scalar; N] {
        if const { limits::<D, N>() == 0 && has_frictions::<D, N>() } {
            if !contacts.sticks() {
                return self.slide(contacts, free);
            }
            let grasp = self.grasp_with(free, contacts);
            return grasp.hold(contacts, &grasp.slide(contacts, free));
        }
        self.push(free, contacts, false).accelerations
    }

    /// Computes the same with the dry frictions of the system, if it has any.
    pub(crate) fn push_with(
        &self,
        grasp: Option<&Grasp<D::Scalar, N>>,
        free: &[D::Scalar; N],
        contacts: &Contacts,
        may_open: bool,
    ) -> Push<D::Scalar, N> {
        let number = D::Scalar::from_f64;
        let none = [number(0.0); L];
        let held = grasp.map(|grasp| grasp.hold(contacts, &grasp.slide(contacts, free)));
        if const { limits::<D, N>() == 0 } {
            let accelerations = held.unwrap_or(*free);
            return Push { accelerations, multipliers: none, gaps: none, noise: none };
        }
        let own = free;
        let free = held.as_ref().unwrap_or(own);
        let ([_, _, rates], normals) = (self.gaps(), self.normals());
        let along = |a: &[D::Scalar; N]| -> [D::Scalar; L] {
            core::array::from_fn(|i| rates[i] + product(&row(&normals, i), a))
        };
        let zero = [number(0.0); N];
        let mut bound = if may_open { self.bound() } else { zero };
        if const { has_frictions::<D, N>() } {
            // The forces of frictions that stick leave only the rounding errors of others.
            for j in 0..N {
                bound[j] += own[j].abs() + (free[j] - own[j]).abs();
            }
        }
        let noise = |change: &[D::Scalar; N]| -> [D::Scalar; L] {
            core::array::from_fn(|i| {
                let sizes = (0..N).fold(rates[i].abs(), |sum, j| {
                    sum + normals[(i, j)].abs() * (free[j].abs() + bound[j] + change[j].abs())
                });
                number(64.0) * D::Scalar::EPSILON * sizes
            })
        };
        let responses = Responses::new(self, &normals, contacts, |i, change| match grasp {
            Some(grasp) => grasp.keep(contacts, &grasp.drag(contacts, i, &change)),
            None => change,
        });
        let without = along(free);
        let mut multipliers = responses.multipliers(contacts, &without.map(|rate| -rate));
        let mut change = responses.change(&multipliers);
        if may_open {
            let pushing = || responses.pushing(contacts, &without, &noise(&change));
            multipliers = if const { has_frictions::<D, N>() } {
                responses.balancing(contacts, &without).unwrap_or_else(pushing)
            } else {
                pushing()
            };
            change = responses.change(&multipliers);
        }
        let accelerations = core::array::from_fn(|i| free[i] + change[i]);
        Push { accelerations, multipliers, gaps: along(&accelerations), noise: noise(&change) }
    }

    /// Returns the sizes of the accelerations by the forces of the constraints. At rest, these and the
    /// other forces cancel, and leave their rounding errors.
    pub(super) fn bound(&self) -> [D::Scalar; N] {
        let mut sizes = [D::Scalar::from_f64(0.0); N];
        if const { is_constrained::<D, N>() } {
            let system = self.dynamics.system();
            let forces = system.reactions(self.at(&self.inputs(Purpose::Accelerations)));
            let inputs = self.momentum_inputs();
            let masses = system.mass_matrix(self.at(&inputs));
            let gradients = system.constraint_jacobian(self.at(&inputs));
            for k in 0..<D::System as System<N>>::FACTS.held_constraints() {
                let part = solved(masses, core::array::from_fn(|j| gradients[(k, j)]));
                for j in 0..N {
                    sizes[j] += (part[j] * forces[k]).abs();
                }
            }
        }
        sizes
    }

    /// Returns the change of the velocities by impulses of the contacts that changes the rates by
    /// `target`. The same change of the coordinates changes the gaps by `target`.
    pub(crate) fn shift(&self, contacts: &Contacts, target: &[D::Scalar; L]) -> [D::Scalar; N] {
        let responses = Responses::new(self, &self.normals(), contacts, |_, change| change);
        responses.change(&responses.multipliers(contacts, target))
    }

    /// Returns the change of the velocities as [`shift`](Self::shift) does, which also changes the
    /// rates of the frictions that stick to zero. Where a contact that frictions keep answers to no
    /// impulse, as that of a rod whose ends pass each other, their rates are zero by themselves.
    pub(crate) fn settle(&self, contacts: &Contacts, target: &[D::Scalar; L]) -> [D::Scalar; N] {
        let grasp = self.grasp();
        let (_, change) = grasp.shift(contacts, &grasp.rates[0]);
        if contacts.touching() == 0 {
            return change;
        }
        let keep = |_, change| grasp.keep(contacts, &change);
        let normals = self.normals();
        let dead = |i| {
            let normal = row(&normals, i);
            let change = self.response(&normal);
            let least = D::Scalar::EPSILON.sqrt() * product(&normal, &change);
            product(&normal, &grasp.keep(contacts, &change)) <= least
        };
        if (0..limits::<D, N>()).filter(|i| contacts.has(*i)).any(dead) {
            return self.shift(contacts, target);
        }
        let responses = Responses::new(self, &normals, contacts, keep);
        let rest = core::array::from_fn(|i| target[i] - product(&row(&normals, i), &change));
        let other = responses.change(&responses.multipliers(contacts, &rest));
        core::array::from_fn(|j| change[j] + other[j])
    }

    /// Returns the change of the velocities by a plastic impact of several limits that close with
    /// `rates`, and its impulses: the least change after which no limit closes by more than `noise`.
    pub(crate) fn stop(
        &self,
        contacts: &Contacts,
        rates: &[D::Scalar; L],
        noise: &[D::Scalar; L],
    ) -> ([D::Scalar; N], [D::Scalar; L]) {
        let responses = Responses::new(self, &self.normals(), contacts, |_, change| change);
        let impulses = responses.pushing(contacts, rates, noise);
        (responses.change(&impulses), impulses)
    }

    /// Returns the sizes of coordinates and velocities, whose rounding errors are one unit in the
    /// last place.
    ///
    /// A projection onto constraints gives each coordinate the rounding errors of all terms of the
    /// constraints: the height of a bar's end is rounded as the length of the bar is, even at zero.
    pub(crate) fn sizes(&self) -> [[D::Scalar; N]; 2] {
        let zero = D::Scalar::from_f64(0.0);
        let Self { q, v, .. } = *self;
        let mut sizes = [q.map(Real::abs), v.map(Real::abs)];
        if const { is_constrained::<D, N>() } {
            let (system, inputs) = (self.dynamics.system(), self.momentum_inputs());
            let scales = system.misfit_scales(self.at(&inputs));
            for (sizes, scales) in sizes.iter_mut().zip(scales) {
                for k in 0..<D::System as System<N>>::FACTS.held_constraints() {
                    let own = core::array::from_fn(|i| if i == k { scales[k] } else { zero });
                    let change = system.correction(self.at(&inputs), &own);
                    for j in 0..N {
                        // Dependent constraints have no correction.
                        if change[j].is_finite() {
                            sizes[j] += change[j].abs();
                        }
                    }
                }
            }
        }
        sizes
    }

    /// Returns the rounding errors of each gap and of its rate: the effect of one unit in the last
    /// place of every coordinate and velocity, and of the time.
    pub(crate) fn rounding(&self) -> [[D::Scalar; L]; 2] {
        let (zero, normals, sizes) = (D::Scalar::from_f64(0.0), self.normals(), self.sizes());
        let sum = |i: usize, sizes: &[D::Scalar; N]| {
            (0..N).fold(zero, |sum, j| sum + normals[(i, j)].abs() * sizes[j])
        };
        let eps = D::Scalar::EPSILON;
        let time = D::Scalar::from_f64(f64::EPSILON * self.t.to_f64().abs());
        [
            core::array::from_fn(|i| eps * sum(i, &sizes[0]) + time * sum(i, &sizes[1])),
            core::array::from_fn(|i| eps * sum(i, &sizes[1])),
        ]
    }
}
