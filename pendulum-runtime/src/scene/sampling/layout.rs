//! The layout of the records of samples.

use crate::motion::{Derivatives, derivatives_of};
use crate::system::{Input, Purpose};

/// The places of the derivatives of each input in a record, which contains the derivatives that a
/// purpose needs in sequence.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    /// The place of the first component, by input and derivative; [`NONE`] if the derivative is not
    /// needed.
    begin: [[usize; 3]; 8],
    /// The number of values in a record.
    pub(crate) width: usize,
}

const NONE: usize = usize::MAX;

impl Layout {
    /// Returns the layout for `inputs` whose numbers of components are `components`.
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

    /// Returns the place of a number in a record; `None` if the record does not contain it.
    #[inline(always)]
    #[allow(clippy::inline_always)]
    pub(crate) fn place(&self, input: usize, derivative: usize, component: usize) -> Option<usize> {
        let begin = self.begin[input][derivative];
        if begin == NONE { None } else { Some(begin + component) }
    }
}
