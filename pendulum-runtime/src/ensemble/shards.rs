//! The division of an ensemble into shards.

use core::ops::Range;

/// The greatest number of members of a shard, unless one is set.
const MOST: usize = 1024;
/// The number of shards that small ensembles are divided into, as far as a shard fills the lanes.
const MANY: usize = 128;
/// The lanes of a batch.
const LANES: usize = 8;

/// The shards of consecutive members: a function of their number alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shards {
    start: usize,
    members: usize,
    size: usize,
}

impl Shards {
    /// Divides the members with these indices.
    pub(super) fn new(members: &Range<usize>, size: Option<usize>) -> Self {
        let count = members.end.saturating_sub(members.start);
        let usual = (count / MANY).next_multiple_of(LANES).clamp(LANES, MOST);
        Self { start: members.start, members: count, size: size.unwrap_or(usual).max(1) }
    }

    /// The number of members.
    pub(super) fn members(&self) -> usize {
        self.members
    }

    /// The number of members of all shards but the last.
    pub(super) fn size(&self) -> usize {
        self.size
    }

    /// The number of shards.
    pub(super) fn count(&self) -> usize {
        self.members.div_ceil(self.size)
    }

    /// The members of a shard.
    pub(super) fn members_of(&self, shard: usize) -> Range<usize> {
        let first = (shard * self.size).min(self.members);
        let last = first.saturating_add(self.size).min(self.members);
        self.start + first..self.start + last
    }

    /// The indices of all members.
    pub(super) fn range(&self) -> Range<usize> {
        self.start..self.start + self.members
    }
}

#[cfg(test)]
mod tests {
    use super::Shards;

    #[test]
    fn every_member_is_in_one_shard() {
        for (start, count) in [(0, 0), (0, 1), (3, 8), (5, 9), (0, 1000), (7, 100_001)] {
            for size in [None, Some(1), Some(13), Some(usize::MAX)] {
                let shards = Shards::new(&(start..start + count), size);
                let mut next = start;
                for shard in 0..shards.count() {
                    let members = shards.members_of(shard);
                    assert!(members.start == next && next < members.end);
                    next = members.end;
                }
                assert_eq!(next, start + count);
            }
        }
    }

    #[test]
    fn shards_fill_lanes_and_are_bounded() {
        let size = |count| Shards::new(&(0..count), None).size();
        assert_eq!([1, 100, 10_000, 1_000_000, 1_000_000_000].map(size), [8, 8, 80, 1024, 1024]);
    }
}
