//! A search for states that fulfil the constraints of a system.

use crate::error::{Error, Part};
use crate::integrate::state::State;
use crate::integrate::step::integration::check_start;
use crate::integrate::step::projection;
use crate::motion::Side;
use crate::scalar::{Float, Real};
use crate::system::label::Source;
use crate::system::{At, Dynamics, Purpose, System, scalar_time};
use crate::time::Time;
use nalgebra::{DMatrix, DVector};

/// The maximum number of steps.
const STEPS: u32 = 200;

/// The maximum number of times that a step is halved.
const HALVES: u32 = 40;

/// The least part of a constraint that must be independent of the other constraints; a step leaves
/// out constraints below it.
const RANK: f64 = 1e-12;

/// Begins the search for a state at `t` that fulfils the constraints of a system, near the
/// coordinates `q` and the velocities `v`; [`run`](Assemble::run) performs the search.
///
/// ```
/// use pendulum_runtime::prelude::*;
/// use pendulum_runtime::integrate::assemble;
///
/// # mod system {
/// pendulum_runtime::lagrangian! {
///     /// A bob on a rod, in Cartesian coordinates.
///     pub struct Bob { L: m, g: m/s^2 = 9.81 }
///     coordinate x: m;
///     coordinate y: m;
///     kinetic = (ẋ^2 + ẏ^2)/2;
///     potential = g*y;
///     constraint rod: x^2 + y^2 = L^2;
/// }
/// # }
/// # use system::Bob;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let bob = Bob::new(1.0);
/// let start = assemble(&bob, 0.0, [0.6, -1.0], [1.0, 0.0]).hold("x").run()?;
/// assert!((start.q[1] + 0.8).abs() < 1e-15);
/// // The velocity is at right angles to the rod.
/// assert!((start.v[1] - 0.75).abs() < 1e-15);
/// let solution = solve(&bob, (0.0, 1.0), start.q, start.v).run()?;
/// # Ok(())
/// # }
/// ```
pub fn assemble<D: Dynamics<N, Scalar: Float>, const N: usize>(
    dynamics: &D,
    t: f64,
    q: [D::Scalar; N],
    v: [D::Scalar; N],
) -> Assemble<'_, D, N> {
    Assemble { dynamics, t, q, v, held: Vec::new() }
}

/// A search for a state that fulfils the constraints, created by [`assemble`].
#[derive(Clone, Debug)]
#[must_use = "`run` finds the state"]
pub struct Assemble<'d, D: Dynamics<N>, const N: usize> {
    dynamics: &'d D,
    t: f64,
    q: [D::Scalar; N],
    v: [D::Scalar; N],
    held: Vec<String>,
}

impl<D: Dynamics<N, Scalar: Float>, const N: usize> Assemble<'_, D, N> {
    /// Keeps the coordinate with this name, and its velocity, exactly as they are in the guess.
    ///
    /// Names are parsed as in [`Solution::column`](crate::integrate::Solution::column).
    pub fn hold(mut self, coordinate: impl Into<String>) -> Self {
        self.held.push(coordinate.into());
        self
    }

    /// Finds the state.
    ///
    /// The coordinates come from Newton's method with the shortest steps in the metric of the mass
    /// matrix, δq = −M⁻¹Cᵀ(C M⁻¹Cᵀ)⁻¹g over the coordinates that are not held. The velocities
    /// follow from the impulse that makes them fit, δq̇ = −M⁻¹Cᵀ(C M⁻¹Cᵀ)⁻¹(C q̇ + b).
    ///
    /// A step changes no coordinate q by more than 1 + |q|. It is halved until the next step,
    /// computed with the same matrices, is shorter (Deuflhard 2004, Newton Methods for Nonlinear
    /// Problems, section 3.2). Without constraints the state is the guess. Systems written by hand
    /// need a mass matrix.
    ///
    /// # Errors
    /// Returns an error if the guess is not finite; [`Error::NoCoordinate`] if no coordinate has
    /// the name of a held one; [`Error::NotAssembled`] if no state near the guess fulfils the
    /// constraints with the held coordinates; [`Error::DependentConstraints`] if the constraints do
    /// not determine their forces; and [`Error::Inconsistent`] if a redundant constraint does not
    /// follow from the others.
    pub fn run(self) -> Result<State<D::Scalar, N>, Error> {
        let Self { dynamics, t, mut q, mut v, held } = self;
        let time = Time::new(t);
        check_start(dynamics, time, &q, &v)?;
        let facts = &<D::System as System<N>>::FACTS;
        let labels = Source::Facts(facts).labels(N);
        let mut free = [true; N];
        for name in held {
            match labels.coordinate(&name) {
                Some(index) => free[index] = false,
                None => return Err(Error::NoCoordinate { name, coordinates: facts.coordinates }),
            }
        }
        if facts.held_constraints() != 0 {
            let search = Search::new(dynamics, time, free);
            search.positions(&mut q, &v)?;
            search.velocities(&q, &mut v)?;
        }
        // The integration checks its start in the same way.
        projection::start(dynamics, time, Side::After, q, v)?;
        Ok(State { t, q, v })
    }
}

/// A search at a fixed time.
struct Search<'d, D: Dynamics<N>, const N: usize> {
    dynamics: &'d D,
    t: f64,
    time: D::Scalar,
    inputs: <D::System as System<N>>::Inputs,
    /// The indices of the coordinates that are not held.
    free: Vec<usize>,
    /// The number of constraints.
    count: usize,
}

impl<'d, D: Dynamics<N, Scalar: Float>, const N: usize> Search<'d, D, N> {
    fn new(dynamics: &'d D, t: Time, free: [bool; N]) -> Self {
        Self {
            dynamics,
            t: t.to_f64(),
            time: scalar_time(t),
            inputs: dynamics.inputs(t, Side::After, Purpose::Momenta),
            free: (0..N).filter(|&index| free[index]).collect(),
            count: <D::System as System<N>>::FACTS.held_constraints(),
        }
    }

    fn at<'a>(
        &'a self,
        q: &'a [D::Scalar; N],
        v: &'a [D::Scalar; N],
    ) -> At<'a, D::Scalar, <D::System as System<N>>::Inputs, N> {
        At { t: self.time, q, v, inputs: &self.inputs }
    }

    fn misfits(&self, part: Part, q: &[D::Scalar; N], v: &[D::Scalar; N]) -> DVector<f64> {
        let all = self.dynamics.system().misfits(self.at(q, v));
        let own = &all[usize::from(part == Part::Velocity)];
        DVector::from_fn(self.count, |index, _| own[index].to_f64())
    }

    fn metric(&self, q: &[D::Scalar; N], v: &[D::Scalar; N]) -> Option<Metric> {
        let (system, at) = (self.dynamics.system(), self.at(q, v));
        let (masses, gradients) = (system.mass_matrix(at), system.constraint_jacobian(at));
        let (free, size) = (&self.free, self.free.len());
        let mass = |i: usize, j: usize| masses[(i, j)].to_f64();
        Metric::new(
            DMatrix::from_fn(size, size, |i, j| mass(free[i], free[j])),
            &DMatrix::from_fn(self.count, size, |k, j| gradients[(k, free[j])].to_f64()),
        )
    }

    /// Returns `values` minus `share` times `change` in the free coordinates.
    fn less(&self, values: &[D::Scalar; N], share: f64, change: &DVector<f64>) -> [D::Scalar; N] {
        let mut values = *values;
        for (own, change) in self.free.iter().zip(change) {
            values[*own] -= D::Scalar::from_f64(share * change);
        }
        values
    }

    /// Returns the largest component of a change, in units of the last place of 1 + |value|.
    fn length(&self, values: &[D::Scalar; N], change: &DVector<f64>) -> f64 {
        self.free.iter().zip(change).fold(0.0, |most: f64, (&own, change)| {
            let size = D::Scalar::EPSILON.to_f64() * (1.0 + values[own].to_f64().abs());
            most.max(change.abs() / size)
        })
    }

    fn positions(&self, q: &mut [D::Scalar; N], v: &[D::Scalar; N]) -> Result<(), Error> {
        let guessed = self.misfits(Part::Position, q, v);
        for _ in 0..STEPS {
            let misfit = self.misfits(Part::Position, q, v);
            let Some(metric) = self.metric(q, v).filter(|_| misfit.iter().all(|g| g.is_finite()))
            else {
                return Err(self.failure(Part::Position, &misfit));
            };
            let (step, norm) = metric.step(&misfit);
            let length = self.length(q, &step);
            if length < 8.0 {
                // The last step is taken only if it reduces the misfit.
                let end = self.less(q, 1.0, &step);
                if self.misfits(Part::Position, &end, v).norm() < misfit.norm() {
                    *q = end;
                }
                let misfit = self.misfits(Part::Position, q, v);
                return self.settled(&metric, Part::Position, q, &misfit, &guessed);
            }
            let mut share = self.free.iter().zip(&step).fold(1.0, |share: f64, (&own, step)| {
                share.min((1.0 + q[own].to_f64().abs()) / step.abs())
            });
            let taken = (0..HALVES).find_map(|_| {
                let (end, part) = (self.less(q, share, &step), share);
                share *= 0.5;
                let then = self.misfits(Part::Position, &end, v);
                // NaN fails the comparison.
                (metric.step(&then).1 <= (1.0 - 0.5 * part) * norm).then_some(end)
            });
            match taken {
                Some(end) => *q = end,
                // The rounding error is larger than the step.
                None if length < 1e4 => {
                    return self.settled(&metric, Part::Position, q, &misfit, &guessed);
                }
                None => return Err(self.failure(Part::Position, &misfit)),
            }
        }
        Err(self.failure(Part::Position, &self.misfits(Part::Position, q, v)))
    }

    fn velocities(&self, q: &[D::Scalar; N], v: &mut [D::Scalar; N]) -> Result<(), Error> {
        let guessed = self.misfits(Part::Velocity, q, v);
        let Some(metric) = self.metric(q, v) else {
            return Err(self.failure(Part::Velocity, &guessed));
        };
        let mut misfit = guessed.clone();
        // Each step leaves a rounding error relative to the misfit before it.
        for _ in 0..4 {
            let end = self.less(v, 1.0, &metric.step(&misfit).0);
            let then = self.misfits(Part::Velocity, q, &end);
            if then.norm() < misfit.norm() {
                (*v, misfit) = (end, then);
            }
        }
        self.settled(&metric, Part::Velocity, v, &misfit, &guessed)
    }

    /// Checks that all constraints are fulfilled, including those left out of the steps. The scale
    /// of a misfit is the misfit of the guess plus the product of the lengths of gradient and
    /// values in the metric.
    fn settled(
        &self,
        metric: &Metric,
        part: Part,
        values: &[D::Scalar; N],
        misfit: &DVector<f64>,
        guessed: &DVector<f64>,
    ) -> Result<(), Error> {
        let allowed = D::Scalar::EPSILON.to_f64().sqrt();
        let values = DVector::from_fn(self.free.len(), |i, _| values[self.free[i]].to_f64());
        let size = values.dot(&(&metric.mass * &values)).abs().sqrt();
        let fulfilled = (0..self.count).all(|k| {
            let scale = guessed[k].abs() + metric.squares[k].sqrt() * size;
            misfit[k] == 0.0 || misfit[k].abs() <= allowed * scale
        });
        if fulfilled { Ok(()) } else { Err(self.failure(part, misfit)) }
    }

    /// Returns the error for the constraint with the largest misfit.
    fn failure(&self, part: Part, misfit: &DVector<f64>) -> Error {
        let size = |k: usize| if misfit[k].is_nan() { f64::INFINITY } else { misfit[k].abs() };
        let most = (0..self.count).fold(0, |most, k| if size(most) < size(k) { k } else { most });
        let own = &<D::System as System<N>>::FACTS.constraints[most];
        let rate = part == Part::Velocity && own.holonomic;
        let (constraint, unit) = (own.name, own.unit);
        Error::NotAssembled { t: self.t, part, rate, constraint, residual: size(most), unit }
    }
}

/// The metric of the mass matrix over the free coordinates, and the constraints in this metric.
struct Metric {
    mass: DMatrix<f64>,
    /// M⁻¹Cᵀ.
    directions: DMatrix<f64>,
    /// The diagonal of C M⁻¹Cᵀ.
    squares: DVector<f64>,
    /// The factor L of L Lᵀ = C M⁻¹Cᵀ, scaled to a diagonal of ones, in the order of the pivots.
    root: DMatrix<f64>,
    /// The indices of the constraints in the order of the pivots, without dependent constraints.
    order: Vec<usize>,
}

impl Metric {
    /// Computes the metric; returns `None` if the mass matrix is not positive definite.
    fn new(mass: DMatrix<f64>, gradients: &DMatrix<f64>) -> Option<Self> {
        let count = gradients.nrows();
        let directions = mass.clone().cholesky()?.solve(&gradients.transpose());
        let products = gradients * &directions;
        let squares = products.diagonal();
        let mut rest = DMatrix::from_fn(count, count, |k, l| {
            let scale = (squares[k] * squares[l]).sqrt();
            if 0.0 < scale { products[(k, l)] / scale } else { 0.0 }
        });
        let mut left: Vec<usize> = (0..count).collect();
        let (mut order, mut root) = (Vec::new(), DMatrix::zeros(count, count));
        // Chooses the largest pivot first, and the first of several equal pivots.
        while let Some(place) = (0..left.len())
            .filter(|&place| RANK < rest[(left[place], left[place])])
            .reduce(|a, b| if pivot(&rest, left[a]) < pivot(&rest, left[b]) { b } else { a })
        {
            let own = left.remove(place);
            let column = order.len();
            let scale = pivot(&rest, own).sqrt();
            root[(own, column)] = scale;
            for &k in &left {
                root[(k, column)] = rest[(k, own)] / scale;
            }
            for &k in &left {
                for &l in &left {
                    rest[(k, l)] -= root[(k, column)] * root[(l, column)];
                }
            }
            order.push(own);
        }
        Some(Self { mass, directions, squares, root, order })
    }

    /// Returns M⁻¹Cᵀ(C M⁻¹Cᵀ)⁻¹g for the misfits g, and its length in the metric.
    fn step(&self, misfit: &DVector<f64>) -> (DVector<f64>, f64) {
        let Self { root, order, .. } = self;
        let size = order.len();
        let mut x: Vec<f64> = order.iter().map(|&k| misfit[k] / self.squares[k].sqrt()).collect();
        for (i, &row) in order.iter().enumerate() {
            let rest = (0..i).fold(x[i], |rest, j| rest - root[(row, j)] * x[j]);
            x[i] = rest / root[(row, i)];
        }
        let norm = x.iter().fold(0.0, |sum, x| sum + x * x).sqrt();
        for i in (0..size).rev() {
            let sum = (i + 1..size).fold(x[i], |x_i, j| x_i - root[(order[j], i)] * x[j]);
            x[i] = sum / root[(order[i], i)];
        }
        let mut step = DVector::zeros(self.directions.nrows());
        for (x, &k) in x.iter().zip(order) {
            step.axpy(x / self.squares[k].sqrt(), &self.directions.column(k), 1.0);
        }
        (step, norm)
    }
}

fn pivot(matrix: &DMatrix<f64>, index: usize) -> f64 {
    matrix[(index, index)]
}
