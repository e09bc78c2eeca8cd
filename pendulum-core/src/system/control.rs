//! Systems with controllers for their control inputs.

use crate::error::{Error, Quantity};
use crate::motion::input::Purpose;
use crate::motion::{Derivatives, Motion, Motions, Sample, Side, shorter};
use crate::scalar::{Float, Real};
use crate::system::dynamics::{Driven, Dynamics, MOST_CONTROLS};
use crate::system::equations::System;
use crate::system::inputs::Samples;
use crate::time::Time;
use core::cell::RefCell;
use core::marker::PhantomData;
use core::sync::atomic::{AtomicU64, Ordering};

/// A placeholder for a control input among the motions of a system.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ControlSlot;

impl<T: Real, const D: usize> Motion<T, D> for ControlSlot {
    const HAS: Derivatives = Derivatives::ALL;

    #[inline]
    fn sample(&self, _: Time, _: Side, _: Derivatives) -> Sample<T, D> {
        Sample::zero()
    }

    fn kink_before(&self, _: f64) -> Option<f64> {
        Some(f64::NEG_INFINITY)
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }

    fn longest_step(&self, _: f64, _: f64) -> Option<f64> {
        Some(f64::INFINITY)
    }
}

/// The values of all control inputs: a number or an array for one input, a tuple for several.
pub trait ControlValues<T>: Copy {
    /// The number of components.
    const COUNT: usize;

    /// Writes the components to the start of `values`.
    fn write(&self, values: &mut [T]);
}

impl<T: Real> ControlValues<T> for T {
    const COUNT: usize = 1;

    #[inline]
    fn write(&self, values: &mut [T]) {
        values[0] = *self;
    }
}

impl<T: Real, const D: usize> ControlValues<T> for [T; D] {
    const COUNT: usize = D;

    #[inline]
    fn write(&self, values: &mut [T]) {
        values[..D].copy_from_slice(self);
    }
}

macro_rules! tuples {
    ($(($($member:ident $index:tt),+))+) => {$(
        impl<T: Real, $($member: ControlValues<T>),+> ControlValues<T> for ($($member,)+) {
            const COUNT: usize = $($member::COUNT +)+ 0;

            #[inline]
            fn write(&self, values: &mut [T]) {
                let mut at = 0;
                $(self.$index.write(&mut values[at..]);
                at += $member::COUNT;)+
                let _ = at;
            }
        }
    )+};
}

tuples! {
    (A 0, B 1)
    (A 0, B 1, C 2)
    (A 0, B 1, C 2, D 3)
    (A 0, B 1, C 2, D 3, E 4)
    (A 0, B 1, C 2, D 3, E 4, F 5)
    (A 0, B 1, C 2, D 3, E 4, F 5, G 6)
    (A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7)
}

/// Returns the total number of components of the control inputs of a system.
const fn components<S: System<N>, const N: usize>() -> usize {
    let (inputs, mut index, mut count) = (S::FACTS.inputs, S::FACTS.driven(), 0);
    while index < inputs.len() {
        count += inputs[index].components;
        index += 1;
    }
    count
}

/// A system with motions for its driven inputs, but without a controller for its control inputs.
#[derive(Clone, Debug)]
pub struct Uncontrolled<S, M> {
    /// The system and its motions, with a [`ControlSlot`] for each control input.
    pub driven: Driven<S, M>,
}

impl<S, M> Uncontrolled<S, M> {
    /// Adds a feedback law in continuous time: control inputs u(t, q, q̇), computed from the time
    /// in seconds, the coordinates and the velocities. The law returns a number or an array for one
    /// input and a tuple for several, in the units and in the order of their declarations.
    ///
    /// Does not compile if the number of values differs from the number of components of the
    /// control inputs.
    pub fn controlled_by<U, F, const N: usize>(self, law: F) -> Controlled<S, M, F, U>
    where
        S: System<N>,
        F: Fn(f64, &[S::Scalar; N], &[S::Scalar; N]) -> U,
        U: ControlValues<S::Scalar>,
    {
        const {
            assert!(
                components::<S, N>() == U::COUNT,
                "the control inputs have another number of components than the law gives"
            );
        };
        Controlled { driven: self.driven, law, values: PhantomData }
    }

    /// Adds a controller that sets the control inputs every `period` seconds; they are constant in
    /// between (zero-order hold). A rate of 1 kHz is the period 1e-3.
    ///
    /// A step ends at every sample. The controller may have a state: the closure is cloned at the
    /// start of each integration. The values of the last integration are recorded, one entry per
    /// period, for powers and outputs along its solution. For an earlier solution these are errors;
    /// use a clone of the system for each run to keep all of them.
    ///
    /// # Errors
    /// Integrations end with [`Error::Setting`] if the period is not positive or is too short in
    /// comparison with the time, with [`Error::NotFinite`] if a value is not finite, and with
    /// [`Error::Controller`] if another integration of the same system has begun since.
    pub fn sampled<U, C, const N: usize>(self, period: f64, controller: C) -> Sampled<S, M, C, U>
    where
        S: System<N>,
        C: FnMut(f64, &[S::Scalar; N], &[S::Scalar; N]) -> U + Clone,
        U: ControlValues<S::Scalar>,
    {
        const {
            assert!(
                components::<S, N>() == U::COUNT,
                "the control inputs have another number of components than the controller gives"
            );
        };
        let record =
            Record { run: 0, start: 0.0, controller: controller.clone(), samples: Vec::new() };
        Sampled { driven: self.driven, period, controller, record: RefCell::new(record) }
    }
}

/// A system whose control inputs follow a law u(t, q, q̇) in continuous time. See the page on control
/// of the guide.
///
/// All methods for systems with velocities support it except [`Taylor`](crate::integrate::Taylor),
/// which requires Taylor series.
///
/// A law has no derivative, with which the rate of a state would be integrated. A program with a law
/// in the rate of a `state` does not compile; `sampled` in place of `controlled_by` does:
///
/// ```compile_fail,E0080
/// use pendulum_runtime::prelude::*;
///
/// # mod system {
/// pendulum_runtime::lagrangian! {
///     pub struct Motor { J: kg*m^2, T: s }
///     coordinate φ: rad;
///     input u: N*m;
///     state τ: N*m;
///     kinetic = J/2*φ̇^2;
///     force φ = τ;
///     rate τ = (u - τ)/T;
/// }
/// # }
/// # use system::Motor;
/// # fn main() {
/// let motor = Motor::new(1.0, 0.1).controlled_by(|_, q, _| -q[0]);
/// let _ = solve(&motor, (0.0, 1.0), [0.0; 2], [0.0; 2]).run();
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Controlled<S, M, F, U> {
    pub(crate) driven: Driven<S, M>,
    law: F,
    values: PhantomData<fn() -> U>,
}

impl<S, M, F, U, const N: usize> Dynamics<N> for Controlled<S, M, F, U>
where
    S: System<N>,
    M: Motions<S::Inputs>,
    F: Fn(f64, &[S::Scalar; N], &[S::Scalar; N]) -> U,
    U: ControlValues<S::Scalar>,
{
    type System = S;
    type Scalar = S::Scalar;

    const FEEDBACK: bool = true;

    fn system(&self) -> &S {
        &self.driven.system
    }

    #[inline]
    fn inputs(&self, t: Time, side: Side, purpose: Purpose) -> S::Inputs {
        self.driven.motions.sample(t, side, S::FACTS.inputs, purpose)
    }

    #[inline]
    fn control(&self, t: Time, q: &[S::Scalar; N], v: &[S::Scalar; N], inputs: &mut S::Inputs) {
        let values = self.controls(t, q, v);
        inputs.set_controls(const { S::FACTS.driven() }, &values[..U::COUNT]);
    }

    #[inline]
    fn controls(
        &self,
        t: Time,
        q: &[S::Scalar; N],
        v: &[S::Scalar; N],
    ) -> [S::Scalar; MOST_CONTROLS] {
        let mut values = [S::Scalar::from_f64(0.0); MOST_CONTROLS];
        (self.law)(t.to_f64(), q, v).write(&mut values);
        values
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        self.driven.motions.next_kink(t)
    }

    fn kink_before(&self, t: f64) -> Option<f64> {
        self.driven.motions.kink_before(t)
    }

    #[inline]
    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        shorter(unknown, self.driven.motions.longest_step(t, widths, unknown))
    }
}

/// A system with a controller that sets the control inputs every `period` seconds.
///
/// It stores the samples of its last integration only: powers, outputs, accelerations and reactions
/// along the solution of any other integration are errors. See the page on control of the guide.
#[derive(Clone, Debug)]
pub struct Sampled<S, M, C, U> {
    pub(crate) driven: Driven<S, M>,
    period: f64,
    controller: C,
    record: RefCell<Record<C, U>>,
}

/// The number of integrations with sampled controllers so far.
static RUNS: AtomicU64 = AtomicU64::new(0);

/// The samples of one integration.
#[derive(Clone, Debug)]
struct Record<C, U> {
    /// The number of the integration.
    run: u64,
    /// The start of the integration; samples are due at whole multiples of the period after it.
    start: f64,
    /// The controller in its current state.
    controller: C,
    /// The times of the samples and the values of the controller.
    samples: Vec<(f64, U)>,
}

impl<C, U: Copy> Record<C, U> {
    /// Returns the time of the first sample that is due after `t`.
    fn next(&self, t: f64, period: f64) -> f64 {
        let k = ((t - self.start) / period).floor();
        // Rounding errors shift `k` by at most two, unless the period is too short for the time.
        let due = (0..4).map(|more| self.start + (k + f64::from(more)) * period);
        due.into_iter().find(|&due| t < due).unwrap_or(t.next_up())
    }

    /// Returns the values at `t`: the values of the last sample before `t`, or at the time of a
    /// sample the values on `side`.
    fn at(&self, t: Time, side: Side) -> Option<U> {
        let known = |&(sampled, _): &(f64, U)| {
            let since = t.since(sampled);
            0.0 < since || since == 0.0 && side == Side::After
        };
        let count = match self.samples.last() {
            Some(last) if known(last) => self.samples.len(),
            _ => self.samples.partition_point(known),
        };
        // The values of the first sample are used before it, too.
        self.samples.get(count.saturating_sub(1)).map(|sample| sample.1)
    }
}

impl<S, M, C, U, const N: usize> Dynamics<N> for Sampled<S, M, C, U>
where
    S: System<N, Scalar: Float>,
    M: Motions<S::Inputs>,
    C: FnMut(f64, &[S::Scalar; N], &[S::Scalar; N]) -> U + Clone,
    U: ControlValues<S::Scalar>,
{
    type System = S;
    type Scalar = S::Scalar;

    const SAMPLED: bool = true;

    fn system(&self) -> &S {
        &self.driven.system
    }

    #[inline]
    fn inputs(&self, t: Time, side: Side, purpose: Purpose) -> S::Inputs {
        let mut inputs = self.driven.motions.sample(t, side, S::FACTS.inputs, purpose);
        inputs.set_controls(const { S::FACTS.driven() }, &self.held(t, side)[..U::COUNT]);
        inputs
    }

    fn begin(&self, t: f64) -> u64 {
        // The number is unique in the program, so that a solution can be matched with the system
        // that has its samples.
        let run = RUNS.fetch_add(1, Ordering::Relaxed) + 1;
        *self.record.borrow_mut() =
            Record { run, start: t, controller: self.controller.clone(), samples: Vec::new() };
        run
    }

    fn recorded(&self) -> u64 {
        self.record.borrow().run
    }

    fn sample(
        &self,
        run: u64,
        t: Time,
        q: &[S::Scalar; N],
        v: &[S::Scalar; N],
    ) -> Result<bool, Error> {
        let record = &mut *self.record.borrow_mut();
        let now = t.to_f64();
        if !(now < now + self.period && self.period.is_finite()) {
            let required = "positive, finite and so long that it moves the time on";
            return Err(Error::Setting { name: "period", value: self.period, required });
        }
        if run != record.run {
            return Err(Error::Controller { t: now });
        }
        while record.samples.pop_if(|last| now < last.0).is_some() {}
        if let Some(&(last, _)) = record.samples.last()
            && now < record.next(last, self.period)
        {
            return Ok(false);
        }
        let values = (record.controller)(now, q, v);
        let mut numbers = [S::Scalar::from_f64(0.0); MOST_CONTROLS];
        values.write(&mut numbers);
        if let Some(index) = numbers.iter().position(|number| !number.is_finite()) {
            return Err(Error::NotFinite {
                t: now,
                what: control::<S, N>(index),
                suspects: Vec::new(),
            });
        }
        record.samples.push((now, values));
        Ok(true)
    }

    fn controls(
        &self,
        t: Time,
        _: &[S::Scalar; N],
        _: &[S::Scalar; N],
    ) -> [S::Scalar; MOST_CONTROLS] {
        self.held(t, Side::After)
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        let motions = self.driven.motions.next_kink(t);
        if !(0.0 < self.period && self.period.is_finite()) {
            return motions;
        }
        let sample = self.record.borrow().next(t, self.period);
        Some(motions.map_or(sample, |kink| f64::min(kink, sample)))
    }

    #[inline]
    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        self.driven.motions.longest_step(t, widths, unknown)
    }
}

impl<S, M, C, U: Copy> Sampled<S, M, C, U> {
    /// Returns the recorded values in force at `t`; NaN before the first integration.
    pub(crate) fn held<T: Real, const N: usize>(&self, t: Time, side: Side) -> [T; MOST_CONTROLS]
    where
        S: System<N, Scalar = T>,
        U: ControlValues<T>,
    {
        let mut values = [T::from_f64(f64::NAN); MOST_CONTROLS];
        if let Some(held) = self.record.borrow().at(t, side) {
            held.write(&mut values);
        }
        values
    }
}

/// Returns the component of a control input with this index among all components.
fn control<S: System<N>, const N: usize>(mut index: usize) -> Quantity {
    for input in &S::FACTS.inputs[S::FACTS.driven()..] {
        if index < input.components {
            return Quantity::Control { name: input.name, component: index };
        }
        index -= input.components;
    }
    Quantity::Control { name: "", component: index }
}
