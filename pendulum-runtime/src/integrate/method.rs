//! Methods: the trait that each implements, and what they work with.
//!
//! A method outside of this crate implements [`Method`], and [`ErrorEstimate`] and [`Adaptive`] if
//! it can choose its steps; the example `own_method` has one.

use super::field::diagnose;
pub use super::field::{Field, InputsOf};
use super::field::{coordinate, first_in_state};
pub use super::interpolant::{Basis, Interpolant, TERMS};
pub use super::state::compensated::Compensated;
pub use super::state::endpoint::Endpoint;
pub use super::state::interval::StepInterval;
use crate::error::{Error, Quantity};
use crate::integrate::interpolant::hermite;
pub use crate::integrate::state::saved::Memory;
use crate::scalar::Float;
use crate::system::{Dynamics, System};
use crate::time::Time;

/// A method that integrates the dynamics `D`: q̈ = a(t, q, q̇).
///
/// Splitting, Nyström and multistep methods integrate [`VelocityFree`](crate::system::VelocityFree)
/// systems, those that solve equations by Newton's method systems with
/// [`Jacobians`](crate::system::Jacobians), which all generated systems have; the others integrate
/// every system:
///
/// ```
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: VelocityFree<1> + System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).method(Leapfrog).step(0.01).run()?.end.q[0])
/// }
/// ```
///
/// ```compile_fail,E0277
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).method(Leapfrog).step(0.01).run()?.end.q[0])
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot integrate `{D}`",
    note = "without `.method(…)`, `solve` chooses for systems that `lagrangian!` has made; for others name a method, as `.method(Dop853)`"
)]
pub trait Method<D: Dynamics<N, Scalar: Float>, const N: usize>: Copy + core::fmt::Debug {
    /// The name.
    const NAME: &'static str;
    /// Memory for one step, and for what it leaves to the error estimate, the interpolant and the
    /// next step.
    type Workspace: Clone + core::fmt::Debug;

    /// A workspace before the first step.
    fn workspace(&self, dynamics: &D) -> Self::Workspace;

    /// Goes from `from` to the end of `interval`.
    ///
    /// The accelerations at the start may be kept in `from`, those at the end in the endpoint that
    /// is returned. A step that failed is taken once more with a field that is watched (`W`).
    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        workspace: &mut Self::Workspace,
    ) -> Endpoint<D::Scalar, N>;

    /// The motion within the step just taken; evaluates what it needs beyond the step itself.
    ///
    /// Without an interpolant of its own a method has the quintic through coordinates, velocities
    /// and accelerations at both ends of the step.
    fn interpolant(
        &self,
        field: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        workspace: &mut Self::Workspace,
    ) -> Interpolant<D::Scalar, N> {
        let _ = workspace;
        let (a0, a1) = (from.start_acceleration(field), to.end_acceleration(field));
        hermite::quintic(interval, from, to, &a0, &a1)
    }

    /// The cause of a step that ended in numbers that are not finite, if it is found: the first
    /// such number in the step, taken once more, or the equations that were not solved.
    fn diagnose(
        &self,
        field: &Field<'_, D, N>,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        workspace: &Self::Workspace,
    ) -> Option<Error> {
        fault(self, field, interval, from, workspace)
    }

    /// The time and the index of the coordinate where the equations of the step just taken could
    /// not be solved; explicit methods have none to solve.
    fn unsolved(&self, workspace: &Self::Workspace) -> Option<(Time, usize)> {
        let _ = workspace;
        None
    }

    /// The name of the method that has taken the steps, if that is another one.
    fn name(&self, workspace: &Self::Workspace) -> &'static str {
        let _ = workspace;
        Self::NAME
    }

    /// Visits everything in the workspace that one step leaves to the next, in an order of its own:
    /// a saved integration goes on with the same bits. Methods whose steps begin with the state
    /// alone have nothing to visit.
    fn remember(&self, workspace: &mut Self::Workspace, memory: &mut Memory) {
        let _ = (workspace, memory);
    }

    /// Takes note that the end of the last step has been moved to `to`, by no more than its error:
    /// onto the constraints. Methods that know a step by its end go on from there.
    fn moved(&self, dynamics: &D, workspace: &mut Self::Workspace, to: &Endpoint<D::Scalar, N>) {
        let _ = (dynamics, workspace, to);
    }

    /// Returns true if all accelerations of a step come from [`Field::at`], which adds the forces
    /// of limits in contact. Others end in [`Error::Contact`] where a contact begins.
    fn keeps_contacts(&self) -> bool {
        false
    }

    /// Returns true if the method goes back in time too; by default if the kinks that come there
    /// are known.
    fn goes_back(&self, dynamics: &D) -> bool {
        dynamics.kink_before(0.0).is_some()
    }

    /// The next kink after `t`, or the last one before it.
    fn kink(&self, dynamics: &D, t: f64, backwards: bool) -> Option<f64> {
        if backwards {
            dynamics.kink_before(t).filter(|kink| f64::NEG_INFINITY < *kink)
        } else {
            dynamics.next_kink(t)
        }
    }
}

/// A method that estimates the error of its steps.
pub trait ErrorEstimate<D: Dynamics<N, Scalar: Float>, const N: usize>: Method<D, N> {
    /// The error of the step just taken, of the length `h` in seconds, times `weights`, as a root
    /// mean square over coordinates and velocities: the step is good enough up to 1.
    fn error(&self, workspace: &Self::Workspace, h: f64, weights: &Weights<N>) -> f64;

    /// The same of the error that stays when the end of the step is brought onto the constraints:
    /// `along` takes off an estimate, of coordinates or of velocities, what is across them.
    ///
    /// It is asked for where constraints almost depend on each other: the accelerations then have
    /// few digits across them. Without an implementation of its own it is the whole error.
    fn error_along(
        &self,
        workspace: &Self::Workspace,
        h: f64,
        weights: &Weights<N>,
        along: impl Fn(&mut [D::Scalar; N]),
    ) -> f64 {
        let _ = along;
        self.error(workspace, h, weights)
    }
}

/// A method with an [`ErrorEstimate`], which can choose its own steps; others do not compile
/// without a step size:
///
/// ```
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     let exact = solve(system, (0.0, 10.0), [1.3], [0.0]).method(Dop853).rtol(1e-12).run()?;
///     let animated = solve(system, (0.0, 10.0), [1.3], [0.0]).method(Rk4).step(0.01).run()?;
///     Ok(animated.end.q[0] - exact.end.q[0])
/// }
/// ```
///
/// ```compile_fail,E0277
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).method(Rk4).run()?.end.q[0])
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no error estimate and cannot choose its steps",
    label = "a step size is missing",
    note = "give `solve(…)` a `.step(h)` or `.steps(n)` and an `Integrator` a `.control(FixedStep::new(h))`, or use `Dop853`"
)]
pub trait Adaptive {
    /// The order p of the first step: its length h is chosen for an error of about h^p.
    const ORDER: u32;

    /// The response of the step size to the error.
    const RESPONSE: Response;

    /// The widest gap between two times whose accelerations the estimate contains, in steps:
    /// anything narrower may stay unseen.
    const GAP: f64 = 1.0;
}

/// The response of the step size to the error: h ← h · safety · err^(−α) · e^β with the error e of
/// the step before, within limits (Gustafsson 1991).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// α.
    pub alpha: f64,
    /// β.
    pub beta: f64,
    /// The safety factor.
    pub safety: f64,
    /// The least factor between two steps.
    pub least: f64,
    /// The greatest factor between two steps.
    pub greatest: f64,
}

/// One over the error that is allowed in each component: 1/(atol + rtol·max(|y₀|, |y₁|)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights<const N: usize> {
    /// For the coordinates.
    pub q: [f64; N],
    /// For the velocities.
    pub v: [f64; N],
}

impl<const N: usize> Weights<N> {
    /// Σ (e·weight)² over coordinates and velocities; NaN if an error is.
    #[inline]
    pub fn square_sum<T: Float>(&self, q: &[T; N], v: &[T; N]) -> f64 {
        let mut sum = 0.0;
        for i in 0..N {
            let q = q[i].to_f64() * self.q[i];
            let v = v[i].to_f64() * self.v[i];
            sum += q * q + v * v;
        }
        sum
    }
}

/// The error for a step, with what it has left in `workspace`, that led to a number that is not
/// finite.
pub(crate) fn cause<D: Dynamics<N, Scalar: Float>, M: Method<D, N>, const N: usize>(
    method: &M,
    field: &Field<'_, D, N>,
    interval: &StepInterval,
    from: &Endpoint<D::Scalar, N>,
    workspace: &M::Workspace,
) -> Error {
    let coordinate = coordinate(&<D::System as System<N>>::FACTS, 0);
    method.diagnose(field, interval, from, workspace).unwrap_or_else(|| Error::NotFinite {
        t: interval.end.to_f64(),
        what: Quantity::Velocity(coordinate),
        suspects: Vec::new(),
    })
}

/// The first number in the evaluations of a step that is not finite, or where its equations were
/// not solved, if there is one.
fn fault<D: Dynamics<N, Scalar: Float>, M: Method<D, N>, const N: usize>(
    method: &M,
    field: &Field<'_, D, N>,
    interval: &StepInterval,
    from: &Endpoint<D::Scalar, N>,
    workspace: &M::Workspace,
) -> Option<Error> {
    let facts = &<D::System as System<N>>::FACTS;
    let dynamics = field.dynamics;
    let unsolved = method.unsolved(workspace);
    let mut watched = field.watched();
    let mut start = Endpoint { a: None, ..*from };
    let to = method.attempt(&mut watched, interval, &mut start, &mut method.workspace(dynamics));
    let findings = watched.findings;
    if let Some((t, coordinate)) = findings.lost
        && diagnose::regular(dynamics, from.t, &from.q.high, &from.v.high)
    {
        return Some(Error::NoVelocity { t: t.to_f64(), coordinate });
    }
    // Where an iteration went astray, numbers that are not finite are not the cause but the effect.
    if let Some((t, index)) = unsolved {
        let coordinate = coordinate(facts, index);
        return Some(Error::NoConvergence { t: t.to_f64(), step: interval.h, coordinate });
    }
    let at_end = || first_in_state(facts, &to.q.high, &to.v.high).map(|what| (interval.end, what));
    let (t, what) = findings.first.or_else(at_end)?;
    if findings.singular {
        return Some(Error::NotFinite {
            t: t.to_f64(),
            what,
            suspects: diagnose::suspects(dynamics.system()),
        });
    }
    // With a parameter at fault the step would not have begun.
    let began = start.a.is_some_and(|a| a.iter().all(|a| a.is_finite()));
    if began {
        return Some(Error::NotFinite { t: t.to_f64(), what, suspects: Vec::new() });
    }
    Some(diagnose::not_finite(dynamics.system(), t, what))
}
