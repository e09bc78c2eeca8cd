//! A run of a family: reference, amplification, and every method.

use crate::case::{Case, Method, Scalar, amplification, distance};
use crate::families::Family;
use crate::random::Random;

/// The result of a method in a run.
#[derive(Clone, Debug)]
pub(crate) struct Measurement {
    pub(crate) method: Method,
    /// The error at the end divided by tolerance and amplification, and the largest such error at
    /// the other output times; or the error that the method returned.
    pub(crate) merit: Result<(f64, f64), String>,
    /// The error at the end.
    pub(crate) error: f64,
    /// The numbers of steps and evaluations.
    pub(crate) stats: String,
    /// The time relative to that of `Dop853`.
    pub(crate) time: Option<f64>,
}

/// A run of a family.
#[derive(Clone, Debug)]
pub(crate) struct Measured {
    pub(crate) run: usize,
    pub(crate) tolerance: f64,
    pub(crate) amplification: f64,
    /// The distance between two references.
    pub(crate) doubt: f64,
    pub(crate) start: String,
    pub(crate) measurements: Vec<Measurement>,
}

/// The fractions of the interval at which dense output is measured.
const WITHIN: [f64; 2] = [0.37, 0.71];

/// Returns the problem of a run, its tolerance and its generator.
fn problem(family: &Family, run: usize) -> (Box<dyn Case>, f64, Random) {
    let (case, mut random) = family.problem(run);
    let (least, most) = family.scalar.tolerances();
    let tolerance = random.log_within(least, most);
    (case, tolerance, random)
}

/// Measures the methods accepted by `wanted`.
pub(crate) fn measure(
    family: &Family,
    run: usize,
    wanted: &dyn Fn(Method) -> bool,
) -> Result<Measured, String> {
    let (case, tolerance, mut random) = problem(family, run);
    let case = &*case;
    let times = WITHIN.map(|part| part * case.end());
    let amplification = amplification(case, &mut random).ok_or("the flow has no end")?;
    let (exact, doubt) = reference(case, family.scalar, tolerance, &times)?;
    let least = 100.0 * family.scalar.epsilon();
    let unit = tolerance.max(least) * amplification;
    if 0.01 * unit < doubt {
        return Err(format!(
            "two references differ by {doubt:.1e}, the tolerance is {tolerance:.1e}, {}",
            case.describe()
        ));
    }
    let measured = |method: &Method| wanted(*method) && method.least(family.scalar) <= tolerance;
    let measurements = case.methods(family.scalar).iter().copied().filter(measured).map(|method| {
        let mut error = f64::NAN;
        let mut stats = String::new();
        let merit = case.run(method, family.scalar, tolerance, &times).map(|run| {
            let errors: Vec<f64> = run
                .states
                .iter()
                .zip(&exact)
                .map(|(state, exact)| distance(state, exact))
                .collect();
            let (end, within) = (
                errors[times.len()],
                errors[..times.len()].iter().fold(0.0, |a: f64, b| a.max(*b)),
            );
            (error, stats) = (end, run.stats);
            (end / unit, within / unit)
        });
        Measurement { method, merit, error, stats, time: None }
    });
    let measurements = measurements.collect();
    let start = case.describe();
    Ok(Measured { run, tolerance, amplification, doubt, start, measurements })
}

/// Returns the states at the output times and at the end in double-double, and their distance from
/// a second reference with other steps.
fn reference(
    case: &dyn Case,
    scalar: Scalar,
    tolerance: f64,
    times: &[f64],
) -> Result<(Vec<crate::case::State>, f64), String> {
    let guide = case.guide();
    let fine = if case.by_series() {
        if scalar == Scalar::Wide { 1e-31 } else { 1e-24 }
    } else {
        (1e-6 * tolerance).clamp(1e-20, 1e-14)
    };
    let fine = fine.max(guide.least);
    let trusted = case.exact(fine, guide.max_step, times)?;
    let other = case.exact(30.0 * fine, 0.7 * guide.max_step, times)?;
    let doubt = trusted.iter().zip(&other).map(|(a, b)| distance(b, a)).fold(0.0, f64::max);
    Ok((trusted, doubt))
}

/// Measures the times of all methods relative to that of `Dop853`, each the minimum of several
/// runs.
pub(crate) fn clock(family: &Family, measured: &mut Measured) {
    let (case, tolerance, _) = problem(family, measured.run);
    let time = |method| {
        let once =
            || Some(case.run(method, family.scalar, tolerance, &[]).ok()?.time.as_secs_f64());
        let first: f64 = once()?;
        // Disturbances hardly affect a long run.
        let repeats = if first < 0.02 { 4 } else { 0 };
        Some((0..repeats).filter_map(|_| once()).fold(first, f64::min))
    };
    let Some(unit) = time(Method::Dop853) else { return };
    for measurement in &mut measured.measurements {
        if measurement.merit.is_ok() {
            measurement.time = match measurement.method {
                Method::Dop853 => Some(1.0),
                method => time(method).map(|time| time / unit),
            };
        }
    }
}
