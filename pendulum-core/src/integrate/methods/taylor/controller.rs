//! The step law of adaptive Taylor steps.

use super::doubts::{Doubts, MOST_DOUBTS};
use super::method::{GAP, Taylor, Workspace, WorkspaceOf, expand, side, sum};
use super::rule::{Rule, ends, largest, length};
use crate::error::Error;
use crate::integrate::field::Field;
use crate::integrate::method;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::adaptive::{AdaptiveStep, fit, resolution_of};
use crate::integrate::step::controller::{
    Controller, ControllerState, StepContext, StepLaw, Trial, Verdict,
};
use crate::jet::{JetDynamics, Jets, Path, Series};
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, Facts, System};

impl<D, const N: usize, const KNOWN: bool> Controller<Taylor<KNOWN>, D, N> for AdaptiveStep<N>
where
    D: JetDynamics<N, KNOWN, Scalar: Float>,
{
    fn check(&self) -> Result<(), Error> {
        self.positive::<D::Scalar>()
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
        context: StepContext<'_, '_, D, Taylor<KNOWN>, N>,
    ) -> Result<StepInterval, Error> {
        self.take_step(state, context)
    }
}

impl<D, const N: usize, const KNOWN: bool> StepLaw<Taylor<KNOWN>, D, N> for AdaptiveStep<N>
where
    D: JetDynamics<N, KNOWN, Scalar: Float>,
{
    fn propose(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, Taylor<KNOWN>, N>,
    ) -> Result<Trial, Error> {
        let StepContext { method, field, from, workspace, target, .. } = context;
        let (t, target) = (from.t.to_f64(), *target);
        // A target may lie within the low word of the time.
        let backwards = 0.0 < from.t.since(target);
        let found = if backwards {
            field.dynamics.last_break(t).filter(|time| target < *time)
        } else {
            field.dynamics.next_break(t).filter(|time| *time < target)
        };
        if let Some(kink) = found
            && if backwards { t <= kink } else { kink <= t }
        {
            return Err(Error::Kink { t, kink });
        }
        let target = found.unwrap_or(target);
        let (rtol, atol) = self.tolerances::<D::Scalar>();
        if workspace.rule.tolerance != rtol {
            workspace.rule = Rule::new(method.order_for(rtol, D::System::PER_DIGIT), rtol);
        }
        let side = if backwards { Side::Before } else { Side::After };
        expand::<D, N, KNOWN, _>(field, from, side, workspace.rule.order, workspace);
        workspace.weights = [
            core::array::from_fn(|i| 1.0 / (atol.0[i] + rtol * from.q.high[i].to_f64().abs())),
            core::array::from_fn(|i| 1.0 / (atol.1[i] + rtol * from.v.high[i].to_f64().abs())),
        ];
        let wanted = length(&workspace.path, &workspace.rule, &workspace.weights);
        // From zero, a tolerance may allow no step at all. A series that ends has no error.
        let polynomial = wanted <= resolution_of::<D::Scalar>(from.t)
            && ends(&workspace.path, &workspace.rule, &workspace.weights);
        let wanted = if polynomial { f64::INFINITY } else { wanted };
        // The series of a uniform motion does not limit the step; without a target it is 1 s.
        let wanted = if wanted == f64::INFINITY && target.is_infinite() { 1.0 } else { wanted };
        let wanted = self.limited(state.h == 0.0, wanted);
        let wanted = state.within_sight(wanted, field.dynamics, from.t, GAP)?;
        if state.h == 0.0 {
            // At a start no jumps are known.
            workspace.doubts = Doubts::default();
        }
        let resolution = resolution_of::<D::Scalar>(from.t);
        let wanted = workspace.doubts.begin(from.t, backwards, resolution, wanted);
        workspace.whole = fit(from.t, wanted, target);
        Ok(Trial::new(wanted, target))
    }

    fn interval(
        &self,
        _: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, Taylor<KNOWN>, N>,
        trial: &mut Trial,
    ) -> Result<StepInterval, Error> {
        Ok(fit(context.from.t, trial.wanted, trial.target))
    }

    /// Compares the accelerations at the end of the step with those of the series. Returns 0 if the
    /// difference is allowed or not checked, and infinity if it is not allowed.
    fn estimate(
        &self,
        context: &mut StepContext<'_, '_, D, Taylor<KNOWN>, N>,
        trial: &Trial,
        interval: &StepInterval,
    ) -> f64 {
        let StepContext { field, from, to, workspace, .. } = context;
        **to = sum(workspace, from, interval);
        let order = workspace.rule.order;
        let finite = |series: &Series<D::Scalar>| series[..=order].iter().all(|x| x.is_finite());
        let Path { q, v, .. } = &workspace.path;
        let known =
            0 < trial.rejected || to.is_finite() || (0..N).all(|i| finite(&q[i]) && finite(&v[i]));
        // No step can be shorter than the resolution of times.
        let shortest = trial.wanted <= resolution_of::<D::Scalar>(from.t);
        if !known || shortest || workspace.doubts.trusts {
            return 0.0;
        }
        let strict = 0 < trial.rejected || workspace.doubts.refuted.is_some();
        let misfit = misfit(field, workspace, interval, to, strict);
        workspace.doubts.holds &= misfit.allowed;
        workspace.doubts.rounding = misfit.rounding;
        if misfit.allowed || MOST_DOUBTS <= workspace.doubts.count { 0.0 } else { f64::INFINITY }
    }

    fn judge(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, Taylor<KNOWN>, N>,
        trial: &mut Trial,
        interval: &StepInterval,
        error: f64,
    ) -> Result<Verdict, Error> {
        if 1.0 < error {
            let whole = context.workspace.whole.h.abs();
            let doubts = &mut context.workspace.doubts;
            return Ok(Verdict::Reject { length: doubts.shorten(trial, interval, whole) });
        }
        let StepContext { method, field, from, to, workspace, .. } = context;
        if !to.is_finite() {
            return Err(method::cause(*method, field, &workspace.whole, from, workspace));
        }
        self.resolved(context, trial, |context| {
            let Workspace { path, order, weights, .. } = &*context.workspace;
            largest(path, *order, weights).1
        })?;
        context.workspace.doubts.accept(0 < trial.rejected, trial.wanted);
        state.h = trial.wanted;
        Ok(Verdict::Accept)
    }
}

/// The largest error of a step, over the error allowed, at which its series still counts as valid
/// at its end.
pub(crate) const MISFIT: f64 = 30.0;

/// The misfit of a series at the end of its step.
pub(crate) struct Misfit {
    /// `true` if the accelerations agree with those of the series.
    pub(crate) allowed: bool,
    /// `true` if they differ by at most a thousand times the assumed rounding error.
    pub(super) rounding: bool,
}

/// The values at both ends of a step from which the misfit of its series is computed.
pub(crate) struct Ends<'a, T, const N: usize> {
    pub(crate) interval: &'a StepInterval,
    pub(crate) order: usize,
    /// The coordinates at the start.
    pub(crate) q: [T; N],
    /// The accelerations at the start.
    pub(crate) a: [T; N],
    /// One over the errors allowed of the velocities.
    pub(crate) weights: [f64; N],
    /// The state at the end.
    pub(crate) to: &'a Endpoint<T, N>,
    /// The accelerations at the end.
    pub(crate) end: [T; N],
    /// The accelerations of the series at the end.
    pub(crate) series: [T; N],
}

/// Returns the misfit of the series in `workspace` at the end `to` of its step, from one evaluation
/// of the accelerations there. `strict` applies after a series that was not valid.
fn misfit<D: Dynamics<N, Scalar: Float, System: Jets<N>>, const N: usize>(
    field: &Field<'_, D, N>,
    workspace: &WorkspaceOf<D, N>,
    interval: &StepInterval,
    to: &Endpoint<D::Scalar, N>,
    strict: bool,
) -> Misfit {
    let (h, zero) = (interval.length::<D::Scalar>(), D::Scalar::from_f64(0.0));
    // A separate field, because this method counts the orders of its series as evaluations.
    let mut end = Field::new(field.dynamics, field.prepared);
    let end = end.at(interval.end, side(interval.h).opposite(), &to.q.high, &to.v.high);
    let (q, v) = (&workspace.path.q, &workspace.path.v);
    let series = core::array::from_fn(|i| {
        let orders = (1..=workspace.order).rev();
        orders.fold(zero, |sum, k| sum * h + D::Scalar::from_f64(k as f64) * v[i][k])
    });
    let ends = Ends {
        interval,
        order: workspace.order,
        q: core::array::from_fn(|i| q[i][0]),
        a: core::array::from_fn(|i| v[i][1]),
        weights: workspace.weights[1],
        to,
        end,
        series,
    };
    ends.misfit(&<D::System as System<N>>::FACTS, strict)
}

impl<T: Float, const N: usize> Ends<'_, T, N> {
    /// Returns the misfit from the difference between the accelerations at the end of a step and
    /// those of the series: h |a − Σ k v\[k\] hᵏ⁻¹|/p in units of the error allowed, or without the
    /// division by p if `strict`.
    ///
    /// A series contains only the derivatives at its centre: its coefficients contain no
    /// information about a distant wall, contact or switch. The assumed rounding error is a
    /// thousand ε of velocities, accelerations, coordinates and time.
    pub(crate) fn misfit(&self, facts: &Facts, strict: bool) -> Misfit {
        let Self { interval, order, q, a, weights, to, end, series } = self;
        // Motions have the accuracy of `f64`.
        let epsilon = T::EPSILON.to_f64();
        let rounding = 1e3
            * if facts.inputs.is_empty() || f64::EPSILON < epsilon {
                epsilon
            } else {
                f64::EPSILON
            };
        let largest = |values: &dyn Fn(usize) -> T| {
            (0..N).fold(0.0, |largest: f64, i| largest.max(values(i).to_f64().abs()))
        };
        // Coordinates and time are rounded too, and the accelerations change with both at the rate
        // at which they change over the step. The smaller of the changes of both accelerations is
        // used, because a jump is not a slope.
        let way = largest(&|i| to.q.high[i] - q[i]);
        let turns = [largest(&|i| end[i] - a[i]), largest(&|i| series[i] - a[i])];
        let turn = if turns[1] < turns[0] { turns[1] } else { turns[0] };
        let by_place = if 0.0 < way { largest(&|i| to.q.high[i]) * (turn / way) } else { 0.0 };
        let by_time = interval.end.to_f64().abs() * (turn / interval.h.abs());
        let size = largest(&|i| end[i]) + by_place + if facts.autonomous { 0.0 } else { by_time };
        let (mut allowed, mut is_rounding) = (to.is_finite() && size.is_finite(), true);
        for i in 0..N {
            let difference = (end[i] - series[i]).to_f64().abs();
            // The misfit of a smooth series vanishes after a halving; that of a jump does not, and
            // is an error of the velocity in full.
            let (share, most) = if strict { (1.0, 1.0) } else { (*order as f64, MISFIT) };
            let misfit = interval.h.abs() * difference / share;
            let noise = rounding * (to.v.high[i].to_f64().abs() + interval.h.abs() * size);
            allowed &= misfit * weights[i] <= most + noise * weights[i];
            is_rounding &= difference <= 1e3 * rounding * size;
        }
        Misfit { allowed, rounding: is_rounding }
    }
}
