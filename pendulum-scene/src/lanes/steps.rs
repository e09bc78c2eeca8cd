//! The parts of a step, for lanes of any number.
//!
//! All functions are inlined into the code that [`simd`](pendulum_core::simd) compiles for several
//! instruction sets.

#![allow(clippy::inline_always)]

use crate::lanes::equations::Slopes;
use crate::lanes::limits::LaneLimits;
use pendulum_core::integrate::method::Compensated;
use pendulum_core::scalar::{Float, Real};
use pendulum_core::system::{At, System};

/// The square of the largest h² |θ̈| of an angle in a step, in rad². A system that swings as fast as
/// the usual tolerance allows has half a radian at an amplitude of 1.4.
pub(super) const MOST_TURN: f64 = 0.25;

/// A step of RK4.
///
/// Lanes in which the accelerations turn an angle too far in the step become NaN: on a joint that is
/// shaken, a pendulum may be too fast for steps that fit small motions, and would gain energy from
/// nothing. Lanes with stops or damping of their own, whose ticks are not repeated, stay. A
/// coordinate that `may_be_length` is allowed √(1 + q²) times as much as an angle; `None` is not
/// watched.
#[inline(always)]
pub(super) fn runge_kutta<L: Real, const N: usize>(
    h: L,
    slopes: &impl Slopes<L, N>,
    q: &mut Compensated<L, N>,
    v: &mut Compensated<L, N>,
    may_be_length: &[Option<bool>; N],
    limits: Option<&LaneLimits<L, N>>,
) {
    // The order of the sums is that of the scalar method. One loop with one evaluation: of two, the
    // compiler makes twice the code, in the square of the time.
    let number = |value: f64| L::from_f64(value);
    let (mut stage_q, mut stage_v) = (q.high, v.high);
    let (mut sum_q, mut sum_v) = (v.high, v.high);
    let mut turns = [number(0.0); N];
    for (stage, part, weight) in [(0, 0.5, 1.0), (1, 0.5, 2.0), (1, 1.0, 2.0), (2, 0.0, 1.0)] {
        let slope_q = stage_v;
        let slope_v = slopes.at(stage, &stage_q, &stage_v);
        for i in 0..N {
            let own = [slope_q[i], slope_v[i]];
            let [by_q, by_v] = own.map(|slope| number(weight) * slope);
            if may_be_length[i].is_some() && part != 0.0 {
                turns[i] = Real::max(turns[i], slope_v[i] * slope_v[i]);
            }
            (sum_q[i], sum_v[i]) = if stage == 0 {
                (slope_q[i], slope_v[i])
            } else {
                (sum_q[i] + by_q, sum_v[i] + by_v)
            };
            stage_q[i] = q.high[i] + h * (number(part) * own[0]);
            stage_v[i] = v.high[i] + h * (number(part) * own[1]);
        }
    }
    for i in 0..N {
        sum_q[i] /= number(6.0);
        sum_v[i] /= number(6.0);
    }
    let most = limits.map_or(number(MOST_TURN), |limits| limits.most_turn);
    let mut beyond = number(-1.0);
    for i in 0..N {
        if let Some(may_be_length) = may_be_length[i] {
            let size = if may_be_length { q.high[i] * q.high[i] } else { number(0.0) };
            let own = turns[i] * (h * h) * (h * h) - most * (number(1.0) + size);
            beyond = Real::max(beyond, own);
        }
    }
    q.add(h, &sum_q);
    v.add(h, &sum_v);
    if may_be_length.iter().any(Option::is_some) {
        q.high[0] = beyond.where_positive(number(f64::NAN), q.high[0]);
    }
}

/// Projects the state at the end of a step onto the constraints, in the metric of the mass matrix.
/// Lanes in which the projection fails become NaN.
///
/// Two iterations of Newton's method reach the rounding error from an error of the order of its
/// square root.
#[inline(always)]
pub(super) fn project<S: System<N>, const N: usize>(
    system: &S,
    epsilon: impl Float,
    t: S::Scalar,
    inputs: &S::Inputs,
    q: &mut Compensated<S::Scalar, N>,
    v: &mut Compensated<S::Scalar, N>,
) {
    let number = <S::Scalar as Real>::from_f64;
    let minus = number(-1.0);
    for _ in 0..2 {
        let at = At { t, q: &q.high, v: &v.high, inputs };
        let change = system.correction(at, &system.misfits(at)[0]);
        q.add(minus, &change);
    }
    let at = At { t, q: &q.high, v: &v.high, inputs };
    let change = system.correction(at, &system.misfits(at)[1]);
    v.add(minus, &change);
    let at = At { t, q: &q.high, v: &v.high, inputs };
    let (left, scales) = (system.misfits(at), system.misfit_scales(at));
    let bound = number(epsilon.to_f64().sqrt());
    for part in 0..2 {
        for k in 0..S::FACTS.held_constraints() {
            let off = left[part][k];
            let beyond = Real::abs(off) - bound * scales[part][k];
            // NaN where the misfit is too large; where it is finite, 0 is taken off.
            let none = off * number(0.0);
            q.high[0] = beyond.where_positive(number(f64::NAN), q.high[0]) - none * none;
        }
    }
}

/// Applies the damping of half a step.
#[inline(always)]
pub(super) fn decay<L: Real, const N: usize>(
    v: &mut Compensated<L, N>,
    limits: Option<&LaneLimits<L, N>>,
) {
    if let Some(limits) = limits {
        for i in 0..N {
            v.high[i] *= limits.factor;
            v.low[i] *= limits.factor;
        }
    }
}

#[inline(always)]
pub(super) fn drift<L: Real, const N: usize>(
    weight: L,
    q: &mut Compensated<L, N>,
    v: &mut Compensated<L, N>,
    limits: Option<&LaneLimits<L, N>>,
) {
    q.add(weight, &v.high);
    stop(q, v, limits);
}

/// Reflects coordinates that are beyond a hard stop. Within a drift the path is straight, so the
/// distance beyond the stop is reflected and multiplied by the restitution.
#[inline(always)]
pub(super) fn stop<L: Real, const N: usize>(
    q: &mut Compensated<L, N>,
    v: &mut Compensated<L, N>,
    limits: Option<&LaneLimits<L, N>>,
) {
    let Some(LaneLimits { own, stops: true, .. }) = limits else { return };
    let zero = L::from_f64(0.0);
    for i in 0..N {
        let (x, speed, e) = (q.high[i], v.high[i], own.restitution);
        for (limit, beyond, out) in
            [(own.high[i], x - own.high[i], speed), (own.low[i], own.low[i] - x, -speed)]
        {
            // The reflected coordinate must not pass the opposite limit.
            let back = Real::min(Real::max(limit - e * (x - limit), own.low[i]), own.high[i]);
            let hit = |then: L, otherwise: L| {
                let moving = out.where_positive(then, otherwise);
                own.hard.where_positive(beyond.where_positive(moving, otherwise), otherwise)
            };
            (q.high[i], q.low[i]) = (hit(back, q.high[i]), hit(zero, q.low[i]));
            (v.high[i], v.low[i]) = (hit(-(e * speed), v.high[i]), hit(zero, v.low[i]));
        }
    }
}
