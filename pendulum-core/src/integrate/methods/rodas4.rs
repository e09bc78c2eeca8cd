//! The Rosenbrock method of Hairer and Wanner of order 4, for stiff springs and dampers.

use crate::integrate::field::Field;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::linear::{Factors, Square, times};
use crate::integrate::method::{Adaptive, ErrorEstimate, Method, Response, Weights};
use crate::integrate::schemes::runge_kutta::{Row, Slopes};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::gap::{all, widest};
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{Dynamics, Jacobians, System};
use crate::time::Time;

/// The linearly implicit (Rosenbrock) method of order 4 of Hairer and Wanner with an error estimate
/// of order 3: six evaluations, the Jacobians and one factorization per step, adaptive.
///
/// The method is intended for stiff springs and dampers. It is L-stable: a damper of any strength
/// brings its coordinate to rest without oscillation, and a spring that is too fast for the step is
/// damped out. No iteration can fail. Each stage (x, z) solves (I − hγ ∂q̈/∂q̇ − h²γ² ∂q̈/∂q) z =
/// hγ r + h²γ² ∂q̈/∂q s, x = hγ (z + s), where s and r are the right-hand sides of the equations of
/// the coordinates and of the velocities: a linear system with one unknown per coordinate. For
/// smooth motions explicit methods are cheaper. If the fast oscillation itself matters, or energy
/// has to be conserved over a long time, use [`Gauss`](crate::integrate::Gauss) with Newton's
/// method.
///
/// If the equations contain time or a driven motion, ∂q̈/∂t is a finite difference of three
/// accelerations close to the start of the step, which takes two more evaluations. Dense output is
/// of order 3 and takes no further evaluations.
///
/// If the equations have [layers](crate::system::Facts::layers), the error is estimated with the
/// Jacobians at the end of the step as well, by a second factorization: a damper that saturates
/// within a step is not the damper that its start led to expect.
///
/// The method requires the generated Jacobians. Source: Hairer and Wanner (1996), Solving Ordinary
/// Differential Equations II, IV.7, and their code RODAS for the digits.
///
/// ```compile_fail,E0277
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).method(Rodas4).run()?.end.q[0])
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rodas4;

impl<D: Dynamics<N, Scalar: Float, System: Jacobians<N>>, const N: usize> Method<D, N> for Rodas4 {
    const NAME: &'static str = "Rodas4";
    type Workspace = Slopes<D::Scalar, N, 7>;

    fn workspace(&self, _: &D) -> Self::Workspace {
        Slopes::zero()
    }

    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        k: &mut Slopes<D::Scalar, N, 7>,
    ) -> Endpoint<D::Scalar, N> {
        let a = from.start_acceleration(field);
        let linear = Linear::new(field, interval, from, &a);
        let zero = [D::Scalar::from_f64(0.0); N];
        linear.solve(k, 0, &from.v.high, &a, (zero, zero), D[0]);
        linear.stage(field, interval, from, k, 1, A1, C1);
        linear.stage(field, interval, from, k, 2, A2, C2);
        linear.stage(field, interval, from, k, 3, A3, C3);
        linear.stage(field, interval, from, k, 4, A4, C4);
        let [v, a, dq, dv] = linear.stage(field, interval, from, k, 5, A5, C5);
        if const { has_layers::<D, N>() } {
            let (q, _) = place(from, k, A5);
            let (t, side) = interval.at(C[5]);
            let end = Linear::at(field, interval, (t, side), &q, &v);
            end.solve(k, 6, &v, &a, (dq, dv), D[5]);
        }
        let (dq, dv) = k.weighted(B);
        let mut to = Endpoint { t: interval.end, a: None, ..*from };
        to.q.add(D::Scalar::from_f64(1.0), &dq);
        to.v.add(D::Scalar::from_f64(1.0), &dv);
        to
    }

    fn interpolant(
        &self,
        _: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        to: &mut Endpoint<D::Scalar, N>,
        k: &mut Slopes<D::Scalar, N, 7>,
    ) -> Interpolant<D::Scalar, N> {
        let mut interpolant = Interpolant::linear(interval, from, to);
        (interpolant.q[1], interpolant.v[1]) = k.weighted(H2);
        (interpolant.q[2], interpolant.v[2]) = k.weighted(H3);
        interpolant.terms = 3;
        interpolant
    }

    fn stage(
        &self,
        index: usize,
        interval: &StepInterval,
        from: &Endpoint<D::Scalar, N>,
        k: &Slopes<D::Scalar, N, 7>,
    ) -> Option<(f64, Endpoint<D::Scalar, N>)> {
        let (q, v) = match index {
            0 => place(from, k, A1),
            1 => place(from, k, A2),
            2 => place(from, k, A3),
            3 => place(from, k, A4),
            4 => place(from, k, A5),
            _ => return None,
        };
        let c = C[index + 1];
        Some((c, Endpoint::new(interval.at(c).0, q, v)))
    }
}

impl<D: Dynamics<N, Scalar: Float, System: Jacobians<N>>, const N: usize> ErrorEstimate<D, N>
    for Rodas4
{
    #[inline]
    fn error(&self, k: &Slopes<D::Scalar, N, 7>, _: f64, weights: &Weights<N>) -> f64 {
        ErrorEstimate::<D, N>::error_along(self, k, 0.0, weights, |_| {})
    }

    #[inline]
    fn error_along(
        &self,
        k: &Slopes<D::Scalar, N, 7>,
        _: f64,
        weights: &Weights<N>,
        along: impl Fn(&mut [D::Scalar; N]),
    ) -> f64 {
        // The last stage is the difference from the embedded method.
        let last = if const { has_layers::<D, N>() } { 6 } else { 5 };
        let sums = (5..=last).map(|stage| {
            let (mut q, mut v) = (k.v[stage], k.a[stage]);
            along(&mut q);
            along(&mut v);
            weights.square_sum(&q, &v)
        });
        // A NaN stays one.
        let sum = sums.reduce(|a, b| if a < b { b } else { a + 0.0 * b }).unwrap_or(0.0);
        (sum / (2 * N) as f64).sqrt()
    }
}

impl Adaptive for Rodas4 {
    const ORDER: u32 = 4;
    const RESPONSE: Response =
        Response { alpha: 0.25, beta: 0.0, safety: 0.9, least: 0.2, greatest: 6.0 };
    const GAP: f64 = widest(&C, &all::<6>());
}

/// Returns `true` if the equations have layers, in which the Jacobians may change within a step.
const fn has_layers<D: Dynamics<N>, const N: usize>() -> bool {
    !<D::System as System<N>>::FACTS.layers.is_empty()
}

/// The linear equations of a step.
struct Linear<T, const N: usize> {
    h: T,
    /// hγ.
    scale: T,
    /// ∂q̈/∂q.
    stiffness: Square<T, N>,
    /// h ∂q̈/∂t.
    drive: [T; N],
    factors: Factors<T, N, 1>,
}

impl<T: Float, const N: usize> Linear<T, N> {
    fn new<D: Dynamics<N, Scalar = T, System: Jacobians<N>>, const W: bool>(
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &Endpoint<T, N>,
        a: &[T; N],
    ) -> Self {
        let (q, v) = (&from.q.high, &from.v.high);
        let still = Self::at(field, interval, (from.t, interval.side()), q, v);
        let drive = if D::System::FACTS.autonomous {
            still.drive
        } else {
            // The slope of the parabola through three accelerations. Their distance is small enough
            // for an error far below that of the method, and large enough for rounding to be
            // negligible.
            let part = T::EPSILON.sqrt().sqrt().to_f64();
            let [once, twice] = [part, 2.0 * part]
                .map(|part| field.at(from.t + part * interval.h, interval.side(), q, v));
            let (four, three, two) = (T::from_f64(4.0), T::from_f64(3.0), T::from_f64(2.0 * part));
            core::array::from_fn(|i| (four * once[i] - twice[i] - three * a[i]) / two)
        };
        Self { drive, ..still }
    }

    /// Returns the equations with the Jacobians of a state, without ∂q̈/∂t.
    fn at<D: Dynamics<N, Scalar = T, System: Jacobians<N>>, const W: bool>(
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        (t, side): (Time, Side),
        q: &[T; N],
        v: &[T; N],
    ) -> Self {
        let [by_q, by_v] = field.jacobians(t, side, q, v);
        let scale = T::from_f64(GAMMA * interval.h);
        let stiffness: Square<T, N> =
            core::array::from_fn(|i| core::array::from_fn(|j| by_q[(i, j)]));
        let factors = Factors::new(|_, _| {
            core::array::from_fn(|i| {
                core::array::from_fn(|j| {
                    let unit = T::from_f64(if i == j { 1.0 } else { 0.0 });
                    unit - scale * (by_v[(i, j)] + scale * stiffness[i][j])
                })
            })
        });
        let drive = [T::from_f64(0.0); N];
        Self { h: interval.length::<T>(), scale, stiffness, drive, factors }
    }

    /// Computes stage `index` from the earlier stages. Returns the right-hand sides of the equations
    /// at the stage, and the weighted sums of the earlier stages.
    // The rows are constants: inlining makes their indices and weights constants too.
    #[allow(clippy::inline_always, clippy::too_many_arguments)]
    #[inline(always)]
    fn stage<D: Dynamics<N, Scalar = T>, const K: usize, const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &Endpoint<T, N>,
        k: &mut Slopes<T, N, 7>,
        index: usize,
        row: Row<K>,
        memory: Row<K>,
    ) -> [[T; N]; 4] {
        let (q, v) = place(from, k, row);
        let (t, side) = interval.at(C[index]);
        let a = field.at(t, side, &q, &v);
        let memory = k.weighted(memory);
        self.solve(k, index, &v, &a, memory, D[index]);
        [v, a, memory.0, memory.1]
    }

    /// Solves the linear equations of stage `index`, from the slopes `v` and `a` at the stage and
    /// the weighted sums `memory` of earlier stages, which contain a factor h.
    fn solve(
        &self,
        k: &mut Slopes<T, N, 7>,
        index: usize,
        v: &[T; N],
        a: &[T; N],
        memory: ([T; N], [T; N]),
        drive: f64,
    ) {
        let drive = T::from_f64(drive);
        let s: [T; N] = core::array::from_fn(|i| v[i] + memory.0[i] / self.h);
        let pull = times(&self.stiffness, &s);
        let mut z = [core::array::from_fn(|i| {
            self.scale
                * ((a[i] + memory.1[i] / self.h + drive * self.drive[i]) + self.scale * pull[i])
        })];
        self.factors.solve(&mut z);
        k.a[index] = z[0];
        k.v[index] = core::array::from_fn(|i| self.scale * (z[0][i] + s[i]));
    }
}

/// Returns the coordinates and velocities of the stage with this row of the tableau.
// As the stages themselves.
#[allow(clippy::inline_always)]
#[inline(always)]
fn place<T: Float, const N: usize, const K: usize>(
    from: &Endpoint<T, N>,
    k: &Slopes<T, N, 7>,
    row: Row<K>,
) -> ([T; N], [T; N]) {
    let (dq, dv) = k.weighted(row);
    (
        core::array::from_fn(|i| from.q.high[i] + (from.q.low[i] + dq[i])),
        core::array::from_fn(|i| from.v.high[i] + (from.v.low[i] + dv[i])),
    )
}

const GAMMA: f64 = 0.25;

const C: [f64; 6] = [0.0, 0.386, 0.21, 0.63, 1.0, 1.0];

const D: [f64; 6] = [0.25, -0.1043, 0.1035, -0.03620000000000023, 0.0, 0.0];

const A1: Row<1> = [(0, 1.544)];

const A2: Row<2> = [(0, 0.9466785280815826), (1, 0.2557011698983284)];

const A3: Row<3> = [(0, 3.314825187068521), (1, 2.896124015972201), (2, 0.9986419139977817)];

const A4: Row<4> = [
    (0, 1.221224509226641),
    (1, 6.019134481288629),
    (2, 12.53708332932087),
    (3, -0.6878860361058950),
];

// `A5` adds stage 4 to `A4` and gives the result of the embedded method; `B` adds stage 5 to that.

const A5: Row<5> = [A4[0], A4[1], A4[2], A4[3], (4, 1.0)];

const B: Row<6> = [A4[0], A4[1], A4[2], A4[3], (4, 1.0), (5, 1.0)];

const C1: Row<1> = [(0, -5.6688)];

const C2: Row<2> = [(0, -2.430093356833875), (1, -0.2063599157091915)];

const C3: Row<3> = [(0, -0.1073529058151375), (1, -9.594562251023355), (2, -20.47028614809616)];

const C4: Row<4> = [
    (0, 7.496443313967647),
    (1, -10.24680431464352),
    (2, -33.99990352819905),
    (3, 11.70890893206160),
];

const C5: Row<5> = [
    (0, 8.083246795921522),
    (1, -7.981132988064893),
    (2, -31.52159432874371),
    (3, 16.31930543123136),
    (4, -6.058818238834054),
];

// Dense output.

const H2: Row<5> = [
    (0, 10.12623508344586),
    (1, -7.487995877610167),
    (2, -34.80091861555747),
    (3, -7.992771707568823),
    (4, 1.025137723295662),
];

const H3: Row<5> = [
    (0, -0.6762803392801253),
    (1, 6.087714651680015),
    (2, 16.43084320892478),
    (3, 24.76722511418386),
    (4, -6.594389125716872),
];
