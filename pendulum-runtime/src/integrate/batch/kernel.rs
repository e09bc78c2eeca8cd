//! The steps of the lanes.
//!
//! What every step does is inlined into the code that [`simd`](crate::simd) compiles for several
//! instruction sets; what begins and ends motions is not.

#![allow(clippy::inline_always)]
// A branch in a loop over lanes would take the lanes apart.
#![allow(clippy::needless_bitwise_bool)]

use super::lengths::{UNTOLD, any, fit, is_short, lengths, log_radii, longer, reaches, weights};
use super::member::InLane;
use super::{Batch, Batched, Outcome, Posed, W};
use crate::error::Error;
use crate::integrate::events::detector::{EventDetector, POINTS, Place};
use crate::integrate::events::{Event, Status};
use crate::integrate::method::{self, Method};
use crate::integrate::methods::taylor::{GAP, Rule, Taylor, largest, rest};
use crate::integrate::output::{Output, Recorder, direction};
use crate::integrate::solution::Stats;
use crate::integrate::state::State;
use crate::integrate::step::compensated::{Compensated, splitter};
use crate::integrate::step::endpoint::Endpoint;
use crate::integrate::step::field::Field;
use crate::integrate::step::field::coordinate;
use crate::integrate::step::gap;
use crate::integrate::step::interval::StepInterval;
use crate::jet::{Jets, LENGTH, Path, Unrolling};
use crate::scalar::{Float, Lane, Lanes, Real};
use crate::simd::Work;
use crate::system::scalar_time;
use crate::time::Time;

/// A number of each lane.
pub(super) type Wide<T> = Lanes<T, W>;

/// A source of problems and their indices.
pub(crate) type Problems<'a, S, const N: usize> =
    dyn FnMut() -> Option<(usize, Posed<'a, S, N>)> + 'a;

/// A receiver of outcomes and their indices.
pub(crate) type Outcomes<'a, T, const N: usize> = dyn FnMut(usize, Outcome<T, N>) + 'a;

/// What is kept of each motion of a batch beside its end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Watch<'a, T, const N: usize> {
    pub(crate) output: Output<'a>,
    pub(crate) dense: bool,
    /// Events with functions that do not act.
    pub(crate) events: &'a [Event<'a, T, N>],
}

/// A motion in a lane.
struct Member<'a, S: Batched<N>, const N: usize> {
    index: usize,
    problem: Posed<'a, S, N>,
    recorder: Recorder<'a, 'a, S::Scalar, N>,
    detector: EventDetector<'a, S::Scalar, N>,
    /// The accelerations at the start, where somebody has asked for them.
    a: Option<[S::Scalar; N]>,
    /// Evaluations beside those of the series.
    evaluations: u64,
}

/// A batch under way.
pub(super) struct Run<'a, S: Batched<N>, const N: usize, const WATCHED: bool> {
    batch: &'a Batch<N>,
    /// What is kept of each motion beside its end.
    watch: Watch<'a, S::Scalar, N>,
    /// Gives the next problem and its index, until there are no more.
    problems: &'a mut Problems<'a, S, N>,
    /// Takes the outcomes as motions end.
    outcomes: &'a mut Outcomes<'a, S::Scalar, N>,
    /// The last problem was given.
    exhausted: bool,
    rule: Rule,
    /// The absolute tolerances of coordinates and velocities, and the relative one.
    atol: [[f64; N]; 2],
    rtol: f64,
    /// The parameters of all lanes.
    parameters: Vec<Wide<S::Scalar>>,
    system: S::Wide,
    workspace: Box<Workspace<S, N>>,
    lanes: Flight<S::Scalar, N>,
    /// The motion in each lane; none where it is idle.
    members: [Option<Member<'a, S, N>>; W],
    /// The next output time of each lane, and the direction of its time.
    output: Wide<f64>,
    onwards: Wide<f64>,
    /// The round in which the motion in each lane began.
    begun: [u64; W],
    /// The rounds so far: each takes one step in every lane.
    round: u64,
    /// The round after which a motion has taken all steps allowed.
    deadline: u64,
    /// True if some lane takes its first step, of limited length.
    first: bool,
}

/// The room for the jets.
struct Workspace<S: Batched<N>, const N: usize> {
    path: Path<Wide<S::Scalar>, N>,
    drive: <S::Wide as Jets<N>>::Drive,
    work: <S::Wide as Jets<N>>::Work,
}

/// The states of all lanes.
#[derive(Clone, Copy)]
pub(super) struct Flight<T, const N: usize> {
    pub(super) q: Compensated<Wide<T>, N>,
    pub(super) v: Compensated<Wide<T>, N>,
    /// The words of the time.
    pub(super) high: Wide<f64>,
    pub(super) low: Wide<f64>,
    /// The time at which the motion ends.
    pub(super) end: Wide<f64>,
    /// 1 where a motion is under way, else 0.
    pub(super) live: Wide<f64>,
}

/// All steps of a batch.
pub(super) struct Steps<'r, 'a, S: Batched<N>, const N: usize, const WATCHED: bool>(
    pub(super) &'r mut Run<'a, S, N, WATCHED>,
);

impl<S: Batched<N>, const N: usize, const WATCHED: bool> Work for Steps<'_, '_, S, N, WATCHED> {
    #[inline(always)]
    fn run(self) {
        while self.0.round < self.0.deadline {
            self.0.step();
        }
    }
}

impl<'a, S: Batched<N>, const N: usize, const WATCHED: bool> Run<'a, S, N, WATCHED> {
    /// The first motions in their lanes; `None` without problems.
    pub(super) fn new(
        batch: &'a Batch<N>,
        watch: Watch<'a, S::Scalar, N>,
        problems: &'a mut Problems<'a, S, N>,
        outcomes: &'a mut Outcomes<'a, S::Scalar, N>,
    ) -> Option<Self> {
        let zero = Wide::from_f64(0.0);
        let first = problems()?;
        let mut parameters = Vec::new();
        let system = first.1.system.widen(|parameter| {
            parameters.push(Wide::splat(parameter));
            Wide::splat(parameter)
        });
        let (rtol, atol) = batch.control.tolerances::<S::Scalar>();
        let still = Compensated::new([zero; N]);
        let number = Wide::from_f64(0.0);
        let mut run = Self {
            batch,
            watch,
            problems,
            outcomes,
            exhausted: false,
            rule: batch.rule::<S>(),
            atol: [atol.0, atol.1],
            rtol,
            parameters,
            workspace: Box::new(Workspace {
                path: Path::new(),
                drive: S::Wide::drive(),
                work: system.work(),
            }),
            system,
            lanes: Flight {
                q: still,
                v: still,
                high: number,
                low: number,
                end: number,
                live: number,
            },
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

    /// One step in every lane.
    #[inline(always)]
    fn step(&mut self) {
        let from = self.lanes;
        let Workspace { path, drive, work } = &mut *self.workspace;
        for l in 0..W {
            path.t.0[l] = S::Scalar::from_f64(from.high.0[l]) + S::Scalar::from_f64(from.low.0[l]);
        }
        for i in 0..N {
            path.q[i][0] = self.lanes.q.high[i];
            path.v[i][0] = self.lanes.v.high[i];
        }
        <S::Wide as Jets<N>>::Unrolling::run_in_lanes(
            &self.system,
            self.rule.order,
            path,
            drive,
            work,
        );
        let weights = weights(&from, self.rtol, &self.atol);
        let log_radii = log_radii(path, &self.rule, &weights);
        let mut wanted = lengths(log_radii);
        let mut unusual = wanted;
        for l in 0..W {
            unusual.0[l] = if UNTOLD < wanted.0[l] { 1.0 } else { 0.0 };
            wanted.0[l] = self.limited(&from, l, false, wanted.0[l]);
        }
        let h = fit(&from, wanted, &mut unusual);
        if any(unusual) | self.first | (self.round + 1 == self.deadline) {
            self.unusual_steps(&from, log_radii, &weights);
        } else {
            let h = [h, Wide::from_f64(0.0)];
            let mut not_finite = self.advance(&from, h);
            let mut seen = Wide::from_f64(0.0);
            if WATCHED {
                seen = self.watch(&from, h);
                for l in 0..W {
                    not_finite.0[l] += seen.0[l];
                }
            }
            if any(not_finite) {
                self.settle(&from, wanted, h, seen);
            }
        }
    }

    /// A length of step of a lane within the limits set, and short enough to see what time alone
    /// does.
    #[inline(always)]
    fn limited(&self, from: &Flight<S::Scalar, N>, l: usize, first: bool, wanted: f64) -> f64 {
        let wanted = self.batch.control.limited(first, wanted);
        if !S::FACTS.explicit_time {
            return wanted;
        }
        let Some(Member { problem, .. }) = &self.members[l] else { return wanted };
        let longest =
            gap::longest(&problem.system, Time::from_words(from.high.0[l], from.low.0[l]), GAP);
        if longest < wanted { longest } else { wanted }
    }

    /// Goes to the ends of steps of the lengths `h`, which come in two words; not zero where the
    /// state there is not finite.
    #[inline(always)]
    fn advance(&mut self, from: &Flight<S::Scalar, N>, h: [Wide<f64>; 2]) -> Wide<f64> {
        let mut length = Wide::from_f64(0.0);
        for l in 0..W {
            length.0[l] = S::Scalar::from_f64(h[0].0[l]) + S::Scalar::from_f64(h[1].0[l]);
        }
        let (path, splitter) = (&self.workspace.path, Wide::splat(splitter::<S::Scalar>()));
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
        let mut not_finite = Wide::from_f64(0.0);
        for l in 0..W {
            let t = Time::from_words(from.high.0[l], from.low.0[l]) + h[0].0[l];
            (self.lanes.high.0[l], self.lanes.low.0[l]) = (t.to_f64(), t.low());
            not_finite.0[l] = finite.0[l].to_f64();
        }
        self.round += 1;
        not_finite
    }

    /// Takes steps of which some are the first or the last ones, too short, or as long as no term
    /// tells.
    #[cold]
    #[inline(never)]
    fn unusual_steps(
        &mut self,
        from: &Flight<S::Scalar, N>,
        log_radii: Wide<f64>,
        weights: &[[Wide<f64>; N]; 2],
    ) {
        let mut wanted = longer(&self.workspace.path, &self.rule, weights, log_radii);
        for l in 0..W {
            wanted.0[l] = self.limited(from, l, self.begun[l] == self.round, wanted.0[l]);
        }
        let mut h = [fit(from, wanted, &mut Wide::from_f64(0.0)), Wide::from_f64(0.0)];
        for l in 0..W {
            let (t, end) = (Time::from_words(from.high.0[l], from.low.0[l]), from.end.0[l]);
            if 0.0 < from.live.0[l] && reaches(t, end, wanted.0[l]) {
                let interval = StepInterval::to(t, end);
                (h[0].0[l], h[1].0[l]) = (interval.h, interval.low);
            }
        }
        self.first = false;
        self.advance(from, h);
        for l in 0..W {
            let t = Time::from_words(from.high.0[l], from.low.0[l]);
            if 0.0 < from.live.0[l] && reaches(t, from.end.0[l], wanted.0[l]) {
                (self.lanes.high.0[l], self.lanes.low.0[l]) = (from.end.0[l], 0.0);
            }
        }
        let seen = if WATCHED { self.watch(from, h) } else { Wide::from_f64(0.0) };
        self.settle(from, wanted, h, seen);
    }

    /// Finds the lanes in whose steps something is to be kept: an output time, an event. They are
    /// not zero.
    #[inline(always)]
    fn watch(&mut self, from: &Flight<S::Scalar, N>, h: [Wide<f64>; 2]) -> Wide<f64> {
        let mut seen = Wide::from_f64(0.0);
        let always = self.watch.dense | matches!(self.watch.output, Output::Steps);
        for l in 0..W {
            let ahead = self.onwards.0[l] * (self.output.0[l] - self.lanes.high.0[l]);
            seen.0[l] = if (ahead <= 0.0) | always { from.live.0[l] } else { 0.0 };
        }
        if self.watch.events.is_empty() {
            return seen;
        }
        let places = self.places(h);
        for l in 0..W {
            if 0.0 < from.live.0[l] {
                seen.0[l] = if self.is_quiet(l, from, h, &places) { seen.0[l] } else { 1.0 };
            }
        }
        seen
    }

    /// The coordinates and velocities at [`POINTS`] but the two that are known.
    #[inline(always)]
    fn places(&self, h: [Wide<f64>; 2]) -> Places<S::Scalar, N> {
        let zero = Wide::from_f64(0.0);
        let mut places = [[[zero; N]; 2]; POINTS.len()];
        let mut length = Wide::from_f64(0.0);
        for l in 0..W {
            length.0[l] = S::Scalar::from_f64(h[0].0[l]) + S::Scalar::from_f64(h[1].0[l]);
        }
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
                            (sums[point] + terms[k]) * Wide::<S::Scalar>::from_f64(POINTS[point]);
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
    fn is_quiet(
        &mut self,
        l: usize,
        from: &Flight<S::Scalar, N>,
        h: [Wide<f64>; 2],
        places: &Places<S::Scalar, N>,
    ) -> bool {
        let Some(member) = &mut self.members[l] else { return true };
        let interval = interval_of(from, &self.lanes, h, l);
        let (t, length) =
            (scalar_time::<S::Scalar>(interval.start), interval.length::<S::Scalar>());
        let last = POINTS.len() - 1;
        // Number by number into the same place: the next load of a copy would wait.
        let put = |point: usize, place: &mut Place<S::Scalar, N>| {
            place.t = t + S::Scalar::from_f64(POINTS[point]) * length;
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

    /// Ends the motions that have come to an end, and begins others in their lanes; looks at what is
    /// to be kept in the lanes `seen`.
    #[cold]
    #[inline(never)]
    fn settle(
        &mut self,
        before: &Flight<S::Scalar, N>,
        wanted: Wide<f64>,
        h: [Wide<f64>; 2],
        seen: Wide<f64>,
    ) {
        let mut ended = false;
        for l in 0..W {
            let Some(member) = &mut self.members[l] else { continue };
            let steps = self.round - self.begun[l];
            let (from, to) = (node(before, l), node(&self.lanes, l));
            let end = self.lanes.end.0[l];
            let close = reaches(from.t, end, wanted.0[l]);
            let interval = interval_of(before, &self.lanes, h, l);
            let mut error = if !to.is_finite() {
                Some(Self::not_finite(&self.batch.method, &member.problem.system, &from, &interval))
            } else if is_short(from.t, end, wanted.0[l]) {
                let unresolved = self.batch.control.unresolved(steps == 1, wanted.0[l]);
                Some(unresolved.unwrap_or_else(|| {
                    let weights = weights(before, self.rtol, &self.atol);
                    underflow::<S, N>(
                        &self.workspace.path,
                        self.rule.order,
                        &weights,
                        &from,
                        wanted.0[l],
                        l,
                    )
                }))
            } else {
                None
            };
            let failed_step = error.is_some();
            let (mut end, mut status) = (if failed_step { from } else { to }, None);
            if WATCHED && !failed_step && 0.0 < seen.0[l] {
                let mut view = InLane::<S, N> {
                    system: &member.problem.system,
                    path: &self.workspace.path,
                    order: self.rule.order,
                    lane: l,
                    from: Endpoint { a: if steps == 1 { member.a } else { None }, ..from },
                    end,
                    interval,
                    interpolant: None,
                    evaluations: &mut member.evaluations,
                };
                let looked = member.detector.observe(&mut view);
                member.recorder.events(member.detector.found());
                let looked = looked.and_then(|status| {
                    member.recorder.step(&mut view)?;
                    Ok(status)
                });
                end = view.end;
                match looked {
                    Ok(ended) => status = ended,
                    Err(failure) => error = Some(failure),
                }
                self.output.0[l] = member.recorder.next_time();
            }
            if error.is_none() && status.is_none() {
                if close {
                    status = Some(Status::Completed);
                } else if self.batch.max_steps <= steps {
                    let max_steps = self.batch.max_steps;
                    error = Some(Error::MaxSteps { t: to.t.to_f64(), max_steps });
                } else {
                    continue;
                }
            }
            ended = true;
            let (taken, tried) = if failed_step { (steps - 1, steps) } else { (steps, steps) };
            let evaluations = tried * self.rule.order as u64;
            self.finish(l, State::from(&end), status, error, (taken, evaluations));
        }
        if ended {
            self.fill();
        }
    }

    /// Gives the outcome of the motion in a lane, which is free then.
    fn finish(
        &mut self,
        l: usize,
        end: State<S::Scalar, N>,
        status: Option<Status>,
        error: Option<Error>,
        (accepted, evaluations): (u64, u64),
    ) {
        let Some(member) = self.members[l].take() else { return };
        let mut stats = Stats::new(<Taylor as Method<S, N>>::NAME);
        (stats.accepted, stats.evaluations) = (accepted, evaluations + member.evaluations);
        let outcome = match error {
            Some(error) => Err(member.recorder.fail(error, end, 0, stats)),
            None => Ok(member.recorder.finish(end, 0, status.unwrap_or(Status::Completed), stats)),
        };
        (self.outcomes)(member.index, outcome);
    }

    /// The error for a step of a lane that led to a number that is not finite.
    fn not_finite(
        method: &Taylor,
        system: &S,
        from: &Endpoint<S::Scalar, N>,
        interval: &StepInterval,
    ) -> Error {
        let prepared = system.prepare();
        let field = Field::new(system, &prepared);
        method::cause(method, &field, interval, from, &Method::<S, N>::workspace(method, system))
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
        self.deadline = (0..W)
            .filter(|&l| self.members[l].is_some())
            .map(|l| self.begun[l].saturating_add(self.batch.max_steps))
            .min()
            .unwrap_or(self.round);
    }

    /// Begins a motion in a lane, unless it fails at once or ends where it begins.
    fn begin(&mut self, l: usize, (index, problem): (usize, Posed<'a, S, N>)) {
        let Watch { output, dense, events } = self.watch;
        let (time, start) =
            (problem.time, Endpoint::new(Time::new(problem.time.0), problem.q, problem.v));
        let mut member = Member {
            index,
            recorder: Recorder::new(output, time, const { &S::FACTS }, None),
            detector: EventDetector::new(events),
            problem,
            a: None,
            evaluations: 0,
        };
        let begun = self.batch.begin(&member.problem, &output).and_then(|ends| {
            if WATCHED {
                member.recorder.begin(State::from(&start), 0, dense);
                let mut view = InLane::<S, N> {
                    system: &member.problem.system,
                    path: &self.workspace.path,
                    order: self.rule.order,
                    lane: l,
                    from: start,
                    end: start,
                    interval: StepInterval::by(start.t, if time.1 < time.0 { -0.0 } else { 0.0 }),
                    interpolant: None,
                    evaluations: &mut member.evaluations,
                };
                member.detector.begin(&mut view)?;
                member.a = view.end.a;
            }
            Ok(ends)
        });
        if let Ok(false) = begun {
            let mut parameters = self.parameters.iter_mut();
            member.problem.system.map(|parameter| {
                if let Some(lanes) = parameters.next() {
                    lanes.0[l] = parameter;
                }
                parameter
            });
            self.put(l, &start);
            (self.lanes.end.0[l], self.lanes.live.0[l]) = (time.1, 1.0);
            (self.output.0[l], self.onwards.0[l]) =
                (member.recorder.next_time(), direction(time.0, time.1));
            (self.members[l], self.begun[l]) = (Some(member), self.round);
            self.first = self.batch.control.limits_first();
        } else {
            self.members[l] = Some(member);
            self.finish(l, State::from(&start), None, begun.err(), (0, 0));
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

    fn put(&mut self, l: usize, node: &Endpoint<S::Scalar, N>) {
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

/// The error for a step of a lane that is too short.
fn underflow<S: Batched<N>, const N: usize>(
    lanes: &Path<Wide<S::Scalar>, N>,
    k: usize,
    weights: &[[Wide<f64>; N]; 2],
    from: &Endpoint<S::Scalar, N>,
    wanted: f64,
    l: usize,
) -> Error {
    let one = weights.map(|weights| weights.map(|weights| weights.0[l]));
    let mut path = Path::new();
    for i in 0..N {
        path.q[i][k] = lanes.q[i][k].0[l];
        path.v[i][k] = lanes.v[i][k].0[l];
    }
    let (_, index) = largest(&path, k, &one);
    let coordinate = coordinate(&S::FACTS, index);
    Error::StepSizeUnderflow { t: from.t.to_f64(), step: wanted, coordinate }
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
