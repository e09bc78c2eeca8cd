//! The history of explicit multistep methods in summed form.
//!
//! d_n + Σ a_j d_{n−j} = Σ b_j f_{n−j} gives the second difference h² d_n = q_{n+1} − 2q_n +
//! q_{n−1} from accelerations f. Its first sum, w_n = (q_{n+1} − q_n)/h = w_{n−1} + h d_n, and its
//! second sum, q_{n+1} = q_n + h w_n, are computed with compensation (Henrici 1962, 6.4).

use crate::integrate::field::Field;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::interpolant::fit::{Condition, fit};
use crate::integrate::interpolant::hermite;
use crate::integrate::method::{Memory, Method};
use crate::integrate::methods::dop853::{self, Dop853};
use crate::integrate::state::compensated::Compensated;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::Float;
use crate::system::Dynamics;
use crate::time::Time;

/// The coefficients of a method of order `P`, that of the newest value first. They are constants of
/// a type, so that zero coefficients cost nothing.
pub(crate) trait Scheme<const P: usize> {
    /// The weights b of the accelerations.
    const BETA: [f64; P];
    /// The weights a of earlier second differences.
    const ALPHA: [f64; P];
    /// The weights g of the accelerations in the velocity at the end of a step, v_n = w_{n−1} + h Σ
    /// g_j f_{n−j}.
    const VELOCITIES: [f64; P] = velocities();
}

/// The history of a multistep method: the last `P` points of a grid of equal steps.
#[derive(Clone, Copy, Debug)]
pub struct History<T, const N: usize, const P: usize> {
    /// The accelerations at the last point.
    newest: [T; N],
    /// The accelerations at the earlier points, in order.
    f: Window<T, N, P>,
    /// The second differences, divided by h².
    d: Window<T, N, P>,
    /// The latest first difference, divided by h.
    w: Compensated<T, N>,
    /// The length of the steps.
    h: f64,
    /// The number of points; 0 before the first step.
    points: usize,
    /// The last point. A step from any other state begins a new grid.
    end: (Time, Compensated<T, N>, [T; N]),
    /// The stages of `Dop853`, which takes the first steps.
    starter: dop853::Stages<T, N>,
}

impl<T: Float, const N: usize, const P: usize> History<T, N, P> {
    pub(crate) fn new() -> Self {
        let zero = [T::from_f64(0.0); N];
        let end = (Time::new(0.0), Compensated::new(zero), zero);
        Self {
            newest: zero,
            f: Window::new(),
            d: Window::new(),
            w: Compensated::new(zero),
            h: 0.0,
            points: 0,
            end,
            starter: dop853::Stages::zero(),
        }
    }

    /// Takes the step `interval`.
    ///
    /// A new grid begins if the state has been changed from outside, after a kink (the
    /// accelerations in `from` are then unknown), and if the length of the step changes. The first
    /// `P` − 1 steps of a grid are taken by `Dop853` in [`SUBSTEPS`] parts each.
    #[inline]
    pub(crate) fn step<C: Scheme<P>, D: Dynamics<N, Scalar = T>, const W: bool>(
        &mut self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<T, N>,
    ) -> Endpoint<T, N> {
        let same_step = (interval.h - self.h).abs() <= 1e-10 * self.h.abs();
        let same_state = self.end == (from.t, from.q, from.v.high);
        let goes_on = self.points != 0 && same_step && from.a.is_some() && same_state;
        if goes_on && self.points == P {
            self.multistep::<C, D, W>(field, interval, from)
        } else {
            if !goes_on {
                (self.points, self.h) = (1, interval.h);
                self.newest = from.start_acceleration(field);
            }
            self.start(field, interval, from)
        }
    }

    #[inline]
    fn multistep<C: Scheme<P>, D: Dynamics<N, Scalar = T>, const W: bool>(
        &mut self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &Endpoint<T, N>,
    ) -> Endpoint<T, N> {
        let (h, last) = (T::from_f64(self.h), T::from_f64(interval.h));
        let (f, d, newest) = (self.f.values(), self.d.values(), self.newest);
        // Everything that does not depend on the newest acceleration is computed first, while the
        // processor waits for that acceleration. The coordinates therefore add h w_{n−1} and h² d_n
        // separately, so that the long sums are not part of the dependency chain between
        // accelerations.
        let older: [T; N] = core::array::from_fn(|i| {
            sum(1, &C::BETA, |j| f[P - j][i]) - sum(0, &C::ALPHA, |j| d[P - 1 - j][i])
        });
        let glide: [T; N] = core::array::from_fn(|i| sum(2, &C::VELOCITIES, |j| f[P + 1 - j][i]));
        let mut q = self.end.1;
        q.add(last, &self.w.high);
        let kick = T::from_f64(C::BETA[0]);
        let (weight, rest) = (last * h * kick, older.map(|older| last * h * older));
        q.add(T::from_f64(1.0), &core::array::from_fn(|i| weight * newest[i] + rest[i]));
        let a = field.at(interval.end, interval.side().opposite(), &q.high, &from.v.high);
        let d = core::array::from_fn(|i| kick * newest[i] + older[i]);
        self.w.add(h, &d);
        // v = w + h ∫ u f(t + u h) du over [0, 1].
        let [first, second] = [C::VELOCITIES[0], C::VELOCITIES[1]].map(T::from_f64);
        let v = core::array::from_fn(|i| {
            self.w.high[i] + h * (first * a[i] + (second * newest[i] + glide[i]))
        });
        self.d.push(d);
        self.f.push(newest);
        (self.newest, self.end) = (a, (interval.end, q, v));
        Endpoint { t: interval.end, q, v: Compensated::new(v), a: Some(a) }
    }

    /// Takes one of the first steps of a grid.
    fn start<D: Dynamics<N, Scalar = T>, const W: bool>(
        &mut self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<T, N>,
    ) -> Endpoint<T, N> {
        let mut to = *from;
        for part in 1..=SUBSTEPS {
            let end = if part == SUBSTEPS {
                interval.end
            } else {
                interval.start + interval.h * part as f64 / SUBSTEPS as f64
            };
            let substep =
                StepInterval { start: to.t, end, h: interval.h / SUBSTEPS as f64, low: 0.0 };
            to = Dop853.attempt(field, &substep, &mut to, &mut self.starter);
        }
        let difference = to.q.since(&from.q);
        let w = Compensated::new(difference.map(|difference| difference / T::from_f64(interval.h)));
        if 1 < self.points {
            let rise = w.since(&self.w);
            self.d.push(rise.map(|rise| rise / T::from_f64(interval.h)));
        }
        self.f.push(self.newest);
        self.newest = to.end_acceleration(field);
        self.w = w;
        self.points += 1;
        self.end = (to.t, to.q, to.v.high);
        to
    }

    /// Visits everything that the next step depends on.
    pub(crate) fn remember(&mut self, memory: &mut Memory) {
        memory.scalars(&mut self.newest);
        self.f.remember(memory);
        self.d.remember(memory);
        memory.sums(&mut self.w);
        memory.number(&mut self.h);
        memory.count(&mut self.points, P);
        let (t, q, v) = &mut self.end;
        memory.time(t);
        memory.sums(q);
        memory.scalars(v);
    }

    /// Returns the motion within the last step, from both of its ends and the latest accelerations.
    pub(crate) fn interpolant<D: Dynamics<N, Scalar = T>>(
        &self,
        field: &mut Field<'_, D, N>,
        interval: &StepInterval,
        from: &mut Endpoint<T, N>,
        to: &mut Endpoint<T, N>,
    ) -> Interpolant<T, N> {
        let (a0, a1) = (from.start_acceleration(field), to.end_acceleration(field));
        if self.points < BEHIND {
            // All pieces of an integration get the same number of terms.
            return Interpolant {
                terms: BEHIND + 3,
                ..hermite::quintic(interval, from, to, &a0, &a1)
            };
        }
        let h = T::from_f64(interval.h);
        let mut interpolant = Interpolant::linear(interval, from, to);
        let scaled = |values: &[T; N], factor: T| values.map(|value| factor * value);
        let zero = (Condition::Slope(0.0), [T::from_f64(0.0); N]);
        let (mut q, mut v) = ([zero; BEHIND + 2], [zero; BEHIND]);
        for j in 0..BEHIND {
            let (theta, f) =
                (1.0 - j as f64, if j == 0 { &self.newest } else { &self.f.values()[P - j] });
            q[j] = (Condition::Curvature(theta), scaled(f, h * h));
            v[j] = (Condition::Slope(theta), scaled(f, h));
        }
        q[BEHIND] = (Condition::Slope(0.0), scaled(&from.v.high, h));
        q[BEHIND + 1] = (Condition::Slope(1.0), scaled(&to.v.high, h));
        fit(&mut interpolant.q, &q);
        fit(&mut interpolant.v, &v);
        interpolant.terms = BEHIND + 3;
        interpolant
    }
}

/// The number of parts of each of the first steps: sufficient for an error at the level of rounding
/// wherever the method is stable.
const SUBSTEPS: usize = 4;

/// The number of accelerations in the dense output.
const BEHIND: usize = 7;

/// Returns Σ weight_j · value(j) over j ≥ `first`, as two sums of alternating terms, which halves
/// the wait for the last addition.
// Unrolled by hand, because the compiler does not unroll some of these loops and keeps the
// comparisons in them.
#[allow(clippy::inline_always)]
#[inline(always)]
fn sum<T: Float, const P: usize>(
    first: usize,
    weights: &[f64; P],
    value: impl Fn(usize) -> T,
) -> T {
    const { assert!(P <= 12) };
    let mut sums = [T::from_f64(0.0); 2];
    macro_rules! add {
        ($($j:literal)*) => {$(
            if first <= $j && $j < P && weights[$j] != 0.0 {
                sums[$j % 2] += T::from_f64(weights[$j]) * value($j);
            }
        )*};
    }
    add!(11 10 9 8 7 6 5 4 3 2 1 0);
    sums[0] + sums[1]
}

/// The last `P` values of a sequence, in a buffer of 4 `P` values that moves them only once every 3
/// `P` steps: reading values that were just written and moved would have to wait for both
/// operations.
#[derive(Clone, Copy, Debug)]
struct Window<T, const N: usize, const P: usize> {
    buffer: [[[T; N]; P]; 4],
    start: usize,
}

impl<T: Float, const N: usize, const P: usize> Window<T, N, P> {
    fn new() -> Self {
        Self { buffer: [[[T::from_f64(0.0); N]; P]; 4], start: 0 }
    }

    /// Visits the values, but not their position in the buffer.
    fn remember(&mut self, memory: &mut Memory) {
        let mut values = *self.values();
        for value in &mut values {
            memory.scalars(value);
        }
        if memory.reads() {
            (self.buffer[0], self.start) = (values, 0);
        }
    }

    /// Returns the values, the newest last.
    #[inline]
    fn values(&self) -> &[[T; N]; P] {
        let values = self.buffer.as_flattened()[self.start..].first_chunk();
        values.unwrap_or(&self.buffer[0])
    }

    #[inline]
    fn push(&mut self, value: [T; N]) {
        let buffer = self.buffer.as_flattened_mut();
        if self.start == 3 * P {
            buffer.copy_within(self.start.., 0);
            self.start = 0;
        }
        buffer[self.start + P] = value;
        self.start += 1;
    }
}

/// Returns the weights of velocities for order `P`, which are exact for accelerations that are
/// polynomials.
const fn velocities<const P: usize>() -> [f64; P] {
    padded(match P {
        8 => &VELOCITIES8,
        10 => &VELOCITIES10,
        12 => &VELOCITIES12,
        _ => panic!("multistep methods have order 8, 10 or 12"),
    })
}

/// Returns `values`, padded with zeros.
pub(crate) const fn padded<const P: usize>(values: &[f64]) -> [f64; P] {
    let (mut padded, mut i) = ([0.0; P], 0);
    while i < values.len() {
        padded[i] = values[i];
        i += 1;
    }
    padded
}

// Printed by tests/data/multistep.py.

const VELOCITIES8: [f64; 7] = [
    0.23602017195767197,
    0.4774305555555556,
    -0.4253720238095238,
    0.35122354497354497,
    -0.19104662698412697,
    0.0599702380952381,
    -0.00822585978835979,
];

const VELOCITIES10: [f64; 9] = [
    0.223835014329806,
    0.5682638888888889,
    -0.7200209435626103,
    0.8939858906525573,
    -0.8113301917989418,
    0.5096615961199294,
    -0.20980379188712522,
    0.0509457671957672,
    -0.005537229938271605,
];

const VELOCITIES12: [f64; 11] = [
    0.21502497590822245,
    0.6516462053571429,
    -1.0740100628056357,
    1.7813400623296456,
    -2.265120569534632,
    2.1353147421637004,
    -1.4654353242243867,
    0.711832686988937,
    -0.2321385199965929,
    0.045637774487600875,
    -0.004091970674001924,
];
