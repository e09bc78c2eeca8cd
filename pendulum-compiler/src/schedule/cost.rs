//! What a program costs: its operations of each kind.

use super::{Op, Program};
use crate::algebra::expr::Function;

/// How many of each operation a program has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Count {
    pub(crate) sincos: usize,
    pub(crate) functions: usize,
    pub(crate) mul: usize,
    pub(crate) add: usize,
    pub(crate) div: usize,
}

impl Count {
    /// What the operations cost, in multiplications.
    pub(crate) fn cost(self) -> usize {
        self.mul + self.add + 4 * self.div + 20 * (self.sincos + self.functions)
    }
}

impl Program {
    /// The operations of one evaluation, after what parameters alone decide has been prepared.
    pub(crate) fn count(&self) -> Count {
        let mut count = Count::default();
        let parameter_only = self.parameter_only();
        for (op, _) in
            self.ops.iter().zip(parameter_only).filter(|(_, parameter_only)| !parameter_only)
        {
            match op {
                Op::SinCos(_) | Op::Call(Function::Sin | Function::Cos, _) => count.sincos += 1,
                Op::Mul(..) => count.mul += 1,
                Op::Add(..) | Op::Sub(..) => count.add += 1,
                Op::Div(..) => count.div += 1,
                Op::Sqrt(_) | Op::Powf(..) | Op::Atan2(..) | Op::Max(..) | Op::Call(..) => {
                    count.functions += 1;
                }
                Op::Number(_)
                | Op::Literal(_)
                | Op::Pi
                | Op::Load(_)
                | Op::Negative(_)
                | Op::Part(..) => {}
            }
        }
        count
    }
}
