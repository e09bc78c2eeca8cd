//! The state of an integration between two steps, saved bit by bit.

use crate::integrate::state::compensated::Compensated;
use crate::integrate::state::endpoint::Endpoint;
use crate::scalar::Float;
use crate::time::Time;

/// An integration saved between two steps by
/// [`Integrator::save`](crate::integrate::Integrator::save). It contains all bits of the state, and
/// of the data that methods, controllers and events pass from step to step.
///
/// With the feature `serde` it can be serialized. The numbers are words of 64 bits, so that no
/// format rounds them.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Saved {
    pub(crate) system: String,
    pub(crate) method: String,
    pub(crate) words: Vec<u64>,
}

/// A visitor of all numbers that one step passes to the next. It either saves the numbers or
/// restores them.
#[derive(Debug)]
pub struct Memory {
    words: Vec<u64>,
    /// The index of the next word to read; `None` while writing.
    next: Option<usize>,
    failed: bool,
}

impl Memory {
    pub(crate) fn writer() -> Self {
        Self { words: Vec::new(), next: None, failed: false }
    }

    pub(crate) fn reader(words: Vec<u64>) -> Self {
        Self { words, next: Some(0), failed: false }
    }

    /// Returns the words written.
    pub(crate) fn into_words(self) -> Vec<u64> {
        self.words
    }

    /// Returns `true` if all words have been read without a failure.
    pub(crate) fn is_complete(&self) -> bool {
        !self.failed && self.next == Some(self.words.len())
    }

    /// Returns `true` if the visitor restores numbers.
    pub fn reads(&self) -> bool {
        self.next.is_some()
    }

    /// Visits a word of 64 bits.
    pub fn word(&mut self, word: &mut u64) {
        let Some(next) = self.next else { return self.words.push(*word) };
        match self.words.get(next) {
            Some(read) => (*word, self.next) = (*read, Some(next + 1)),
            None => self.failed = true,
        }
    }

    /// Visits a number bit for bit.
    pub fn number(&mut self, number: &mut f64) {
        let mut word = number.to_bits();
        self.word(&mut word);
        *number = f64::from_bits(word);
    }

    /// Visits a count of at most `most`; a greater count is a failure.
    pub fn count(&mut self, count: &mut usize, most: usize) {
        let mut word = *count as u64;
        self.word(&mut word);
        match usize::try_from(word) {
            Ok(read) if read <= most => *count = read,
            _ => self.failed = true,
        }
    }

    /// Visits a boolean.
    pub fn flag(&mut self, flag: &mut bool) {
        let mut word = usize::from(*flag);
        self.count(&mut word, 1);
        *flag = word == 1;
    }

    /// Visits a scalar, with both words.
    pub fn scalar<T: Float>(&mut self, scalar: &mut T) {
        let mut high = scalar.to_f64();
        // An infinite number has no low word.
        let mut low = if high.is_finite() { (*scalar - T::from_f64(high)).to_f64() } else { 0.0 };
        self.number(&mut high);
        if T::EPSILON.to_f64() < f64::EPSILON {
            self.number(&mut low);
        }
        if self.reads() {
            *scalar = T::from_f64(high);
            // Adding 0 to −0 would change its sign.
            if low != 0.0 {
                *scalar += T::from_f64(low);
            }
        }
    }

    /// Visits scalars.
    pub fn scalars<T: Float>(&mut self, scalars: &mut [T]) {
        for scalar in scalars {
            self.scalar(scalar);
        }
    }

    /// Visits a time, with both words.
    pub fn time(&mut self, time: &mut Time) {
        let (mut high, mut low) = (time.to_f64(), time.low());
        self.number(&mut high);
        self.number(&mut low);
        *time = Time::from_words(high, low);
    }

    /// Visits sums, with their low words.
    pub fn sums<T: Float, const N: usize>(&mut self, sums: &mut Compensated<T, N>) {
        self.scalars(&mut sums.high);
        self.scalars(&mut sums.low);
    }

    /// Visits an optional value; `empty` creates a value that `visit` overwrites.
    pub fn maybe<X>(
        &mut self,
        value: &mut Option<X>,
        empty: impl FnOnce() -> X,
        visit: impl FnOnce(&mut Self, &mut X),
    ) {
        let mut some = value.is_some();
        self.flag(&mut some);
        if some {
            visit(self, value.get_or_insert_with(empty));
        } else {
            *value = None;
        }
    }

    /// Visits the state at one end of a step.
    pub fn endpoint<T: Float, const N: usize>(&mut self, end: &mut Endpoint<T, N>) {
        self.time(&mut end.t);
        self.sums(&mut end.q);
        self.sums(&mut end.v);
        let zero = [T::from_f64(0.0); N];
        self.maybe(&mut end.a, || zero, |memory, a| memory.scalars(a));
    }
}

#[cfg(test)]
mod tests {
    use super::Memory;
    use crate::scalar::{DoubleDouble, Real};
    use crate::time::Time;

    #[test]
    fn every_bit_comes_back() {
        let third = DoubleDouble::ratio(1.0, 3.0);
        let mut there = (-0.0_f64, f32::MIN_POSITIVE, third, Time::new(1e9) + 1e-9, Some(7_u64));
        let visit = |memory: &mut Memory,
                     values: &mut (f64, f32, DoubleDouble, Time, Option<u64>)| {
            memory.scalar(&mut values.0);
            memory.scalar(&mut values.1);
            memory.scalar(&mut values.2);
            memory.time(&mut values.3);
            memory.maybe(&mut values.4, || 0, Memory::word);
        };
        let mut writer = Memory::writer();
        visit(&mut writer, &mut there);
        let words = writer.into_words();
        let mut back = (1.0, 1.0, DoubleDouble::from(1.0), Time::new(0.0), None);
        let mut reader = Memory::reader(words.clone());
        visit(&mut reader, &mut back);
        assert!(reader.is_complete());
        assert_eq!(back, there);
        assert!(back.0.is_sign_negative());
        // Missing words, and surplus words.
        for words in [words[..words.len() - 1].to_vec(), [&words[..], &[0]].concat()] {
            let mut reader = Memory::reader(words);
            visit(&mut reader, &mut back);
            assert!(!reader.is_complete());
        }
    }
}
