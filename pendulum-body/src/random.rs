//! A random number generator with the same numbers on every machine.

/// `SplitMix64` (Steele, Lea and Flood 2014), with the constants of Vigna (2015).
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Returns 64 random bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E3779B97F4A7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58476D1CE4E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D049BB133111EB);
        z ^ (z >> 31)
    }

    /// Returns a uniform random number in [0, 1), a multiple of 2⁻⁵³.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / 9007199254740992.0
    }
}

#[cfg(test)]
mod tests {
    use super::Random;

    #[test]
    fn first_numbers_are_those_of_the_reference() {
        // Published with the original Java code, for the seed 1234567.
        let mut random = Random::new(1234567);
        let first = [0; 5].map(|_| random.bits());
        let expected = [
            6457827717110365317,
            3203168211198807973,
            9817491932198370423,
            4593380528125082431,
            16408922859458223821,
        ];
        assert_eq!(first, expected);
    }

    #[test]
    fn units_fill_their_interval() {
        let mut random = Random::new(1);
        let (mut sum, mut square) = (0.0, 0.0);
        for _ in 0..100_000 {
            let unit = random.unit();
            assert!((0.0..1.0).contains(&unit));
            sum += unit;
            square += unit * unit;
        }
        // Four standard errors: √(1/12/N) and √(4/45/N).
        assert!((sum / 1e5 - 0.5).abs() < 4.0 * 0.000913);
        assert!((square / 1e5 - 1.0 / 3.0).abs() < 4.0 * 0.000943);
    }
}
