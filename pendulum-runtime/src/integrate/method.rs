//! What a method is: a way to take one step, and for some an estimate of its error.

use crate::integrate::interpolant::hermite;
pub use crate::integrate::interpolant::{Basis, Interpolant, TERMS};
pub use crate::integrate::step::compensated::Compensated;
pub use crate::integrate::step::controller::{Control, ControllerState, StepContext};
pub use crate::integrate::step::endpoint::Endpoint;
pub use crate::integrate::step::field::{Accelerations, Counted, Field};
pub use crate::integrate::step::interval::StepInterval;
pub use crate::integrate::step::stepper::Stepper;
use crate::real::Float;
use crate::system::System;
use crate::time::Time;

/// A method for q̈ = a(t, q, q̇): what is known about it.
///
/// For which systems it is right, and how it steps them, says [`Suits`].
pub trait Method: Copy + core::fmt::Debug {
    /// The name.
    const NAME: &'static str;
    /// The order p: the error at a fixed time falls with the p-th power of the step.
    const ORDER: u32;
    /// The order of the dense output: the power of the step with which the error of the coordinates
    /// between two steps falls.
    const DENSE_ORDER: u32;
    /// What one step leaves behind for its error estimate and dense output.
    type Stages<T: Float, const N: usize>: Clone + core::fmt::Debug;

    /// Room for the stages.
    fn stages<T: Float, const N: usize>() -> Self::Stages<T, N>;

    /// Where the equations of the step just taken could not be solved: the time and the index of
    /// the coordinate; explicit methods have none to solve.
    ///
    /// Asked for after a step that has ended in numbers that are not finite.
    fn unsolved<T: Float, const N: usize>(stages: &Self::Stages<T, N>) -> Option<(Time, usize)> {
        let _ = stages;
        None
    }
}

/// A method with an error estimate, which can choose its own steps; others do not compile without a
/// step size:
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
    note = "give `solve(…)` a `.step(h)` or `.steps(n)` and an `Integrator` a `.control(FixedStep::new(h))`, or use `Tsit5` or `Dop853`"
)]
pub trait Embedded: Method {
    /// How the step size answers to the error.
    const RESPONSE: Response;

    /// The widest gap between two times whose accelerations the estimate contains, in steps: what
    /// is narrower may stay unseen.
    const GAP: f64 = 1.0;

    /// The error of the step just taken, times `weights`, as a root mean square.
    fn error<T: Float, const N: usize>(
        &self,
        stages: &Self::Stages<T, N>,
        h: f64,
        weights: &Weights<N>,
    ) -> f64;
}

/// How the step size answers to the error: h ← h · safety · err^(−α) · e^β with the error e of the
/// step before, within limits (Gustafsson 1991).
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
    /// The greatest.
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
    /// Σ (e·weight)² over coordinates and velocities; not a number if an error is not.
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

/// Methods that are right for the system `S`, and how they step it.
///
/// Splitting, Nyström and multistep methods want [`VelocityFree`](crate::system::VelocityFree)
/// systems, those that solve equations by Newton's method [`Jacobians`](crate::system::Jacobians),
/// which all generated systems have; the others suit every system:
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
pub trait Suits<S, const N: usize>: Method
where
    S: System<N, Scalar: Float>,
{
    /// Goes from `from` to the end of `interval`.
    ///
    /// The accelerations at the start may be kept in `from`, those at the end in the node that is
    /// returned.
    fn step(
        &self,
        field: &mut impl Field<S, N>,
        interval: &StepInterval,
        from: &mut Endpoint<S::Scalar, N>,
        stages: &mut Self::Stages<S::Scalar, N>,
    ) -> Endpoint<S::Scalar, N>;

    /// The motion within the step just taken; evaluates what it needs beyond the step itself.
    ///
    /// A method without dense output of its own has the quintic through coordinates, velocities and
    /// accelerations at both ends of the step.
    fn dense(
        &self,
        field: &mut impl Field<S, N>,
        interval: &StepInterval,
        from: &mut Endpoint<S::Scalar, N>,
        to: &mut Endpoint<S::Scalar, N>,
        stages: &mut Self::Stages<S::Scalar, N>,
    ) -> Interpolant<S::Scalar, N> {
        let _ = stages;
        let (a0, a1) = (from.start_acceleration(field), to.end_acceleration(field));
        hermite::quintic(interval, from, to, &a0, &a1)
    }
}
