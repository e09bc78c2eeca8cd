//! The sweeps of a step.
//!
//! All functions here are inlined into the code that [`simd`](crate::simd) compiles for several
//! instruction sets, and give the same bits in each.

#![allow(clippy::inline_always)]

use super::lanes::{LaneDynamics, LaneInputs, WideOf};
use super::tableau::{BETWEEN, EIGHT, Nodes, REFINED, S, SIXTEEN, UNITED};
use super::workspace::{Progress, Scaled, Stages, Tolerances, Wide, WorkspaceOf};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::motion::Side;
use crate::scalar::{Float, Octet};
use crate::simd::Work;
use crate::system::{LaneSystem, Staged, System, scalar_time};
use crate::time::Time;
use core::hint::black_box;

/// The square of the error that may remain in the equations, over the one allowed. The error is
/// taken to be the change that one more sweep would make.
const NEGLIGIBLE: f64 = 0.04;

/// The square of the largest change by the last sweep of an adaptive step, over the error allowed.
const LAST_CHANGE: f64 = 1.0;
/// The square of the largest change expected of the last sweep before it begins, over the error
/// allowed.
const EXPECTED_CHANGE: f64 = 0.25;

/// The largest number of sweeps of an adaptive step.
pub(super) const ADAPTIVE: u32 = 12;
/// The largest number of sweeps of a fixed step.
pub(super) const FIXED: u32 = 60;

/// The equations of a step at 8 `G` nodes, and the required accuracy of their solution.
pub(super) struct Equations<'a, D: LaneDynamics<N, Scalar = T>, T: Float, const N: usize> {
    pub(super) dynamics: &'a D,
    pub(super) prepared: &'a <WideOf<D, N> as System<N>>::Prepared,
    pub(super) interval: &'a StepInterval,
    /// The state at its start.
    pub(super) from: &'a Endpoint<T, N>,
    /// The error in the step that a unit of each acceleration causes, over the error allowed.
    pub(super) weights: &'a [T; N],
    /// The least number of sweeps. If it is right, the processor predicts the end of the loop.
    pub(super) least: u32,
    /// The largest number of sweeps.
    pub(super) most: u32,
    /// The number of sweeps whose changes say nothing of the convergence: 2 if the first one starts
    /// from no guess, 1 if it has no earlier change to compare with, 0 if the change that led to
    /// the guess is known.
    pub(super) blind: u32,
    /// The square of that change, over the error allowed.
    pub(super) earlier: T,
    /// `true` if the last sweeps also evaluate the points between the nodes, and the change by the
    /// very last one has to be small.
    pub(super) closing: bool,
}

/// A step of the integration.
pub(super) struct Onwards<'a, D: LaneDynamics<N, Scalar = T>, T: Float, const N: usize> {
    pub(super) dynamics: &'a D,
    pub(super) interval: &'a StepInterval,
    /// The state at its start.
    pub(super) from: &'a Endpoint<T, N>,
    /// Receives the state at its end.
    pub(super) to: &'a mut Endpoint<T, N>,
    /// The results of the previous step, or a first guess of the accelerations.
    pub(super) workspace: &'a mut WorkspaceOf<D, N>,
    /// The length of this step over that of the previous step; 0 if there is a first guess instead.
    pub(super) ratio: f64,
    pub(super) tolerances: &'a Tolerances<N>,
    /// The largest number of sweeps.
    pub(super) most: u32,
    /// `true` if an error estimate is required.
    pub(super) adaptive: bool,
}

impl<D: LaneDynamics<N, Scalar = T>, T: Float, const N: usize> Work for Onwards<'_, D, T, N> {
    #[inline(always)]
    fn run(self) {
        let Self { dynamics, interval, from, to, workspace, ratio, tolerances, most, adaptive } =
            self;
        let (half, h, number) = (black_box(S / 2), interval.length::<T>(), T::from_f64);
        workspace.weigh(interval.h.abs(), from, tolerances);
        let [scaled, ahead, between] = &mut workspace.scaled;
        scaled.scale(h, [&EIGHT.once, &EIGHT.twice], 0);
        if adaptive {
            between.scale(h, [&BETWEEN.once, &BETWEEN.twice], 0);
        }
        let [first, second] = &mut workspace.a;
        let (before, a) = if workspace.last == 0 { (&*first, second) } else { (&*second, first) };
        let goes_on = ratio == 1.0;
        // The first sweep of an equal step needs no guess, and its change is needed only if the
        // second sweep may be the last.
        let guessed = !goes_on || workspace.sweeps < 3;
        if goes_on {
            ahead.scale(h, [&EIGHT.once_ahead, &EIGHT.twice_ahead], 0);
            if guessed {
                [*a] = sums(black_box(before), [&EIGHT.ahead], Wide::known, half);
            }
        } else if ratio == 0.0 {
            *a = *before;
        } else {
            *a = extrapolated(black_box(before), number(ratio), half);
        }
        // Through memory: otherwise the compiler would split the vectors of the three cases to
        // merge them.
        let a = black_box(a);
        // The accelerations at the nodes and between them.
        let mut new = [a[0], [Wide::splat(number(0.0)); N]];
        let equations = Equations {
            dynamics,
            prepared: &workspace.prepared,
            interval,
            from,
            weights: &workspace.weights,
            least: workspace.sweeps,
            most,
            blind: if guessed { 1 } else { 2 },
            earlier: number(0.0),
            closing: adaptive,
        };
        let first = if goes_on { (before, &*ahead) } else { (&*a, &*scaled) };
        let points = [&EIGHT.nodes[0], &BETWEEN.points[0]];
        workspace.ends.progress =
            sweeps(&equations, points, first, [&*scaled, &*between], &mut new, half);
        *a = [new[0]];
        workspace.between_known = adaptive;
        if adaptive {
            let (between, start) = &mut workspace.between[workspace.last ^ 1];
            (*between, *start) = (new[1], workspace.start);
        }
        let [sums] = sums(black_box(&new), [&BETWEEN.ends], Wide::known, half);
        let [sums] = black_box(&sums);
        *to = Endpoint { t: interval.end, a: None, ..*from };
        for i in 0..N {
            let [once, twice, a15, a14, a13, a12, a16, _] = sums[i].0;
            workspace.ends.tail[i] =
                [a15, a14, a13, a12, a16 + number(BETWEEN.start) * workspace.start[i]];
            workspace.ends.last[i] = new[1][i].0[S - 1];
            workspace.ends.size[i] = root_mean_square(Octet(new[0][i].0.map(Float::to_f64)));
            to.q.add_product(i, h, from.v.high[i], h * (h * twice + from.v.low[i]));
            to.v.add_one(i, h * once);
        }
        let inherited = [0.0; N];
        workspace.ends.solved = workspace.is_solved(&inherited);
        workspace.ends.error = if workspace.ends.solved && to.is_finite() {
            workspace.error(&inherited)
        } else {
            f64::NAN
        };
    }
}

/// A step solved again at twice as many nodes, for the motion between its ends.
pub(super) struct Within<'a, D: LaneDynamics<N, Scalar = T>, T: Float, const N: usize> {
    pub(super) equations: Equations<'a, D, T, N>,
    /// The accelerations at the eight nodes of the step.
    pub(super) a: &'a Stages<T, N, 1>,
    /// Those at the points between them and at the start, if the step was solved there, too.
    pub(super) between: Option<&'a ([Wide<T>; N], [T; N])>,
    /// Receives the Legendre coefficients of the accelerations.
    pub(super) series: &'a mut Stages<T, N, 2>,
    /// The scaled columns of a sweep, by vector.
    pub(super) scaled: &'a mut [Scaled<T, 2>; 2],
    /// Receives the number of evaluated vectors.
    pub(super) count: &'a mut u32,
}

impl<D: LaneDynamics<N, Scalar = T>, T: Float, const N: usize> Work for Within<'_, D, T, N> {
    #[inline(always)]
    fn run(self) {
        let half = black_box(S / 2);
        let [mut a] = sums(black_box(self.a), [&REFINED], Wide::known, half);
        let mut equations = self.equations;
        if let Some((between, start)) = self.between {
            // As good as the first sweep from the polynomial through the eight nodes, whose states
            // these are the accelerations of.
            let [mut united] =
                sums(black_box(&[self.a[0], *between]), [&UNITED.0], Wide::known, half);
            let mut changes = Wide::splat(T::from_f64(0.0));
            for g in 0..2 {
                let at_start = Wide::<T>::known(&UNITED.1[g]);
                for i in 0..N {
                    united[g][i] += at_start * Wide::splat(start[i]);
                    let change = (united[g][i] - a[g][i]) * Wide::splat(equations.weights[i]);
                    changes += change * change;
                }
            }
            (equations.earlier, equations.blind, equations.least) =
                (total(black_box(&changes)), 0, 1);
            a = united;
        }
        let h = equations.interval.length();
        for (to, scaled) in self.scaled.iter_mut().enumerate() {
            scaled.scale(h, [&SIXTEEN.once, &SIXTEEN.twice], to);
        }
        let (guess, [first, second]) = (a, &*self.scaled);
        let points = [&SIXTEEN.nodes[0], &SIXTEEN.nodes[1]];
        *self.count =
            sweeps(&equations, points, (&guess, first), [first, second], &mut a, half).vectors;
        [*self.series] = sums(black_box(&a), [&SIXTEEN.legendre], Wide::known, half);
    }
}

/// Returns the times of the nodes, as times and in lanes, and the inputs there; the last lane
/// contains the inputs at `last` instead, if it is given.
#[inline(always)]
fn at_nodes<D: LaneDynamics<N>, const N: usize>(
    dynamics: &D,
    interval: &StepInterval,
    nodes: &Nodes,
    last: Option<(Time, Side)>,
) -> ([Time; S], Wide<D::Scalar>, LaneInputs<D, N>) {
    let (mut times, mut lanes) = ([interval.start; S], Wide::splat(scalar_time(interval.start)));
    // Other dynamics do not use the times.
    if D::FEEDBACK || !<D::System as System<N>>::FACTS.autonomous {
        for k in 0..S {
            times[k] = interval.start + nodes[k] * interval.h;
            lanes.0[k] = scalar_time(times[k]);
        }
    }
    (times, lanes, dynamics.inputs_at(&times, last))
}

/// Repeats sweeps until the accelerations converge: each sweep evaluates the accelerations at the
/// states that follow from the latest ones.
///
/// The accelerations in the first `G` of the `H` vectors determine the states at the points of all
/// vectors. The other vectors are evaluated only in the closing sweeps.
#[inline(always)]
fn sweeps<
    D: LaneDynamics<N, Scalar = T>,
    T: Float,
    const N: usize,
    const G: usize,
    const H: usize,
>(
    equations: &Equations<'_, D, T, N>,
    points: [&'static Nodes; H],
    (first, first_by): (&Stages<T, N, G>, &Scaled<T, G>),
    scaled: [&Scaled<T, G>; H],
    a: &mut Stages<T, N, H>,
    half: usize,
) -> Progress<T> {
    let (zero, system) =
        (Wide::splat(T::from_f64(0.0)), equations.dynamics.system().widen(Octet::splat));
    let (h, prepared) = (Wide::splat(equations.interval.length()), equations.prepared);
    // The coordinates of a motion without accelerations.
    let mut straight = [[zero; N]; H];
    let (times, t, inputs) = at_nodes(equations.dynamics, equations.interval, points[0], None);
    let mut known = [(t, inputs, WideOf::<D, N>::at_time(t, &inputs)); H];
    let mut node_times = [times; H];
    let all = if G == H || equations.closing { H } else { G };
    for g in 0..all {
        let elapsed = Wide::<T>::known(points[g]) * h;
        for i in 0..N {
            straight[g][i] = Wide::splat(equations.from.q.high[i])
                + elapsed * Wide::splat(equations.from.v.high[i]);
        }
        if 0 < g {
            // The last of the points between the nodes is just before the end of the step, at which
            // a motion may have a kink.
            let end = equations.interval.end;
            let last = if G < H && g + 1 == H && end.low() == 0.0 {
                Some((end, equations.interval.side().opposite()))
            } else {
                None
            };
            let (times, t, inputs) =
                at_nodes(equations.dynamics, equations.interval, points[g], last);
            known[g] = (t, inputs, WideOf::<D, N>::at_time(t, &inputs));
            node_times[g] = times;
        }
    }
    // Kept in memory as vectors: otherwise the compiler would mix the lanes of different
    // coordinates.
    let lanes =
        (straight, equations.from.v.high.map(Wide::splat), equations.weights.map(Wide::splat));
    let (straight, v0, weights) = black_box(&lanes);
    let number = T::from_f64;
    let mut progress = Progress {
        sweeps: 0,
        vectors: 0,
        change: equations.earlier,
        done: false,
        spare: false,
        complete: false,
    };
    let (mut values, mut by) = (first, first_by);
    let groups_of = |closing| if closing || G == H { H } else { G };
    let (mut groups, mut near, mut was_near) = (groups_of(false), false, false);
    let mut last;
    loop {
        let mut changes = zero;
        for g in 0..groups {
            let [once, twice] =
                sums(black_box(values), [&by.once, &by.twice], |column| *column, half);
            let (mut q, mut v) = (straight[g], once[0]);
            for i in 0..N {
                q[i] += twice[0][i];
                v[i] += v0[i];
            }
            let (t, inputs, at_time) = &known[g];
            let mut controlled = *inputs;
            let inputs = if D::FEEDBACK {
                equations.dynamics.control_lanes(&node_times[g], &q, &v, &mut controlled);
                &controlled
            } else {
                inputs
            };
            let at_position = system.at_position(prepared, at_time, *t, &q, inputs);
            let new =
                system.accelerations_staged(prepared, at_time, &at_position, *t, &q, &v, inputs);
            if g < G {
                for i in 0..N {
                    let change = (new[i] - a[g][i]) * weights[i];
                    changes += change * change;
                }
            }
            a[g] = new;
            by = scaled[(g + 1) % H];
        }
        let (change, earlier) = (total(black_box(&changes)), progress.change);
        progress.sweeps += 1;
        progress.vectors += groups as u32;
        progress.change = change;
        // Assumes linear convergence: the next change shrinks by the same ratio as this one. NaN
        // fails the comparisons.
        let (is_known, next) = (equations.blind < progress.sweeps, change * change);
        let shrinks = !is_known || change < earlier;
        let is_last = !equations.closing || groups == H;
        progress.complete = is_last;
        let enough = is_known
            && next <= number(NEGLIGIBLE) * earlier
            && (!equations.closing || change <= number(LAST_CHANGE));
        if equations.least <= progress.sweeps
            && is_last
            && (enough || !shrinks || equations.most <= progress.sweeps)
        {
            progress.done = enough;
            progress.spare = was_near;
            return progress;
        }
        // A change of zero may be followed by a change of the size of rounding.
        let stays = shrinks
            || change <= number(16.0) * earlier
            || equations.closing && change <= number(LAST_CHANGE);
        if progress.sweeps < equations.least && !stays {
            return progress;
        }
        let expected = if equations.closing { EXPECTED_CHANGE } else { NEGLIGIBLE };
        let is_near = is_known && next <= number(expected) * earlier;
        if equations.closing {
            // If convergence was near before this sweep, this sweep could have been the closing
            // one.
            (near, was_near) = (near || is_near, near);
            if equations.least <= progress.sweeps + 1
                && (near || !shrinks || equations.most <= progress.sweeps + 1)
            {
                groups = groups_of(true);
            }
        } else {
            was_near = is_near;
        }
        last = core::array::from_fn(|g| a[g]);
        (values, by) = (&last, scaled[0]);
    }
}

/// Returns Σ value_j column_j for each coordinate and each set of columns, which `lanes` takes from a
/// tableau as it is or scaled.
///
/// The values have to be in memory, from which each of them is broadcast to all lanes in one load.
/// `half` is `S / 2`, but must not be known to the compiler, which would unroll the loop and then
/// gather adjacent values.
#[inline(always)]
fn sums<T: Float, K, const N: usize, const G: usize, const H: usize, const C: usize>(
    values: &Stages<T, N, G>,
    columns: [&[[[K; H]; S]; G]; C],
    lanes: impl Fn(&K) -> Wide<T>,
    half: usize,
) -> [Stages<T, N, H>; C] {
    let zero = Wide::splat(T::from_f64(0.0));
    let (mut even, mut odd) = ([[[zero; N]; H]; C], [[[zero; N]; H]; C]);
    if N <= 2 {
        for c in 0..C {
            for j in 0..half {
                let j = j % (S / 2);
                for g in 0..G {
                    for to in 0..H {
                        let (x, y) =
                            (lanes(&columns[c][g][j][to]), lanes(&columns[c][g][j + S / 2][to]));
                        for i in 0..N {
                            even[c][to][i] += x * Wide::splat(values[g][i].0[j]);
                            odd[c][to][i] += y * Wide::splat(values[g][i].0[j + S / 2]);
                        }
                    }
                }
            }
        }
    } else {
        // In a loop over more coordinates the compiler would form vectors with one coordinate in
        // each lane.
        for i in 0..N {
            for j in 0..half {
                let j = j % (S / 2);
                for g in 0..G {
                    let (x, y) =
                        (Wide::splat(values[g][i].0[j]), Wide::splat(values[g][i].0[j + S / 2]));
                    for c in 0..C {
                        for to in 0..H {
                            even[c][to][i] += lanes(&columns[c][g][j][to]) * x;
                            odd[c][to][i] += lanes(&columns[c][g][j + S / 2][to]) * y;
                        }
                    }
                }
            }
        }
    }
    for c in 0..C {
        for to in 0..H {
            for i in 0..N {
                even[c][to][i] += odd[c][to][i];
            }
        }
    }
    even
}

/// Returns the sum over all lanes, by repeated halving.
#[inline(always)]
fn total<T: Float>(values: &Wide<T>) -> T {
    let x = &values.0;
    ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]))
}

/// Returns the root mean square of the values in all lanes.
#[inline(always)]
fn root_mean_square(a: Wide<f64>) -> f64 {
    // Below about 1e-154, squares underflow. A root of zero would make rounding errors of the
    // accelerations look like changes of them. Above about 1e154, squares overflow, and no step
    // would be short enough.
    const UP: f64 = f64::from_bits((1023 + 500) << 52);
    let scaled = |by: f64| {
        let a = a * Wide::splat(by);
        (total(black_box(&(a * a))) / S as f64).sqrt() / by
    };
    let square = total(black_box(&(a * a))) / S as f64;
    if square < 1e-280 {
        return scaled(UP);
    }
    if square == f64::INFINITY {
        return scaled(1.0 / UP);
    }
    square.sqrt()
}

/// Returns the accelerations at the nodes of a step, extrapolated from those of the previous step:
/// the values of the polynomial through them.
#[inline(always)]
fn extrapolated<T: Float, const N: usize>(
    before: &Stages<T, N, 1>,
    ratio: T,
    half: usize,
) -> Stages<T, N, 1> {
    let one = Wide::splat(T::from_f64(1.0));
    let at = one + Wide::<T>::known(&EIGHT.nodes[0]) * Wide::splat(ratio);
    // Lagrange polynomials: ∏ (x − c_k) over k < j and over k > j.
    let mut weights = [one; S];
    let mut product = one;
    for j in 0..S {
        weights[j] = product * Wide::splat(T::from_f64(EIGHT.lagrange[0][j]));
        product *= at - Wide::splat(T::from_f64(EIGHT.nodes[0][j]));
    }
    product = one;
    for j in (0..S).rev() {
        weights[j] *= product;
        product *= at - Wide::splat(T::from_f64(EIGHT.nodes[0][j]));
    }
    let weights = black_box(&weights);
    let mut a = [[Wide::splat(T::from_f64(0.0)); N]; 1];
    for i in 0..N {
        for j in 0..half {
            let j = j % (S / 2);
            a[0][i] += weights[j] * Wide::splat(before[0][i].0[j]);
            a[0][i] += weights[j + S / 2] * Wide::splat(before[0][i].0[j + S / 2]);
        }
    }
    a
}
