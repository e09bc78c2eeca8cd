//! Poincaré sections: the crossings of a surface by a motion.

use crate::error::Error;
use crate::integrate::controller::Controller;
use crate::integrate::method::Method;
use crate::integrate::{AdaptiveStep, Direction, Event, Integrator, Picard, State};
use crate::system::Dynamics;
use core::iter::FusedIterator;
use std::collections::VecDeque;

/// The settings of a Poincaré section, created by [`poincare`].
#[must_use = "nothing is integrated before `start`"]
#[derive(Clone, Debug)]
pub struct Section<'a, const N: usize, D, M = Picard> {
    dynamics: &'a D,
    time: (f64, f64),
    q: [f64; N],
    v: [f64; N],
    surface: Event<'a, f64, N>,
    method: M,
    control: AdaptiveStep<N>,
}

/// Prepares the Poincaré section of a motion: its states with s(t, q, q̇) = 0 and rising s, in
/// order of time.
///
/// The crossings are found as [`Event`]s on the dense output of the method, to the last digits.
/// They are returned during the integration, one at a time, so their number is not limited by
/// memory. The integration ends at `time.1`.
///
/// Source: Hénon (1982), On the numerical computation of Poincaré maps, Physica D 5, 412–414. The
/// last step along the surface in this paper is replaced by the root on the dense output.
///
/// ```
/// use pendulum_runtime::prelude::*;
/// use pendulum_runtime::analysis::poincare;
///
/// # mod system {
/// pendulum_runtime::lagrangian! {
///     pub struct Kepler { μ }
///     coordinate x;
///     coordinate y;
///     kinetic = (ẋ^2 + ẏ^2)/2;
///     potential = -μ/|[x, y]|;
/// }
/// # }
/// # use system::Kepler;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // An ellipse closes: it comes back to the same point of the axis after every 2π.
/// let kepler = Kepler::new(1.0);
/// let section = poincare(&kepler, (0.0, 100.0), [1.5, 0.0], [0.0, 0.5_f64.sqrt()], |_, q, _| q[1]);
/// for crossing in section.rtol(1e-12).start()?.take(3) {
///     println!("{:?}", crossing?);
/// }
/// # Ok(())
/// # }
/// ```
pub fn poincare<'a, const N: usize, D: Dynamics<N, Scalar = f64>>(
    dynamics: &'a D,
    time: (f64, f64),
    q: [f64; N],
    v: [f64; N],
    surface: impl Fn(f64, &[f64; N], &[f64; N]) -> f64 + Send + Sync + 'a,
) -> Section<'a, N, D> {
    Section {
        dynamics,
        time,
        q,
        v,
        surface: Event::new(surface).rising(),
        method: Picard,
        control: AdaptiveStep::new().rtol(1e-9).atol(1e-9),
    }
}

impl<'a, const N: usize, D, M> Section<'a, N, D, M> {
    /// Sets the adaptive method, [`Picard`] by default.
    pub fn method<B>(self, method: B) -> Section<'a, N, D, B> {
        let Self { dynamics, time, q, v, surface, control, .. } = self;
        Section { dynamics, time, q, v, surface, method, control }
    }

    /// Sets the direction of the crossings; rising by default.
    pub fn direction(mut self, direction: Direction) -> Self {
        self.surface = self.surface.direction(direction);
        self
    }

    /// Sets the relative and absolute tolerance, 1e-9 by default.
    pub fn rtol(mut self, rtol: f64) -> Self {
        self.control = self.control.rtol(rtol).atol(rtol);
        self
    }

    /// Sets the greatest length of a step in seconds, for surfaces that are crossed twice within an
    /// eighth of a step.
    pub fn max_step(mut self, step: f64) -> Self {
        self.control = self.control.max_step(step);
        self
    }

    /// Starts the integration.
    ///
    /// # Errors
    /// Returns an error if the time interval is not finite or ends before it begins, if a setting
    /// is out of its range, or if the state or an acceleration at the start is not finite.
    pub fn start(self) -> Result<Crossings<'a, N, D, M>, Error>
    where
        D: Dynamics<N, Scalar = f64>,
        M: Method<D, N>,
        AdaptiveStep<N>: Controller<M, D, N>,
    {
        let (start, end) = self.time;
        if !((end - start).is_finite() && start <= end) {
            return Err(Error::Interval { start, end });
        }
        let run = Integrator::new(self.dynamics, self.method, start, self.q, self.v)?
            .control(self.control)?
            .events([self.surface])?;
        Ok(Crossings { run, end, found: VecDeque::new(), over: start == end })
    }
}

/// An iterator over the crossings of a surface: states, or the error that ended the integration.
#[derive(Clone, Debug)]
pub struct Crossings<'a, const N: usize, D, M>
where
    D: Dynamics<N, Scalar = f64>,
    M: Method<D, N>,
{
    run: Integrator<'a, N, D, M>,
    end: f64,
    /// The crossings of the last step that have not been returned yet.
    found: VecDeque<State<f64, N>>,
    over: bool,
}

impl<const N: usize, D, M> Crossings<'_, N, D, M>
where
    D: Dynamics<N, Scalar = f64>,
    M: Method<D, N>,
{
    /// Returns the state that the integration has reached, at or after the last crossing.
    pub fn state(&self) -> State<f64, N> {
        self.run.state()
    }
}

impl<const N: usize, D, M> Iterator for Crossings<'_, N, D, M>
where
    D: Dynamics<N, Scalar = f64>,
    M: Method<D, N>,
    AdaptiveStep<N>: Controller<M, D, N>,
{
    type Item = Result<State<f64, N>, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(state) = self.found.pop_front() {
                if self.end < state.t {
                    (self.over, self.found) = (true, VecDeque::new());
                    return None;
                }
                return Some(Ok(state));
            }
            if self.over {
                return None;
            }
            if let Err(error) = self.run.step() {
                self.over = true;
                return Some(Err(error));
            }
            self.found.extend(self.run.occurrences().iter().map(|crossing| crossing.state));
            self.over = self.end <= self.run.t();
        }
    }
}

impl<const N: usize, D, M> FusedIterator for Crossings<'_, N, D, M>
where
    D: Dynamics<N, Scalar = f64>,
    M: Method<D, N>,
    AdaptiveStep<N>: Controller<M, D, N>,
{
}
