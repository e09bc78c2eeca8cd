//! Taylor series of any order.

// What lanes use too has to be compiled for their vectors.
#![allow(clippy::inline_always)]

use super::adaptive_step::{AdaptiveStep, fit, resolution_of};
use super::blame::{self, blame};
use super::control::{Control, Course, Memory};
use super::field::{Accelerations, Counted, Watched, coordinate, first_in_state};
use super::node::Node;
use super::piece::{Basis, Piece, TERMS};
use super::power::{digits, log2, power};
use super::span::Span;
use super::stepper::Stepper;
use crate::error::{Error, Quantity};
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
/// inexact, and whole steps are taken until series hold again. Each comparison is one evaluation, which [`Stats`](super::Stats) do not count: there each order of the series is
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
pub struct Room<T, W, X, const N: usize> {
    path: Path<T, N>,
    drive: X,
    work: W,
    /// The order of the jet.
    order: usize,
    /// What the tolerance decides.
    rule: Rule,
    /// The last time at which a series did not hold.
    refuted: Option<Time>,
    /// How many steps in a row went over a jump, or what seems to be one.
    crossed: u32,
    /// One more for each step that was halved, two less for each whole step whose series holds, and
    /// none where steps are long again.
    doubts: u32,
    /// The shortest step of these.
    shortest: f64,
}

/// A jump is found within some forty steps, and behind it they are long again. If series go on not
/// to hold, the accelerations are not exact.
const MOST_DOUBTS: u32 = 256;

/// A step is long again if it is so many times as long as the shortest before it.
const FOUND: f64 = 1e3;

/// What the tolerance decides about the length of a step.
#[derive(Clone, Debug, Default)]
pub(super) struct Rule {
    tolerance: f64,
    pub(super) order: usize,
    /// For each order what its coefficient tells where it is 2^−1023, and how much less for one
    /// that is twice as large, over 2³².
    told: [(f64, f64); LENGTH],
}

impl Rule {
    pub(super) fn new<S: Jets<N>, const N: usize>(method: Taylor, tolerance: f64) -> Self {
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
    pub(super) fn told(&self, coefficient: f64, k: usize) -> f64 {
        let (most, slope) = self.told[k];
        let told = most - slope * digits(coefficient);
        if 0.0 < coefficient { told } else { f64::INFINITY }
    }
}

/// The room for the jets of the dynamics `D`.
pub(crate) type RoomOf<D, const N: usize> = Room<
    <D as Dynamics<N>>::Scalar,
    <<D as Dynamics<N>>::System as Jets<N>>::Work,
    <<D as Dynamics<N>>::System as Jets<N>>::Drive,
    N,
>;

impl<D: JetDynamics<N, Scalar: Float>, const N: usize> Stepper<D, N> for Taylor {
    const NAME: &'static str = "Taylor";
    type Stages = RoomOf<D, N>;

    fn goes_back(&self, _: &D) -> bool {
        true
    }

    fn room(&self, dynamics: &D) -> RoomOf<D, N> {
        Room {
            path: Path::new(),
            drive: D::System::drive(),
            work: dynamics.system().work(),
            order: 0,
            rule: Rule::default(),
            refuted: None,
            crossed: 0,
            doubts: 0,
            shortest: f64::INFINITY,
        }
    }

    fn advance(
        &self,
        field: &mut Counted<'_, D>,
        span: &Span,
        from: &mut Node<D::Scalar, N>,
        room: &mut RoomOf<D, N>,
    ) -> Node<D::Scalar, N> {
        let order = self.fixed::<D::Scalar>();
        expand(field, from, side(span.h), order, room);
        sum(room, from, span)
    }

    fn within(
        &self,
        _: &mut Counted<'_, D>,
        span: &Span,
        from: &mut Node<D::Scalar, N>,
        _: &mut Node<D::Scalar, N>,
        room: &mut RoomOf<D, N>,
    ) -> Piece<D::Scalar, N> {
        let (h, zero) = (span.length::<D::Scalar>(), [[D::Scalar::from_f64(0.0); N]; TERMS]);
        let (q0, v0) = (from.q.high, from.v.high);
        let mut piece = Piece {
            span: *span,
            q0,
            v0,
            q: zero,
            v: zero,
            terms: room.order,
            basis: Basis::Powers,
        };
        let mut power = h;
        for k in 1..=room.order {
            for i in 0..N {
                piece.q[k - 1][i] = room.path.q[i][k] * power;
                piece.v[k - 1][i] = room.path.v[i][k] * power;
            }
            power *= h;
        }
        piece
    }

    fn fault(
        &self,
        dynamics: &D,
        span: &Span,
        from: &Node<D::Scalar, N>,
        _: &RoomOf<D, N>,
    ) -> Option<Error> {
        let mut watched = Watched::new(dynamics);
        watched.at(from.t, side(span.h), &from.q.high, &from.v.high);
        let mut room = self.room(dynamics);
        expand(
            &mut Counted::new(dynamics),
            from,
            side(span.h),
            self.fixed::<D::Scalar>(),
            &mut room,
        );
        let facts = &<D::System as System<N>>::FACTS;
        let finite = |series: &Series<D::Scalar>| series.iter().all(|x| x.is_finite());
        let infinite = (0..N).find(|&i| !finite(&room.path.v[i]) || !finite(&room.path.q[i]));
        let (t, what) = watched
            .first
            .or_else(|| {
                infinite.map(|index| (from.t, Quantity::Acceleration(coordinate(facts, index))))
            })
            .or_else(|| {
                let to = sum(&room, from, span);
                first_in_state(facts, &to.q.high, &to.v.high).map(|what| (span.end, what))
            })?;
        Some(blame::not_finite(dynamics.system(), t, what))
    }

    fn kink(&self, dynamics: &D, t: f64, backwards: bool) -> Option<f64> {
        if backwards { dynamics.last_kink(t) } else { dynamics.next_kink(t) }
    }
}

impl<D: JetDynamics<N, Scalar: Float>, const N: usize> Control<Taylor, D, N> for AdaptiveStep<N> {
    fn check(&self) -> Result<(), Error> {
        self.positive::<D::Scalar>()
    }

    fn least_steps(&self, length: f64) -> f64 {
        self.least_steps_over(length)
    }

    fn step(
        &self,
        memory: &mut Memory,
        course: Course<'_, '_, D, Taylor, N>,
    ) -> Result<Span, Error> {
        let Course { method, field, from, to, stages: room, target, stats } = course;
        let t = from.t.to_f64();
        let backwards = target < t;
        let target = if backwards {
            field.dynamics.last_break(t).filter(|time| target < *time).unwrap_or(target)
        } else {
            field.dynamics.next_break(t).filter(|time| *time < target).unwrap_or(target)
        };
        let (rtol, atol) = self.tolerances::<D::Scalar>();
        if room.rule.tolerance != rtol {
            room.rule = Rule::new::<D::System, N>(*method, rtol);
        }
        let order = room.rule.order;
        expand(field, from, if backwards { Side::Before } else { Side::After }, order, room);
        let weights = [
            core::array::from_fn(|i| 1.0 / (atol.0[i] + rtol * from.q.high[i].to_f64().abs())),
            core::array::from_fn(|i| 1.0 / (atol.1[i] + rtol * from.v.high[i].to_f64().abs())),
        ];
        let wanted = length(&room.path, &room.rule, &weights);
        // A uniform motion may go on for ever, but it has to come to an end.
        let wanted = if wanted == f64::INFINITY && target == wanted { 1.0 } else { wanted };
        let mut wanted = memory.within_sight(
            self.limited(memory.h == 0.0, wanted),
            field.dynamics,
            from.t,
            GAP,
        )?;
        if memory.h == 0.0 {
            // At a start nothing is known of jumps.
            (room.refuted, room.crossed, room.doubts) = (None, 0, 0);
        }
        // Towards a time at which the last series did not hold.
        let left = |refuted: Time| refuted.since(from.t.to_f64()) - from.t.low();
        room.refuted = room.refuted.filter(|&refuted| {
            let left = left(refuted);
            (left < 0.0) == backwards && resolution_of::<D::Scalar>(from.t) < left.abs()
        });
        let mut holds = room.refuted.is_none();
        if let Some(refuted) = room.refuted {
            let left = left(refuted).abs();
            wanted = if left < wanted { left } else { wanted };
        }
        let mut span = fit(from.t, wanted, target);
        *to = sum(room, from, &span);
        let whole = span;
        let finite = |series: &Series<D::Scalar>| series[..=order].iter().all(|x| x.is_finite());
        let known =
            to.is_finite() || (0..N).all(|i| finite(&room.path.q[i]) && finite(&room.path.v[i]));
        let (mut halved, mut crosses) = (0, false);
        // At the resolution of times no step can be shorter.
        while known && resolution_of::<D::Scalar>(from.t) < wanted {
            let strict = 0 < halved || room.refuted.is_some();
            let misfit = misfit(field.dynamics, room, &span, to, &weights[1], strict);
            holds &= misfit.allowed;
            if misfit.allowed || MOST_DOUBTS <= room.doubts {
                break;
            }
            stats.rejected += 1;
            halved += 1;
            room.refuted = Some(span.end);
            // A jump may be as wide as the rounding of the place: each further step over it is twice
            // as long.
            if MOST_HALVED.saturating_sub(room.crossed) <= halved {
                // Something jumps within so short a step, which goes over that; or its series is
                // right, and what does not fit is rounding.
                crosses = !misfit.rounding;
                if !crosses {
                    (wanted, span) = (whole.h.abs(), whole);
                    *to = sum(room, from, &span);
                }
                room.refuted = None;
                break;
            }
            // The same series ends sooner.
            wanted = 0.5 * span.h.abs();
            span = fit(from.t, wanted, target);
            *to = sum(room, from, &span);
        }
        if !to.is_finite() {
            return Err(blame(method, field.dynamics, &whole, from, room));
        }
        if wanted <= resolution_of::<D::Scalar>(from.t) && wanted < from.t.since(target).abs() {
            let (_, index) = largest(&room.path, order, &weights);
            let coordinate = coordinate(&<D::System as System<N>>::FACTS, index);
            let short = Error::StepSizeUnderflow { t, step: wanted, coordinate };
            return Err(self.unresolved(memory.h == 0.0, wanted).unwrap_or(short));
        }
        room.crossed = if crosses { room.crossed + 1 } else { 0 };
        if room.doubts < MOST_DOUBTS && FOUND * room.shortest < wanted || room.doubts == 0 {
            (room.doubts, room.shortest) = (0, f64::INFINITY);
        }
        if 0 < halved {
            room.doubts += 1;
            room.shortest = if wanted < room.shortest { wanted } else { room.shortest };
        } else if holds {
            room.doubts = room.doubts.saturating_sub(2);
        }
        if MOST_DOUBTS <= room.doubts {
            room.refuted = None;
        }
        memory.h = wanted;
        stats.accepted += 1;
        Ok(span)
    }
}

/// A series knows the start of its step alone. It tells a bell from two widths away, and the bound
/// is to leave a sine its steps of 3/ω.
pub(super) const GAP: f64 = 0.7;

/// The side from which the start of a step is seen.
fn side(h: f64) -> Side {
    if h < 0.0 { Side::Before } else { Side::After }
}

/// The jet at `from`.
#[inline]
fn expand<D: JetDynamics<N, Scalar: Float>, const N: usize>(
    field: &mut Counted<'_, D>,
    from: &Node<D::Scalar, N>,
    side: Side,
    order: usize,
    room: &mut RoomOf<D, N>,
) {
    if room.order != order {
        // No coefficient of a higher order may stay.
        room.path = Path::new();
        room.order = order;
    }
    let Room { path, drive, work, .. } = room;
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
    room: &Room<T, W, X, N>,
    from: &Node<T, N>,
    span: &Span,
) -> Node<T, N> {
    let h = span.length::<T>();
    let mut to = Node { t: span.end, a: None, ..*from };
    for i in 0..N {
        to.q.add_product(i, h, room.path.q[i][1], rest(&room.path.q[i], room.order, h));
        to.v.add_product(i, h, room.path.v[i][1], rest(&room.path.v[i], room.order, h));
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
    dynamics: &D,
    room: &RoomOf<D, N>,
    span: &Span,
    to: &Node<D::Scalar, N>,
    weights: &[f64; N],
    strict: bool,
) -> Misfit {
    let (h, zero) = (span.length::<D::Scalar>(), D::Scalar::from_f64(0.0));
    // Beside the orders of the series, which are what evaluations of this method count.
    let a = Counted::new(dynamics).at(span.end, side(span.h).opposite(), &to.q.high, &to.v.high);
    // Motions have the digits of `f64`.
    let facts = &<D::System as System<N>>::FACTS;
    let epsilon = D::Scalar::EPSILON.to_f64();
    let rounding = 1e3
        * if facts.inputs.is_empty() || f64::EPSILON < epsilon { epsilon } else { f64::EPSILON };
    let largest = |values: &dyn Fn(usize) -> D::Scalar| {
        (0..N).fold(0.0, |largest: f64, i| largest.max(values(i).to_f64().abs()))
    };
    let (q, v) = (&room.path.q, &room.path.v);
    let series: [D::Scalar; N] = core::array::from_fn(|i| {
        let orders = (1..=room.order).rev();
        orders.fold(zero, |sum, k| sum * h + D::Scalar::from_f64(k as f64) * v[i][k])
    });
    // Coordinates and time are rounded too, and the accelerations change with them as they do on
    // the way: those of the series, where a jump is no slope.
    let way = largest(&|i| to.q.high[i] - q[i][0]);
    let turns = [largest(&|i| a[i] - v[i][1]), largest(&|i| series[i] - v[i][1])];
    let turn = if turns[1] < turns[0] { turns[1] } else { turns[0] };
    let by_place = if 0.0 < way { largest(&|i| to.q.high[i]) * (turn / way) } else { 0.0 };
    let by_time = span.end.to_f64().abs() * (turn / span.h.abs());
    let size = largest(&|i| a[i]) + by_place + if facts.autonomous { 0.0 } else { by_time };
    let (mut allowed, mut is_rounding) = (to.is_finite() && size.is_finite(), true);
    for i in 0..N {
        let difference = (a[i] - series[i]).to_f64().abs();
        // That of a smooth series is gone after a halving; that of a jump is not, and the velocity
        // is off by all of it.
        let (share, most) = if strict { (1.0, 1.0) } else { (room.order as f64, MISFIT) };
        let misfit = span.h.abs() * difference / share;
        let noise = rounding * (to.v.high[i].to_f64().abs() + span.h.abs() * size);
        allowed &= misfit * weights[i] <= most + noise * weights[i];
        is_rounding &= difference <= 1e3 * rounding * size;
    }
    Misfit { allowed, rounding: is_rounding }
}

/// Σ x\[k\] hᵏ over 2 ≤ k ≤ `order`, beyond which all are zero: every fourth term after Horner
/// (1819), the four sums side by side.
#[inline(always)]
pub(super) fn rest<T: Real>(series: &Series<T>, order: usize, h: T) -> T {
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
pub(super) const TELLING: usize = 4;

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
        if TELLING <= told && least < f64::INFINITY {
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
pub(super) fn largest<T: Float, const N: usize>(
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
