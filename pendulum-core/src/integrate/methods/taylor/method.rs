//! The Taylor method: the series of a step.

// Code over lanes uses these functions too, compiled for its vector instructions.
#![allow(clippy::inline_always)]

use super::doubts::Doubts;
use super::rule::Rule;
use crate::error::{Error, Quantity};
use crate::integrate::field::diagnose;
use crate::integrate::field::{Field, first_in_state};
use crate::integrate::interpolant::{Basis, Interpolant, TERMS};
use crate::integrate::method::{Memory, Method};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::fast_exp2::log2;
use crate::jet::{JetDynamics, Jets, MAX_ORDER, Path, Series, Unrolling};
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, System, scalar_time};
use crate::time::Time;

/// The Taylor series of the motion: any order from 2 to 30, adaptive, forwards and backwards in
/// time.
///
/// The method supports every system that `lagrangian!` has made and every motion that is
/// [`Analytic`](crate::motion::Analytic). Use it for errors close to rounding and for integration
/// backwards in time. Its steps are long and few are rejected, because the coefficients give the
/// radius of convergence. It is explicit: a stiff spring or damper shortens its steps.
///
/// A series contains no information about a wall or a contact far from its centre. The
/// accelerations a at the end of each step are therefore compared with those of the series of order
/// p. A step is halved if h·|Δa|/p is more than 30 times the error allowed; after a first halving,
/// if h·|Δa| is more than that error. Differences below a thousand units of rounding are allowed.
/// After forty halvings the shortest step is assumed to contain a jump and crosses it. If 256 steps
/// are halved, and none of them is a thousand times as long as an earlier one, the accelerations
/// are assumed to be inexact, and whole steps are taken until series are valid again. Each
/// comparison is one evaluation, which [`Stats`](crate::integrate::Stats) do not count: they count
/// one evaluation for each order of the series. A needle or a thin wall is missed if a step ends
/// behind it. The method is wrong for equations that are not smooth: at the zeros of `abs` and
/// `sign`, and where the larger of two numbers changes.
///
/// The order is p = ⌈1 − c ln rtol⌉ with c = 0.8 for the shortest equations, as of an undriven
/// pendulum, and 0.7 otherwise. The step is h = ρ rtol^(1/p) e^(−0.7/(p−1)), where ρ is the least
/// of the radii of convergence (rtol · max |xᵢ\[k\]|/εᵢ)^(−1/k) for the last four orders k, with εᵢ
/// = atolᵢ + rtol·|xᵢ| over all coordinates and velocities; where these coefficients vanish, lower
/// orders are used. (With c = ½ the work would be least if it grew with p²; the measured exponent
/// is 1.4 or less.) `rtol` may be arbitrarily small: 1e-18 reduces the truncation error well below
/// rounding. Fixed steps use the order for the machine epsilon and c = 0.7, unless
/// [`order`](Self::order) is set.
///
/// The sum of the series is compensated. Dense output is the series itself and takes no further
/// evaluations.
///
/// Source: Jorba and Zou (2005), A software package for the numerical integration of ODEs by means
/// of high-order Taylor methods, Exp. Math. 14, 99.
///
/// The jets are `KNOWN` unless [`Auto`](crate::integrate::Auto) has found them at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Taylor<const KNOWN: bool = true> {
    order: Option<usize>,
}

impl Default for Taylor {
    fn default() -> Self {
        Self::new()
    }
}

impl Taylor {
    /// Creates the method with an order that depends on the tolerance.
    pub const fn new() -> Self {
        Self { order: None }
    }

    /// Returns the method for jets that are found at run time.
    pub(crate) const fn unknown(self) -> Taylor<false> {
        Taylor { order: self.order }
    }
}

impl<const KNOWN: bool> Taylor<KNOWN> {
    /// Sets the order, clamped to the range from 2 to 30.
    pub const fn order(self, order: usize) -> Self {
        let order = if order < 2 { 2 } else { order };
        Self { order: Some(if MAX_ORDER < order { MAX_ORDER } else { order }) }
    }

    /// Returns the order for a tolerance: `per_digit` orders for each factor e of the tolerance,
    /// unless the order is set.
    pub(crate) fn order_for(self, tolerance: f64, per_digit: f64) -> usize {
        let best = (1.0 - per_digit * core::f64::consts::LN_2 * log2(tolerance)).ceil();
        self.order.unwrap_or(best.clamp(2.0, MAX_ORDER as f64) as usize)
    }

    /// Returns the order of fixed steps.
    fn fixed<T: Float>(self) -> usize {
        self.order_for(T::EPSILON.to_f64(), 0.7)
    }
}

/// The jet at the start of a step, and the state of step control.
#[derive(Clone, Debug)]
pub struct Workspace<T, W, X, const N: usize> {
    pub(super) path: Path<T, N>,
    pub(super) drive: X,
    pub(super) work: W,
    /// The order of the jet.
    pub(super) order: usize,
    /// The rule for the length of steps, from the tolerance.
    pub(super) rule: Rule,
    /// One over the errors allowed of coordinates and velocities at the start.
    pub(super) weights: [[f64; N]; 2],
    /// The step that is taken if its series is valid.
    pub(super) whole: StepInterval,
    pub(super) doubts: Doubts,
}

impl<T, W, X, const N: usize> Workspace<T, W, X, N> {
    /// Returns `true` if no recent series was invalid.
    pub(crate) fn is_sure(&self) -> bool {
        self.doubts.are_gone()
    }
}

/// The workspace for the jets of the dynamics `D`.
pub(crate) type WorkspaceOf<D, const N: usize> = Workspace<
    <D as Dynamics<N>>::Scalar,
    <<D as Dynamics<N>>::System as Jets<N>>::Work,
    <<D as Dynamics<N>>::System as Jets<N>>::Drive,
    N,
>;

impl<D, const N: usize, const KNOWN: bool> Method<D, N> for Taylor<KNOWN>
where
    D: JetDynamics<N, KNOWN, Scalar: Float>,
{
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
        expand::<D, N, KNOWN, _>(field, from, side(interval.h), order, workspace);
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
        let path = &workspace.path;
        series_interpolant(*interval, from, workspace.order, |i, k| [path.q[i][k], path.v[i][k]])
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
        expand::<D, N, KNOWN, _>(&mut series, from, side, order, &mut workspace);
        let facts = &<D::System as System<N>>::FACTS;
        let finite = |series: &Series<D::Scalar>| series.iter().all(|x| x.is_finite());
        let Path { q, v, .. } = &workspace.path;
        let infinite = (0..N).find(|&i| !finite(&v[i]) || !finite(&q[i]));
        let (t, what) = watched
            .findings
            .first
            .or_else(|| infinite.map(|index| (from.t, Quantity::Series(facts.coordinate(index)))))
            .or_else(|| {
                let to = sum(&workspace, from, interval);
                first_in_state(facts, &to.q.high, &to.v.high).map(|what| (interval.end, what))
            })?;
        Some(diagnose::not_finite(dynamics.system(), t, what))
    }

    fn remember(&self, workspace: &mut WorkspaceOf<D, N>, memory: &mut Memory) {
        workspace.doubts.remember(memory);
    }

    fn kink(&self, dynamics: &D, t: f64, backwards: bool) -> Option<f64> {
        if backwards { dynamics.last_kink(t) } else { dynamics.next_kink(t) }
    }
}

/// The widest gap between two samples, in steps. A series contains only the derivatives at the
/// start of its step. It detects a bell-shaped pulse at a distance of two widths, and the bound
/// permits steps of 3/ω over a sine.
pub(crate) const GAP: f64 = 0.7;

/// Returns the side of the start of a step on which the step lies.
pub(super) fn side(h: f64) -> Side {
    if h < 0.0 { Side::Before } else { Side::After }
}

/// Computes the jet at `from`.
#[inline]
pub(super) fn expand<D, const N: usize, const KNOWN: bool, const W: bool>(
    field: &mut Field<'_, D, N, W>,
    from: &Endpoint<D::Scalar, N>,
    side: Side,
    order: usize,
    workspace: &mut WorkspaceOf<D, N>,
) where
    D: JetDynamics<N, KNOWN, Scalar: Float>,
{
    if workspace.order != order {
        // Clears the coefficients of higher orders.
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

/// Returns the state at the end of a step: the sum of the series. The products of the first order
/// are added with both words.
#[inline]
pub(super) fn sum<T: Float, W, X, const N: usize>(
    workspace: &Workspace<T, W, X, N>,
    from: &Endpoint<T, N>,
    interval: &StepInterval,
) -> Endpoint<T, N> {
    let h = interval.length::<T>();
    let mut to = Endpoint { t: interval.end, a: None, ..*from };
    for i in 0..N {
        let Path { q, v, .. } = &workspace.path;
        for (sum, series) in [(&mut to.q, &q[i]), (&mut to.v, &v[i])] {
            sum.add_product(i, h, series[1], rest(series, workspace.order, h));
        }
    }
    to
}

/// Returns the motion within a step, from the coefficients of the coordinates and of the
/// velocities.
pub(crate) fn series_interpolant<T: Float, const N: usize>(
    interval: StepInterval,
    from: &Endpoint<T, N>,
    order: usize,
    coefficients: impl Fn(usize, usize) -> [T; 2],
) -> Interpolant<T, N> {
    let (h, zero) = (interval.length::<T>(), [[T::from_f64(0.0); N]; TERMS]);
    let (q0, v0) = (from.q.high, from.v.high);
    let basis = Basis::Powers;
    let mut interpolant = Interpolant { interval, q0, v0, q: zero, v: zero, terms: order, basis };
    let mut power = h;
    for k in 1..=order {
        for i in 0..N {
            let [q, v] = coefficients(i, k);
            (interpolant.q[k - 1][i], interpolant.v[k - 1][i]) = (q * power, v * power);
        }
        power *= h;
    }
    interpolant
}

/// Returns Σ x\[k\] hᵏ over 2 ≤ k ≤ `order`; all coefficients beyond `order` are zero. Four sums,
/// each of every fourth term, are computed side by side by Horner's scheme (1819).
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
