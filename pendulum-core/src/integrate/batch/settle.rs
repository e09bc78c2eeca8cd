//! The ends of steps: outputs, events and kinks, and the steps that `Taylor` takes alone.

#![allow(clippy::inline_always)]
// A branch in a loop over lanes would prevent vector instructions.
#![allow(clippy::needless_bitwise_bool)]

use super::flight::{Wide, endpoint, interval_of};
use super::in_lane::InLane;
use super::kernel::Run;
use super::lengths::reaches;
use super::member::Member;
use super::problem::{Batched, Problem, W};
use crate::error::Error;
use crate::integrate::events::Status;
use crate::integrate::field::inertia::{inertia, varies};
use crate::integrate::state::State;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::stats::Stats;
use crate::integrate::step::held::Held;
use crate::integrate::step::integration::{Integration, cross};
use crate::motion::Side;
use crate::time::Time;

/// The end of a motion: its last state, and its status or error.
type End<T, const N: usize> = (State<T, N>, Result<Status, Error>);

impl<D: Batched<N>, const N: usize> Run<'_, D, N> {
    /// Keeps the records of the lanes `seen`, repeats the steps of the lanes `doubted` with
    /// `Taylor`, ends motions that are complete, and begins others in their lanes. Returns `true`
    /// if the state of a lane has changed.
    #[cold]
    #[inline(never)]
    pub(super) fn settle(&mut self, doubted: Wide<f64>, seen: Wide<f64>) -> bool {
        let (mut moved, mut ended) = (false, false);
        for l in 0..W {
            if self.members[l].is_none() {
                continue;
            }
            let to = endpoint(&self.lanes, l);
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

    /// Returns the state beyond a kink at the end of the step of a lane; `None` if the crossing
    /// fails.
    pub(super) fn beyond(
        &self,
        l: usize,
        to: &Endpoint<D::Scalar, N>,
    ) -> Option<Endpoint<D::Scalar, N>> {
        let system = &self.members[l].as_ref()?.problem.system;
        let (mut beyond, backwards) = (*to, self.onwards.0[l] < 0.0);
        cross(system, &mut beyond, backwards).ok()?;
        if varies(Self::FACTS) {
            let side = if backwards { Side::Before } else { Side::After };
            inertia(&beyond.phase(system, side)).ok()?;
        }
        Some(beyond)
    }

    /// Keeps the records of the step of a lane to `to` and, beyond a kink, to `end`; returns the
    /// end of the motion if it ends.
    pub(super) fn arrive(
        &mut self,
        l: usize,
        to: &Endpoint<D::Scalar, N>,
        mut end: Endpoint<D::Scalar, N>,
        seen: bool,
    ) -> Option<End<D::Scalar, N>> {
        let (member, attempt) = (self.members[l].as_mut()?, &self.attempt);
        let (steps, from) = (self.round - self.begun[l], endpoint(&attempt.from, l));
        let first = steps == 1 && member.stats.accepted == 0;
        let kinked = 0.0 < attempt.kinked.0[l];
        let mut before_kink = kinked.then_some(*to);
        if seen | kinked {
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

    /// Takes the step of a lane by [`Taylor`] instead, and further steps until their series hold.
    /// The series of the step may not have held, or the step may fail.
    pub(super) fn go_alone(&mut self, l: usize) -> Option<End<D::Scalar, N>> {
        // The doubtful step is not counted.
        self.count(l, self.round - self.begun[l] - 1);
        let Member { problem, recorder, detector, a, stats, .. } = self.members[l].as_mut()?;
        let Problem { system, time: (start, end), .. } = &**problem;
        let (start, end) = (*start, *end);
        let mut from = endpoint(&self.attempt.from, l);
        from.a = if stats.accepted + stats.rejected == 0 { *a } else { None };
        let resumed = Integration::resumed(
            Held::borrowed(system),
            self.batch.method.unknown(),
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
                && let Err(error) = integration.check_inertia()
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

    /// Adds this number of steps of a lane to the counters of its motion, and begins a new count.
    pub(super) fn count(&mut self, l: usize, steps: u64) {
        if let Some(Member { stats, .. }) = &mut self.members[l] {
            stats.accepted += steps;
            stats.evaluations += steps * self.rule.order as u64;
        }
        self.begun[l] = self.round;
    }
}
