//! A hash of 64-bit words.

/// The hash FNV-1a of Fowler, Noll and Vo over words of 64 bits, with a final mixing of the bits.
pub(crate) struct Hash(u64);

impl Hash {
    pub(crate) fn new() -> Self {
        Self(0xcbf29ce484222325)
    }

    pub(crate) fn add(&mut self, word: u64) {
        // Without the shifted word and the rotation, high bits would not influence low bits.
        self.0 = (self.0 ^ word ^ (word >> 32)).wrapping_mul(0x100000001b3).rotate_left(23);
    }

    pub(crate) fn value(&self) -> u64 {
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58476d1ce4e5b9);
        mixed ^ (mixed >> 31)
    }
}
