//! Impacts with dry friction, along the path of impulses.
//!
//! The time of an impact is the impulse p of its limit. Let x be the rate of the gap, then those of
//! the frictions on the limit. They change by dx/dp = G y, where y = (1, φ) and G is the effect of
//! impulses on rates. A rate u that slides has φ = −μ u/|u|; one that is zero has the φ that keeps
//! it there, if that is at most its bound, and otherwise leaves zero against φ. So a rate may stop,
//! stick, turn round or change its direction during an impact. Compression ends where the gap's
//! rate is zero. Restitution ends where it has given back the share e² of the work of compression:
//! no impact adds energy.
//!
//! Sources: E. J. Routh, Dynamics of a System of Rigid Bodies I (1905), chapter 5; W. J. Stronge,
//! Proc. R. Soc. Lond. A 431 (1990) 169, for the restitution.

use crate::integrate::field::cone::{Balance, FORCES, group, heads, norm};
use crate::integrate::field::contacts::row;
use crate::integrate::field::load::loads;
use crate::integrate::field::phase::Phase;
use crate::integrate::field::response::{product, solved};
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, MOST_FRICTIONS as F, System};
use core::ops::Range;

/// The rates of an impact: that of the gap and those of the frictions.
const R: usize = F + 1;
/// The steps after which directions turn no more.
const TURNS: usize = 4000;
/// The steps of a path, the last of which are straight.
const STEPS: usize = TURNS + 4 * F;

/// The rounding errors within which two sides are equal.
const LITTLE: f64 = 8.0;

/// An impact at a limit with frictions.
struct Impact<T> {
    /// The number of rates.
    count: usize,
    /// The rates of each friction; the others are empty.
    groups: [Range<usize>; F],
    /// The matrix G.
    effects: [[T; R]; R],
    /// The rates before the impact.
    before: [T; R],
    /// The rounding errors of the rates of each friction.
    noise: [T; F],
    /// The factors of the limit's impulse in that of each friction that slides, and in its bound.
    shares: [[T; F]; 2],
}

/// What an impact has done: the impulses, the rates, and ∫ n dp for the rate n of the gap. The rates
/// are more precise than `before` and the effects of the impulses would be, as they become zero.
#[derive(Clone, Copy)]
struct Progress<T> {
    impulses: [T; R],
    rates: [T; R],
    work: T,
}

/// How a rate slides on while the impulses keep their directions.
struct Way<T> {
    /// The lengths of the rate and of its change.
    size: T,
    change: T,
    /// The impulse of the limit in which the rate becomes zero; infinite if it does not.
    stop: T,
    /// The impulse of the limit in which it turns by 1; infinite if it does not turn.
    turn: T,
}

impl<T: Float> Progress<T> {
    fn plus(self, factor: T, rate: &Self) -> Self {
        let sum = |a: [T; R], b: [T; R]| core::array::from_fn(|i| a[i] + factor * b[i]);
        Self {
            impulses: sum(self.impulses, rate.impulses),
            rates: sum(self.rates, rate.rates),
            work: self.work + factor * rate.work,
        }
    }
}

impl<T: Float> Impact<T> {
    /// Returns the frictions that are there.
    fn frictions(&self) -> impl Iterator<Item = usize> {
        (0..F).take_while(|k| !self.groups[*k].is_empty())
    }

    /// Returns the effects of impulses on the rates.
    fn changes(&self, impulses: &[T; R]) -> [T; R] {
        let zero = T::from_f64(0.0);
        core::array::from_fn(|i| {
            (0..self.count).fold(zero, |sum, j| sum + self.effects[i][j] * impulses[j])
        })
    }

    /// Returns y. Rates that `rest` are zero, or leave it.
    fn law(&self, rates: &[T; R], rest: &[bool; F]) -> [T; R] {
        let zero = T::from_f64(0.0);
        let mut law = [zero; R];
        law[0] = T::from_f64(1.0);
        for k in self.frictions().filter(|k| !rest[*k]) {
            let own = self.groups[k].clone();
            let size = norm(&rates[own.clone()]);
            own.filter(|_| zero < size).for_each(|i| law[i] = -self.shares[0][k] * rates[i] / size);
        }
        let resting = self.frictions().filter(|k| rest[*k]);
        let (mut groups, mut of, mut number) = ([const { 0..0 }; F], [0; R], 0);
        for k in resting {
            groups[number] = self.groups[k].clone();
            of[self.groups[k].start] = k;
            number += 1;
        }
        if number == 0 {
            return law;
        }
        let mut balance = Balance {
            limits: 0,
            count: self.count,
            matrix: [[zero; FORCES]; FORCES],
            rates: [zero; FORCES],
        };
        balance.rates[..R].copy_from_slice(&self.changes(&law));
        for (to, from) in balance.matrix.iter_mut().zip(&self.effects) {
            to[..R].copy_from_slice(from);
        }
        // Those that the greater bound does not hold slide.
        let mut slides = [false; F];
        for _ in 0..=number {
            let bound = |k: usize| {
                let [force, most] = [0, 1].map(|part| self.shares[part][k]);
                if slides[k] { force } else { force.max(most) }
            };
            let Some(forces) = balance.solve(&groups[..number], |i, _| bound(of[i])) else { break };
            let least = T::from_f64(1.0) - T::EPSILON.sqrt();
            let slips = |own: &&Range<usize>| {
                let (k, force) = (of[own.start], norm(&forces[(*own).clone()]));
                self.shares[0][k] < bound(k) && least * bound(k) <= force
            };
            if let Some(own) = groups[..number].iter().find(slips) {
                slides[of[own.start]] = true;
            } else {
                (0..R).for_each(|i| law[i] += forces[i]);
                break;
            }
        }
        law
    }

    /// Returns the changes for a unit of the limit's impulse.
    fn rate(&self, progress: &Progress<T>, rest: &[bool; F]) -> Progress<T> {
        let impulses = self.law(&progress.rates, rest);
        Progress { impulses, rates: self.changes(&impulses), work: progress.rates[0] }
    }

    /// Returns what follows from `progress`, whose changes are `first`, after the impulse `step`, by
    /// the method of Kutta.
    fn step(
        &self,
        progress: &Progress<T>,
        first: &Progress<T>,
        rest: &[bool; F],
        step: T,
    ) -> Progress<T> {
        let number = T::from_f64;
        let half = number(0.5) * step;
        let second = self.rate(&progress.plus(half, first), rest);
        let third = self.rate(&progress.plus(half, &second), rest);
        let fourth = self.rate(&progress.plus(step, &third), rest);
        let [side, middle] = [step / number(6.0), step / number(3.0)];
        progress.plus(side, first).plus(middle, &second).plus(middle, &third).plus(side, &fourth)
    }

    /// Returns how a friction slides on, given the rates and their changes.
    ///
    /// Before it stops, a rate may turn by what impulses of the size 1/ε times `total` do not show.
    fn way(&self, k: usize, rates: &[T; R], changes: &[T; R], total: T) -> Way<T> {
        let (zero, infinity) = (T::from_f64(0.0), T::from_f64(f64::INFINITY));
        let own = self.groups[k].clone();
        let (rate, part) = (&rates[own.clone()], &changes[own]);
        let (size, change) = (norm(rate), norm(part));
        let along = rate.iter().zip(part).fold(zero, |sum, (u, f)| sum + *u * *f) / size;
        let mut across = [zero; 3];
        for i in 0..rate.len() {
            across[i] = part[i] - along * rate[i] / size;
        }
        let across = norm(&across);
        let stop = if along < zero { -size / along } else { infinity };
        let turns = T::from_f64(LITTLE) * T::EPSILON * change < across
            && (zero <= along || total * change < across * stop);
        Way { size, change, stop, turn: if turns { size / across } else { infinity } }
    }

    /// Returns the impulses of an impact with the coefficient of restitution e.
    fn impulses(&self, e: T) -> [T; R] {
        let number = T::from_f64;
        let (zero, half, infinity) = (number(0.0), number(0.5), number(f64::INFINITY));
        let little = number(LITTLE) * T::EPSILON;
        let root = T::EPSILON.sqrt().sqrt().sqrt();
        let (fine, coarse) = (T::EPSILON.sqrt() * root, root * root * root);
        let mut progress = Progress { impulses: [zero; R], rates: self.before, work: zero };
        // The work at the end of restitution, once compression has ended.
        let mut goal = None;
        let mut pace = infinity;
        for count in 0..STEPS {
            let mut rest = [false; F];
            for k in self.frictions() {
                let own = &mut progress.rates[self.groups[k].clone()];
                rest[k] = norm(own) <= self.noise[k];
                own.iter_mut().filter(|_| rest[k]).for_each(|rate| *rate = zero);
            }
            let speed = progress.rates[0];
            if goal.is_none() && speed.abs() <= -little * self.before[0] {
                goal = Some((number(1.0) - e * e) * progress.work);
            }
            let first = self.rate(&progress, &rest);
            let rise = first.rates[0];
            let end = match goal {
                None if zero < rise => -speed / rise,
                None => infinity,
                Some(goal) => {
                    let left = goal - progress.work;
                    let square = speed * speed + number(2.0) * rise * left;
                    if left.abs() <= -little * progress.work || square <= zero {
                        break;
                    }
                    number(2.0) * left / (speed + square.sqrt())
                }
            };
            // The impulses in which the next rate becomes zero, and in which one turns by 1.
            let (mut stop, mut turn) = (infinity, infinity);
            let total = T::EPSILON * norm(&progress.impulses[..self.count]);
            for k in self.frictions().filter(|k| !rest[*k]) {
                let way = self.way(k, &progress.rates, &first.rates, total);
                (stop, turn) = (stop.min(way.stop), turn.min(way.turn));
            }
            if TURNS <= count || turn == infinity {
                let length = end.min(stop);
                if length == infinity {
                    break;
                }
                let straight = Progress { work: speed + half * length * rise, ..first };
                progress = progress.plus(length, &straight);
                continue;
            }
            let mut length = end.min(half * stop).min(half * turn).min(pace);
            progress = loop {
                let whole = self.step(&progress, &first, &rest, length);
                let part = self.step(&progress, &first, &rest, half * length);
                let second = self.rate(&part, &rest);
                let both = self.step(&part, &second, &rest, half * length);
                // The error of a rate that turns, in what its direction allows.
                let mut error = zero;
                for k in self.frictions().filter(|k| !rest[*k]) {
                    let way = self.way(k, &progress.rates, &first.rates, total);
                    if way.turn < infinity {
                        let mut difference = [zero; 3];
                        for (part, i) in difference.iter_mut().zip(self.groups[k].clone()) {
                            *part = both.rates[i] - whole.rates[i];
                        }
                        let allowed = fine.max(total * way.change / way.size).min(coarse);
                        error = error.max(norm(&difference) / (way.size * allowed));
                    }
                }
                let ratio = half / error;
                pace = length.abs() * ratio.sqrt().sqrt().max(number(0.2)).min(number(4.0));
                if number(1.0) < error {
                    length = half * length;
                    continue;
                }
                break both.plus(number(1.0 / 15.0), &both.plus(-number(1.0), &whole));
            };
        }
        progress.impulses
    }
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Phase<'_, D, N> {
    /// Returns the impulse of a limit that closes with `rate` and rebounds with `restitution`, and
    /// the change of the velocities: with the impulses of the frictions on the limit.
    ///
    /// # Errors
    /// Returns a friction that the impulses of constraints press.
    pub(crate) fn strike(
        &self,
        limit: usize,
        rate: D::Scalar,
        restitution: D::Scalar,
    ) -> Result<(D::Scalar, [D::Scalar; N]), usize> {
        let number = D::Scalar::from_f64;
        let (zero, one) = (number(0.0), number(1.0));
        let normal = row(&self.normals(), limit);
        let response = self.response(&normal);
        let grasp = self.grasp();
        let noise = grasp.rounding(self.v, &self.sizes()[1]);
        let mut impact = Impact {
            count: 1,
            groups: [const { 0..0 }; F],
            effects: [[zero; R]; R],
            before: [zero; R],
            noise: [zero; F],
            shares: [[zero; F]; 2],
        };
        let (mut rows, mut responses) = ([normal; R], [response; R]);
        impact.before[0] = rate;
        let on = heads(grasp.facts).filter(|k| grasp.is_shared(*k, limit));
        for (place, head) in on.enumerate() {
            let (own, start) = (group(grasp.facts, head), impact.count);
            for part in 0..2 {
                impact.shares[part][place] = grasp.share(part, head, limit).max(zero);
            }
            impact.noise[place] = number(LITTLE) * norm(&noise[own.clone()]);
            for k in own {
                rows[impact.count] = row(&grasp.rows, k);
                responses[impact.count] = grasp.changes[k];
                impact.before[impact.count] = grasp.rates[0][k];
                impact.count += 1;
            }
            impact.groups[place] = start..impact.count;
        }
        let count = impact.count;
        for i in 0..count {
            for j in 0..count {
                impact.effects[i][j] = product(&rows[i], &responses[j]);
            }
        }
        let mut impulses = [zero; R];
        if count == 1 {
            impulses[0] = -(one + restitution) * rate / impact.effects[0][0];
        } else {
            impulses = impact.impulses(restitution);
        }
        let change = core::array::from_fn(|j| {
            (0..count).fold(zero, |sum, i| sum + impulses[i] * responses[i][j])
        });
        if const { 0 < loads::<D, N>() } {
            let sum = |j: usize| (0..count).fold(zero, |sum, i| sum + impulses[i] * rows[i][j]);
            let masses = self.dynamics.system().mass_matrix(self.at(&self.momentum_inputs()));
            let free = solved(masses, core::array::from_fn(sum));
            if let Some(friction) = self.knocked(&free, |_| zero) {
                return Err(friction);
            }
        }
        Ok((impulses[0], change))
    }
}
