//! The sweeps of a step.
//!
//! Everything here is inlined into the code that [`simd`](crate::simd) compiles for several instruction sets, and has the same bits in each.

#![allow(clippy::inline_always)]

use super::side_by_side::SideBySide;
use super::tableau::{Collocation, EIGHT, Nodes, REFINED, S, SIXTEEN};
use crate::integrate::span::Span;
use crate::real::{Float, Lane, Octet};
use crate::simd::Work;
use crate::system::{Staged, System, scalar_time};
use core::hint::black_box;

/// One number for each node of a vector.
pub(super) type Wide<T> = Octet<T>;

/// The accelerations at the nodes of a step, by vector and coordinate.
pub(super) type Stages<T, const N: usize, const G: usize> = [[Wide<T>; N]; G];

/// The system over lanes.
type Of<D, const N: usize> = <D as SideBySide<N>>::Wide;

/// The equations of a step at 8 `G` nodes, and how well they are to be solved.
pub(super) struct Equations<'a, D: SideBySide<N, Scalar = T>, T: Lane + Float, const N: usize, const G: usize> {
    pub(super) dynamics: &'a D,
    pub(super) prepared: &'a <Of<D, N> as System<N>>::Prepared,
    pub(super) span: &'a Span,
    /// The state at its start.
    pub(super) q: &'a [T; N],
    pub(super) v: &'a [T; N],
    /// The part of the error allowed that a unit of each acceleration makes in the step.
    pub(super) weights: &'a [T; N],
    /// The square of the largest error that may be left.
    pub(super) negligible: T,
    /// The least number of sweeps and the most. The processor foresees the end of the loop where the least number is right.
    pub(super) least: u32,
    pub(super) most: u32,
}

/// How the iteration has ended.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress<T> {
    /// The number of sweeps.
    pub(super) sweeps: u32,
    /// The square of the last change, over the error allowed.
    pub(super) change: T,
    /// What is left is negligible.
    pub(super) done: bool,
    /// It was after one sweep less.
    pub(super) spare: bool,
}

/// What a step comes to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends<T, const N: usize> {
    /// ∫ q̈ over h and ∫ ∫ q̈ over h².
    pub(super) once: [T; N],
    pub(super) twice: [T; N],
    /// The last coefficient of the accelerations after Legendre and the one before it.
    pub(super) last: [[T; 2]; N],
    /// The mean square of the accelerations.
    pub(super) square: [T; N],
    pub(super) progress: Progress<T>,
}

impl<T: Float, const N: usize> Ends<T, N> {
    pub(super) fn new() -> Self {
        let zero = [T::from_f64(0.0); N];
        let progress = Progress { sweeps: 0, change: zero[0], done: false, spare: false };
        Self { once: zero, twice: zero, last: [[zero[0]; 2]; N], square: zero, progress }
    }
}

/// A step onwards.
pub(super) struct Onwards<'a, D: SideBySide<N, Scalar = T>, T: Lane + Float, const N: usize> {
    pub(super) equations: Equations<'a, D, T, N, 1>,
    /// The accelerations of the step before, or a first guess.
    pub(super) before: &'a Stages<T, N, 1>,
    /// The length of this step over that of the step before; 0 with a first guess.
    pub(super) ratio: T,
    /// Where the accelerations of this one go.
    pub(super) a: &'a mut Stages<T, N, 1>,
    pub(super) ends: &'a mut Ends<T, N>,
}

impl<D: SideBySide<N, Scalar = T>, T: Lane + Float, const N: usize> Work for Onwards<'_, D, T, N> {
    #[inline(always)]
    fn run(self) {
        let Self { equations, before, ratio, a, ends } = self;
        let half = black_box(S / 2);
        let mut guess = *before;
        if ratio == T::from_f64(1.0) {
            guess = lanes(sums(black_box(before), [&EIGHT.ahead], half)[0]);
        } else if ratio != T::from_f64(0.0) {
            guess = extrapolated(black_box(before), ratio, half);
        }
        ends.progress = sweeps(&equations, &EIGHT, &mut guess, half);
        *a = guess;
        let [[sums]] = sums(black_box(a), [&EIGHT.ends], half);
        for i in 0..N {
            let [once, twice, last, before] = sums[i];
            (ends.once[i], ends.twice[i], ends.last[i]) = (once, twice, [last, before]);
            ends.square[i] = total(black_box(&(guess[0][i] * guess[0][i]))) * T::from_f64(1.0 / S as f64);
        }
    }
}

/// A step once more, at twice as many nodes: what is between its ends.
pub(super) struct Within<'a, D: SideBySide<N, Scalar = T>, T: Lane + Float, const N: usize> {
    pub(super) equations: Equations<'a, D, T, N, 2>,
    /// The accelerations of the step.
    pub(super) a: &'a Stages<T, N, 1>,
    /// Where the coefficients of the accelerations after Legendre go.
    pub(super) series: &'a mut Stages<T, N, 2>,
    /// Where the number of sweeps goes.
    pub(super) count: &'a mut u32,
}

impl<D: SideBySide<N, Scalar = T>, T: Lane + Float, const N: usize> Work for Within<'_, D, T, N> {
    #[inline(always)]
    fn run(self) {
        let half = black_box(S / 2);
        let mut a = lanes(sums(black_box(self.a), [&REFINED], half)[0]);
        *self.count = sweeps(&self.equations, &SIXTEEN, &mut a, half).sweeps;
        *self.series = lanes(sums(black_box(&a), [&SIXTEEN.legendre], half)[0]);
    }
}

/// The times of the nodes and the inputs there.
#[inline(always)]
fn at_nodes<D: SideBySide<N>, const N: usize>(
    dynamics: &D,
    span: &Span,
    nodes: &Nodes,
) -> (Wide<D::Scalar>, <D::Wide as System<N>>::Inputs) {
    let (mut times, mut lanes) = ([span.start; S], Wide::splat(scalar_time(span.start)));
    // Otherwise nobody looks at them.
    if !<D::System as System<N>>::FACTS.autonomous {
        for k in 0..S {
            times[k] = span.start + nodes[k] * span.h;
            lanes.0[k] = scalar_time(times[k]);
        }
    }
    (lanes, dynamics.inputs_at(&times))
}

/// Evaluates the accelerations where the last ones lead, again and again, until that changes nothing.
#[inline(always)]
fn sweeps<D: SideBySide<N, Scalar = T>, T: Lane + Float, const N: usize, const G: usize>(
    equations: &Equations<'_, D, T, N, G>,
    tableau: &'static Collocation<G>,
    a: &mut Stages<T, N, G>,
    half: usize,
) -> Progress<T> {
    let (zero, system) = (Wide::splat(T::from_f64(0.0)), equations.dynamics.widened());
    let (h, prepared) = (Wide::splat(equations.span.length()), equations.prepared);
    // Where the motion is without accelerations.
    let mut straight = [[zero; N]; G];
    let (t, inputs) = at_nodes(equations.dynamics, equations.span, &tableau.nodes[0]);
    let mut known = [(t, inputs, Of::<D, N>::at_time(t, &inputs)); G];
    for g in 0..G {
        let elapsed = Wide::<T>::known(&tableau.nodes[g]) * h;
        for i in 0..N {
            straight[g][i] = Wide::splat(equations.q[i]) + elapsed * Wide::splat(equations.v[i]);
        }
        if 0 < g {
            let (t, inputs) = at_nodes(equations.dynamics, equations.span, &tableau.nodes[g]);
            known[g] = (t, inputs, Of::<D, N>::at_time(t, &inputs));
        }
    }
    let mut progress = Progress { sweeps: 0, change: T::from_f64(0.0), done: false, spare: false };
    loop {
        let mut scaled = *a;
        for g in 0..G {
            for i in 0..N {
                scaled[g][i] *= h;
            }
        }
        let [once, twice] = sums(black_box(&scaled), [&tableau.once, &tableau.twice], half);
        let (once, twice) = (lanes(once), lanes(twice));
        let mut changes = zero;
        for g in 0..G {
            let (mut q, mut v) = (straight[g], once[g]);
            for i in 0..N {
                q[i] += twice[g][i] * h;
                v[i] += Wide::splat(equations.v[i]);
            }
            let (t, inputs, at_time) = &known[g];
            let at_position = system.at_position(prepared, at_time, *t, &q, inputs);
            let new = system.accelerations_staged(prepared, at_time, &at_position, *t, &q, &v, inputs);
            for i in 0..N {
                let change = (new[i] - a[g][i]) * Wide::splat(equations.weights[i]);
                changes += change * change;
            }
            a[g] = new;
        }
        let (change, last) = (total(black_box(&changes)), progress.change);
        progress.sweeps += 1;
        progress.change = change;
        // A change leaves that part of itself which it was of the one before. What is not a number is not less.
        let enough = change * change <= equations.negligible * last;
        let shrinks = progress.sweeps == 1 || change < last;
        let stays = shrinks || change <= T::from_f64(16.0) * last;
        if equations.least <= progress.sweeps {
            if enough || !shrinks || equations.most <= progress.sweeps {
                progress.done = enough;
                return progress;
            }
        } else if !stays {
            return progress;
        }
        progress.spare = enough;
    }
}

/// Σ value_j column_j for each coordinate and each set of columns.
///
/// The values have to be in memory, from where each goes to all lanes at once, and `half`, which is `S / 2`, must not be known to the compiler: it
/// would write out the loop, and then gather what stands side by side.
#[inline(always)]
fn sums<T: Lane, const N: usize, const G: usize, const H: usize, const W: usize, const C: usize>(
    values: &Stages<T, N, G>,
    columns: [&'static [[[[f64; W]; H]; S]; G]; C],
    half: usize,
) -> [[[[T; W]; N]; H]; C] {
    let zero = [T::from_f64(0.0); W];
    let mut parts = [[[[zero; 2]; N]; H]; C];
    for j in 0..half {
        let j = j % (S / 2);
        for g in 0..G {
            for i in 0..N {
                let (x, y) = (values[g][i].0[j], values[g][i].0[j + S / 2]);
                for c in 0..C {
                    for to in 0..H {
                        let (even, odd) = (&columns[c][g][j][to], &columns[c][g][j + S / 2][to]);
                        let [p, q] = &mut parts[c][to][i];
                        for k in 0..W {
                            p[k] += T::from_f64(even[k]) * x;
                            q[k] += T::from_f64(odd[k]) * y;
                        }
                    }
                }
            }
        }
    }
    let mut sums = [[[zero; N]; H]; C];
    for c in 0..C {
        for to in 0..H {
            for i in 0..N {
                for k in 0..W {
                    sums[c][to][i][k] = parts[c][to][i][0][k] + parts[c][to][i][1][k];
                }
            }
        }
    }
    sums
}

/// Sums for all nodes as lanes.
#[inline(always)]
fn lanes<T: Lane, const N: usize, const G: usize>(sums: [[[T; S]; N]; G]) -> Stages<T, N, G> {
    let mut lanes = [[Wide::splat(T::from_f64(0.0)); N]; G];
    for g in 0..G {
        for i in 0..N {
            lanes[g][i] = Octet(sums[g][i]);
        }
    }
    lanes
}

/// The sum over all lanes, of halves.
#[inline(always)]
fn total<T: Lane>(values: &Wide<T>) -> T {
    let x = &values.0;
    ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]))
}

/// The accelerations at the nodes of a step from those of the step before: the values of the polynomial through them.
#[inline(always)]
fn extrapolated<T: Lane, const N: usize>(before: &Stages<T, N, 1>, ratio: T, half: usize) -> Stages<T, N, 1> {
    let one = Wide::splat(T::from_f64(1.0));
    let at = one + Wide::<T>::known(&EIGHT.nodes[0]) * Wide::splat(ratio);
    // Lagrange's polynomials: ∏ (x − c_k) over k < j and over k > j.
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
    for j in 0..half {
        let j = j % (S / 2);
        for i in 0..N {
            a[0][i] += weights[j] * Wide::splat(before[0][i].0[j]);
            a[0][i] += weights[j + S / 2] * Wide::splat(before[0][i].0[j + S / 2]);
        }
    }
    a
}
