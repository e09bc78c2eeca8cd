//! The Gauss methods: collocation at the nodes of Gauss and Legendre, in momenta.

mod dense;
mod equations;
mod tableau;

use crate::integrate::field::Field;
use crate::integrate::interpolant::Interpolant;
use crate::integrate::method::{Memory, Method};
use crate::integrate::state::compensated::Compensated;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::{At, Dynamics, Jacobians, Purpose, System, scalar_time};
use crate::time::Time;
use equations::{Change, Equations, Linearized, Slopes};
pub(super) use tableau::Tableau;

/// The Gauss method with `S` = 1, 2, 3, 4 or 8 stages: implicit, order 2S, symplectic for every
/// conservative system, fixed step.
///
/// Q_i = q₀ + h Σ a_ij V_j, P_i = p₀ + h Σ a_ij F_j, where V = q̇ and F = ∂L/∂q − ∂R/∂q̇ + Q are
/// evaluated at the stages (t + c_i h, Q_i, P_i), and q₁ = q₀ + h Σ b_j V_j, p₁ = p₀ + h Σ b_j F_j.
/// In coordinates and momenta the method is symplectic and reversible for any mass matrix: energy
/// errors stay bounded, phase errors grow with time, and conserved quantities that are quadratic in
/// q and p are conserved, as are the momenta of cyclic coordinates. `Gauss<1>` is the implicit
/// midpoint rule. The method requires the velocity of a driven motion, not its acceleration.
///
/// The equations are solved by sweeps, which start from the polynomial of the previous step and are
/// repeated until only rounding errors remain: two to six sweeps of S evaluations if h·ω is below
/// about 1. For stiff springs and dampers [`newton`](Self::newton) selects Newton's method with the
/// generated Jacobians. An iteration that diverges is an
/// [error](crate::error::Error::NoConvergence) with time and coordinate. With nine hundred steps
/// per period `Gauss<4>` conserves the energy of a pendulum to rounding: the error is 4e-15 after
/// ten million steps and grows with the square root of their number.
///
/// With constraints the method is not symplectic: energy errors grow slowly, as those of other
/// methods do.
///
/// Rounding errors have no bias: the coefficients are m_ij = a_ij/b_j, for which m_ij + m_ji = 1
/// holds exactly, and both coordinates and momenta are summed with compensation. Dense output is
/// the polynomial through the velocities at the stages and at both ends.
///
/// Source: Hairer, Lubich and Wanner (2006), Geometric Numerical Integration, II.1.3 and VIII.6;
/// Hairer, McLachlan and Razakarivony (2008), Achieving Brouwer's law with implicit Runge–Kutta
/// methods, BIT 48, 231; for the ratios m Antoñana, Makazaga and Murua (2017), Reducing and
/// monitoring round-off error propagation for symplectic implicit Runge–Kutta schemes, Numer.
/// Algorithms 76, 861.
///
/// ```
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: Jacobians<1> + System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     let soft = solve(system, (0.0, 10.0), [1.3], [0.0]).method(Gauss::<4>::new()).step(0.1).run()?;
///     let stiff = solve(system, (0.0, 10.0), [1.3], [0.0]).method(Gauss::<2>::new().newton()).step(0.1).run()?;
///     Ok(soft.end.q[0] - stiff.end.q[0])
/// }
/// ```
///
/// Newton's method does not compile for systems without Jacobians:
///
/// ```compile_fail,E0277
/// # use pendulum_runtime::{integrate::*, system::*};
/// fn swing<S: System<1, Scalar = f64, Inputs = ()>>(system: &S) -> Result<f64, Failure<f64, 1>> {
///     Ok(solve(system, (0.0, 10.0), [1.3], [0.0]).method(Gauss::<2>::new().newton()).step(0.1).run()?.end.q[0])
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gauss<const S: usize, I = ()> {
    iteration: I,
}

/// The iteration of [`Gauss`] with the Jacobians at the start of the step, for stiff systems.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Newton;

impl<const S: usize> Gauss<S> {
    /// Creates the method.
    pub const fn new() -> Self {
        Self { iteration: () }
    }

    /// Replaces sweeps by Newton's method.
    pub const fn newton(self) -> Gauss<S, Newton> {
        Gauss { iteration: Newton }
    }
}

/// Returns the name of the method with `S` stages.
const fn name<const S: usize>() -> &'static str {
    match S {
        1 => "Gauss<1>",
        2 => "Gauss<2>",
        3 => "Gauss<3>",
        4 => "Gauss<4>",
        _ => "Gauss<8>",
    }
}

/// What both iterations have in common: all but the attempt at a step.
macro_rules! with_stages {
    () => {
        const NAME: &'static str = name::<S>();
        type Workspace = Stages<D::Scalar, N, S>;

        fn workspace(&self, _: &D) -> Self::Workspace {
            Stages::new()
        }

        fn interpolant(
            &self,
            _: &mut Field<'_, D, N>,
            interval: &StepInterval,
            from: &mut Endpoint<D::Scalar, N>,
            to: &mut Endpoint<D::Scalar, N>,
            stages: &mut Self::Workspace,
        ) -> Interpolant<D::Scalar, N> {
            dense::interpolant(interval, from, to, &stages.slopes.v)
        }

        fn moved(&self, dynamics: &D, stages: &mut Self::Workspace, to: &Endpoint<D::Scalar, N>) {
            stages.moved(dynamics, to);
        }

        fn remember(&self, stages: &mut Self::Workspace, memory: &mut Memory) {
            stages.remember(memory);
        }

        fn unsolved(&self, stages: &Self::Workspace) -> Option<(Time, usize)> {
            stages.unsolved
        }
    };
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize, const S: usize> Method<D, N> for Gauss<S> {
    with_stages!();

    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        stages: &mut Self::Workspace,
    ) -> Endpoint<D::Scalar, N> {
        let equations = stages.begin(field, interval, from);
        stages.finish(field, interval, from, &equations, |field, old, slopes| {
            equations.sweep(field, old, slopes)
        })
    }
}

impl<D: Dynamics<N, Scalar: Float, System: Jacobians<N>>, const N: usize, const S: usize>
    Method<D, N> for Gauss<S, Newton>
{
    with_stages!();

    fn attempt<const W: bool>(
        &self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &mut Endpoint<D::Scalar, N>,
        stages: &mut Self::Workspace,
    ) -> Endpoint<D::Scalar, N> {
        let equations = stages.begin(field, interval, from);
        let linearized = Linearized::new(field, interval, from);
        stages.finish(field, interval, from, &equations, |field, old, slopes| {
            equations.newton(field, &linearized, old, slopes)
        })
    }
}

/// The results of a step: the slopes at its stages and the momenta at its end.
#[derive(Clone, Copy, Debug)]
pub struct Stages<T, const N: usize, const S: usize> {
    slopes: Slopes<T, N, S>,
    p: Compensated<T, N>,
    /// The state to which `p` belongs; `None` if the next step cannot continue from it.
    end: Option<Endpoint<T, N>>,
    /// The length of the last step.
    h: f64,
    unsolved: Option<(Time, usize)>,
}

impl<T: Float, const N: usize, const S: usize> Stages<T, N, S> {
    fn new() -> Self {
        Self {
            slopes: Slopes::zero(),
            p: Compensated::new([T::from_f64(0.0); N]),
            end: None,
            h: 0.0,
            unsolved: None,
        }
    }

    /// Visits everything that the next step depends on.
    fn remember(&mut self, memory: &mut Memory) {
        let Slopes { v, f } = &mut self.slopes;
        v.iter_mut().chain(f).for_each(|slopes| memory.scalars(slopes));
        memory.sums(&mut self.p);
        let empty = || Endpoint::new(Time::new(0.0), self.p.high, self.p.high);
        memory.maybe(&mut self.end, empty, Memory::endpoint);
        memory.number(&mut self.h);
    }

    /// Continues from `to`, to which the end of the last step has been moved.
    fn moved<D: Dynamics<N, Scalar = T>>(&mut self, dynamics: &D, to: &Endpoint<T, N>) {
        if self.end.is_some_and(|end| end.t == to.t) {
            let inputs = dynamics.inputs(to.t, Side::After, Purpose::Momenta);
            let (t, q, v) = (scalar_time(to.t), &to.q.high, &to.v.high);
            self.p = Compensated::new(dynamics.system().momenta(At { t, q, v, inputs: &inputs }));
            self.end = Some(*to);
        }
    }

    /// Returns the equations of the next step and puts a first guess into `slopes`.
    fn begin<D: Dynamics<N, Scalar = T>, const W: bool>(
        &mut self,
        field: &mut Field<'_, D, N, W>,
        interval: &StepInterval,
        from: &Endpoint<T, N>,
    ) -> Equations<D, N, S> {
        let goes_on =
            self.end.is_some_and(|end| end.t == from.t && end.q == from.q && end.v == from.v);
        if !goes_on {
            // The state has been set from outside or lies beyond a kink.
            let inputs = field.inputs(from.t, interval.side());
            self.p = Compensated::new(field.momenta(from.t, &from.q.high, &from.v.high, &inputs));
        }
        if goes_on && (interval.h - self.h).abs() <= 1e-3 * self.h.abs() {
            self.slopes = self.slopes.ahead(&Tableau::<S>::GAUSS.ahead);
        } else {
            let inputs = field.inputs(from.t, interval.side());
            let f = field.momentum_rates(from.t, &from.q.high, &from.v.high, &inputs);
            self.slopes = Slopes { v: [from.v.high; S], f: [f; S] };
        }
        (self.end, self.h, self.unsolved) = (None, interval.h, None);
        Equations::new(field, interval, from.q, self.p)
    }

    /// Improves the slopes until only rounding errors remain, and takes the step.
    fn finish<'a, D: Dynamics<N, Scalar = T>, const W: bool>(
        &mut self,
        field: &mut Field<'a, D, N, W>,
        interval: &StepInterval,
        from: &Endpoint<T, N>,
        equations: &Equations<D, N, S>,
        improve: impl FnMut(&mut Field<'a, D, N, W>, &Slopes<T, N, S>, &mut Slopes<T, N, S>) -> Change,
    ) -> Endpoint<T, N> {
        let mut to = Endpoint { t: interval.end, a: None, ..*from };
        match self.iterate(field, improve) {
            Ok(()) => {
                let (dq, dp) = equations.increments(&self.slopes);
                let one = T::from_f64(1.0);
                to.q.add(one, &dq);
                self.p.add(one, &dp);
                let inputs = field.inputs(interval.end, interval.side().opposite());
                to.v = Compensated::new(field.velocities(
                    interval.end,
                    &to.q.high,
                    &self.p.high,
                    &inputs,
                ));
                self.end = Some(to);
            }
            Err(astray) => {
                self.unsolved = astray.map(|(stage, index)| (equations.time(stage), index));
                to.v = Compensated::new([T::from_f64(f64::NAN); N]);
            }
        }
        to
    }

    /// Repeats `improve` until the next change is expected to be negligible, but at most [`SWEEPS`]
    /// times. The iteration also ends after 1, 2 or 10 changes that are not smaller than the least
    /// one so far, depending on how far it has converged.
    ///
    /// # Errors
    ///
    /// If the last change of the velocities is far above rounding, or a change is NaN: the stage
    /// and the coordinate of the last change that is a number, or `None` if the first change is
    /// NaN.
    fn iterate<X>(
        &mut self,
        field: &mut X,
        mut improve: impl FnMut(&mut X, &Slopes<T, N, S>, &mut Slopes<T, N, S>) -> Change,
    ) -> Result<(), Option<(usize, usize)>> {
        let epsilon = T::EPSILON.to_f64();
        // The remaining error has the same sign in every step: it must be small compared to the sum
        // of many rounding errors.
        let negligible = epsilon / 65536.0;
        let rounding = 0.01 * epsilon.sqrt();
        let (mut least, mut last, mut stalls, mut shift) =
            (f64::INFINITY, None::<Change>, 0, f64::INFINITY);
        let mut spare = Slopes::zero();
        let (mut slopes, mut next, mut changed) = (&mut self.slopes, &mut spare, false);
        let outcome = 'sweeps: {
            for _ in 0..SWEEPS {
                let change = improve(field, slopes, next);
                // The buffers are swapped, because a copy of slopes would have to wait until they
                // are written.
                (slopes, next, changed) = (next, slopes, !changed);
                if change.size.is_nan() {
                    break 'sweeps Err(last.map(|last| last.place));
                }
                let shrinks = last.map_or(1.0, |last| {
                    if change.size < last.size { change.size / last.size } else { 1.0 }
                });
                if change.size * shrinks <= negligible {
                    break 'sweeps Ok(());
                }
                last = Some(change);
                shift = change.shift;
                if change.size < least {
                    least = change.size;
                } else {
                    stalls += 1;
                    // Where stiff forces cancel, the momenta only converge to their rounding
                    // errors, and only the coordinates converge fully.
                    let patience = if least <= epsilon {
                        1
                    } else if shift <= rounding {
                        2
                    } else {
                        10
                    };
                    if stalls >= patience {
                        break;
                    }
                }
            }
            if shift <= rounding { Ok(()) } else { Err(last.map(|last| last.place)) }
        };
        if changed {
            self.slopes = spare;
        }
        outcome
    }
}

/// The largest number of sweeps. Close to the limit of convergence even hundreds of sweeps would
/// not suffice.
const SWEEPS: usize = 100;
