//! A small generator: the same starts for every method, on every machine.

/// The generator SplitMix64 of Steele, Lea and Flood (2014).
pub(crate) struct Random(u64);

impl Random {
    /// The generator of one run of one family.
    pub(crate) fn of(family: &str, run: usize) -> Self {
        let seed = family
            .bytes()
            .fold(SEED, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
        let mut random = Self(seed ^ (run as u64).wrapping_mul(0xd134_2543_de82_ef95));
        random.next();
        random
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number between two others.
    pub(crate) fn within(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * ((self.next() >> 11) as f64 / 9_007_199_254_740_992.0)
    }

    /// A number between two others, evenly in its logarithm.
    pub(crate) fn log_within(&mut self, least: f64, most: f64) -> f64 {
        self.within(least.ln(), most.ln()).exp()
    }
}

/// The seed of everything.
const SEED: u64 = 0xcbf2_9ce4_8422_2325;
