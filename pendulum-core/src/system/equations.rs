//! The equations of motion of a system, their Jacobians, and marker traits.

use crate::error::Error;
use crate::scalar::Real;
use crate::system::at::At;
use crate::system::constraints::{MOST_FRICTIONS, MOST_LIMITS};
use crate::system::facts::Facts;
use crate::system::inputs::Samples;
use crate::system::table::Table;
use core::fmt::Debug;
use nalgebra::SMatrix;

/// A mechanical system with `N` generalized coordinates: the equations of motion of one Lagrangian.
///
/// [`At`] holds the arguments of its functions. `lagrangian!` implements this trait. It generates
/// each function separately from one shared expression graph, so that unused functions cost
/// nothing. No function checks for singular mass matrices or numbers that are not finite; the
/// integrators do.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no system of `lagrangian!` itself",
    label = "no system itself",
    note = "`solve` takes a system after `.driven_by(…)` and, if it has control inputs, after `.controlled_by(…)` or `.sampled(…)`; scenes and `Variational` take it before"
)]
pub trait System<const N: usize> {
    /// The scalar of parameters and state.
    type Scalar: Real;
    /// `()` or a tuple with a [`Sample`](crate::motion::Sample) for each driven input, in the order
    /// of declaration.
    type Inputs: Samples<Self::Scalar>;
    /// The same system over another scalar.
    type With<U: Real>: System<N, Scalar = U>;
    /// Intermediate values of the accelerations that depend only on parameters, computed once; `()`
    /// for systems written by hand.
    type Prepared: Copy + Debug;

    /// Facts about the system, known at compile time.
    const FACTS: Facts;

    /// Returns the same system with every parameter mapped, in the order of `FACTS.parameters`.
    fn map<U: Real>(&self, map: impl FnMut(Self::Scalar) -> U) -> Self::With<U>;

    /// Returns the system in a model that is `scale` times as large: every parameter times the
    /// power of `scale` that the metre has in its unit, gravity and the points of tables included.
    ///
    /// On paths and from states whose lengths are `scale` times as large, it does the same at the
    /// same times. If gravity is set back to that of the small model, motions by gravity alone take
    /// √`scale` times as long.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if `scale` is not positive and finite, and [`Error::Unit`] if the
    /// unit of a parameter is neither given nor follows from others, or if a table whose points
    /// stand in the block has lengths; tables among the parameters may have them. What
    /// [`Table::new`] refuses of the new points is refused here too.
    fn resized(&self, scale: f64) -> Result<Self::With<Self::Scalar>, Error> {
        if !(0.0 < scale && scale < f64::INFINITY) {
            let required = "positive and finite";
            return Err(Error::Setting { name: "resized", value: scale, required });
        }
        let Facts { parameters, metres, coordinates, coordinate_units, .. } = Self::FACTS;
        // Without parameters, lengths may hide in numbers unless units are given.
        let bare = parameters.is_empty() && coordinate_units.iter().all(|unit| unit.is_empty());
        let mut unknown = bare.then(|| coordinates.first().copied().unwrap_or("the system"));
        let mut index = 0;
        let mut system = self.map(|parameter| {
            let power = metres.get(index).copied().flatten();
            if power.is_none() {
                unknown = unknown.or(parameters.get(index).copied()).or(Some("a parameter"));
            }
            index += 1;
            parameter * Self::Scalar::from_f64(Real::powf(scale, power.unwrap_or(0.0)))
        });
        let mut tables = Ok(());
        system.__tables_mut(&mut |table, metres| {
            let factors = metres.map(|power| Real::powf(scale, power));
            match table.times(factors) {
                Ok(own) => *table = own,
                Err(error) => tables = Err(error),
            }
        });
        unknown.map_or(tables.map(|()| system), |quantity| Err(Error::Unit { quantity }))
    }

    /// Computes the values that depend only on parameters.
    fn prepare(&self) -> Self::Prepared;

    /// Computes the accelerations q̈ with the values from [`prepare`](Self::prepare).
    #[inline]
    fn accelerations_prepared(
        &self,
        prepared: &Self::Prepared,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
    ) -> [Self::Scalar; N] {
        let _ = prepared;
        self.accelerations(at)
    }

    /// Computes the accelerations q̈.
    fn accelerations(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> [Self::Scalar; N];

    /// Computes the Jacobi integral q̇·∂L/∂q̇ − L.
    fn energy(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> Self::Scalar;

    /// Computes dE/dt along the motion: −∂L/∂t − q̇·∂R/∂q̇ + Q·q̇ − λ·b, where ∂/∂t includes the
    /// driven inputs and b is the rate of the constraints at q̇ = 0.
    fn power(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> Self::Scalar;

    /// Computes the generalized momenta p = ∂L/∂q̇.
    fn momenta(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> [Self::Scalar; N];

    /// Computes the velocities q̇ from the momenta `p`.
    fn velocities(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        p: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> [Self::Scalar; N];

    /// Computes the mass matrix M = ∂²L/∂q̇².
    fn mass_matrix(&self, at: At<'_, Self::Scalar, Self::Inputs, N>)
    -> SMatrix<Self::Scalar, N, N>;

    /// Computes the right-hand side f of M q̈ = f, or with constraints of M q̈ = f + Cᵀλ.
    fn forces(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> [Self::Scalar; N];

    /// Computes the conserved quantities listed in `FACTS.conserved`, up to the length of `values`.
    ///
    /// They correspond to the symmetries q → q + ε(a + Bq) of the Lagrangian (Noether 1918).
    fn conserved(&self, at: At<'_, Self::Scalar, Self::Inputs, N>, values: &mut [Self::Scalar]) {
        let _ = (at, values);
    }

    /// Computes the scalars of the output with this index in `FACTS.outputs`, up to the length of
    /// `values`. The members of a family follow one another.
    ///
    /// Each output is also a method with the name of the output.
    fn output(
        &self,
        index: usize,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
        values: &mut [Self::Scalar],
    ) {
        let _ = (index, at, values);
    }

    /// Computes the same scalars as [`output`](Self::output), but with given accelerations q̈ and
    /// `reactions` instead of those of the equations, which limits in contact and frictions change:
    /// the multipliers λ of the constraints, those of the limits, and the forces of the frictions,
    /// along the rows of [`constraint_jacobian`](Self::constraint_jacobian),
    /// [`gap_jacobian`](Self::gap_jacobian) and [`slip_jacobian`](Self::slip_jacobian). `output`
    /// takes the last two as zero.
    ///
    /// Generated code overrides this method if the system has limits or frictions; otherwise it
    /// calls `output`.
    fn output_of(
        &self,
        index: usize,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
        accelerations: &[Self::Scalar; N],
        reactions: [&[Self::Scalar]; 3],
        values: &mut [Self::Scalar],
    ) {
        let _ = (accelerations, reactions);
        self.output(index, at, values);
    }

    /// Computes dp/dt = ∂L/∂q − ∂R/∂q̇ + Q + Cᵀλ, the second half of the momentum form. Without
    /// constraints the momentum form needs one derivative of the inputs less than the
    /// accelerations.
    fn momentum_rates(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> [Self::Scalar; N];

    /// Computes the velocities with the rates of the states in their places, and q̈ with the
    /// derivatives of these rates along given `accelerations`.
    ///
    /// States are the last coordinates. Their rates do not depend on the velocities in their
    /// places, and neither do the other accelerations. Driven inputs are sampled for
    /// [`Purpose::Accelerations`](crate::system::Purpose::Accelerations).
    fn state_rates(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
        accelerations: &[Self::Scalar; N],
    ) -> [[Self::Scalar; N]; 2] {
        [*at.v, *accelerations]
    }

    /// Computes the longest step from `t`, in seconds, that cannot miss an explicit time dependence
    /// of the accelerations or of the gaps of limits; infinite if there is none.
    ///
    /// A step may be `widths` times as long as the width of the narrowest function of time, w for
    /// exp(−((t − t₀)/w)²), and half as long as the distance in time to a function farther away.
    /// Generated code detects the arguments of functions and powers that are polynomials in time
    /// with coefficients made of parameters, and magnitudes of such polynomials. The default, for
    /// systems written by hand, is infinite.
    fn longest_step(&self, t: Self::Scalar, widths: Self::Scalar) -> Self::Scalar {
        let _ = (t, widths);
        Self::Scalar::from_f64(f64::INFINITY)
    }

    /// Computes the arguments in `FACTS.switches`, followed by those in `FACTS.layers`, up to the
    /// length of `values`.
    ///
    /// Driven inputs are sampled for
    /// [`Purpose::Accelerations`](crate::system::Purpose::Accelerations).
    fn arguments(&self, at: At<'_, Self::Scalar, Self::Inputs, N>, values: &mut [Self::Scalar]) {
        let _ = (at, values);
    }

    /// Computes the jump of the velocities where the argument `index` in `FACTS.switches`, which
    /// changes with `rate`, passes zero, and the accelerations jump by `change`; `None` if no
    /// velocity jumps.
    ///
    /// Velocities of motions are continuous there. Those of
    /// [`Variational`](crate::analysis::Variational) equations jump where accelerations do.
    fn jump(
        &self,
        index: usize,
        rate: Self::Scalar,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
        change: &[Self::Scalar; N],
    ) -> Option<[Self::Scalar; N]> {
        let _ = (index, rate, at, change);
        None
    }

    /// Visits the tables in accelerations and limits that are refused beyond their points: the name,
    /// the first and the last point, and the argument.
    #[doc(hidden)]
    fn __tables(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
        visit: &mut dyn FnMut(&'static str, [f64; 2], Self::Scalar),
    ) {
        let _ = (at, visit);
    }

    /// Visits the tables among the parameters, in the order of declaration.
    #[doc(hidden)]
    fn __given_tables(&self, visit: &mut dyn FnMut(&Table)) {
        let _ = visit;
    }

    /// Visits the same tables with the powers of the metre in the units of argument and value.
    #[doc(hidden)]
    fn __tables_mut(&mut self, visit: &mut dyn FnMut(&mut Table, [f64; 2])) {
        let _ = visit;
    }

    /// Computes the misfits of the constraints with multipliers, in the order of
    /// `FACTS.constraints`: the values g, which are zero for constraints on velocities, and the
    /// rates C q̇ + b.
    ///
    /// There are always fewer constraints than coordinates; the remaining entries are zero. Driven
    /// inputs are sampled for [`Purpose::Momenta`](crate::system::Purpose::Momenta).
    fn misfits(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> [[Self::Scalar; N]; 2] {
        let _ = at;
        [[Self::Scalar::from_f64(0.0); N]; 2]
    }

    /// Computes the sums of the magnitudes of the terms of [`misfits`](Self::misfits), as a scale
    /// for rounding errors.
    fn misfit_scales(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> [[Self::Scalar; N]; 2] {
        let _ = at;
        [[Self::Scalar::from_f64(0.0); N]; 2]
    }

    /// Computes the misfits of the redundant constraints, as [`misfits`](Self::misfits). There are
    /// at most as many redundant constraints as coordinates.
    fn redundant_misfits(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
    ) -> [[Self::Scalar; N]; 2] {
        let _ = at;
        [[Self::Scalar::from_f64(0.0); N]; 2]
    }

    /// Computes the change of the coordinates or velocities that changes the constraints by
    /// `target` and is the shortest in the metric of the mass matrix: M⁻¹Cᵀ(C M⁻¹Cᵀ)⁻¹ `target`.
    ///
    /// Driven inputs are sampled for [`Purpose::Momenta`](crate::system::Purpose::Momenta).
    fn correction(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
        target: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        let _ = (at, target);
        [Self::Scalar::from_f64(0.0); N]
    }

    /// Computes the gradients C of the constraints with multipliers, one per row; the remaining
    /// rows are zero.
    ///
    /// Driven inputs are sampled for [`Purpose::Momenta`](crate::system::Purpose::Momenta).
    fn constraint_jacobian(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
    ) -> SMatrix<Self::Scalar, N, N> {
        let _ = at;
        SMatrix::from_element(Self::Scalar::from_f64(0.0))
    }

    /// Computes the rates C `change` of the constraints with multipliers along a change of the
    /// coordinates; the remaining entries are zero.
    fn constraint_rates(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
        change: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        let gradients = self.constraint_jacobian(at);
        core::array::from_fn(|k| {
            (0..N).fold(Self::Scalar::from_f64(0.0), |sum, j| sum + gradients[(k, j)] * change[j])
        })
    }

    /// Computes the squared gradients of the constraints with multipliers, Σⱼ Cₖⱼ²/Mⱼⱼ; the
    /// remaining entries are zero.
    fn squared_gradients(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> [Self::Scalar; N] {
        let (gradients, masses) = (self.constraint_jacobian(at), self.mass_matrix(at));
        core::array::from_fn(|k| {
            (0..N).fold(Self::Scalar::from_f64(0.0), |sum, j| {
                sum + gradients[(k, j)] * gradients[(k, j)] / masses[(j, j)]
            })
        })
    }

    /// Computes the multipliers λ of M q̈ = f + Cᵀλ, in the order of `FACTS.constraints`; the
    /// remaining entries are zero.
    ///
    /// Driven inputs are sampled for
    /// [`Purpose::Accelerations`](crate::system::Purpose::Accelerations).
    fn reactions(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> [Self::Scalar; N] {
        let _ = at;
        [Self::Scalar::from_f64(0.0); N]
    }

    /// Computes the independence of each constraint from the constraints before it, from 0 to 1;
    /// the remaining entries are one.
    ///
    /// It is the pivot of its multiplier in the elimination, divided by the part of the pivot that
    /// other multipliers have not reduced. If the coordinates are eliminated first, it is sin² of
    /// the angle between gradients in the metric of the mass matrix. At zero the accelerations are
    /// undetermined. Driven inputs are sampled for
    /// [`Purpose::Momenta`](crate::system::Purpose::Momenta).
    fn independence(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> [Self::Scalar; N] {
        let _ = at;
        [Self::Scalar::from_f64(1.0); N]
    }

    /// Computes the gaps h of the limits in the order of `FACTS.limits`, their rates along the
    /// motion, and their second rates at q̈ = 0; the remaining entries are zero.
    ///
    /// Driven inputs are sampled for
    /// [`Purpose::Accelerations`](crate::system::Purpose::Accelerations).
    fn gaps(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> [[Self::Scalar; MOST_LIMITS]; 3] {
        let _ = at;
        [[Self::Scalar::from_f64(0.0); MOST_LIMITS]; 3]
    }

    /// Computes the gradients ∂h/∂q of the limits, one per row; the remaining rows are zero.
    fn gap_jacobian(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
    ) -> SMatrix<Self::Scalar, MOST_LIMITS, N> {
        let _ = at;
        SMatrix::from_element(Self::Scalar::from_f64(0.0))
    }

    /// Computes the coefficient of restitution of each limit, from 0 (no rebound) to 1; the
    /// remaining entries are zero.
    fn restitutions(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
    ) -> [Self::Scalar; MOST_LIMITS] {
        let _ = at;
        [Self::Scalar::from_f64(0.0); MOST_LIMITS]
    }

    /// Computes the rates r of `FACTS.frictions`, and dr/dt at q̈ = 0; the remaining entries are
    /// zero. No rate contains a control input.
    ///
    /// Driven inputs are sampled for
    /// [`Purpose::Accelerations`](crate::system::Purpose::Accelerations).
    fn slips(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
    ) -> [[Self::Scalar; MOST_FRICTIONS]; 2] {
        let _ = at;
        [[Self::Scalar::from_f64(0.0); MOST_FRICTIONS]; 2]
    }

    /// Computes the coefficients A = ∂r/∂q̇ of the rates with dry friction, one per row; the
    /// remaining rows are zero.
    fn slip_jacobian(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
    ) -> SMatrix<Self::Scalar, MOST_FRICTIONS, N> {
        let _ = at;
        SMatrix::from_element(Self::Scalar::from_f64(0.0))
    }

    /// Computes the magnitudes of each dry friction without the parts of
    /// [`grip_shares`](Self::grip_shares): the force while the rate is not zero, and the bound
    /// `static`, zero if there is none. The components of a vector have equal entries; the
    /// remaining entries are zero.
    fn grips(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
    ) -> [[Self::Scalar; MOST_FRICTIONS]; 2] {
        let _ = at;
        [[Self::Scalar::from_f64(0.0); MOST_FRICTIONS]; 2]
    }

    /// Computes the coefficients of the magnitudes in [`grips`](Self::grips) for the reactions of
    /// the limits, with a row for each friction and a column for each limit: of the force, and of
    /// `static`. Behind the limits follow the columns for the sizes of the reactions `FACTS.loads`.
    ///
    /// Friction in a contact is proportional to the force of the contact.
    fn grip_shares(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
    ) -> [SMatrix<Self::Scalar, MOST_FRICTIONS, MOST_LIMITS>; 2] {
        let _ = at;
        [SMatrix::from_element(Self::Scalar::from_f64(0.0)); 2]
    }

    /// Evaluates Hamilton's equations: the velocities q̇ = ∂H/∂p at the momenta `p`, and dp/dt.
    ///
    /// Generated code shares the intermediate values of both.
    #[inline]
    fn hamilton(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        p: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> ([Self::Scalar; N], [Self::Scalar; N]) {
        let v = self.velocities(t, q, p, inputs);
        let rates = self.momentum_rates(At { t, q, v: &v, inputs });
        (v, rates)
    }
}

/// The accelerations in stages. Values that depend only on parameters are
/// [prepared](System::prepare) once. Values that depend only on time and driven inputs are computed
/// once for all systems of a type on a joint. Values that depend on the position, but not on
/// velocities, are computed once for all velocities.
///
/// The last stage returns the same bits as [`System::accelerations`]. Generated stages are always
/// inlined, so that loops over [lanes](crate::scalar::Lanes) use the vector instructions of the
/// code around them.
pub trait Staged<const N: usize>: System<N> {
    /// Values that depend only on time and driven inputs.
    type AtTime: Copy + Debug;
    /// Values that depend on the position, but not on velocities.
    type AtPosition: Copy + Debug;

    /// Computes the values that depend only on time and driven inputs, not on parameters.
    fn at_time(t: Self::Scalar, inputs: &Self::Inputs) -> Self::AtTime;

    /// Computes the values that do not depend on velocities.
    fn at_position(
        &self,
        prepared: &Self::Prepared,
        at_time: &Self::AtTime,
        t: Self::Scalar,
        q: &[Self::Scalar; N],
        inputs: &Self::Inputs,
    ) -> Self::AtPosition;

    /// Computes the accelerations q̈ from the values of the earlier stages.
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

/// A system whose Lagrangian is given as kinetic minus potential energy.
pub trait SplitEnergy<const N: usize>: System<N> {
    /// Computes the sum of all `kinetic` statements.
    fn kinetic_energy(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> Self::Scalar;

    /// Computes the sum of all `potential` statements.
    fn potential_energy(&self, at: At<'_, Self::Scalar, Self::Inputs, N>) -> Self::Scalar;
}

/// The derivatives of the accelerations, generated from the same expression graph.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no Jacobians",
    label = "no system that `lagrangian!` has made",
    note = "`Variational` takes a system without its motions, and they come behind it: `Driven::new(Variational::new(system), (motion,))`; the derivatives of a driven motion come as well by `solution.sensitivities(&driven, [\"b\"])`"
)]
pub trait Jacobians<const N: usize>: Staged<N> {
    /// The same system over another scalar, as [`System::With`], but with Jacobians.
    type Over<U: Real>: Jacobians<N, Scalar = U>;

    /// Returns the same system with every parameter mapped, as [`System::map`].
    fn over<U: Real>(&self, map: impl FnMut(Self::Scalar) -> U) -> Self::Over<U>;

    /// Computes ∂q̈/∂q, with a row per acceleration and a column per coordinate.
    fn position_jacobian(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
    ) -> SMatrix<Self::Scalar, N, N>;

    /// Computes ∂q̈/∂q̇, with a row per acceleration and a column per velocity.
    fn velocity_jacobian(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
    ) -> SMatrix<Self::Scalar, N, N>;

    /// Computes ∂q̈/∂p for each parameter p in the order of `FACTS.parameters`, up to the length of
    /// `columns`.
    fn parameter_jacobian(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
        columns: &mut [[Self::Scalar; N]],
    );

    /// Computes ∂q̈/∂u for each component u of the control inputs in the order of declaration, up
    /// to the length of `columns`.
    fn control_jacobian(
        &self,
        at: At<'_, Self::Scalar, Self::Inputs, N>,
        columns: &mut [[Self::Scalar; N]],
    ) {
        let _ = (at, columns);
    }
}

/// Marks systems with a constant mass matrix and accelerations that contain no velocity.
///
/// Leapfrog and Runge–Kutta–Nyström methods require this trait, because they are wrong for all
/// other systems.
#[diagnostic::on_unimplemented(
    message = "the accelerations of `{Self}` contain velocities or its mass matrix is not constant",
    label = "a splitting or Nyström method would be wrong here",
    note = "use `Rk4` or `Dop853`"
)]
pub trait VelocityFree<const N: usize>: System<N> {}

/// Marks systems with constraints, all of them on positions, with a constant mass matrix and forces
/// without velocities.
///
/// [`Rattle`](crate::integrate::Rattle) requires this trait, because it is wrong for all other
/// systems.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no system with constraints of positions alone, a constant mass matrix and forces without velocities",
    label = "RATTLE would be wrong here",
    note = "use `Picard` or `Dop853`; without constraints `Srkn14a` or `Gauss` for long runs"
)]
pub trait Holonomic<const N: usize>: System<N> {}
