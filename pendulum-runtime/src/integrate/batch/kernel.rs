//! The steps of the lanes.
//!
//! What every step does is inlined into the code that [`simd`](crate::simd) compiles for several instruction sets; what begins and ends
//! motions is not.

#![allow(clippy::inline_always)]
// A branch in a loop over lanes would take the lanes apart.
#![allow(clippy::needless_bitwise_bool)]

use super::{Batch, Batched, Outcome, Problem, W, outcome};
use crate::error::Error;
use crate::integrate::adaptive_step::resolution;
use crate::integrate::blame::blame;
use crate::integrate::field::coordinate;
use crate::integrate::node::Node;
use crate::integrate::power::{coarse_exp2, coarse_log2};
use crate::integrate::solution::{State, Stats};
use crate::integrate::span::Span;
use crate::integrate::stepper::Stepper;
use crate::integrate::sum::{Sum, splitter};
use crate::integrate::taylor::{Rule, TELLING, Taylor, largest, rest};
use crate::jet::{Jets, Orders, Path};
use crate::real::{Float, Lane, Lanes, Real};
use crate::simd::Work;
use crate::time::Time;

/// A number of each lane.
type Wide<T> = Lanes<T, W>;

/// A batch under way.
pub(super) struct Run<'a, S: Batched<N>, const N: usize> {
    batch: &'a Batch<N>,
    problems: &'a [Problem<S, N>],
    /// The problem that the next free lane takes.
    next: usize,
    outcomes: Vec<Option<Outcome<S::Scalar, N>>>,
    rule: Rule,
    /// The absolute tolerances of coordinates and velocities, and the relative one.
    atol: [[f64; N]; 2],
    rtol: f64,
    /// The parameters of all lanes.
    parameters: Vec<Wide<S::Scalar>>,
    system: S::Wide,
    room: Box<Room<S, N>>,
    lanes: Flight<S::Scalar, N>,
    /// The problem in each lane; none where it is idle.
    problem: [Option<usize>; W],
    /// The round in which the motion in each lane began.
    begun: [u64; W],
    /// The rounds so far: each takes one step in every lane.
    round: u64,
    /// The round after which a motion has taken all steps allowed.
    deadline: u64,
    /// Whether some lane takes its first step.
    first: bool,
}

/// The room for the jets.
struct Room<S: Batched<N>, const N: usize> {
    path: Path<Wide<S::Scalar>, N>,
    drive: <S::Wide as Jets<N>>::Drive,
    work: <S::Wide as Jets<N>>::Work,
}

/// The states of all lanes.
#[derive(Clone, Copy)]
struct Flight<T, const N: usize> {
    q: Sum<Wide<T>, N>,
    v: Sum<Wide<T>, N>,
    /// The words of the time.
    high: Wide<f64>,
    low: Wide<f64>,
    /// Where the motion ends.
    end: Wide<f64>,
    /// 1 where a motion is under way, else 0.
    live: Wide<f64>,
}

/// What a step does to the lanes that it ends or that it must not end.
struct Step {
    wanted: Wide<f64>,
    /// The length and what rounding has left off it.
    h: Wide<f64>,
    h_low: Wide<f64>,
    /// Lanes that reach their end.
    close: [bool; W],
    /// Lanes whose step time does not resolve.
    short: [bool; W],
    /// Lanes whose state stays finite.
    finite: [bool; W],
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
    pub(super) fn new(batch: &'a Batch<N>, problems: &'a [Problem<S, N>]) -> Option<Self> {
        let zero = Wide::from_f64(0.0);
        let template = &problems.first()?.system;
        let mut parameters = Vec::new();
        let system = template.widen(|parameter| {
            parameters.push(Wide::splat(parameter));
            Wide::splat(parameter)
        });
        let (rtol, atol) = batch.control.tolerances::<S::Scalar>();
        let still = Sum::new([zero; N]);
        let number = Wide::from_f64(0.0);
        let mut run = Self {
            batch,
            problems,
            next: 0,
            outcomes: problems.iter().map(|_| None).collect(),
            rule: batch.rule::<S>(),
            atol: [atol.0, atol.1],
            rtol,
            parameters,
            room: Box::new(Room { path: Path::new(), drive: S::Wide::drive(), work: system.work() }),
            system,
            lanes: Flight { q: still, v: still, high: number, low: number, end: number, live: number },
            problem: [None; W],
            begun: [0; W],
            round: 0,
            deadline: 0,
            first: true,
        };
        run.fill();
        Some(run)
    }

    /// The outcomes of all problems.
    pub(super) fn outcomes(self) -> Vec<Outcome<S::Scalar, N>> {
        self.outcomes.into_iter().flatten().collect()
    }

    /// One step in every lane.
    #[inline(always)]
    fn step(&mut self) {
        let from = self.lanes;
        let Room { path, drive, work } = &mut *self.room;
        for l in 0..W {
            path.t.0[l] = S::Scalar::from_f64(from.high.0[l]) + S::Scalar::from_f64(from.low.0[l]);
        }
        for i in 0..N {
            path.q[i][0] = from.q.high[i];
            path.v[i][0] = from.v.high[i];
        }
        <S::Wide as Jets<N>>::Orders::run_in_lanes(&self.system, self.rule.order, path, drive, work);
        let weights = weights(&from, self.rtol, &self.atol);
        let mut wanted = length(path, &self.rule, &weights);
        for l in 0..W {
            wanted.0[l] = self.batch.control.limited(false, wanted.0[l]);
        }
        if self.first {
            for l in 0..W {
                wanted.0[l] = self.batch.control.limited(self.begun[l] == self.round, wanted.0[l]);
            }
            self.first = false;
        }
        let mut step = fit(&from, wanted);
        let mut h = Wide::from_f64(0.0);
        for l in 0..W {
            h.0[l] = S::Scalar::from_f64(step.h.0[l]) + S::Scalar::from_f64(step.h_low.0[l]);
        }
        let splitter = Wide::splat(splitter::<S::Scalar>());
        let mut finite = Wide::from_f64(0.0);
        for i in 0..N {
            for (sum, series) in [(&mut self.lanes.q, &path.q[i]), (&mut self.lanes.v, &path.v[i])] {
                sum.add_split_product(i, h, series[1], rest(series, self.rule.order, h), splitter);
                // Times zero, infinity and what is not a number are not zero.
                finite += sum.high[i] * Wide::from_f64(0.0);
            }
        }
        let (mut usual, zero) = (true, S::Scalar::from_f64(0.0));
        for l in 0..W {
            let t = Time::from_words(from.high.0[l], from.low.0[l]) + step.h.0[l];
            (self.lanes.high.0[l], self.lanes.low.0[l]) = (t.to_f64(), t.low());
            step.finite[l] = finite.0[l] == zero;
            usual &= step.finite[l] & !step.close[l] & !step.short[l];
        }
        self.round += 1;
        if !usual || self.deadline <= self.round {
            self.settle(&from, &step);
        }
    }

    /// Ends the motions that have come to an end, and begins others in their lanes.
    #[cold]
    #[inline(never)]
    fn settle(&mut self, before: &Flight<S::Scalar, N>, step: &Step) {
        for l in 0..W {
            let Some(index) = self.problem[l] else { continue };
            let steps = self.round - self.begun[l];
            let from = node(before, l);
            let error = if !step.finite[l] {
                Some(self.not_finite(&from, step, l))
            } else if step.short[l] {
                Some(self.underflow(before, &from, step, l))
            } else {
                None
            };
            let (taken, tried) = if error.is_some() { (steps - 1, steps) } else { (steps, steps) };
            let mut stats = Stats::new(<Taylor as Stepper<S, N>>::NAME);
            (stats.accepted, stats.evaluations) = (taken, tried * self.rule.order as u64);
            let time = self.problems[index].time;
            if error.is_some() {
                self.finish(l, outcome(time, State::from(&from), stats, error));
            } else if step.close[l] {
                (self.lanes.high.0[l], self.lanes.low.0[l]) = (time.1, 0.0);
                self.finish(l, outcome(time, State::from(&node(&self.lanes, l)), stats, None));
            } else if self.batch.max_steps <= steps {
                let to = node(&self.lanes, l);
                let error = Error::MaxSteps { t: to.t.to_f64(), max_steps: self.batch.max_steps };
                self.finish(l, outcome(time, State::from(&to), stats, Some(error)));
            }
        }
        self.fill();
    }

    fn finish(&mut self, l: usize, outcome: Outcome<S::Scalar, N>) {
        if let Some(index) = self.problem[l].take() {
            self.outcomes[index] = Some(outcome);
        }
    }

    /// The error for a step of a lane that led to a number that is not finite.
    fn not_finite(&self, from: &Node<S::Scalar, N>, step: &Step, l: usize) -> Error {
        let (method, start) = (&self.batch.method, from.t);
        let system = &self.problems[self.problem[l].unwrap_or(0)].system;
        let span = if step.close[l] { Span::to(start, self.lanes.end.0[l]) } else { Span::by(start, step.h.0[l]) };
        blame(method, system, &span, from, &Stepper::<S, N>::room(method, system))
    }

    /// The error for a step of a lane that is too short.
    fn underflow(&self, before: &Flight<S::Scalar, N>, from: &Node<S::Scalar, N>, step: &Step, l: usize) -> Error {
        let all = weights(before, self.rtol, &self.atol);
        let one = all.map(|weights| weights.map(|weights| weights.0[l]));
        let mut path = Path::new();
        let k = self.rule.order;
        for i in 0..N {
            path.q[i][k] = self.room.path.q[i][k].0[l];
            path.v[i][k] = self.room.path.v[i][k].0[l];
        }
        let (_, index) = largest(&path, k, &one);
        let coordinate = coordinate(&S::FACTS, index);
        Error::StepSizeUnderflow { t: from.t.to_f64(), step: step.wanted.0[l], coordinate }
    }

    /// Begins motions in all free lanes.
    fn fill(&mut self) {
        let mut changed = false;
        for l in 0..W {
            if self.problem[l].is_some() {
                continue;
            }
            changed = true;
            while self.problem[l].is_none() && self.next < self.problems.len() {
                self.begin(l);
                self.next += 1;
            }
        }
        if changed {
            self.idle();
            let (mut parameters, mut index) = (self.parameters.iter(), 0);
            self.system = self.problems[0].system.widen(|parameter| {
                index += 1;
                parameters.next().copied().unwrap_or(Wide::splat(parameter))
            });
            self.room.work = self.system.work();
        }
        self.deadline = (0..W)
            .filter(|&l| self.problem[l].is_some())
            .map(|l| self.begun[l].saturating_add(self.batch.max_steps))
            .min()
            .unwrap_or(self.round);
    }

    /// Begins the next motion in a lane, unless it fails at once or ends where it begins.
    fn begin(&mut self, l: usize) {
        let problem = &self.problems[self.next];
        let given = State { t: problem.time.0, q: problem.q, v: problem.v };
        let error = match self.batch.begin(problem) {
            Ok(false) => {
                let mut parameters = self.parameters.iter_mut();
                problem.system.map(|parameter| {
                    if let Some(lanes) = parameters.next() {
                        lanes.0[l] = parameter;
                    }
                    parameter
                });
                self.put(l, &Node::new(Time::new(problem.time.0), problem.q, problem.v));
                (self.lanes.end.0[l], self.lanes.live.0[l]) = (problem.time.1, 1.0);
                (self.problem[l], self.begun[l], self.first) = (Some(self.next), self.round, true);
                return;
            }
            Ok(true) => None,
            Err(error) => Some(error),
        };
        let stats = Stats::new(<Taylor as Stepper<S, N>>::NAME);
        self.outcomes[self.next] = Some(outcome(problem.time, given, stats, error));
    }

    /// Gives the lanes that stay free what one stands for that is under way, so that no odd number slows the others down.
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

    fn put(&mut self, l: usize, node: &Node<S::Scalar, N>) {
        (self.lanes.high.0[l], self.lanes.low.0[l]) = (node.t.to_f64(), node.t.low());
        for i in 0..N {
            (self.lanes.q.high[i].0[l], self.lanes.q.low[i].0[l]) = (node.q.high[i], node.q.low[i]);
            (self.lanes.v.high[i].0[l], self.lanes.v.low[i].0[l]) = (node.v.high[i], node.v.low[i]);
        }
    }
}

/// The state in a lane.
fn node<T: Lane + Float, const N: usize>(lanes: &Flight<T, N>, l: usize) -> Node<T, N> {
    let sum = |sum: &Sum<Wide<T>, N>| Sum { high: sum.high.map(|x| x.0[l]), low: sum.low.map(|x| x.0[l]) };
    let t = Time::from_words(lanes.high.0[l], lanes.low.0[l]);
    Node { t, q: sum(&lanes.q), v: sum(&lanes.v), a: None }
}

/// One over the error allowed.
#[inline(always)]
fn weights<T: Lane + Float, const N: usize>(from: &Flight<T, N>, rtol: f64, atol: &[[f64; N]; 2]) -> [[Wide<f64>; N]; 2] {
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

/// The lengths of steps at whose ends the last terms of the series are as large as allowed, as [`Taylor`] finds them.
#[inline(always)]
fn length<T: Lane + Float, const N: usize>(path: &Path<Wide<T>, N>, rule: &Rule, weights: &[[Wide<f64>; N]; 2]) -> Wide<f64> {
    let mut least = Wide::from_f64(f64::INFINITY);
    for told in 0..TELLING {
        if told < rule.order {
            least = nearest(least, radius(path, rule, weights, rule.order - told));
        }
    }
    let mut open = false;
    for l in 0..W {
        open |= least.0[l] == f64::INFINITY;
    }
    let mut wanted = least;
    for l in 0..W {
        wanted.0[l] = coarse_exp2(least.0[l] + rule.margin);
    }
    if open {
        longer(path, rule, weights, least, &mut wanted);
    }
    wanted
}

/// The lanes that the last terms tell nothing listen to those before.
#[cold]
#[inline(never)]
fn longer<T: Lane + Float, const N: usize>(
    path: &Path<Wide<T>, N>,
    rule: &Rule,
    weights: &[[Wide<f64>; N]; 2],
    mut least: Wide<f64>,
    wanted: &mut Wide<f64>,
) {
    let mut open: [bool; W] = least.0.map(|least| least == f64::INFINITY);
    for k in (1..=rule.order.saturating_sub(TELLING)).rev() {
        let radius = radius(path, rule, weights, k);
        for l in 0..W {
            if open[l] && radius.0[l] < f64::INFINITY {
                (least.0[l], open[l]) = (radius.0[l], false);
            }
        }
    }
    for l in 0..W {
        wanted.0[l] = if open[l] { f64::INFINITY } else { coarse_exp2(least.0[l] + rule.margin) };
    }
}

/// log₂ of the radius of convergence, if the coefficients fall like its powers; infinite where all of this order are zero.
#[inline(always)]
fn radius<T: Lane + Float, const N: usize>(
    path: &Path<Wide<T>, N>,
    rule: &Rule,
    weights: &[[Wide<f64>; N]; 2],
    k: usize,
) -> Wide<f64> {
    let mut radius = Wide::<f64>::from_f64(0.0);
    for i in 0..N {
        for (series, weights) in [(&path.q[i], &weights[0]), (&path.v[i], &weights[1])] {
            for l in 0..W {
                let coefficient = series[k].0[l].to_f64().abs() * weights[i].0[l];
                radius.0[l] = if radius.0[l] < coefficient { coefficient } else { radius.0[l] };
            }
        }
    }
    let reciprocal = path.reciprocals.of(k).0[0].to_f64();
    for l in 0..W {
        let told = -(coarse_log2(radius.0[l]) + rule.binary) * reciprocal;
        radius.0[l] = if 0.0 < radius.0[l] { told } else { f64::INFINITY };
    }
    radius
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

/// The steps of these lengths, or what avoids going beyond the end and leaving a sliver before it, as for a single motion; none in idle
/// lanes.
#[inline(always)]
fn fit<T: Lane + Float, const N: usize>(from: &Flight<T, N>, wanted: Wide<f64>) -> Step {
    let zero = Wide::from_f64(0.0);
    let (close, short, finite) = ([false; W], [false; W], [true; W]);
    let mut step = Step { wanted, h: zero, h_low: zero, close, short, finite };
    let mut any = false;
    for l in 0..W {
        let (t, wanted) = (Time::from_words(from.high.0[l], from.low.0[l]), wanted.0[l]);
        let left = -t.since(from.end.0[l]);
        let live = 0.0 < from.live.0[l];
        step.close[l] = live & (left.abs() <= 1.01 * wanted);
        step.short[l] = live & (wanted <= resolution(t)) & (wanted < left.abs());
        let h = if left.abs() < 2.0 * wanted { 0.5 * left } else { wanted.copysign(left) };
        step.h.0[l] = if live { h } else { 0.0 };
        any |= step.close[l];
    }
    if any {
        step.end(&from.high, &from.low, &from.end);
    }
    step
}

impl Step {
    /// Makes the last steps of motions as long as what is left.
    #[cold]
    #[inline(never)]
    fn end(&mut self, high: &Wide<f64>, low: &Wide<f64>, end: &Wide<f64>) {
        for l in 0..W {
            if self.close[l] {
                let span = Span::to(Time::from_words(high.0[l], low.0[l]), end.0[l]);
                (self.h.0[l], self.h_low.0[l]) = (span.h, span.low);
            }
        }
    }
}
