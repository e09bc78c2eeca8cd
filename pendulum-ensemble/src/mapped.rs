//! Mapped ensembles, and the loop over their shards.

use super::checkpoint::{Checkpoint, Folder};
use super::error::EnsembleError;
use super::fold::{Fold, Indexed};
use super::gathered::{Gathered, Progress, Tally};
use super::record::{Codec, Record, hash};
use super::shard::{Done, Open};
use super::shards::Shards;
use super::team::{Desk, Team};
use super::threads;
use super::tree::Tree;
use super::way::Way;
use core::any::type_name;
use core::cell::RefCell;
use core::fmt;
use core::marker::PhantomData;
use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use pendulum_core::integrate::members::Settings;
use pendulum_core::integrate::{Outcome, Problem, Solution};
use pendulum_core::scalar::{Float, Real};
use pendulum_core::system::{Dynamics, System};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// A function that observes the progress and can cancel the run.
type Look<'a> = dyn FnMut(&Progress) -> ControlFlow<()> + Send + 'a;

/// An [`Ensemble`](super::Ensemble) with a function that maps each solution to a value. `P` is the
/// reduction of a shard, which the last call determines.
#[must_use = "nothing is integrated before `reduce`, `fold`, `collect` or `for_each`"]
pub struct Mapped<'a, const N: usize, D: Dynamics<N>, G, W, C, F, P> {
    work: Work<'a, N, D, G, W, C, F>,
    look: Option<Box<Look<'a>>>,
    folder: Option<Folder<P>>,
    tag: String,
    /// The index of the part to solve, and the number of parts.
    part: (usize, usize),
}

/// The description of the work, shared by all threads.
struct Work<'a, const N: usize, D: Dynamics<N>, G, W, C, F> {
    shards: Shards,
    problem: G,
    way: W,
    settings: Settings<'a, D::Scalar, N, C>,
    map: F,
    dynamics: PhantomData<fn() -> D>,
}

/// The maximum number of problems that are included in the description of the settings.
const PROBES: usize = 64;

/// The mutable state shared by all threads.
struct Shared<'a> {
    next: AtomicUsize,
    part: (usize, usize),
    error: Mutex<Option<EnsembleError>>,
    cancelled: AtomicBool,
    progress: Mutex<(Progress, Option<Box<Look<'a>>>)>,
    /// The number of finished shards of the part to solve.
    own: AtomicUsize,
}

impl<'a, const N: usize, D: Dynamics<N>, G, W, C, F, P> Mapped<'a, N, D, G, W, C, F, P> {
    pub(super) fn new(
        shards: Shards,
        problem: G,
        way: W,
        settings: Settings<'a, D::Scalar, N, C>,
        map: F,
    ) -> Self {
        let work = Work { shards, problem, way, settings, map, dynamics: PhantomData };
        Self { work, look: None, folder: None, tag: String::new(), part: (0, 1) }
    }

    /// Writes every finished shard to a file in `folder`, which is created if it does not exist. An
    /// interrupted run loses only unfinished shards: the next run with the same settings reads the
    /// files and continues, with the same bits in the result.
    ///
    /// A file is written under another name, synchronized to disk and then renamed. It contains a
    /// checksum, and damaged files count as missing. A folder of a run with other settings is an
    /// error. The settings are those of the ensemble, the system, the type of the reduced value,
    /// and up to 64 of the problems. They do not include functions, motions and controllers, which
    /// can be identified by a [`tag`](Self::tag).
    ///
    /// Values must implement [`Record`].
    pub fn checkpoint(mut self, folder: impl Into<PathBuf>) -> Self
    where
        P: Record,
    {
        self.folder = Some(Folder { path: folder.into(), codec: Codec::new() });
        self
    }

    /// Adds a text to the settings of the [checkpoint](Self::checkpoint), for example a version of
    /// the mapped function.
    pub fn tag(mut self, tag: impl Into<String>) -> Self {
        self.tag = tag.into();
        self
    }

    /// Solves only the shards `index`, `index + of`, `index + 2 of`, …, for several processes that
    /// share the folder of a [checkpoint](Self::checkpoint), such as jobs of a cluster. Finished
    /// shards of other parts are read from the folder; all others are
    /// [`missing`](Gathered::missing). A final run without this call joins all shards.
    pub fn part(mut self, index: usize, of: usize) -> Self {
        self.part = (index, of);
        self
    }

    /// Calls `look` after each finished shard, to report progress or to cancel. After
    /// [`ControlFlow::Break`], no further member is started.
    pub fn on_progress(
        mut self,
        look: impl FnMut(&Progress) -> ControlFlow<()> + Send + 'a,
    ) -> Self {
        self.look = Some(Box::new(look));
        self
    }
}

impl<const N: usize, D, G, W, C, F, R, P> Mapped<'_, N, D, G, W, C, F, P>
where
    D: Dynamics<N, Scalar: Float>,
    G: Fn(usize) -> Problem<D, N> + Sync,
    W: Way<D, C, N>,
    C: Sync + fmt::Debug,
    F: Fn(usize, &Solution<D::Scalar, N>) -> R + Sync,
    R: Send,
    P: Send,
{
    /// Reduces values of the type `R` to parts of another type, as [`reduce`](Self::reduce): `add`
    /// adds a member to the part of the preceding members of its shard, and `merge` joins two
    /// parts.
    ///
    /// # Errors
    /// Returns the errors of [`reduce`](Self::reduce).
    pub fn fold(
        self,
        identity: impl Fn() -> P + Sync,
        add: impl Fn(P, R) -> P + Sync,
        merge: impl Fn(P, P) -> P + Sync,
    ) -> Result<Gathered<P>, EnsembleError> {
        let add = |part, _, value| add(part, value);
        self.gather(&Fold { identity: &identity, add: &add, merge: &merge }, None, |part| part)
    }

    /// Computes [`fold`](Self::fold) together with the other processes of a [`Team`]. Each process
    /// calls this method with the same ensemble. The root gets the value, with the same bits as a
    /// single process; the other processes get `None`.
    ///
    /// With a checkpoint, all processes share its folder.
    ///
    /// # Errors
    /// Returns the errors of [`fold`](Self::fold) in the process in which they occur. The value of
    /// the root then includes only finished shards.
    pub fn fold_in(
        self,
        team: &impl Team,
        identity: impl Fn() -> P + Sync,
        add: impl Fn(P, R) -> P + Sync,
        merge: impl Fn(P, P) -> P + Sync,
    ) -> Result<Option<Gathered<P>>, EnsembleError>
    where
        P: Record,
    {
        let add = |part, _, value| add(part, value);
        let fold = Fold { identity: &identity, add: &add, merge: &merge };
        let gathered = self.gather(&fold, Some((team, Codec::new())), |part| part)?;
        Ok(team.is_root().then_some(gathered))
    }

    /// Solves and reduces all members, alone or with a team. `settle` gets the part of each shard
    /// before it is joined with others.
    fn gather(
        self,
        fold: &Fold<'_, P, R>,
        team: Option<(&dyn Team, Codec<P>)>,
        settle: impl Fn(P) -> P + Sync,
    ) -> Result<Gathered<P>, EnsembleError> {
        let Self { work, look, folder, tag, part } = self;
        let (index, parts) = part;
        let shards = work.shards;
        work.way.check(&work.settings)?;
        if parts <= index {
            return Err(EnsembleError::Part { index, parts });
        }
        let checkpoint = Checkpoint::open(folder, || work.describe::<P>(&tag))?;
        let shared = Shared::new(&shards, look, part);
        let tree = Tree::new(shards.count());
        let join = |first: Done<P>, second: Done<P>| first.join(second, fold.merge);
        let keep = |shard: usize, done: Done<P>| {
            shared.advance(shard, &done.tally);
            tree.add(shard, Done { part: settle(done.part), ..done }, join);
        };
        let away =
            team.filter(|(team, _)| !team.is_root()).map(|(team, codec)| (team.desk(), codec));
        let give = |shard: usize, done: Done<P>| match away {
            Some((desk, codec)) => desk.send(shard, done.to_bytes(codec)),
            None => keep(shard, done),
        };
        let desk = team.map(|(team, _)| team.desk());
        let solve = || {
            let mut take = || {
                while !shared.is_cancelled() {
                    let shard = match desk {
                        Some(desk) => desk.take()?,
                        None => shared.next.fetch_add(1, Ordering::Relaxed),
                    };
                    if shards.count() <= shard {
                        return None;
                    }
                    match checkpoint.read(shard) {
                        Ok(Some(done)) => give(shard, done),
                        Ok(None) if shared.owns(shard) => return Some(shard),
                        Ok(None) => {}
                        Err(error) => shared.fail(error),
                    }
                }
                None
            };
            let mut write = |shard, done: Done<P>| match checkpoint.write(shard, &done) {
                Ok(()) => give(shard, done),
                Err(error) => shared.fail(error),
            };
            work.solve(fold, &mut take, &|| shared.is_cancelled(), &mut write);
        };
        match team {
            None => threads::on_all(shards.count(), solve),
            Some((team, codec)) => std::thread::scope(|scope| {
                let desk = team.desk();
                scope.spawn(move || {
                    let _finish = Finish(desk);
                    threads::on_all(shards.count(), solve);
                });
                team.serve(&mut |shard, bytes| {
                    if let Some(done) = Done::of_bytes(bytes, codec) {
                        keep(shard, done);
                    }
                });
            }),
        }
        let done = tree.finish(join);
        let Done { part: value, tally, resumed } =
            done.unwrap_or_else(|| Done::new(settle((fold.identity)())));
        let Shared { error, progress, cancelled, own, .. } = shared;
        if let Some(error) = error.into_inner().unwrap_or_else(PoisonError::into_inner) {
            return Err(error);
        }
        let (progress, _) = progress.into_inner().unwrap_or_else(PoisonError::into_inner);
        let missing = shards.count() - progress.shards;
        if missing == 0 {
            checkpoint.tidy();
        }
        // Another process of a team may have cancelled its work.
        let all_own = shards.count().saturating_sub(index).div_ceil(parts);
        let cancelled = 0 < missing && (cancelled.into_inner() || own.into_inner() < all_own);
        Ok(Gathered { value, tally, cancelled, resumed, missing })
    }
}

impl<const N: usize, D, G, W, C, F, R> Mapped<'_, N, D, G, W, C, F, R>
where
    D: Dynamics<N, Scalar: Float>,
    G: Fn(usize) -> Problem<D, N> + Sync,
    W: Way<D, C, N>,
    C: Sync + fmt::Debug,
    F: Fn(usize, &Solution<D::Scalar, N>) -> R + Sync,
    R: Send,
{
    /// Solves all members and merges their values in a binary tree over the index. The tree depends
    /// only on the number of members and the size of the shards. `identity` returns the value of an
    /// empty ensemble.
    ///
    /// # Errors
    /// Returns an error if a setting is out of its range, or if the checkpoint cannot be read or
    /// written or belongs to other settings.
    pub fn reduce(
        self,
        identity: impl Fn() -> R + Sync,
        merge: impl Fn(R, R) -> R + Sync,
    ) -> Result<Gathered<R>, EnsembleError> {
        self.fold(identity, &merge, &merge)
    }
}

impl<const N: usize, D, G, W, C, F, R> Mapped<'_, N, D, G, W, C, F, Indexed<R>>
where
    D: Dynamics<N, Scalar: Float>,
    G: Fn(usize) -> Problem<D, N> + Sync,
    W: Way<D, C, N>,
    C: Sync + fmt::Debug,
    F: Fn(usize, &Solution<D::Scalar, N>) -> R + Sync,
    R: Send,
{
    /// Solves all members and returns the list of their values by index. Failed members, and
    /// members of shards that were unfinished when the run was cancelled, have no value.
    ///
    /// # Errors
    /// Returns the errors of [`reduce`](Mapped::reduce).
    pub fn collect(self) -> Result<Gathered<Vec<Option<R>>>, EnsembleError> {
        let range = self.work.shards.range();
        let gathered = self.list(|part| part)?;
        Ok(gathered.map(|members| {
            let mut list = Vec::new();
            list.resize_with(range.len(), || None);
            for (index, member) in members {
                list[index - range.start] = Some(member);
            }
            list
        }))
    }

    /// Solves all members and passes their indices and values to `take`, one shard at a time, as
    /// the shards finish. Members of a shard are passed in order. Failed members are omitted.
    ///
    /// With several threads the order of the shards can vary between runs.
    ///
    /// # Errors
    /// Returns the errors of [`reduce`](Mapped::reduce).
    pub fn for_each(
        self,
        take: impl FnMut(usize, R) + Send,
    ) -> Result<Gathered<()>, EnsembleError> {
        let take = Mutex::new(take);
        let gathered = self.list(|part| {
            let mut take = take.lock().unwrap_or_else(PoisonError::into_inner);
            for (index, value) in part {
                take(index, value);
            }
            Vec::new()
        })?;
        Ok(gathered.map(|_| ()))
    }

    /// Gathers the indices and values of the members that were solved.
    fn list(
        self,
        settle: impl Fn(Indexed<R>) -> Indexed<R> + Sync,
    ) -> Result<Gathered<Indexed<R>>, EnsembleError> {
        let add = |mut part: Indexed<R>, index, value| {
            part.push((index, value));
            part
        };
        let merge = |mut first: Indexed<R>, second| {
            first.extend(second);
            first
        };
        self.gather(&Fold { identity: &Vec::new, add: &add, merge: &merge }, None, settle)
    }
}

impl<const N: usize, D, G, W, C, F, R> Work<'_, N, D, G, W, C, F>
where
    D: Dynamics<N, Scalar: Float>,
    G: Fn(usize) -> Problem<D, N> + Sync,
    W: Way<D, C, N>,
    F: Fn(usize, &Solution<D::Scalar, N>) -> R + Sync,
{
    /// Returns the settings that determine the bits of the result, one per line.
    fn describe<P>(&self, tag: &str) -> String
    where
        C: fmt::Debug,
    {
        let facts = &<D::System as System<N>>::FACTS;
        let Settings { controller, output, dense, stops, events, max_steps } = &self.settings;
        let range = self.shards.range();
        let mut bytes = Vec::new();
        let problems = range.len().min(PROBES);
        for probe in 0..problems {
            // The probes are spread over all members, including the first and the last.
            let place = if probe == 0 { 0 } else { probe * (range.len() - 1) / (problems - 1) };
            let Problem { system, time, q, v } = (self.problem)(range.start + place);
            let mut add = |number: D::Scalar| {
                let high = number.to_f64();
                (high, (number - D::Scalar::from_f64(high)).to_f64()).write(&mut bytes);
                number
            };
            system.system().map(&mut add);
            q.into_iter().chain(v).for_each(|number| {
                add(number);
            });
            time.write(&mut bytes);
        }
        [
            format!("version = {}", env!("CARGO_PKG_VERSION")),
            format!("tag = {tag:?}"),
            format!(
                "system = {} with {N} coordinates over {}",
                facts.name,
                type_name::<D::Scalar>()
            ),
            format!("equations = {:016x}", hash(facts.equations.as_bytes())),
            format!("members = {range:?}"),
            format!("shard = {}", self.shards.size()),
            format!("problems = {:016x}", hash(&bytes)),
            format!("method = {}", self.way.name(&self.settings)),
            format!("steps = {controller:?}, at most {max_steps}"),
            format!("output = {output:?}, dense {dense}, stops {stops:?}"),
            format!("events = {events:?}"),
            format!("value = {}", type_name::<P>()),
        ]
        .map(|line| line + "\n")
        .concat()
    }

    /// Solves shards on one thread: `take` returns the next shard, and `give` receives each
    /// finished shard. If `stop` returns `true`, no further member is started.
    fn solve<P>(
        &self,
        fold: &Fold<'_, P, R>,
        take: &mut dyn FnMut() -> Option<usize>,
        stop: &dyn Fn() -> bool,
        give: &mut dyn FnMut(usize, Done<P>),
    ) {
        let open: RefCell<VecDeque<Open<R, P>>> = RefCell::new(VecDeque::new());
        let mut members = 0..0;
        let mut next = || {
            if members.is_empty() {
                let shard = take()?;
                members = self.shards.members_of(shard);
                let open_shard = Open::new(shard, members.clone(), (fold.identity)());
                open.borrow_mut().push_back(open_shard);
            }
            let index = if stop() { None } else { members.next() };
            index.map(|index| (index, (self.problem)(index)))
        };
        let mut ended = |index: usize, outcome: Outcome<D::Scalar, N>| {
            let value = outcome.as_ref().ok().map(|solution| (self.map)(index, solution));
            let mut open = open.borrow_mut();
            let Some(place) = open.iter().position(|open| open.members.contains(&index)) else {
                return;
            };
            if open[place].add(fold, index, value, &outcome)
                && let Some(Open { shard, part: Some(part), tally, .. }) = open.remove(place)
            {
                drop(open);
                give(shard, Done { part, tally, resumed: 0 });
            }
        };
        self.way.solve_all(&self.settings, &mut next, &mut ended);
    }
}

/// Calls [`Desk::finish`] when it is dropped, including during a panic.
struct Finish<'t>(&'t dyn Desk);

impl Drop for Finish<'_> {
    fn drop(&mut self) {
        self.0.finish();
    }
}

impl<'a> Shared<'a> {
    fn new(shards: &Shards, look: Option<Box<Look<'a>>>, part: (usize, usize)) -> Self {
        let progress = Progress {
            members: 0,
            failed: 0,
            total: shards.members() as u64,
            shards: 0,
            total_shards: shards.count(),
        };
        Self {
            next: AtomicUsize::new(0),
            part,
            error: Mutex::new(None),
            cancelled: AtomicBool::new(false),
            progress: Mutex::new((progress, look)),
            own: AtomicUsize::new(0),
        }
    }

    /// Returns `true` if the shard belongs to the part to solve.
    fn owns(&self, shard: usize) -> bool {
        shard % self.part.1 == self.part.0
    }

    /// Cancels the run because of `error`.
    fn fail(&self, error: EnsembleError) {
        let mut first = self.error.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert(error);
        self.cancelled.store(true, Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Adds a finished shard to the progress and calls the observer.
    fn advance(&self, shard: usize, tally: &Tally) {
        self.own.fetch_add(usize::from(self.owns(shard)), Ordering::Relaxed);
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

impl<const N: usize, D, G, W, C, F, P> fmt::Debug for Mapped<'_, N, D, G, W, C, F, P>
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
