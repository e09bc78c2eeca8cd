//! The state between two steps.

// Picard's steps are compiled for several instruction sets.
#![allow(clippy::inline_always)]

use crate::integrate::field::Field;
use crate::integrate::state::State;
use crate::integrate::state::compensated::Compensated;
use crate::integrate::state::interval::StepInterval;
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::Dynamics;
use crate::time::Time;

/// The state at one end of a step, with the digits that rounding has left off.
// In this order and with the option last, the vectors that copy an endpoint are those that have
// written it: a load that spans two stores waits for both.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Endpoint<T, const N: usize> {
    /// The time.
    pub t: Time,
    /// The coordinates.
    pub q: Compensated<T, N>,
    /// The velocities.
    pub v: Compensated<T, N>,
    /// The accelerations, where somebody has computed them: from before if this is the end of a
    /// step, from after if its start.
    ///
    /// The two differ at kinks only, and there the loop forgets them.
    pub a: Option<[T; N]>,
}

impl<T: Float, const N: usize> Endpoint<T, N> {
    /// The state `q`, `v` at `t`.
    pub fn new(t: Time, q: [T; N], v: [T; N]) -> Self {
        Self { t, q: Compensated::new(q), v: Compensated::new(v), a: None }
    }

    /// The accelerations at the start of a step.
    #[inline]
    pub fn start_acceleration<const W: bool>(
        &mut self,
        field: &mut Field<'_, impl Dynamics<N, Scalar = T>, N, W>,
    ) -> [T; N] {
        let side = field.side();
        self.acceleration(field, side)
    }

    /// The accelerations at the end of a step.
    #[inline]
    pub fn end_acceleration<const W: bool>(
        &mut self,
        field: &mut Field<'_, impl Dynamics<N, Scalar = T>, N, W>,
    ) -> [T; N] {
        let side = field.side().opposite();
        self.acceleration(field, side)
    }

    #[inline]
    fn acceleration<const W: bool>(
        &mut self,
        field: &mut Field<'_, impl Dynamics<N, Scalar = T>, N, W>,
        side: Side,
    ) -> [T; N] {
        if let Some(a) = self.a {
            return a;
        }
        // The value comes from registers: the place where it is kept has just been written.
        let a = field.at(self.t, side, &self.q.high, &self.v.high);
        self.a = Some(a);
        a
    }

    /// The endpoint of `interval` whose coordinates and velocities have grown by `h·dq` and
    /// `h·dv`.
    #[inline]
    pub fn advanced(&self, interval: &StepInterval, dq: &[T; N], dv: &[T; N]) -> Self {
        let h = interval.length::<T>();
        let mut next = Self { t: interval.end, a: None, ..*self };
        next.q.add(h, dq);
        next.v.add(h, dv);
        next
    }

    /// Returns true if the whole state is finite.
    #[inline(always)]
    pub fn is_finite(&self) -> bool {
        self.q.is_finite() && self.v.is_finite()
    }
}

impl<T: Float, const N: usize> From<&Endpoint<T, N>> for State<T, N> {
    fn from(end: &Endpoint<T, N>) -> Self {
        Self { t: end.t.to_f64(), q: end.q.high, v: end.v.high }
    }
}
