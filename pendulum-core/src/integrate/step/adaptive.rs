//! Steps as long as the error allows.

// Functions that lanes use too are inlined, to be compiled for the vectors of the lanes.
#![allow(clippy::inline_always)]

use crate::error::Error;
use crate::integrate::field::Field;
use crate::integrate::method::{self, Adaptive, ErrorEstimate, Method, Weights};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::controller::{
    Controller, ControllerState, StepContext, StepLaw, Trial, Verdict,
};
use crate::integrate::step::fast_exp2::{exp2, log2};
use crate::integrate::step::projection::Tangent;
use crate::integrate::step::short::shortest;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, System, is_constrained};
use crate::time::Time;

/// The least tolerance that coefficients with the precision of `f64` support, for any scalar.
const ONE_WORD: f64 = 10.0 * f64::EPSILON;

/// A controller that makes steps as long as the error allows.
///
/// A step is accepted if √(mean (eᵢ/(atolᵢ + rtol·max(|yᵢ|, |yᵢ′|)))²) ≤ 1 over all coordinates and
/// velocities, where e is the error estimate of the method and y, y′ are the values before and
/// after the step. Tolerances bound the error of one step. The error at the end also depends on the
/// number of steps, and on the amplification of errors by the motion: the errors of N steps that do
/// not cancel add up to N tolerances. A drive of a kilohertz takes thousands of steps a second, and
/// needs a tolerance that is smaller by as many digits.
///
/// The default of `atol` is `rtol`, in the units of each coordinate and velocity, for every method.
/// The error is compared with atol + rtol·|y|, and only with atol if y passes through zero or comes
/// to rest. With an `atol` that follows `rtol`, the error there follows `rtol` too. With a fixed
/// number it does not: beside `rtol` 1e-3, 1e-9 requires six digits more near zero than elsewhere,
/// and thus many unnecessary steps; beside 1e-12, it allows a thousand times the error requested.
/// For coordinates that are much smaller or greater than one, set the scale by [`atol`](Self::atol)
/// or [`atol_each`](Self::atol_each).
///
/// A step that would end beyond a target (kink, stop, end) is cut there, and a step that would end
/// less than 1 % before the target is stretched to it. If less than two steps are left, they are
/// made equal, so that no sliver is left. The length before a cut is restored afterwards. The first
/// step follows Hairer, Nørsett and Wanner (1993), II.4.
///
/// The error estimate contains the accelerations at a few times only, and misses features between
/// two of these times. The times are therefore at most 1.5 widths apart, where a width is the time
/// scale of functions of time. For functions in the equations, `lagrangian!` determines the width
/// where it can ([`System::longest_step`]). Motions return it by
/// [`Motion::longest_step`](crate::motion::Motion::longest_step), and a
/// [`Function`](crate::motion::Function) contains it as its `resolution`. Without a resolution, a
/// step over the function is at most a fiftieth of the interval long, or one second for an
/// [`Integrator`](crate::integrate::Integrator) without an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptiveStep<const N: usize> {
    rtol: Option<f64>,
    atol: Option<([f64; N], [f64; N])>,
    first_step: Option<f64>,
    max_step: f64,
}

impl<const N: usize> Default for AdaptiveStep<N> {
    fn default() -> Self {
        Self { rtol: None, atol: None, first_step: None, max_step: 1e300 }
    }
}

impl<const N: usize> AdaptiveStep<N> {
    /// Creates a controller with an `rtol` of 1e-6 (100 machine epsilons for `f32`) and the same
    /// `atol`.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the relative tolerance.
    ///
    /// Runge–Kutta methods return an error for less than ten machine epsilons of the scalar.
    /// [`Picard`](crate::integrate::Picard) and [`Taylor`](crate::integrate::Taylor) take any
    /// positive number; their errors do not fall below the rounding of a coordinate. The absolute
    /// tolerance, which is equal by default, has no such bound. With scalars of two words, methods
    /// other than `Taylor` reach no tolerance below 2.3e-15; smaller values count as 2.3e-15.
    pub fn rtol(mut self, rtol: f64) -> Self {
        self.rtol = Some(rtol);
        self
    }

    /// Sets the absolute tolerance of all coordinates and velocities; the default is `rtol`. In
    /// single precision, less than 1.2e-38, the least number with all digits, counts as 1.2e-38.
    pub fn atol(self, atol: f64) -> Self {
        self.atol_each([atol; N], [atol; N])
    }

    /// Sets the absolute tolerances of each coordinate and of each velocity.
    pub fn atol_each(mut self, q: [f64; N], v: [f64; N]) -> Self {
        self.atol = Some((q, v));
        self
    }

    /// Sets the length of the first step in seconds, which is chosen automatically by default.
    pub fn first_step(mut self, step: f64) -> Self {
        self.first_step = Some(step);
        self
    }

    /// Sets the maximum length of a step in seconds.
    pub fn max_step(mut self, step: f64) -> Self {
        self.max_step = step;
        self
    }

    fn relative<T: Float>(&self) -> f64 {
        let least = 100.0 * T::EPSILON.to_f64();
        self.rtol.unwrap_or(if 1e-6 < least { least } else { 1e-6 })
    }

    /// Returns the reciprocal of the error allowed between `from` and `to`.
    fn weights<T: Float>(&self, from: &Endpoint<T, N>, to: &Endpoint<T, N>) -> Weights<N> {
        let (rtol, atol) = self.tolerances::<T>();
        let larger = |a: T, b: T| {
            let (a, b) = (a.to_f64().abs(), b.to_f64().abs());
            if a < b { b } else { a }
        };
        Weights {
            q: core::array::from_fn(|i| {
                1.0 / (atol.0[i] + rtol * larger(from.q.high[i], to.q.high[i]))
            }),
            v: core::array::from_fn(|i| {
                1.0 / (atol.1[i] + rtol * larger(from.v.high[i], to.v.high[i]))
            }),
        }
    }
}

impl<M, D, const N: usize> Controller<M, D, N> for AdaptiveStep<N>
where
    M: ErrorEstimate<D, N> + Adaptive,
    D: Dynamics<N, Scalar: Float>,
{
    fn check(&self) -> Result<(), Error> {
        self.positive::<D::Scalar>()?;
        let rtol = self.relative::<D::Scalar>();
        if rtol < 10.0 * D::Scalar::EPSILON.to_f64() {
            let required = "at least ten machine epsilons of the scalar (2.3e-15 for f64, 1.2e-6 for f32, 5e-31 for two words)";
            return Err(Error::Setting { name: "rtol", value: rtol, required });
        }
        Ok(())
    }

    fn accuracy(&self) -> Option<(f64, [[f64; N]; 2])> {
        let (relative, (q, v)) = self.tolerances::<D::Scalar>();
        Some((relative, [q, v]))
    }

    fn least_steps(&self, length: f64) -> f64 {
        self.least_steps_over(length)
    }

    #[inline]
    fn step(
        &self,
        state: &mut ControllerState,
        context: StepContext<'_, '_, D, M, N>,
    ) -> Result<StepInterval, Error> {
        self.take_step(state, context)
    }
}

impl<M, D, const N: usize> StepLaw<M, D, N> for AdaptiveStep<N>
where
    M: ErrorEstimate<D, N> + Adaptive,
    D: Dynamics<N, Scalar: Float>,
{
    #[inline]
    fn propose(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, M, N>,
    ) -> Result<Trial, Error> {
        if state.h == 0.0 {
            let (order, first) = (M::ORDER, self.first_step);
            state.h = match first {
                Some(step) => context.started().map(|_| step)?,
                None => self.in_one_word::<D::Scalar>().automatic_step(order, context)?,
            };
            state.error = log2(1e-4);
        }
        let wanted = if state.h < self.max_step { state.h } else { self.max_step };
        let StepContext { field, from, target, .. } = context;
        Ok(Trial::new(state.within_sight(wanted, field.dynamics, from.t, M::GAP)?, *target))
    }

    #[inline]
    fn interval(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, M, N>,
        trial: &mut Trial,
    ) -> Result<StepInterval, Error> {
        self.resolved(context, trial, |context| self.worst(state, context))?;
        Ok(fit(context.from.t, trial.wanted, trial.target))
    }

    #[inline]
    fn estimate(
        &self,
        context: &mut StepContext<'_, '_, D, M, N>,
        _: &Trial,
        interval: &StepInterval,
    ) -> f64 {
        let StepContext { method, field, from, to, workspace, .. } = context;
        **to = method.attempt(field, interval, from, workspace);
        self.error_of(*method, field, interval, from, to, workspace)
    }

    #[inline]
    fn judge(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, M, N>,
        trial: &mut Trial,
        interval: &StepInterval,
        error: f64,
    ) -> Result<Verdict, Error> {
        let (response, h, wanted) = (M::RESPONSE, interval.h.abs(), trial.wanted);
        let retried = 0 < trial.rejected;
        if error <= 1.0 {
            let error = log2(error);
            let factor =
                response.safety * exp2(response.beta * state.error - response.alpha * error);
            state.h = h * if factor < response.least { response.least } else { factor };
            // A step that was cut contains little information about longer steps, and none if its
            // error is a rounding error. The length wanted before remains possible.
            let longest = if retried { h } else { h * response.greatest };
            let longest = if longest < wanted && !retried { wanted } else { longest };
            if longest < state.h {
                state.h = longest;
            } else if h < 0.5 * wanted && state.h < wanted && !retried {
                state.h = wanted;
            }
            if wanted <= h {
                state.error = if error < log2(1e-4) { log2(1e-4) } else { error };
            }
            return Ok(Verdict::Accept);
        }
        let length = if error.is_nan() {
            context.note_fault(trial, interval)?;
            0.1 * h
        } else {
            trial.fault = None;
            let factor = response.safety * exp2(-response.alpha * log2(error));
            h * if factor < response.least { response.least } else { factor }
        };
        Ok(Verdict::Reject { length })
    }
}

impl<const N: usize> AdaptiveStep<N> {
    /// Returns the error of the step that `method` has just taken, relative to the error allowed;
    /// NaN if the end of the step is not finite.
    #[inline]
    pub(crate) fn error_of<D, M, const W: bool>(
        &self,
        method: &M,
        field: &Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        to: &Endpoint<D::Scalar, N>,
        workspace: &M::Workspace,
    ) -> f64
    where
        D: Dynamics<N, Scalar: Float>,
        M: ErrorEstimate<D, N>,
    {
        if !to.is_finite() {
            return f64::NAN;
        }
        let weights = self.in_one_word::<D::Scalar>().weights(from, to);
        let error = method.error(workspace, interval.h.abs(), &weights);
        if const { !is_constrained::<D, N>() } || error <= 1.0 {
            return error;
        }
        let tangent = Tangent::new(&from.phase(field.dynamics(), field.side()));
        let along = method.error_along(workspace, interval.h.abs(), &weights, |estimate| {
            tangent.take_off(estimate);
        });
        self.on_constraints::<D::Scalar>(error, along)
    }

    /// Returns the error of a step whose end is projected onto the constraints, from the whole
    /// error and the part along the constraints.
    fn on_constraints<T: Float>(&self, whole: f64, along: f64) -> f64 {
        let (relative, _) = self.tolerances::<T>();
        let square = BENT * relative * whole * whole;
        // NaN fails the comparison.
        if along < whole && square < whole { f64::max(along, square) } else { whole }
    }

    /// Returns an error if time does not resolve an attempt that does not reach the target. `worst`
    /// returns the coordinate named in the error.
    #[inline(always)]
    pub(crate) fn resolved<D, M>(
        &self,
        context: &mut StepContext<'_, '_, D, M, N>,
        trial: &mut Trial,
        worst: impl FnOnce(&mut StepContext<'_, '_, D, M, N>) -> usize,
    ) -> Result<(), Error>
    where
        D: Dynamics<N, Scalar: Float>,
        M: Method<D, N>,
    {
        let (t, step) = (context.from.t, trial.wanted);
        if !(step <= resolution_of::<D::Scalar>(t) && step < t.since(trial.target).abs()) {
            return Ok(());
        }
        let first = context.stats.accepted + context.stats.rejected == 0;
        if let Some(error) = self.unresolved(first, step) {
            return Err(error);
        }
        let error = trial.fault.take().map_or_else(
            || {
                let coordinate = <D::System as System<N>>::FACTS.coordinate(worst(context));
                Error::StepSizeUnderflow { t: t.to_f64(), step, coordinate }
            },
            |fault| at(fault, t),
        );
        let interval = fit(t, step, trial.target);
        Err(method::beyond_tables(context.field.dynamics, &interval, context.from, error))
    }

    /// Raises the relative tolerance to the least value that coefficients rounded to one word
    /// support. The error of these coefficients exceeds smaller tolerances for any length of step.
    fn in_one_word<T: Float>(&self) -> Self {
        let rtol = self.relative::<T>();
        Self { rtol: Some(if rtol < ONE_WORD { ONE_WORD } else { rtol }), ..*self }
    }

    /// Returns the relative tolerance, and the absolute tolerances of coordinates and velocities.
    ///
    /// An absolute tolerance is at least the least normal number of the scalar: smaller numbers
    /// have fewer digits, and no step is short enough for the error of their rounding.
    #[inline]
    pub(crate) fn tolerances<T: Float>(&self) -> (f64, ([f64; N], [f64; N])) {
        let (rtol, least) = (self.relative::<T>(), shortest::<T>());
        let (q, v) = self.atol.unwrap_or(([rtol; N], [rtol; N]));
        let normal = |atol: f64| if atol < least { least } else { atol };
        (rtol, (q.map(normal), v.map(normal)))
    }

    /// Returns a lower bound of the number of steps over an interval of this length.
    pub(crate) fn least_steps_over(&self, length: f64) -> f64 {
        length / self.max_step
    }

    /// Returns `true` if the length of the first step has been set.
    pub(crate) fn limits_first(&self) -> bool {
        self.first_step.is_some()
    }

    /// Limits the length of a step by the settings.
    #[inline(always)]
    pub(crate) fn limited(&self, first: bool, wanted: f64) -> f64 {
        let wanted = if self.max_step < wanted { self.max_step } else { wanted };
        match self.first_step {
            Some(step) if first && step < wanted => step,
            _ => wanted,
        }
    }

    /// Returns the error for a step of the length `wanted`, which time does not resolve, if
    /// `first_step` requested this length.
    pub(crate) fn unresolved(&self, first: bool, wanted: f64) -> Option<Error> {
        let value = self.first_step.filter(|step| first && *step <= wanted)?;
        let required = "long enough to be told from zero at the start: above 1e-200 s, and above 1e-26 of the time there";
        Some(Error::Setting { name: "first_step", value, required })
    }

    /// Checks that all settings are positive.
    pub(crate) fn positive<T: Float>(&self) -> Result<(), Error> {
        let positive = |name, value: f64| {
            let fine = (f64::MIN_POSITIVE..f64::INFINITY).contains(&value);
            if fine {
                Ok(())
            } else {
                Err(Error::Setting { name, value, required: "positive and finite" })
            }
        };
        positive("rtol", self.relative::<T>())?;
        if let Some((q, v)) = self.atol {
            q.into_iter().chain(v).try_for_each(|atol| positive("atol", atol))?;
        }
        self.first_step.map_or(Ok(()), |step| positive("first_step", step))?;
        if 0.0 < self.max_step {
            Ok(())
        } else {
            Err(Error::Setting { name: "max_step", value: self.max_step, required: "positive" })
        }
    }

    /// Returns the length h of a first step with hᵖ·d = 0.01, where p is `order` and d the larger
    /// norm of the first and the second derivative of the state, in units of the tolerances.
    pub(crate) fn automatic_step<D, M>(
        &self,
        order: u32,
        context: &mut StepContext<'_, '_, D, M, N>,
    ) -> Result<f64, Error>
    where
        D: Dynamics<N, Scalar: Float>,
        M: Method<D, N>,
    {
        let a0 = context.started()?;
        let StepContext { field, from, target, .. } = context;
        let (limit, backwards) = (from.t.since(*target).abs(), *target < from.t.to_f64());
        let towards = if backwards { -1.0 } else { 1.0 };
        let weights = self.weights(from, from);
        let norm = |q: &[D::Scalar; N], v: &[D::Scalar; N]| {
            (weights.square_sum(q, v) / (2 * N) as f64).sqrt()
        };
        let (q0, v0) = (from.q.high, from.v.high);
        let (state, slope) = (norm(&q0, &v0), norm(&v0, &a0));
        let guess = if 1e-5 < state && 1e-5 < slope { 0.01 * (state / slope) } else { 1e-6 };
        // If the norms overflow, the guess is useless.
        let guess = if 1e-100 < guess { guess } else { 1e-6 };
        let h = if limit < guess { limit } else { guess };
        let step = D::Scalar::from_f64(towards * h);
        let q1 = core::array::from_fn(|i| q0[i] + step * v0[i]);
        let v1 = core::array::from_fn(|i| v0[i] + step * a0[i]);
        let a1 = field.at(from.t + towards * h, field.side().opposite(), &q1, &v1);
        let change = norm(
            &core::array::from_fn(|i| v1[i] - v0[i]),
            &core::array::from_fn(|i| a1[i] - a0[i]),
        ) / h;
        let curvature = if change < slope { slope } else { change };
        let longer = if curvature <= 1e-15 {
            if 1e-3 * h < 1e-6 { 1e-6 } else { 1e-3 * h }
        } else if curvature < f64::INFINITY {
            exp2(log2(0.01 / curvature) / f64::from(order))
        } else {
            1e-3 * h
        };
        let step = if longer < 100.0 * h { longer } else { 100.0 * h };
        // Time does not resolve a shorter step. The error decides on a longer one.
        let least = 2.0 * resolution_of::<D::Scalar>(from.t);
        Ok(if step < least { least } else { step })
    }

    /// Returns the coordinate with the largest error in the last step tried.
    fn worst<D: Dynamics<N, Scalar: Float>, M: ErrorEstimate<D, N>>(
        &self,
        state: &ControllerState,
        context: &StepContext<'_, '_, D, M, N>,
    ) -> usize {
        let StepContext { method, from, workspace, .. } = context;
        let all = self.in_one_word::<D::Scalar>().weights(from, from);
        let mut worst = (0, 0.0);
        for index in 0..N {
            let mut weights = Weights { q: [0.0; N], v: [0.0; N] };
            (weights.q[index], weights.v[index]) = (all.q[index], all.v[index]);
            let error = method.error(workspace, state.h, &weights);
            if worst.1 < error {
                worst = (index, error);
            }
        }
        worst.0
    }
}

/// Bound on the curvature of constraints, relative to the state: an error e across the constraints
/// leaves an error `BENT` e² along them.
const BENT: f64 = 100.0;

/// Returns the length below which time does not resolve a step: the second word of the time has to
/// represent the step to about ten digits.
#[inline(always)]
pub(crate) fn resolution(t: Time) -> f64 {
    let resolution = 1e-26 * t.to_f64().abs();
    if resolution < 1e-200 { 1e-200 } else { resolution }
}

/// Returns [`resolution`], or the shortest length that the scalar represents if it is longer.
#[inline(always)]
pub(crate) fn resolution_of<T: Float>(t: Time) -> f64 {
    let (time, scalar) = (resolution(t), shortest::<T>());
    if time < scalar { scalar } else { time }
}

/// Sets the time of a fault to `t`, the start of steps that fail at any length.
pub(crate) fn at(fault: Error, t: Time) -> Error {
    match fault {
        Error::NotFinite { what, suspects, .. } => {
            Error::NotFinite { t: t.to_f64(), what, suspects }
        }
        other => other,
    }
}

/// Returns the step of length `wanted` from `t`, or a step that neither goes beyond `target` nor
/// leaves a sliver before it.
#[inline]
pub(crate) fn fit(t: Time, wanted: f64, target: f64) -> StepInterval {
    let left = -t.since(target);
    if left.abs() <= 1.01 * wanted {
        StepInterval::to(t, target)
    } else if left.abs() < 2.0 * wanted {
        StepInterval::by(t, 0.5 * left)
    } else {
        StepInterval::by(t, wanted.copysign(left))
    }
}

#[cfg(test)]
mod tests {
    use super::{Time, fit};

    #[test]
    fn no_slivers() {
        let length = |wanted, target| fit(Time::new(0.0), wanted, target).h;
        assert_eq!(length(1.0, f64::INFINITY), 1.0);
        assert_eq!(length(1.0, 2.5), 1.0);
        assert_eq!(length(1.0, 1.5), 0.75);
        assert_eq!(length(1.0, 1.009), 1.009);
        assert_eq!(length(1.0, 0.3), 0.3);
        assert_eq!(fit(Time::new(0.1), 1.0, 0.3).end, Time::new(0.3));
    }
}
