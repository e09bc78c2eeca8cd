//! Projection onto the constraints, in the metric of the mass matrix.
//!
//! The accelerations keep the constraints as long as a state fulfils them, but the errors of the
//! steps would grow with the square of the time. Each step therefore ends on the nearest state that
//! fulfils the constraints: q − M⁻¹Cᵀ(C M⁻¹Cᵀ)⁻¹g, repeated, and v − M⁻¹Cᵀ(C M⁻¹Cᵀ)⁻¹(C v + b). The
//! corrections are impulses of the constraint forces. Momenta conserved by these forces are
//! therefore preserved, and the energy changes in second order only.
//!
//! Sources: E. Eich, SIAM J. Numer. Anal. 30 (1993) 1467; E. Hairer, C. Lubich, G. Wanner,
//! Geometric Numerical Integration (2006), IV.4.

use crate::error::{Error, Part};
use crate::integrate::field::first_in_state;
use crate::integrate::field::phase::Phase;
use crate::integrate::state::State;
use crate::integrate::state::compensated::Compensated;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::saved::Memory;
use crate::integrate::stats::{ConstraintStats, Extreme};
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::{At, Dynamics, Facts, Purpose, System, is_constrained, scalar_time};
use crate::time::Time;

/// The maximum number of Newton iterations; from the end of a step, one or two are sufficient.
const MOST: usize = 8;

/// Returns the facts about the system of the dynamics `D`.
const fn facts<D: Dynamics<N>, const N: usize>() -> &'static Facts {
    &<D::System as System<N>>::FACTS
}

/// The data of a projection at one time.
struct Projection<'d, D: Dynamics<N>, const N: usize> {
    dynamics: &'d D,
    time: D::Scalar,
    inputs: <D::System as System<N>>::Inputs,
}

impl<'d, D: Dynamics<N, Scalar: Float>, const N: usize> Projection<'d, D, N> {
    fn new(dynamics: &'d D, t: Time, side: Side) -> Self {
        let inputs = dynamics.inputs(t, side, Purpose::Momenta);
        Self { dynamics, time: scalar_time(t), inputs }
    }

    fn misfits(&self, q: &[D::Scalar; N], v: &[D::Scalar; N]) -> [[D::Scalar; N]; 2] {
        self.dynamics.system().misfits(At { t: self.time, q, v, inputs: &self.inputs })
    }

    fn scales(&self, q: &[D::Scalar; N], v: &[D::Scalar; N]) -> [[D::Scalar; N]; 2] {
        self.dynamics.system().misfit_scales(At { t: self.time, q, v, inputs: &self.inputs })
    }

    /// Returns the change to subtract from the state to remove `misfit`, to first order.
    fn correction(
        &self,
        q: &[D::Scalar; N],
        v: &[D::Scalar; N],
        misfit: &[D::Scalar; N],
    ) -> [D::Scalar; N] {
        self.dynamics.system().correction(At { t: self.time, q, v, inputs: &self.inputs }, misfit)
    }
}

/// Returns the length of a correction in units of the rounding errors of the corrected values.
/// Values that are almost zero are measured by the largest value.
fn rounding<T: Float, const N: usize>(change: &[T; N], values: &[T; N]) -> f64 {
    let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.to_f64().abs()));
    let mut most = 0.0f64;
    for (change, value) in change.iter().zip(values) {
        let scale = value.to_f64().abs().max(1e-3 * largest).max(f64::MIN_POSITIVE);
        let own = change.to_f64().abs() / (T::EPSILON.to_f64() * scale);
        most = if own.is_nan() { f64::INFINITY } else { most.max(own) };
    }
    most
}

/// The tangent plane of the constraints at a state; a projection moves a state across this plane.
pub(crate) struct Tangent<'d, D: Dynamics<N>, const N: usize> {
    projection: Projection<'d, D, N>,
    q: [D::Scalar; N],
    v: [D::Scalar; N],
}

impl<'d, D: Dynamics<N, Scalar: Float>, const N: usize> Tangent<'d, D, N> {
    pub(crate) fn new(phase: &Phase<'d, D, N>) -> Self {
        let Phase { dynamics, t, side, q, v } = *phase;
        Self { projection: Projection::new(dynamics, t, side), q: *q, v: *v }
    }

    /// Removes the component across the plane from a change of coordinates, or of velocities.
    pub(crate) fn take_off(&self, change: &mut [D::Scalar; N]) {
        let Self { projection: Projection { dynamics, time, inputs }, q, v } = self;
        let (system, at) = (dynamics.system(), At { t: *time, q, v, inputs });
        let across = system.correction(at, &system.constraint_rates(at, change));
        for i in 0..N {
            change[i] -= across[i];
        }
    }
}

/// The results of a projection.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    /// The largest misfits of positions and of velocities before the projection, with their
    /// constraints.
    pub(crate) misfits: [(f64, usize); 2],
    /// The lengths of the first corrections of both, in units of rounding errors.
    pub(crate) first: [f64; 2],
    /// The remaining misfits of both, in units of the rounding errors of their terms, with the
    /// constraints that have them.
    pub(crate) left: [(f64, usize); 2],
    /// `true` if the projection has changed the state.
    pub(crate) moved: bool,
}

fn largest<T: Float, const N: usize>(values: &[T; N]) -> (f64, usize) {
    let mut most = (0.0, 0);
    for (index, value) in values.iter().enumerate() {
        let value = value.to_f64().abs();
        if most.0 < value || value.is_nan() {
            most = (value, index);
        }
    }
    most
}

/// Returns the largest misfit in units of the rounding errors of its terms.
pub(crate) fn in_rounding<T: Float, const N: usize>(
    misfit: &[T; N],
    scales: &[T; N],
) -> (f64, usize) {
    let mut most = (0.0, 0);
    for index in 0..N {
        let own = misfit[index].to_f64().abs();
        let own = if own == 0.0 {
            0.0
        } else {
            own / (T::EPSILON.to_f64() * scales[index].to_f64()).max(f64::MIN_POSITIVE)
        };
        if most.0 < own || own.is_nan() {
            most = (if own.is_nan() { f64::INFINITY } else { own }, index);
        }
    }
    most
}

/// The misfit that needs no correction, in units of the rounding errors of its terms.
const ROUNDED: f64 = 2.0;

/// Projects `q` and `v` at `t` onto the constraints. At a kink, `side` selects the constraints.
pub(crate) fn project<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    t: Time,
    side: Side,
    q: &mut Compensated<D::Scalar, N>,
    v: &mut Compensated<D::Scalar, N>,
) -> Found {
    let projection = Projection::new(dynamics, t, side);
    let none = (0.0, 0);
    let mut found = Found { misfits: [none; 2], first: [0.0; 2], left: [none; 2], moved: false };
    // After a correction of this length, in units of rounding errors, the next is below rounding.
    let quadratic = 0.25 / D::Scalar::EPSILON.to_f64().sqrt();
    for part in 0..2 {
        // The largest misfit and the values before the last correction, if any.
        let mut before = None;
        let mut scales = projection.scales(&q.high, &v.high)[part];
        for iteration in 0..=MOST {
            let misfit = projection.misfits(&q.high, &v.high)[part];
            let mut left = in_rounding(&misfit, &scales);
            if iteration == 0 {
                found.misfits[part] = largest(&misfit);
            } else if ROUNDED < left.0 {
                // The correction itself has rounding errors. At rest they exceed those of the
                // values before it, some of which may be exactly zero.
                let corrected = projection.scales(&q.high, &v.high)[part];
                scales = core::array::from_fn(|k| {
                    if scales[k] < corrected[k] { corrected[k] } else { scales[k] }
                });
                left = in_rounding(&misfit, &scales);
            }
            let values = if part == 0 { &mut *q } else { &mut *v };
            if let Some((best, own)) = before
                && best <= left.0
            {
                // Almost dependent constraints amplify rounding errors.
                *values = own;
                break;
            }
            let shrinks = before.is_none_or(|(best, _)| left.0 < 0.5 * best);
            found.left[part] = left;
            if left.0 <= ROUNDED || !shrinks || iteration == MOST {
                break;
            }
            before = Some((left.0, *values));
            let change = projection.correction(&q.high, &v.high, &misfit);
            let values = if part == 0 { &mut *q } else { &mut *v };
            let length = rounding(&change, &values.high);
            if iteration == 0 {
                found.first[part] = length;
            }
            values.add(D::Scalar::from_f64(-1.0), &change);
            found.moved = true;
            if length < if part == 0 { quadratic } else { 4.0 } {
                found.left[part].0 = 0.0;
                break;
            }
        }
    }
    found
}

/// Projects the end of a step onto the constraints, and returns `true` if the projection has moved
/// the end. At a kink, `side` selects the constraints.
///
/// # Errors
/// Returns [`Error::DependentConstraints`] for a constraint that depends on earlier constraints,
/// and [`Error::Inconsistent`] if the step has left a constraint too far or if a redundant
/// constraint does not hold.
pub(crate) fn project_end<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    endpoint: &mut Endpoint<D::Scalar, N>,
    side: Side,
    stats: &mut Option<ConstraintStats>,
    gradients: &mut Gradients<N>,
) -> Result<bool, Error> {
    let t = endpoint.t.to_f64();
    let phase = endpoint.phase(dynamics, side);
    gradients.check(&phase)?;
    independent(&phase, stats)?;
    let found = project(dynamics, endpoint.t, side, &mut endpoint.q, &mut endpoint.v);
    let constraints = facts::<D, N>().constraints;
    let (misfit, index) = found.misfits[0];
    if let Some(stats) = stats
        && stats.misfit.value <= misfit
    {
        stats.misfit = Extreme { value: misfit, t, constraint: constraints[index].name };
    }
    for (part, (left, _)) in [Part::Position, Part::Velocity].into_iter().zip(found.left) {
        if allowed::<D::Scalar>() <= left {
            return Err(off::<D, N>(t, part, &found));
        }
    }
    if found.moved {
        endpoint.a = None;
    }
    redundant(&endpoint.phase(dynamics, side))?;
    Ok(found.moved)
}

/// Returns the largest misfit allowed after a projection, in units of the rounding errors of its
/// terms: √ε of the terms.
fn allowed<T: Float>() -> f64 {
    T::EPSILON.to_f64().powf(-0.5)
}

/// Returns the longest correction of a start, in units of rounding errors: ε^(2/3) of the state.
fn rounded<T: Float>() -> f64 {
    T::EPSILON.to_f64().cbrt().recip()
}

/// Returns the error for a constraint that does not hold.
fn off<D: Dynamics<N>, const N: usize>(t: f64, part: Part, found: &Found) -> Error {
    let (residual, index) = found.misfits[usize::from(part == Part::Velocity)];
    let constraint = &facts::<D, N>().constraints[index];
    let rate = part == Part::Velocity && constraint.holonomic;
    let (constraint, unit) = (constraint.name, constraint.unit);
    Error::Inconsistent { t, part, rate, constraint, residual, unit, redundant: false }
}

/// Scales the quaternions whose lengths are within 1e-6 of one, and takes from their velocities
/// what changes the lengths.
///
/// Quaternions come from files and from numbers with six digits. Unlike the misfits of other
/// constraints, their lengths have no meaning.
fn scale_quaternions<D: Dynamics<N, Scalar: Float>, const N: usize>(
    q: &mut [D::Scalar; N],
    v: &mut [D::Scalar; N],
) {
    for constraint in facts::<D, N>().constraints {
        // The constraint of the rotation `R` is `|R|`, which is no name of a user's constraint.
        let name = constraint.name.strip_prefix('|').and_then(|name| name.strip_suffix('|'));
        let mut coordinates = facts::<D, N>().coordinates.iter();
        let first = coordinates.position(|own| name.is_some() && own.strip_suffix(".w") == name);
        let Some(first) = first.filter(|first| first + 4 <= N) else { continue };
        let (q, v) = (&mut q[first..first + 4], &mut v[first..first + 4]);
        let product = |a: &[D::Scalar], b: &[D::Scalar]| {
            a.iter().zip(b).fold(D::Scalar::from_f64(0.0), |sum, (&a, &b)| sum + a * b)
        };
        let (square, rate) = (product(q, q), product(q, v));
        let length = square.sqrt();
        let misfits = [length.to_f64() - 1.0, rate.to_f64()];
        if misfits.iter().all(|misfit| misfit.abs() < 1e-6) {
            for (q, v) in q.iter_mut().zip(v) {
                *v = (*v - *q * rate / square) / length;
                *q /= length;
            }
        }
    }
}

/// Checks the state at a start, and projects it onto the constraints if its misfits are rounding
/// errors, or if they are those of quaternions of nearly length one.
///
/// # Errors
/// Returns [`Error::Inconsistent`] or [`Error::DependentConstraints`].
pub fn start<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    t: Time,
    side: Side,
    mut q: [D::Scalar; N],
    mut v: [D::Scalar; N],
) -> Result<Endpoint<D::Scalar, N>, Error> {
    exact_start(dynamics, t, side, q, v).or_else(|_| {
        scale_quaternions::<D, N>(&mut q, &mut v);
        exact_start(dynamics, t, side, q, v)
    })
}

/// Checks a start, and projects it if its misfits are rounding errors.
fn exact_start<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    t: Time,
    side: Side,
    q: [D::Scalar; N],
    v: [D::Scalar; N],
) -> Result<Endpoint<D::Scalar, N>, Error> {
    let mut endpoint = Endpoint::new(t, q, v);
    if const { is_constrained::<D, N>() } {
        let found = project(dynamics, t, side, &mut endpoint.q, &mut endpoint.v);
        let parts = [Part::Position, Part::Velocity].into_iter().zip(found.first);
        for (part, first) in parts {
            let phase = Phase { dynamics, t, side, q: &q, v: &v };
            if rounded::<D::Scalar>() <= first && !by_time(&phase, part) {
                return Err(off::<D, N>(t.to_f64(), part, &found));
            }
        }
        independent(&endpoint.phase(dynamics, side), &mut None)?;
    }
    redundant(&endpoint.phase(dynamics, side))?;
    Ok(endpoint)
}

/// Returns `true` if the misfits are no larger than the effect of rounding errors of the time. This
/// is the case for a driven constraint at a state in which all other terms are zero.
fn by_time<D: Dynamics<N, Scalar: Float>, const N: usize>(
    phase: &Phase<'_, D, N>,
    part: Part,
) -> bool {
    let Phase { dynamics, t, side, q, v } = *phase;
    let later = t + 64.0 * D::Scalar::EPSILON.to_f64() * t.to_f64().abs();
    let [now, then] =
        [t, later].map(|t| Projection::new(dynamics, t, side).misfits(q, v)[part as usize]);
    now.iter().zip(&then).all(|(now, then)| now.abs() <= (*then - *now).abs())
}

/// Projects the state after a jump onto the constraints. An impulse of the constraint forces
/// changes the velocities, and the coordinates change by no more than their rounding errors.
///
/// # Errors
/// Returns [`Error::Inconsistent`] for coordinates that do not fulfil the constraints.
pub(crate) fn landed<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    t: Time,
    side: Side,
    state: &State<D::Scalar, N>,
) -> Result<State<D::Scalar, N>, Error> {
    let mut state = *state;
    if const { is_constrained::<D, N>() } {
        let (mut q, mut v) = (Compensated::new(state.q), Compensated::new(state.v));
        let found = project(dynamics, t, side, &mut q, &mut v);
        let phase = Phase { dynamics, t, side, q: &state.q, v: &state.v };
        if rounded::<D::Scalar>() <= found.first[0] && !by_time(&phase, Part::Position) {
            return Err(off::<D, N>(t.to_f64(), Part::Position, &found));
        }
        (state.q, state.v) = (q.high, v.high);
    }
    Ok(state)
}

/// Returns the error for the constraint with the largest misfit of positions at a state, or of
/// velocities if all positions fit.
pub fn misfit<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    state: &State<D::Scalar, N>,
) -> Error {
    let projection = Projection::new(dynamics, Time::new(state.t), Side::After);
    let misfits = projection.misfits(&state.q, &state.v).map(|part| largest(&part));
    let none = (0.0, 0);
    let found = Found { misfits, first: [0.0; 2], left: [none; 2], moved: false };
    let part = if misfits[0].0 == 0.0 { Part::Velocity } else { Part::Position };
    off::<D, N>(state.t, part, &found)
}

/// Returns the nearest state that fulfils the constraints, at any distance from `state`.
///
/// # Errors
/// Returns an error if the search ends off the constraints, if constraints depend on each other
/// there, or if the state is not finite.
pub fn nearest<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    state: &State<D::Scalar, N>,
) -> Result<State<D::Scalar, N>, Error> {
    let mut endpoint = Endpoint::new(Time::new(state.t), state.q, state.v);
    project_end(dynamics, &mut endpoint, Side::After, &mut None, &mut Gradients::new())?;
    independent(&endpoint.phase(dynamics, Side::After), &mut None)?;
    if let Some(what) = first_in_state(facts::<D, N>(), &endpoint.q.high, &endpoint.v.high) {
        return Err(Error::NotFinite { t: state.t, what, suspects: Vec::new() });
    }
    Ok(State::from(&endpoint))
}

/// Projects a state for output within a step onto the constraints.
pub(crate) fn deliver<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    t: Time,
    side: Side,
    state: &mut State<D::Scalar, N>,
) {
    let (mut q, mut v) = (Compensated::new(state.q), Compensated::new(state.v));
    project(dynamics, t, side, &mut q, &mut v);
    (state.q, state.v) = (q.high, v.high);
}

/// The largest squared gradient of each constraint so far: Σ C_kj²/M_jj.
///
/// At a change point, for example with all bars of a linkage in a line, a gradient vanishes or
/// depends on others, and another branch of the motion begins. A state closer to the change point
/// than √ε may be on either branch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gradients<const N: usize>([f64; N]);

impl<const N: usize> Gradients<N> {
    pub(crate) fn new() -> Self {
        Self([0.0; N])
    }

    /// Checks that no gradient has vanished compared to the largest gradient of its constraint.
    fn check<D>(&mut self, phase: &Phase<'_, D, N>) -> Result<(), Error>
    where
        D: Dynamics<N, Scalar: Float>,
    {
        let (system, inputs) = (phase.dynamics.system(), phase.momentum_inputs());
        let sizes = system.squared_gradients(phase.at(&inputs));
        for k in 0..facts::<D, N>().held_constraints() {
            let size = sizes[k].to_f64();
            self.0[k] = f64::max(self.0[k], size);
            let independence = size / self.0[k];
            if independence <= least_independence::<D::Scalar>() {
                let (t, constraint) = (phase.t.to_f64(), facts::<D, N>().constraints[k].name);
                return Err(Error::DependentConstraints { t, constraint, independence });
            }
        }
        Ok(())
    }

    /// Visits all gradients.
    pub(crate) fn remember(&mut self, memory: &mut Memory) {
        self.0.iter_mut().for_each(|size| memory.number(size));
    }
}

/// Returns the least independence allowed: half of the digits of a pivot, and some more.
fn least_independence<T: Float>() -> f64 {
    T::EPSILON.to_f64().powf(40.0 / 52.0)
}

/// Checks that no constraint depends on earlier constraints.
fn independent<D: Dynamics<N, Scalar: Float>, const N: usize>(
    phase: &Phase<'_, D, N>,
    stats: &mut Option<ConstraintStats>,
) -> Result<(), Error> {
    let (system, inputs) = (phase.dynamics.system(), phase.momentum_inputs());
    let all = system.independence(phase.at(&inputs));
    let constraints = facts::<D, N>().constraints;
    let mut least = (f64::INFINITY, 0);
    for (index, own) in all.iter().enumerate().take(facts::<D, N>().held_constraints()) {
        let own = own.to_f64();
        if own < least.0 || own.is_nan() {
            least = (own, index);
        }
    }
    let (value, index) = least;
    let (t, constraint) = (phase.t.to_f64(), constraints[index].name);
    if value <= least_independence::<D::Scalar>() || value.is_nan() {
        return Err(Error::DependentConstraints { t, constraint, independence: value });
    }
    let extreme = Extreme { value, t, constraint };
    let kept = stats.get_or_insert(ConstraintStats {
        independence: extreme,
        misfit: Extreme { value: 0.0, t, constraint },
    });
    if value < kept.independence.value {
        kept.independence = extreme;
    }
    Ok(())
}

/// Checks that the redundant constraints hold, up to ε^0.6 of the squared scale of the state.
fn redundant<D: Dynamics<N, Scalar: Float>, const N: usize>(
    phase: &Phase<'_, D, N>,
) -> Result<(), Error> {
    let Phase { q, v, .. } = *phase;
    let held = facts::<D, N>().held_constraints();
    let redundant = &facts::<D, N>().constraints[held..];
    if redundant.is_empty() {
        return Ok(());
    }
    let (system, inputs) = (phase.dynamics.system(), phase.momentum_inputs());
    let misfits = system.redundant_misfits(phase.at(&inputs));
    let allowed = D::Scalar::EPSILON.to_f64().powf(0.6);
    for (part, misfits, values) in
        [(Part::Position, misfits[0], q), (Part::Velocity, misfits[1], v)]
    {
        let scale = largest(values).0.max(1.0);
        let (residual, index) = largest(&misfits);
        if allowed * scale * scale < residual || residual.is_nan() {
            let (t, own) = (phase.t.to_f64(), &redundant[index]);
            let rate = part == Part::Velocity && own.holonomic;
            let (constraint, unit) = (own.name, own.unit);
            return Err(Error::Inconsistent {
                t,
                part,
                rate,
                constraint,
                residual,
                unit,
                redundant: true,
            });
        }
    }
    Ok(())
}
