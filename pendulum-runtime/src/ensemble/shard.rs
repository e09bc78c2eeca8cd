//! Shards: unfinished and finished.

use super::gathered::Tally;
use super::record::Record;
use super::sink::Sink;
use crate::integrate::Outcome;
use core::ops::Range;
use std::collections::BTreeMap;

/// A finished shard, or several joined shards.
pub(super) struct Done<P> {
    pub(super) part: P,
    pub(super) tally: Tally,
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
    /// Joins two consecutive results.
    pub(super) fn join<R, S: Sink<R, Whole = P>>(sink: &S, first: Self, second: Self) -> Self {
        let Self { part, mut tally } = first;
        tally.join(second.tally);
        Self { part: sink.join(part, second.part), tally }
    }
}

impl<P: Record> Done<P> {
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.tally.write(&mut bytes);
        self.part.write(&mut bytes);
        bytes
    }

    pub(super) fn of_bytes(mut bytes: &[u8]) -> Option<Self> {
        let (tally, part) = (Tally::read(&mut bytes)?, P::read(&mut bytes)?);
        bytes.is_empty().then_some(Self { part, tally })
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
