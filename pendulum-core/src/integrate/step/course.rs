//! A step in which dry frictions may change: their rates and forces at places within it.

use crate::error::Error;
use crate::integrate::events::root;
use crate::integrate::field::cone::{group, heads, norm};
use crate::integrate::field::contacts::{CLOSED, Contacts, limits};
use crate::integrate::field::grasp::{Grip, Rubbed, frictions};
use crate::integrate::field::load::loads;
use crate::integrate::field::phase::Phase;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::step::frictions::{BREAKS, decide, name};
use crate::integrate::step::meeting::{
    FINEST, HALVINGS, Meeting, Met, PARTS, Place, dip, falling, place,
};
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::{Dynamics, MOST_FRICTIONS as F, Purpose, System};
use crate::time::Time;

/// The frictions at a place within a step.
pub(super) struct Sight<T> {
    theta: f64,
    /// The rates.
    rates: [T; F],
    rubbed: Rubbed<T>,
}

impl<T: Float> Sight<T> {
    /// Returns the rate of a friction that slides in the direction `s`, above `least`.
    fn place(&self, friction: usize, s: f64, least: f64) -> Place {
        let (rate, second) = (self.rates[friction].to_f64(), self.rubbed.rates[friction].to_f64());
        Place { theta: self.theta, gap: s * rate - least, rate: s * second }
    }
}

/// A step in which frictions may change, with the limits in contact and the modes `held`.
pub(super) struct Course<'a, D: Dynamics<N>, A, const N: usize> {
    pub(super) held: &'a Contacts,
    pub(super) dynamics: &'a D,
    pub(super) interpolant: &'a Interpolant<D::Scalar, N>,
    pub(super) end: &'a Endpoint<D::Scalar, N>,
    pub(super) side: Side,
    /// The accelerations without contacts and frictions.
    pub(super) free: A,
}

impl<T, D, A, const N: usize> Course<'_, D, A, N>
where
    T: Float,
    D: Dynamics<N, Scalar = T>,
    A: Fn(Time, &[T; N], &[T; N]) -> [T; N],
{
    /// Returns the place between two where the rate of a vector that leaves zero has left the
    /// direction of its acceleration by more than `allowed`, or the latter place, if it is the
    /// `last` one and the direction of the rate changes slowly enough for a step.
    pub(super) fn leaves(
        &self,
        [from, to]: [f64; 2],
        last: bool,
        allowed: &impl Fn(usize, T) -> f64,
    ) -> Option<Meeting> {
        let facts = <D::System as System<N>>::FACTS.frictions;
        let leaving =
            |k: &usize| facts[*k].components != 1 && self.held.grip(*k) == Grip::Backwards;
        let mut first: Option<f64> = None;
        for k in heads(facts).filter(leaving) {
            let own = group(facts, k);
            // How far the rate has left the direction, beyond a tenth of what is allowed, the
            // rate, and the change of its rate per unit of force.
            let aside = |theta: f64| {
                self.at(theta, |phase| {
                    let grasp = phase.grasp_with(&self.free(phase), self.held);
                    let zero = T::from_f64(0.0);
                    let aim = |k: usize| grasp.direction(self.held, k).unwrap_or(zero);
                    let rate = |k: usize| grasp.rates[0][k];
                    let along = own.clone().fold(zero, |sum, k| sum + aim(k) * rate(k));
                    let (mut aside, mut most, mut response) = ([zero; 3], 0.0, zero);
                    for (part, k) in aside.iter_mut().zip(own.clone()) {
                        *part = rate(k) - along * aim(k);
                        most += grasp.allowed(k, phase.v, allowed);
                        response = response.max(grasp.entry(k, k));
                    }
                    (norm(&aside).to_f64() - 0.1 * most, along, response)
                })
            };
            let (beyond, along, response) = aside(to);
            let slow = || {
                let force = self.look(to).map(|sight| norm(&sight.rubbed.forces[own.clone()]));
                let h = T::from_f64(self.interpolant.interval.h);
                force.is_ok_and(|force| force * response * h < along)
            };
            let place = if 0.0 < beyond {
                Some(falling(|theta| -aside(theta).0, from, to, 0.0))
            } else {
                (last && slow()).then_some(to)
            };
            first = match (first, place) {
                (Some(a), Some(b)) => Some(f64::min(a, b)),
                (a, b) => a.or(b),
            };
        }
        first.map(|theta| Meeting { theta, what: Met::Turns })
    }

    fn at<R>(&self, theta: f64, what: impl FnOnce(&Phase<'_, D, N>) -> R) -> R {
        let (t, q, v) = place(self.interpolant, self.end, theta);
        what(&Phase { dynamics: self.dynamics, t, side: self.side, q: &q, v: &v })
    }

    fn free(&self, phase: &Phase<'_, D, N>) -> [T; N] {
        (self.free)(phase.t, phase.q, phase.v)
    }

    /// Returns how far the force of a friction that sticks is below its bound.
    fn margin(sight: &Sight<T>, friction: usize) -> T {
        let Rubbed { forces, bounds, .. } = &sight.rubbed;
        let noise = T::from_f64(BREAKS) * T::EPSILON * bounds[friction];
        let own = group(<D::System as System<N>>::FACTS.frictions, friction);
        bounds[friction] + noise - norm(&forces[own])
    }

    /// Returns the magnitudes below which the rates at the start count as zero.
    pub(super) fn flat(&self) -> [f64; F] {
        let least = self.at(0.0, |phase| phase.grasp().rounding(phase.v, &phase.sizes()[1]));
        least.map(|least| CLOSED * least.to_f64())
    }

    /// Returns the rates.
    ///
    /// # Errors
    /// Returns an error for a negative magnitude.
    pub(super) fn rates(&self, theta: f64) -> Result<[T; F], Error> {
        self.at(theta, |phase| {
            let inputs = phase.inputs(Purpose::Accelerations);
            let (system, at) = (self.dynamics.system(), phase.at(&inputs));
            let magnitudes = system.grips(at);
            let columns = const { limits::<D, N>() + loads::<D, N>() };
            let shares = (0 < columns).then(|| system.grip_shares(at));
            for k in 0..frictions::<D, N>() {
                let shares = shares.iter().flatten();
                let shares = shares.flat_map(|part| (0..columns).map(move |i| part[(k, i)]));
                let sizes = magnitudes.iter().map(|part| part[k]).chain(shares);
                if let Some(value) = sizes.into_iter().find(|value| *value < T::from_f64(0.0)) {
                    let (t, friction) = (phase.t.to_f64(), name::<D, N>(k));
                    return Err(Error::NegativeFriction { t, friction, value: value.to_f64() });
                }
            }
            if const { 0 < loads::<D, N>() }
                && let Some(k) = phase.grasp_with(&self.free(phase), self.held).jam
            {
                return Err(Error::NoGrip { t: phase.t.to_f64(), friction: name::<D, N>(k) });
            }
            let [rates, _] = system.slips(at);
            Ok(rates)
        })
    }

    /// Returns the rates and forces.
    ///
    /// # Errors
    /// Returns an error for a friction whose contact has no force that keeps it closed.
    pub(super) fn look(&self, theta: f64) -> Result<Sight<T>, Error> {
        self.at(theta, |phase| {
            let free = self.free(phase);
            let grasp = phase.grasp_with(&free, self.held);
            let push = phase.push_with(Some(&grasp), &free, self.held, false);
            let rubbed = phase.rubbed(&grasp, &free, self.held, &push);
            match rubbed.jam.or(grasp.jam) {
                Some(k) => Err(Error::NoGrip { t: phase.t.to_f64(), friction: name::<D, N>(k) }),
                None => Ok(Sight { theta, rates: grasp.rates[0], rubbed }),
            }
        })
    }

    /// Returns the rate of a friction; not a number where there is an error.
    fn rate(&self, theta: f64, friction: usize) -> f64 {
        self.rates(theta).map_or(f64::NAN, |rates| rates[friction].to_f64())
    }

    /// Returns a place in a part of the step where the rate of a friction that slides in the
    /// direction `s` is below `least`, if it turns there; otherwise `None`. Before that place, the
    /// rate falls below `least` once.
    ///
    /// `rates` are those at the ends of all parts, and `bend` how far they are from lines. The
    /// polynomial through them is searched, since it costs nothing, if the rate in the middle of
    /// the part lies on it, as it does where the coefficients of the velocities are constant.
    pub(super) fn dips(
        &self,
        friction: usize,
        (s, least): (f64, f64),
        part: usize,
        theta: impl Fn(f64) -> f64,
        (rates, bend): (&[f64; PARTS + 1], f64),
    ) -> Option<f64> {
        let terms = divided(rates);
        let on = |part: f64| {
            let [rate, slope] = newton(&terms, part);
            Place { theta: part, gap: s * rate - least, rate: s * slope }
        };
        let (from, to) = ((part - 1) as f64, part as f64);
        let middle = from + 0.5;
        let off = (self.rate(theta(middle), friction) - newton(&terms, middle)[0]).abs();
        let size = rates.iter().fold(0.0, |most, rate| f64::max(most, rate.abs()));
        if off <= 1e-6 * bend + 64.0 * f64::EPSILON * size {
            let low = theta(dip(&on, on(from), on(to), 1.0, FINEST)?);
            return (s * self.rate(low, friction) < least).then_some(low);
        }
        let on = |theta: f64| match self.look(theta) {
            Ok(sight) => sight.place(friction, s, least),
            Err(_) => Place { theta, gap: f64::NAN, rate: f64::NAN },
        };
        dip(&on, on(theta(from)), on(theta(to)), self.interpolant.interval.h, FINEST)
    }

    /// Returns the first place between two where the rate of a friction that slides in the
    /// direction `s` falls below `least`, as it is at the latter.
    pub(super) fn stops(&self, friction: usize, s: f64, least: f64, [from, to]: [f64; 2]) -> f64 {
        let gap = |theta: f64| s * self.rate(theta, friction) - least;
        let (before, after) = (gap(from), gap(to));
        if !(0.0 < before && after < 0.0) {
            return falling(gap, from, to, 0.0);
        }
        let mut below = to;
        let mut tracked = |theta: f64| {
            let gap = gap(theta);
            below = if gap <= 0.0 { f64::min(below, theta) } else { below };
            Ok::<_, Error>(gap)
        };
        // The function has no errors.
        let _ = root::root(&mut tracked, (from, before), (to, after));
        below
    }

    /// Returns the first components of the frictions that stick.
    fn sticking(&self) -> impl Iterator<Item = usize> {
        let heads = heads(<D::System as System<N>>::FACTS.frictions);
        heads.filter(|k| self.held.grip(*k) == Grip::Sticks)
    }

    /// Returns the friction that breaks away most at a place, if any does.
    ///
    /// # Errors
    /// As [`Frictions::watch`](crate::integrate::step::frictions::Frictions::watch).
    pub(super) fn broken(&self, sight: &Sight<T>) -> Result<Option<Meeting>, Error> {
        if !self.sticking().any(|k| Self::margin(sight, k) < T::from_f64(0.0)) {
            return Ok(None);
        }
        let theta = sight.theta;
        let decided = self.at(theta, |phase| decide(phase, &self.free(phase), self.held))?;
        let moving = self.sticking().filter(|k| decided.grip(*k) != Grip::Sticks);
        let most = |a: usize, b: usize| {
            if Self::margin(sight, b) < Self::margin(sight, a) { b } else { a }
        };
        Ok(moving.reduce(most).map(|friction| {
            let forwards = decided.grip(friction) == Grip::Forwards;
            Meeting { theta, what: Met::Breaks { friction, forwards } }
        }))
    }

    /// Returns the first place between the last two at which a friction breaks away, or between all
    /// three if its force is above the bound only between them. The `edges` of the step are the first
    /// and the last one.
    ///
    /// # Errors
    /// As [`broken`](Self::broken).
    pub(super) fn breaks(
        &self,
        earlier: Option<&Sight<T>>,
        last: &Sight<T>,
        here: &Sight<T>,
        edges: [bool; 2],
    ) -> Result<Option<Meeting>, Error> {
        if let Some(beyond) = self.broken(here)? {
            return self.breaks_between(last.theta, beyond).map(Some);
        }
        let Some(earlier) = earlier else { return Ok(None) };
        let mut first: Option<Meeting> = None;
        for k in self.sticking() {
            let points = [earlier, last, here]
                .map(|sight| (T::from_f64(sight.theta), Self::margin(sight, k)));
            let mut margin =
                |theta: T| self.look(theta.to_f64()).map(|sight| Self::margin(&sight, k));
            if let Some(low) = root::hidden_dip(&mut margin, points, edges)?
                && let Some(beyond) = self.broken(&self.look(low.to_f64())?)?
            {
                let found = self.breaks_between(earlier.theta, beyond)?;
                if first.is_none_or(|first| found.theta < first.theta) {
                    first = Some(found);
                }
            }
        }
        Ok(first)
    }

    /// Returns the first place between `whole` and `beyond` at which a friction breaks away.
    fn breaks_between(&self, mut whole: f64, beyond: Meeting) -> Result<Meeting, Error> {
        let mut found = beyond;
        let mut low = beyond.theta;
        let mut least = |theta: f64| {
            let sight = self.look(theta)?;
            let least =
                self.sticking().map(|k| Self::margin(&sight, k).to_f64()).fold(f64::MAX, f64::min);
            low = if least <= 0.0 { f64::min(low, theta) } else { low };
            Ok(least)
        };
        let [from, to] = [(whole, least(whole)?), (beyond.theta, least(beyond.theta)?)];
        if 0.0 < from.1 && to.1 < 0.0 {
            root::root(&mut least, from, to)?;
            // Forces above their bounds move what they exceed only if no others take them over,
            // and if this is more than rounding: mostly there, or as soon as it is more.
            let mut ahead = 0.0;
            while low + ahead < found.theta {
                let theta = low + ahead;
                match self.broken(&self.look(theta)?)? {
                    Some(meeting) if ahead == 0.0 => return Ok(meeting),
                    Some(meeting) => found = meeting,
                    None => whole = theta,
                }
                ahead = if ahead == 0.0 { f64::EPSILON * low } else { 4.0 * ahead };
            }
        }
        for _ in 0..HALVINGS {
            let middle = whole + 0.5 * (found.theta - whole);
            if middle <= whole || found.theta <= middle {
                break;
            }
            match self.broken(&self.look(middle)?)? {
                Some(earlier) => found = earlier,
                None => whole = middle,
            }
        }
        Ok(found)
    }
}

/// Returns the divided differences of values at 0, 1, 2 and so on.
fn divided(values: &[f64; PARTS + 1]) -> [f64; PARTS + 1] {
    let mut terms = *values;
    for order in 1..=PARTS {
        for k in (order..=PARTS).rev() {
            terms[k] = (terms[k] - terms[k - 1]) / order as f64;
        }
    }
    terms
}

/// Returns the value and the slope of Newton's polynomial with these divided differences.
fn newton(terms: &[f64; PARTS + 1], x: f64) -> [f64; 2] {
    let (mut value, mut slope) = (terms[PARTS], 0.0);
    for k in (0..PARTS).rev() {
        slope = slope * (x - k as f64) + value;
        value = value * (x - k as f64) + terms[k];
    }
    [value, slope]
}

#[cfg(test)]
mod tests {
    use super::{divided, newton};

    #[test]
    fn a_polynomial_through_nine_values_has_their_slope() {
        let cubic = |x: f64| 1.0 - 2.0 * x + x * x * (0.5 - 0.125 * x);
        let terms = divided(&core::array::from_fn(|k| cubic(k as f64)));
        for x in [0.0, 0.3, 1.5, 4.0, 7.9] {
            let [value, slope] = newton(&terms, x);
            assert!((value - cubic(x)).abs() < 1e-12, "{value}");
            assert!((slope - (x - 2.0 - 0.375 * x * x)).abs() < 1e-11, "{slope}");
        }
    }
}
