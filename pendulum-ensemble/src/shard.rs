//! Shards: unfinished and finished.

use super::fold::Fold;
use super::gathered::Tally;
use super::record::{Codec, Record};
use core::ops::Range;
use pendulum_core::integrate::Outcome;
use std::collections::BTreeMap;

/// A finished shard, or several joined shards.
pub(super) struct Done<P> {
    pub(super) part: P,
    pub(super) tally: Tally,
    /// The number of shards that were read from a checkpoint.
    pub(super) resumed: usize,
}

/// An unfinished shard.
pub(super) struct Open<R, P> {
    pub(super) shard: usize,
    pub(super) members: Range<usize>,
    /// The index of the next member to add to the part.
    pub(super) next: usize,
    /// The values of finished members after `next`.
    pub(super) ahead: BTreeMap<usize, Option<R>>,
    pub(super) part: Option<P>,
    pub(super) tally: Tally,
}

impl<P> Done<P> {
    /// Creates a result without members.
    pub(super) fn new(part: P) -> Self {
        Self { part, tally: Tally::default(), resumed: 0 }
    }

    /// Joins two consecutive results.
    pub(super) fn join(self, second: Self, merge: impl Fn(P, P) -> P) -> Self {
        let Self { part, mut tally, resumed } = self;
        tally.join(second.tally);
        Self { part: merge(part, second.part), tally, resumed: resumed + second.resumed }
    }

    /// Returns the bytes for the root of a team.
    pub(super) fn to_bytes(&self, codec: Codec<P>) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.resumed.write(&mut bytes);
        self.tally.write(&mut bytes);
        (codec.write)(&self.part, &mut bytes);
        bytes
    }

    /// Reads what [`to_bytes`](Self::to_bytes) returned.
    pub(super) fn of_bytes(mut bytes: &[u8], codec: Codec<P>) -> Option<Self> {
        let (resumed, tally) = Record::read(&mut bytes)?;
        let part = (codec.read)(&mut bytes)?;
        bytes.is_empty().then_some(Self { part, tally, resumed })
    }
}

impl<R, P> Open<R, P> {
    pub(super) fn new(shard: usize, members: Range<usize>, part: P) -> Self {
        let (next, ahead) = (members.start, BTreeMap::new());
        Self { shard, members, next, ahead, part: Some(part), tally: Tally::default() }
    }

    /// Adds a finished member, and later members that have waited for it. Returns `true` if all
    /// members are finished.
    pub(super) fn add<T, const N: usize>(
        &mut self,
        fold: &Fold<'_, P, R>,
        index: usize,
        value: Option<R>,
        outcome: &Outcome<T, N>,
    ) -> bool {
        self.tally.add(index, outcome);
        self.ahead.insert(index, value);
        while let Some(value) = self.ahead.remove(&self.next) {
            // A failed member has no value.
            if let Some(value) = value {
                self.part = self.part.take().map(|part| (fold.add)(part, self.next, value));
            }
            self.next += 1;
        }
        self.next == self.members.end
    }
}
