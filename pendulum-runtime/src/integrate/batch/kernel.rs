//! The steps of the lanes.
//!
//! The work of every step is inlined into the code that [`simd`](crate::simd) compiles for several
//! instruction sets; the work at the beginning and the end of motions is not.

#![allow(clippy::inline_always)]
// A branch in a loop over lanes would take the lanes apart.
#![allow(clippy::needless_bitwise_bool)]

use super::lengths::{UNTOLD, any, fit, is_short, lengths, log_radii, longer, reaches, weights};
use super::member::InLane;
use super::{Batch, Batched, Outcome, Posed, W};
use crate::error::Error;
use crate::integrate::Problem;
use crate::integrate::events::detector::{EventDetector, POINTS, Place};
use crate::integrate::events::{Event, Status};
use crate::integrate::method::Method;
use crate::integrate::methods::taylor::{Ends, GAP, MISFIT, Rule, Taylor, rest};
use crate::integrate::output::{Output, Recorder, direction, precedes};
use crate::integrate::solution::Stats;
use crate::integrate::state::State;
use crate::integrate::step::compensated::{Compensated, splitter};
use crate::integrate::step::controller::ControllerState;
use crate::integrate::step::endpoint::Endpoint;
use crate::integrate::step::held::Held;
use crate::integrate::step::inertia::{inertia, varies};
use crate::integrate::step::integration::{Integration, cross};
use crate::integrate::step::interval::StepInterval;
use crate::integrate::step::short::shortest;
use crate::jet::{InputSeries, Jets, Known, LENGTH, Path, Unrolling};
use crate::motion::Side;
use crate::scalar::{Float, Lane, Lanes, Real};
use crate::simd::Work;
use crate::system::{Dynamics, Facts, System, scalar_time};
use crate::time::Time;

/// A number of each lane.
pub(super) type Wide<T> = Lanes<T, W>;

/// A source of problems and their indices.
pub(crate) type Problems<'a, D, const N: usize> =
    dyn FnMut() -> Option<(usize, Posed<'a, D, N>)> + 'a;

/// A receiver of outcomes and their indices.
pub(crate) type Outcomes<'a, T, const N: usize> = dyn FnMut(usize, Outcome<T, N>) + 'a;

/// The end of a motion: its last state, and how it has come to it.
type End<T, const N: usize> = (State<T, N>, Result<Status, Error>);

/// The records kept of each motion of a batch beside its end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Watch<'a, T, const N: usize> {
    pub(crate) output: Output<'a>,
    pub(crate) dense: bool,
    /// Events with functions that do not act.
    pub(crate) events: &'a [Event<'a, T, N>],
}

/// A motion in a lane.
struct Member<'a, D: Batched<N>, const N: usize> {
    index: usize,
    problem: Posed<'a, D, N>,
    recorder: Recorder<'a, 'a, D::Scalar, N>,
    detector: EventDetector<'a, D::Scalar, N>,
    /// The accelerations at the start, where somebody has asked for them.
    a: Option<[D::Scalar; N]>,
    /// The counters without the steps since `Run::begun`.
    stats: Stats,
}

/// A batch under way.
pub(super) struct Run<'a, D: Batched<N>, const N: usize, const WATCHED: bool> {
    batch: &'a Batch<N>,
    /// The records kept of each motion beside its end.
    watch: Watch<'a, D::Scalar, N>,
    /// Gives the next problem and its index, until there are no more.
    problems: &'a mut Problems<'a, D, N>,
    /// Takes the outcomes as motions end.
    outcomes: &'a mut Outcomes<'a, D::Scalar, N>,
    /// The last problem was given.
    exhausted: bool,
    rule: Rule,
    /// The absolute tolerances of coordinates and velocities, and the relative one.
    atol: [[f64; N]; 2],
    rtol: f64,
    /// The parameters of all lanes.
    parameters: Vec<Wide<D::Scalar>>,
    system: D::Wide,
    workspace: Box<Workspace<D, N>>,
    lanes: Flight<D::Scalar, N>,
    /// The steps that have led to these states.
    attempt: Attempt<D::Scalar, N>,
    /// True if it is not yet known whether they are good.
    attempted: bool,
    /// The motion in each lane; none where it is idle.
    members: [Option<Member<'a, D, N>>; W],
    /// The next output time of each lane, and the direction of its time.
    output: Wide<f64>,
    onwards: Wide<f64>,
    /// The round before the first step that the counters of the motion in each lane lack.
    begun: [u64; W],
    /// The rounds so far: each takes one step in every lane.
    round: u64,
    /// The round after which a motion has taken all steps allowed.
    deadline: u64,
    /// True if some lane takes its first step, of limited length.
    first: bool,
}

/// The room for the jets.
struct Workspace<D: Batched<N>, const N: usize> {
    path: Path<Wide<D::Scalar>, N>,
    /// States and accelerations from which the next steps go.
    ahead: Path<Wide<D::Scalar>, N>,
    drive: <D::Wide as Jets<N>>::Drive,
    /// The series of the driven inputs of one motion.
    own: <D::System as Jets<N>>::Drive,
    /// The lanes whose series of driven inputs are those at their time.
    driven: [bool; W],
    work: <D::Wide as Jets<N>>::Work,
}

/// The states of all lanes.
#[derive(Clone, Copy)]
pub(super) struct Flight<T, const N: usize> {
    pub(super) q: Compensated<Wide<T>, N>,
    pub(super) v: Compensated<Wide<T>, N>,
    /// The words of the time.
    pub(super) high: Wide<f64>,
    pub(super) low: Wide<f64>,
    /// The time at which the series stop holding: that of a break, or the end of the motion.
    pub(super) end: Wide<f64>,
    /// 1 where a motion is under way, else 0.
    pub(super) live: Wide<f64>,
}

/// A step in every lane.
#[derive(Clone, Copy)]
struct Attempt<T, const N: usize> {
    from: Flight<T, N>,
    /// The lengths wanted, and those taken, in two words.
    wanted: Wide<f64>,
    h: [Wide<f64>; 2],
    /// One over the errors allowed.
    weights: [[Wide<f64>; N]; 2],
    /// The accelerations of the series at the ends.
    ends: [Wide<T>; N],
    /// Not zero where the state at the end is not finite, or the step one that is left to `Taylor`.
    doubted: Wide<f64>,
    /// 1 where the step ends on a kink.
    kinked: Wide<f64>,
    /// True if some step is the first, the last or one of those that are too short or too long.
    unusual: bool,
}

impl<T, const N: usize> Attempt<T, N> {
    /// The time at which the step of a lane starts.
    #[inline(always)]
    fn start(&self, l: usize) -> Time {
        Time::from_words(self.from.high.0[l], self.from.low.0[l])
    }
}

/// All steps of a batch.
pub(super) struct Steps<'r, 'a, D: Batched<N>, const N: usize, const WATCHED: bool>(
    pub(super) &'r mut Run<'a, D, N, WATCHED>,
);

impl<D: Batched<N>, const N: usize, const WATCHED: bool> Work for Steps<'_, '_, D, N, WATCHED> {
    #[inline(always)]
    fn run(self) {
        while self.0.attempted | (self.0.round < self.0.deadline) {
            self.0.step();
        }
    }
}

impl<'a, D: Batched<N>, const N: usize, const WATCHED: bool> Run<'a, D, N, WATCHED> {
    const FACTS: &'static Facts = &<D::System as System<N>>::FACTS;

    /// The first motions in their lanes; `None` without problems.
    pub(super) fn new(
        batch: &'a Batch<N>,
        watch: Watch<'a, D::Scalar, N>,
        problems: &'a mut Problems<'a, D, N>,
        outcomes: &'a mut Outcomes<'a, D::Scalar, N>,
    ) -> Option<Self> {
        let zero = Wide::from_f64(0.0);
        let first = problems()?;
        let mut parameters = Vec::new();
        let system = first.1.system.widen(|parameter| {
            parameters.push(Wide::splat(parameter));
            Wide::splat(parameter)
        });
        let (rtol, atol) = batch.control.tolerances::<D::Scalar>();
        let still = Compensated::new([zero; N]);
        let number = Wide::from_f64(0.0);
        let lanes =
            Flight { q: still, v: still, high: number, low: number, end: number, live: number };
        let mut run = Self {
            batch,
            watch,
            problems,
            outcomes,
            exhausted: false,
            rule: batch.rule::<D>(),
            atol: [atol.0, atol.1],
            rtol,
            parameters,
            workspace: Box::new(Workspace {
                path: Path::new(),
                ahead: Path::new(),
                drive: D::Wide::drive(),
                own: D::System::drive(),
                driven: [false; W],
                work: system.work(),
            }),
            system,
            lanes,
            attempt: Attempt {
                from: lanes,
                wanted: number,
                h: [number; 2],
                weights: [[number; N]; 2],
                ends: [zero; N],
                doubted: number,
                kinked: number,
                unusual: false,
            },
            attempted: false,
            members: [const { None }; W],
            output: number,
            onwards: number,
            begun: [0; W],
            round: 0,
            deadline: 0,
            first: true,
        };
        run.begin(0, first);
        run.fill();
        Some(run)
    }

    /// Looks at the ends of the steps under way; if they hold everywhere, one more step in every
    /// lane.
    ///
    /// The accelerations at the ends are the first coefficients of the series that go on there.
    #[inline(always)]
    fn step(&mut self) {
        self.look_ahead();
        if self.attempted {
            let doubted = self.doubted();
            let seen = if WATCHED { self.watch(doubted) } else { Wide::from_f64(0.0) };
            if (self.attempt.unusual | any(doubted) | any(seen)) && self.settle(doubted, seen) {
                self.attempted = false;
                return;
            }
        }
        self.attempted = true;
        self.attempt.from = self.lanes;
        let Workspace { path, ahead, drive, work, .. } = &mut *self.workspace;
        path.t = ahead.t;
        for i in 0..N {
            path.q[i][0] = ahead.q[i][0];
            path.v[i][0] = ahead.v[i][0];
            path.a[i][0] = ahead.a[i][0];
        }
        <D::Wide as Jets<N>>::Unrolling::run_in_lanes(
            &self.system,
            self.rule.order,
            path,
            drive,
            work,
        );
        let from = &self.attempt.from;
        let weights = weights(from, self.rtol, &self.atol);
        let log_radii = log_radii(path, &self.rule, &weights);
        let mut wanted = lengths(log_radii);
        let mut unusual = wanted;
        for l in 0..W {
            unusual.0[l] = if UNTOLD < wanted.0[l] { 1.0 } else { 0.0 };
            wanted.0[l] = self.limited(l, false, wanted.0[l]);
        }
        let h = fit(from, wanted, &mut unusual);
        (self.attempt.wanted, self.attempt.weights) = (wanted, weights);
        if any(unusual) | self.first | (self.round + 1 == self.deadline) {
            self.unusual_steps(log_radii);
        } else {
            (self.attempt.unusual, self.attempt.kinked) = (false, Wide::from_f64(0.0));
            self.advance([h, Wide::from_f64(0.0)]);
        }
    }

    /// The accelerations at the states of all lanes, with which their series begin.
    #[inline(always)]
    fn look_ahead(&mut self) {
        if const { !Self::FACTS.inputs.is_empty() } {
            self.drive();
        }
        let Workspace { ahead, drive, work, .. } = &mut *self.workspace;
        let Flight { q, v, high, low, .. } = &self.lanes;
        for l in 0..W {
            ahead.t.0[l] = D::Scalar::from_f64(high.0[l]) + D::Scalar::from_f64(low.0[l]);
        }
        for i in 0..N {
            ahead.q[i][0] = q.high[i];
            ahead.v[i][0] = v.high[i];
        }
        <D::Wide as Jets<N>>::Unrolling::begin_in_lanes(&self.system, ahead, drive, work);
    }

    /// The series of the driven inputs in all lanes, each at its own time.
    #[inline(never)]
    fn drive(&mut self) {
        let Workspace { drive, own, driven, .. } = &mut *self.workspace;
        let order = self.rule.order;
        for l in 0..W {
            let Some(member) = self.members[l].as_ref().filter(|_| !driven[l]) else { continue };
            driven[l] = true;
            let t = Time::from_words(self.lanes.high.0[l], self.lanes.low.0[l]);
            let side = if self.onwards.0[l] < 0.0 { Side::Before } else { Side::After };
            member.problem.system.drive(t, side, order, own);
            let lanes: &mut [InputSeries<Wide<D::Scalar>>] = drive.as_mut();
            for (lanes, own) in lanes.iter_mut().zip(own.as_mut()) {
                for k in 0..=(order + 1).min(LENGTH - 1) {
                    lanes.position[k].0[l] = own.position[k];
                    lanes.velocity[k].0[l] = own.velocity[k];
                    lanes.acceleration[k].0[l] = own.acceleration[k];
                }
            }
        }
    }

    /// Finds the lanes whose steps are not to be trusted, as [`Taylor`] does: their series do not
    /// give the accelerations at their ends. They are not zero.
    #[inline(always)]
    fn doubted(&self) -> Wide<f64> {
        let Attempt { from, h, weights, ends, doubted, kinked, .. } = &self.attempt;
        let (mut doubted, most) = (*doubted, MISFIT * self.rule.order as f64);
        let mut suspect = *kinked;
        for i in 0..N {
            let difference = self.workspace.ahead.a[i][0] - ends[i];
            for l in 0..W {
                let misfit = h[0].0[l].abs() * difference.0[l].to_f64().abs() * weights[1][i].0[l];
                suspect.0[l] = if misfit <= most { suspect.0[l] } else { from.live.0[l] };
            }
        }
        if any(suspect) {
            for l in 0..W {
                if 0.0 < suspect.0[l] && doubted.0[l] == 0.0 {
                    doubted.0[l] = if self.holds(l) { 0.0 } else { 1.0 };
                }
            }
        }
        doubted
    }

    /// Returns true if a difference of the accelerations at the end of the step of a lane is no
    /// more than rounding explains.
    #[cold]
    #[inline(never)]
    fn holds(&self, l: usize) -> bool {
        let Workspace { path, ahead, .. } = &*self.workspace;
        let (Some(Member { problem, .. }), to) = (&self.members[l], node(&self.lanes, l)) else {
            return true;
        };
        let end = if self.attempt.kinked.0[l] == 0.0 {
            core::array::from_fn(|i| ahead.a[i][0].0[l])
        } else {
            // Those of the next series are accelerations beyond the kink.
            let side = if self.onwards.0[l] < 0.0 { Side::After } else { Side::Before };
            problem.system.accelerations_at(to.t, side, &to.q.high, &to.v.high)
        };
        let ends = Ends {
            interval: &interval_of(&self.attempt.from, &self.lanes, self.attempt.h, l),
            order: self.rule.order,
            q: core::array::from_fn(|i| path.q[i][0].0[l]),
            a: core::array::from_fn(|i| path.a[i][0].0[l]),
            weights: core::array::from_fn(|i| self.attempt.weights[1][i].0[l]),
            to: &to,
            end,
            series: self.attempt.ends.map(|ends| ends.0[l]),
        };
        ends.misfit(Self::FACTS, false).allowed
    }

    /// A length of step of a lane within the limits set, and short enough to see what time and the
    /// motions alone do; none if that is no length.
    #[inline(always)]
    fn limited(&self, l: usize, first: bool, wanted: f64) -> f64 {
        let wanted = self.batch.control.limited(first, wanted);
        if const { !Self::FACTS.explicit_time && Self::FACTS.inputs.is_empty() } {
            return wanted;
        }
        let Some(Member { problem, .. }) = &self.members[l] else { return wanted };
        let (start, end) = problem.time;
        let t = self.attempt.start(l);
        // What is wrong with a motion, `Taylor` says.
        let limited =
            ControllerState::over(end - start).within_sight(wanted, &problem.system, t, GAP);
        limited.unwrap_or(0.0)
    }

    /// Goes to the ends of steps of the lengths `h`, which come in two words.
    #[inline(always)]
    fn advance(&mut self, h: [Wide<f64>; 2]) {
        let length = length_of::<D::Scalar>(&h);
        let (path, splitter) = (&self.workspace.path, Wide::splat(splitter::<D::Scalar>()));
        let mut ends = [Wide::from_f64(0.0); N];
        for i in 0..N {
            let series = &path.a[i];
            ends[i] = series[0] + (series[1] * length + rest(series, self.rule.order - 1, length));
        }
        self.attempt.ends = ends;
        let mut finite = Wide::from_f64(0.0);
        for i in 0..N {
            for (sum, series) in [(&mut self.lanes.q, &path.q[i]), (&mut self.lanes.v, &path.v[i])]
            {
                sum.add_split_product(
                    i,
                    length,
                    series[1],
                    rest(series, self.rule.order, length),
                    splitter,
                );
                // Times zero, infinity and what is not a number are not zero.
                finite += sum.high[i] * Wide::from_f64(0.0);
            }
        }
        self.attempt.h = h;
        for l in 0..W {
            let t = self.attempt.start(l) + h[0].0[l];
            (self.lanes.high.0[l], self.lanes.low.0[l]) = (t.to_f64(), t.low());
            let fine = finite.0[l].to_f64() == 0.0;
            self.attempt.doubted.0[l] = if fine { 0.0 } else { self.attempt.from.live.0[l] };
        }
        self.workspace.driven = [false; W];
        self.round += 1;
    }

    /// Takes steps of which some are the first or the last ones, too short, or as long as no term
    /// tells.
    #[cold]
    #[inline(never)]
    fn unusual_steps(&mut self, log_radii: Wide<f64>) {
        let Attempt { from, weights, .. } = &self.attempt;
        let mut wanted = longer(&self.workspace.path, &self.rule, weights, log_radii);
        for l in 0..W {
            let first = self.begun[l] == self.round
                && self.members[l].as_ref().is_some_and(|member| member.stats.accepted == 0);
            wanted.0[l] = self.limited(l, first, wanted.0[l]);
        }
        let mut h = [fit(from, wanted, &mut Wide::from_f64(0.0)), Wide::from_f64(0.0)];
        for l in 0..W {
            let (t, end) = (self.attempt.start(l), from.end.0[l]);
            if 0.0 < from.live.0[l] && reaches(t, end, wanted.0[l]) {
                let interval = StepInterval::to(t, end);
                (h[0].0[l], h[1].0[l]) = (interval.h, interval.low);
            }
        }
        self.first = false;
        self.advance(h);
        (self.attempt.wanted, self.attempt.unusual) = (wanted, true);
        self.attempt.kinked = Wide::from_f64(0.0);
        for l in 0..W {
            let (t, end) = (self.attempt.start(l), self.lanes.end.0[l]);
            let Some(member) = &self.members[l] else { continue };
            if reaches(t, end, wanted.0[l]) {
                (self.lanes.high.0[l], self.lanes.low.0[l]) = (end, 0.0);
                let kink = member.next_kink(t);
                if kink == end {
                    self.attempt.kinked.0[l] = 1.0;
                } else if !precedes(end, kink, member.problem.time) {
                    // Not in order, as `Taylor` says.
                    self.attempt.doubted.0[l] = 1.0;
                }
            } else if is_short::<D::Scalar>(t, end, wanted.0[l]) {
                self.attempt.doubted.0[l] = 1.0;
            }
            if t.since(end).abs() < shortest::<D::Scalar>() {
                // The scalar does not hold the length of this step.
                self.attempt.doubted.0[l] = 1.0;
            }
            if varies(Self::FACTS) && self.lanes.high.0[l] == member.problem.time.1 {
                self.attempt.doubted.0[l] += self.lacks_inertia(l, member);
            }
        }
    }

    /// 1 if the mass matrix at the end of the step of a lane is not positive, which `Taylor`
    /// reports; else 0.
    fn lacks_inertia(&self, l: usize, member: &Member<'a, D, N>) -> f64 {
        let to = node(&self.lanes, l);
        let side = if self.onwards.0[l] < 0.0 { Side::Before } else { Side::After };
        let checked = inertia(&member.problem.system, to.t, side, &to.q.high, &to.v.high);
        if checked.is_err() { 1.0 } else { 0.0 }
    }

    /// Finds the lanes in whose steps something is to be kept: an output time, an event. They are
    /// not zero.
    #[inline(always)]
    fn watch(&mut self, doubted: Wide<f64>) -> Wide<f64> {
        let live = self.attempt.from.live;
        let mut seen = Wide::from_f64(0.0);
        let always = self.watch.dense | matches!(self.watch.output, Output::Steps);
        for l in 0..W {
            let ahead = self.onwards.0[l] * (self.output.0[l] - self.lanes.high.0[l]);
            seen.0[l] = if (ahead <= 0.0) | always { live.0[l] } else { 0.0 };
        }
        if self.watch.events.is_empty() {
            return seen;
        }
        let places = self.places();
        for l in 0..W {
            // The detector looks at each step once: what it notes of a quiet one belongs to its
            // end.
            let unseen = (0.0 < live.0[l]) & (seen.0[l] == 0.0);
            if unseen && doubted.0[l] + self.attempt.kinked.0[l] == 0.0 {
                seen.0[l] = if self.is_quiet(l, &places) { 0.0 } else { 1.0 };
            }
        }
        seen
    }

    /// The coordinates and velocities at [`POINTS`] but the two that are known.
    #[inline(always)]
    fn places(&self) -> Places<D::Scalar, N> {
        let zero = Wide::from_f64(0.0);
        let mut places = [[[zero; N]; 2]; POINTS.len()];
        let length = length_of::<D::Scalar>(&self.attempt.h);
        let (path, order) = (&self.workspace.path, self.rule.order);
        for i in 0..N {
            for (part, series) in [&path.q[i], &path.v[i]].into_iter().enumerate() {
                let mut terms = [zero; LENGTH];
                let mut power = length;
                for k in 1..=order {
                    terms[k] = series[k] * power;
                    power *= length;
                }
                // Side by side: each sum waits for its own last product only.
                let mut sums = [zero; POINTS.len()];
                for k in (1..=order).rev() {
                    for point in INNER {
                        sums[point] =
                            (sums[point] + terms[k]) * Wide::<D::Scalar>::from_f64(POINTS[point]);
                    }
                }
                for point in INNER {
                    places[point][part][i] = series[0] + sums[point];
                }
            }
        }
        places
    }

    /// Returns true if no event happens in the step of a lane.
    fn is_quiet(&mut self, l: usize, places: &Places<D::Scalar, N>) -> bool {
        let Attempt { from, h, .. } = &self.attempt;
        let Some(member) = &mut self.members[l] else { return true };
        let interval = interval_of(from, &self.lanes, *h, l);
        let (t, length) =
            (scalar_time::<D::Scalar>(interval.start), interval.length::<D::Scalar>());
        let last = POINTS.len() - 1;
        // Number by number into the same place: the next load of a copy would wait.
        let put = |point: usize, place: &mut Place<D::Scalar, N>| {
            place.t = t + D::Scalar::from_f64(POINTS[point]) * length;
            let ends = [(1, from), (last, &self.lanes)];
            if let Some((_, end)) = ends.into_iter().find(|end| end.0 == point) {
                *place = Place::of(&node(end, l));
                return;
            }
            let [q, v] = &places[point];
            for i in 0..N {
                (place.q[i], place.v[i]) = (q[i].0[l], v[i].0[l]);
            }
        };
        let room = Place { t, q: [t; N], v: [t; N] };
        member.detector.is_quiet(&interval, room, put)
    }

    /// Looks at what is to be kept in the lanes `seen`, takes the steps of the lanes `doubted` once
    /// more, ends the motions that have come to an end and begins others in their lanes. Returns
    /// true if some lane has another state now.
    #[cold]
    #[inline(never)]
    fn settle(&mut self, doubted: Wide<f64>, seen: Wide<f64>) -> bool {
        let (mut moved, mut ended) = (false, false);
        for l in 0..W {
            if self.members[l].is_none() {
                continue;
            }
            let to = node(&self.lanes, l);
            let beyond =
                if 0.0 < self.attempt.kinked.0[l] { self.beyond(l, &to) } else { Some(to) };
            let end = match beyond {
                Some(end) if doubted.0[l] == 0.0 => {
                    if end.v.high != to.v.high {
                        moved = true;
                    }
                    self.arrive(l, &to, end, 0.0 < seen.0[l])
                }
                _ => {
                    moved = true;
                    self.go_alone(l)
                }
            };
            if let Some((end, outcome)) = end {
                ended = true;
                self.finish(l, end, outcome);
            }
        }
        if ended {
            self.fill();
        } else if moved {
            self.set_deadline();
        }
        moved | ended
    }

    /// The state beyond a kink at the end of the step of a lane; `None` if it cannot be crossed.
    fn beyond(&self, l: usize, to: &Endpoint<D::Scalar, N>) -> Option<Endpoint<D::Scalar, N>> {
        let system = &self.members[l].as_ref()?.problem.system;
        let (mut beyond, backwards) = (*to, self.onwards.0[l] < 0.0);
        cross(system, &mut beyond, backwards).ok()?;
        if varies(Self::FACTS) {
            let side = if backwards { Side::Before } else { Side::After };
            inertia(system, beyond.t, side, &beyond.q.high, &beyond.v.high).ok()?;
        }
        Some(beyond)
    }

    /// Looks at the step of a lane to `to`, and over a kink there to `end`: what is to be kept, and
    /// if the motion ends.
    fn arrive(
        &mut self,
        l: usize,
        to: &Endpoint<D::Scalar, N>,
        mut end: Endpoint<D::Scalar, N>,
        seen: bool,
    ) -> Option<End<D::Scalar, N>> {
        let (member, attempt) = (self.members[l].as_mut()?, &self.attempt);
        let (steps, from) = (self.round - self.begun[l], node(&attempt.from, l));
        let first = steps == 1 && member.stats.accepted == 0;
        let kinked = 0.0 < attempt.kinked.0[l];
        let mut before_kink = kinked.then_some(*to);
        if WATCHED && (seen | kinked) {
            let mut view = InLane::<D, N> {
                dynamics: &member.problem.system,
                path: &self.workspace.path,
                order: self.rule.order,
                lane: l,
                from: Endpoint { a: if first { member.a } else { None }, ..from },
                before_kink,
                end,
                interval: interval_of(&attempt.from, &self.lanes, attempt.h, l),
                interpolant: None,
                evaluations: &mut member.stats.evaluations,
            };
            let looked = member.detector.observe(&mut view);
            member.recorder.events(member.detector.found());
            let looked = looked.and_then(|status| {
                member.recorder.step(&mut view)?;
                Ok(status)
            });
            (end, before_kink) = (view.end, view.before_kink);
            self.output.0[l] = member.recorder.next_time();
            member.stats.kinks += u64::from(before_kink.is_some());
            if let Some(outcome) = looked.transpose() {
                return Some((State::from(&end), outcome));
            }
        }
        if !WATCHED && kinked {
            member.stats.kinks += 1;
        }
        if reaches(from.t, self.lanes.end.0[l], attempt.wanted.0[l]) {
            if end.t == Time::new(member.problem.time.1) {
                return Some((State::from(&end), Ok(Status::Completed)));
            }
            self.lanes.end.0[l] = member.next_end(end.t);
            let (v, low) = (end.v.high, end.v.low);
            for i in 0..N {
                (self.lanes.v.high[i].0[l], self.lanes.v.low[i].0[l]) = (v[i], low[i]);
            }
        }
        if self.batch.max_steps <= member.stats.accepted + member.stats.rejected + steps {
            let max_steps = self.batch.max_steps;
            return Some((
                State::from(&end),
                Err(Error::MaxSteps { t: end.t.to_f64(), max_steps }),
            ));
        }
        None
    }

    /// Takes the step of a lane by [`Taylor`] instead, and more of them until it has no doubts: its
    /// series may not have held, or it may fail.
    fn go_alone(&mut self, l: usize) -> Option<End<D::Scalar, N>> {
        // Without the step under way.
        self.count(l, self.round - self.begun[l] - 1);
        let Member { problem, recorder, detector, a, stats, .. } = self.members[l].as_mut()?;
        let Problem { system, time: (start, end), .. } = &**problem;
        let (start, end) = (*start, *end);
        let mut from = node(&self.attempt.from, l);
        from.a = if stats.accepted + stats.rejected == 0 { *a } else { None };
        let known = Known(system);
        let resumed = Integration::resumed(
            Held::borrowed(&known),
            self.batch.method,
            self.batch.control,
            from,
            *stats,
            end < start,
        );
        let mut integration = match resumed {
            Ok(integration) => integration.over((end - start).abs()),
            Err(error) => return Some((State::from(&from), Err(error))),
        };
        let ended = loop {
            let Stats { accepted, rejected, .. } = integration.stats;
            if self.batch.max_steps <= accepted + rejected {
                let max_steps = self.batch.max_steps;
                break Some(Err(Error::MaxSteps { t: integration.t(), max_steps }));
            }
            if let Err(error) = integration.step(end) {
                break Some(Err(error));
            }
            if integration.end.t == Time::new(end)
                && let Err(error) = integration.look()
            {
                break Some(Err(error));
            }
            let looked = detector.observe(&mut integration);
            recorder.events(detector.found());
            let looked = looked.and_then(|status| {
                recorder.step(&mut integration)?;
                Ok(status)
            });
            if let Some(outcome) = looked.transpose() {
                break Some(outcome);
            }
            if integration.end.t == Time::new(end) {
                break Some(Ok(Status::Completed));
            }
            let Stats { accepted, rejected, .. } = integration.stats;
            if integration.workspace().is_sure() && accepted + rejected < self.batch.max_steps {
                break None;
            }
        };
        let to = integration.end;
        *stats = integration.stats;
        self.output.0[l] = recorder.next_time();
        if ended.is_none() {
            self.lanes.end.0[l] =
                self.members[l].as_ref().map_or(end, |member| member.next_end(to.t));
            self.put(l, &to);
        }
        ended.map(|outcome| (State::from(&to), outcome))
    }

    /// Puts so many steps of a lane, and all before, into the counters of its motion.
    fn count(&mut self, l: usize, steps: u64) {
        if let Some(Member { stats, .. }) = &mut self.members[l] {
            stats.accepted += steps;
            stats.evaluations += steps * self.rule.order as u64;
        }
        self.begun[l] = self.round;
    }

    /// Gives the outcome of the motion in a lane, which is free then.
    fn finish(&mut self, l: usize, end: State<D::Scalar, N>, outcome: Result<Status, Error>) {
        self.count(l, self.round - self.begun[l]);
        let Some(Member { index, recorder, stats, .. }) = self.members[l].take() else { return };
        let outcome = match outcome {
            Err(error) => Err(recorder.fail(error, end, 0, stats)),
            Ok(status) => Ok(recorder.finish(end, 0, status, stats)),
        };
        (self.outcomes)(index, outcome);
    }

    /// Begins motions in all free lanes.
    fn fill(&mut self) {
        for l in 0..W {
            while self.members[l].is_none() && !self.exhausted {
                match (self.problems)() {
                    Some(next) => self.begin(l, next),
                    None => self.exhausted = true,
                }
            }
        }
        self.idle();
        if let Some(member) = self.members.iter().flatten().next() {
            let mut parameters = self.parameters.iter();
            self.system = member
                .problem
                .system
                .widen(|parameter| parameters.next().copied().unwrap_or(Wide::splat(parameter)));
            self.workspace.work = self.system.work();
        }
        self.set_deadline();
    }

    /// Finds the round after which a motion has taken all steps allowed.
    fn set_deadline(&mut self) {
        let left = |l: usize| {
            let Stats { accepted, rejected, .. } = self.members[l].as_ref()?.stats;
            Some(
                self.begun[l]
                    .saturating_add(self.batch.max_steps.saturating_sub(accepted + rejected)),
            )
        };
        self.deadline = (0..W).filter_map(left).min().unwrap_or(self.round);
    }

    /// Begins a motion in a lane, unless it fails at once or ends where it begins.
    fn begin(&mut self, l: usize, (index, problem): (usize, Posed<'a, D, N>)) {
        let Watch { output, dense, events } = self.watch;
        let (time, start) =
            (problem.time, Endpoint::new(Time::new(problem.time.0), problem.q, problem.v));
        let mut member = Member {
            index,
            recorder: Recorder::new(output, time, Self::FACTS, None),
            detector: EventDetector::new(events),
            problem,
            a: None,
            stats: Stats::new(<Taylor as Method<Known<'_, D>, N>>::NAME),
        };
        let begun = self.batch.begin(&member.problem, &output).and_then(|ends| {
            if WATCHED {
                member.recorder.begin(State::from(&start), 0, dense);
                let mut view = InLane::<D, N> {
                    dynamics: &member.problem.system,
                    path: &self.workspace.path,
                    order: self.rule.order,
                    lane: l,
                    from: start,
                    before_kink: None,
                    end: start,
                    interval: StepInterval::by(start.t, if time.1 < time.0 { -0.0 } else { 0.0 }),
                    interpolant: None,
                    evaluations: &mut member.stats.evaluations,
                };
                member.detector.begin(&mut view)?;
                member.a = view.end.a;
            }
            Ok(ends)
        });
        if let Ok(false) = begun {
            let mut parameters = self.parameters.iter_mut();
            member.problem.system.system().map(|parameter| {
                if let Some(lanes) = parameters.next() {
                    lanes.0[l] = parameter;
                }
                parameter
            });
            self.put(l, &start);
            (self.lanes.end.0[l], self.lanes.live.0[l]) = (member.next_end(start.t), 1.0);
            (self.output.0[l], self.onwards.0[l]) =
                (member.recorder.next_time(), direction(time.0, time.1));
            (self.members[l], self.begun[l]) = (Some(member), self.round);
            self.first = self.batch.control.limits_first();
        } else {
            self.members[l] = Some(member);
            self.begun[l] = self.round;
            let outcome = begun.map(|_| Status::Completed);
            self.finish(l, State::from(&start), outcome);
        }
    }

    /// Gives the lanes that stay free what one stands for that is under way, so that no odd number
    /// slows the others down.
    fn idle(&mut self) {
        let Some(model) = self.members.iter().position(Option::is_some) else { return };
        for l in 0..W {
            if self.members[l].is_none() {
                self.put(l, &node(&self.lanes, model));
                self.lanes.live.0[l] = 0.0;
                self.lanes.end.0[l] = self.lanes.end.0[model];
                for parameter in &mut self.parameters {
                    parameter.0[l] = parameter.0[model];
                }
            }
        }
    }

    fn put(&mut self, l: usize, node: &Endpoint<D::Scalar, N>) {
        self.workspace.driven[l] = false;
        (self.lanes.high.0[l], self.lanes.low.0[l]) = (node.t.to_f64(), node.t.low());
        for i in 0..N {
            (self.lanes.q.high[i].0[l], self.lanes.q.low[i].0[l]) = (node.q.high[i], node.q.low[i]);
            (self.lanes.v.high[i].0[l], self.lanes.v.low[i].0[l]) = (node.v.high[i], node.v.low[i]);
        }
    }
}

/// The indices of those of [`POINTS`] that are no ends of a step.
const INNER: [usize; POINTS.len() - 2] = [0, 2, 3, 4, 5, 6, 7, 8, 9];

/// The coordinates and velocities of all lanes at several points of their steps.
type Places<T, const N: usize> = [[[Wide<T>; N]; 2]; POINTS.len()];

impl<D: Batched<N>, const N: usize> Member<'_, D, N> {
    /// The first time after `t` at which the series stop holding: that of a break, or the end.
    fn next_end(&self, t: Time) -> f64 {
        let Problem { system, time: (start, end), .. } = &*self.problem;
        let t = t.to_f64();
        let found = if end < start { system.last_break(t) } else { system.next_break(t) };
        found.filter(|time| precedes(*time, *end, (*start, *end))).unwrap_or(*end)
    }

    /// The first kink after `t`, infinite if there is none.
    fn next_kink(&self, t: Time) -> f64 {
        let Problem { system, time: (start, end), .. } = &*self.problem;
        let (t, onwards) = (t.to_f64(), direction(*start, *end));
        let kink = if onwards < 0.0 { system.last_kink(t) } else { Dynamics::next_kink(system, t) };
        kink.unwrap_or(onwards * f64::INFINITY)
    }
}

/// The lengths of steps in the scalar of the system.
#[inline(always)]
fn length_of<T: Lane + Float>(h: &[Wide<f64>; 2]) -> Wide<T> {
    let mut length = Wide::from_f64(0.0);
    for l in 0..W {
        length.0[l] = T::from_f64(h[0].0[l]) + T::from_f64(h[1].0[l]);
    }
    length
}

/// The step that a lane has taken.
fn interval_of<T: Lane + Float, const N: usize>(
    from: &Flight<T, N>,
    to: &Flight<T, N>,
    h: [Wide<f64>; 2],
    l: usize,
) -> StepInterval {
    let [start, end] = [from, to].map(|lanes| Time::from_words(lanes.high.0[l], lanes.low.0[l]));
    StepInterval { start, end, h: h[0].0[l], low: h[1].0[l] }
}

/// The state in a lane.
fn node<T: Lane + Float, const N: usize>(lanes: &Flight<T, N>, l: usize) -> Endpoint<T, N> {
    let sum = |sum: &Compensated<Wide<T>, N>| Compensated {
        high: sum.high.map(|x| x.0[l]),
        low: sum.low.map(|x| x.0[l]),
    };
    let t = Time::from_words(lanes.high.0[l], lanes.low.0[l]);
    Endpoint { t, q: sum(&lanes.q), v: sum(&lanes.v), a: None }
}
