//! Random systems, compiled and run. The results of the generated code equal the generator's own
//! evaluation of the source, in `f64` and in double-double; jets have the derivatives of the
//! motion; and a motion that is run backwards returns to its start.

mod polynomial;

use pendulum_runtime::jet::{InputSeries, Jets, Path, Unrolling};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use pendulum_runtime::system::Staged;
use pendulum_runtime::system::System;
use polynomial::Driving;

#[allow(clippy::all, clippy::pedantic, unused_imports, unused_variables, non_snake_case)]
#[rustfmt::skip]
mod blocks;

/// A state of a system with `N` coordinates and `J` components of driven inputs, and the expected
/// values at this state.
pub(crate) struct Case<const N: usize, const J: usize> {
    t: f64,
    q: [f64; N],
    v: [f64; N],
    /// The third derivatives of the driven inputs; all others are zero.
    jerks: [f64; J],
    accelerations: [&'static str; N],
    momenta: [&'static str; N],
    momentum_rates: [&'static str; N],
    /// The third and the fourth derivatives of the coordinates.
    third: [&'static str; N],
    fourth: [&'static str; N],
    energy: &'static str,
    power: &'static str,
}

/// Returns the sum of two words.
pub(crate) fn words<T: Real>(high: f64, low: f64) -> T {
    T::from_f64(high) + T::from_f64(low)
}

/// Compares numbers with digits. Errors are relative to the largest number or to one.
fn compare<T: Float>(what: &str, found: &[T], expected: &[&str], bar: f64) {
    let expected: Vec<DoubleDouble> =
        expected.iter().map(|digits| digits.parse().unwrap()).collect();
    let scale = expected.iter().fold(1.0, |scale: f64, x| scale.max(x.to_f64().abs()));
    for (x, expected) in found.iter().zip(&expected) {
        let high = x.to_f64();
        let error =
            (DoubleDouble::sum(high, (*x - T::from_f64(high)).to_f64()) - *expected).to_f64().abs()
                / scale;
        assert!(error < bar, "{what}: {high} instead of {expected}, which is {error:e} off");
    }
}

/// Returns the series of a component of a driven input that is a cubic polynomial.
fn cubic([x, v, a, j]: [f64; 4]) -> InputSeries<f64> {
    let mut series = InputSeries::zero();
    let parts = [x, v, a / 2.0, j / 6.0];
    for (coefficient, part) in series.position.iter_mut().zip(parts) {
        *coefficient = part;
    }
    series.differentiate(8);
    series
}

/// The values, first and second derivatives of all components of inputs.
trait Components<T> {
    fn components(&self) -> Vec<[T; 3]>;
}

impl<T> Components<T> for () {
    fn components(&self) -> Vec<[T; 3]> {
        Vec::new()
    }
}

macro_rules! components {
    ($($dim:ident $index:tt),+) => {
        impl<T: Real, $(const $dim: usize),+> Components<T> for ($(pendulum_runtime::motion::Sample<T, $dim>,)+) {
            fn components(&self) -> Vec<[T; 3]> {
                let mut all = Vec::new();
                $(all.extend((0..$dim).map(|k| [self.$index.position[k], self.$index.velocity[k], self.$index.acceleration[k]]));)+
                all
            }
        }
    };
}

components!(A 0);
components!(A 0, B 1);

fn outputs<S, const N: usize, const J: usize>(
    name: &str,
    system: &S,
    inputs: &S::Inputs,
    case: &Case<N, J>,
    bar: f64,
) where
    S: Staged<N, Scalar: Float>,
{
    let of = |values: [f64; N]| values.map(S::Scalar::from_f64);
    let (t, q, v) = (S::Scalar::from_f64(case.t), of(case.q), of(case.v));
    let compare = |what: &str, found: &[S::Scalar], expected: &[&str]| {
        compare(&format!("{name}, {what}"), found, expected, bar);
    };
    let at = At { t, q: &q, v: &v, inputs };
    let accelerations = system.accelerations(at);
    compare("accelerations", &accelerations, &case.accelerations);
    let momenta = system.momenta(at);
    compare("momenta", &momenta, &case.momenta);
    compare("momentum rates", &system.momentum_rates(at), &case.momentum_rates);
    compare("energy", &[system.energy(at)], &[case.energy]);
    compare("power", &[system.power(at)], &[case.power]);
    // The computation in stages gives the same bits.
    let prepared = system.prepare();
    assert_eq!(system.accelerations_prepared(&prepared, at), accelerations, "{name}");
    let at_time = S::at_time(t, inputs);
    let at_position = system.at_position(&prepared, &at_time, t, &q, inputs);
    assert_eq!(
        system.accelerations_staged(&prepared, &at_time, &at_position, t, &q, &v, inputs),
        accelerations,
        "{name}"
    );
    // M q̈ = f, and the inverse of the momenta.
    let matrix = system.mass_matrix(at);
    let forces = system.forces(at);
    let back = system.velocities(t, &q, &momenta, inputs);
    for i in 0..N {
        let size = |x: S::Scalar| x.to_f64().abs();
        let (mut sum, mut scale) = (-forces[i], 1.0 + size(forces[i]));
        for j in 0..N {
            let part = matrix[(i, j)] * accelerations[j];
            sum += part;
            scale += size(part);
        }
        assert!(size(sum) < bar * scale, "{name}: row {i} of M q̈ = f is {:e} off", size(sum));
        assert!(
            size(back[i] - v[i]) < 100.0 * bar,
            "{name}: velocity {i} is {:e} off",
            size(back[i] - v[i])
        );
    }
}

/// Checks the outputs of one module in one scalar.
macro_rules! in_scalar {
    ($module:ident, $scalar:ty, $bar:expr) => {{
        let (system, inputs) =
            (blocks::$module::system::<$scalar>(), blocks::$module::inputs::<$scalar>());
        outputs(stringify!($module), &system, &inputs, &blocks::$module::CASE, $bar);
    }};
}

/// Checks the Taylor coefficients of the accelerations of one module.
macro_rules! jets {
    ($module:ident) => {{
        let (system, inputs, case) =
            (blocks::$module::system(), blocks::$module::inputs::<f64>(), &blocks::$module::CASE);
        let (mut path, mut drive, mut work) =
            (Path::<f64, _>::new(), DriveOf::drive_of(&system), system.work());
        path.t = case.t;
        for (i, (&q, v)) in case.q.iter().zip(case.v).enumerate() {
            (path.q[i][0], path.v[i][0]) = (q, v);
        }
        let components: Vec<[f64; 3]> = inputs.components();
        for (series, ([x, v, a], jerk)) in
            drive.iter_mut().zip(components.into_iter().zip(case.jerks))
        {
            *series = cubic([x, v, a, jerk]);
        }
        run(&system, &mut path, &drive, &mut work);
        let name = stringify!($module);
        compare(
            &format!("{name}, third derivatives"),
            &path.a.map(|series| series[1]),
            &case.third,
            1e-11,
        );
        compare(
            &format!("{name}, fourth derivatives"),
            &path.a.map(|series| 2.0 * series[2]),
            &case.fourth,
            1e-10,
        );
    }};
}

fn run<S: Jets<N>, const N: usize>(
    system: &S,
    path: &mut Path<S::Scalar, N>,
    drive: &S::Drive,
    work: &mut S::Work,
) {
    S::Unrolling::run(system, 6, path, drive, work);
}

/// The drive of a system whose type has no name here.
trait DriveOf<const N: usize>: Jets<N> {
    fn drive_of(_: &Self) -> Self::Drive {
        Self::drive()
    }
}

impl<S: Jets<N>, const N: usize> DriveOf<N> for S {}

/// Adds the distance between the start and the end of a motion of one module that is run for a
/// while and back, if the system is smooth.
macro_rules! there_and_back {
    ($module:ident, $apart:ident) => {{
        let (system, case) = (blocks::$module::system::<f64>(), &blocks::$module::CASE);
        if smooth(&system) {
            let dynamics =
                Driven::new(system, blocks::$module::inputs::<f64>().motions(case.t, &case.jerks));
            let run = |time, q, v| {
                solve(&dynamics, time, q, v)
                    .method(Taylor::new())
                    .rtol(1e-17)
                    .run()
                    .map(|solution| solution.end)
            };
            let end = run((case.t, case.t + 0.25), case.q, case.v).unwrap();
            let back = run((case.t + 0.25, case.t), end.q, end.v).unwrap();
            let size = |x: &[f64], y: &[f64]| {
                x.iter().chain(y).fold(1.0, |size: f64, x| size.max(x.abs()))
            };
            let pairs = back.q.iter().zip(&case.q).chain(back.v.iter().zip(&case.v));
            let own = pairs.fold(0.0, |worst: f64, (x, y)| worst.max((x - y).abs()))
                / size(&end.q, &end.v);
            $apart.push((stringify!($module), own));
        }
    }};
}

/// Returns `true` if Taylor series are valid for a system.
fn smooth<S: System<N>, const N: usize>(_: &S) -> bool {
    S::FACTS.smooth
}

/// Tests integration forwards and backwards along a path, including friction, forces and driven
/// inputs.
#[test]
fn motions_come_back_to_their_start() {
    let mut apart = Vec::new();
    macro_rules! one {
        ($module:ident) => {
            there_and_back!($module, apart)
        };
    }
    blocks::each!(one);
    assert!(20 <= apart.len(), "only {} systems are smooth", apart.len());
    for (name, own) in apart {
        assert!(own < 1e-14, "{name} ends {own:e} from its start");
    }
}

macro_rules! check {
    ($module:ident) => {
        in_scalar!($module, f64, 1e-12);
        in_scalar!($module, DoubleDouble, 1e-25);
        jets!($module);
    };
}

#[test]
fn generated_code_computes_what_is_written() {
    blocks::each!(check);
}
