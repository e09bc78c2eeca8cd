//! Lyapunov exponents: the mean rates at which neighbouring motions diverge.

use crate::analysis::reduction::free_directions;
use crate::analysis::variational::Variational;
use crate::error::Error;
use crate::integrate::controller::Controller;
use crate::integrate::method::Method;
use crate::integrate::{AdaptiveStep, Picard, State, solve};
use crate::motion::Side;
use crate::scalar::Real;
use crate::system::{At, Dynamics, Jacobians, Purpose, System};
use crate::time::Time;
use core::fmt;
use nalgebra::{DMatrix, DVector, SMatrix};

/// The Lyapunov spectrum of a motion: two exponents for each degree of freedom, each with a
/// standard error. A `rotation` has three degrees of freedom.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LyapunovSpectrum {
    /// The exponents in 1/s, in the order of the vectors of the frame: descending, except for
    /// statistical errors.
    pub exponents: Vec<f64>,
    /// The standard errors of the exponents in 1/s, by the means of [`BATCHES`](Self::BATCHES)
    /// batches.
    pub standard_errors: Vec<f64>,
    /// The length of the average in seconds.
    pub time: f64,
    /// The time between two orthonormalizations of the frame.
    interval: f64,
    /// For each interval, the logarithms of the growth of the vectors of the frame.
    growths: Vec<f64>,
}

impl LyapunovSpectrum {
    /// The number of batches whose means determine the standard errors. If there are fewer than
    /// twice as many intervals, the number of batches is half the number of intervals.
    pub const BATCHES: usize = 32;

    /// Computes means and standard errors of the growth in each interval.
    fn new(size: usize, interval: f64, growths: Vec<f64>) -> Self {
        let count = growths.len() / size;
        let time = count as f64 * interval;
        let mean = |from: usize, to: usize, index: usize| {
            let sum: f64 = (from..to).map(|k| growths[k * size + index]).sum();
            sum / ((to - from) as f64 * interval)
        };
        let exponents: Vec<f64> = (0..size).map(|index| mean(0, count, index)).collect();
        let batches = Self::BATCHES.min(count / 2).max(1);
        let standard_error = |index: usize| {
            let squares: f64 = (0..batches)
                .map(|batch| {
                    let (from, to) = (batch * count / batches, (batch + 1) * count / batches);
                    let off = mean(from, to, index) - exponents[index];
                    off * off
                })
                .sum();
            (squares / (batches as f64 * (batches as f64 - 1.0))).sqrt()
        };
        let standard_errors = (0..size).map(standard_error).collect();
        Self { exponents, standard_errors, time, interval, growths }
    }

    /// Returns the sum of all exponents: the mean growth rate of volumes in phase space. The sum is
    /// zero for a bounded motion without friction.
    pub fn sum(&self) -> f64 {
        self.exponents.iter().sum()
    }

    /// Returns an iterator over the intervals, with the time since the beginning of the average and
    /// the mean growth rates up to the end of each interval.
    pub fn running(&self) -> impl Iterator<Item = (f64, Vec<f64>)> {
        let size = self.exponents.len();
        let mut sums = vec![0.0; size];
        self.growths.chunks_exact(size.max(1)).enumerate().map(move |(index, growths)| {
            let time = (index + 1) as f64 * self.interval;
            for (sum, growth) in sums.iter_mut().zip(growths) {
                *sum += growth;
            }
            (time, sums.iter().map(|sum| sum / time).collect())
        })
    }

    /// Returns the Lyapunov dimension j + (λ₁ + … + λ_j)/|λ_{j+1}|, where j is the largest number
    /// of exponents whose sum is not negative. For a driven system add 1, the dimension of time.
    ///
    /// Source: Kaplan and Yorke (1979), Chaotic behavior of multidimensional difference equations.
    pub fn kaplan_yorke_dimension(&self) -> f64 {
        let mut sum = 0.0;
        for (index, &exponent) in self.exponents.iter().enumerate() {
            if sum + exponent < 0.0 {
                return index as f64 + sum / exponent.abs();
            }
            sum += exponent;
        }
        self.exponents.len() as f64
    }
}

/// Writes each exponent with its standard error, and the length of the average.
impl fmt::Display for LyapunovSpectrum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = f.precision().unwrap_or(5);
        for (exponent, error) in self.exponents.iter().zip(&self.standard_errors) {
            writeln!(f, "{exponent:+.digits$} ± {error:.digits$} /s")?;
        }
        write!(f, "over {} s", self.time)
    }
}

/// An error of the computation of a Lyapunov spectrum, with the partial result.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LyapunovError {
    /// The error of the integration, or of a setting.
    pub error: Error,
    /// The time of the last frame.
    pub t: f64,
    /// The spectrum over the intervals before `t`, if there are at least two.
    pub partial: Option<Box<LyapunovSpectrum>>,
}

impl fmt::Display for LyapunovError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the Lyapunov spectrum ended at t = {}: {}", self.t, self.error)
    }
}

impl core::error::Error for LyapunovError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        Some(&self.error)
    }
}

/// The settings of a Lyapunov spectrum, created by [`lyapunov`].
#[must_use = "nothing is integrated before `run`"]
#[derive(Clone, Copy, Debug)]
pub struct Lyapunov<'a, const N: usize, D, Me = Picard> {
    dynamics: &'a D,
    t: f64,
    q: [f64; N],
    v: [f64; N],
    method: Me,
    rtol: f64,
    transient: f64,
    interval: f64,
}

/// Prepares the Lyapunov spectrum of the motion with coordinates `q` and velocities `v` at time
/// `t`.
///
/// A frame of small deviations, two for each degree of freedom, which obey the variational
/// equations, is integrated along the motion. After each interval τ the frame is orthonormalized in
/// coordinates and momenta, (δ₁ … δ₂ₙ) = Q R with δ = (δq, δp). The exponents are the means λᵢ =
/// ⟨ln Rᵢᵢ⟩/τ over all intervals. The exponents do not depend on units and coordinates; the growth
/// within an interval does. Without friction the flow preserves volumes in (q, p), so the exponents
/// of each interval add up to zero (Liouville). With constraints, δq is tangent to them, and δp is
/// its tangent part: the part across them moves nothing, and volumes of both parts are preserved.
///
/// Sources: Benettin, Galgani, Giorgilli and Strelcyn (1980), Lyapunov Characteristic Exponents for
/// smooth dynamical systems, Meccanica 15, 9–30, part 2; Shimada and Nagashima (1979), Progress of
/// Theoretical Physics 61, 1605–1616. Standard errors by batch means: Geyer (1992), Practical
/// Markov Chain Monte Carlo, Statistical Science 7, section 3.2.
///
/// ```
/// use pendulum_runtime::prelude::*;
/// use pendulum_runtime::analysis::{Variational, lyapunov, variational_size};
///
/// # mod system {
/// pendulum_runtime::lagrangian! {
///     /// A saddle: neighbours part as exp(2 t).
///     pub struct Saddle { k }
///     coordinate x;
///     kinetic = ẋ^2/2;
///     potential = -k*x^2/2;
/// }
/// # }
/// # use system::Saddle;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let saddle = Variational::<_, 1, { variational_size(1, 0) }>::new(Saddle::new(4.0));
/// let spectrum = lyapunov(&saddle, 0.0, [0.0], [0.0]).transient(20.0).run(100.0)?;
/// assert!((spectrum.exponents[0] - 2.0).abs() < 1e-9);
/// assert!((spectrum.exponents[1] + 2.0).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
pub fn lyapunov<D, S, const N: usize, const M: usize>(
    dynamics: &D,
    t: f64,
    q: [f64; N],
    v: [f64; N],
) -> Lyapunov<'_, N, D>
where
    D: Dynamics<M, System = Variational<S, N, M>, Scalar = f64>,
    S: Jacobians<N, Scalar = f64>,
{
    Lyapunov { dynamics, t, q, v, method: Picard, rtol: 1e-12, transient: 0.0, interval: 1.0 }
}

/// The relative length of a vector after orthogonalization below which the vector is a rounding
/// error.
const LOST: f64 = 1e-12;

/// The least length of a vector as a multiple of the tolerance: its relative error is then a
/// thousandth.
const SHRUNK: f64 = 1e3;

impl<'a, const N: usize, D, Me> Lyapunov<'a, N, D, Me> {
    /// Sets the adaptive method, [`Picard`] by default.
    pub fn method<B>(self, method: B) -> Lyapunov<'a, N, D, B> {
        let Self { dynamics, t, q, v, rtol, transient, interval, .. } = self;
        Lyapunov { dynamics, t, q, v, method, rtol, transient, interval }
    }

    /// Sets the relative and absolute tolerance of the motion and the deviations, 1e-12 by default.
    pub fn rtol(mut self, rtol: f64) -> Self {
        self.rtol = rtol;
        self
    }

    /// Sets the time in seconds before the average begins, zero by default. In this time the motion
    /// approaches its attractor, and the frame approaches its directions.
    pub fn transient(mut self, time: f64) -> Self {
        self.transient = time;
        self
    }

    /// Sets the time τ in seconds between two orthonormalizations of the frame, one second by
    /// default.
    ///
    /// The interval must be short enough that vectors of the frame do not become parallel to
    /// rounding, or as short as the tolerance. For a tolerance of 1e-12 it should fulfil λ_min τ >
    /// −20 and (λ_max − λ_min) τ < 25.
    pub fn interval(mut self, time: f64) -> Self {
        self.interval = time;
        self
    }

    /// Integrates and averages over `time` seconds, rounded to whole intervals.
    ///
    /// # Errors
    /// Returns an error if a setting is out of its range, if there are fewer than two intervals, if
    /// an interval is too long, or if the integration fails. The error contains the spectrum up to
    /// that time.
    pub fn run<S, const M: usize>(self, time: f64) -> Result<LyapunovSpectrum, LyapunovError>
    where
        D: Dynamics<M, System = Variational<S, N, M>, Scalar = f64>,
        S: Jacobians<N, Scalar = f64>,
        Me: Method<D, M>,
        AdaptiveStep<M>: Controller<Me, D, M>,
    {
        let setting = |name, value, required| {
            let error = Error::Setting { name, value, required };
            Err(LyapunovError { error, t: self.t, partial: None })
        };
        if !(0.0 < self.interval && self.interval < f64::INFINITY) {
            return setting("interval", self.interval, "positive and finite");
        }
        if !(0.0..f64::INFINITY).contains(&self.transient) {
            return setting("transient", self.transient, "zero or positive, and finite");
        }
        let count = (time / self.interval).round();
        if !(2.0..1e15).contains(&count) {
            return setting("run", time, "two intervals at least and finite");
        }
        let transient = (self.transient / self.interval).ceil();
        let (count, transient) = (count as u64, transient as u64);
        let (mut q, mut v) = (self.q, self.v);
        let (start, _) = assemble::<N, M>(&[], &q, &v);
        let mut frame = self.frame(&start);
        let size = frame.len() / (2 * N);
        let mut growths = Vec::new();
        for index in 0..transient + count {
            let at = |index: u64| self.t + index as f64 * self.interval;
            let failed = |error, growths: Vec<f64>| {
                let enough = 2 * size <= growths.len();
                let partial =
                    enough.then(|| Box::new(LyapunovSpectrum::new(size, self.interval, growths)));
                LyapunovError { error, t: at(index), partial }
            };
            let (mut q0, mut v0) = assemble::<N, M>(&frame, &q, &v);
            self.momenta(at(index), &mut q0, &mut v0, Back::Velocities);
            let run = solve(self.dynamics, (at(index), at(index + 1)), q0, v0)
                .method(self.method)
                .rtol(self.rtol)
                .run();
            let mut end = match run {
                Ok(solution) => solution.end,
                Err(failure) => return Err(failed(failure.error, growths)),
            };
            let own = end.v;
            self.momenta(end.t, &mut end.q, &mut end.v, Back::Momenta);
            take_apart::<N, M>(&end, &mut frame);
            (q, v) = (head(&end.q), head(&own));
            let Some(found) = orthonormalize(&mut frame, 2 * N, SHRUNK * self.rtol) else {
                let error = Error::Setting {
                    name: "interval",
                    value: self.interval,
                    required: "so short that the deviations stay distinct; shorten it",
                };
                return Err(failed(error, growths));
            };
            if transient <= index {
                growths.extend(found);
            }
        }
        Ok(LyapunovSpectrum::new(size, self.interval, growths))
    }
}

/// The direction of a conversion of deviations.
#[derive(Clone, Copy)]
enum Back {
    Momenta,
    Velocities,
}

impl<const N: usize, D, Me> Lyapunov<'_, N, D, Me> {
    /// Converts the deviations of the velocities in `all` to deviations of the momenta, or back,
    /// with both tangent to the constraints. The first `N` numbers, the velocities of the motion,
    /// stay unchanged.
    fn momenta<S, const M: usize>(&self, t: f64, q: &mut [f64; M], all: &mut [f64; M], back: Back)
    where
        D: Dynamics<M, System = Variational<S, N, M>, Scalar = f64>,
        S: Jacobians<N, Scalar = f64>,
    {
        let system = self.dynamics.system();
        let inputs = self.dynamics.inputs(Time::new(t), Side::After, Purpose::Momenta);
        // The momenta of the motion do not depend on the deviations.
        let momenta = system.momenta(At { t, q, v: all, inputs: &inputs });
        match back {
            Back::Momenta => {
                all[N..].copy_from_slice(&momenta[N..]);
                if const { 0 < S::FACTS.held_constraints() } {
                    let along = self.directions(t, q).map(|free| &free * free.transpose());
                    for (values, along) in [(&mut *q, &along[0]), (all, &along[1])] {
                        for column in values.chunks_exact_mut(N).skip(1) {
                            let tangent = along * DVector::from_column_slice(column);
                            column.copy_from_slice(tangent.as_slice());
                        }
                    }
                }
            }
            Back::Velocities => {
                let mut p = *all;
                p[..N].copy_from_slice(&momenta[..N]);
                let v = system.velocities(t, q, &p, &inputs);
                all[N..].copy_from_slice(&v[N..]);
                // Corrections of velocities change the momenta across the constraints only.
                system.onto_constraints(t, q, all, &inputs);
            }
        }
    }

    /// Returns the first frame: unit vectors, or with constraints an orthonormal basis of the
    /// tangent space.
    fn frame<S, const M: usize>(&self, q: &[f64; M]) -> Vec<f64>
    where
        D: Dynamics<M, System = Variational<S, N, M>, Scalar = f64>,
        S: Jacobians<N, Scalar = f64>,
    {
        let mut frame = Vec::new();
        for (part, basis) in self.directions(self.t, q).iter().enumerate() {
            for own in basis.column_iter() {
                let mut vector = vec![0.0; 2 * N];
                vector[part * N..][..N].copy_from_slice(own.as_slice());
                frame.extend(vector);
            }
        }
        frame
    }

    /// Returns orthonormal bases of the deviations of coordinates and of momenta along the
    /// constraints, unit vectors without constraints.
    fn directions<S, const M: usize>(&self, t: f64, q: &[f64; M]) -> [DMatrix<f64>; 2]
    where
        D: Dynamics<M, System = Variational<S, N, M>, Scalar = f64>,
        S: Jacobians<N, Scalar = f64>,
    {
        let free = || DMatrix::identity(N, N);
        if const { S::FACTS.held_constraints() == 0 } {
            return [free(), free()];
        }
        let inputs = self.dynamics.inputs(Time::new(t), Side::After, Purpose::Momenta);
        let at = At { t, q, v: &[0.0; M], inputs: &inputs };
        let all = self.dynamics.system().constraint_jacobian(at);
        let all: SMatrix<f64, N, N> = all.fixed_view::<N, N>(0, 0).into_owned();
        let mut of_positions = all;
        for (row, constraint) in S::FACTS.constraints.iter().enumerate().take(N) {
            if !constraint.holonomic {
                of_positions.row_mut(row).fill(0.0);
            }
        }
        [of_positions, all].map(|gradients| {
            // The integration refuses a start that is not finite.
            let finite = gradients.iter().all(|entry| entry.is_finite());
            let own = finite.then(|| free_directions(&gradients, &free())).flatten();
            own.unwrap_or_else(free)
        })
    }
}

/// Returns the first `N` numbers.
fn head<const N: usize, const M: usize>(all: &[f64; M]) -> [f64; N] {
    core::array::from_fn(|row| all[row])
}

/// Combines the motion and the frame to coordinates and velocities of the variational system.
fn assemble<const N: usize, const M: usize>(
    frame: &[f64],
    q: &[f64; N],
    v: &[f64; N],
) -> ([f64; M], [f64; M]) {
    let of = |own: &[f64; N], first: usize| {
        core::array::from_fn(|place| match (place / N, place % N) {
            (0, row) => own[row],
            (group, row) => {
                frame.get((group - 1) * 2 * N + first + row).copied().unwrap_or_default()
            }
        })
    };
    (of(q, 0), of(v, N))
}

/// Copies the deviations of a state into the frame.
fn take_apart<const N: usize, const M: usize>(state: &State<f64, M>, frame: &mut [f64]) {
    for (index, vector) in frame.chunks_exact_mut(2 * N).enumerate() {
        for row in 0..N {
            vector[row] = state.q[(index + 1) * N + row];
            vector[N + row] = state.v[(index + 1) * N + row];
        }
    }
}

/// Orthonormalizes the vectors of the frame, each of `size` numbers, by the Gram–Schmidt process,
/// applied twice to each vector (Giraud, Langou and Rozložník 2005). Returns the logarithms of the
/// diagonal of R; `None` if two vectors are parallel, a vector is shorter than `least`, or a number
/// is not finite.
fn orthonormalize(frame: &mut [f64], size: usize, least: f64) -> Option<Vec<f64>> {
    let norm = |vector: &[f64]| {
        let largest = vector.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let sum: f64 = vector.iter().map(|x| (x / largest) * (x / largest)).sum();
        largest * sum.sqrt()
    };
    let mut growths = Vec::with_capacity(size);
    for index in 0..frame.len() / size {
        let (before, rest) = frame.split_at_mut(index * size);
        let vector = &mut rest[..size];
        let whole = norm(vector);
        for _ in 0..2 {
            for other in before.chunks_exact(size) {
                let part: f64 = vector.iter().zip(other).map(|(a, b)| a * b).sum();
                for (a, b) in vector.iter_mut().zip(other) {
                    *a -= part * b;
                }
            }
        }
        let left = norm(vector);
        if !(LOST * whole < left && least < left && left < f64::INFINITY) {
            return None;
        }
        for component in vector.iter_mut() {
            *component /= left;
        }
        growths.push(Real::ln(left));
    }
    Some(growths)
}
