//! The random numbers: the same starts for every method and on every machine.

/// The generator of all tools, with a seed for each run.
pub(crate) struct Random(systems::random::Random);

impl Random {
    /// Creates the generator of a run of a family.
    pub(crate) fn of(family: &str, run: usize) -> Self {
        let seed = family
            .bytes()
            .fold(SEED, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
        let seed = seed ^ (run as u64).wrapping_mul(0xd134_2543_de82_ef95);
        let mut random = Self(systems::random::Random::new(seed));
        random.0.bits();
        random
    }

    /// Returns a uniformly distributed number between two numbers.
    pub(crate) fn within(&mut self, least: f64, most: f64) -> f64 {
        self.0.uniform(least, most)
    }

    /// Returns a number between two numbers whose logarithm is uniformly distributed.
    pub(crate) fn log_within(&mut self, least: f64, most: f64) -> f64 {
        self.within(least.ln(), most.ln()).exp()
    }
}

/// The common seed.
const SEED: u64 = 0xcbf2_9ce4_8422_2325;
