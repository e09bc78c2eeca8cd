//! The steps of the lanes.
//!
//! What every step does is inlined into the code that [`simd`](crate::simd) compiles for several
//! instruction sets; what begins and ends motions is not.

#![allow(clippy::inline_always)]
// A branch in a loop over lanes would take the lanes apart.
#![allow(clippy::needless_bitwise_bool)]

use super::{Batch, Batched, Outcome, Posed, W, outcome};
use crate::error::Error;
use crate::integrate::method::{self, Method};
use crate::integrate::methods::taylor::{GAP, LAST_ORDERS, Rule, Taylor, largest, rest};
use crate::integrate::solution::Stats;
use crate::integrate::state::State;
use crate::integrate::step::adaptive::resolution;
use crate::integrate::step::compensated::{Compensated, splitter};
use crate::integrate::step::endpoint::Endpoint;
use crate::integrate::step::fast_exp2::power;
use crate::integrate::step::field::Field;
use crate::integrate::step::field::coordinate;
use crate::integrate::step::gap;
use crate::integrate::step::interval::StepInterval;
use crate::jet::{Jets, Path, Unrolling};
use crate::scalar::{Float, Lane, Lanes, Real};
use crate::simd::Work;
use crate::time::Time;

/// A number of each lane.
type Wide<T> = Lanes<T, W>;

/// A source of problems and their indices.
pub(crate) type Problems<'a, S, const N: usize> =
    dyn FnMut() -> Option<(usize, Posed<'a, S, N>)> + 'a;

/// A receiver of outcomes and their indices.
pub(crate) type Outcomes<'a, T, const N: usize> = dyn FnMut(usize, Outcome<T, N>) + 'a;

/// A batch under way.
pub(super) struct Run<'a, S: Batched<N>, const N: usize> {
    batch: &'a Batch<N>,
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
    /// The problem in each lane and its index; none where it is idle.
    problem: [Option<(usize, Posed<'a, S, N>)>; W],
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
struct Flight<T, const N: usize> {
    q: Compensated<Wide<T>, N>,
    v: Compensated<Wide<T>, N>,
    /// The words of the time.
    high: Wide<f64>,
    low: Wide<f64>,
    /// The time at which the motion ends.
    end: Wide<f64>,
    /// 1 where a motion is under way, else 0.
    live: Wide<f64>,
}

/// All steps of a batch.
pub(super) struct Steps<'r, 'a, S: Batched<N>, const N: usize>(pub(super) &'r mut Run<'a, S, N>);

impl<S: Batched<N>, const N: usize> Work for Steps<'_, '_, S, N> {
    #[inline(always)]
    fn run(self) {
        while self.0.round < self.0.deadline {
            self.0.step();
        }
    }
}

impl<'a, S: Batched<N>, const N: usize> Run<'a, S, N> {
    /// The first motions in their lanes; `None` without problems.
    pub(super) fn new(
        batch: &'a Batch<N>,
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
            problem: [const { None }; W],
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
        } else if any(self.advance(&from, [h, Wide::from_f64(0.0)])) {
            self.settle(&from, wanted, h);
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
        let Some((_, problem)) = &self.problem[l] else { return wanted };
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
        self.settle(from, wanted, h[0]);
    }

    /// Ends the motions that have come to an end, and begins others in their lanes.
    #[cold]
    #[inline(never)]
    fn settle(&mut self, before: &Flight<S::Scalar, N>, wanted: Wide<f64>, h: Wide<f64>) {
        for l in 0..W {
            let Some((_, problem)) = &self.problem[l] else { continue };
            let time = problem.time;
            let steps = self.round - self.begun[l];
            let (from, to) = (node(before, l), node(&self.lanes, l));
            let end = self.lanes.end.0[l];
            let close = reaches(from.t, end, wanted.0[l]);
            let error = if !to.is_finite() {
                let interval = if close {
                    StepInterval::to(from.t, end)
                } else {
                    StepInterval::by(from.t, h.0[l])
                };
                Some(Self::not_finite(&self.batch.method, &problem.system, &from, &interval))
            } else if is_short(from.t, end, wanted.0[l]) {
                let unresolved = self.batch.control.unresolved(steps == 1, wanted.0[l]);
                Some(unresolved.unwrap_or_else(|| self.underflow(before, &from, wanted.0[l], l)))
            } else {
                None
            };
            let (taken, tried) = if error.is_some() { (steps - 1, steps) } else { (steps, steps) };
            let mut stats = Stats::new(<Taylor as Method<S, N>>::NAME);
            (stats.accepted, stats.evaluations) = (taken, tried * self.rule.order as u64);
            if error.is_some() {
                self.finish(l, outcome::<S, N>(time, State::from(&from), stats, error));
            } else if close {
                (self.lanes.high.0[l], self.lanes.low.0[l]) = (time.1, 0.0);
                self.finish(
                    l,
                    outcome::<S, N>(time, State::from(&node(&self.lanes, l)), stats, None),
                );
            } else if self.batch.max_steps <= steps {
                let error = Error::MaxSteps { t: to.t.to_f64(), max_steps: self.batch.max_steps };
                self.finish(l, outcome::<S, N>(time, State::from(&to), stats, Some(error)));
            }
        }
        self.fill();
    }

    fn finish(&mut self, l: usize, outcome: Outcome<S::Scalar, N>) {
        if let Some((index, _)) = self.problem[l].take() {
            (self.outcomes)(index, outcome);
        }
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

    /// The error for a step of a lane that is too short.
    fn underflow(
        &self,
        before: &Flight<S::Scalar, N>,
        from: &Endpoint<S::Scalar, N>,
        wanted: f64,
        l: usize,
    ) -> Error {
        let all = weights(before, self.rtol, &self.atol);
        let one = all.map(|weights| weights.map(|weights| weights.0[l]));
        let mut path = Path::new();
        let k = self.rule.order;
        for i in 0..N {
            path.q[i][k] = self.workspace.path.q[i][k].0[l];
            path.v[i][k] = self.workspace.path.v[i][k].0[l];
        }
        let (_, index) = largest(&path, k, &one);
        let coordinate = coordinate(&S::FACTS, index);
        Error::StepSizeUnderflow { t: from.t.to_f64(), step: wanted, coordinate }
    }

    /// Begins motions in all free lanes.
    fn fill(&mut self) {
        for l in 0..W {
            while self.problem[l].is_none() && !self.exhausted {
                match (self.problems)() {
                    Some(next) => self.begin(l, next),
                    None => self.exhausted = true,
                }
            }
        }
        self.idle();
        if let Some((_, problem)) = self.problem.iter().flatten().next() {
            let mut parameters = self.parameters.iter();
            self.system = problem
                .system
                .widen(|parameter| parameters.next().copied().unwrap_or(Wide::splat(parameter)));
            self.workspace.work = self.system.work();
        }
        self.deadline = (0..W)
            .filter(|&l| self.problem[l].is_some())
            .map(|l| self.begun[l].saturating_add(self.batch.max_steps))
            .min()
            .unwrap_or(self.round);
    }

    /// Begins a motion in a lane, unless it fails at once or ends where it begins.
    fn begin(&mut self, l: usize, (index, problem): (usize, Posed<'a, S, N>)) {
        let given = State { t: problem.time.0, q: problem.q, v: problem.v };
        let error = match self.batch.begin(&problem) {
            Ok(false) => {
                let mut parameters = self.parameters.iter_mut();
                problem.system.map(|parameter| {
                    if let Some(lanes) = parameters.next() {
                        lanes.0[l] = parameter;
                    }
                    parameter
                });
                self.put(l, &Endpoint::new(Time::new(problem.time.0), problem.q, problem.v));
                (self.lanes.end.0[l], self.lanes.live.0[l]) = (problem.time.1, 1.0);
                (self.problem[l], self.begun[l]) = (Some((index, problem)), self.round);
                self.first = self.batch.control.limits_first();
                return;
            }
            Ok(true) => None,
            Err(error) => Some(error),
        };
        let stats = Stats::new(<Taylor as Method<S, N>>::NAME);
        (self.outcomes)(index, outcome::<S, N>(problem.time, given, stats, error));
    }

    /// Gives the lanes that stay free what one stands for that is under way, so that no odd number
    /// slows the others down.
    fn idle(&mut self) {
        let Some(model) = self.problem.iter().position(Option::is_some) else { return };
        for l in 0..W {
            if self.problem[l].is_none() {
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

/// The state in a lane.
fn node<T: Lane + Float, const N: usize>(lanes: &Flight<T, N>, l: usize) -> Endpoint<T, N> {
    let sum = |sum: &Compensated<Wide<T>, N>| Compensated {
        high: sum.high.map(|x| x.0[l]),
        low: sum.low.map(|x| x.0[l]),
    };
    let t = Time::from_words(lanes.high.0[l], lanes.low.0[l]);
    Endpoint { t, q: sum(&lanes.q), v: sum(&lanes.v), a: None }
}

/// One over the error allowed.
#[inline(always)]
fn weights<T: Lane + Float, const N: usize>(
    from: &Flight<T, N>,
    rtol: f64,
    atol: &[[f64; N]; 2],
) -> [[Wide<f64>; N]; 2] {
    let mut weights = [[Wide::from_f64(0.0); N]; 2];
    for (part, state) in [&from.q.high, &from.v.high].into_iter().enumerate() {
        for i in 0..N {
            for l in 0..W {
                weights[part][i].0[l] = 1.0 / (atol[part][i] + rtol * state[i].0[l].to_f64().abs());
            }
        }
    }
    weights
}

/// A length that stands for one that the last terms do not tell.
const UNTOLD: f64 = 1e300;

/// The lengths of steps that the last terms of the series tell: 1023 and their binary
/// logarithms.
#[inline(always)]
fn log_radii<T: Lane + Float, const N: usize>(
    path: &Path<Wide<T>, N>,
    rule: &Rule,
    weights: &[[Wide<f64>; N]; 2],
) -> Wide<f64> {
    let mut least = Wide::from_f64(f64::INFINITY);
    for back in 0..LAST_ORDERS {
        least = nearest(
            least,
            log_radius_of(path, rule, weights, rule.order.saturating_sub(back).max(1)),
        );
    }
    least
}

/// The lengths of steps at whose ends the last terms of the series are as large as allowed, as
/// [`Taylor`] finds them.
#[inline(always)]
fn lengths(log_radii: Wide<f64>) -> Wide<f64> {
    let mut wanted = log_radii;
    for l in 0..W {
        wanted.0[l] = power(log_radii.0[l]);
    }
    wanted
}

/// The same where the last terms may tell nothing: those lanes listen to the terms before.
fn longer<T: Lane + Float, const N: usize>(
    path: &Path<Wide<T>, N>,
    rule: &Rule,
    weights: &[[Wide<f64>; N]; 2],
    mut log_radii: Wide<f64>,
) -> Wide<f64> {
    let mut open = log_radii.0.map(|log_radii| log_radii == f64::INFINITY);
    if !open.contains(&true) {
        return lengths(log_radii);
    }
    for k in (1..=rule.order.saturating_sub(LAST_ORDERS)).rev() {
        let earlier = log_radius_of(path, rule, weights, k);
        for l in 0..W {
            if open[l] && earlier.0[l] < f64::INFINITY {
                (log_radii.0[l], open[l]) = (earlier.0[l], false);
            }
        }
    }
    let mut wanted = lengths(log_radii);
    for l in 0..W {
        wanted.0[l] = if open[l] { f64::INFINITY } else { wanted.0[l] };
    }
    wanted
}

/// The length that the coefficients of one order tell; infinite if all are zero.
#[inline(always)]
fn log_radius_of<T: Lane + Float, const N: usize>(
    path: &Path<Wide<T>, N>,
    rule: &Rule,
    weights: &[[Wide<f64>; N]; 2],
    k: usize,
) -> Wide<f64> {
    let mut log_radii = Wide::<f64>::from_f64(0.0);
    for i in 0..N {
        for (series, weights) in [(&path.q[i], &weights[0]), (&path.v[i], &weights[1])] {
            for l in 0..W {
                let coefficient = series[k].0[l].to_f64().abs() * weights[i].0[l];
                log_radii.0[l] =
                    if log_radii.0[l] < coefficient { coefficient } else { log_radii.0[l] };
            }
        }
    }
    for l in 0..W {
        log_radii.0[l] = rule.log_radius(log_radii.0[l], k);
    }
    log_radii
}

/// The lesser number of each lane.
#[inline(always)]
fn nearest(a: Wide<f64>, b: Wide<f64>) -> Wide<f64> {
    let mut least = a;
    for l in 0..W {
        least.0[l] = if b.0[l] < a.0[l] { b.0[l] } else { a.0[l] };
    }
    least
}

/// The steps of these lengths, or what avoids leaving a sliver before the end, as for a single
/// motion; none in idle lanes. Steps that would reach the end or are too short are marked.
#[inline(always)]
fn fit<T, const N: usize>(
    from: &Flight<T, N>,
    wanted: Wide<f64>,
    unusual: &mut Wide<f64>,
) -> Wide<f64> {
    let mut h = wanted;
    for l in 0..W {
        let (t, wanted) = (Time::from_words(from.high.0[l], from.low.0[l]), wanted.0[l]);
        let left = -t.since(from.end.0[l]);
        let step = if left.abs() < 2.0 * wanted { 0.5 * left } else { wanted.copysign(left) };
        h.0[l] = if 0.0 < from.live.0[l] { step } else { 0.0 };
        unusual.0[l] =
            if reaches(t, from.end.0[l], wanted) { from.live.0[l] } else { unusual.0[l] };
        unusual.0[l] =
            if is_short(t, from.end.0[l], wanted) { from.live.0[l] } else { unusual.0[l] };
    }
    h
}

/// Returns true if a step of this length would reach the end.
#[inline(always)]
fn reaches(t: Time, end: f64, wanted: f64) -> bool {
    t.since(end).abs() <= 1.01 * wanted
}

/// Returns true if a step of this length would be too short before the end.
#[inline(always)]
fn is_short(t: Time, end: f64, wanted: f64) -> bool {
    (wanted <= resolution(t)) & (wanted < t.since(end).abs())
}

/// Returns true if some lane is not zero.
#[inline(always)]
fn any(lanes: Wide<f64>) -> bool {
    let mut all_zero = true;
    for l in 0..W {
        all_zero &= lanes.0[l] == 0.0;
    }
    !all_zero
}
