//! Dry frictions at a state: their forces, and which of them stick.
//!
//! A friction acts against a rate r = a q̇ + b. While it slides in the direction s = ±1, its force
//! is φ = −s F, where F grows with the forces μ of limits in contact. While it sticks, ṙ = 0
//! determines φ, as for a constraint. Frictions that stick are eliminated before the contacts: each
//! force, that of a contact too, then acts through the response that keeps their rates. A contact
//! with a friction that slides acts along n − s f a, where f is the share of its force in F, so
//! that the equations of the contacts are not symmetric.
//!
//! Which of the frictions at rate zero stick is a complementarity problem: ṙ = 0 and |φ| ≤ S, or φ
//! = ∓S and ±ṙ > 0. With contacts without shares it is convex, so that the accelerations exist and
//! are unique, even if the forces are not. The forces of those that break away fall from S to F,
//! which may break others away; their bounds become F one after the other, until no other breaks
//! away.

use crate::integrate::field::complementarity::{MOST, complementary};
use crate::integrate::field::contacts::{Contacts, Push, limits, row};
use crate::integrate::field::phase::Phase;
use crate::integrate::field::response::{product, solved_where};
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, Facts, MOST_FRICTIONS as F, MOST_LIMITS as L, Purpose, System};
use nalgebra::SMatrix;

/// Returns the number of rates with dry friction of the dynamics `D`.
pub(crate) const fn frictions<D: Dynamics<N>, const N: usize>() -> usize {
    <D::System as System<N>>::FACTS.frictions.len()
}

/// Returns `true` if all rates are scalars: the force of a vector has the direction of the rate,
/// which a sign for each component does not give.
pub(crate) const fn are_scalar(facts: &Facts) -> bool {
    let mut index = 0;
    while index < facts.frictions.len() && facts.frictions[index].components == 1 {
        index += 1;
    }
    index == facts.frictions.len()
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
    /// The rate is negative, or about to become so.
    Backwards,
    /// The rate is positive, or about to become so.
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
    /// The number of frictions. Loops end there, and not at the most that a system may have.
    count: usize,
    /// The rates r, and their rates at q̈ = 0.
    pub(crate) rates: [[T; F]; 2],
    rows: SMatrix<T, F, N>,
    changes: [[T; N]; F],
    /// The force of sliding and the bound of sticking, without the shares of the contacts.
    pub(crate) magnitudes: [[T; F]; 2],
    /// The factors of the forces of contacts in both; `None` without limits.
    pub(crate) shares: Option<[SMatrix<T, F, L>; 2]>,
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
    /// Returns `a` with the forces of frictions that slide, without the shares of contacts.
    pub(crate) fn slide(&self, contacts: &Contacts, a: &[T; N]) -> [T; N] {
        let mut a = *a;
        for k in 0..self.count {
            if let Some(s) = contacts.grip(k).direction::<T>() {
                add(&mut a, -s * self.magnitudes[0][k], &self.changes[k]);
            }
        }
        a
    }

    /// Returns the response to a unit force of a contact with the response `change`: with the
    /// frictions that slide on it.
    pub(crate) fn drag(&self, contacts: &Contacts, limit: usize, change: &[T; N]) -> [T; N] {
        let mut change = *change;
        for k in 0..self.count {
            if let Some(s) = contacts.grip(k).direction::<T>() {
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
        let mut sticking = (0..self.count).filter(sticks);
        let Some(first) = sticking.next() else { return (forces, change) };
        if sticking.next().is_none() {
            let own = self.entry(first, first);
            if zero < own {
                forces[first] = target[first] / own;
            }
        } else {
            forces = self.forces(sticks, target);
        }
        for k in (0..self.count).filter(sticks) {
            add(&mut change, forces[k], &self.changes[k]);
        }
        (forces, change)
    }

    /// Returns the forces of several frictions that stick. That of one which depends on those before
    /// it is zero.
    #[inline(never)]
    fn forces(&self, sticks: impl Fn(&usize) -> bool, target: &[T; F]) -> [T; F] {
        let mut matrix = SMatrix::from_element(T::from_f64(0.0));
        for i in (0..self.count).filter(&sticks) {
            for j in (0..self.count).filter(&sticks) {
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
    fn each(&self, value: impl Fn(usize) -> T) -> [T; F] {
        let mut values = [T::from_f64(0.0); F];
        for k in 0..self.count {
            values[k] = value(k);
        }
        values
    }

    /// Returns aᵢ K aⱼ.
    fn entry(&self, i: usize, j: usize) -> T {
        product(&row(&self.rows, i), &self.changes[j])
    }

    /// Returns the factor of the force of a limit in a magnitude of a friction.
    fn share(&self, part: usize, friction: usize, limit: usize) -> T {
        let zero = T::from_f64(0.0);
        self.shares.as_ref().map_or(zero, |shares| shares[part][(friction, limit)])
    }

    /// Returns the generalized forces Aᵀφ.
    pub(crate) fn force(&self, forces: &[T; F]) -> [T; N] {
        let zero = T::from_f64(0.0);
        let sum = |sum, k: usize, j: usize| sum + self.rows[(k, j)] * forces[k];
        core::array::from_fn(|j| (0..self.count).fold(zero, |part, k| sum(part, k, j)))
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

    /// Returns the rounding error of the rate of a rate at the accelerations `a`.
    pub(crate) fn noise(&self, friction: usize, free: &[T; N], a: &[T; N]) -> T {
        let sizes = core::array::from_fn(|j| free[j].abs() + (a[j] - free[j]).abs());
        T::EPSILON * self.size(friction, self.rates[1][friction], &sizes)
    }

    /// Returns the sum of the sizes of the terms of a rate.
    fn size(&self, friction: usize, fixed: T, sizes: &[T; N]) -> T {
        (0..N).fold(fixed.abs(), |sum, j| sum + self.rows[(friction, j)].abs() * sizes[j].abs())
    }

    /// Returns a magnitude of a friction at the forces `pushes` of the contacts: that while it slides
    /// for `part` 0, the bound `static` for `part` 1.
    fn magnitude(&self, part: usize, friction: usize, pushes: &[T; L]) -> T {
        let own = self.magnitudes[part][friction];
        self.shares.as_ref().map_or(own, |shares| {
            (0..L).fold(own, |sum, i| sum + shares[part][(friction, i)] * pushes[i])
        })
    }

    /// Returns the friction that most probably stands against any motion: one on a contact.
    fn blame(&self, contacts: &Contacts) -> usize {
        let on = |k: &usize| (0..L).any(|i| contacts.has(i) && self.is_shared(*k, i));
        (0..self.count).find(on).unwrap_or(0)
    }

    /// Returns `true` if the force of a limit is part of the magnitude of a friction.
    pub(crate) fn is_shared(&self, friction: usize, limit: usize) -> bool {
        (0..2).any(|part| self.share(part, friction, limit) != T::from_f64(0.0))
    }
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Phase<'_, D, N> {
    /// Returns accelerations with the forces of frictions that slide, without limits in contact.
    pub(crate) fn slide(&self, contacts: &Contacts, free: &[D::Scalar; N]) -> [D::Scalar; N] {
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
        let shares = const { 0 < limits::<D, N>() }.then(|| system.grip_shares(at));
        Grasp { count: frictions::<D, N>(), rates, rows, changes, magnitudes, shares }
    }

    /// Returns the impulse of a limit that closes with `rate` and rebounds with `restitution`, and
    /// the change of the velocities: with the impulses of the frictions on the limit.
    ///
    /// The impulse of a friction is at most its share of the impulse of the limit. It acts against
    /// the rate that the impact would otherwise leave, and stops at rate zero, while the limit
    /// adapts its impulse so that the rebound stays. This is the sequence of Newton's and Coulomb's
    /// laws, not the path of impulses of Routh (1905) with an energetic restitution (Stronge 1990).
    /// In eccentric impacts it could create energy (Kane 1984): the impulse is then cut to what
    /// keeps the energy.
    pub(crate) fn strike(
        &self,
        limit: usize,
        rate: D::Scalar,
        restitution: D::Scalar,
    ) -> (D::Scalar, [D::Scalar; N]) {
        let number = D::Scalar::from_f64;
        let (zero, one, half) = (number(0.0), number(1.0), number(0.5));
        let normal = row(&self.normals(), limit);
        let response = self.response(&normal);
        let own = product(&normal, &response);
        let mut impulse = -(one + restitution) * rate / own;
        let mut change = response.map(|part| impulse * part);
        let grasp = self.grasp();
        let mut loss = half * (one - restitution * restitution) * rate * rate / own;
        for k in (0..frictions::<D, N>()).filter(|k| grasp.is_shared(*k, limit)) {
            let (along, share) = (row(&grasp.rows, k), grasp.share(0, k, limit));
            let closing = product(&normal, &grasp.changes[k]) / own;
            let mut turned = grasp.changes[k];
            add(&mut turned, -closing, &response);
            let size = product(&along, &turned);
            if size <= D::Scalar::EPSILON.sqrt() * grasp.entry(k, k) {
                continue;
            }
            let left = grasp.rates[0][k] + product(&along, &change);
            let towards = if zero < left { -one } else { one };
            let mut length = left.abs() / size;
            let jams = one + share * closing * towards;
            if zero < jams && share * impulse / jams < length {
                length = share * impulse / jams;
            }
            // The energy changes by length·slope + length²·size/2.
            let slope = towards * left + closing * towards * restitution * rate;
            if loss < length * (slope + half * length * size) {
                length = ((slope * slope + number(2.0) * size * loss).sqrt() - slope) / size;
            }
            loss -= length * (slope + half * length * size);
            add(&mut change, towards * length, &turned);
            impulse -= closing * towards * length;
        }
        (impulse, change)
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
        let forces = grasp.each(|k| {
            contacts.grip(k).direction::<D::Scalar>().map_or(held[k], |s| -s * sliding[k])
        });
        let bounds = grasp.each(|k| sliding[k].max(least[k]));
        Rubbed { forces, bounds, rates: grasp.after(&push.accelerations), jam }
    }

    /// Returns the modes as [`decide`](Self::decide) does without limits in contact, if they follow
    /// from one elimination: if all frictions that stick can hold, or if there is only one.
    fn settled(
        &self,
        grasp: &Grasp<D::Scalar, N>,
        free: &[D::Scalar; N],
        contacts: &Contacts,
    ) -> Option<[Grip; F]> {
        let zero = D::Scalar::from_f64(0.0);
        let base = grasp.slide(contacts, free);
        let rates = grasp.after(&base);
        let (forces, _) = grasp.shift(contacts, &rates.map(|rate| -rate));
        let bound = |k: usize| grasp.magnitudes[0][k].max(grasp.magnitudes[1][k]);
        let sticking = || (0..grasp.count).filter(|k| contacts.grip(*k) == Grip::Sticks);
        let mut slipping = sticking().filter(|k| bound(*k) < forces[*k].abs());
        let Some(k) = slipping.next() else { return Some(contacts.grips) };
        if 1 < sticking().count() {
            return None;
        }
        let force = if zero < rates[k] { -bound(k) } else { bound(k) };
        let mut sizes = self.bound();
        for i in 0..N {
            sizes[i] += free[i].abs() + (base[i] - free[i]).abs();
            sizes[i] += (force * grasp.changes[k][i]).abs();
        }
        let rate = rates[k] + grasp.entry(k, k) * force;
        let noise = D::Scalar::from_f64(64.0) * D::Scalar::EPSILON;
        let mut grips = contacts.grips;
        if noise * grasp.size(k, grasp.rates[1][k], &sizes) < rate.abs() {
            grips[k] = Grip::sliding(zero < rate);
        }
        Some(grips)
    }

    /// Returns the contacts with new modes of the frictions that stick, given the accelerations
    /// `free` without contacts and frictions: those that the others cannot hold slide. The limits
    /// push or open.
    ///
    /// # Errors
    /// Returns a friction if no accelerations fulfil the laws of all contacts and frictions.
    pub(crate) fn decide(
        &self,
        free: &[D::Scalar; N],
        contacts: &Contacts,
    ) -> Result<Contacts, usize> {
        let number = D::Scalar::from_f64;
        let (zero, one) = (number(0.0), number(1.0));
        let grasp = self.grasp();
        if contacts.touching() == 0
            && let Some(grips) = self.settled(&grasp, free, contacts)
        {
            return Ok(contacts.with(grips));
        }
        let normals = self.normals();
        let [_, _, gaps] = self.gaps();
        // The rows of the contacts and of the frictions that stick, their responses, and their
        // sizes in the metric of the mass matrix, which become units.
        let mut list = [(0, false); L + F];
        let mut count = 0;
        for i in (0..limits::<D, N>()).filter(|i| contacts.has(*i)) {
            (list[count], count) = ((i, true), count + 1);
        }
        let pushing = count;
        for k in (0..frictions::<D, N>()).filter(|k| contacts.grip(*k) == Grip::Sticks) {
            // A rate that no force changes needs none.
            if zero < grasp.entry(k, k) {
                (list[count], count) = ((k, false), count + 1);
            }
        }
        let list = &list[..count];
        let rubbing = count - pushing;
        let base = grasp.slide(contacts, free);
        let (mut rows, mut changes) = ([[zero; N]; L + F], [[zero; N]; L + F]);
        let (mut units, mut offsets) = ([one; L + F], [zero; L + F]);
        for (own, &(index, limit)) in list.iter().enumerate() {
            let (normal, change) = if limit {
                let normal = row(&normals, index);
                (normal, self.response(&normal))
            } else {
                (row(&grasp.rows, index), grasp.changes[index])
            };
            (rows[own], units[own]) = (normal, product(&normal, &change).sqrt());
            offsets[own] = if limit { gaps[index] } else { grasp.rates[1][index] };
            changes[own] = if limit { grasp.drag(contacts, index, &change) } else { change };
        }
        let at_rest = core::array::from_fn::<_, { L + F }, _>(|own| {
            (offsets[own] + product(&rows[own], &base)) / units[own]
        });
        let mut decided = *contacts;
        // Frictions that break away, and those with the bound F in place of S.
        let mut moved = [false; F];
        let mut kinetic: [bool; F] =
            core::array::from_fn(|k| grasp.magnitudes[1][k] <= grasp.magnitudes[0][k]);
        for _ in 0..4 * F {
            let part = |k: usize| usize::from(!(moved[k] || kinetic[k]));
            let (mut matrix, mut q) = ([[zero; MOST]; MOST], [zero; MOST]);
            q[..count].copy_from_slice(&at_rest[..count]);
            for j in 0..count {
                for i in 0..count {
                    matrix[i][j] += product(&rows[i], &changes[j]) / (units[i] * units[j]);
                }
            }
            // The forces of frictions are counted from the lower bound.
            for j in pushing..count {
                let (k, back) = (list[j].0, j + rubbing);
                let two = number(2.0);
                let bound = units[j] * grasp.magnitudes[part(k)][k];
                for i in 0..count {
                    q[i] -= matrix[i][j] * bound;
                }
                q[back] = two * bound;
                for l in 0..pushing {
                    let share = grasp.share(part(k), k, list[l].0) * units[j] / units[l];
                    for i in 0..count {
                        let entry = matrix[i][j] * share;
                        matrix[i][l] -= entry;
                    }
                    matrix[back][l] = two * share;
                }
                (matrix[j][back], matrix[back][j]) = (one, -one);
            }
            let refused = || grasp.blame(contacts);
            let [w, z] = complementary(count + rubbing, &matrix, &q).ok_or_else(refused)?;
            let mut pushes = [zero; L];
            for j in 0..pushing {
                pushes[list[j].0] = z[j] / units[j];
            }
            let mut sizes = self.bound();
            for i in 0..N {
                sizes[i] += free[i].abs() + (base[i] - free[i]).abs();
            }
            for j in 0..count {
                let mut force = z[j] / units[j];
                if pushing <= j {
                    force -= grasp.magnitude(part(list[j].0), list[j].0, &pushes);
                }
                for i in 0..N {
                    sizes[i] += (force * changes[j][i]).abs();
                }
            }
            let (before, noise) = ((moved, kinetic), number(64.0) * D::Scalar::EPSILON);
            for j in pushing..count {
                let k = list[j].0;
                let rate = (w[j] - z[j + rubbing]) * units[j];
                let moves = noise * grasp.size(k, grasp.rates[1][k], &sizes) < rate.abs();
                decided.grips[k] = if moves { Grip::sliding(zero < rate) } else { Grip::Sticks };
                let [force, bound] = [0, 1].map(|part| grasp.magnitude(part, k, &pushes));
                kinetic[k] = bound <= force;
                moved[k] |= moves && kinetic[k] == before.1[k];
            }
            if (moved, kinetic) == before {
                break;
            }
        }
        Ok(decided)
    }
}

/// Adds `factor` times `change` to `sum`.
fn add<T: Float, const N: usize>(sum: &mut [T; N], factor: T, change: &[T; N]) {
    for j in 0..N {
        sum[j] += factor * change[j];
    }
}
