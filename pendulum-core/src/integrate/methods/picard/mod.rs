//! Collocation at Gauss nodes, solved by Picard iteration with all nodes of a step side by side in
//! the lanes of a vector.

// The functions of a step are inlined into code that is compiled for several instruction sets.
#![allow(clippy::inline_always)]

mod controller;
mod dense;
mod kernel;
mod lanes;
mod tableau;
mod workspace;

use crate::error::Error;
use crate::integrate::field::diagnose;
use crate::integrate::field::{Field, first_in_state};
use crate::integrate::interpolant::Interpolant;
use crate::integrate::method::{Memory, Method};
use crate::integrate::methods::dop853::{self, Dop853};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::{Float, Octet, Real};
use crate::simd;
use crate::system::{Dynamics, LaneSystem, System};
use core::hint::black_box;
use kernel::{ADAPTIVE, FIXED, Onwards};
pub use lanes::LaneDynamics;
use tableau::{EIGHT, S};
use workspace::{Ends, Scaled, Tolerances, Workspace, WorkspaceOf};

/// Collocation with the accelerations at eight Gauss nodes, which are evaluated side by side in the
/// lanes of a vector: order 16, adaptive.
///
/// A_i = a(t + c_i h, Q_i, V_i) with V_i = v₀ + h Σ a_ij A_j and Q_i = q₀ + c_i h v₀ + h² Σ (A²)_ij
/// A_j is solved by Picard iteration, which starts from the polynomial of the previous step and
/// takes four to seven sweeps. A sweep evaluates the accelerations at all nodes at once. It takes
/// the time of one or two evaluations on a machine with vectors of 64 or 32 bytes, and up to three
/// times that with 16 bytes: the method is the fastest one here for most systems and errors. It
/// supports every system that `lagrangian!` has made and any motion, analytic or not.
///
/// The last sweep also evaluates the accelerations at eight further points, which halve the gaps
/// between the nodes. The error of a step in the velocities is estimated as h max(|α₁₆|, ε₇ min(1,
/// ε₇/ε₆), ε₇/16), where α_k are the Legendre coefficients of the accelerations at all these points
/// and at the start, and ε_k is the larger of |α_2k| and |α_2k+1|. For smooth accelerations the
/// first two terms fall with the power 17 of the step, and the last one with the power 15. For
/// others, the estimate does not fall so fast: at corners, jumps, stops and narrow kicks. Steps end
/// at the known breaks of a motion.
///
/// An iteration has converged if its last change is below the tolerance, and the next change,
/// assuming linear convergence, is below a fifth of the tolerance. The length of the steps stays
/// the same while the error is within bounds. `rtol` may be arbitrarily small; below about 1e-15
/// the error is that of rounding. The interval to the next stop, break or end is divided into equal
/// steps. Fixed steps are iterated down to rounding; the iteration converges if h·ω is below about
/// 1.5, and otherwise returns an [error](crate::error::Error::NoConvergence). A stiff spring or
/// damper shortens the steps: use [`Rodas4`](crate::integrate::Rodas4) or
/// [`Gauss`](crate::integrate::Gauss) for such systems.
///
/// Where constraints are almost linearly dependent, as at the change points of a linkage, the
/// iteration does not converge: [`Dop853`] takes the next 24 steps there, including their dense
/// output.
///
/// The sum of the state is compensated. The coefficients have the accuracy of `f64`, so that the
/// method is no more accurate over scalars of two words than over `f64`. Dense output is the
/// collocation polynomial at sixteen nodes, as accurate as the ends of the step; it costs three
/// quarters of what the step does.
///
/// Source: van der Houwen and Sommeijer (1990), Parallel iteration of high-order Runge–Kutta
/// methods with stepsize control, J. Comput. Appl. Math. 29, 111, here for second-order equations;
/// for the iteration over the whole step Clenshaw and Norton (1963), The solution of nonlinear
/// ordinary differential equations in Chebyshev series, Comput. J. 6, 88; for the points between
/// the nodes Kronrod (1965), Nodes and weights of quadrature formulas.
///
/// ```
/// # use pendulum_runtime::{integrate::*, prelude::*};
/// # lagrangian! {
/// #     pub struct Pendulum { L: m, g: m/s^2 = 9.81 }
/// #     coordinate θ: rad;
/// #     kinetic = L^2 * θ̇^2 / 2;
/// #     potential = -g * L * cos(θ);
/// # }
/// let swing = solve(&Pendulum::new(0.5), (0.0, 10.0), [1.3], [0.0]).method(Picard).rtol(1e-12).run().unwrap();
/// println!("{:.12} rad", swing.end.q[0]);
/// ```
///
/// Systems written by hand cannot be evaluated in lanes:
///
/// ```compile_fail,E0277
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).method(Picard).run()?.end.q[0])
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Picard;

/// Takes a step over `interval` and puts its end into `to`; the workspace stores the results of the
/// step until it is accepted.
#[inline]
fn iterate<D: LaneDynamics<N>, const N: usize, const W: bool>(
    field: &mut Field<'_, D, N, W>,
    interval: &StepInterval,
    from: &mut Endpoint<D::Scalar, N>,
    to: &mut Endpoint<D::Scalar, N>,
    workspace: &mut WorkspaceOf<D, N>,
    tolerances: Option<&Tolerances<N>>,
) {
    let goes_on = workspace
        .end
        .as_ref()
        .is_some_and(|(t, q, v)| *t == from.t && *q == from.q.high && *v == from.v.high);
    let ratio = interval.h / workspace.h;
    let ratio = if goes_on && 0.0 < ratio && ratio <= 2.0 { ratio } else { 0.0 };
    // Ratios that differ from 1 only by rounding count as 1: the ratio affects only the first
    // sweep.
    let ratio = if f64::abs(ratio - 1.0) <= 1e-12 { 1.0 } else { ratio };
    if ratio == 0.0 {
        let a = from.start_acceleration(field);
        (workspace.a[workspace.last], workspace.sweeps) = ([a.map(Octet::splat)], 2);
        workspace.size = a.map(|a| a.to_f64().abs());
    }
    // After a kink the accelerations differ from those before it. Kinks and stops have times of one
    // word.
    let may_break = !<D::System as System<N>>::FACTS.autonomous && from.t.low() == 0.0;
    if tolerances.is_some() && (ratio == 0.0 || !workspace.start_known || may_break) {
        (workspace.start, workspace.start_known) = (from.start_acceleration(field), true);
    }
    let (most, adaptive) = if tolerances.is_some() { (ADAPTIVE, true) } else { (FIXED, false) };
    let tolerances = tolerances.unwrap_or(&(0.0, ([0.0; N], [0.0; N])));
    simd::widest(Onwards {
        dynamics: field.dynamics,
        interval,
        from,
        to,
        workspace,
        ratio,
        tolerances,
        most,
        adaptive,
    });
    field.evaluations += u64::from(workspace.ends.progress.vectors) * S as u64;
}

/// Returns the accelerations at the start of a step that errors of one machine epsilon in each
/// coordinate and velocity cause: Σ |a(q_j(1 + ε)) − a(q)| + Σ |a(q̇_j(1 + ε)) − a(q̇)|.
///
/// Where bodies pass each other closely, far from the origin, the differences of their coordinates
/// have few digits, and so have the accelerations. No step is short enough for a tolerance below
/// that.
#[cold]
#[inline(never)]
fn inherited<D: LaneDynamics<N>, const N: usize, const W: bool>(
    field: &mut Field<'_, D, N, W>,
    from: &mut Endpoint<D::Scalar, N>,
) -> [f64; N] {
    let (a, side) = (from.start_acceleration(field), field.side());
    let off = D::Scalar::from_f64(1.0) + D::Scalar::EPSILON;
    let mut sum = [0.0; N];
    // A count that the compiler knows would make it write out the equations as often.
    for j in 0..black_box(2 * N) {
        let (mut q, mut v) = (from.q.high, from.v.high);
        if j < N {
            q[j] *= off;
        } else {
            v[j - N] *= off;
        }
        let other = field.at(from.t, side, &q, &v);
        for i in 0..N {
            let change = (other[i] - a[i]).abs().to_f64();
            if change.is_finite() {
                sum[i] += change;
            }
        }
    }
    sum
}

impl<D: LaneDynamics<N>, const N: usize> Method<D, N> for Picard {
    const NAME: &'static str = "Picard";
    type Workspace = WorkspaceOf<D, N>;

    fn workspace(&self, dynamics: &D) -> WorkspaceOf<D, N> {
        let zero = D::Scalar::from_f64(0.0);
        Workspace {
            prepared: dynamics.system().widen(Octet::splat).prepare(),
            a: [[[Octet::splat(zero); N]]; 2],
            between: [([Octet::splat(zero); N], [zero; N]); 2],
            between_known: false,
            last: 0,
            end: None,
            h: 0.0,
            ends: Ends::new(),
            size: [0.0; N],
            start: [zero; N],
            start_known: false,
            scaled: [Scaled::new(), Scaled::new(), Scaled::new()],
            within: [Scaled::new(), Scaled::new()],
            sweeps: 2,
            weights: [zero; N],
            unsolved: None,
            detour: dop853::Stages::zero(),
            on_detour: false,
            detour_left: 0,
        }
    }

    #[inline]
    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        workspace: &mut WorkspaceOf<D, N>,
    ) -> Endpoint<D::Scalar, N> {
        let mut to = *from;
        iterate(field, interval, from, &mut to, workspace, None);
        workspace.unsolved = None;
        if workspace.ends.solved {
            workspace.accept(&to, interval.h);
            workspace.start_known = false;
        } else {
            if workspace.ends.progress.change.is_finite() {
                workspace.unsolved = Some((interval.end, workspace.worst()));
            }
            to.v.high = [D::Scalar::from_f64(f64::NAN); N];
        }
        to
    }

    fn interpolant(
        &self,
        field: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        workspace: &mut WorkspaceOf<D, N>,
    ) -> Interpolant<D::Scalar, N> {
        if workspace.on_detour {
            return Dop853.interpolant(field, interval, from, to, &mut workspace.detour);
        }
        dense::interpolant(field, interval, from, to, workspace)
    }

    fn stage(
        &self,
        index: usize,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        workspace: &WorkspaceOf<D, N>,
    ) -> Option<(f64, Endpoint<D::Scalar, N>)> {
        let detour = workspace.on_detour.then_some(&workspace.detour)?;
        Method::<D, N>::stage(&Dop853, index, interval, from, detour)
    }

    fn moved(&self, _: &D, workspace: &mut WorkspaceOf<D, N>, to: &Endpoint<D::Scalar, N>) {
        if workspace.end.is_some_and(|(t, ..)| t == to.t) {
            workspace.end = Some((to.t, to.q.high, to.v.high));
        }
    }

    fn remember(&self, workspace: &mut WorkspaceOf<D, N>, memory: &mut Memory) {
        workspace.remember(memory);
    }

    fn diagnose(
        &self,
        field: &Field<'_, D, N>,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        workspace: &WorkspaceOf<D, N>,
    ) -> Option<Error> {
        let facts = &<D::System as System<N>>::FACTS;
        if let Some((t, index)) = workspace.unsolved {
            return Some(Error::NoConvergence {
                t: t.to_f64(),
                step: interval.h,
                coordinate: facts.coordinate(index),
            });
        }
        let mut watched = field.watched();
        let to = one_by_one(&mut watched, interval, from);
        let at_end =
            || first_in_state(facts, &to.q.high, &to.v.high).map(|what| (interval.end, what));
        let (t, what) = watched.findings.first.or_else(at_end)?;
        Some(diagnose::not_finite(field.dynamics.system(), t, what))
    }
}

/// Takes the step without lanes, with the largest number of sweeps of an adaptive step, to find the
/// source of a number that is not finite.
fn one_by_one<T: Float, const N: usize, const W: bool>(
    field: &mut Field<'_, impl Dynamics<N, Scalar = T>, N, W>,
    interval: &StepInterval,
    from: &Endpoint<T, N>,
) -> Endpoint<T, N> {
    let (h, start) = (
        interval.length::<T>(),
        field.at(interval.start, interval.side(), &from.q.high, &from.v.high),
    );
    let sum = |columns: &dyn Fn(usize) -> f64, a: &[[T; N]; S], i: usize| {
        (0..S).fold(T::from_f64(0.0), |sum, j| sum + T::from_f64(columns(j)) * a[j][i])
    };
    let mut a = [start; S];
    for _ in 0..ADAPTIVE {
        let last = a;
        for (k, a) in a.iter_mut().enumerate() {
            let elapsed = h * T::from_f64(EIGHT.nodes[0][k]);
            let q = core::array::from_fn(|i| {
                from.q.high[i]
                    + elapsed * from.v.high[i]
                    + h * h * sum(&|j| EIGHT.twice[0][j][0][k], &last, i)
            });
            let v = core::array::from_fn(|i| {
                from.v.high[i] + h * sum(&|j| EIGHT.once[0][j][0][k], &last, i)
            });
            let (t, side) = interval.at(EIGHT.nodes[0][k]);
            *a = field.at(t, side, &q, &v);
        }
    }
    let mut to = Endpoint { t: interval.end, a: None, ..*from };
    for i in 0..N {
        to.q.high[i] += h * from.v.high[i] + h * h * sum(&|j| EIGHT.ends[0][j][0][1], &a, i);
        to.v.high[i] += h * sum(&|j| EIGHT.ends[0][j][0][0], &a, i);
    }
    to
}
