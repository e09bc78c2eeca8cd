//! States on limits: projections onto those in contact, and the room that limits leave.

use crate::error::Error;
use crate::integrate::field::contacts::{self, Contacts, limits};
use crate::integrate::field::grasp::has_frictions;
use crate::integrate::field::phase::Phase;
use crate::integrate::field::response::product;
use crate::integrate::state::State;
use crate::integrate::state::compensated::Compensated;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::step::frictions::slides;
use crate::integrate::step::projection;
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, Limit, MOST_LIMITS as L, System, is_constrained};
use crate::time::Time;

/// Returns a limit by its index.
pub(super) fn facts<D: Dynamics<N>, const N: usize>(limit: usize) -> Limit {
    <D::System as System<N>>::FACTS.limits[limit]
}

/// Returns the gaps, and the depths below zero up to which they count as zero: the same tolerance as
/// for the constraints at a start.
pub(super) fn depths<D: Dynamics<N, Scalar: Float>, const N: usize>(
    phase: &Phase<'_, D, N>,
) -> [[D::Scalar; L]; 2] {
    let ([gaps, ..], [least, _]) = (phase.gaps(), phase.rounding());
    let part = D::Scalar::from_f64(D::Scalar::EPSILON.to_f64().cbrt().recip());
    [gaps, least.map(|least| part * least)]
}

/// Returns the error for a limit that closes although those in contact stop it: one of them, that
/// which a force of the limit would close most, is against it.
pub(super) fn no_room<D: Dynamics<N, Scalar: Float>, const N: usize>(
    phase: &Phase<'_, D, N>,
    limit: usize,
    contacts: &Contacts,
) -> Error {
    let normals = phase.normals();
    let change = phase.response(&contacts::row(&normals, limit));
    let mut other: Option<(usize, f64)> = None;
    for i in (0..limits::<D, N>()).filter(|i| contacts.has(*i)) {
        let normal = contacts::row(&normals, i);
        let own = product(&normal, &phase.response(&normal));
        let closing = (product(&normal, &change) / own.sqrt()).to_f64();
        if closing < other.map_or(0.0, |(_, most)| most) {
            other = Some((i, closing));
        }
    }
    let name = |i: usize| facts::<D, N>(i).name;
    Error::NoRoom { t: phase.t.to_f64(), limit: name(limit), other: other.map(|(i, _)| name(i)) }
}

/// Slows down the closing of a gap after the state has been lifted by `lift` to a gap of zero. What
/// the lift has added to the energy against the accelerations `free` is taken from the motion, so
/// that the limit is met with the velocity that it would have been met with at a gap of zero.
pub(super) fn give_back<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    endpoint: &mut Endpoint<D::Scalar, N>,
    side: Side,
    free: &[D::Scalar; N],
    limit: usize,
    lift: D::Scalar,
) {
    let zero = D::Scalar::from_f64(0.0);
    let phase = endpoint.phase(dynamics, side);
    let [_, rates, second] = phase.gaps();
    let normal = contacts::row(&phase.normals(), limit);
    let (rate, fall) = (rates[limit], -(second[limit] + product(&normal, free)));
    if rate < zero && zero < fall {
        let squared = rate * rate - D::Scalar::from_f64(2.0) * fall * lift;
        let slower = if zero < squared { -squared.sqrt() } else { zero };
        let change = phase.response(&normal);
        endpoint.v.add((slower - rate) / product(&normal, &change), &change);
        endpoint.a = None;
    }
}

/// Projects a state onto the constraints.
pub(super) fn project<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    endpoint: &mut Endpoint<D::Scalar, N>,
    side: Side,
) {
    if const { is_constrained::<D, N>() } {
        projection::project(dynamics, endpoint.t, side, &mut endpoint.q, &mut endpoint.v);
        endpoint.a = None;
    }
}

/// Moves coordinates onto the limits in contact, and sets the rates of their gaps to zero if
/// `rates` is `true`.
pub(super) fn project_onto_contacts<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    endpoint: &mut Endpoint<D::Scalar, N>,
    side: Side,
    contacts: &Contacts,
    rates: bool,
) {
    let zero = D::Scalar::from_f64(0.0);
    for part in 0..if rates { 2 } else { 1 } {
        // The largest terms of each sum.
        let mut terms = [zero; N];
        // From the end of a step, Newton's method converges to rounding in two iterations.
        for _ in 0..3 {
            let phase = endpoint.phase(dynamics, side);
            let (values, least) = (phase.gaps()[part], phase.rounding()[part]);
            let off = |i: usize| contacts.has(i) && least[i] < values[i].abs();
            let sliding =
                const { has_frictions::<D, N>() } && part == 1 && slides(&phase, contacts);
            if !sliding && !(0..limits::<D, N>()).any(off) {
                break;
            }
            let change = if const { has_frictions::<D, N>() } && part == 1 {
                phase.settle(contacts, &values)
            } else {
                phase.shift(contacts, &values)
            };
            let sums = if part == 0 { &mut endpoint.q } else { &mut endpoint.v };
            for j in 0..N {
                for term in [sums.high[j].abs(), change[j].abs()] {
                    terms[j] = if terms[j] < term { term } else { terms[j] };
                }
            }
            sums.add(D::Scalar::from_f64(-1.0), &change);
            endpoint.a = None;
        }
        // What is left of a velocity that the limits end is a rounding error. Corrected again and
        // again, it would become the smallest of numbers, never zero.
        for j in (0..N).filter(|_| part == 1) {
            let least = D::Scalar::from_f64(8.0) * D::Scalar::EPSILON * terms[j];
            if endpoint.v.high[j].abs() < least {
                (endpoint.v.high[j], endpoint.v.low[j]) = (zero, zero);
            }
        }
    }
}

/// Moves the end of a step onto the limits in contact and the constraints.
pub(crate) fn project_end<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    endpoint: &mut Endpoint<D::Scalar, N>,
    side: Side,
    contacts: &Contacts,
) {
    project_onto_contacts(dynamics, endpoint, side, contacts, true);
    if const { is_constrained::<D, N>() } {
        project(dynamics, endpoint, side);
        project_onto_contacts(dynamics, endpoint, side, contacts, true);
    }
}

/// Returns `true` if limits may move. Limits at rest keep the room that they had at the start.
pub(super) const fn may_move<D: Dynamics<N>, const N: usize>() -> bool {
    let facts = &<D::System as System<N>>::FACTS;
    facts.explicit_time || !facts.inputs.is_empty()
}

/// Checks that a state moved onto the limits `held` fulfils all of them.
///
/// # Errors
/// Returns [`Error::NoRoom`] if it does not.
pub(crate) fn check_room<D: Dynamics<N, Scalar: Float>, const N: usize>(
    phase: &Phase<'_, D, N>,
    held: &Contacts,
) -> Result<(), Error> {
    if !may_move::<D, N>() || held.touching() < 2 {
        return Ok(());
    }
    let [gaps, least] = depths(phase);
    if (0..limits::<D, N>()).all(|i| !held.has(i) || -least[i] <= gaps[i]) {
        return Ok(());
    }
    // What another projection would mend is a rounding error of coordinates about zero.
    let (normals, change) = (phase.normals(), phase.shift(held, &gaps));
    let left = |i: usize| gaps[i] - product(&contacts::row(&normals, i), &change);
    let mut deepest = (D::Scalar::from_f64(0.0), D::Scalar::from_f64(0.0));
    let mut limit = None;
    for i in (0..limits::<D, N>()).filter(|i| held.has(*i)) {
        let left = left(i);
        if gaps[i] < deepest.0 {
            deepest.0 = gaps[i];
        }
        if left < deepest.1 && left < -least[i] {
            (deepest.1, limit) = (left, Some(i));
        }
    }
    match limit {
        Some(limit) if deepest.1 + deepest.1 < deepest.0 => Err(no_room(phase, limit, held)),
        _ => Ok(()),
    }
}

/// Moves a state for output onto the limits in contact and the constraints.
pub(crate) fn deliver<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    t: Time,
    side: Side,
    contacts: &Contacts,
    state: &mut State<D::Scalar, N>,
) {
    let (q, v) = (Compensated::new(state.q), Compensated::new(state.v));
    let mut endpoint = Endpoint { t, q, v, a: None };
    project_end(dynamics, &mut endpoint, side, contacts);
    (state.q, state.v) = (endpoint.q.high, endpoint.v.high);
}
