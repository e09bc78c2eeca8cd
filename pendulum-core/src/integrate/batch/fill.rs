//! The start of motions in free lanes, and their outcomes.

use super::flight::{Wide, endpoint};
use super::in_lane::InLane;
use super::kernel::Run;
use super::member::{Member, Recording};
use super::problem::{Batched, Posed, W};
use crate::error::Error;
use crate::integrate::events::Status;
use crate::integrate::events::detector::EventDetector;
use crate::integrate::method::Method;
use crate::integrate::methods::taylor::Taylor;
use crate::integrate::output::Recorder;
use crate::integrate::state::State;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::stats::Stats;
use crate::integrate::times::direction;
use crate::jet::Jets;
use crate::system::{LaneSystem, System, tables};
use crate::time::Time;

impl<'a, D: Batched<N>, const N: usize> Run<'a, D, N> {
    /// Passes on the outcome of the motion in a lane, and frees the lane.
    pub(super) fn finish(
        &mut self,
        l: usize,
        end: State<D::Scalar, N>,
        outcome: Result<Status, Error>,
    ) {
        self.count(l, self.round - self.begun[l]);
        let Some(Member { index, recorder, stats, .. }) = self.members[l].take() else { return };
        let outcome = match outcome {
            Err(error) => Err(recorder.fail(error, end, 0, stats)),
            Ok(status) => Ok(recorder.finish(end, 0, status, stats)),
        };
        (self.outcomes)(index, outcome);
    }

    /// Begins motions in all free lanes.
    pub(super) fn fill(&mut self) {
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
            self.system =
                member.problem.system.system().widen(|parameter| {
                    parameters.next().copied().unwrap_or(Wide::splat(parameter))
                });
            self.workspace.work = self.system.work();
        }
        self.set_deadline();
    }

    /// Computes the round after which a motion has taken all steps allowed.
    pub(super) fn set_deadline(&mut self) {
        let left = |l: usize| {
            let Stats { accepted, rejected, .. } = self.members[l].as_ref()?.stats;
            Some(
                self.begun[l]
                    .saturating_add(self.batch.max_steps.saturating_sub(accepted + rejected)),
            )
        };
        self.deadline = (0..W).filter_map(left).min().unwrap_or(self.round);
    }

    /// Begins a motion in a lane, unless it fails at once or has an interval of zero length.
    pub(super) fn begin(&mut self, l: usize, (index, problem): (usize, Posed<'a, D, N>)) {
        let Recording { output, dense, events } = self.recording;
        let (time, start) =
            (problem.time, Endpoint::new(Time::new(problem.time.0), problem.q, problem.v));
        let mut detector = EventDetector::new(events);
        let (rtol, (q, v)) = self.batch.control.tolerances::<D::Scalar>();
        detector.accuracy = Some((rtol, [q, v]));
        let mut member = Member {
            index,
            recorder: Recorder::new(output, time, Self::FACTS, None),
            detector,
            problem,
            a: None,
            stats: Stats::new(<Taylor<false> as Method<D, N>>::NAME),
        };
        let begun = self.batch.begin(&member.problem, &output).and_then(|ends| {
            if tables(member.problem.system.system()) != self.tables {
                return Err(Error::OtherTables);
            }
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

    /// Copies the numbers of an active lane into free lanes, so that no special values slow down
    /// the other lanes.
    pub(super) fn idle(&mut self) {
        let Some(model) = self.members.iter().position(Option::is_some) else { return };
        for l in 0..W {
            if self.members[l].is_none() {
                self.put(l, &endpoint(&self.lanes, model));
                self.lanes.live.0[l] = 0.0;
                self.lanes.end.0[l] = self.lanes.end.0[model];
                for parameter in &mut self.parameters {
                    parameter.0[l] = parameter.0[model];
                }
            }
        }
    }

    pub(super) fn put(&mut self, l: usize, endpoint: &Endpoint<D::Scalar, N>) {
        self.workspace.driven[l] = false;
        (self.lanes.high.0[l], self.lanes.low.0[l]) = (endpoint.t.to_f64(), endpoint.t.low());
        for i in 0..N {
            (self.lanes.q.high[i].0[l], self.lanes.q.low[i].0[l]) =
                (endpoint.q.high[i], endpoint.q.low[i]);
            (self.lanes.v.high[i].0[l], self.lanes.v.low[i].0[l]) =
                (endpoint.v.high[i], endpoint.v.low[i]);
        }
    }
}
