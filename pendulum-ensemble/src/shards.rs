//! The division of an ensemble into shards.

use core::ops::Range;

/// The greatest number of members of a shard by default.
const MOST: usize = 1024;
/// The number of shards of small ensembles, if each shard fills the lanes of a batch.
const MANY: usize = 128;
/// The number of lanes of a batch.
const LANES: usize = 8;

/// The division of members into shards of consecutive indices. It depends only on the number of
/// members and the size of a shard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shards {
    start: usize,
    members: usize,
    size: usize,
}

impl Shards {
    /// Divides the members with the given indices.
    pub(super) fn new(members: &Range<usize>, size: Option<usize>) -> Self {
        let count = members.end.saturating_sub(members.start);
        let usual = (count / MANY).next_multiple_of(LANES).clamp(LANES, MOST);
        Self { start: members.start, members: count, size: size.unwrap_or(usual).max(1) }
    }

    /// Returns the number of members.
    pub(super) fn members(&self) -> usize {
        self.members
    }

    /// Returns the number of members of each shard except the last.
    pub(super) fn size(&self) -> usize {
        self.size
    }

    /// Returns the number of shards.
    pub(super) fn count(&self) -> usize {
        self.members.div_ceil(self.size)
    }

    /// Returns the indices of the members of a shard.
    pub(super) fn members_of(&self, shard: usize) -> Range<usize> {
        let first = (shard * self.size).min(self.members);
        let last = first.saturating_add(self.size).min(self.members);
        self.start + first..self.start + last
    }

    /// Returns the indices of all members.
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
