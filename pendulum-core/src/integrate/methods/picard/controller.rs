//! The lengths of adaptive steps of Picard iteration.

use super::lanes::LaneDynamics;
use super::tableau::S;
use super::workspace::{AIM, DETOUR};
use super::{Picard, inherited, iterate, tableau};
use crate::error::Error;
use crate::integrate::method::{self, Method};
use crate::integrate::methods::dop853::Dop853;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::adaptive::AdaptiveStep;
use crate::integrate::step::controller::{
    Controller, ControllerState, StepContext, StepLaw, Trial, Verdict,
};
use crate::integrate::step::fast_exp2::{log2, power};
use crate::scalar::Float;
use crate::system::is_constrained;
use crate::time::Time;

/// The error below which the next step may become longer: `AIM` / 1.25¹⁵.
const LOW: f64 = AIM * 0.0352;
/// The error above which the next step becomes shorter: `AIM` / 0.86¹⁵.
const HIGH: f64 = AIM * 9.6;
/// The number of sweeps above which the next step does not become longer.
const MANY: u32 = 4;
/// The number of sweeps above which the next step becomes shorter.
const TOO_MANY: u32 = 9;
/// The number of rejected attempts after which `Dop853` takes a step under constraints.
const PATIENCE: u32 = 2;

impl<D: LaneDynamics<N>, const N: usize> Controller<Picard, D, N> for AdaptiveStep<N> {
    fn check(&self) -> Result<(), Error> {
        self.positive::<D::Scalar>()
    }

    fn accuracy(&self) -> Option<(f64, [[f64; N]; 2])> {
        let (relative, (q, v)) = self.tolerances::<D::Scalar>();
        Some((relative, [q, v]))
    }

    fn least_steps(&self, length: f64) -> f64 {
        self.least_steps_over(length)
    }

    #[inline]
    fn step(
        &self,
        state: &mut ControllerState,
        context: StepContext<'_, '_, D, Picard, N>,
    ) -> Result<StepInterval, Error> {
        self.take_step(state, context)
    }
}

impl<D: LaneDynamics<N>, const N: usize> StepLaw<Picard, D, N> for AdaptiveStep<N> {
    #[inline(always)]
    fn propose(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, Picard, N>,
    ) -> Result<Trial, Error> {
        let (dynamics, t) = (context.field.dynamics, context.from.t);
        if context.target < t.to_f64() {
            if let Some(time) = dynamics.break_before(t.to_f64())
                && context.target < time
            {
                context.target = time;
            }
        } else if let Some(time) = dynamics.next_break(t.to_f64())
            && time < context.target
        {
            if time <= t.to_f64() {
                return Err(Error::Kink { t: t.to_f64(), kink: time });
            }
            context.target = time;
        }
        if state.h == 0.0 {
            state.h = self.limited(true, self.automatic_step(2 * S as u32, context)?);
        }
        let wanted = self.limited(false, state.h);
        Ok(Trial::new(state.within_sight(wanted, dynamics, t, tableau::GAP)?, context.target))
    }

    #[inline(always)]
    fn interval(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, Picard, N>,
        trial: &mut Trial,
    ) -> Result<StepInterval, Error> {
        self.resolved(context, trial, |context| context.workspace.worst())?;
        Ok(planned(state, context.from.t, trial.wanted, trial.target))
    }

    #[inline(always)]
    fn estimate(
        &self,
        context: &mut StepContext<'_, '_, D, Picard, N>,
        trial: &Trial,
        interval: &StepInterval,
    ) -> f64 {
        let StepContext { field, from, to, workspace, .. } = context;
        if const { is_constrained::<D, N>() }
            && workspace.detour_left == 0
            && (PATIENCE <= trial.rejected || 0 < trial.rejected && !workspace.ends.solved)
        {
            workspace.detour_left = DETOUR;
        }
        workspace.on_detour = 0 < workspace.detour_left;
        if workspace.on_detour {
            // Where constraints are almost linearly dependent, the accelerations change fast across
            // them, and sweeps do not converge.
            **to = Dop853.attempt(field, interval, from, &mut workspace.detour);
            return self.error_of(&Dop853, field, interval, from, to, &workspace.detour);
        }
        iterate(field, interval, from, to, workspace, Some(&self.tolerances::<D::Scalar>()));
        let error = workspace.ends.error;
        let high = HIGH < error || error.is_nan();
        if high && to.is_finite() && workspace.may_be_rounding() {
            let inherited = inherited(field, from);
            workspace.ends.solved = workspace.is_solved(&inherited);
            if workspace.ends.solved {
                let left = workspace.error(&inherited);
                // Rounding hides by how much the next step may be longer: by a quarter.
                workspace.ends.error = if left < 0.9 * LOW { 0.9 * LOW } else { left };
            }
        }
        workspace.ends.error
    }

    #[inline(always)]
    fn judge(
        &self,
        state: &mut ControllerState,
        context: &mut StepContext<'_, '_, D, Picard, N>,
        trial: &mut Trial,
        interval: &StepInterval,
        error: f64,
    ) -> Result<Verdict, Error> {
        let StepContext { method, field, from, to, workspace, .. } = context;
        let (h, wanted) = (interval.h.abs(), trial.wanted);
        if workspace.on_detour && error.is_finite() {
            (workspace.end, workspace.start_known, state.left) = (None, false, 0);
            trial.fault = None;
            let factor = 0.9 * power(1023.0 - log2(error) / 8.0);
            let length = h * if factor < 0.2 { 0.2 } else { factor };
            if error <= 1.0 {
                workspace.detour_left -= 1;
                state.h = if 4.0 * h < length { 4.0 * h } else { length };
                return Ok(Verdict::Accept);
            }
            return Ok(Verdict::Reject { length });
        }
        if error <= 1.0 {
            workspace.accept(to, interval.h);
            let sweeps = workspace.ends.progress.sweeps;
            let mut next = wanted;
            // The error of a shortened step is no evidence for longer steps.
            if error < LOW && sweeps <= MANY && trial.rejected == 0 && 0.5 * wanted <= h {
                let factor = scaled(error);
                let longer = h * if factor < 2.0 { factor } else { 2.0 };
                next = if 1.25 * wanted <= longer { longer } else { wanted };
            } else if HIGH < error {
                next = h * scaled(error);
            } else if TOO_MANY < sweeps {
                next = 0.95 * h;
            }
            state.left = if next == state.h { state.left - 1 } else { 0 };
            state.h = next;
            return Ok(Verdict::Accept);
        }
        (workspace.sweeps, state.left) = (2, 0);
        let factor = if error.is_finite() {
            trial.fault = None;
            let factor = scaled(error);
            if factor < 0.2 { 0.2 } else { factor }
        } else if !workspace.start.iter().all(|a| a.is_finite()) {
            let at_once = StepInterval::by(from.t, 0.0);
            return Err(method::cause(*method, field, &at_once, from, workspace));
        } else if to.is_finite() {
            trial.fault = None;
            0.5
        } else {
            context.note_fault(trial, interval)?;
            0.1
        };
        Ok(Verdict::Reject { length: h * factor })
    }
}

/// Returns the next of the equal steps to `target`, which are about as long as `wanted`. The
/// iteration converges best if a step is as long as the previous one.
#[inline]
fn planned(plan: &mut ControllerState, t: Time, wanted: f64, target: f64) -> StepInterval {
    let left = t.since(target).abs();
    let goes_on = |plan: &ControllerState| {
        f64::abs(left - plan.left as f64 * plan.equal) <= 1e-9 * plan.equal
    };
    if plan.left == 0 || plan.target != target || !goes_on(plan) {
        let count = f64::ceil(left / wanted - 0.01);
        let (count, equal) = if count < 1e9 {
            (f64::max(count, 1.0), left / f64::max(count, 1.0))
        } else {
            (1e9, wanted)
        };
        (plan.left, plan.equal, plan.target) = (count as u64, equal, target);
    }
    let towards = if target < t.to_f64() { -1.0 } else { 1.0 };
    if plan.left == 1 {
        StepInterval::to(t, target)
    } else {
        StepInterval::by(t, towards * plan.equal)
    }
}

/// Returns the factor that changes the length of a step with this error to that of a step with the
/// error `AIM`.
fn scaled(error: f64) -> f64 {
    // If not all derivatives of the accelerations exist, the power differs, but then no power is
    // correct.
    power(1023.0 + (log2(AIM) - log2(error)) / (2 * S - 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::{AdaptiveStep, Controller, ControllerState, Picard, StepContext, planned};
    use crate::integrate::field::Field;
    use crate::integrate::method::Method;
    use crate::integrate::methods::picard::Workspace;
    use crate::integrate::state::endpoint::Endpoint;
    use crate::integrate::stats::Stats;
    use crate::scalar::Real;
    use crate::system::{At, Facts, Staged, System};
    use crate::time::Time;
    use nalgebra::SMatrix;

    /// A body in orbit around another one that is fixed at the origin: r̈ = −μ r/r³.
    #[derive(Clone, Copy, Debug)]
    struct Kepler<T> {
        mu: T,
    }

    impl<T: Real> System<2> for Kepler<T> {
        type Scalar = T;
        type Inputs = ();
        type With<U: Real> = Kepler<U>;
        type Prepared = ();
        const FACTS: Facts = Facts { parameters: &["μ"], ..Facts::new("Kepler", &["x", "y"]) };

        fn map<U: Real>(&self, mut map: impl FnMut(T) -> U) -> Kepler<U> {
            Kepler { mu: map(self.mu) }
        }

        fn prepare(&self) {}

        fn accelerations(&self, At { q, .. }: At<'_, T, (), 2>) -> [T; 2] {
            let square = q[0] * q[0] + q[1] * q[1];
            let factor = -self.mu / (square * square.sqrt());
            [factor * q[0], factor * q[1]]
        }

        fn energy(&self, _: At<'_, T, (), 2>) -> T {
            unreachable!("no step asks for the energy")
        }

        fn momenta(&self, _: At<'_, T, (), 2>) -> [T; 2] {
            unreachable!("no step asks for the momenta")
        }

        fn velocities(&self, _: T, _: &[T; 2], _: &[T; 2], (): &()) -> [T; 2] {
            unreachable!("no step asks for the velocities")
        }

        fn power(&self, _: At<'_, T, (), 2>) -> T {
            unreachable!("no step asks for the power")
        }

        fn mass_matrix(&self, _: At<'_, T, (), 2>) -> SMatrix<T, 2, 2> {
            unreachable!("no step asks for the mass matrix")
        }

        fn forces(&self, _: At<'_, T, (), 2>) -> [T; 2] {
            unreachable!("no step asks for the forces")
        }

        fn momentum_rates(&self, _: At<'_, T, (), 2>) -> [T; 2] {
            unreachable!("no step asks for the momentum rates")
        }
    }

    /// Evaluation without stages.
    impl<T: Real> Staged<2> for Kepler<T> {
        type AtTime = ();
        type AtPosition = ();

        fn at_time(_: T, (): &()) {}

        fn at_position(&self, (): &(), (): &(), _: T, _: &[T; 2], (): &()) {}

        fn accelerations_staged(
            &self,
            (): &(),
            (): &(),
            (): &(),
            t: T,
            q: &[T; 2],
            v: &[T; 2],
            (): &(),
        ) -> [T; 2] {
            self.accelerations(At::of(t, q, v))
        }
    }

    const PLANET: Kepler<f64> = Kepler { mu: 1.0 };

    /// A planet in orbit, with everything that one step passes to the next.
    #[derive(Clone)]
    struct Flight {
        node: Endpoint<f64, 2>,
        memory: ControllerState,
        workspace: Workspace<f64, (), 2>,
        rejected: u64,
    }

    impl Flight {
        fn new() -> Self {
            let node = Endpoint::new(Time::new(0.0), [0.5, 0.0], [0.0, 3.0_f64.sqrt()]);
            Self {
                node,
                memory: ControllerState::default(),
                workspace: Picard.workspace(&PLANET),
                rejected: 0,
            }
        }

        /// Takes a step whose first attempt has the length `h`, and returns the length of the
        /// accepted attempt.
        fn step(&mut self, h: f64) -> f64 {
            let (mut field, mut stats, mut to) =
                (Field::new(&PLANET, &()), Stats::new("Picard"), self.node);
            (self.memory.h, self.memory.left) = (h, 0);
            let course = StepContext {
                method: &Picard,
                field: &mut field,
                from: &mut self.node,
                to: &mut to,
                workspace: &mut self.workspace,
                target: f64::INFINITY,
                stats: &mut stats,
            };
            let interval = AdaptiveStep::new().rtol(1e-6).step(&mut self.memory, course).unwrap();
            (self.node, self.rejected) = (to, stats.rejected);
            interval.h
        }

        /// Returns the state and everything that the next step depends on, with every bit.
        fn bits(&self) -> String {
            let Workspace { a, last, end, h, size, start, weights, ends, .. } = &self.workspace;
            format!(
                "{:?} {:?} {end:?} {h} {size:?} {start:?} {weights:?} {}",
                self.node, a[*last], ends.error
            )
        }
    }

    /// A step after a rejected attempt equals the step without that attempt.
    #[test]
    fn nothing_of_a_rejected_attempt_stays() {
        let (mut flight, mut rejected) = (Flight::new(), Vec::new());
        for k in 0..60 {
            let (mut tried, mut fresh) = (flight.clone(), flight.clone());
            let h = tried.step(if k == 0 { 3.0 } else { 2.0 * flight.workspace.h });
            if 0 < tried.rejected {
                // The count of sweeps starts again after a rejection.
                fresh.workspace.sweeps = 2;
                assert_eq!((fresh.step(h), fresh.rejected), (h, 0), "step {k}");
                assert_eq!(tried.bits(), fresh.bits(), "step {k}");
                rejected.push(k);
            }
            flight.step(if k == 0 { 0.01 } else { flight.memory.h });
        }
        // The first step, which has no predecessor, and others that continue from one.
        assert!(rejected[0] == 0 && 20 <= rejected.len(), "{rejected:?}");
    }

    /// Returns the lengths of the steps to `target`.
    fn lengths(wanted: f64, start: f64, target: f64) -> Vec<f64> {
        let (mut plan, mut t, mut lengths) =
            (ControllerState::default(), Time::new(start), Vec::new());
        while t.since(target) < 0.0 {
            let interval = planned(&mut plan, t, wanted, target);
            plan.left -= 1;
            t = interval.end;
            lengths.push(interval.h);
        }
        assert_eq!(t, Time::new(target));
        lengths
    }

    #[test]
    fn steps_to_a_target_are_equal() {
        assert_eq!(lengths(1.0, 0.0, 3.0), [1.0; 3]);
        assert_eq!(lengths(1.0, 0.0, 2.25), [0.75; 3]);
        assert_eq!(lengths(1.0, 0.0, 1.009), [1.009]);
        assert_eq!(lengths(1.0, 0.0, 0.3), [0.3]);
        let many = lengths(0.013, 0.1, 10.1);
        assert_eq!(many.len(), 770);
        assert!(
            many.iter().all(|h| (h * 77.0 - 1.0).abs() < 1e-12)
                && many[..769].iter().all(|h| *h == many[0])
        );
    }

    #[test]
    fn without_a_target_they_are_as_wanted() {
        let mut plan = ControllerState::default();
        for k in 0..5 {
            let interval = planned(&mut plan, Time::new(f64::from(k)), 0.7, f64::INFINITY);
            plan.left -= 1;
            assert_eq!(interval.h, 0.7);
        }
    }

    #[test]
    fn a_plan_ends_where_the_state_or_the_target_is_another() {
        let mut plan = ControllerState::default();
        assert_eq!(planned(&mut plan, Time::new(0.0), 1.0, 2.5).h, 2.5 / 3.0);
        plan.left -= 1;
        assert_eq!(planned(&mut plan, Time::new(0.5), 1.0, 2.5).h, 1.0);
        assert_eq!(planned(&mut plan, Time::new(0.5), 1.0, 4.0).h, 3.5 / 4.0);
    }
}
