//! What `lagrangian!` generates, and a system together with the motions that drive it.

use crate::motion::{Derivatives, Motions, Sample, Side, sufficient};
use crate::real::Real;
use crate::time::Time;
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
    /// `()` or a tuple with a [`Sample`] for each driven input, in the order of declaration.
    type Inputs: Samples;
    /// The same system over another scalar.
    type With<U: Real>: System<N, Scalar = U>;
    /// What the accelerations need and the parameters alone decide, computed once; `()` for systems
    /// written by hand.
    type Prepared: Copy + Debug;

    /// What is known about the system before it runs.
    const FACTS: Facts;

    /// The same system with every parameter mapped, in the order of `FACTS.parameters`.
    fn map<U: Real>(&self, map: impl FnMut(Self::Scalar) -> U) -> Self::With<U>;

    /// What parameters alone decide.
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

    /// dE/dt along the motion: −∂L/∂t − q̇·∂R/∂q̇ + Q·q̇, where ∂/∂t takes in the driven inputs.
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

    /// The right-hand side f of M q̈ = f.
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

    /// dp/dt = ∂L/∂q − ∂R/∂q̇ + Q: the other half of the momentum form, which needs one derivative
    /// of the inputs less than the accelerations.
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
/// inlined, so that loops over [lanes](crate::real::Lanes) use the vectors of the code around them.
pub trait Staged<const N: usize>: System<N> {
    /// What time and driven inputs alone decide.
    type AtTime: Copy + Debug;
    /// What the position adds to it.
    type AtPosition: Copy + Debug;

    /// What time and driven inputs alone decide, whatever the parameters.
    fn at_time(t: Self::Scalar, inputs: &Self::Inputs) -> Self::AtTime;

    /// What can be computed before the velocities are known.
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
}

/// The marker of systems with a constant mass matrix whose accelerations contain no velocity.
///
/// Leapfrog and Runge–Kutta–Nyström methods are wrong for all others, so they ask for it.
#[diagnostic::on_unimplemented(
    message = "the accelerations of `{Self}` contain velocities or its mass matrix is not constant",
    label = "a splitting or Nyström method would be wrong here",
    note = "use `Rk4`, `Tsit5` or `Dop853`"
)]
pub trait VelocityFree<const N: usize>: System<N> {}

/// What `lagrangian!` knows about a system before it runs.
// Each is a fact of its own, not a state.
#[allow(clippy::struct_excessive_bools)]
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Facts {
    /// The name of the struct.
    pub name: &'static str,
    /// The coordinates as written, a family as `θ[0]`, `θ[1]`, ….
    pub coordinates: &'static [&'static str],
    /// The parameters in the order of [`System::map`], a vector as `c.x`, `c.y`, a family as
    /// `m[0]`, ….
    pub parameters: &'static [&'static str],
    /// The units of the parameters as written, empty where none was given.
    pub units: &'static [&'static str],
    /// The driven inputs in the order of declaration.
    pub inputs: &'static [Input],
    /// Neither time nor a driven input stands in the equations.
    pub autonomous: bool,
    /// The time itself stands in the equations, beside driven inputs.
    pub explicit_time: bool,
    /// The energy is T(p) + V(q, t): the mass matrix is constant and no velocity multiplies a
    /// function of the coordinates.
    pub separable: bool,
    /// The accelerations contain no velocity.
    pub velocity_free: bool,
    /// The mass matrix contains neither coordinates, velocities nor time.
    pub constant_mass_matrix: bool,
    /// There is a `dissipation` or `force` statement.
    pub nonconservative: bool,
    /// No `abs`, `sign`, `min` or `max` of something that moves stands in the accelerations.
    pub smooth: bool,
    /// The accelerations are linear in coordinates and velocities, with coefficients that the
    /// parameters alone decide.
    pub linear: bool,
    /// The coordinates that do not stand in the Lagrangian, by index.
    pub cyclic: &'static [usize],
    /// The conserved quantities that [`System::conserved`] gives, in terms of the momenta: `p_φ`,
    /// `x·p_y − y·p_x`. The energy is not among them; it is conserved where [`System::power`] is
    /// zero, as it is without `dissipation` and `force` if neither time nor a driven input stands
    /// in the energy.
    pub conserved: &'static [&'static str],
    /// The parameters that the accelerations do not need.
    pub unused: &'static [&'static str],
    /// The equations of motion, one line a coordinate.
    pub equations: &'static str,
    pub(crate) latex: &'static str,
    /// `lagrangian!` has made the system, so that it has a mass matrix.
    pub(crate) derived: bool,
}

impl Facts {
    /// The facts of a system about which nothing is known but its names.
    pub const fn new(name: &'static str, coordinates: &'static [&'static str]) -> Self {
        Self {
            name,
            coordinates,
            parameters: &[],
            units: &[],
            inputs: &[],
            autonomous: false,
            explicit_time: true,
            separable: false,
            velocity_free: false,
            constant_mass_matrix: false,
            nonconservative: true,
            smooth: false,
            linear: false,
            cyclic: &[],
            conserved: &[],
            unused: &[],
            equations: "",
            latex: "",
            derived: false,
        }
    }

    /// The equations of motion in LaTeX, one line a coordinate.
    pub const fn latex(&self) -> &'static str {
        self.latex
    }
}

/// What a system takes from one of its driven inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input {
    /// The name as written.
    pub name: &'static str,
    /// The number of components.
    pub components: usize,
    /// What the accelerations and forces need.
    pub accelerations: Derivatives,
    /// What momenta, velocities and momentum rates need.
    pub momenta: Derivatives,
    /// What the energy needs.
    pub energy: Derivatives,
    /// What the power needs.
    pub power: Derivatives,
}

/// The samples of all driven inputs of a system: `()` or a tuple of [`Sample`]s.
pub trait Samples: Copy + Debug + PartialEq {
    /// The first number that is not finite: the input, the derivative (0 for the position) and the
    /// component, by index.
    fn first_not_finite(&self) -> Option<(usize, usize, usize)>;
}

impl Samples for () {
    fn first_not_finite(&self) -> Option<(usize, usize, usize)> {
        None
    }
}

macro_rules! samples {
    ($(($($dim:ident $index:tt),+))+) => {$(
        impl<T: Real, $(const $dim: usize),+> Samples for ($(Sample<T, $dim>,)+) {
            fn first_not_finite(&self) -> Option<(usize, usize, usize)> {
                $(if let Some((derivative, component)) = first_in_sample(&self.$index) {
                    return Some(($index, derivative, component));
                })+
                None
            }
        }
    )+};
}

samples! {
    (A 0)
    (A 0, B 1)
    (A 0, B 1, C 2)
    (A 0, B 1, C 2, D 3)
    (A 0, B 1, C 2, D 3, E 4)
    (A 0, B 1, C 2, D 3, E 4, F 5)
    (A 0, B 1, C 2, D 3, E 4, F 5, G 6)
    (A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7)
}

/// The derivative and the component of the first number in `sample` that is not finite.
fn first_in_sample<T: Real, const D: usize>(sample: &Sample<T, D>) -> Option<(usize, usize)> {
    // Times zero, infinity and what is not a number are not zero; everything else is.
    let zero = T::from_f64(0.0);
    let infinite = |x: &T| *x * zero != zero;
    let derivatives = [&sample.position, &sample.velocity, &sample.acceleration];
    derivatives
        .iter()
        .enumerate()
        .find_map(|(derivative, values)| Some((derivative, values.iter().position(infinite)?)))
}

/// The output for which a driven input is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// [`System::accelerations`] and [`System::forces`].
    Accelerations,
    /// [`System::momenta`], [`System::velocities`], [`System::momentum_rates`] and
    /// [`System::mass_matrix`].
    Momenta,
    /// [`System::energy`] and the two energies of [`SplitEnergy`].
    Energy,
    /// [`System::power`].
    Power,
}

impl Input {
    /// The derivatives that `purpose` needs.
    pub const fn derivatives(&self, purpose: Purpose) -> Derivatives {
        match purpose {
            Purpose::Accelerations => self.accelerations,
            Purpose::Momenta => self.momenta,
            Purpose::Energy => self.energy,
            Purpose::Power => self.power,
        }
    }
}

/// A system with a motion for each of its driven inputs: what an integrator takes.
///
/// Every system without driven inputs is one; a driven one becomes one by its method `driven_by`,
/// which gives a [`Driven`].
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be integrated",
    label = "no system whose driven inputs have motions",
    note = "integrators take systems that `lagrangian!` has made; driven inputs get their motions by `.driven_by(…)`"
)]
pub trait Dynamics<const N: usize> {
    /// The system.
    type System: System<N, Scalar = Self::Scalar>;
    /// Its scalar.
    type Scalar: Real;

    /// The system.
    fn system(&self) -> &Self::System;

    /// The samples of all driven inputs at `t`, seen from `side`, with the derivatives that
    /// `purpose` needs.
    fn inputs(&self, t: Time, side: Side, purpose: Purpose) -> <Self::System as System<N>>::Inputs;

    /// The first time after `t` at which a derivative of a driven input jumps.
    fn next_kink(&self, t: f64) -> Option<f64>;

    /// The longest step from `t` over the motions, as
    /// [`Motion::longest_step`](crate::motion::Motion::longest_step); `unknown` stands for the
    /// answer of those that do not know, and of dynamics with inputs that do not say it.
    #[inline]
    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        let _ = (t, widths);
        if <Self::System as System<N>>::FACTS.inputs.is_empty() { f64::INFINITY } else { unknown }
    }

    /// The accelerations at `t`, seen from `side`.
    #[inline]
    fn accelerations_at(
        &self,
        t: Time,
        side: Side,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        self.accelerations_with(&self.system().prepare(), t, side, q, v)
    }

    /// The accelerations at `t`, seen from `side`, with what the parameters alone decide computed
    /// before: what all methods call, and the place for forces beside those of the system.
    #[inline]
    fn accelerations_with(
        &self,
        prepared: &<Self::System as System<N>>::Prepared,
        t: Time,
        side: Side,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        let inputs = self.inputs(t, side, Purpose::Accelerations);
        self.system().accelerations_prepared(prepared, scalar_time(t), q, v, &inputs)
    }

    /// The Jacobi integral at `t`.
    fn energy_at(&self, t: f64, q: &[Self::Scalar; N], v: &[Self::Scalar; N]) -> Self::Scalar {
        let t = Time::new(t);
        let inputs = self.inputs(t, Side::After, Purpose::Energy);
        self.system().energy(scalar_time(t), q, v, &inputs)
    }

    /// dE/dt at `t`.
    fn power_at(&self, t: f64, q: &[Self::Scalar; N], v: &[Self::Scalar; N]) -> Self::Scalar {
        let t = Time::new(t);
        let inputs = self.inputs(t, Side::After, Purpose::Power);
        self.system().power(scalar_time(t), q, v, &inputs)
    }

    /// The velocities beyond a kink at `t` from those on the side `from`: the momenta are the same
    /// on both sides.
    ///
    /// Where nothing that the momenta contain jumps, they are the same numbers.
    fn across_kink(
        &self,
        t: Time,
        from: Side,
        q: &[Self::Scalar; N],
        v: &[Self::Scalar; N],
    ) -> [Self::Scalar; N] {
        let near = self.inputs(t, from, Purpose::Momenta);
        let far = self.inputs(t, from.opposite(), Purpose::Momenta);
        if near == far {
            return *v;
        }
        let p = self.system().momenta(scalar_time(t), q, v, &near);
        self.system().velocities(scalar_time(t), q, &p, &far)
    }
}

/// `t` in the scalar of a system, with both of its words.
#[inline]
pub fn scalar_time<T: Real>(t: Time) -> T {
    T::from_f64(t.to_f64()) + T::from_f64(t.low())
}

/// The samples of the driven inputs of a system `S` that has none: `()`.
#[diagnostic::on_unimplemented(
    message = "`{S}` has driven inputs; give their motions by `.driven_by(…)`",
    label = "the motions of its driven inputs are missing",
    note = "`driven_by` takes one motion for each driven input, in the order of declaration"
)]
pub trait NoInputs<S>: Samples {
    /// No samples.
    fn none() -> Self;
}

impl<S> NoInputs<S> for () {
    #[inline]
    fn none() {}
}

impl<const N: usize, S: System<N, Inputs: NoInputs<S>>> Dynamics<N> for S {
    type System = S;
    type Scalar = S::Scalar;

    fn system(&self) -> &S {
        self
    }

    #[inline]
    fn inputs(&self, _: Time, _: Side, _: Purpose) -> S::Inputs {
        NoInputs::none()
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

/// Some dynamics with what their parameters alone decide computed once: what steppers work with.
#[derive(Debug)]
pub struct Prepared<'a, D, P> {
    dynamics: &'a D,
    prepared: P,
}

impl<D, P: Copy> Clone for Prepared<'_, D, P> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<D, P: Copy> Copy for Prepared<'_, D, P> {}

impl<'a, D, P> Prepared<'a, D, P> {
    /// Prepares the system of `dynamics`.
    pub fn new<const N: usize>(dynamics: &'a D) -> Self
    where
        D: Dynamics<N>,
        D::System: System<N, Prepared = P>,
    {
        Self { dynamics, prepared: dynamics.system().prepare() }
    }

    /// The dynamics.
    pub(crate) fn dynamics(&self) -> &'a D {
        self.dynamics
    }
}

impl<const N: usize, D: Dynamics<N>> Dynamics<N>
    for Prepared<'_, D, <D::System as System<N>>::Prepared>
{
    type System = D::System;
    type Scalar = D::Scalar;

    fn system(&self) -> &D::System {
        self.dynamics.system()
    }

    #[inline]
    fn inputs(&self, t: Time, side: Side, purpose: Purpose) -> <D::System as System<N>>::Inputs {
        self.dynamics.inputs(t, side, purpose)
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        self.dynamics.next_kink(t)
    }

    #[inline]
    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        self.dynamics.longest_step(t, widths, unknown)
    }

    #[inline]
    fn accelerations_at(
        &self,
        t: Time,
        side: Side,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
    ) -> [D::Scalar; N] {
        self.dynamics.accelerations_with(&self.prepared, t, side, q, v)
    }

    #[inline]
    fn accelerations_with(
        &self,
        prepared: &<D::System as System<N>>::Prepared,
        t: Time,
        side: Side,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
    ) -> [D::Scalar; N] {
        self.dynamics.accelerations_with(prepared, t, side, q, v)
    }
}

/// A system and the motions of its driven inputs.
#[derive(Clone, Debug)]
pub struct Driven<S, M> {
    /// The system.
    pub system: S,
    /// A tuple of motions in the order of declaration.
    pub motions: M,
}

impl<S, M> Driven<S, M> {
    /// Binds `motions`, a tuple with one motion for each driven input; does not compile if one of
    /// them lacks a derivative that the equations need.
    pub fn new<const N: usize>(system: S, motions: M) -> Self
    where
        S: System<N>,
        M: Motions<S::Inputs>,
    {
        const {
            assert!(
                sufficient(M::HAS, S::FACTS.inputs),
                "a motion that `driven_by` was given lacks a derivative that the equations of motion need; a `Function` gets them by `.velocity(…)` and `.acceleration(…)`"
            );
        };
        Self { system, motions }
    }
}

impl<const N: usize, S: System<N>, M: Motions<S::Inputs>> Dynamics<N> for Driven<S, M> {
    type System = S;
    type Scalar = S::Scalar;

    fn system(&self) -> &S {
        &self.system
    }

    #[inline]
    fn inputs(&self, t: Time, side: Side, purpose: Purpose) -> S::Inputs {
        self.motions.sample(t, side, S::FACTS.inputs, purpose)
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        self.motions.next_kink(t)
    }

    #[inline]
    fn longest_step(&self, t: f64, widths: f64, unknown: f64) -> f64 {
        self.motions.longest_step(t, widths, unknown)
    }
}
