//! Stages of a program: values that depend on parameters, on time and inputs, on the position, and
//! on velocities.

use super::program::{Op, Place, Program, operands};
use crate::algebra::expr::{Dependencies, Symbol};

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
            let latest = |own: Stage| {
                operands(op).iter().map(|place| stages[place.0]).fold(own, Stage::with)
            };
            let own = match op {
                Op::Load(symbol) => {
                    let kind = Dependencies::of(*symbol);
                    let early = [
                        (Dependencies::PARAMETER, Stage::Parameters),
                        // A control input may depend on the state.
                        (Dependencies::CONTROL, Stage::Velocity),
                        (Dependencies::TIME.or(Dependencies::INPUT), Stage::Time),
                        (Dependencies::COORDINATE, Stage::Position),
                    ];
                    let stage = early.into_iter().find(|(kinds, _)| kind.any(*kinds));
                    stage.map_or(Stage::Velocity, |(_, stage)| stage)
                }
                Op::Call(function, _) if function.is_given() => latest(Stage::Parameters),
                _ => latest(Stage::Numbers),
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
