//! The data that an integration passes from one step to the next, for saved integrations.

use super::Integration;
use crate::integrate::field::contacts::has_contacts;
use crate::integrate::method::Method;
use crate::integrate::state::saved::Memory;
use crate::integrate::stats::{ConstraintStats, Extreme, Stats};
use crate::integrate::step::controller::ControllerState;
use crate::scalar::Float;
use crate::system::{Constraint, Dynamics, System};

impl<const N: usize, D, M, C> Integration<'_, N, D, M, C>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    /// Visits all data that one step passes to the next. The last step and its interpolant are not
    /// included; reading resets them.
    pub(crate) fn remember(&mut self, memory: &mut Memory) {
        memory.endpoint(&mut self.end);
        let end = self.end;
        memory.maybe(&mut self.before_kink, || end, Memory::endpoint);
        let Stats { evaluations, accepted, rejected, kinks, .. } = &mut self.stats;
        for count in [evaluations, accepted, rejected, kinks] {
            memory.word(count);
        }
        self.remember_constraints(memory);
        let ControllerState { h, left, equal, target, error, unknown, reach, ahead } =
            &mut self.state;
        memory.word(left);
        for number in [h, equal, target, error, unknown, reach, ahead, &mut self.kink] {
            memory.number(number);
        }
        memory.flag(&mut self.backwards);
        if const { has_contacts::<D, N>() } {
            memory.flag(&mut self.crossed);
            self.limits.remember(memory);
        }
        self.method.remember(&mut self.workspace, memory);
        if memory.reads() {
            (self.last, self.interpolant, self.from) = (None, None, self.end);
            self.straight = false;
        }
    }

    /// Visits the statistics of the constraints.
    fn remember_constraints(&mut self, memory: &mut Memory) {
        let constraints = <D::System as System<N>>::FACTS.constraints;
        let Some(first) = constraints.first() else { return };
        self.gradients.remember(memory);
        let none = Extreme { value: 0.0, t: 0.0, constraint: first.name };
        let empty = || ConstraintStats { independence: none, misfit: none };
        memory.maybe(&mut self.stats.constraints, empty, |memory, stats| {
            for extreme in [&mut stats.independence, &mut stats.misfit] {
                memory.number(&mut extreme.value);
                memory.number(&mut extreme.t);
                let named = |own: &Constraint| own.name == extreme.constraint;
                let mut index = constraints.iter().position(named).unwrap_or(0);
                memory.count(&mut index, constraints.len() - 1);
                extreme.constraint = constraints[index].name;
            }
        });
    }
}
