//! The traits that methods implement, and the types that they use.
//!
//! A method outside of this crate implements [`Method`]. For adaptive steps it implements
//! [`ErrorEstimate`] and [`Adaptive`] too, as in the example `own_method`.

pub use super::field::Field;
use super::field::diagnose;
use super::field::first_in_state;
pub use super::interpolant::{Basis, Interpolant};
pub use super::state::compensated::Compensated;
pub use super::state::endpoint::Endpoint;
pub use super::state::interval::StepInterval;
use crate::error::{Error, Quantity};
use crate::integrate::interpolant::hermite;
pub use crate::integrate::state::saved::Memory;
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, Purpose, System, suspects};
use crate::time::Time;

/// A method that integrates the dynamics `D`: q̈ = a(t, q, q̇).
///
/// Splitting and Nyström methods require a [`VelocityFree`](crate::system::VelocityFree) system.
/// Methods that solve equations by Newton's method require
/// [`Jacobians`](crate::system::Jacobians), which all generated systems have. `Picard`, `Taylor`
/// and `Auto` require a generated system. The other methods integrate every system:
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
    /// The name of the method.
    const NAME: &'static str;
    /// The memory for one step, and for the data that the error estimate, the interpolant and the
    /// next step need.
    type Workspace: Clone + core::fmt::Debug;

    /// Creates a workspace for the first step.
    fn workspace(&self, dynamics: &D) -> Self::Workspace;

    /// Takes a step from `from` to the end of `interval`, and returns the endpoint.
    ///
    /// The method may store the accelerations at the start in `from`, and those at the end in the
    /// endpoint returned. A failed step is repeated with a watched field (`W`) to find the cause.
    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        workspace: &mut Self::Workspace,
    ) -> Endpoint<D::Scalar, N>;

    /// Returns the motion within the last step, and performs further evaluations if necessary.
    ///
    /// The default is the quintic through coordinates, velocities and accelerations at both ends of
    /// the step.
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

    /// Returns the state of a stage of the last step whose accelerations the method has used, by its
    /// index from 0, and its place as a fraction of the step; `None` after the last stage.
    ///
    /// A method implements it if its dense output may stay on one side of a switch, such as the
    /// argument of `sign`, while stages lie on the other side. The default is `None`.
    fn stage(
        &self,
        index: usize,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        workspace: &Self::Workspace,
    ) -> Option<(f64, Endpoint<D::Scalar, N>)> {
        let _ = (index, interval, from, workspace);
        None
    }

    /// Returns the cause of a step that ended in numbers that are not finite, if it is found: the
    /// first such number in a repetition of the step, or equations that could not be solved.
    fn diagnose(
        &self,
        field: &Field<'_, D, N>,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        workspace: &Self::Workspace,
    ) -> Option<Error> {
        fault(self, field, interval, from, workspace)
    }

    /// Returns the time and the index of the coordinate at which the equations of the last step
    /// could not be solved. Explicit methods have no equations to solve.
    fn unsolved(&self, workspace: &Self::Workspace) -> Option<(Time, usize)> {
        let _ = workspace;
        None
    }

    /// Returns the name of the method that took the steps; it differs from `NAME` if this method
    /// delegates its steps to another.
    fn name(&self, workspace: &Self::Workspace) -> &'static str {
        let _ = workspace;
        Self::NAME
    }

    /// Visits all data in the workspace that one step passes to the next, in a fixed order, so that
    /// a saved integration continues with the same bits. Methods whose steps depend only on the
    /// state have no data to visit.
    fn remember(&self, workspace: &mut Self::Workspace, memory: &mut Memory) {
        let _ = (workspace, memory);
    }

    /// Updates the workspace after the projection onto the constraints has moved the end of the
    /// last step to `to`, by no more than the error of the step. Methods that store the end of a
    /// step continue from `to`.
    fn moved(&self, dynamics: &D, workspace: &mut Self::Workspace, to: &Endpoint<D::Scalar, N>) {
        let _ = (dynamics, workspace, to);
    }

    /// Returns `true` if all accelerations of a step come from [`Field::at`], which adds the forces
    /// of limits in contact and of dry frictions. Other methods end in [`Error::Contact`] when a
    /// contact begins, and in [`Error::Friction`] at the start.
    fn keeps_contacts(&self) -> bool {
        false
    }

    /// Returns `true` if the method can go back in time. The default is `true` for dynamics that
    /// provide the kinks before a time.
    fn goes_back(&self, dynamics: &D) -> bool {
        dynamics.kink_before(0.0).is_some()
    }

    /// Returns the next kink after `t`, or the last kink before `t` if `backwards`.
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
    /// Returns the error of the last step, of the length `h` in seconds: the root mean square of
    /// the error times `weights` over coordinates and velocities. A step is accepted if its error
    /// is at most 1.
    fn error(&self, workspace: &Self::Workspace, h: f64, weights: &Weights<N>) -> f64;

    /// Returns the part of the error that remains after the projection of the end of the step onto
    /// the constraints. `along` removes the components across the constraints from an estimate, of
    /// coordinates or of velocities.
    ///
    /// This error is used for constraints that almost depend on each other, because the
    /// accelerations then have few digits across the constraints. The default is the whole error.
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

/// A method with an [`ErrorEstimate`], which can choose its own steps. Other methods do not compile
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

    /// The widest gap, in steps, between two times whose accelerations the error estimate contains;
    /// narrower features may be missed.
    const GAP: f64 = 1.0;
}

/// The response of the step size to the error: h ← h · safety · err^(−α) · e^β with the error e of
/// the previous step, within limits (Gustafsson 1991).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// The exponent α.
    pub alpha: f64,
    /// The exponent β.
    pub beta: f64,
    /// The safety factor.
    pub safety: f64,
    /// The least factor between the lengths of two consecutive steps.
    pub least: f64,
    /// The greatest factor between the lengths of two consecutive steps.
    pub greatest: f64,
}

/// The reciprocal of the error allowed in each component: 1/(atol + rtol·max(|y₀|, |y₁|)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights<const N: usize> {
    /// The weights of the coordinates.
    pub q: [f64; N],
    /// The weights of the velocities.
    pub v: [f64; N],
}

impl<const N: usize> Weights<N> {
    /// Returns Σ (e·weight)² over coordinates and velocities; NaN if an error is NaN.
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

/// Returns the error for a step that led to a number that is not finite; `workspace` is as the step
/// left it.
pub(crate) fn cause<D: Dynamics<N, Scalar: Float>, M: Method<D, N>, const N: usize>(
    method: &M,
    field: &Field<'_, D, N>,
    interval: &StepInterval,
    from: &Endpoint<D::Scalar, N>,
    workspace: &M::Workspace,
) -> Error {
    let coordinate = <D::System as System<N>>::FACTS.coordinate(0);
    let error = method.diagnose(field, interval, from, workspace);
    let error = error.unwrap_or_else(|| Error::NotFinite {
        t: interval.end.to_f64(),
        what: Quantity::Velocity(coordinate),
        suspects: Vec::new(),
    });
    beyond_tables(field.dynamics, interval, from, error)
}

/// Returns the error for a table whose argument leaves its points in a step, in place of one for
/// numbers of the equations that are not finite or for steps that fail at any length.
///
/// Steps that leave the points fail. The last one begins where the argument is at an end but for
/// rounding, or is too long and ends beyond it.
pub(crate) fn beyond_tables<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    interval: &StepInterval,
    from: &Endpoint<D::Scalar, N>,
    error: Error,
) -> Error {
    /// The distance from an end that is rounding, as a fraction of the interval.
    const NEAR: f64 = 1e-9;
    let of_equations = match &error {
        Error::NotFinite { what, .. } => {
            !matches!(what, Quantity::Input { .. } | Quantity::Control { .. })
        }
        error => matches!(error, Error::StepSizeUnderflow { .. }),
    };
    if !of_equations {
        return error;
    }
    let side = interval.side();
    let straight = from.advanced(interval, &from.v.high, &[D::Scalar::from_f64(0.0); N]);
    let mut found = None;
    for (state, near, side) in [(from, NEAR, side), (&straight, 0.0, side.opposite())] {
        let phase = state.phase(dynamics, side);
        let inputs = phase.inputs(Purpose::Accelerations);
        let visit = &mut |name, [first, last]: [f64; 2], argument: D::Scalar| {
            let (argument, near) = (argument.to_f64(), near * (last - first));
            let outside = argument < first + near || last - near < argument;
            if outside && found.is_none() {
                let t = phase.t.to_f64();
                found = Some(Error::Table { t, name, argument, ends: [first, last] });
            }
        };
        dynamics.system().__tables(phase.at(&inputs), visit);
    }
    found.unwrap_or(error)
}

/// Returns the error for the first number in the evaluations of a step that is not finite, or for
/// the equations that were not solved, if any.
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
        && diagnose::regular(&from.phase(dynamics, Side::After))
    {
        return Some(Error::NoVelocity { t: t.to_f64(), coordinate });
    }
    // After a failed iteration, numbers that are not finite are an effect and not the cause.
    if let Some((t, index)) = unsolved {
        let coordinate = facts.coordinate(index);
        return Some(Error::NoConvergence { t: t.to_f64(), step: interval.h, coordinate });
    }
    let at_end = || first_in_state(facts, &to.q.high, &to.v.high).map(|what| (interval.end, what));
    let (t, what) = findings.first.or_else(at_end)?;
    if findings.singular {
        return Some(Error::NotFinite {
            t: t.to_f64(),
            what,
            suspects: suspects(dynamics.system()),
        });
    }
    // With a faulty parameter the accelerations at the start would not be finite.
    let began = start.a.is_some_and(|a| a.iter().all(|a| a.is_finite()));
    if began {
        return Some(Error::NotFinite { t: t.to_f64(), what, suspects: Vec::new() });
    }
    Some(diagnose::not_finite(dynamics.system(), t, what))
}
