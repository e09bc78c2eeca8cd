//! The steps of the lanes: series, lengths, and checks of the ends.
//!
//! The work of every step is inlined into the code that [`simd`](crate::simd) compiles for several
//! instruction sets. The work at the beginning and the end of motions is not.

#![allow(clippy::inline_always)]
// A branch in a loop over lanes would prevent vector instructions.
#![allow(clippy::needless_bitwise_bool)]

use super::flight::{Attempt, Flight, Wide, endpoint, interval_of, length_of};
use super::lengths::{UNTOLD, any, fit, is_short, lengths, log_radii, longer, reaches, weights};
use super::member::{Member, Recording};
use super::problem::{Batched, Outcomes, Problems, W, WideOf};
use super::settings::Batch;
use crate::integrate::field::inertia::{inertia, is_due, varies};
use crate::integrate::methods::taylor::{Ends, GAP, MISFIT, Rule, rest};
use crate::integrate::state::compensated::{Compensated, splitter};
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::controller::ControllerState;
use crate::integrate::step::short::shortest;
use crate::integrate::times::precedes;
use crate::jet::{InputSeries, Jets, LENGTH, Path, Unrolling};
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::simd::Work;
use crate::system::{Facts, LaneSystem, System, Table, tables};
use crate::time::Time;

/// A batch during its integration.
pub(super) struct Run<'a, D: Batched<N>, const N: usize> {
    pub(super) batch: &'a Batch<N>,
    /// The records to keep of each motion, in addition to its end.
    pub(super) recording: Recording<'a, D::Scalar, N>,
    /// `true` if there are such records.
    records: bool,
    /// The source of the problems and their indices.
    pub(super) problems: &'a mut Problems<'a, D, N>,
    /// The receiver of the outcomes.
    pub(super) outcomes: &'a mut Outcomes<'a, D::Scalar, N>,
    /// `true` if there are no more problems.
    pub(super) exhausted: bool,
    pub(super) rule: Rule,
    /// The absolute tolerances of coordinates and velocities.
    pub(super) atol: [[f64; N]; 2],
    /// The relative tolerance.
    pub(super) rtol: f64,
    /// The tables of all lanes.
    pub(super) tables: Vec<Table>,
    /// The parameters of all lanes.
    pub(super) parameters: Vec<Wide<D::Scalar>>,
    pub(super) system: WideOf<D, N>,
    pub(super) workspace: Box<Workspace<D, N>>,
    pub(super) lanes: Flight<D::Scalar, N>,
    /// The steps that have led to the states in `lanes`.
    pub(super) attempt: Attempt<D::Scalar, N>,
    /// `true` if the ends of these steps have not been checked yet.
    pub(super) attempted: bool,
    /// The motion in each lane; `None` for idle lanes.
    pub(super) members: [Option<Member<'a, D, N>>; W],
    /// The next output time of each lane.
    pub(super) output: Wide<f64>,
    /// The direction of time in each lane: 1 or −1.
    pub(super) onwards: Wide<f64>,
    /// For each lane, the round before the first step that the counters of its motion do not
    /// include.
    pub(super) begun: [u64; W],
    /// The number of rounds so far; each round takes one step in every lane.
    pub(super) round: u64,
    /// The round after which a motion has taken all steps allowed.
    pub(super) deadline: u64,
    /// `true` if a lane takes its first step, which has a limited length.
    pub(super) first: bool,
}

/// The workspace of the jets.
pub(super) struct Workspace<D: Batched<N>, const N: usize> {
    pub(super) path: Path<Wide<D::Scalar>, N>,
    /// The states and accelerations at which the next steps start.
    pub(super) ahead: Path<Wide<D::Scalar>, N>,
    pub(super) drive: <WideOf<D, N> as Jets<N>>::Drive,
    /// The series of the driven inputs of one motion.
    pub(super) own: <D::System as Jets<N>>::Drive,
    /// `true` for lanes whose series of driven inputs belong to their current time.
    pub(super) driven: [bool; W],
    pub(super) work: <WideOf<D, N> as Jets<N>>::Work,
}

/// The loop over all steps of a batch.
pub(super) struct Steps<'r, 'a, D: Batched<N>, const N: usize>(pub(super) &'r mut Run<'a, D, N>);

impl<D: Batched<N>, const N: usize> Work for Steps<'_, '_, D, N> {
    #[inline(always)]
    fn run(self) {
        while self.0.attempted | (self.0.round < self.0.deadline) {
            self.0.step();
        }
    }
}

impl<'a, D: Batched<N>, const N: usize> Run<'a, D, N> {
    pub(super) const FACTS: &'static Facts = &<D::System as System<N>>::FACTS;

    /// Begins the first motions in the lanes; returns `None` without problems.
    pub(super) fn new(
        batch: &'a Batch<N>,
        recording: Recording<'a, D::Scalar, N>,
        problems: &'a mut Problems<'a, D, N>,
        outcomes: &'a mut Outcomes<'a, D::Scalar, N>,
    ) -> Option<Self> {
        let zero = Wide::from_f64(0.0);
        let first = problems()?;
        let mut parameters = Vec::new();
        let system = first.1.system.system().widen(|parameter| {
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
            recording,
            records: recording.is_any(),
            problems,
            outcomes,
            exhausted: false,
            rule: batch.rule::<D>(),
            atol: [atol.0, atol.1],
            rtol,
            tables: tables(first.1.system.system()),
            parameters,
            workspace: Box::new(Workspace {
                path: Path::new(),
                ahead: Path::new(),
                drive: WideOf::<D, N>::drive(),
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

    /// Checks the ends of the last steps, and takes one more step in every lane if the check
    /// succeeds everywhere.
    ///
    /// The accelerations at the ends are the first coefficients of the next series.
    #[inline(always)]
    fn step(&mut self) {
        self.look_ahead();
        if self.attempted {
            let doubted = self.doubted();
            let seen = if self.records { self.detect(doubted) } else { Wide::from_f64(0.0) };
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
        let (system, order) = (&self.system, self.rule.order);
        <WideOf<D, N> as Jets<N>>::Unrolling::run_in_lanes(system, order, path, drive, work);
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

    /// Computes the accelerations at the states of all lanes, which begin their series.
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
        <WideOf<D, N> as Jets<N>>::Unrolling::begin_in_lanes(&self.system, ahead, drive, work);
    }

    /// Computes the series of the driven inputs in all lanes, each at its own time.
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

    /// Returns a number other than zero for each lane with a doubtful step. The criterion is that
    /// of [`Taylor`]: the series do not give the accelerations at the end.
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
        if varies(Self::FACTS) {
            for l in 0..W {
                doubted.0[l] += self.lacks_inertia(l);
            }
        }
        doubted
    }

    /// Returns 1 if the mass matrix at the end of the step of a lane is due to be checked, as in a
    /// single motion, and not positive; otherwise 0. `Taylor` then reports the error.
    fn lacks_inertia(&self, l: usize) -> f64 {
        let Some(member) = &self.members[l] else { return 0.0 };
        let accepted = member.stats.accepted + (self.round - self.begun[l]);
        let is_last = self.lanes.high.0[l] == member.problem.time.1;
        if !is_last && !is_due::<D::System, N>(accepted, false) {
            return 0.0;
        }
        let to = endpoint(&self.lanes, l);
        let side = if self.onwards.0[l] < 0.0 { Side::Before } else { Side::After };
        let checked = inertia(&to.phase(&member.problem.system, side));
        if checked.is_err() { 1.0 } else { 0.0 }
    }

    /// Returns `true` if the difference of the accelerations at the end of the step of a lane is no
    /// larger than rounding errors explain.
    #[cold]
    #[inline(never)]
    fn holds(&self, l: usize) -> bool {
        let Workspace { path, ahead, .. } = &*self.workspace;
        let (Some(Member { problem, .. }), to) = (&self.members[l], endpoint(&self.lanes, l))
        else {
            return true;
        };
        let end = if self.attempt.kinked.0[l] == 0.0 {
            core::array::from_fn(|i| ahead.a[i][0].0[l])
        } else {
            // `ahead` contains the accelerations beyond the kink.
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

    /// Limits the length of a step of a lane by the settings, and by the time scales of functions
    /// of time and motions; returns 0 if a motion returns an invalid time scale.
    #[inline(always)]
    fn limited(&self, l: usize, first: bool, wanted: f64) -> f64 {
        let wanted = self.batch.control.limited(first, wanted);
        if const { !Self::FACTS.explicit_time && Self::FACTS.inputs.is_empty() } {
            return wanted;
        }
        let Some(Member { problem, .. }) = &self.members[l] else { return wanted };
        let (start, end) = problem.time;
        let t = self.attempt.start(l);
        // `Taylor` returns the error for the motion.
        let limited =
            ControllerState::over(end - start).within_sight(wanted, &problem.system, t, GAP);
        limited.unwrap_or(0.0)
    }

    /// Moves all lanes to the ends of steps of the lengths `h`, in two words.
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
                let rest = rest(series, self.rule.order, length);
                sum.add_split_product(i, length, series[1], rest, splitter);
                // The product of zero and infinity or NaN is not zero.
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

    /// Takes steps of which some are first or last ones, too short, or of a length that the last
    /// terms do not determine.
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
                    // `Taylor` returns the error for a kink that is not in order.
                    self.attempt.doubted.0[l] = 1.0;
                }
            } else if is_short::<D::Scalar>(t, end, wanted.0[l]) {
                self.attempt.doubted.0[l] = 1.0;
            }
            let left = t.since(end).abs();
            if left == 0.0 || left < shortest::<D::Scalar>() {
                // The scalar cannot represent the length of this step, or a break or kink is not in
                // order.
                self.attempt.doubted.0[l] = 1.0;
            }
        }
    }
}
