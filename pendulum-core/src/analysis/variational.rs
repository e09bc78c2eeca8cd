//! Sensitivities of a motion with respect to its initial state and parameters.

use crate::integrate::State;
use crate::scalar::{Dual, Real};
use crate::system::{At, Facts, Jacobians, Samples, Staged, System, Table, VelocityFree};
use nalgebra::{DMatrix, SMatrix};

/// A system with the variational equations along its motion. It is a system as well, for `Picard`
/// and every method that supports equations written by hand (the method must be named: `Picard`,
/// `Dop853`, `Gauss`, …).
///
/// The `M` coordinates are the `N` coordinates of the system, followed by columns of `N` numbers:
/// ∂q/∂q₀ for each initial coordinate, ∂q/∂q̇₀ for each initial velocity, and ∂q/∂p for as many
/// parameters as fit, in the order of `FACTS.parameters`. The velocities are the derivatives of q̇
/// in the same order. Each column δq obeys δq̈ = A δq + B δq̇ + c with the generated Jacobians A =
/// ∂q̈/∂q, B = ∂q̈/∂q̇ and, for a parameter, c = ∂q̈/∂p. [`variational_size`] returns `M`.
///
/// With constraints, among them those of a `rotation`, columns are tangent to the constraints:
/// C δq = 0, which is q·δq = 0 for a quaternion. [`start`](Self::start) makes tangent columns.
/// Constraints other than the lengths of rotations do not compile in equations that contain the
/// time or an input.
///
/// Inputs are not varied: the columns do not include the law of control inputs.
///
/// Where accelerations jump, as at the zero of a `sign`, the columns jump with them (Aizerman and
/// Gantmacher 1958), except in steps of fixed length, which do not end there.
///
/// Step control applies to the columns as well as to the motion. At a kink, the derivatives of the
/// momenta are continuous, as are the momenta.
///
/// ```
/// use pendulum_runtime::prelude::*;
/// use pendulum_runtime::analysis::{Variational, variational_size};
///
/// # mod system {
/// pendulum_runtime::lagrangian! {
///     pub struct Spring { k, m }
///     coordinate x;
///     kinetic = m*ẋ^2/2;
///     potential = k*x^2/2;
/// }
/// # }
/// # use system::Spring;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // One coordinate, and of its two parameters the first.
/// const M: usize = variational_size(1, 1);
/// let spring = Variational::<_, 1, M>::new(Spring::new(4.0, 1.0));
/// let (q, v) = spring.start([1.0], [0.0]);
/// let end = solve(&spring, (0.0, 1.0), q, v).method(Dop853).rtol(1e-12).atol(1e-12).run()?.end;
/// // x = cos ωt with ω² = k/m.
/// let (by_k, _) = spring.by_parameter(&end, 0);
/// assert!((by_k[0] + 2.0_f64.sin() / 4.0).abs() < 1e-10);
/// let transition = spring.transition(&end);
/// assert!((transition.trace() - 2.0 * 2.0_f64.cos()).abs() < 1e-10);
/// # Ok(())
/// # }
/// ```
///
/// The variational equations of a driven system are added before its motions:
/// `Driven::new(Variational::<_, 1, M>::new(pendulum), (hand,))`.
///
/// Derivatives by a few parameters, chosen by name, of any dynamics and in as many columns as
/// wanted, are [`Solution::sensitivities`](crate::integrate::Solution::sensitivities) of a run.
///
/// Source: Hairer, Nørsett and Wanner (1993), Solving Ordinary Differential Equations I, I.14,
/// equations 14.6 and 14.8.
#[derive(Clone, Copy, Debug)]
pub struct Variational<S, const N: usize, const M: usize> {
    system: S,
}

/// Returns the number of coordinates of a [`Variational`] system with `coordinates` and the
/// sensitivities to the first `parameters`.
pub const fn variational_size(coordinates: usize, parameters: usize) -> usize {
    coordinates * (1 + 2 * coordinates + parameters)
}

impl<S: Jacobians<N>, const N: usize, const M: usize> Variational<S, N, M> {
    /// The number of parameters whose sensitivities are computed.
    pub const PARAMETERS: usize = {
        assert!(
            0 < N && M.is_multiple_of(N) && variational_size(N, 0) <= M,
            "the size of a variational system is `variational_size(coordinates, parameters)`"
        );
        let parameters = M / N - 1 - 2 * N;
        assert!(parameters <= S::FACTS.parameters.len(), "there are not as many parameters");
        parameters
    };

    /// Adds the variational equations to a system.
    pub const fn new(system: S) -> Self {
        const { assert!(Self::PARAMETERS <= M) };
        const {
            assert!(
                S::FACTS.only_rotations() || S::FACTS.autonomous,
                "the start of columns on constraints other than those of rotations is not written yet for equations that contain the time or an input: use `solution.sensitivities`, or coordinates that fulfil the constraints"
            );
            assert!(
                S::FACTS.limits.is_empty(),
                "variations jump where a limit strikes, which is not written yet: leave the limits out"
            );
            assert!(
                S::FACTS.frictions.is_empty(),
                "variations jump where a dry friction begins to stick, which is not written yet: leave the frictions out, or write `dissipation` or a force with `tanh(rate/eps)`"
            );
            assert!(
                S::FACTS.states == 0,
                "the variations of a `state` follow its rate, which is not written yet: give it by a coordinate with an inertia"
            );
        };
        Self { system }
    }

    /// Returns the initial coordinates and velocities for `q` and `v`; the derivatives are those of
    /// the identity, projected onto the constraints in the metric of the mass matrix.
    pub fn start(&self, q: [S::Scalar; N], v: [S::Scalar; N]) -> ([S::Scalar; M], [S::Scalar; M]) {
        // The columns of the coordinates precede those of the velocities. Column `first + k` has
        // its 1 in row k.
        let columns = |own: [S::Scalar; N], first: usize| {
            core::array::from_fn(|index| match (index / N, index % N) {
                (0, row) => own[row],
                (group, row) => number(if group == 1 + first + row { 1.0 } else { 0.0 }),
            })
        };
        let (mut q, mut v) = (columns(q, 0), columns(v, N));
        // The constraints contain neither the time nor inputs.
        self.onto_constraints(number(0.0), &mut q, &mut v, &S::Inputs::zero());
        (q, v)
    }

    /// Changes the columns such that the varied states fulfil the constraints, to first order.
    pub(super) fn onto_constraints(
        &self,
        t: S::Scalar,
        q: &mut [S::Scalar; M],
        v: &mut [S::Scalar; M],
        inputs: &S::Inputs,
    ) {
        if S::FACTS.held_constraints() == 0 {
            return;
        }
        // The rates depend on the coordinates, which are corrected first.
        for part in 0..2 {
            let at = At { t, q, v, inputs };
            let none = [number(0.0); N];
            let misfits = self.derivatives(none, at, |system, at| system.misfits(at)[part]);
            let mut changes = [number(0.0); M];
            for (index, changes) in changes.chunks_exact_mut(N).enumerate() {
                let misfit = column(&misfits, index);
                let own = Self::own(at, |at| self.system.correction(at, &misfit));
                changes.copy_from_slice(&own);
            }
            let values = if part == 0 { &mut *q } else { &mut *v };
            for (value, change) in values.iter_mut().zip(&changes) {
                *value -= *change;
            }
        }
    }

    /// Returns the state of the system without the columns.
    pub fn state(&self, state: &State<S::Scalar, M>) -> State<S::Scalar, N> {
        State { t: state.t, q: column(&state.q, 0), v: column(&state.v, 0) }
    }

    /// Returns the derivatives of q and q̇ by the initial coordinate `index`.
    ///
    /// # Panics
    /// Panics if there is no such coordinate.
    pub fn by_position(
        &self,
        state: &State<S::Scalar, M>,
        index: usize,
    ) -> ([S::Scalar; N], [S::Scalar; N]) {
        assert!(index < N, "there is no coordinate {index}");
        (column(&state.q, 1 + index), column(&state.v, 1 + index))
    }

    /// Returns the derivatives of q and q̇ by the initial velocity `index`.
    ///
    /// # Panics
    /// Panics if there is no such coordinate.
    pub fn by_velocity(
        &self,
        state: &State<S::Scalar, M>,
        index: usize,
    ) -> ([S::Scalar; N], [S::Scalar; N]) {
        assert!(index < N, "there is no coordinate {index}");
        (column(&state.q, 1 + N + index), column(&state.v, 1 + N + index))
    }

    /// Returns the derivatives of q and q̇ by the parameter `index` in `FACTS.parameters`.
    ///
    /// # Panics
    /// Panics if the sensitivities to this parameter are not computed.
    pub fn by_parameter(
        &self,
        state: &State<S::Scalar, M>,
        index: usize,
    ) -> ([S::Scalar; N], [S::Scalar; N]) {
        assert!(
            index < Self::PARAMETERS,
            "the sensitivities to parameter {index} are not computed"
        );
        (column(&state.q, 1 + 2 * N + index), column(&state.v, 1 + 2 * N + index))
    }

    /// Returns the state transition matrix ∂(q, q̇)/∂(q₀, q̇₀), 2`N` by 2`N`. After a period of a
    /// periodic system it is the monodromy matrix. With constraints it has a zero eigenvalue for
    /// each direction across them.
    pub fn transition(&self, state: &State<S::Scalar, M>) -> DMatrix<S::Scalar> {
        DMatrix::from_fn(2 * N, 2 * N, |row, column| {
            if row < N {
                state.q[(1 + column) * N + row]
            } else {
                state.v[(1 + column) * N + row - N]
            }
        })
    }

    /// Returns `of` the system without the columns, at its part of the state.
    #[inline]
    fn own<R>(
        At { t, q, v, inputs }: At<'_, S::Scalar, S::Inputs, M>,
        of: impl FnOnce(At<'_, S::Scalar, S::Inputs, N>) -> R,
    ) -> R {
        of(At { t, q: &column(q, 0), v: &column(v, 0), inputs })
    }

    /// Returns `own`, followed by the directional derivative of `output` along each column.
    ///
    /// The arguments of `output` are the system and the state over dual numbers.
    fn derivatives(
        &self,
        own: [S::Scalar; N],
        At { t, q, v, inputs }: At<'_, S::Scalar, S::Inputs, M>,
        output: impl Fn(
            &Lifted<S, N>,
            At<'_, Dual<S::Scalar>, LiftedInputs<S, N>, N>,
        ) -> [Dual<S::Scalar>; N],
    ) -> [S::Scalar; M] {
        let inputs = inputs.map(Dual::constant);
        let mut all = [number(0.0); M];
        all[..N].copy_from_slice(&own);
        for index in 1..M / N {
            let mut parameter = 0;
            let system = self.system.over(|value| {
                parameter += 1;
                // The parameters follow the 2N columns of the state.
                if parameter + 2 * N == index {
                    Dual::variable(value)
                } else {
                    Dual::constant(value)
                }
            });
            let lift = |all: &[S::Scalar; M]| {
                let (value, derivative) =
                    (column::<_, N, M>(all, 0), column::<_, N, M>(all, index));
                core::array::from_fn(|i| Dual { value: value[i], derivative: derivative[i] })
            };
            let at = At { t: Dual::constant(t), q: &lift(q), v: &lift(v), inputs: &inputs };
            let found = output(&system, at);
            all[index * N..][..N].copy_from_slice(&found.map(|dual| dual.derivative));
        }
        all
    }
}

/// The greatest number of switches of a varied system, such that the memory for their arguments is
/// an array.
const MOST_SWITCHES: usize = 64;

type Lifted<S, const N: usize> = <S as Jacobians<N>>::Over<Dual<<S as System<N>>::Scalar>>;
type LiftedInputs<S, const N: usize> = <Lifted<S, N> as System<N>>::Inputs;

fn number<T: Real>(value: f64) -> T {
    T::from_f64(value)
}

/// Returns the numbers of the system, followed by `rest` in every column.
fn padded<T: Real, const N: usize, const M: usize>(own: [T; N], rest: f64) -> [T; M] {
    core::array::from_fn(|i| if i < N { own[i] } else { number(rest) })
}

/// Returns the `index`-th group of `N` numbers.
#[inline]
fn column<T: Copy, const N: usize, const M: usize>(all: &[T; M], index: usize) -> [T; N] {
    core::array::from_fn(|i| all[index * N + i])
}

impl<S: Jacobians<N>, const N: usize, const M: usize> Variational<S, N, M> {
    /// Returns the accelerations `own` of the system, followed by those of all columns.
    #[inline]
    fn extended(&self, own: [S::Scalar; N], at: At<'_, S::Scalar, S::Inputs, M>) -> [S::Scalar; M] {
        let At { q, v, .. } = at;
        let by_position = Self::own(at, |at| self.system.position_jacobian(at));
        let mut all = [number(0.0); M];
        all[..N].copy_from_slice(&own);
        for start in (N..M).step_by(N) {
            for i in 0..N {
                for j in 0..N {
                    all[start + i] += by_position[(i, j)] * q[start + j];
                }
            }
        }
        if !S::FACTS.velocity_free {
            let by_velocity = Self::own(at, |at| self.system.velocity_jacobian(at));
            for start in (N..M).step_by(N) {
                for i in 0..N {
                    for j in 0..N {
                        all[start + i] += by_velocity[(i, j)] * v[start + j];
                    }
                }
            }
        }
        if 0 < Self::PARAMETERS {
            let mut columns = [[number(0.0); N]; M];
            let columns = &mut columns[..Self::PARAMETERS];
            Self::own(at, |at| self.system.parameter_jacobian(at, columns));
            for (k, column) in columns.iter().enumerate() {
                for i in 0..N {
                    all[(1 + 2 * N + k) * N + i] += column[i];
                }
            }
        }
        all
    }
}

impl<S: Jacobians<N>, const N: usize, const M: usize> System<M> for Variational<S, N, M> {
    type Scalar = S::Scalar;
    type Inputs = S::Inputs;
    type With<U: Real> = Variational<S::Over<U>, N, M>;
    type Prepared = S::Prepared;

    const FACTS: Facts = Facts { separable: false, cyclic: &[], ..S::FACTS };

    fn map<U: Real>(&self, map: impl FnMut(S::Scalar) -> U) -> Self::With<U> {
        Variational { system: self.system.over(map) }
    }

    fn prepare(&self) -> S::Prepared {
        self.system.prepare()
    }

    #[inline]
    fn accelerations_prepared(
        &self,
        prepared: &S::Prepared,
        at: At<'_, S::Scalar, S::Inputs, M>,
    ) -> [S::Scalar; M] {
        let own = Self::own(at, |at| self.system.accelerations_prepared(prepared, at));
        self.extended(own, at)
    }

    fn accelerations(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> [S::Scalar; M] {
        self.extended(Self::own(at, |at| self.system.accelerations(at)), at)
    }

    /// Returns the energy of the system.
    fn energy(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> S::Scalar {
        Self::own(at, |at| self.system.energy(at))
    }

    /// Returns the power of the system.
    fn power(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> S::Scalar {
        Self::own(at, |at| self.system.power(at))
    }

    /// Returns the momenta of the system and their derivatives.
    fn momenta(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> [S::Scalar; M] {
        let own = Self::own(at, |at| self.system.momenta(at));
        self.derivatives(own, at, System::momenta)
    }

    fn velocities(
        &self,
        t: S::Scalar,
        q: &[S::Scalar; M],
        p: &[S::Scalar; M],
        inputs: &S::Inputs,
    ) -> [S::Scalar; M] {
        let own = self.system.velocities(t, &column(q, 0), &column(p, 0), inputs);
        self.derivatives(own, At { t, q, v: p, inputs }, |system, At { t, q, v: p, inputs }| {
            system.velocities(t, q, p, inputs)
        })
    }

    /// Returns a block-diagonal matrix with the mass matrix of the system for the motion and for
    /// each column.
    fn mass_matrix(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> SMatrix<S::Scalar, M, M> {
        let block = Self::own(at, |at| self.system.mass_matrix(at));
        SMatrix::from_fn(|row, column| {
            if row / N == column / N { block[(row % N, column % N)] } else { number(0.0) }
        })
    }

    fn forces(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> [S::Scalar; M] {
        let block = Self::own(at, |at| self.system.mass_matrix(at));
        let a = self.accelerations(at);
        let own = Self::own(at, |at| self.system.forces(at));
        core::array::from_fn(|index| {
            let (group, row) = (index / N, index % N);
            if group == 0 {
                own[row]
            } else {
                (0..N).fold(number(0.0), |sum, j| sum + block[(row, j)] * a[group * N + j])
            }
        })
    }

    /// Returns the conserved quantities of the system.
    fn conserved(&self, at: At<'_, S::Scalar, S::Inputs, M>, values: &mut [S::Scalar]) {
        Self::own(at, |at| self.system.conserved(at, values));
    }

    // Only the motion is projected onto its constraints. The columns stay in the tangent space
    // because the equations keep C δq at zero, with an error that grows with the time.

    fn misfits(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> [[S::Scalar; M]; 2] {
        Self::own(at, |at| self.system.misfits(at)).map(|part| padded(part, 0.0))
    }

    fn misfit_scales(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> [[S::Scalar; M]; 2] {
        Self::own(at, |at| self.system.misfit_scales(at)).map(|part| padded(part, 0.0))
    }

    fn redundant_misfits(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> [[S::Scalar; M]; 2] {
        Self::own(at, |at| self.system.redundant_misfits(at)).map(|part| padded(part, 0.0))
    }

    fn correction(
        &self,
        at: At<'_, S::Scalar, S::Inputs, M>,
        target: &[S::Scalar; M],
    ) -> [S::Scalar; M] {
        padded(Self::own(at, |at| self.system.correction(at, &column(target, 0))), 0.0)
    }

    fn constraint_jacobian(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> SMatrix<S::Scalar, M, M> {
        let own = Self::own(at, |at| self.system.constraint_jacobian(at));
        let mut all: SMatrix<_, M, M> = SMatrix::from_element(number(0.0));
        all.fixed_view_mut::<N, N>(0, 0).copy_from(&own);
        all
    }

    fn constraint_rates(
        &self,
        at: At<'_, S::Scalar, S::Inputs, M>,
        change: &[S::Scalar; M],
    ) -> [S::Scalar; M] {
        padded(Self::own(at, |at| self.system.constraint_rates(at, &column(change, 0))), 0.0)
    }

    fn squared_gradients(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> [S::Scalar; M] {
        padded(Self::own(at, |at| self.system.squared_gradients(at)), 0.0)
    }

    fn reactions(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> [S::Scalar; M] {
        padded(Self::own(at, |at| self.system.reactions(at)), 0.0)
    }

    fn independence(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> [S::Scalar; M] {
        padded(Self::own(at, |at| self.system.independence(at)), 1.0)
    }

    /// Returns the bound of the system: the derivatives of its functions of time have the same
    /// widths.
    fn longest_step(&self, t: S::Scalar, widths: S::Scalar) -> S::Scalar {
        self.system.longest_step(t, widths)
    }

    fn __given_tables(&self, visit: &mut dyn FnMut(&Table)) {
        self.system.__given_tables(visit);
    }

    fn __tables_mut(&mut self, visit: &mut dyn FnMut(&mut Table, [f64; 2])) {
        self.system.__tables_mut(visit);
    }

    fn __tables(
        &self,
        at: At<'_, S::Scalar, S::Inputs, M>,
        visit: &mut dyn FnMut(&'static str, [f64; 2], S::Scalar),
    ) {
        Self::own(at, |at| self.system.__tables(at, visit));
    }

    /// Returns the jump of each column, (q̈⁺ − q̈⁻) δs/ṡ, where the argument s changes by δs with
    /// the column: a varied motion passes the zero of s earlier by δs/ṡ.
    fn jump(
        &self,
        index: usize,
        rate: S::Scalar,
        at: At<'_, S::Scalar, S::Inputs, M>,
        change: &[S::Scalar; M],
    ) -> Option<[S::Scalar; M]> {
        const { assert!(S::FACTS.switches.len() <= MOST_SWITCHES, "there are too many switches") };
        if change[..N].iter().all(|change| *change == number(0.0)) {
            return None;
        }
        let mut all = self.derivatives([number(0.0); N], at, |system, at| {
            let mut values = [Dual::constant(number(0.0)); MOST_SWITCHES];
            system.arguments(at, &mut values[..=index]);
            [values[index]; N]
        });
        for (i, column) in all.iter_mut().enumerate() {
            *column *= change[i % N] / rate;
        }
        Some(all)
    }

    /// Returns the arguments of the system.
    fn arguments(&self, at: At<'_, S::Scalar, S::Inputs, M>, values: &mut [S::Scalar]) {
        Self::own(at, |at| self.system.arguments(at, values));
    }

    fn momentum_rates(&self, at: At<'_, S::Scalar, S::Inputs, M>) -> [S::Scalar; M] {
        let own = Self::own(at, |at| self.system.momentum_rates(at));
        self.derivatives(own, at, System::momentum_rates)
    }
}

/// A single stage, which [`Picard`](crate::integrate::Picard) evaluates at eight times at once.
impl<S: Jacobians<N>, const N: usize, const M: usize> Staged<M> for Variational<S, N, M> {
    type AtTime = ();
    type AtPosition = ();

    #[inline]
    fn at_time(_: S::Scalar, _: &S::Inputs) {}

    #[inline]
    fn at_position(
        &self,
        _: &S::Prepared,
        (): &(),
        _: S::Scalar,
        _: &[S::Scalar; M],
        _: &S::Inputs,
    ) {
    }

    #[inline]
    fn accelerations_staged(
        &self,
        prepared: &S::Prepared,
        (): &(),
        (): &(),
        t: S::Scalar,
        q: &[S::Scalar; M],
        v: &[S::Scalar; M],
        inputs: &S::Inputs,
    ) -> [S::Scalar; M] {
        self.accelerations_prepared(prepared, At { t, q, v, inputs })
    }
}

/// If the accelerations do not depend on velocities, their derivatives do not either.
impl<S: Jacobians<N> + VelocityFree<N>, const N: usize, const M: usize> VelocityFree<M>
    for Variational<S, N, M>
{
}
