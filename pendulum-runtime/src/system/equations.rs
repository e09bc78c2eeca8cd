//! The equations of motion of a system, its Jacobians and what its type says about it.

use crate::scalar::Real;
use crate::system::constraints::MOST_LIMITS;
use crate::system::facts::Facts;
use crate::system::inputs::Samples;
use core::fmt::Debug;
use nalgebra::SMatrix;

/// A mechanical system with `N` generalized coordinates: the equations of motion of one Lagrangian.
///
/// `q` are the coordinates, `v` their velocities q̇, `t` the time in seconds and `inputs` the
/// samples of the driven inputs. Each function is generated on its own from one shared expression
/// graph, so that what nobody calls costs nothing. `lagrangian!` implements it; nothing here checks
/// for singular mass matrices or numbers that are not finite, the integrators do.
pub trait System<const N: usize> {
    /// The scalar of parameters and state.
    type Scalar: Real;
    /// `()` or a tuple with a [`Sample`](crate::motion::Sample) for each driven input, in the order
    /// of declaration.
    type Inputs: Samples;
    /// The same system over another scalar.
    type With<U: Real>: System<N, Scalar = U>;
    /// Values that the accelerations need and the parameters alone decide, computed once; `()` for
    /// systems written by hand.
    type Prepared: Copy + Debug;

    /// Facts about the system that are known before it runs.
    const FACTS: Facts;

    /// The same system with every parameter mapped, in the order of `FACTS.parameters`.
    fn map<U: Real>(&self, map: impl FnMut(Self::Scalar) -> U) -> Self::With<U>;

    /// Computes the values that parameters alone decide.
    fn prepare(&self) -> Self::Prepared;

    /// The accelerations q̈ with what [`prepare`](Self::prepare) gave.
    #[inline]
    fn accelerations_prepared(
        &self,
        prepared: &Self::Prepared,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [Self::Scalar; N] {
        let _ = prepared;
        self.accelerations(t, q, v, inputs)
    }

    /// The accelerations q̈.
    fn accelerations(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [Self::Scalar; N];

    /// The Jacobi integral q̇·∂L/∂q̇ − L.
    fn energy(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> Self::Scalar;

    /// dE/dt along the motion: −∂L/∂t − q̇·∂R/∂q̇ + Q·q̇ − λ·b, where ∂/∂t takes in the driven
    /// inputs and b is the rate of the constraints at q̇ = 0.
    fn power(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> Self::Scalar;

    /// The generalized momenta p = ∂L/∂q̇.
    fn momenta(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [Self::Scalar; N];

    /// The velocities q̇ that give the momenta `p`.
    fn velocities(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        p: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [Self::Scalar; N];

    /// The mass matrix M = ∂²L/∂q̇².
    fn mass_matrix(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> SMatrix<Self::Scalar, N, N>;

    /// The right-hand side f of M q̈ = f; with constraints, of M q̈ = f + Cᵀλ.
    fn forces(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [Self::Scalar; N];

    /// The conserved quantities that `FACTS.conserved` names, as far as `values` reaches.
    ///
    /// They belong to the symmetries q → q + ε(a + Bq) of the Lagrangian (Noether 1918).
    fn conserved(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
        values: &mut [Self::Scalar],
    ) {
        let _ = (t, q, v, inputs, values);
    }

    /// The scalars of the output with this index in `FACTS.outputs`, as far as `values` reaches:
    /// those of the first member of a family, of the second and so on.
    ///
    /// Each output is a method of its own, too, named as it is.
    fn output(
        &self,
        index: usize,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
        values: &mut [Self::Scalar],
    ) {
        let _ = (index, t, q, v, inputs, values);
    }

    /// The same at accelerations q̈ and multipliers λ that are given, instead of those of the
    /// equations: limits in contact change both.
    ///
    /// Generated code has it where there are limits; elsewhere it is [`output`](Self::output).
    #[allow(clippy::too_many_arguments)]
    fn output_of(
        &self,
        index: usize,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        accelerations: &[Self::Scalar; N],
        multipliers: &[Self::Scalar; N],
        inputs: &Self::Inputs,
        values: &mut [Self::Scalar],
    ) {
        let _ = (accelerations, multipliers);
        self.output(index, t, q, v, inputs, values);
    }

    /// dp/dt = ∂L/∂q − ∂R/∂q̇ + Q + Cᵀλ: the other half of the momentum form, which without
    /// constraints needs one derivative of the inputs less than the accelerations.
    fn momentum_rates(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [Self::Scalar; N];

    /// The longest step from `t` that cannot go unseen over what time alone does to the
    /// accelerations, in seconds; infinite if it stands nowhere.
    ///
    /// A step may be `widths` times as long as the narrowest function of time is wide, w for
    /// exp(−((t − t₀)/w)²), and half as long as it is to one that is farther off. Generated code
    /// knows the arguments of functions and powers that are polynomials in time with coefficients
    /// made of parameters, and magnitudes of such; nothing is known of systems written by hand that
    /// do not say it.
    fn longest_step(&self, t: Self::Scalar, widths: Self::Scalar) -> Self::Scalar {
        let _ = (t, widths);
        Self::Scalar::from_f64(f64::INFINITY)
    }

    /// The misfits of the constraints that the equations hold, in the order of
    /// `FACTS.constraints`: g, zero for those of velocities, and the rates C q̇ + b.
    ///
    /// There are always fewer of them than coordinates; the rest is zero. Driven inputs are sampled
    /// for [`Purpose::Momenta`](crate::system::Purpose::Momenta).
    fn misfits(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [[Self::Scalar; N]; 2] {
        let _ = (t, q, v, inputs);
        [[Self::Scalar::from_f64(0.0); N]; 2]
    }

    /// The sums of the magnitudes of the terms of [`misfits`](Self::misfits): what its rounding is
    /// measured by.
    fn misfit_scales(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [[Self::Scalar; N]; 2] {
        let _ = (t, q, v, inputs);
        [[Self::Scalar::from_f64(0.0); N]; 2]
    }

    /// The same as [`misfits`](Self::misfits) of the redundant constraints, of which there are no
    /// more than coordinates.
    fn redundant_misfits(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [[Self::Scalar; N]; 2] {
        let _ = (t, q, v, inputs);
        [[Self::Scalar::from_f64(0.0); N]; 2]
    }

    /// The change of the coordinates, or of the velocities, that is the shortest in the metric of
    /// the mass matrix and changes the constraints by `target`: M⁻¹Cᵀ(C M⁻¹Cᵀ)⁻¹ `target`.
    ///
    /// Driven inputs are sampled for [`Purpose::Momenta`](crate::system::Purpose::Momenta).
    fn correction(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
        target: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        let _ = (t, q, v, inputs, target);
        [Self::Scalar::from_f64(0.0); N]
    }

    /// The gradients C of the constraints that the equations hold, one in a row; the rest is zero.
    ///
    /// Driven inputs are sampled for [`Purpose::Momenta`](crate::system::Purpose::Momenta).
    fn constraint_jacobian(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> SMatrix<Self::Scalar, N, N> {
        let _ = (t, q, v, inputs);
        SMatrix::from_element(Self::Scalar::from_f64(0.0))
    }

    /// The multipliers λ of M q̈ = f + Cᵀλ, in the order of `FACTS.constraints`; the rest is zero.
    ///
    /// Driven inputs are sampled for
    /// [`Purpose::Accelerations`](crate::system::Purpose::Accelerations).
    fn reactions(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [Self::Scalar; N] {
        let _ = (t, q, v, inputs);
        [Self::Scalar::from_f64(0.0); N]
    }

    /// The independence of each constraint of those before it, from 0 to 1; the rest is one.
    ///
    /// It is the pivot of its multiplier, as elimination meets it, over the part of the pivot that
    /// other multipliers have not reduced: sin² of the angle between gradients in the metric of the
    /// mass matrix, where the coordinates are eliminated first. At zero the accelerations are
    /// undetermined. Driven inputs are sampled for
    /// [`Purpose::Momenta`](crate::system::Purpose::Momenta).
    fn independence(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [Self::Scalar; N] {
        let _ = (t, q, v, inputs);
        [Self::Scalar::from_f64(1.0); N]
    }

    /// The gaps h of the limits in the order of `FACTS.limits`, their rates along the motion, and
    /// the second rates at q̈ = 0; the rest is zero.
    ///
    /// Driven inputs are sampled for
    /// [`Purpose::Accelerations`](crate::system::Purpose::Accelerations).
    fn gaps(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [[Self::Scalar; MOST_LIMITS]; 3] {
        let _ = (t, q, v, inputs);
        [[Self::Scalar::from_f64(0.0); MOST_LIMITS]; 3]
    }

    /// The gradients ∂h/∂q of the limits, one in a row; the rest is zero.
    fn gap_jacobian(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> SMatrix<Self::Scalar, MOST_LIMITS, N> {
        let _ = (t, q, v, inputs);
        SMatrix::from_element(Self::Scalar::from_f64(0.0))
    }

    /// The coefficient of restitution of each limit, from 0 (no rebound) to 1; the rest is zero.
    fn restitutions(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [Self::Scalar; MOST_LIMITS] {
        let _ = (t, q, v, inputs);
        [Self::Scalar::from_f64(0.0); MOST_LIMITS]
    }

    /// Hamilton's equations: the velocities q̇ = ∂H/∂p that give the momenta `p`, and dp/dt there.
    ///
    /// Generated code computes once what both need of a position.
    #[inline]
    fn hamilton(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        p: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> ([Self::Scalar; N], [Self::Scalar; N]) {
        let v = self.velocities(t, q, p, inputs);
        let rates = self.momentum_rates(t, q, &v, inputs);
        (v, rates)
    }
}

/// The accelerations in stages: what parameters decide is [prepared](System::prepare) once, what
/// time and driven inputs decide is computed once for all systems of a type on a joint, and what
/// the position adds once for all velocities.
///
/// The last stage gives the same bits as [`System::accelerations`]. Generated stages are always
/// inlined, so that loops over [lanes](crate::scalar::Lanes) use the vectors of the code around
/// them.
pub trait Staged<const N: usize>: System<N> {
    /// Values that time and driven inputs alone decide.
    type AtTime: Copy + Debug;
    /// Values that the position adds.
    type AtPosition: Copy + Debug;

    /// Computes the values that time and driven inputs alone decide, whatever the parameters.
    fn at_time(t: Self::Scalar, inputs: &Self::Inputs) -> Self::AtTime;

    /// Computes the values that do not need the velocities.
    fn at_position(
        &self,
        prepared: &Self::Prepared,
        at_time: &Self::AtTime,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> Self::AtPosition;

    /// The accelerations q̈ from all stages before.
    #[allow(clippy::too_many_arguments)]
    fn accelerations_staged(
        &self,
        prepared: &Self::Prepared,
        at_time: &Self::AtTime,
        at_position: &Self::AtPosition,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [Self::Scalar; N];
}

/// A system whose Lagrangian was given as kinetic minus potential energy.
pub trait SplitEnergy<const N: usize>: System<N> {
    /// The sum of all `kinetic` statements.
    fn kinetic_energy(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> Self::Scalar;

    /// The sum of all `potential` statements.
    fn potential_energy(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> Self::Scalar;
}

/// The derivatives of the accelerations, from the same expression graph.
pub trait Jacobians<const N: usize>: System<N> {
    /// The same system over another scalar, as [`System::With`], with Jacobians too.
    type Over<U: Real>: Jacobians<N, Scalar = U>;

    /// The same system with every parameter mapped, as [`System::map`] does it.
    fn over<U: Real>(&self, map: impl FnMut(Self::Scalar) -> U) -> Self::Over<U>;

    /// The samples of the driven inputs with every number mapped.
    fn inputs_over<U: Real>(
        inputs: &Self::Inputs,
        map: impl Fn(Self::Scalar) -> U,
    ) -> <Self::Over<U> as System<N>>::Inputs;

    /// ∂q̈/∂q, row by acceleration, column by coordinate.
    fn position_jacobian(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> SMatrix<Self::Scalar, N, N>;

    /// ∂q̈/∂q̇, row by acceleration, column by velocity.
    fn velocity_jacobian(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> SMatrix<Self::Scalar, N, N>;

    /// ∂q̈/∂p for each parameter p in the order of `FACTS.parameters`, as far as `columns` reaches.
    fn parameter_jacobian(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
        columns: &mut [[Self::Scalar; N]],
    );

    /// ∂q̈/∂u for each component u of the control inputs in the order of declaration, as far as
    /// `columns` reaches.
    fn control_jacobian(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
        inputs: &Self::Inputs,
        columns: &mut [[Self::Scalar; N]],
    ) {
        let _ = (t, q, v, inputs, columns);
    }
}

/// The marker of systems with a constant mass matrix whose accelerations contain no velocity.
///
/// Leapfrog and Runge–Kutta–Nyström methods are wrong for all others, so they ask for it.
#[diagnostic::on_unimplemented(
    message = "the accelerations of `{Self}` contain velocities or its mass matrix is not constant",
    label = "a splitting or Nyström method would be wrong here",
    note = "use `Rk4` or `Dop853`"
)]
pub trait VelocityFree<const N: usize>: System<N> {}

/// The marker of systems with constraints, all of positions, a constant mass matrix and forces
/// without velocities.
///
/// [`Rattle`](crate::integrate::Rattle) is wrong for all others, so it asks for it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no system with constraints of positions alone, a constant mass matrix and forces without velocities",
    label = "RATTLE would be wrong here",
    note = "use `Picard` or `Dop853`; without constraints `Srkn14a` or `Gauss` for long runs"
)]
pub trait Holonomic<const N: usize>: System<N> {}
