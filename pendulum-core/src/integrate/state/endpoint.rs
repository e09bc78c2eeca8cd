//! The state between two steps.

// The steps of `Picard` are inlined into code that is compiled for several instruction sets.
#![allow(clippy::inline_always)]

use crate::integrate::field::Field;
use crate::integrate::field::phase::{Phase, has_states};
use crate::integrate::state::State;
use crate::integrate::state::compensated::Compensated;
use crate::integrate::state::interval::StepInterval;
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::Dynamics;
use crate::time::Time;

/// The state at one end of a step, including its low words.
// In this order and with the option last, the vectors that copy an endpoint match the vectors that
// wrote it: a load that spans two stores waits for both.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Endpoint<T, const N: usize> {
    /// The time.
    pub t: Time,
    /// The coordinates.
    pub q: Compensated<T, N>,
    /// The velocities.
    pub v: Compensated<T, N>,
    /// The accelerations, if they have been computed. The end of a step stores those before a kink,
    /// the start of a step those after the kink.
    ///
    /// The two differ only at kinks, where the loop resets this field.
    pub a: Option<[T; N]>,
}

impl<T: Float, const N: usize> Endpoint<T, N> {
    /// Creates the state `q`, `v` at `t`.
    pub fn new(t: Time, q: [T; N], v: [T; N]) -> Self {
        Self { t, q: Compensated::new(q), v: Compensated::new(v), a: None }
    }

    /// Returns the accelerations at the start of a step, and computes them if necessary.
    #[inline]
    pub fn start_acceleration<const W: bool>(
        &mut self,
        field: &mut Field<'_, impl Dynamics<N, Scalar = T>, N, W>,
    ) -> [T; N] {
        let side = field.side();
        self.acceleration(field, side)
    }

    /// Returns the accelerations at the end of a step, and computes them if necessary.
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
        // The return value comes from registers, because `self.a` has just been written.
        let a = field.at(self.t, side, &self.q.high, &self.v.high);
        self.a = Some(a);
        a
    }

    /// Returns this state of `dynamics`.
    pub(crate) fn phase<'a, D>(&'a self, dynamics: &'a D, side: Side) -> Phase<'a, D, N>
    where
        D: Dynamics<N, Scalar = T>,
    {
        Phase { dynamics, t: self.t, side, q: &self.q.high, v: &self.v.high }
    }

    /// Sets the velocities of the states to their rates.
    #[inline]
    pub(crate) fn settle<D: Dynamics<N, Scalar = T>>(&mut self, dynamics: &D, side: Side) {
        if const { has_states::<D, N>() } {
            let [v, _] = self.phase(dynamics, side).with_rates(&self.v.high);
            self.v.jump(&v);
            // The accelerations depend on these velocities in the places of states only.
            self.a = self.a.map(|a| self.phase(dynamics, side).with_rates(&a)[1]);
        }
    }

    /// Returns the endpoint of `interval` at which coordinates and velocities have grown by `h·dq`
    /// and `h·dv`.
    #[inline]
    pub fn advanced(&self, interval: &StepInterval, dq: &[T; N], dv: &[T; N]) -> Self {
        let h = interval.length::<T>();
        let mut next = Self { t: interval.end, a: None, ..*self };
        next.q.add(h, dq);
        next.v.add(h, dv);
        next
    }

    /// Returns `true` if the whole state is finite.
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
