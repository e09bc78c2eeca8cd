//! Which dry frictions stick, and in which directions others slide from rest.
//!
//! Which of the frictions at rate zero stick is a complementarity problem: ṙ = 0 and |φ| ≤ S, or φ
//! = ∓S and ±ṙ > 0. With contacts without shares it is convex, so that the accelerations exist and
//! are unique, even if the forces are not. The forces of those that break away fall from S to F,
//! which may break others away; their bounds become F one after the other, until no other breaks
//! away.
//!
//! Rates that are vectors have discs and balls in place of intervals, |φ| ≤ S, and slide in the
//! direction of ṙ, against φ. Systems that have some are swept ([`Balance`]); all others go by
//! complementary pivots, which are exact.

use crate::integrate::field::complementarity::{MOST, complementary};
use crate::integrate::field::cone::{Balance, FORCES, group, heads, norm};
use crate::integrate::field::contacts::{CLOSED, Contacts, limits, row};
use crate::integrate::field::grasp::{Grasp, Grip, ROUNDS, frictions, has_vectors};
use crate::integrate::field::load::loads;
use crate::integrate::field::phase::Phase;
use crate::integrate::field::response::product;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, MOST_FRICTIONS as F, MOST_LIMITS as L};
use core::ops::Range;

/// The forces of limits in contact and of frictions at rest, in this order.
struct Rows<T, const N: usize> {
    /// Indices of limits and then of frictions.
    list: [usize; FORCES],
    /// The number of forces, and the number of those that are limits.
    count: usize,
    limits: usize,
    gradients: [[T; N]; FORCES],
    changes: [[T; N]; FORCES],
    /// The sizes of the rows in the metric of the mass matrix.
    units: [T; FORCES],
    /// The rates of the rates of the gaps and of the frictions without these forces.
    rates: [T; FORCES],
    /// The accelerations without these forces.
    base: [T; N],
}

impl<T: Float, const N: usize> Rows<T, N> {
    /// Returns the effect of a force on a rate.
    fn entry(&self, i: usize, j: usize) -> T {
        product(&self.gradients[i], &self.changes[j])
    }

    /// Returns the forces of the limits by their indices.
    fn pushes(&self, forces: &[T; FORCES]) -> [T; L] {
        let mut pushes = [T::from_f64(0.0); L];
        for j in 0..self.limits {
            pushes[self.list[j]] = forces[j];
        }
        pushes
    }

    /// Returns the places of the frictions.
    fn groups(&self, grasp: &Grasp<T, N>) -> ([Range<usize>; F], usize) {
        let (mut groups, mut count) = (core::array::from_fn(|_| 0..0), 0);
        let mut place = self.limits;
        while place < self.count {
            let own = place..place + group(grasp.facts, self.list[place]).len();
            place = own.end;
            (groups[count], count) = (own, count + 1);
        }
        (groups, count)
    }

    /// Returns the forces by sweeps, and the rates with them, for bounds by the indices of
    /// frictions and the forces of limits.
    fn swept(
        &self,
        grasp: &Grasp<T, N>,
        bound: impl Fn(usize, &[T; L]) -> T,
    ) -> Option<[[T; FORCES]; 2]> {
        let mut matrix = [[T::from_f64(0.0); FORCES]; FORCES];
        for i in 0..self.count {
            for j in 0..self.count {
                matrix[i][j] = self.entry(i, j);
            }
        }
        let (groups, count) = self.groups(grasp);
        let Self { limits, count: all, rates, .. } = *self;
        let balance = Balance { limits, count: all, matrix, rates };
        let bound = |j: usize, forces: &_| bound(self.list[j], &self.pushes(forces));
        let forces = balance.solve(&groups[..count], bound)?;
        Some([forces, core::array::from_fn(|i| balance.rate(i, &forces, &(0..0)))])
    }

    /// Returns the forces by pivots, and the rates with them, for rates that are scalars and for
    /// parts of the magnitudes.
    fn pivoted(
        &self,
        grasp: &Grasp<T, N>,
        part: impl Fn(usize) -> usize,
    ) -> Option<[[T; FORCES]; 2]> {
        let (zero, one, two) = (T::from_f64(0.0), T::from_f64(1.0), T::from_f64(2.0));
        let Self { count, limits, units, list, .. } = *self;
        let rubbing = count - limits;
        let (mut matrix, mut q) = ([[zero; MOST]; MOST], [zero; MOST]);
        for i in 0..count {
            q[i] = self.rates[i] / units[i];
            for j in 0..count {
                matrix[i][j] = self.entry(i, j) / (units[i] * units[j]);
            }
        }
        // The forces of frictions are counted from the lower bound.
        for j in limits..count {
            let (k, back) = (list[j], j + rubbing);
            let bound = units[j] * grasp.magnitudes[part(k)][k];
            for i in 0..count {
                q[i] -= matrix[i][j] * bound;
            }
            q[back] = two * bound;
            for l in 0..limits {
                let share = grasp.share(part(k), k, list[l]) * units[j] / units[l];
                for i in 0..count {
                    let entry = matrix[i][j] * share;
                    matrix[i][l] -= entry;
                }
                matrix[back][l] = two * share;
            }
            (matrix[j][back], matrix[back][j]) = (one, -one);
        }
        let [w, z] = complementary(count + rubbing, &matrix, &q)?;
        let (mut forces, mut rates) = ([zero; FORCES], [zero; FORCES]);
        for j in 0..count {
            forces[j] = z[j] / units[j];
            let back = if j < limits { zero } else { z[j + rubbing] };
            rates[j] = (w[j] - back) * units[j];
        }
        let pushes = self.pushes(&forces);
        for j in limits..count {
            forces[j] -= grasp.magnitude(part(list[j]), list[j], &pushes);
        }
        Some([forces, rates])
    }
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Phase<'_, D, N> {
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
        let sticking = || heads(grasp.facts).filter(|k| contacts.grip(*k) == Grip::Sticks);
        let size = |k: usize| norm(&forces[group(grasp.facts, k)]);
        let mut slipping = sticking().filter(|k| bound(*k) < size(*k));
        let Some(k) = slipping.next() else { return Some(contacts.grips) };
        if 1 < sticking().count() || grasp.facts[k].components != 1 {
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

    /// Returns the forces of the limits in contact and of the frictions that stick, with the forces
    /// of those that slide.
    fn rows(
        &self,
        grasp: &Grasp<D::Scalar, N>,
        free: &[D::Scalar; N],
        contacts: &Contacts,
    ) -> Rows<D::Scalar, N> {
        let (zero, one) = (D::Scalar::from_f64(0.0), D::Scalar::from_f64(1.0));
        let (normals, [_, _, gaps]) = (self.normals(), self.gaps());
        let mut own = Rows {
            list: [0; FORCES],
            count: 0,
            limits: contacts.touching(),
            gradients: [[zero; N]; FORCES],
            changes: [[zero; N]; FORCES],
            units: [one; FORCES],
            rates: [zero; FORCES],
            base: grasp.slide(contacts, free),
        };
        let mut add = |index, row: [D::Scalar; N], change: [D::Scalar; N], offset, dragged| {
            let j = own.count;
            (own.list[j], own.gradients[j], own.count) = (index, row, j + 1);
            own.units[j] = product(&row, &change).sqrt();
            own.rates[j] = offset + product(&row, &own.base);
            own.changes[j] = dragged;
        };
        for i in (0..limits::<D, N>()).filter(|i| contacts.has(*i)) {
            let normal = row(&normals, i);
            let change = self.response(&normal);
            add(i, normal, change, gaps[i], grasp.drag(contacts, i, &change));
        }
        for k in (0..frictions::<D, N>()).filter(|k| contacts.grip(*k) == Grip::Sticks) {
            // A rate that no force changes needs none.
            if zero < grasp.entry(k, k) || grasp.facts[k].components != 1 {
                let change = grasp.changes[k];
                add(k, row(&grasp.rows, k), change, grasp.rates[1][k], change);
            }
        }
        own
    }

    /// Sets the directions of the frictions against vectors that slide: those of their rates, or
    /// those in which rates leave zero; at zero shorter than one, so that the rate stays there,
    /// where less than the force of sliding holds it.
    ///
    /// A small rate turns into the direction of its acceleration so fast that an explicit method
    /// would take a step for each of these turns. This direction serves until the rate has left it.
    pub(super) fn aim(
        &self,
        grasp: &mut Grasp<D::Scalar, N>,
        free: &[D::Scalar; N],
        contacts: &Contacts,
    ) {
        let number = D::Scalar::from_f64;
        let least = grasp.rounding(self.v, &self.sizes()[1]);
        let (mut resting, mut begins) = (*contacts, [false; F]);
        for own in heads(grasp.facts).map(|head| group(grasp.facts, head)) {
            if own.len() == 1 || own.clone().all(|k| contacts.grip(k).direction::<f64>().is_none())
            {
                continue;
            }
            let rates = grasp.rates[0];
            let small = |k: usize| rates[k].abs() <= number(CLOSED) * least[k];
            if contacts.grip(own.start) == Grip::Backwards || own.clone().all(small) {
                own.for_each(|k| (begins[k], resting.grips[k]) = (true, Grip::Sticks));
            } else {
                let size = norm(&rates[own.clone()]);
                own.for_each(|k| grasp.aims[k] = rates[k] / size);
            }
        }
        if !begins.contains(&true) {
            return;
        }
        let rows = self.rows(grasp, free, &resting);
        let bound = |k: usize, pushes: &[D::Scalar; L]| {
            let [force, bound] = [0, 1].map(|part| grasp.magnitude(part, k, pushes));
            if begins[k] { force } else { force.max(bound) }
        };
        // Without forces that fulfil all laws, the modes are decided before, and end the run.
        let Some([forces, _]) = rows.swept(grasp, bound) else { return };
        let (pushes, (groups, count)) = (rows.pushes(&forces), rows.groups(grasp));
        for own in groups[..count].iter().filter(|own| begins[rows.list[own.start]]) {
            let mut most = grasp.magnitude(0, rows.list[own.start], &pushes);
            let small = |j: usize| {
                let k = rows.list[j];
                grasp.rates[0][k].abs() <= number(CLOSED) * least[k]
            };
            if !own.clone().all(small) {
                most = most.min(norm(&forces[own.clone()]));
            }
            for j in own.clone() {
                // Without a force, any direction will do.
                let other = number(if j == own.start { 1.0 } else { 0.0 });
                let acts = number(0.0) < most;
                grasp.aims[rows.list[j]] = if acts { -forces[j] / most } else { other };
            }
        }
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
        let mut grasp = self.grasp_with(free, contacts);
        let mut decided = self.decided(&grasp, free, contacts)?;
        if const { loads::<D, N>() == 0 } {
            return Ok(decided);
        }
        let mut before = decided;
        for _ in 0..ROUNDS {
            if let Some(k) = grasp.jam {
                return Err(k);
            }
            // What slides changes the loads; the bounds of what slides are those at rest.
            let Grasp { magnitudes: [forces, bounds], jam, .. } = self.grasp_with(free, &decided);
            let sticks = |k: usize| decided.grip(k) == Grip::Sticks;
            let bounds = grasp.each(|k| if sticks(k) { bounds[k] } else { grasp.magnitudes[1][k] });
            (grasp.magnitudes, grasp.jam) = ([forces, bounds], jam);
            let next = self.decided(&grasp, free, contacts)?;
            if next == decided && jam.is_none() {
                return Ok(decided);
            }
            if next == before && jam.is_none() {
                // The loads decide what rounding errors leave open: it sticks until it is more.
                let sticking =
                    |own: &Contacts| own.grips.iter().filter(|g| **g == Grip::Sticks).count();
                let sticks = sticking(&decided) < sticking(&next);
                return Ok(if sticks { next } else { decided });
            }
            (before, decided) = (decided, next);
        }
        Err(grasp.blame(contacts))
    }

    /// Returns the same at given magnitudes.
    fn decided(
        &self,
        grasp: &Grasp<D::Scalar, N>,
        free: &[D::Scalar; N],
        contacts: &Contacts,
    ) -> Result<Contacts, usize> {
        let number = D::Scalar::from_f64;
        if contacts.touching() == 0
            && let Some(grips) = self.settled(grasp, free, contacts)
        {
            return Ok(contacts.with(grips));
        }
        let rows = self.rows(grasp, free, contacts);
        let (groups, count) = rows.groups(grasp);
        let mut decided = *contacts;
        // Frictions that break away, and those with the bound F in place of S.
        let mut moved = [false; F];
        let mut kinetic: [bool; F] =
            core::array::from_fn(|k| grasp.magnitudes[1][k] <= grasp.magnitudes[0][k]);
        for _ in 0..4 * F {
            let part = |k: usize| usize::from(!(moved[k] || kinetic[k]));
            let found = if const { has_vectors::<D, N>() } {
                rows.swept(grasp, |k, pushes| grasp.magnitude(part(k), k, pushes))
            } else {
                rows.pivoted(grasp, part)
            };
            let [forces, rates] = found.ok_or_else(|| grasp.blame(contacts))?;
            let mut sizes = self.bound();
            for i in 0..N {
                sizes[i] += free[i].abs() + (rows.base[i] - free[i]).abs();
                for j in 0..rows.count {
                    sizes[i] += (forces[j] * rows.changes[j][i]).abs();
                }
            }
            let pushes = rows.pushes(&forces);
            let (before, noise) = ((moved, kinetic), number(64.0) * D::Scalar::EPSILON);
            for own in &groups[..count] {
                let k = rows.list[own.start];
                let ([rate, ..], length) = (&rates[own.clone()], norm(&rates[own.clone()])) else {
                    continue;
                };
                let size = |j: usize| {
                    let k = rows.list[j];
                    grasp.size(k, grasp.rates[1][k], &sizes)
                };
                let least = own.clone().map(size).fold(number(0.0), D::Scalar::max);
                let moves = noise * least < length;
                let forwards = own.len() == 1 && number(0.0) < *rate;
                let grip = if moves { Grip::sliding(forwards) } else { Grip::Sticks };
                let [force, bound] = [0, 1].map(|part| grasp.magnitude(part, k, &pushes));
                for k in own.clone().map(|j| rows.list[j]) {
                    decided.grips[k] = grip;
                    kinetic[k] = bound <= force;
                    moved[k] |= moves && kinetic[k] == before.1[k];
                }
            }
            if (moved, kinetic) == before {
                break;
            }
        }
        Ok(decided)
    }
}
