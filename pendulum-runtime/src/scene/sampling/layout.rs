//! Places of numbers in the records of samples.

use crate::motion::{Derivatives, derivatives_of};
use crate::system::{Input, Purpose};

/// Places of the derivatives of each input in a record that holds those that a purpose needs, one
/// after the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    /// By input and derivative; [`NONE`] if it is not needed.
    begin: [[usize; 3]; 8],
    /// The numbers in a record.
    pub(crate) width: usize,
}

const NONE: usize = usize::MAX;

impl Layout {
    /// The layout for `inputs` with so many `components` each.
    pub(crate) const fn new(inputs: &[Input], components: &[usize], purpose: Purpose) -> Self {
        let (mut begin, mut width, mut input) = ([[NONE; 3]; 8], 0, 0);
        while input < components.len() {
            let needed = derivatives_of(inputs, input, purpose);
            let mut derivative = 0;
            while derivative < 3 {
                if needed.contains(Derivatives::of(derivative)) {
                    begin[input][derivative] = width;
                    width += components[input];
                }
                derivative += 1;
            }
            input += 1;
        }
        Self { begin, width }
    }

    /// The place of a number in a record, if it is there.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    pub(crate) fn place(&self, input: usize, derivative: usize, component: usize) -> Option<usize> {
        let begin = self.begin[input][derivative];
        if begin == NONE { None } else { Some(begin + component) }
    }
}
