//! Dry frictions at a state, and their forces.
//!
//! A friction acts against a rate r = a q̇ + b. While it slides in the direction s = ±1, its force
//! is φ = −s F, where F grows with the forces μ of limits in contact; a vector slides in the
//! direction s = r/|r|, and its components share F. While it sticks, ṙ = 0 determines φ, as for a
//! constraint. Frictions that stick are eliminated before the contacts: each force, that of a
//! contact too, then acts through the response that keeps their rates. A contact with a friction
//! that slides acts along n − s f a, where f is the share of its force in F, so that the equations
//! of the contacts are not symmetric.

use crate::integrate::field::contacts::{Contacts, Push, limits, row};
use crate::integrate::field::load::loads;
use crate::integrate::field::phase::Phase;
use crate::integrate::field::response::{product, solved_where};
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, Friction, MOST_FRICTIONS as F, MOST_LIMITS as L, Purpose, System};
use nalgebra::SMatrix;

/// The rounds in which modes or directions, and the loads that depend on them, are found.
pub(super) const ROUNDS: usize = 32;

/// Returns the number of rates with dry friction of the dynamics `D`.
pub(crate) const fn frictions<D: Dynamics<N>, const N: usize>() -> usize {
    <D::System as System<N>>::FACTS.frictions.len()
}

/// Returns `true` if a rate is a vector: its force has the direction of the rate, which a sign for
/// each component does not give.
pub(crate) const fn has_vectors<D: Dynamics<N>, const N: usize>() -> bool {
    let (frictions, mut index) = (<D::System as System<N>>::FACTS.frictions, 0);
    while index < frictions.len() && frictions[index].components == 1 {
        index += 1;
    }
    index < frictions.len()
}

/// Returns `true` if a system has dry frictions.
#[inline]
pub(crate) const fn has_frictions<D: Dynamics<N>, const N: usize>() -> bool {
    0 < frictions::<D, N>()
}

/// The mode of a dry friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Grip {
    /// The system has fewer frictions.
    Absent,
    /// The rate is held at zero.
    Sticks,
    /// The rate is negative, or about to become so. The rate of a vector leaves zero: its direction
    /// is that in which it is accelerated.
    Backwards,
    /// The rate is positive, or about to become so. The rate of a vector has a direction.
    Forwards,
}

impl Grip {
    /// All modes in the order of their codes.
    pub(crate) const ALL: [Self; 4] = [Self::Absent, Self::Sticks, Self::Backwards, Self::Forwards];

    /// Returns the mode of a friction that slides.
    pub(crate) fn sliding(forwards: bool) -> Self {
        if forwards { Self::Forwards } else { Self::Backwards }
    }

    /// Returns the direction of a friction that slides, otherwise `None`.
    pub(crate) fn direction<T: Float>(self) -> Option<T> {
        match self {
            Self::Absent | Self::Sticks => None,
            Self::Backwards => Some(T::from_f64(-1.0)),
            Self::Forwards => Some(T::from_f64(1.0)),
        }
    }
}

/// The dry frictions at a state, with their responses K a to forces.
pub(crate) struct Grasp<T, const N: usize> {
    /// The frictions. Loops end there, and not at the most that a system may have.
    pub(super) facts: &'static [Friction],
    /// The rates r, and their rates at q̈ = 0.
    pub(crate) rates: [[T; F]; 2],
    /// The directions of the rates that are vectors and slide.
    pub(super) aims: [T; F],
    pub(super) rows: SMatrix<T, F, N>,
    pub(super) changes: [[T; N]; F],
    /// The force of sliding and the bound of sticking, without the shares of the contacts.
    pub(crate) magnitudes: [[T; F]; 2],
    /// The factors of the forces of contacts in both, and of loads; `None` without either.
    pub(crate) shares: Option<[SMatrix<T, F, L>; 2]>,
    /// A friction that presses its own constraint so that no load fits, or several do.
    pub(crate) jam: Option<usize>,
}

/// The forces of dry frictions and what they lead to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rubbed<T> {
    /// The forces φ.
    pub(crate) forces: [T; F],
    /// The bounds of the forces of those that stick.
    pub(crate) bounds: [T; F],
    /// The rates of the rates.
    pub(crate) rates: [T; F],
    /// A friction that slides on a contact so that a force of the contact closes it.
    pub(crate) jam: Option<usize>,
}

impl<T: Float, const N: usize> Grasp<T, N> {
    /// Returns the direction of a friction that slides, or its component; otherwise `None`.
    pub(crate) fn direction(&self, contacts: &Contacts, k: usize) -> Option<T> {
        let sign = contacts.grip(k).direction();
        if self.facts[k].components == 1 { sign } else { sign.map(|_: T| self.aims[k]) }
    }

    /// Returns `a` with the forces of frictions that slide, without the shares of contacts.
    pub(crate) fn slide(&self, contacts: &Contacts, a: &[T; N]) -> [T; N] {
        let mut a = *a;
        for k in 0..self.facts.len() {
            if let Some(s) = self.direction(contacts, k) {
                add(&mut a, -s * self.magnitudes[0][k], &self.changes[k]);
            }
        }
        a
    }

    /// Returns the response to a unit force of a contact with the response `change`: with the
    /// frictions that slide on it.
    pub(crate) fn drag(&self, contacts: &Contacts, limit: usize, change: &[T; N]) -> [T; N] {
        let mut change = *change;
        for k in 0..self.facts.len() {
            if let Some(s) = self.direction(contacts, k) {
                add(&mut change, -s * self.share(0, k, limit), &self.changes[k]);
            }
        }
        change
    }

    /// Returns the forces that change the rates of the frictions that stick by `target`, and the
    /// response to them.
    pub(crate) fn shift(&self, contacts: &Contacts, target: &[T; F]) -> ([T; F], [T; N]) {
        let (zero, sticks) = (T::from_f64(0.0), |k: &usize| contacts.grip(*k) == Grip::Sticks);
        let (mut forces, mut change) = ([zero; F], [zero; N]);
        let mut sticking = (0..self.facts.len()).filter(sticks);
        let Some(first) = sticking.next() else { return (forces, change) };
        if sticking.next().is_none() {
            let own = self.entry(first, first);
            if zero < own {
                forces[first] = target[first] / own;
            }
        } else {
            forces = self.forces(sticks, target);
        }
        for k in (0..self.facts.len()).filter(sticks) {
            add(&mut change, forces[k], &self.changes[k]);
        }
        (forces, change)
    }

    /// Returns the forces of several frictions that stick. That of one which depends on those
    /// before it is zero.
    #[inline(never)]
    fn forces(&self, sticks: impl Fn(&usize) -> bool, target: &[T; F]) -> [T; F] {
        let mut matrix = SMatrix::from_element(T::from_f64(0.0));
        for i in (0..self.facts.len()).filter(&sticks) {
            for j in (0..self.facts.len()).filter(&sticks) {
                matrix[(i, j)] = self.entry(i, j);
            }
        }
        solved_where(matrix, *target, |k, pivot| {
            sticks(&k) && T::EPSILON.sqrt() * matrix[(k, k)] < pivot
        })
    }

    /// Returns a response with the forces of the frictions that stick, which keep their rates.
    pub(crate) fn keep(&self, contacts: &Contacts, change: &[T; N]) -> [T; N] {
        if !contacts.sticks() {
            return *change;
        }
        let (_, back) = self.shift(contacts, &self.along(change).map(|rate| -rate));
        core::array::from_fn(|j| change[j] + back[j])
    }

    /// Returns accelerations with the forces of the frictions that stick.
    pub(crate) fn hold(&self, contacts: &Contacts, a: &[T; N]) -> [T; N] {
        if !contacts.sticks() {
            return *a;
        }
        let (_, back) = self.shift(contacts, &self.after(a).map(|rate| -rate));
        core::array::from_fn(|j| a[j] + back[j])
    }

    /// Returns a value for each friction; the remaining entries are zero.
    pub(super) fn each(&self, value: impl Fn(usize) -> T) -> [T; F] {
        let mut values = [T::from_f64(0.0); F];
        for k in 0..self.facts.len() {
            values[k] = value(k);
        }
        values
    }

    /// Returns aᵢ K aⱼ.
    pub(crate) fn entry(&self, i: usize, j: usize) -> T {
        product(&row(&self.rows, i), &self.changes[j])
    }

    /// Returns the factor of the force of a limit in a magnitude of a friction.
    pub(super) fn share(&self, part: usize, friction: usize, limit: usize) -> T {
        let zero = T::from_f64(0.0);
        self.shares.as_ref().map_or(zero, |shares| shares[part][(friction, limit)])
    }

    /// Returns the generalized forces Aᵀφ.
    pub(crate) fn force(&self, forces: &[T; F]) -> [T; N] {
        let zero = T::from_f64(0.0);
        let sum = |sum, k: usize, j: usize| sum + self.rows[(k, j)] * forces[k];
        core::array::from_fn(|j| (0..self.facts.len()).fold(zero, |part, k| sum(part, k, j)))
    }

    /// Returns the changes of the rates by a change of the velocities.
    fn along(&self, change: &[T; N]) -> [T; F] {
        self.each(|k| product(&row(&self.rows, k), change))
    }

    /// Returns the rates of the rates at the accelerations `a`.
    pub(crate) fn after(&self, a: &[T; N]) -> [T; F] {
        self.each(|k| self.rates[1][k] + product(&row(&self.rows, k), a))
    }

    /// Returns the rounding error of each rate, given the rounding errors of the velocities.
    pub(crate) fn rounding(&self, v: &[T; N], sizes: &[T; N]) -> [T; F] {
        self.each(|k| {
            let fixed = self.rates[0][k] - product(&row(&self.rows, k), v);
            T::EPSILON * self.size(k, fixed, sizes)
        })
    }

    /// Returns the change of a rate by changes of the velocities.
    pub(crate) fn allowed(&self, k: usize, v: &[T; N], changes: impl Fn(usize, T) -> f64) -> f64 {
        (0..N).fold(0.0, |sum, j| {
            let part = self.rows[(k, j)].to_f64().abs();
            if part == 0.0 { sum } else { sum + part * changes(j, v[j]) }
        })
    }

    /// Returns the rounding error of the rate of a rate at the accelerations `a`.
    pub(crate) fn noise(&self, friction: usize, free: &[T; N], a: &[T; N]) -> T {
        let sizes = core::array::from_fn(|j| free[j].abs() + (a[j] - free[j]).abs());
        T::EPSILON * self.size(friction, self.rates[1][friction], &sizes)
    }

    /// Returns the sum of the sizes of the terms of a rate.
    pub(super) fn size(&self, friction: usize, fixed: T, sizes: &[T; N]) -> T {
        (0..N).fold(fixed.abs(), |sum, j| sum + self.rows[(friction, j)].abs() * sizes[j].abs())
    }

    /// Returns a magnitude of a friction at the forces `pushes` of the contacts: that while it
    /// slides for `part` 0, the bound `static` for `part` 1.
    pub(super) fn magnitude(&self, part: usize, friction: usize, pushes: &[T; L]) -> T {
        let own = self.magnitudes[part][friction];
        self.shares.as_ref().map_or(own, |shares| {
            (0..L).fold(own, |sum, i| sum + shares[part][(friction, i)] * pushes[i])
        })
    }

    /// Returns the friction that most probably stands against any motion: one on a contact.
    pub(super) fn blame(&self, contacts: &Contacts) -> usize {
        let on = |k: &usize| (0..L).any(|i| contacts.has(i) && self.is_shared(*k, i));
        (0..self.facts.len()).find(on).unwrap_or(0)
    }

    /// Returns `true` if the force of a limit is part of the magnitude of a friction.
    pub(crate) fn is_shared(&self, friction: usize, limit: usize) -> bool {
        (0..2).any(|part| self.share(part, friction, limit) != T::from_f64(0.0))
    }
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Phase<'_, D, N> {
    /// Returns accelerations with the forces of frictions that slide, without limits in contact.
    pub(crate) fn slide(&self, contacts: &Contacts, free: &[D::Scalar; N]) -> [D::Scalar; N] {
        if const { has_vectors::<D, N>() || 0 < loads::<D, N>() } {
            return self.grasp_with(free, contacts).slide(contacts, free);
        }
        let (system, inputs) = (self.dynamics.system(), self.inputs(Purpose::Accelerations));
        let at = self.at(&inputs);
        let (rows, [forces, _]) = (system.slip_jacobian(at), system.grips(at));
        let mut a = *free;
        for k in 0..frictions::<D, N>() {
            if let Some(s) = contacts.grip(k).direction::<D::Scalar>() {
                add(&mut a, -s * forces[k], &self.response(&row(&rows, k)));
            }
        }
        a
    }

    /// Returns the dry frictions at this state.
    #[inline]
    pub(crate) fn grasp(&self) -> Grasp<D::Scalar, N> {
        let zero = D::Scalar::from_f64(0.0);
        let (system, inputs) = (self.dynamics.system(), self.inputs(Purpose::Accelerations));
        let at = self.at(&inputs);
        let (rates, rows) = (system.slips(at), system.slip_jacobian(at));
        let mut changes = [[zero; N]; F];
        for k in 0..frictions::<D, N>() {
            changes[k] = self.response(&row(&rows, k));
        }
        let magnitudes = system.grips(at);
        let pressed = const { 0 < limits::<D, N>() + loads::<D, N>() };
        let shares = pressed.then(|| system.grip_shares(at));
        let (facts, aims) = (<D::System as System<N>>::FACTS.frictions, [zero; F]);
        Grasp { facts, rates, aims, rows, changes, magnitudes, shares, jam: None }
    }

    /// Returns the dry frictions at this state, with the directions of those that slide, and with
    /// the loads.
    pub(crate) fn grasp_with(
        &self,
        free: &[D::Scalar; N],
        contacts: &Contacts,
    ) -> Grasp<D::Scalar, N> {
        let mut grasp = self.grasp();
        if const { has_vectors::<D, N>() } {
            self.aim(&mut grasp, free, contacts);
        }
        if const { 0 < loads::<D, N>() } {
            let own = grasp.magnitudes;
            grasp.jam = self.load(&mut grasp, free, contacts);
            // The direction in which a rate leaves zero depends on the loads.
            for _ in 0..if const { has_vectors::<D, N>() } { ROUNDS } else { 0 } {
                let aims = grasp.aims;
                self.aim(&mut grasp, free, contacts);
                if grasp.aims == aims {
                    break;
                }
                grasp.magnitudes = own;
                grasp.jam = self.load(&mut grasp, free, contacts);
            }
        }
        grasp
    }

    /// Returns the forces of the frictions at the accelerations of `push`, from the accelerations
    /// `free` without contacts and frictions.
    pub(crate) fn rubbed(
        &self,
        grasp: &Grasp<D::Scalar, N>,
        free: &[D::Scalar; N],
        contacts: &Contacts,
        push: &Push<D::Scalar, N>,
    ) -> Rubbed<D::Scalar> {
        let mut a = grasp.slide(contacts, free);
        let mut jam = None;
        for i in (0..limits::<D, N>()).filter(|i| contacts.has(*i)) {
            let normal = row(&self.normals(), i);
            let change = self.response(&normal);
            let dragged = grasp.drag(contacts, i, &change);
            add(&mut a, push.multipliers[i], &dragged);
            let opening = product(&normal, &grasp.keep(contacts, &dragged));
            let alone = product(&normal, &grasp.keep(contacts, &change));
            let least = D::Scalar::EPSILON.sqrt() * product(&normal, &change);
            if least < alone && opening <= least {
                jam = Some(grasp.blame(contacts));
            }
        }
        let (held, _) = grasp.shift(contacts, &grasp.after(&a).map(|rate| -rate));
        let [sliding, least] =
            [0, 1].map(|part| grasp.each(|k| grasp.magnitude(part, k, &push.multipliers)));
        let forces =
            grasp.each(|k| grasp.direction(contacts, k).map_or(held[k], |s| -s * sliding[k]));
        let bounds = grasp.each(|k| sliding[k].max(least[k]));
        Rubbed { forces, bounds, rates: grasp.after(&push.accelerations), jam }
    }
}

/// Adds `factor` times `change` to `sum`.
fn add<T: Float, const N: usize>(sum: &mut [T; N], factor: T, change: &[T; N]) {
    for j in 0..N {
        sum[j] += factor * change[j];
    }
}
