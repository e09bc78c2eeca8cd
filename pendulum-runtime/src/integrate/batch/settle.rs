//! The ends of steps: outputs, events and kinks, and the steps that `Taylor` takes alone.

#![allow(clippy::inline_always)]
// A branch in a loop over lanes would take the lanes apart.
#![allow(clippy::needless_bitwise_bool)]

use super::flight::{Attempt, Wide, interval_of, length_of, node};
use super::in_lane::InLane;
use super::kernel::Run;
use super::lengths::reaches;
use super::member::Member;
use super::problem::{Batched, Problem, W};
use crate::error::Error;
use crate::integrate::events::Status;
use crate::integrate::events::detector::{POINTS, Place};
use crate::integrate::output::Output;
use crate::integrate::solution::Stats;
use crate::integrate::state::State;
use crate::integrate::step::endpoint::Endpoint;
use crate::integrate::step::held::Held;
use crate::integrate::step::inertia::{inertia, varies};
use crate::integrate::step::integration::{Integration, cross};
use crate::jet::{Known, LENGTH};
use crate::motion::Side;
use crate::scalar::Real;
use crate::system::scalar_time;
use crate::time::Time;

/// The end of a motion: its last state, and how it has come to it.
type End<T, const N: usize> = (State<T, N>, Result<Status, Error>);

/// The indices of those of [`POINTS`] that are no ends of a step.
const INNER: [usize; POINTS.len() - 2] = [0, 2, 3, 4, 5, 6, 7, 8, 9];

/// The coordinates and velocities of all lanes at several points of their steps.
type Places<T, const N: usize> = [[[Wide<T>; N]; 2]; POINTS.len()];

impl<D: Batched<N>, const N: usize, const WATCHED: bool> Run<'_, D, N, WATCHED> {
    /// Finds the lanes in whose steps something is to be kept: an output time, an event. They are
    /// not zero.
    #[inline(always)]
    pub(super) fn watch(&mut self, doubted: Wide<f64>) -> Wide<f64> {
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
    pub(super) fn places(&self) -> Places<D::Scalar, N> {
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
    pub(super) fn is_quiet(&mut self, l: usize, places: &Places<D::Scalar, N>) -> bool {
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
    pub(super) fn settle(&mut self, doubted: Wide<f64>, seen: Wide<f64>) -> bool {
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
            inertia(system, beyond.t, side, &beyond.q.high, &beyond.v.high).ok()?;
        }
        Some(beyond)
    }

    /// Looks at the step of a lane to `to`, and over a kink there to `end`: what is to be kept, and
    /// if the motion ends.
    pub(super) fn arrive(
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
    pub(super) fn go_alone(&mut self, l: usize) -> Option<End<D::Scalar, N>> {
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
    pub(super) fn count(&mut self, l: usize, steps: u64) {
        if let Some(Member { stats, .. }) = &mut self.members[l] {
            stats.accepted += steps;
            stats.evaluations += steps * self.rule.order as u64;
        }
        self.begun[l] = self.round;
    }
}
