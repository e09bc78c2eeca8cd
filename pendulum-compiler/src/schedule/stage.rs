//! Stages of a program: values that depend on parameters, on time and inputs, on the position, and
//! on velocities.

use super::program::{Op, Place, Program, operands};
use crate::algebra::expr::Symbol;

/// The values that an operation depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Stage {
    Numbers,
    Parameters,
    /// Time and driven inputs without parameters. These values are the same for all systems on a
    /// joint.
    Time,
    Position,
    Velocity,
}

impl Stage {
    /// Returns the stage of an operation with operands of two stages.
    fn with(self, other: Self) -> Self {
        match self.max(other) {
            Stage::Time if self.min(other) == Stage::Parameters => Stage::Position,
            later => later,
        }
    }
}

impl Program {
    /// Returns for each operation whether it depends only on parameters and numbers.
    pub(crate) fn parameter_only(&self) -> Vec<bool> {
        self.stages().into_iter().map(|stage| stage <= Stage::Parameters).collect()
    }

    /// Returns the earliest stage in which each operation can be computed.
    fn stages(&self) -> Vec<Stage> {
        let mut stages: Vec<Stage> = Vec::with_capacity(self.ops.len());
        for op in &self.ops {
            let own = match op {
                Op::Load(symbol) => match symbol {
                    Symbol::Parameter(_) | Symbol::Moment(..) => Stage::Parameters,
                    Symbol::Time | Symbol::Input { .. } => Stage::Time,
                    Symbol::Coordinate(_) | Symbol::Entry(..) => Stage::Position,
                    // A control input may depend on the state.
                    Symbol::Velocity(_)
                    | Symbol::Control { .. }
                    | Symbol::Acceleration(_)
                    | Symbol::Multiplier(_)
                    | Symbol::Contact(_)
                    | Symbol::Friction(_)
                    | Symbol::Target(_)
                    | Symbol::Momentum(_)
                    | Symbol::Auxiliary(_)
                    | Symbol::Position(_)
                    | Symbol::Point(..) => Stage::Velocity,
                },
                _ => operands(op)
                    .iter()
                    .map(|place| stages[place.0])
                    .fold(Stage::Numbers, Stage::with),
            };
            stages.push(own);
        }
        stages
    }

    /// Returns the places to be stored: those computed in a stage and read in another stage or as
    /// results.
    pub(crate) fn kept(&self, stage: Stage) -> Vec<Place> {
        let stages = self.stages();
        let before = |own: Stage| own == Stage::Numbers || own == stage;
        let mut read = vec![false; self.ops.len()];
        for (op, _) in self.ops.iter().zip(&stages).filter(|&(_, &own)| !before(own)) {
            for place in operands(op) {
                read[place.0] = true;
            }
        }
        for result in &self.results {
            read[result.0] = true;
        }
        let worth = |index: &usize| {
            let leaf = match self.ops[*index] {
                Op::Load(symbol) => !matches!(symbol, Symbol::Moment(..)),
                Op::Number(_) | Op::Literal(_) | Op::Pi => true,
                // The parts of a pair are stored instead of the pair.
                Op::SinCos(_) => true,
                _ => false,
            };
            let own = stages[*index];
            (own == stage || own == Stage::Numbers && stage == Stage::Parameters)
                && read[*index]
                && !leaf
        };
        (0..self.ops.len()).filter(worth).map(Place).collect()
    }
}
