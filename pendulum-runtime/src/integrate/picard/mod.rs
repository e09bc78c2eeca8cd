//! Collocation at Gauss's nodes, solved by Picard's iteration with all nodes of a step side by side
//! in the lanes of a vector.

// What a step needs is inlined into what is compiled for several instruction sets.
#![allow(clippy::inline_always)]

mod dense;
mod kernel;
mod side_by_side;
mod tableau;

use super::adaptive_step::{AdaptiveStep, at, resolution_of};
use super::blame::{self, blame};
use super::control::{Control, Course, Memory};
use super::field::{Accelerations, Counted, Watched, coordinate, first_in_state};
use super::node::Node;
use super::piece::Piece;
use super::power::{log2, power};
use super::span::Span;
use super::stepper::Stepper;
use crate::error::{Error, Quantity};
use crate::motion::Side;
use crate::real::{Float, Lane, Octet, Real};
use crate::simd;
use crate::system::{Dynamics, System};
use crate::time::Time;
use kernel::{Ends, Onwards, Progress, Scaled, Stages};
pub use side_by_side::SideBySide;
use tableau::{EIGHT, S};

/// Collocation with the accelerations at eight Gauss nodes, which are evaluated side by side in the
/// lanes of a vector: order 16, adaptive.
///
/// A_i = a(t + c_i h, Q_i, V_i) with V_i = v₀ + h Σ a_ij A_j and Q_i = q₀ + c_i h v₀ + h² Σ (A²)_ij
/// A_j is solved by Picard's iteration from the polynomial of the step before, in four to seven
/// sweeps. A sweep evaluates the accelerations at all nodes at once, in the time of one or two
/// evaluations on a machine with vectors of 64 or 32 bytes, and up to three times that with 16:
/// this is the fastest method here for most systems and errors. It suits every system that
/// `lagrangian!` has made and any motion, analytic or not.
///
/// The last sweep evaluates the accelerations at eight further points as well, which halve the gaps
/// between the nodes. The error of a step in the velocities is estimated as h max(|α₁₆|, ε₇ min(1,
/// ε₇/ε₆), ε₇/16), where α_k are the coefficients after Legendre of the accelerations at all these
/// points and at the start, and ε_k is the larger of |α_2k| and |α_2k+1|. It falls with the power
/// 17 of the step where the accelerations are smooth, and does not where they are not: at corners,
/// jumps, stops and narrow kicks. Steps end where a motion is known to break.
///
/// An iteration has converged when its last change is below the tolerance, and the next one, if
/// changes shrink as they did, below a fifth of it. The length of the steps stays the same as long
/// as the error is within bounds; `rtol` may be as small as you like, and below about 1e-15 the
/// error is that of rounding. The way to the next stop, break or end is divided into equal steps.
/// Fixed steps are iterated down to rounding; while h·ω stays below about 1.5 that converges, and
/// an iteration that does not is an [error](crate::error::Error::NoConvergence). A stiff spring or
/// damper shortens the steps: take [`Rodas4`](super::Rodas4) or [`Gauss`](super::Gauss) there.
///
/// The sum of the state is compensated; the coefficients have the digits of `f64`, so that over
/// scalars of two words it is no better than over one. Dense output is the collocation polynomial
/// at sixteen nodes, as exact as the ends; it costs about as much as the step.
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
/// Systems written by hand stand in no lanes:
///
/// ```compile_fail,E0277
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).method(Picard).run()?.end.q[0])
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Picard;

/// What a step leaves behind.
#[derive(Clone, Debug)]
pub struct Room<T: Lane, P, const N: usize> {
    /// What the parameters alone decide, over lanes.
    prepared: P,
    /// The accelerations at the nodes, of the last step and of the one under way.
    a: [Stages<T, N, 1>; 2],
    /// Which of the two is the last step.
    last: usize,
    /// Time, coordinates and velocities at its end, and its length; nothing before the first step.
    end: Option<(Time, [T; N], [T; N])>,
    h: f64,
    ends: Ends<T, N>,
    /// The mean square of the accelerations of the last step accepted, and the accelerations at its
    /// end.
    square: [f64; N],
    start: [T; N],
    /// Whether the latter are known: fixed steps do not look there.
    seen: bool,
    /// Sums for steps of the last length: of a sweep, of the first one after an equal step, of the
    /// points between the nodes, and of a sweep at sixteen nodes.
    scaled: [Scaled<T, 1>; 3],
    within: [Scaled<T, 2>; 2],
    /// The number of sweeps that is likely to suffice.
    sweeps: u32,
    /// How exactly the equations were solved.
    weights: [T; N],
    /// Where the equations of the step were not solved: its end and the coordinate that is
    /// accelerated most.
    unsolved: Option<(Time, usize)>,
}

/// The room for the dynamics `D`.
type RoomOf<D, const N: usize> =
    Room<<D as Dynamics<N>>::Scalar, <<D as SideBySide<N>>::Wide as System<N>>::Prepared, N>;

/// The errors allowed in a step: relative, and absolute of coordinates and velocities.
type Tolerances<const N: usize> = (f64, ([f64; N], [f64; N]));

/// The most sweeps of an adaptive step and of a fixed one.
const ADAPTIVE: u32 = 12;
const FIXED: u32 = 60;

/// The rounding of the scalar; the coefficients have the digits of `f64`.
#[inline(always)]
fn epsilon<T: Float>() -> f64 {
    let epsilon = T::EPSILON.to_f64();
    if epsilon < f64::EPSILON { f64::EPSILON } else { epsilon }
}

impl<T: Lane + Float, P, const N: usize> Room<T, P, N> {
    /// The part of the error allowed that a unit of each acceleration makes in a step of length
    /// `h`: by way of the velocity or of the coordinate.
    ///
    /// Nothing is asked for below the rounding of a step, and of a tolerance that is larger than
    /// what the accelerations do in it a twentieth of that, or a thousandth of the tolerance: so
    /// that the motion stays one.
    #[inline(always)]
    fn weigh(&mut self, h: f64, from: &Node<T, N>, (rtol, atol): &Tolerances<N>) {
        let rounding = 0.125 * epsilon::<T>();
        let square = self
            .square
            .iter()
            .fold(0.0, |largest, square| if largest < *square { *square } else { largest });
        let gain = h * square.sqrt();
        let allowed = |tolerance: f64, change: f64, value: f64| {
            let least =
                if 0.05 * change < 0.001 * tolerance { 0.001 * tolerance } else { 0.05 * change };
            (if least < tolerance { least } else { tolerance })
                + rounding * (value + epsilon::<T>())
        };
        for i in 0..N {
            let (q, v) = (f64::abs(from.q.high[i].to_f64()), f64::abs(from.v.high[i].to_f64()));
            let by_velocity = h / allowed(atol.1[i] + rtol * v, gain, v + gain);
            let by_coordinate = h * h / allowed(atol.0[i] + rtol * q, h * gain, q + h * (v + gain));
            let weight = if by_velocity < by_coordinate { by_coordinate } else { by_velocity };
            self.weights[i] = T::from_f64(weight);
        }
    }

    /// Whether the equations are solved: the iteration has come to its end, or to rounding.
    #[inline(always)]
    fn is_solved(&self) -> bool {
        let Ends { square, progress, .. } = &self.ends;
        // Squares of very large accelerations are no scale.
        if !(progress.complete && square.iter().all(|square| square.is_finite())) {
            return false;
        }
        if progress.done {
            return true;
        }
        let mut rounding = 0.01;
        for i in 0..N {
            let weight = self.weights[i].to_f64() * 8.0 * epsilon::<T>();
            rounding += S as f64 * weight * weight * square[i];
        }
        // Not so if it has led far away.
        rounding.is_finite() && progress.change.to_f64() <= rounding
    }

    /// The error of the step over the one allowed: in each coordinate w max(|α₁₆|, ε₇ min(1,
    /// ε₇/ε₆), ε₇/16), where ε_k is the larger of |α_2k| and
    /// |α_2k+1|.
    ///
    /// Gauss's nodes leave out what is beyond α₁₅. Where the coefficients fall, both of the first
    /// terms are as large as that; at a corner, a jump or a narrow kick ε₇ is as large as ε₆, and a
    /// jump between the start and the first node stands in α₁₆ alone. Rounding is no coefficient:
    /// 32 ε of the accelerations, or 512 ε where all are alike.
    #[inline(always)]
    fn error(&self) -> f64 {
        let (mut error, epsilon) = (0.0, epsilon::<T>());
        let larger = |a: f64, b: f64| if a < b { b } else { a };
        for i in 0..N {
            let [a15, a14, a13, a12, a16] = self.ends.tail[i].map(|x| f64::abs(x.to_f64()));
            let (last, before) = (larger(a15, a14), larger(a13, a12));
            let square = self.ends.square[i];
            let noise = if before < 4.0 * last { 512.0 } else { 32.0 } * epsilon * square.sqrt();
            let tail = larger(last, a16);
            // NaN is an error, too.
            if noise < tail || tail.is_nan() {
                let by_decay = last * (last / larger(before, last));
                let part = self.weights[i].to_f64() * larger(a16, larger(by_decay, last / 16.0));
                if error < part || part.is_nan() {
                    error = part;
                }
            }
            if square <= 0.0
                && error < AIM
                && self.a[self.last ^ 1][0][i].0.iter().any(|&a| a != T::from_f64(0.0))
            {
                // Too small for squares, which is not zero: steps become no longer.
                error = AIM;
            }
        }
        error
    }

    /// The coordinate with the largest accelerations, over those allowed.
    fn worst(&self) -> usize {
        let part =
            |i: usize| self.weights[i].to_f64() * self.weights[i].to_f64() * self.ends.square[i];
        (1..N).fold(0, |worst, i| if part(worst) < part(i) { i } else { worst })
    }

    /// The step under way becomes the last one.
    #[inline]
    fn accept(&mut self, to: &Node<T, N>, h: f64) {
        let Progress { sweeps, spare, .. } = self.ends.progress;
        self.sweeps = (sweeps - u32::from(spare)).clamp(2, 8);
        self.last ^= 1;
        (self.end, self.h) = (Some((to.t, to.q.high, to.v.high)), h);
        (self.square, self.start) = (self.ends.square, self.ends.last);
    }
}

/// A step over `span` that leads `to` its end; the room holds what it leaves behind until it is
/// accepted.
#[inline]
fn attempt<D: SideBySide<N>, const N: usize>(
    field: &mut Counted<'_, D>,
    span: &Span,
    from: &mut Node<D::Scalar, N>,
    to: &mut Node<D::Scalar, N>,
    room: &mut RoomOf<D, N>,
    tolerances: Option<&Tolerances<N>>,
) {
    let goes_on = room
        .end
        .as_ref()
        .is_some_and(|(t, q, v)| *t == from.t && *q == from.q.high && *v == from.v.high);
    let ratio = if goes_on && span.h <= 2.0 * room.h { span.h / room.h } else { 0.0 };
    // Equal but for rounding: it leads only to the first sweep.
    let ratio = if f64::abs(ratio - 1.0) <= 1e-12 { 1.0 } else { ratio };
    if ratio == 0.0 {
        let a = from.start_acceleration(field);
        (room.a[room.last], room.sweeps) = ([a.map(Octet::splat)], 2);
        room.square = a.map(|a| a.to_f64() * a.to_f64());
    }
    // Behind a kink the accelerations are not those before it. Kinks and stops have times of one
    // word.
    let may_break = !<D::System as System<N>>::FACTS.autonomous && from.t.low() == 0.0;
    if tolerances.is_some() && (ratio == 0.0 || !room.seen || may_break) {
        (room.start, room.seen) = (from.start_acceleration(field), true);
    }
    let (most, adaptive) = if tolerances.is_some() { (ADAPTIVE, true) } else { (FIXED, false) };
    let tolerances = tolerances.unwrap_or(&(0.0, ([0.0; N], [0.0; N])));
    simd::widest(Onwards {
        dynamics: field.dynamics,
        span,
        from,
        to,
        room,
        ratio,
        tolerances,
        most,
        adaptive,
    });
    field.evaluations += u64::from(room.ends.progress.vectors) * S as u64;
}

impl<D: SideBySide<N>, const N: usize> Stepper<D, N> for Picard {
    const NAME: &'static str = "Picard";
    type Stages = RoomOf<D, N>;

    fn room(&self, dynamics: &D) -> RoomOf<D, N> {
        let zero = D::Scalar::from_f64(0.0);
        Room {
            prepared: dynamics.widened().prepare(),
            a: [[[Octet::splat(zero); N]]; 2],
            last: 0,
            end: None,
            h: 0.0,
            ends: Ends::new(),
            square: [0.0; N],
            start: [zero; N],
            seen: false,
            scaled: [Scaled::new(), Scaled::new(), Scaled::new()],
            within: [Scaled::new(), Scaled::new()],
            sweeps: 2,
            weights: [zero; N],
            unsolved: None,
        }
    }

    #[inline]
    fn advance(
        &self,
        field: &mut Counted<'_, D>,
        span: &Span,
        from: &mut Node<D::Scalar, N>,
        room: &mut RoomOf<D, N>,
    ) -> Node<D::Scalar, N> {
        let mut to = *from;
        attempt(field, span, from, &mut to, room, None);
        room.unsolved = None;
        if room.ends.solved {
            room.accept(&to, span.h);
            room.seen = false;
        } else {
            if room.ends.progress.change.is_finite() {
                room.unsolved = Some((span.end, room.worst()));
            }
            to.v.high = [D::Scalar::from_f64(f64::NAN); N];
        }
        to
    }

    fn within(
        &self,
        field: &mut Counted<'_, D>,
        span: &Span,
        from: &mut Node<D::Scalar, N>,
        to: &mut Node<D::Scalar, N>,
        room: &mut RoomOf<D, N>,
    ) -> Piece<D::Scalar, N> {
        dense::piece(field, span, from, to, room)
    }

    fn fault(
        &self,
        dynamics: &D,
        span: &Span,
        from: &Node<D::Scalar, N>,
        room: &RoomOf<D, N>,
    ) -> Option<Error> {
        let facts = &<D::System as System<N>>::FACTS;
        if let Some((t, index)) = room.unsolved {
            return Some(Error::NoConvergence {
                t: t.to_f64(),
                step: span.h,
                coordinate: coordinate(facts, index),
            });
        }
        let mut watched = Watched::new(dynamics);
        let to = one_by_one(&mut watched, span, from);
        let at_end = || first_in_state(facts, &to.q.high, &to.v.high).map(|what| (span.end, what));
        let (t, what) = watched.first.or_else(at_end)?;
        Some(blame::not_finite(dynamics.system(), t, what))
    }

    fn kink(&self, dynamics: &D, t: f64, _: bool) -> Option<f64> {
        dynamics.next_kink(t)
    }
}

/// The same step without lanes and with as many sweeps as an adaptive step may take: to see what a
/// number that is not finite comes from.
fn one_by_one<T: Float, const N: usize>(
    field: &mut impl Accelerations<T, N>,
    span: &Span,
    from: &Node<T, N>,
) -> Node<T, N> {
    let (h, start) =
        (span.length::<T>(), field.at(span.start, Side::After, &from.q.high, &from.v.high));
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
            let (t, side) = span.at(EIGHT.nodes[0][k]);
            *a = field.at(t, side, &q, &v);
        }
    }
    let mut to = Node { t: span.end, a: None, ..*from };
    for i in 0..N {
        to.q.high[i] += h * from.v.high[i] + h * h * sum(&|j| EIGHT.ends[0][j][0][1], &a, i);
        to.v.high[i] += h * sum(&|j| EIGHT.ends[0][j][0][0], &a, i);
    }
    to
}

/// The error that a step aims at, and those beyond which the next one becomes longer or shorter.
const AIM: f64 = 1.0 / 16.0;
/// `AIM` / 1.25¹⁵.
const LOW: f64 = AIM * 0.0352;
/// `AIM` / 0.86¹⁵.
const HIGH: f64 = AIM * 9.6;
/// More sweeps than these, and the steps become no longer, or shorter.
const MANY: u32 = 4;
const TOO_MANY: u32 = 9;

impl<D: SideBySide<N>, const N: usize> Control<Picard, D, N> for AdaptiveStep<N> {
    fn check(&self) -> Result<(), Error> {
        self.positive::<D::Scalar>()
    }

    fn least_steps(&self, length: f64) -> f64 {
        self.least_steps_over(length)
    }

    #[inline]
    fn step(
        &self,
        memory: &mut Memory,
        course: Course<'_, '_, D, Picard, N>,
    ) -> Result<Span, Error> {
        let Course { method, field, from, to, stages: room, target, stats } = course;
        let target = field
            .dynamics
            .next_break(from.t.to_f64())
            .filter(|time| *time < target)
            .unwrap_or(target);
        let tolerances = self.tolerances::<D::Scalar>();
        if memory.h == 0.0 {
            if !from.start_acceleration(field).iter().all(|a| a.is_finite()) {
                return Err(blame(method, field.dynamics, &Span::by(from.t, 0.0), from, room));
            }
            let left = -from.t.since(target);
            memory.h = self.limited(true, self.automatic_step(2 * S as u32, field, from, left));
        }
        let mut wanted = memory.within_sight(
            self.limited(false, memory.h),
            field.dynamics,
            from.t,
            tableau::GAP,
        )?;
        let (mut retried, mut last_fault) = (false, None);
        loop {
            if wanted <= resolution_of::<D::Scalar>(from.t) && wanted < -from.t.since(target) {
                let coordinate = coordinate(&<D::System as System<N>>::FACTS, room.worst());
                let short =
                    Error::StepSizeUnderflow { t: from.t.to_f64(), step: wanted, coordinate };
                let unresolved = self.unresolved(stats.accepted + stats.rejected == 0, wanted);
                return Err(unresolved
                    .or(last_fault.map(|fault| at(fault, from.t)))
                    .unwrap_or(short));
            }
            let span = planned(memory, from.t, wanted, target);
            attempt(field, &span, from, to, room, Some(&tolerances));
            let error = room.ends.error;
            if error <= 1.0 {
                room.accept(to, span.h);
                let sweeps = room.ends.progress.sweeps;
                let mut next = wanted;
                // A step that was cut short says little about longer ones.
                if error < LOW && sweeps <= MANY && !retried && 0.5 * wanted <= span.h {
                    let factor = scaled(error);
                    let longer = span.h * if factor < 2.0 { factor } else { 2.0 };
                    next = if 1.25 * wanted <= longer { longer } else { wanted };
                } else if HIGH < error {
                    next = span.h * scaled(error);
                } else if TOO_MANY < sweeps {
                    next = 0.95 * span.h;
                }
                memory.left = if next == memory.h { memory.left - 1 } else { 0 };
                memory.h = next;
                stats.accepted += 1;
                return Ok(span);
            }
            stats.rejected += 1;
            (retried, room.sweeps, memory.left) = (true, 2, 0);
            wanted = span.h
                * if error.is_finite() {
                    last_fault = None;
                    let factor = scaled(error);
                    if factor < 0.2 { 0.2 } else { factor }
                } else if to.is_finite() {
                    last_fault = None;
                    0.5
                } else {
                    // A function may have left its domain, and a shorter step may stay inside; but
                    // no step is short enough for an input that is not finite.
                    last_fault = method.fault(field.dynamics, &span, from, room);
                    if let Some(input @ Error::NotFinite { what: Quantity::Input { .. }, .. }) =
                        last_fault
                    {
                        return Err(input);
                    }
                    0.1
                };
        }
    }
}

/// The next of equal steps to `target`, which are about as long as `wanted`: a step goes on best as
/// long as the one before.
#[inline]
fn planned(plan: &mut Memory, t: Time, wanted: f64, target: f64) -> Span {
    let left = -t.since(target);
    let goes_on =
        |plan: &Memory| f64::abs(left - plan.left as f64 * plan.equal) <= 1e-9 * plan.equal;
    if plan.left == 0 || plan.target != target || !goes_on(plan) {
        let count = f64::ceil(left / wanted - 0.01);
        let (count, equal) = if count < 1e9 {
            (f64::max(count, 1.0), left / f64::max(count, 1.0))
        } else {
            (1e9, wanted)
        };
        (plan.left, plan.equal, plan.target) = (count as u64, equal, target);
    }
    if plan.left == 1 { Span::to(t, target) } else { Span::by(t, plan.equal) }
}

/// The factor by which a step would be longer whose error is the one aimed at.
fn scaled(error: f64) -> f64 {
    // Where accelerations do not have all derivatives the power is another, but then no power is
    // right.
    power(1023.0 + (log2(AIM) - log2(error)) / (2 * S - 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::{
        AdaptiveStep, Control, Counted, Course, Memory, Node, Picard, Room, Stepper, planned,
    };
    use crate::integrate::solution::Stats;
    use crate::integrate::tests::systems::Kepler;
    use crate::real::Real;
    use crate::system::{Staged, System};
    use crate::time::Time;

    /// Without stages.
    impl<T: Real> Staged<2> for Kepler<T> {
        type AtTime = ();
        type AtPosition = ();

        fn at_time(_: T, (): &()) {}

        fn at_position(&self, (): &(), (): &(), _: T, _: &[T; 2], (): &()) {}

        fn accelerations_staged(
            &self,
            (): &(),
            (): &(),
            (): &(),
            t: T,
            q: &[T; 2],
            v: &[T; 2],
            (): &(),
        ) -> [T; 2] {
            self.accelerations(t, q, v, &())
        }
    }

    const PLANET: Kepler<f64> = Kepler { mu: 1.0 };

    /// A planet on its way, with all that a step knows of the one before.
    #[derive(Clone)]
    struct Flight {
        node: Node<f64, 2>,
        memory: Memory,
        room: Room<f64, (), 2>,
        rejected: u64,
    }

    impl Flight {
        fn new() -> Self {
            let node = Node::new(Time::new(0.0), [0.5, 0.0], [0.0, 3.0_f64.sqrt()]);
            Self { node, memory: Memory::default(), room: Picard.room(&PLANET), rejected: 0 }
        }

        /// Takes a step, the first attempt of the length `h`; the length of the one accepted.
        fn step(&mut self, h: f64) -> f64 {
            let (mut field, mut stats, mut to) =
                (Counted::new(&PLANET), Stats::new("Picard"), self.node);
            (self.memory.h, self.memory.left) = (h, 0);
            let course = Course {
                method: &Picard,
                field: &mut field,
                from: &mut self.node,
                to: &mut to,
                stages: &mut self.room,
                target: f64::INFINITY,
                stats: &mut stats,
            };
            let span = AdaptiveStep::new().rtol(1e-6).step(&mut self.memory, course).unwrap();
            (self.node, self.rejected) = (to, stats.rejected);
            span.h
        }

        /// The state and what the next step will see, with every bit.
        fn bits(&self) -> String {
            let Room { a, last, end, h, square, start, weights, ends, .. } = &self.room;
            format!(
                "{:?} {:?} {end:?} {h} {square:?} {start:?} {weights:?} {}",
                self.node, a[*last], ends.error
            )
        }
    }

    /// A step after an attempt that was rejected is the one that would have come without it.
    #[test]
    fn nothing_of_a_rejected_attempt_stays() {
        let (mut flight, mut rejected) = (Flight::new(), Vec::new());
        for k in 0..60 {
            let (mut tried, mut fresh) = (flight.clone(), flight.clone());
            let h = tried.step(if k == 0 { 3.0 } else { 2.0 * flight.room.h });
            if 0 < tried.rejected {
                // Sweeps are counted anew after a rejection.
                fresh.room.sweeps = 2;
                assert_eq!((fresh.step(h), fresh.rejected), (h, 0), "step {k}");
                assert_eq!(tried.bits(), fresh.bits(), "step {k}");
                rejected.push(k);
            }
            flight.step(if k == 0 { 0.01 } else { flight.memory.h });
        }
        // The first one, which knows nothing of a step before, and others that go on from one.
        assert!(rejected[0] == 0 && 20 <= rejected.len(), "{rejected:?}");
    }

    /// The lengths of the steps to `target`.
    fn lengths(wanted: f64, start: f64, target: f64) -> Vec<f64> {
        let (mut plan, mut t, mut lengths) = (Memory::default(), Time::new(start), Vec::new());
        while t.since(target) < 0.0 {
            let span = planned(&mut plan, t, wanted, target);
            plan.left -= 1;
            t = span.end;
            lengths.push(span.h);
        }
        assert_eq!(t, Time::new(target));
        lengths
    }

    #[test]
    fn steps_to_a_target_are_equal() {
        assert_eq!(lengths(1.0, 0.0, 3.0), [1.0; 3]);
        assert_eq!(lengths(1.0, 0.0, 2.25), [0.75; 3]);
        assert_eq!(lengths(1.0, 0.0, 1.009), [1.009]);
        assert_eq!(lengths(1.0, 0.0, 0.3), [0.3]);
        let many = lengths(0.013, 0.1, 10.1);
        assert_eq!(many.len(), 770);
        assert!(
            many.iter().all(|h| (h * 77.0 - 1.0).abs() < 1e-12)
                && many[..769].iter().all(|h| *h == many[0])
        );
    }

    #[test]
    fn without_a_target_they_are_as_wanted() {
        let mut plan = Memory::default();
        for k in 0..5 {
            let span = planned(&mut plan, Time::new(f64::from(k)), 0.7, f64::INFINITY);
            plan.left -= 1;
            assert_eq!(span.h, 0.7);
        }
    }

    #[test]
    fn a_plan_ends_where_the_state_or_the_target_is_another() {
        let mut plan = Memory::default();
        assert_eq!(planned(&mut plan, Time::new(0.0), 1.0, 2.5).h, 2.5 / 3.0);
        plan.left -= 1;
        assert_eq!(planned(&mut plan, Time::new(0.5), 1.0, 2.5).h, 1.0);
        assert_eq!(planned(&mut plan, Time::new(0.5), 1.0, 4.0).h, 3.5 / 4.0);
    }
}
