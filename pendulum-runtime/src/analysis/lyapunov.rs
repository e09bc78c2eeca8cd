//! Lyapunov exponents: the mean rates at which neighbouring motions part.

use crate::analysis::variational::Variational;
use crate::error::Error;
use crate::integrate::controller::Controller;
use crate::integrate::method::Method;
use crate::integrate::{AdaptiveStep, Picard, State, solve};
use crate::motion::Side;
use crate::scalar::Real;
use crate::system::{Dynamics, Jacobians, Purpose, System};
use crate::time::Time;
use core::fmt;

/// The Lyapunov spectrum of a motion: 2`N` exponents, each with a standard error.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LyapunovSpectrum {
    /// The exponents in 1/s, from the largest mean growth to the least as the frames come by them.
    pub exponents: Vec<f64>,
    /// Their standard errors in 1/s, by the means of [`BATCHES`](Self::BATCHES) batches.
    pub standard_errors: Vec<f64>,
    /// The time over which they were averaged, in seconds.
    pub time: f64,
    /// The time between two frames.
    interval: f64,
    /// For each interval the logarithms by which the vectors of the frame have grown.
    growths: Vec<f64>,
}

impl LyapunovSpectrum {
    /// The number of batches whose means give the standard errors; with fewer intervals than twice
    /// that, half as many as there are intervals.
    pub const BATCHES: usize = 32;

    /// Means and standard errors of what frames grow by in each interval.
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

    /// The sum of all exponents: the mean rate at which volumes of phase space grow, zero for a
    /// motion without friction that stays in a bounded part of it.
    pub fn sum(&self) -> f64 {
        self.exponents.iter().sum()
    }

    /// The time since the beginning of the average and the mean growth rates until then, after each
    /// interval.
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

    /// The Lyapunov dimension j + (λ₁ + … + λ_j)/|λ_{j+1}|, where j is the largest number of
    /// exponents whose sum is not negative; for a driven system add the one of the time.
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

/// Each exponent with its standard error, and the time of the average.
impl fmt::Display for LyapunovSpectrum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = f.precision().unwrap_or(5);
        for (exponent, error) in self.exponents.iter().zip(&self.standard_errors) {
            writeln!(f, "{exponent:+.digits$} ± {error:.digits$} /s")?;
        }
        write!(f, "over {} s", self.time)
    }
}

/// Reason for which there is no Lyapunov spectrum, with what was found until then.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LyapunovError {
    /// The error of the integration, or of a setting.
    pub error: Error,
    /// The time of the last frame.
    pub t: f64,
    /// The spectrum over the intervals until then, if there are two at least.
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

/// The Lyapunov spectrum along a motion, about to be computed; [`lyapunov`] makes it.
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

/// The Lyapunov spectrum of the motion that is at `q` with velocities `v` at time `t`.
///
/// A frame of 2`N` small deviations, which obey the variational equations, goes along the motion.
/// After each interval τ it is made orthonormal again in coordinates and momenta, (δ₁ … δ₂ₙ) = Q R
/// with δ = (δq, δp); the exponents are the means λᵢ = ⟨ln Rᵢᵢ⟩/τ over all intervals. They do not
/// depend on units and coordinates, the growth within an interval does. Without friction the flow
/// keeps volumes in (q, p), so that the exponents of any interval add up to zero (Liouville).
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

/// A vector that is this small a part of what it was before the others were taken off is rounding.
const LOST: f64 = 1e-12;

/// A vector that shrinks to so many tolerances is no more known than to a part of a thousand.
const SHRUNK: f64 = 1e3;

impl<'a, const N: usize, D, Me> Lyapunov<'a, N, D, Me> {
    /// Integrates by another adaptive method than [`Picard`].
    pub fn method<B>(self, method: B) -> Lyapunov<'a, N, D, B> {
        let Self { dynamics, t, q, v, rtol, transient, interval, .. } = self;
        Lyapunov { dynamics, t, q, v, method, rtol, transient, interval }
    }

    /// The relative and absolute tolerance of motion and deviations; 1e-12 without this call.
    pub fn rtol(mut self, rtol: f64) -> Self {
        self.rtol = rtol;
        self
    }

    /// The time in seconds before the average begins, in which the motion comes to its attractor
    /// and the frame turns into its directions; none without this call.
    pub fn transient(mut self, time: f64) -> Self {
        self.transient = time;
        self
    }

    /// The time in seconds between two frames; one second without this call.
    ///
    /// Within it no two vectors of the frame may become so nearly parallel that rounding decides,
    /// and none so short that the tolerance does: at 1e-12 a smallest exponent times the interval
    /// stays above −20, a largest less a smallest one times the interval below 25.
    pub fn interval(mut self, time: f64) -> Self {
        self.interval = time;
        self
    }

    /// Integrates and averages over `time` seconds, rounded to whole intervals.
    ///
    /// # Errors
    /// Settings out of their range, less than two intervals, an interval that is too long, and the
    /// errors of the integration, with the spectrum until then.
    pub fn run<S, const M: usize>(self, time: f64) -> Result<LyapunovSpectrum, LyapunovError>
    where
        D: Dynamics<M, System = Variational<S, N, M>, Scalar = f64>,
        S: Jacobians<N, Scalar = f64>,
        Me: Method<D, M>,
        AdaptiveStep<M>: Controller<Me, D, M>,
    {
        let size = 2 * N;
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
        let mut frame: Vec<f64> = (0..size * size)
            .map(|place| if place / size == place % size { 1.0 } else { 0.0 })
            .collect();
        let (mut q, mut v) = (self.q, self.v);
        let mut growths = Vec::new();
        for index in 0..transient + count {
            let at = |index: u64| self.t + index as f64 * self.interval;
            let failed = |error, growths: Vec<f64>| {
                let enough = 2 * size <= growths.len();
                let partial =
                    enough.then(|| Box::new(LyapunovSpectrum::new(size, self.interval, growths)));
                LyapunovError { error, t: at(index), partial }
            };
            let (q0, mut v0) = assemble::<N, M>(&frame, &q, &v);
            self.momenta(at(index), &q0, &mut v0, Back::Velocities);
            let run = solve(self.dynamics, (at(index), at(index + 1)), q0, v0)
                .method(self.method)
                .rtol(self.rtol)
                .run();
            let mut end = match run {
                Ok(solution) => solution.end,
                Err(failure) => return Err(failed(failure.error, growths)),
            };
            let own = end.v;
            self.momenta(end.t, &end.q, &mut end.v, Back::Momenta);
            take_apart::<N, M>(&end, &mut frame);
            (q, v) = (head(&end.q), head(&own));
            let Some(found) = orthonormalize(&mut frame, size, SHRUNK * self.rtol) else {
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

/// The way back of deviations.
#[derive(Clone, Copy)]
enum Back {
    Momenta,
    Velocities,
}

impl<const N: usize, D, Me> Lyapunov<'_, N, D, Me> {
    /// Turns the deviations of the velocities in `all` into those of the momenta or back; the first
    /// `N` numbers, the velocities themselves, stay.
    fn momenta<S, const M: usize>(&self, t: f64, q: &[f64; M], all: &mut [f64; M], back: Back)
    where
        D: Dynamics<M, System = Variational<S, N, M>, Scalar = f64>,
        S: Jacobians<N, Scalar = f64>,
    {
        let system = self.dynamics.system();
        let inputs = self.dynamics.inputs(Time::new(t), Side::After, Purpose::Momenta);
        // The momenta themselves do not depend on the deviations.
        let momenta = system.momenta(t, q, all, &inputs);
        let found = match back {
            Back::Momenta => momenta,
            Back::Velocities => {
                let mut p = *all;
                p[..N].copy_from_slice(&momenta[..N]);
                system.velocities(t, q, &p, &inputs)
            }
        };
        all[N..].copy_from_slice(&found[N..]);
    }
}

/// The first `N` numbers.
fn head<const N: usize, const M: usize>(all: &[f64; M]) -> [f64; N] {
    core::array::from_fn(|row| all[row])
}

/// Motion and frame as the coordinates and velocities of the variational system.
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

/// Puts the deviations into the frame.
fn take_apart<const N: usize, const M: usize>(state: &State<f64, M>, frame: &mut [f64]) {
    for (index, vector) in frame.chunks_exact_mut(2 * N).enumerate() {
        for row in 0..N {
            vector[row] = state.q[(index + 1) * N + row];
            vector[N + row] = state.v[(index + 1) * N + row];
        }
    }
}

/// Gram–Schmidt's process, twice for each vector (Giraud, Langou and Rozložník 2005): the vectors
/// of the frame become orthonormal, and the logarithms of the diagonal of R come back; `None` if
/// two of them are parallel, one is shorter than `least` or a number is not finite.
fn orthonormalize(frame: &mut [f64], size: usize, least: f64) -> Option<Vec<f64>> {
    let norm = |vector: &[f64]| {
        let largest = vector.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let sum: f64 = vector.iter().map(|x| (x / largest) * (x / largest)).sum();
        largest * sum.sqrt()
    };
    let mut growths = Vec::with_capacity(size);
    for index in 0..size {
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
