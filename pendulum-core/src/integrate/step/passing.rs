//! Passages of switches: the jumps of accelerations where an argument changes its sign, which
//! derivatives of the motion jump with.

use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::step::arguments::{Arguments, sign};
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{At, Dynamics, Purpose, System, scalar_time};

/// A change of an acceleration counts as a jump above this fraction of it, and above a smaller one
/// of the largest acceleration, whose rounding errors the others may have.
const JUMPS: [f64; 2] = [1e-7, 1e-12];

/// The weights of five values, from the first of which on a derivative is taken, in twelfths.
const WEIGHTS: [f64; 5] = [-25.0, 48.0, -36.0, 16.0, -3.0];

/// How a motion passes the zero of a switch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passing<T, const N: usize> {
    /// The index of the switch.
    pub(crate) index: usize,
    /// The last state before the zero.
    pub(crate) near: Endpoint<T, N>,
    /// The jumps of the accelerations.
    pub(crate) jump: [T; N],
    /// The rate of the switch before the zero, to ten digits.
    pub(crate) rate: T,
}

impl<T: Float> Arguments<T> {
    /// Returns how a motion passes the zero of a switch. `motion` takes fractions from 0 to 1.
    pub(crate) fn passing<D: Dynamics<N, Scalar = T>, const N: usize>(
        &mut self,
        dynamics: &D,
        index: usize,
        motion: impl Fn(f64) -> Endpoint<T, N>,
        onwards: Side,
    ) -> Passing<T, N> {
        let mut value = |at: &_, side| self.value(dynamics, index, at, side);
        let end = motion(1.0);
        let after = sign(value(&end, onwards.opposite()));
        let (mut low, mut high) = (0.0, 1.0);
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || high <= middle {
                break;
            }
            let beyond = sign(value(&motion(middle), onwards)) == after;
            (low, high) = if beyond { (low, middle) } else { (middle, high) };
        }
        let near = motion(low);
        let (t, forwards) = (near.t.to_f64(), onwards == Side::After);
        let kink = if forwards { dynamics.next_kink(t) } else { dynamics.kink_before(t) };
        let room = kink.map_or(f64::INFINITY, |kink| (kink - t).abs());
        // Differences end before the next kink of the inputs, on whose other side the argument would
        // have another rate.
        let usual = self.usual;
        let length = |power: f64| {
            let d = Real::powf(T::EPSILON, T::from_f64(power)).to_f64() * usual;
            f64::min(d, 0.125 * room).copysign(if forwards { 1.0 } else { -1.0 })
        };
        let on_line = |d: f64, a: &[T; N]| {
            let mut shifted = Endpoint { t: near.t + d, a: None, ..near };
            for i in 0..N {
                shifted.q.high[i] += T::from_f64(d) * near.v.high[i];
                shifted.v.high[i] += T::from_f64(d) * a[i];
            }
            shifted
        };
        let accelerations = |at: Endpoint<T, N>| {
            let (q, v) = (&at.q.high, &at.v.high);
            let inputs = dynamics.inputs_with(at.t, onwards, Purpose::Accelerations, q, v);
            dynamics.system().accelerations(At { t: scalar_time(at.t), q, v, inputs: &inputs })
        };
        // The argument may round to zero here, where `sign` is neither side. The limits of both
        // sides come from straight lines through two points on each of them.
        let (d, between) = (length(0.4), accelerations(near));
        let [a, b] = [-d, d].map(|d| {
            let [one, two] = [d, 2.0 * d].map(|d| accelerations(on_line(d, &between)));
            core::array::from_fn(|i| one[i] + (one[i] - two[i]))
        });
        // The difference of fourth order on one side.
        let d = length(0.2);
        let mut sum = T::from_f64(0.0);
        for (k, weight) in WEIGHTS.into_iter().enumerate() {
            sum += T::from_f64(weight)
                * self.value(dynamics, index, &on_line(k as f64 * d, &a), onwards);
        }
        Passing { index, near, jump: jump(&a, &b), rate: sum / T::from_f64(12.0 * d) }
    }
}

/// Returns the jumps of accelerations between two states next to each other; zero where there is
/// none, as at a kink.
fn jump<T: Float, const N: usize>(a: &[T; N], b: &[T; N]) -> [T; N] {
    let size = |i: usize| f64::max(a[i].abs().to_f64(), b[i].abs().to_f64());
    let [own, all] = JUMPS;
    let least = all * (0..N).map(size).fold(0.0, f64::max);
    core::array::from_fn(|i| {
        let jump = b[i] - a[i];
        if own * size(i) + least < jump.abs().to_f64() { jump } else { T::from_f64(0.0) }
    })
}
