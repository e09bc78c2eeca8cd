//! Taylor series of any order.

// What lanes use too has to be compiled for their vectors.
#![allow(clippy::inline_always)]

use crate::error::{Error, Quantity};
use crate::integrate::interpolant::{Basis, Interpolant, TERMS};
use crate::integrate::method::{self, Method};
use crate::integrate::step::adaptive::{AdaptiveStep, fit, resolution_of};
use crate::integrate::step::controller::{
    Controller, ControllerState, StepContext, StepLaw, Trial, Verdict,
};
use crate::integrate::step::diagnose;
use crate::integrate::step::endpoint::Endpoint;
use crate::integrate::step::fast_exp2::{digits, log2, power};
use crate::integrate::step::field::{Field, coordinate, first_in_state};
use crate::integrate::step::interval::StepInterval;
use crate::jet::{JetDynamics, Jets, LENGTH, MAX_ORDER, Path, Series, Unrolling};
use crate::motion::Side;
use crate::real::{Float, Real};
use crate::system::{Dynamics, System, scalar_time};
use crate::time::Time;

/// The Taylor series of the motion: any order up to 30, adaptive, forwards and backwards in time.
///
/// It suits every system that `lagrangian!` has made and every motion that is
/// [`Analytic`](crate::motion::Analytic), and is the choice for the last digits and for the way
/// back in time. Its steps are long and it rejects few: the coefficients tell the radius of
/// convergence. It is explicit: a stiff spring or damper shortens its steps.
///
/// A series knows nothing of a wall or a contact far from its centre. The accelerations a at the
/// end of each step are therefore compared with those of the series of order p. A step is halved
/// where h·|Δa|/p is more than 30 times the error allowed; after a first halving, where h·|Δa| is
/// more than that error. Differences below a thousand units of rounding are allowed. After forty
/// halvings the shortest step goes over what must be a jump. If 256 steps are halved, and
/// none of them is a thousand times as long as one before it, the accelerations are taken to be
/// inexact, and whole steps are taken until series hold again. Each comparison is one evaluation, which [`Stats`](crate::integrate::Stats) do not count: there each order of the series is
/// one. A needle or a thin wall goes unseen if a step ends behind it. The method is wrong where the
/// equations themselves are not smooth: at the zeros of `abs` and `sign`, and where the larger of
/// two numbers changes.
///
/// The order is p = ⌈1 − c ln rtol⌉ with c = 0.8 for a coordinate that swings by itself and 0.7
/// else, and the step is h = ρ rtol^(1/p) e^(−0.7/(p−1)), where ρ is the least of the radii of
/// convergence (rtol · max |xᵢ\[k\]|/εᵢ)^(−1/k) that the last four orders k tell, with εᵢ = atolᵢ +
/// rtol·|xᵢ| over all coordinates and velocities; where they vanish, the orders before tell it.
/// (With c = ½ the work would be least if it grew with p²; measured, it grows with p^1.4 and less.)
/// `rtol` may be as small as you like: 1e-18 takes the truncation well below rounding. Fixed steps
/// have the order for the machine epsilon and c = 0.7, without [`order`](Self::order).
///
/// The sum of the series is compensated. Dense output is the series itself and costs nothing.
///
/// Source: Jorba and Zou (2005), A software package for the numerical integration of ODEs by means
/// of high-order Taylor methods, Exp. Math. 14, 99.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Taylor {
    order: Option<usize>,
}

impl Taylor {
    /// The method with the order that the tolerance asks for.
    pub const fn new() -> Self {
        Self { order: None }
    }

    /// The order instead, from 2 to 30; what lies beyond becomes the nearest of them.
    pub const fn order(self, order: usize) -> Self {
        let order = if order < 2 { 2 } else { order };
        Self { order: Some(if MAX_ORDER < order { MAX_ORDER } else { order }) }
    }

    /// The order for a tolerance, `per_digit` for each e-th part.
    fn order_for(self, tolerance: f64, per_digit: f64) -> usize {
        let best = (1.0 - per_digit * core::f64::consts::LN_2 * log2(tolerance)).ceil();
        self.order.unwrap_or(best.clamp(2.0, MAX_ORDER as f64) as usize)
    }

    /// The order of fixed steps.
    fn fixed<T: Float>(self) -> usize {
        self.order_for(T::EPSILON.to_f64(), 0.7)
    }
}

/// The jet at the start of a step.
#[derive(Clone, Debug)]
pub struct Workspace<T, W, X, const N: usize> {
    path: Path<T, N>,
    drive: X,
    work: W,
    /// The order of the jet.
    order: usize,
    /// What the tolerance decides.
    rule: Rule,
    /// One over the errors allowed of coordinates and velocities at the start.
    weights: [[f64; N]; 2],
    /// The step as it would be if its series held.
    whole: StepInterval,
    doubts: Doubts,
}

/// A jump is found within some forty steps, and behind it they are long again. If series go on not
/// to hold, the accelerations are not exact.
const MOST_DOUBTS: u32 = 256;

/// A step is long again if it is so many times as long as the shortest before it.
const FOUND: f64 = 1e3;

/// What the tolerance decides about the length of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rule {
    tolerance: f64,
    pub(crate) order: usize,
    /// For each order what its coefficient tells where it is 2^−1023, and how much less for one
    /// that is twice as large, over 2³².
    told: [(f64, f64); LENGTH],
}

impl Rule {
    pub(crate) fn new<S: Jets<N>, const N: usize>(method: Taylor, tolerance: f64) -> Self {
        let (order, binary) = (method.order_for(tolerance, S::PER_DIGIT), log2(tolerance));
        let margin = binary / order as f64 - 0.7 * core::f64::consts::LOG2_E / (order as f64 - 1.0);
        let told = core::array::from_fn(|k| {
            let k = k.max(1) as f64;
            (1023.0 + margin + (1023.0 - binary) / k, 1.0 / (4294967296.0 * k))
        });
        Self { tolerance, order, told }
    }

    /// 1023 and the binary logarithm of the step that a coefficient of the order k over the error
    /// allowed tells, (coefficient · rtol)^(−1/k) times the margin; infinite where it is zero.
    #[inline(always)]
    pub(crate) fn told(&self, coefficient: f64, k: usize) -> f64 {
        let (most, slope) = self.told[k];
        let told = most - slope * digits(coefficient);
        if 0.0 < coefficient { told } else { f64::INFINITY }
    }
}

/// The room for the jets of the dynamics `D`.
pub(crate) type WorkspaceOf<D, const N: usize> = Workspace<
    <D as Dynamics<N>>::Scalar,
    <<D as Dynamics<N>>::System as Jets<N>>::Work,
    <<D as Dynamics<N>>::System as Jets<N>>::Drive,
    N,
>;

impl<D: JetDynamics<N, Scalar: Float>, const N: usize> Method<D, N> for Taylor {
    const NAME: &'static str = "Taylor";
    type Workspace = WorkspaceOf<D, N>;

    fn goes_back(&self, _: &D) -> bool {
        true
    }

    fn workspace(&self, dynamics: &D) -> WorkspaceOf<D, N> {
        Workspace {
            path: Path::new(),
            drive: D::System::drive(),
            work: dynamics.system().work(),
            order: 0,
            rule: Rule::default(),
            weights: [[0.0; N]; 2],
            whole: StepInterval::by(Time::new(0.0), 0.0),
            doubts: Doubts::default(),
        }
    }

    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        workspace: &mut WorkspaceOf<D, N>,
    ) -> Endpoint<D::Scalar, N> {
        let order = self.fixed::<D::Scalar>();
        expand(field, from, side(interval.h), order, workspace);
        sum(workspace, from, interval)
    }

    fn interpolant(
        &self,
        _: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        _: &mut Endpoint<D::Scalar, N>,
        workspace: &mut WorkspaceOf<D, N>,
    ) -> Interpolant<D::Scalar, N> {
        let (h, zero) = (interval.length::<D::Scalar>(), [[D::Scalar::from_f64(0.0); N]; TERMS]);
        let (q0, v0) = (from.q.high, from.v.high);
        let mut interpolant = Interpolant {
            interval: *interval,
            q0,
            v0,
            q: zero,
            v: zero,
            terms: workspace.order,
            basis: Basis::Powers,
        };
        let mut power = h;
        for k in 1..=workspace.order {
            for i in 0..N {
                interpolant.q[k - 1][i] = workspace.path.q[i][k] * power;
                interpolant.v[k - 1][i] = workspace.path.v[i][k] * power;
            }
            power *= h;
        }
        interpolant
    }

    fn diagnose(
        &self,
        field: &Field<'_, D, N>,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        _: &WorkspaceOf<D, N>,
    ) -> Option<Error> {
        let (dynamics, side) = (field.dynamics, side(interval.h));
        let mut watched = field.watched();
        watched.at(from.t, side, &from.q.high, &from.v.high);
        let mut workspace = self.workspace(dynamics);
        let order = self.fixed::<D::Scalar>();
        let mut series = Field::new(dynamics, field.prepared);
        expand(&mut series, from, side, order, &mut workspace);
        let facts = &<D::System as System<N>>::FACTS;
        let finite = |series: &Series<D::Scalar>| series.iter().all(|x| x.is_finite());
        let Path { q, v, .. } = &workspace.path;
        let infinite = (0..N).find(|&i| !finite(&v[i]) || !finite(&q[i]));
        let (t, what) = watched
            .findings
            .first
            .or_else(|| {
                infinite.map(|index| (from.t, Quantity::Acceleration(coordinate(facts, index))))
            })
            .or_else(|| {
                let to = sum(&workspace, from, interval);
                first_in_state(facts, &to.q.high, &to.v.high).map(|what| (interval.end, what))
            })?;
        Some(diagnose::not_finite(dynamics.system(), t, what))
    }

    fn kink(&self, dynamics: &D, t: f64, backwards: bool) -> Option<f64> {
        if backwards { dynamics.last_kink(t) } else { dynamics.next_kink(t) }
    }
}

impl<D: JetDynamics<N, Scalar: Float>, const N: usize> Controller<Taylor, D, N>
    for AdaptiveStep<N>
{
    fn check(&self) -> Result<(), Error> {
        self.positive::<D::Scalar>()
    }

    fn least_steps(&self, length: f64) -> f64 {
        self.least_steps_over(length)
    }

    #[inline]
    fn step(
        &self,
        state: &mut ControllerState,
        context: StepContext<'_, '_, D, Taylor, N>,
    ) -> Result<StepInterval, Error> {
        self.take_step(state, context)
    }
}

impl<D: JetDynamics<N, Scalar: Float>, const N: usize> StepLaw<Taylor, D, N> for AdaptiveStep<N> {
    fn propose(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, Taylor, N>,
    ) -> Result<Trial, Error> {
        let StepContext { method, field, from, workspace, target, .. } = context;
        let (t, target) = (from.t.to_f64(), *target);
        let backwards = target < t;
        let target = if backwards {
            field.dynamics.last_break(t).filter(|time| target < *time).unwrap_or(target)
        } else {
            field.dynamics.next_break(t).filter(|time| *time < target).unwrap_or(target)
        };
        let (rtol, atol) = self.tolerances::<D::Scalar>();
        if workspace.rule.tolerance != rtol {
            workspace.rule = Rule::new::<D::System, N>(**method, rtol);
        }
        let side = if backwards { Side::Before } else { Side::After };
        expand(field, from, side, workspace.rule.order, workspace);
        workspace.weights = [
            core::array::from_fn(|i| 1.0 / (atol.0[i] + rtol * from.q.high[i].to_f64().abs())),
            core::array::from_fn(|i| 1.0 / (atol.1[i] + rtol * from.v.high[i].to_f64().abs())),
        ];
        let wanted = length(&workspace.path, &workspace.rule, &workspace.weights);
        // A uniform motion may go on for ever, but it has to come to an end.
        let wanted = if wanted == f64::INFINITY && target == wanted { 1.0 } else { wanted };
        let wanted = self.limited(state.h == 0.0, wanted);
        let wanted = state.within_sight(wanted, field.dynamics, from.t, GAP)?;
        if state.h == 0.0 {
            // At a start nothing is known of jumps.
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
        context: &mut StepContext<'_, '_, D, Taylor, N>,
        trial: &mut Trial,
    ) -> Result<StepInterval, Error> {
        Ok(fit(context.from.t, trial.wanted, trial.target))
    }

    /// The error is that of the accelerations at the end: zero where it is allowed, and infinite
    /// where it is not.
    fn estimate(
        &self,
        context: &mut StepContext<'_, '_, D, Taylor, N>,
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
        // At the resolution of times no step can be shorter.
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
        context: &mut StepContext<'_, '_, D, Taylor, N>,
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

/// Doubts about series, from step to step.
#[derive(Clone, Copy, Debug)]
struct Doubts {
    /// The last time at which a series did not hold.
    refuted: Option<Time>,
    /// How many steps in a row went over a jump, or over something like one.
    crossed: u32,
    /// One more for each step that was halved, two less for each whole step whose series holds, and
    /// none where steps are long again.
    count: u32,
    /// The shortest step of these.
    shortest: f64,
    /// Of the step under way: its series holds, as far as it was looked at.
    holds: bool,
    /// It differs from the accelerations by no more than rounding.
    rounding: bool,
    /// It goes over a jump.
    crosses: bool,
    /// It is taken without another look.
    trusts: bool,
}

impl Default for Doubts {
    fn default() -> Self {
        Self {
            refuted: None,
            crossed: 0,
            count: 0,
            shortest: f64::INFINITY,
            holds: true,
            rounding: false,
            crosses: false,
            trusts: false,
        }
    }
}

impl Doubts {
    /// Begins a step from `t`; its length is `wanted`, or less if a series did not hold before.
    fn begin(&mut self, t: Time, backwards: bool, resolution: f64, wanted: f64) -> f64 {
        let left = |refuted: Time| refuted.since(t.to_f64()) - t.low();
        self.refuted = self.refuted.filter(|&refuted| {
            let left = left(refuted);
            (left < 0.0) == backwards && resolution < left.abs()
        });
        (self.holds, self.crosses, self.trusts) = (self.refuted.is_none(), false, false);
        let left = self.refuted.map_or(f64::INFINITY, |refuted| left(refuted).abs());
        if left < wanted { left } else { wanted }
    }

    /// The length of the next attempt after one whose series does not hold at its end.
    fn shorten(&mut self, trial: &Trial, interval: &StepInterval, whole: f64) -> f64 {
        let halved = trial.rejected + 1;
        self.refuted = Some(interval.end);
        // A jump may be as wide as the rounding of the place: each further step over it is twice as
        // long.
        if halved < MOST_HALVED.saturating_sub(self.crossed) {
            return 0.5 * interval.h.abs();
        }
        // Something jumps within so short a step, which goes over that; or its series is right, and
        // the difference is rounding.
        (self.refuted, self.crosses, self.trusts) = (None, !self.rounding, true);
        if self.crosses { trial.wanted } else { whole }
    }

    /// The step is taken, after shorter attempts if it was `halved`.
    fn accept(&mut self, halved: bool, taken: f64) {
        self.crossed = if self.crosses { self.crossed + 1 } else { 0 };
        if self.count < MOST_DOUBTS && FOUND * self.shortest < taken || self.count == 0 {
            (self.count, self.shortest) = (0, f64::INFINITY);
        }
        if halved {
            self.count += 1;
            self.shortest = if taken < self.shortest { taken } else { self.shortest };
        } else if self.holds {
            self.count = self.count.saturating_sub(2);
        }
        if MOST_DOUBTS <= self.count {
            self.refuted = None;
        }
    }
}

/// A series knows the start of its step alone. It tells a bell from two widths away, and the bound
/// is to leave a sine its steps of 3/ω.
pub(crate) const GAP: f64 = 0.7;

/// The side from which the start of a step is seen.
fn side(h: f64) -> Side {
    if h < 0.0 { Side::Before } else { Side::After }
}

/// The jet at `from`.
#[inline]
fn expand<D: JetDynamics<N, Scalar: Float>, const N: usize, const W: bool>(
    field: &mut Field<'_, D, N, W>,
    from: &Endpoint<D::Scalar, N>,
    side: Side,
    order: usize,
    workspace: &mut WorkspaceOf<D, N>,
) {
    if workspace.order != order {
        // No coefficient of a higher order may stay.
        workspace.path = Path::new();
        workspace.order = order;
    }
    let Workspace { path, drive, work, .. } = workspace;
    path.t = scalar_time(from.t);
    for i in 0..N {
        path.q[i][0] = from.q.high[i];
        path.v[i][0] = from.v.high[i];
    }
    field.dynamics.drive(from.t, side, order, drive);
    <D::System as Jets<N>>::Unrolling::run(field.dynamics.system(), order, path, drive, work);
    field.evaluations += order as u64;
}

/// The state at the end of a step: the sum of the series, to which the products of the first order
/// come with both words.
#[inline]
fn sum<T: Float, W, X, const N: usize>(
    workspace: &Workspace<T, W, X, N>,
    from: &Endpoint<T, N>,
    interval: &StepInterval,
) -> Endpoint<T, N> {
    let h = interval.length::<T>();
    let mut to = Endpoint { t: interval.end, a: None, ..*from };
    for i in 0..N {
        to.q.add_product(
            i,
            h,
            workspace.path.q[i][1],
            rest(&workspace.path.q[i], workspace.order, h),
        );
        to.v.add_product(
            i,
            h,
            workspace.path.v[i][1],
            rest(&workspace.path.v[i], workspace.order, h),
        );
    }
    to
}

/// The error of a step over the one allowed from which on the series does not hold at its end.
const MISFIT: f64 = 30.0;

/// How often a step is halved at most.
const MOST_HALVED: u32 = 40;

/// How well a series holds at the end of its step.
struct Misfit {
    /// The accelerations are those of the series.
    allowed: bool,
    /// They differ by no more than a thousand times what rounding is taken for.
    rounding: bool,
}

/// How far the accelerations at the end of a step are from those of the series: h |a − Σ k v\[k\]
/// hᵏ⁻¹|/p in units of the error allowed.
///
/// A series knows no more than its centre does: of a wall, a contact or a switch far away its
/// coefficients tell nothing. Rounding is taken for a thousand ε of velocities, accelerations,
/// coordinates and time.
fn misfit<D: JetDynamics<N, Scalar: Float>, const N: usize>(
    field: &Field<'_, D, N>,
    workspace: &WorkspaceOf<D, N>,
    interval: &StepInterval,
    to: &Endpoint<D::Scalar, N>,
    strict: bool,
) -> Misfit {
    let (h, zero) = (interval.length::<D::Scalar>(), D::Scalar::from_f64(0.0));
    // Beside the orders of the series, which are what evaluations of this method count.
    let mut end = Field::new(field.dynamics, field.prepared);
    let a = end.at(interval.end, side(interval.h).opposite(), &to.q.high, &to.v.high);
    // Motions have the digits of `f64`.
    let facts = &<D::System as System<N>>::FACTS;
    let epsilon = D::Scalar::EPSILON.to_f64();
    let rounding = 1e3
        * if facts.inputs.is_empty() || f64::EPSILON < epsilon { epsilon } else { f64::EPSILON };
    let largest = |values: &dyn Fn(usize) -> D::Scalar| {
        (0..N).fold(0.0, |largest: f64, i| largest.max(values(i).to_f64().abs()))
    };
    let (q, v, weights) = (&workspace.path.q, &workspace.path.v, &workspace.weights[1]);
    let series: [D::Scalar; N] = core::array::from_fn(|i| {
        let orders = (1..=workspace.order).rev();
        orders.fold(zero, |sum, k| sum * h + D::Scalar::from_f64(k as f64) * v[i][k])
    });
    // Coordinates and time are rounded too, and the accelerations change with them as they do on
    // the way: those of the series, where a jump is no slope.
    let way = largest(&|i| to.q.high[i] - q[i][0]);
    let turns = [largest(&|i| a[i] - v[i][1]), largest(&|i| series[i] - v[i][1])];
    let turn = if turns[1] < turns[0] { turns[1] } else { turns[0] };
    let by_place = if 0.0 < way { largest(&|i| to.q.high[i]) * (turn / way) } else { 0.0 };
    let by_time = interval.end.to_f64().abs() * (turn / interval.h.abs());
    let size = largest(&|i| a[i]) + by_place + if facts.autonomous { 0.0 } else { by_time };
    let (mut allowed, mut is_rounding) = (to.is_finite() && size.is_finite(), true);
    for i in 0..N {
        let difference = (a[i] - series[i]).to_f64().abs();
        // That of a smooth series is gone after a halving; that of a jump is not, and the velocity
        // is off by all of it.
        let (share, most) = if strict { (1.0, 1.0) } else { (workspace.order as f64, MISFIT) };
        let misfit = interval.h.abs() * difference / share;
        let noise = rounding * (to.v.high[i].to_f64().abs() + interval.h.abs() * size);
        allowed &= misfit * weights[i] <= most + noise * weights[i];
        is_rounding &= difference <= 1e3 * rounding * size;
    }
    Misfit { allowed, rounding: is_rounding }
}

/// Σ x\[k\] hᵏ over 2 ≤ k ≤ `order`, beyond which all are zero: every fourth term after Horner
/// (1819), the four sums side by side.
#[inline(always)]
pub(crate) fn rest<T: Real>(series: &Series<T>, order: usize, h: T) -> T {
    let (fours, _) = series.as_chunks::<4>();
    let h2 = h * h;
    let h4 = h2 * h2;
    let [mut a, mut b, mut c, mut d] = [T::from_f64(0.0); 4];
    for four in fours[1..=order / 4].iter().rev() {
        a = a * h4 + four[0];
        b = b * h4 + four[1];
        c = c * h4 + four[2];
        d = d * h4 + four[3];
    }
    let [_, _, second, third] = fours[0];
    ((second + third * h) + ((a + b * h) + (c + d * h) * h2) * h2) * h2
}

/// How many of the last coefficients tell the length of a step. A motion from rest in a symmetric
/// place has one order in four only.
pub(crate) const LAST_ORDERS: usize = 4;

/// The length of a step at whose end the last term of the series is as large as allowed; infinite
/// for a uniform motion.
#[inline]
fn length<T: Float, const N: usize>(
    path: &Path<T, N>,
    rule: &Rule,
    weights: &[[f64; N]; 2],
) -> f64 {
    let (mut least, mut told) = (f64::INFINITY, 0);
    for k in (1..=rule.order).rev() {
        let (coefficient, _) = largest(path, k, weights);
        let longest = rule.told(coefficient, k);
        least = if longest < least { longest } else { least };
        told += 1;
        if LAST_ORDERS <= told && least < f64::INFINITY {
            break;
        }
    }
    if least == f64::INFINITY {
        return least;
    }
    power(least)
}

/// The largest coefficient of an order over the error allowed, and its coordinate.
#[inline]
pub(crate) fn largest<T: Float, const N: usize>(
    path: &Path<T, N>,
    k: usize,
    weights: &[[f64; N]; 2],
) -> (f64, usize) {
    let mut largest = (0.0, 0);
    for i in 0..N {
        for (series, weights) in [(&path.q[i], &weights[0]), (&path.v[i], &weights[1])] {
            let coefficient = series[k].to_f64().abs() * weights[i];
            if largest.0 < coefficient {
                largest = (coefficient, i);
            }
        }
    }
    largest
}
