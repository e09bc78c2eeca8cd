//! A system with a start and an interval.

use crate::case::{Guide, Run, Scalar, State};
use crate::motions::Drive;
use pendulum_runtime::integrate::{Failure, Solution};
use pendulum_runtime::scalar::{DoubleDouble, Float};
use pendulum_runtime::system::System;
use std::fmt::Debug;
use std::time::Duration;

/// A system with a start and an interval.
#[derive(Clone, Debug)]
pub(crate) struct Trial<S, const N: usize> {
    pub(crate) system: S,
    pub(crate) q: [f64; N],
    pub(crate) v: [f64; N],
    pub(crate) end: f64,
    pub(crate) guide: Guide,
    /// The longest step of measured methods.
    pub(crate) limit: f64,
    pub(crate) drive: Option<Drive>,
}

impl<S: System<N, Scalar = f64, With<f64> = S>, const N: usize> Trial<S, N> {
    /// Creates a problem whose numbers are exact in the scalar.
    pub(crate) fn new(
        scalar: Scalar,
        system: &S,
        q: [f64; N],
        v: [f64; N],
        end: f64,
        guide: Guide,
    ) -> Self {
        let round = |x| scalar.round(x);
        Self {
            system: system.map(round),
            q: q.map(round),
            v: v.map(round),
            end,
            guide,
            limit: 1e300,
            drive: None,
        }
    }

    /// Sets the longest step.
    pub(crate) fn limited(self, limit: f64) -> Self {
        Self { limit, ..self }
    }

    /// Sets the motion.
    pub(crate) fn driven(self, drive: Drive) -> Self {
        Self { drive: Some(drive), ..self }
    }
}

/// Joins coordinates and velocities in one list, in double-double without loss.
fn joined<T: Float, const N: usize>(q: &[T; N], v: &[T; N]) -> State {
    let widened = |x: &T| {
        let low = (*x - T::from_f64(x.to_f64())).to_f64();
        DoubleDouble::from(x.to_f64()) + DoubleDouble::from(low)
    };
    q.iter().chain(v).map(widened).collect()
}

pub(crate) fn finished<T: Float, const N: usize>(
    result: Result<Solution<T, N>, Failure<T, N>>,
    time: Duration,
    times: &[f64],
) -> Result<Run, String> {
    let solution = result.map_err(|failure| kind(&failure.error))?;
    let mut states: Vec<State> =
        solution.q.iter().zip(&solution.v).take(times.len()).map(|(q, v)| joined(q, v)).collect();
    states.push(joined(&solution.end.q, &solution.end.v));
    Ok(Run { states, time, stats: solution.stats.to_string() })
}

/// Returns the name of an error.
fn kind(error: &impl Debug) -> String {
    format!("{error:?}").chars().take_while(|c| c.is_alphanumeric()).collect()
}

/// Binds a system to its motion, in the form that users provide or for references.
macro_rules! bind {
    (free, $system:expr, $trial:ident, $kind:ident) => {
        $system
    };
    (driven, $system:expr, $trial:ident, $kind:ident) => {
        $system.driven_by($trial.drive.as_ref().expect("a motion").$kind())
    };
}

macro_rules! with {
    (Default, $problem:expr) => {
        $problem
    };
    (Taylor, $problem:expr) => {
        $problem.method(Taylor::new())
    };
    ($method:ident, $problem:expr) => {
        $problem.method($method)
    };
}

macro_rules! over {
    ($trial:ident, $binding:ident, $scalar:ty, $n:literal, $convert:expr, $method:ident, $tolerance:ident, $times:ident, [$($name:ident)*]) => {{
        let dynamics = bind!($binding, pendulum_runtime::system::System::map(&$trial.system, $convert), $trial, given);
        let (q, v) = ($trial.q.map($convert), $trial.v.map($convert));
        let problem = solve(&dynamics, (0.0, $trial.end), q, v)
            .rtol($tolerance)
            .atol_each([$tolerance; $n], [$tolerance; $n])
            .max_step($trial.limit)
            .t_eval($times)
            .max_steps(MOST);
        match $method {
            $(Method::$name => {
                let begin = Instant::now();
                let result = with!($name, problem).run();
                finished::<$scalar, $n>(result, begin.elapsed(), $times)
            })*
            #[allow(unreachable_patterns)]
            _ => Err("NotMeasured".into()),
        }
    }};
}

/// Implements `Case` for a system: the method of its reference, and the methods measured for each
/// scalar.
#[cfg(feature = "all")]
macro_rules! case {
    ($($all:tt)*) => { implement!($($all)*); };
}

/// Implements `Case` with the scalar and the methods of the test.
#[cfg(not(feature = "all"))]
macro_rules! case {
    ($system:ident, $n:literal, $binding:ident, $reference:ident, $($others:tt)*) => {
        implement!($system, $n, $binding, $reference, f64 [Default Picard Dop853]);
    };
}

macro_rules! implement {
    ($system:ident, $n:literal, $binding:ident, $reference:ident, f64 [$($double:ident)*] $(, f32 [$($single:ident)+])? $(, dd [$($wide:ident)+])?) => {
        impl Case for Trial<$system<f64>, $n> {
            fn methods(&self, scalar: Scalar) -> &'static [Method] {
                match scalar {
                    Scalar::F64 => &[$(Method::$double),*],
                    Scalar::F32 => &[$($(Method::$single),+)?],
                    Scalar::Wide => &[$($(Method::$wide),+)?],
                }
            }

            fn end(&self) -> f64 {
                self.end
            }

            fn start(&self) -> Vec<f64> {
                self.q.iter().chain(&self.v).copied().collect()
            }

            fn describe(&self) -> String {
                format!("{:?} q = {:?} v = {:?} end = {:?} {:?}", self.system, self.q, self.v, self.end, self.drive)
            }

            fn run(&self, method: Method, scalar: Scalar, tolerance: f64, times: &[f64]) -> Result<Run, String> {
                match scalar {
                    Scalar::F64 => {
                        over!(self, $binding, f64, $n, |x| x, method, tolerance, times, [$($double)*])
                    }
                    $(Scalar::F32 => {
                        over!(self, $binding, f32, $n, |x| x as f32, method, tolerance, times, [$($single)+])
                    })?
                    $(Scalar::Wide => {
                        over!(self, $binding, DoubleDouble, $n, DoubleDouble::from, method, tolerance, times, [$($wide)+])
                    })?
                    #[allow(unreachable_patterns)]
                    _ => Err("NotMeasured".into()),
                }
            }

            fn exact(&self, tolerance: f64, max_step: f64, times: &[f64]) -> Result<Vec<State>, String> {
                let dynamics = bind!($binding, pendulum_runtime::system::System::map(&self.system, DoubleDouble::from), self, exact);
                let (q, v) = (self.q.map(DoubleDouble::from), self.v.map(DoubleDouble::from));
                let stops = self.guide.between(0.0, self.end);
                let problem = solve(&dynamics, (0.0, self.end), q, v)
                    .rtol(tolerance)
                    .atol_each([tolerance; $n], [tolerance; $n])
                    .max_step(max_step)
                    .t_stops(&stops)
                    .t_eval(times);
                let result = with!($reference, problem).run();
                Ok(finished::<DoubleDouble, $n>(result, Duration::ZERO, times)?.states)
            }

            fn by_series(&self) -> bool {
                stringify!($reference) == "Taylor"
            }

            fn flow(&self, t: f64, state: &[f64], steps: bool, tolerance: f64) -> Option<Vec<(f64, Vec<f64>)>> {
                let dynamics = bind!($binding, self.system.clone(), self, exact);
                let q: [f64; $n] = core::array::from_fn(|i| state[i]);
                let v: [f64; $n] = core::array::from_fn(|i| state[$n + i]);
                let stops = self.guide.between(t, self.end);
                let problem = solve(&dynamics, (t, self.end), q, v)
                    .method(Dop853)
                    .rtol(tolerance)
                    .atol_each([tolerance; $n], [tolerance; $n])
                    .max_step(self.guide.max_step)
                    .t_stops(&stops)
                    .max_steps(MOST);
                let solution = if steps { problem.every_step().run() } else { problem.run() }.ok()?;
                let states = solution.q.iter().zip(&solution.v).map(|(q, v)| q.iter().chain(v).copied().collect());
                Some(solution.t.iter().copied().zip(states).collect())
            }

            fn guide(&self) -> &Guide {
                &self.guide
            }
        }
    };
}
