//! Switches and layers: arguments of functions that the integration follows along each step.
//!
//! A step samples accelerations at a few times, and its error estimate contains only what these
//! samples contain. Between two of them, the argument of `sign` may change its sign twice, and that
//! of tanh(v/ε) may come near zero and leave again. The dense output shows both, because far from
//! zero the accelerations are as smooth as the method assumes. A step is therefore repeated up to
//! the first change of sign of a switch, and in shorter parts near the middle of a layer. The price
//! is one interpolant a step; systems without such functions do not pay it.

use crate::integrate::events::root::{Dip, dip, root, stays_away};
use crate::integrate::interpolant::Interpolant;
use crate::integrate::state::endpoint::Endpoint;
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{At, Dynamics, Purpose, System, scalar_time};
use core::convert::Infallible;

/// The number of points at which arguments are evaluated.
const COUNT: usize = 19;
/// The distance of the outer two points from the ends of the step.
const EDGE: f64 = 1.0 / 4096.0;
/// These points as fractions of the step: both ends, points near them, which show if an argument
/// falls there, and the sixteenths.
const POINTS: [f64; COUNT] = {
    let mut points = [0.0; COUNT];
    let mut k = 2;
    while k < COUNT - 2 {
        points[k] = (k - 1) as f64 / 16.0;
        k += 1;
    }
    (points[1], points[COUNT - 2], points[COUNT - 1]) = (EDGE, 1.0 - EDGE, 1.0);
    points
};
/// The number of parts of a step from one sample of a method to the next, rounded up.
const WINDOW: usize = 4;
/// The greatest change of a layer between two samples of a method near the middle of the layer.
const APART: f64 = 1.0;
/// Arguments of layers count as at most this large, so that their sums are finite.
const LARGEST: f64 = 1e300;
/// The absolute tolerances count as rounding up to this fraction.
const FINE: f64 = 1e-6;
/// A motion is beside a switch within this fraction of the absolute tolerances. `Picard` accepts
/// steps with samples on both sides from about a ten thousandth on.
const NEAR: f64 = 1e-3;

/// Returns the number of arguments of the dynamics `D`.
const fn count<D: Dynamics<N>, const N: usize>() -> usize {
    let facts = &<D::System as System<N>>::FACTS;
    facts.switches.len() + facts.layers.len()
}

/// Returns `true` if the equations or limits of the dynamics `D` contain switches or layers.
#[inline]
pub(crate) const fn has_arguments<D: Dynamics<N>, const N: usize>() -> bool {
    0 < count::<D, N>()
}

/// The reason why a step has to be repeated with another end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cut {
    /// The switch with this index changes its sign at this fraction of the step.
    Switch { index: usize, theta: f64 },
    /// A layer requires a step as long as this fraction of the step.
    Layer(f64),
}

/// What a straight step over a switch has met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Passage {
    /// No switch has changed its sign.
    Nothing,
    /// All switches go on to their other sides; the first of them has this index.
    Through(usize),
    /// The accelerations on both sides lead the switch with this index back to zero.
    Back(usize),
}

/// The arguments along the last step, a row for each point.
#[derive(Clone, Debug)]
pub(crate) struct Arguments<T> {
    rows: Vec<T>,
    /// The length of usual steps.
    pub(super) usual: f64,
}

impl<T: Float> Arguments<T> {
    /// Creates the memory for the arguments of the dynamics `D`.
    pub(crate) fn new<D: Dynamics<N, Scalar = T>, const N: usize>() -> Self {
        Self { rows: vec![T::from_f64(0.0); count::<D, N>() * (COUNT + 2)], usual: 0.0 }
    }

    /// Creates no memory, for steps of fixed length, which do not look at arguments.
    pub(crate) fn none() -> Self {
        Self { rows: Vec::new(), usual: 0.0 }
    }

    /// Returns the reason to repeat the step of `interpolant`, which ends in `to`, if any.
    pub(crate) fn look<D: Dynamics<N, Scalar = T>, const N: usize>(
        &mut self,
        dynamics: &D,
        interpolant: &Interpolant<T, N>,
        to: &Endpoint<T, N>,
        onwards: Side,
        (relative, absolute): (f64, &[[f64; N]; 2]),
    ) -> Option<Cut> {
        if !agrees(interpolant, relative, &absolute[0]) {
            return Some(Cut::Layer(0.5));
        }
        self.usual(interpolant.interval.h.abs());
        let count = count::<D, N>();
        let switches = <D::System as System<N>>::FACTS.switches.len();
        let (rows, extra) = self.rows.split_at_mut(count * COUNT);
        for (row, theta) in rows.chunks_exact_mut(count).zip(POINTS) {
            if theta == 1.0 {
                evaluate(dynamics, to, onwards.opposite(), row);
            } else {
                on(dynamics, interpolant, theta, onwards, row);
            }
        }
        let mut switch: Option<(usize, f64)> = None;
        for index in 0..switches {
            let values: [T; COUNT] = core::array::from_fn(|k| rows[k * count + index]);
            if !may_cross(&values) {
                continue;
            }
            let least = rounding(dynamics, to, onwards.opposite(), (FINE, absolute), index, extra);
            let at = |theta: f64| {
                on(dynamics, interpolant, theta, onwards, &mut extra[..count]);
                extra[index]
            };
            if let Some(theta) = crossing(&values, least, at)
                && switch.is_none_or(|(_, first)| theta < first)
            {
                switch = Some((index, theta));
            }
        }
        let end = switch.map_or(1.0, |(_, theta)| theta);
        let mut layer: Option<f64> = None;
        for index in switches..count {
            // Differences of infinities would hide the layer between them.
            let values =
                core::array::from_fn(|k| rows[k * count + index].to_f64().clamp(-LARGEST, LARGEST));
            if let Some(theta) = unresolved(&values, end) {
                layer = Some(layer.map_or(theta, |least| f64::min(least, theta)));
            }
        }
        let switch = switch.map(|(index, theta)| Cut::Switch { index, theta });
        layer.map(Cut::Layer).or(switch)
    }

    /// Returns the first switch that a stage of the step last looked at has on the other side than
    /// the dense output, if any.
    ///
    /// Stages on both sides of a jump may cancel in the error estimate and in the dense output: a
    /// motion that would have to stay at the switch then goes on beside it.
    pub(crate) fn strayed<D: Dynamics<N, Scalar = T>, const N: usize>(
        &mut self,
        dynamics: &D,
        to: &Endpoint<T, N>,
        onwards: Side,
        absolute: &[[f64; N]; 2],
        stage: impl Fn(usize) -> Option<(f64, Endpoint<T, N>)>,
    ) -> Option<Cut> {
        let count = count::<D, N>();
        let (rows, extra) = self.rows.split_at_mut(count * COUNT);
        for index in 0..<D::System as System<N>>::FACTS.switches.len() {
            let mut farthest = T::from_f64(0.0);
            for row in rows.chunks_exact(count) {
                if farthest.abs() < row[index].abs() {
                    farthest = row[index];
                }
            }
            let mut least = None;
            for (c, state) in (0..).map_while(&stage) {
                // The end may be a kink, where the argument jumps.
                let side = if c < 1.0 { onwards } else { onwards.opposite() };
                evaluate(dynamics, &state, side, &mut extra[..count]);
                let value = extra[index];
                if sign(value) != -sign(farthest) || sign(value) == 0 {
                    continue;
                }
                let least = *least.get_or_insert_with(|| {
                    rounding(dynamics, to, onwards.opposite(), (FINE, absolute), index, extra)
                });
                if least < value.abs() && least < farthest.abs() {
                    // Along a line from the start to the stage. Later stages depend on this one.
                    let [start, value] = [rows[index], value].map(|value: T| value.to_f64());
                    let theta = c * f64::max(start / (start - value), 0.05);
                    return Some(Cut::Switch { index, theta });
                }
            }
        }
        None
    }

    /// Returns the fraction of the step last looked at after which this switch will change its
    /// sign, assuming constant rates.
    pub(crate) fn ahead(&self, index: usize) -> f64 {
        let count = self.rows.len() / (COUNT + 2);
        let [before, end] = [2, 1].map(|k| self.rows[(COUNT - k) * count + index].to_f64());
        EDGE * end / (before - end)
    }

    /// Returns states on both sides of a switch that `from` has come near to, if there is one whose
    /// argument depends on velocities.
    ///
    /// Steps that end beside a switch where the motion sticks need not cross it: near enough, their
    /// errors are below the tolerances, whichever sides their samples lie on.
    pub(crate) fn beside<D: Dynamics<N, Scalar = T>, const N: usize>(
        &mut self,
        dynamics: &D,
        from: &Endpoint<T, N>,
        onwards: Side,
        absolute: &[[f64; N]; 2],
    ) -> Option<[Endpoint<T, N>; 2]> {
        let zero = T::from_f64(0.0);
        let count = count::<D, N>();
        let (rows, extra) = self.rows.split_at_mut(count * COUNT);
        let (before, here) = rows.split_at_mut(count);
        evaluate(dynamics, from, onwards, &mut here[..count]);
        for index in 0..<D::System as System<N>>::FACTS.switches.len() {
            let value = here[index];
            // From zero, the motion may have moved by rounding only.
            let left = before[index] == zero && value != zero;
            let nearer = left || value.abs() < before[index].abs();
            if !nearer {
                continue;
            }
            let near = rounding(dynamics, from, onwards, (NEAR, absolute), index, extra);
            if near < value.abs() {
                continue;
            }
            // The shortest way through the surface.
            let mut gradient = [zero; N];
            let mut square = zero;
            for i in 0..N {
                let mut moved = *from;
                let size = T::EPSILON.sqrt() * (from.v.high[i].abs() + T::from_f64(absolute[1][i]));
                moved.v.high[i] += size;
                evaluate(dynamics, &moved, onwards, &mut extra[..count]);
                gradient[i] = (extra[index] - value) / size;
                square += gradient[i] * gradient[i];
            }
            if zero < square {
                let ways = if value == zero { [near, -near] } else { [zero, -value - value] };
                return Some(ways.map(|way| {
                    let mut state = Endpoint { a: None, ..*from };
                    for i in 0..N {
                        state.v.high[i] += way * gradient[i] / square;
                    }
                    state
                }));
            }
        }
        None
    }

    /// Returns what the switches have done from `before` to `after`, with the accelerations `a` at
    /// both of them.
    pub(crate) fn crossed<D: Dynamics<N, Scalar = T>, const N: usize>(
        &mut self,
        dynamics: &D,
        [before, after]: [&Endpoint<T, N>; 2],
        a: [&[T; N]; 2],
        onwards: Side,
        dt: f64,
    ) -> Passage {
        let count = count::<D, N>();
        let (mut changed, mut sliding) = (None, None);
        let [old, new, later] = {
            let (old, rest) = self.rows.split_at_mut(count);
            let (new, rest) = rest.split_at_mut(count);
            [old, new, &mut rest[..count]]
        };
        evaluate(dynamics, before, onwards, old);
        evaluate(dynamics, after, onwards, new);
        for index in 0..<D::System as System<N>>::FACTS.switches.len() {
            let sides = [sign(old[index]), sign(new[index])];
            if sides[0] == sides[1] {
                continue;
            }
            changed = changed.or(Some(index));
            // Both rates point to the surface.
            let slides = (0..2).all(|k| {
                let step = T::from_f64(dt);
                let mut shifted = Endpoint { t: after.t + dt, ..*after };
                for i in 0..N {
                    // The rates of states may jump.
                    let state = N - <D::System as System<N>>::FACTS.states <= i;
                    let v = if state { [before, after][k] } else { after }.v.high[i];
                    shifted.q.high[i] += step * v;
                    shifted.v.high[i] += step * a[k][i];
                }
                evaluate(dynamics, &shifted, onwards, later);
                sign(later[index] - new[index]) == -sides[k] && sides[k] != 0
            });
            if slides {
                sliding = Some(index);
            }
        }
        match (sliding, changed) {
            (Some(index), _) => Passage::Back(index),
            (None, Some(index)) => Passage::Through(index),
            (None, None) => Passage::Nothing,
        }
    }

    /// Returns the value of one switch.
    pub(crate) fn value<D: Dynamics<N, Scalar = T>, const N: usize>(
        &mut self,
        dynamics: &D,
        index: usize,
        at: &Endpoint<T, N>,
        side: Side,
    ) -> T {
        evaluate(dynamics, at, side, &mut self.rows[..=index]);
        self.rows[index]
    }

    /// Returns the length of usual steps, among which is one of length `h`. Near switches, many
    /// steps in sequence are far shorter.
    pub(crate) fn usual(&mut self, h: f64) -> f64 {
        self.usual = f64::max(0.9 * self.usual, h);
        self.usual
    }
}

/// Returns `false` if the coordinates on the dense output do not follow its velocities by far more
/// than the tolerances allow.
///
/// `Picard` evaluates accelerations at further times for the dense output. It adds what is missing
/// at the end as a straight line, which is the greater the less these accelerations are as those of
/// the step led to expect.
fn agrees<T: Float, const N: usize>(
    interpolant: &Interpolant<T, N>,
    relative: f64,
    absolute: &[f64; N],
) -> bool {
    const FAR: f64 = 100.0;
    /// The part of the step in which this is seen.
    const PART: f64 = 1.0 / 256.0;
    let [(q0, v0), (_, v), (q1, v1)] =
        [0.0, 0.5 * PART, PART].map(|theta| interpolant.at(T::from_f64(theta)));
    (0..N).all(|i| {
        let [before, between, after] = [v0[i], v[i], v1[i]].map(|x: T| x.to_f64());
        // Simpson's rule.
        let path = interpolant.interval.h * (before + 4.0 * between + after) / 6.0;
        let misfit = (q1[i] - q0[i]).to_f64() / PART - path;
        let size = q0[i].to_f64().abs() + path.abs();
        let rounding = 1e3 * T::EPSILON.to_f64() * size;
        // A dense output of no numbers fails the comparison.
        misfit.abs() <= FAR * (absolute[i] + relative * size) + rounding
    })
}

/// Computes the arguments at a state.
fn evaluate<D: Dynamics<N>, const N: usize>(
    dynamics: &D,
    Endpoint { t, q, v, .. }: &Endpoint<D::Scalar, N>,
    side: Side,
    values: &mut [D::Scalar],
) where
    D::Scalar: Float,
{
    let (q, v) = (&q.high, &v.high);
    let inputs = dynamics.inputs_with(*t, side, Purpose::Accelerations, q, v);
    dynamics.system().arguments(At { t: scalar_time(*t), q, v, inputs: &inputs }, values);
}

/// Computes the arguments on the dense output.
fn on<D: Dynamics<N>, const N: usize>(
    dynamics: &D,
    interpolant: &Interpolant<D::Scalar, N>,
    theta: f64,
    onwards: Side,
    values: &mut [D::Scalar],
) where
    D::Scalar: Float,
{
    let interval = &interpolant.interval;
    let (q, v) = interpolant.at(D::Scalar::from_f64(theta));
    evaluate(dynamics, &Endpoint::new(interval.start + theta * interval.h, q, v), onwards, values);
}

/// Returns the change of an argument that counts as rounding, or as this fraction of the absolute
/// tolerances.
fn rounding<D: Dynamics<N>, const N: usize>(
    dynamics: &D,
    end: &Endpoint<D::Scalar, N>,
    side: Side,
    (fraction, absolute): (f64, &[[f64; N]; 2]),
    index: usize,
    rows: &mut [D::Scalar],
) -> D::Scalar
where
    D::Scalar: Float,
{
    let (here, there) = rows.split_at_mut(rows.len() / 2);
    evaluate(dynamics, end, side, here);
    let mut sum = D::Scalar::from_f64(0.0);
    for (part, absolute) in absolute.iter().enumerate() {
        for i in 0..N {
            let mut moved = *end;
            let value = if part == 0 { &mut moved.q.high[i] } else { &mut moved.v.high[i] };
            let size = D::Scalar::from_f64(16.0) * D::Scalar::EPSILON * value.abs();
            *value += size + D::Scalar::from_f64(fraction * absolute[i]);
            evaluate(dynamics, &moved, side, there);
            sum += (there[index] - here[index]).abs();
        }
    }
    sum
}

pub(super) fn sign<T: Float>(value: T) -> i8 {
    let zero = T::from_f64(0.0);
    i8::from(zero < value) - i8::from(value < zero)
}

/// Returns `true` if an argument with these values may change its sign.
fn may_cross<T: Float>(values: &[T; COUNT]) -> bool {
    let first = values.iter().map(|value| sign(*value)).find(|sign| *sign != 0);
    let Some(side) = first else { return false };
    values.iter().any(|value| sign(*value) == -side) || (1..COUNT - 1).any(|k| is_low(values, k))
}

/// Returns `true` for a value nearer to zero than those beside it, unless the argument stays away
/// from zero there.
fn is_low<T: Float>(values: &[T; COUNT], k: usize) -> bool {
    let near = [k - 1, k, k + 1].map(|k| (T::from_f64(POINTS[k]), values[k].abs()));
    near[1].1 < near[0].1 && near[1].1 < near[2].1 && !stays_away(&near, T::from_f64(0.0))
}

/// Returns the fraction of a step at which an argument first changes its sign. Values of at most
/// `least` count as zero, and so do those far smaller than the others.
fn crossing<T: Float>(values: &[T; COUNT], least: T, mut at: impl FnMut(f64) -> T) -> Option<f64> {
    let farthest = values.iter().fold(T::from_f64(0.0), |far, value| far.max(value.abs()));
    // Very short steps at a switch where the motion sticks end just below `least` on its far side.
    let part = farthest / T::from_f64(64.0);
    let least = if least < farthest && part < least { part } else { least };
    let mut side = 0;
    // The last point on this side.
    let mut last = (T::from_f64(0.0), values[0]);
    for k in 0..COUNT {
        let here = (T::from_f64(POINTS[k]), values[k]);
        let own = if least < here.1.abs() { sign(here.1) } else { 0 };
        if side == 0 {
            side = own;
            if k == 1 && last.1 == T::from_f64(0.0) && own != 0 {
                // The accelerations at the start need not be those on this side.
                return Some(0.0);
            }
        }
        // A step may begin on the other side by rounding, where the last one has ended.
        if own != 0 && sign(last.1) == -own {
            let mut f = |theta: T| Ok::<T, Infallible>(at(theta.to_f64()));
            let Ok(theta) = root(&mut f, last, here);
            return Some(theta.to_f64());
        } else if 0 < k && k < COUNT - 1 && is_low(values, k) {
            let towards = T::from_f64(f64::from(side));
            let mut f = |theta: T| Ok::<T, Infallible>(towards * at(theta.to_f64()));
            let points = [k - 1, k, k + 1].map(|k| (T::from_f64(POINTS[k]), towards * values[k]));
            let Ok(found) = dip(&mut f, points, least);
            if let Dip::Crosses(low) = found {
                let Ok(lowest) = f(low);
                let Ok(theta) = root(&mut f, points[0], (low, lowest));
                return Some(theta.to_f64());
            }
        }
        if own == side {
            last = here;
        }
    }
    None
}

/// Returns the fraction of a step that resolves a layer with these values, if the step does not do
/// so before `end`.
fn unresolved(values: &[f64; COUNT], end: f64) -> Option<f64> {
    for k in 0..COUNT - WINDOW {
        if end <= POINTS[k] {
            break;
        }
        let (mut change, mut least) = (0.0, f64::INFINITY);
        for j in k..k + WINDOW {
            let part = f64::abs(values[j + 1] - values[j]);
            change += part;
            least = f64::min(least, 0.5 * (values[j].abs() + values[j + 1].abs() - part));
        }
        if APART < change && least < change {
            // A step of this length ends as far from the middle as its windows are wide.
            let distance = 0.2 * values[0].abs();
            let allowed = if distance < APART { APART } else { distance };
            let theta = f64::max(POINTS[k], 0.8 * allowed / change);
            return (theta < end).then_some(f64::min(theta, 0.9));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{COUNT, POINTS, crossing, may_cross, unresolved};

    fn crossing_of(f: impl Fn(f64) -> f64) -> Option<f64> {
        let values: [f64; COUNT] = POINTS.map(&f);
        may_cross(&values).then(|| crossing(&values, 1e-14, f)).flatten()
    }

    #[test]
    fn first_change_of_sign() {
        let found = crossing_of(|x| (x - 0.3) * (x - 0.7)).unwrap();
        assert!((found - 0.3).abs() < 1e-15, "{found}");
        assert_eq!(crossing_of(|x| x + 1.0), None);
        assert_eq!(crossing_of(|_| 0.0), None);
    }

    #[test]
    fn change_of_sign_that_ends_within_rounding() {
        let found = crossing_of(|x| 1.8e-13 * (x - 0.95)).unwrap();
        assert!((found - 0.95).abs() < 1e-12, "{found}");
        assert_eq!(crossing_of(|x| 1.8e-12 * (x - 0.997)), None);
    }

    #[test]
    fn two_changes_between_two_points() {
        for (middle, apart) in [(0.4, 1e-3), (0.5, 1e-6), (0.03, 1e-4), (0.998, 1e-4), (0.97, 1e-5)]
        {
            let found = crossing_of(|x| (x - middle) * (x - middle) - apart * apart).unwrap();
            assert!((found - (middle - apart)).abs() < 1e-9, "{found} for {middle}");
            assert_eq!(crossing_of(|x| apart * apart - (x - middle) * (x - middle) - 1.0), None);
        }
        assert_eq!(crossing_of(|x| (x - 0.4) * (x - 0.4) + 1e-9), None);
    }

    #[test]
    fn starts_at_a_switch() {
        assert_eq!(crossing_of(|x| x), None);
        // What returns later is followed from the other side of the switch.
        assert_eq!(crossing_of(|x| x * (0.25 - x)), Some(0.0));
        // A step that has ended just before the switch.
        let found = crossing_of(|x| x - 1e-16).unwrap();
        assert!(found < 1e-15, "{found}");
        assert_eq!(crossing_of(|x| 1e-16 * (7.0 * x).sin()), None);
    }

    #[test]
    fn layers_shorten_steps_near_their_middle() {
        let of = |f: &dyn Fn(f64) -> f64| unresolved(&POINTS.map(f), 1.0);
        assert_eq!(of(&|x| 100.0 + 30.0 * x), None);
        assert_eq!(of(&|x| 2.0 * x - 1.0), None);
        let through = of(&|x| 1000.0 * (x - 0.5)).unwrap();
        assert!(0.1 < through && through < 0.5, "{through}");
        let middle = of(&|x| 100.0 * x).unwrap();
        assert!(0.02 < middle && middle < 0.05, "{middle}");
        assert_eq!(unresolved(&POINTS.map(|x| 1000.0 * (x - 0.5)), 0.1), None);
        assert_eq!(of(&|_| f64::NAN), None);
    }
}
