//! Integration step by step, by hand.

use super::adaptive_step::AdaptiveStep;
use super::control::Control;
use super::driver::Driver;
use super::method::{Method, Suits};
use super::piece::Piece;
use super::solution::{State, Stats};
use crate::error::Error;
use crate::real::Float;
use crate::system::{Dynamics, Prepared, System};

/// An integration that goes on for as long as somebody asks for the next step; no step allocates.
///
/// After an error the state is the one before the failed step.
#[derive(Clone, Debug)]
pub struct Integrator<'a, const N: usize, D, M, C = AdaptiveStep<N>>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method,
{
    dynamics: Prepared<'a, D, <D::System as System<N>>::Prepared>,
    driver: Driver<D::Scalar, N, M, C>,
    max_steps: u64,
}

impl<'a, const N: usize, D, M> Integrator<'a, N, D, M>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method,
{
    /// At the coordinates `q` and velocities `v` at time `t`, with the default tolerances.
    ///
    /// A method without error estimate needs a [`FixedStep`](super::FixedStep) from [`control`](Self::control) before its first step.
    pub fn new(dynamics: &'a D, method: M, t: f64, q: [D::Scalar; N], v: [D::Scalar; N]) -> Result<Self, Error>
    where
        M: Suits<D::System, N>,
    {
        let dynamics = Prepared::new(dynamics);
        Ok(Self { dynamics, driver: Driver::new(&dynamics, method, AdaptiveStep::new(), t, q, v)?, max_steps: 10_000_000 })
    }
}

impl<'a, const N: usize, D, M, C> Integrator<'a, N, D, M, C>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method,
{
    /// Chooses the steps otherwise: with a [`FixedStep`](super::FixedStep) or an [`AdaptiveStep`].
    pub fn control<B: Control<M, N>>(self, control: B) -> Result<Integrator<'a, N, D, M, B>, Error> {
        control.check::<D::Scalar>()?;
        let Self { dynamics, driver, max_steps } = self;
        Ok(Integrator { dynamics, driver: driver.controlled(control), max_steps })
    }

    /// The number of steps that one call of [`advance_to`](Self::advance_to) may take; ten million without this call.
    pub fn max_steps(mut self, count: u64) -> Self {
        self.max_steps = count;
        self
    }

    /// Takes one step: the longest that the control allows, but not over a kink.
    #[inline]
    pub fn step(&mut self) -> Result<(), Error>
    where
        M: Suits<D::System, N>,
        C: Control<M, N>,
    {
        self.driver.step(&self.dynamics, f64::INFINITY)
    }

    /// Takes steps until the time is exactly `t`.
    pub fn advance_to(&mut self, t: f64) -> Result<(), Error>
    where
        M: Suits<D::System, N>,
        C: Control<M, N>,
    {
        if !(self.t() <= t && t < f64::INFINITY) {
            return Err(Error::Interval { start: self.t(), end: t });
        }
        let steps = |stats: &Stats| stats.accepted + stats.rejected;
        let before = steps(&self.driver.stats);
        while self.t() < t {
            if self.max_steps <= steps(&self.driver.stats) - before {
                return Err(Error::MaxSteps { t: self.t(), max_steps: self.max_steps });
            }
            self.driver.step(&self.dynamics, t)?;
        }
        Ok(())
    }

    /// Puts the state elsewhere, or the same state to another time.
    pub fn reset(&mut self, t: f64, q: [D::Scalar; N], v: [D::Scalar; N]) -> Result<(), Error> {
        self.driver.reset(&self.dynamics, t, q, v)
    }

    /// The motion within the last step; `None` before the first.
    ///
    /// Methods that need further evaluations for it take them now.
    pub fn last_step(&mut self) -> Option<Piece<D::Scalar, N>>
    where
        M: Suits<D::System, N>,
    {
        self.driver.piece(&self.dynamics)
    }

    /// The time reached.
    pub fn t(&self) -> f64 {
        self.driver.t()
    }

    /// The coordinates.
    pub fn q(&self) -> &[D::Scalar; N] {
        &self.driver.node.q.high
    }

    /// The velocities; at a kink those after it.
    pub fn v(&self) -> &[D::Scalar; N] {
        &self.driver.node.v.high
    }

    /// Time, coordinates and velocities together.
    pub fn state(&self) -> State<D::Scalar, N> {
        State::from(&self.driver.node)
    }

    /// What it took so far.
    pub fn stats(&self) -> &Stats {
        &self.driver.stats
    }
}
