//! The cost of a program: its number of operations of each kind.

use super::program::{Op, Program};
use crate::algebra::functions::Function;
use core::fmt;

/// The number of operations of one evaluation, without the operations that depend only on
/// parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Operations {
    /// The number of pairs of sine and cosine of one angle.
    pub sincos: usize,
    /// The number of other functions, including square roots.
    pub functions: usize,
    /// The number of products.
    pub mul: usize,
    /// The number of sums and differences.
    pub add: usize,
    /// The number of quotients.
    pub div: usize,
}

/// Writes the nonzero counts in words: `2 sine–cosine pairs, 1 division`.
impl fmt::Display for Operations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = [
            (self.sincos, "sine–cosine pair"),
            (self.functions, "other function"),
            (self.mul, "multiplication"),
            (self.add, "addition"),
            (self.div, "division"),
        ];
        let mut before = "";
        for (number, what) in rows.into_iter().filter(|&(number, _)| 0 < number) {
            write!(f, "{before}{number} {what}{}", if number == 1 { "" } else { "s" })?;
            before = ", ";
        }
        if before.is_empty() { f.write_str("no operation") } else { Ok(()) }
    }
}

/// The cost of a function, in multiplications.
const FUNCTION: usize = 20;

impl Program {
    /// Returns the cost of one evaluation in multiplications, without the operations that depend
    /// only on parameters.
    pub(crate) fn cost(&self) -> usize {
        let Operations { sincos, functions, mul, add, div } = self.count();
        mul + add + 4 * div + FUNCTION * (sincos + functions)
    }

    /// Returns the operations of one evaluation, without those that depend only on parameters.
    pub(crate) fn count(&self) -> Operations {
        let mut count = Operations::default();
        let ops = self.ops.iter().zip(self.parameter_only());
        for (op, _) in ops.filter(|(_, parameter_only)| !parameter_only) {
            match op {
                Op::SinCos(_) | Op::Call(Function::Sin | Function::Cos, _) => count.sincos += 1,
                Op::Mul(..) => count.mul += 1,
                Op::Add(..) | Op::Sub(..) => count.add += 1,
                Op::Div(..) => count.div += 1,
                Op::Sqrt(_) | Op::Powf(..) | Op::Atan2(..) | Op::Max(..) | Op::Call(..) => {
                    count.functions += 1;
                }
                Op::Number(_) | Op::Literal(_) | Op::Pi | Op::Load(_) => {}
                Op::Negative(_) | Op::Part(..) => {}
            }
        }
        count
    }
}
