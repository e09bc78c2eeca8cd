//! A mapped ensemble, and the loop through its shards.

use super::error::EnsembleError;
use super::gathered::{Gathered, Progress, Tally};
use super::shards::Shards;
use super::sink::{Each, Fold, List, Sink};
use super::threads;
use super::tree::Tree;
use super::way::Way;
use crate::integrate::settings::Settings;
use crate::integrate::{Outcome, Problem, Solution};
use crate::scalar::Float;
use crate::system::Dynamics;
use core::cell::RefCell;
use core::fmt;
use core::marker::PhantomData;
use core::ops::{ControlFlow, Range};
use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::collections::{BTreeMap, VecDeque};
use std::sync::{Mutex, PoisonError};

/// A function that looks on.
type Look<'a> = dyn FnMut(&Progress) -> ControlFlow<()> + Send + 'a;

/// An [`Ensemble`](super::Ensemble) and what is wanted of each solution.
#[must_use = "nothing is integrated before `reduce`, `fold`, `collect` or `for_each`"]
pub struct Mapped<'a, const N: usize, D: Dynamics<N>, G, W, C, F> {
    work: Work<'a, N, D, G, W, C, F>,
    look: Option<Box<Look<'a>>>,
}

/// What all threads share of it.
struct Work<'a, const N: usize, D: Dynamics<N>, G, W, C, F> {
    shards: Shards,
    problem: G,
    way: W,
    settings: Settings<'a, D::Scalar, N, C>,
    map: F,
    dynamics: PhantomData<fn() -> D>,
}

/// A finished shard, or several that are joined.
pub(super) struct Done<P> {
    pub(super) part: P,
    pub(super) tally: Tally,
}

/// A shard of which members are under way.
struct Open<R, P> {
    shard: usize,
    members: Range<usize>,
    /// The member that is to be added next.
    next: usize,
    /// The values of members behind it.
    ahead: BTreeMap<usize, Option<R>>,
    part: Option<P>,
    tally: Tally,
}

/// What is shared between threads.
struct Shared<'a> {
    next: AtomicUsize,
    shards: usize,
    cancelled: AtomicBool,
    progress: Mutex<(Progress, Option<Box<Look<'a>>>)>,
}

impl<'a, const N: usize, D: Dynamics<N>, G, W, C, F> Mapped<'a, N, D, G, W, C, F> {
    pub(super) fn new(
        shards: Shards,
        problem: G,
        way: W,
        settings: Settings<'a, D::Scalar, N, C>,
        map: F,
    ) -> Self {
        let work = Work { shards, problem, way, settings, map, dynamics: PhantomData };
        Self { work, look: None }
    }

    /// Looks on whenever a shard is finished: for progress, and to cancel. On
    /// [`ControlFlow::Break`] no further member is begun.
    pub fn on_progress(
        mut self,
        look: impl FnMut(&Progress) -> ControlFlow<()> + Send + 'a,
    ) -> Self {
        self.look = Some(Box::new(look));
        self
    }
}

impl<const N: usize, D, G, W, C, F, R> Mapped<'_, N, D, G, W, C, F>
where
    D: Dynamics<N, Scalar: Float>,
    G: Fn(usize) -> Problem<D, N> + Sync,
    W: Way<D, C, N>,
    C: Sync,
    F: Fn(usize, &Solution<D::Scalar, N>) -> R + Sync,
    R: Send,
{
    /// Solves all members and merges what they are mapped to, in a binary tree over the index that
    /// depends on the number of members alone; `identity` gives the value of no member.
    ///
    /// # Errors
    /// A setting that is out of its range.
    pub fn reduce(
        self,
        identity: impl Fn() -> R + Sync,
        merge: impl Fn(R, R) -> R + Sync,
    ) -> Result<Gathered<R>, EnsembleError> {
        self.gather(&Fold { identity, add: &merge, merge: &merge })
    }

    /// The same where the parts are of another type than the members: `add` adds a member to the
    /// part of those before it in its shard, `merge` joins two parts.
    ///
    /// # Errors
    /// As [`reduce`](Self::reduce).
    pub fn fold<P: Send>(
        self,
        identity: impl Fn() -> P + Sync,
        add: impl Fn(P, R) -> P + Sync,
        merge: impl Fn(P, P) -> P + Sync,
    ) -> Result<Gathered<P>, EnsembleError> {
        self.gather(&Fold { identity, add, merge })
    }

    /// Solves all members and lists what they are mapped to by their index; those that have failed
    /// have no value, and neither have those of shards that were not finished before it was
    /// cancelled.
    ///
    /// # Errors
    /// As [`reduce`](Self::reduce).
    pub fn collect(self) -> Result<Gathered<Vec<Option<R>>>, EnsembleError> {
        let range = self.work.shards.range();
        let Gathered { value, tally, cancelled, resumed } = self.gather(&List)?;
        let mut list = Vec::new();
        list.resize_with(range.len(), || None);
        for (index, member) in value {
            list[index - range.start] = Some(member);
        }
        Ok(Gathered { value: list, tally, cancelled, resumed })
    }

    /// Solves all members and gives what they are mapped to, with their indices, to `take`: shard
    /// after shard as they are finished, one at a time, and in order within each. Members that have
    /// failed are left out.
    ///
    /// With several threads the order of the shards is not always the same.
    ///
    /// # Errors
    /// As [`reduce`](Self::reduce).
    pub fn for_each(
        self,
        take: impl FnMut(usize, R) + Send,
    ) -> Result<Gathered<()>, EnsembleError> {
        let take = Mutex::new(take);
        self.gather(&Each { take })
    }

    /// Solves and reduces all members.
    fn gather<S: Sink<R>>(self, sink: &S) -> Result<Gathered<S::Whole>, EnsembleError> {
        let Self { work, look } = self;
        let shards = work.shards;
        work.way.check(&work.settings)?;
        let shared = Shared::new(&shards, look);
        let tree = Tree::new(shards.count());
        let join = |first: Done<_>, second: Done<_>| Done::join(sink, first, second);
        threads::on_all(shards.count(), || {
            work.solve(sink, &shared, &mut |shard, done| {
                let Done { part, tally } = done;
                shared.advance(&tally);
                let done = Done { part: sink.settle(part), tally };
                tree.add(shard, done, join);
            });
        });
        let done = tree.finish(join);
        let (value, tally) = done.map_or_else(
            || (sink.settle(sink.empty()), Tally::default()),
            |done| (done.part, done.tally),
        );
        Ok(Gathered { value, tally, cancelled: shared.is_cancelled(), resumed: 0 })
    }
}

impl<const N: usize, D, G, W, C, F, R> Work<'_, N, D, G, W, C, F>
where
    D: Dynamics<N, Scalar: Float>,
    G: Fn(usize) -> Problem<D, N> + Sync,
    W: Way<D, C, N>,
    F: Fn(usize, &Solution<D::Scalar, N>) -> R + Sync,
{
    /// Solves shards until there are no more, and gives each to `give` when it is finished: the work
    /// of one thread.
    fn solve<S: Sink<R>>(
        &self,
        sink: &S,
        shared: &Shared<'_>,
        give: &mut dyn FnMut(usize, Done<S::Part>),
    ) {
        let open: RefCell<VecDeque<Open<R, S::Part>>> = RefCell::new(VecDeque::new());
        let mut members = 0..0;
        let mut next = || {
            if members.is_empty() {
                let shard = shared.take()?;
                members = self.shards.members_of(shard);
                let open_shard = Open::new(shard, members.clone(), sink.empty());
                open.borrow_mut().push_back(open_shard);
            }
            let index = if shared.is_cancelled() { None } else { members.next() };
            index.map(|index| (index, (self.problem)(index)))
        };
        let mut ended = |index: usize, outcome: Outcome<D::Scalar, N>| {
            let value = outcome.as_ref().ok().map(|solution| (self.map)(index, solution));
            let mut open = open.borrow_mut();
            let Some(place) = open.iter().position(|open| open.members.contains(&index)) else {
                return;
            };
            if open[place].add(sink, index, value, &outcome)
                && let Some(Open { shard, part: Some(part), tally, .. }) = open.remove(place)
            {
                drop(open);
                give(shard, Done { part, tally });
            }
        };
        self.way.solve_all(&self.settings, &mut next, &mut ended);
    }
}

impl<P> Done<P> {
    /// Joins two in a row.
    fn join<R, S: Sink<R, Whole = P>>(sink: &S, first: Self, second: Self) -> Self {
        let Self { part, mut tally } = first;
        tally.join(second.tally);
        Self { part: sink.join(part, second.part), tally }
    }
}

impl<R, P> Open<R, P> {
    fn new(shard: usize, members: Range<usize>, part: P) -> Self {
        let (next, ahead) = (members.start, BTreeMap::new());
        Self { shard, members, next, ahead, part: Some(part), tally: Tally::default() }
    }

    /// Adds a member and those behind it that have waited for it; returns true if all are there.
    fn add<T, const N: usize>(
        &mut self,
        sink: &impl Sink<R, Part = P>,
        index: usize,
        value: Option<R>,
        outcome: &Outcome<T, N>,
    ) -> bool {
        self.tally.add(index, outcome);
        self.ahead.insert(index, value);
        while let Some(value) = self.ahead.remove(&self.next) {
            self.part = self.part.take().map(|part| sink.add(part, self.next, value));
            self.next += 1;
        }
        self.next == self.members.end
    }
}

impl<'a> Shared<'a> {
    fn new(shards: &Shards, look: Option<Box<Look<'a>>>) -> Self {
        let progress = Progress {
            members: 0,
            failed: 0,
            total: shards.members() as u64,
            shards: 0,
            total_shards: shards.count(),
        };
        Self {
            next: AtomicUsize::new(0),
            shards: shards.count(),
            cancelled: AtomicBool::new(false),
            progress: Mutex::new((progress, look)),
        }
    }

    /// The next shard that nobody has begun.
    fn take(&self) -> Option<usize> {
        let shard = self.next.fetch_add(1, Ordering::Relaxed);
        (shard < self.shards && !self.is_cancelled()).then_some(shard)
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Takes note of a finished shard.
    fn advance(&self, tally: &Tally) {
        let mut guard = self.progress.lock().unwrap_or_else(PoisonError::into_inner);
        let (progress, look) = &mut *guard;
        progress.members += tally.members;
        progress.failed += tally.failed;
        progress.shards += 1;
        if let Some(look) = look
            && look(progress).is_break()
        {
            self.cancelled.store(true, Ordering::Relaxed);
        }
    }
}

impl<const N: usize, D, G, W, C, F> fmt::Debug for Mapped<'_, N, D, G, W, C, F>
where
    D: Dynamics<N>,
    W: fmt::Debug,
    C: fmt::Debug,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Work { shards, way, settings, .. } = &self.work;
        let mut mapped = f.debug_struct("Mapped");
        mapped.field("shards", shards).field("way", way).field("settings", settings);
        mapped.finish_non_exhaustive()
    }
}
