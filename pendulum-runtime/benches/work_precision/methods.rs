//! The methods under test and their settings, one per line.
//!
//! The lists are macros, so that each system must implement only the traits that the methods in its
//! own lists require.

use pendulum_runtime::integrate::{Failure, Solution};
use std::rc::Rc;
use systems::work_precision::measure::{Row, Run};
use systems::work_precision::problem::Problem;

/// Methods for any system.
macro_rules! any {
    ($subject:ident) => {
        fixed!($subject, "SymplecticEuler", SymplecticEuler, [10.0, 30.0, 100.0, 300.0, 1000.0]);
        fixed!($subject, "Rk4", Rk4, [4.0, 8.0, 16.0, 32.0, 64.0, 200.0, 600.0]);
        adaptive!($subject, "Dop853", Dop853, [3, 5, 7, 9, 10, 11, 12, 13]);
        adaptive!($subject, "Taylor", Taylor::new(), [3, 5, 7, 9, 11, 13, 15, 18]);
        adaptive!(
            $subject,
            "Picard",
            Picard,
            [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15],
            t_stops
        );
        adaptive!($subject, "Rodas4", Rodas4, [3, 4, 5, 6, 7, 8]);
        fixed!($subject, "Gauss<2>", Gauss::<2>::new(), [2.0, 4.0, 8.0, 16.0, 32.0, 64.0]);
        fixed!($subject, "Gauss<4>", Gauss::<4>::new(), [1.0, 2.0, 4.0, 8.0, 16.0]);
        fixed!($subject, "Gauss<8>", Gauss::<8>::new(), [0.5, 1.0, 1.5, 2.0, 3.0, 4.0]);
    };
}

/// Methods for systems whose accelerations contain no velocity.
macro_rules! velocity_free {
    ($subject:ident) => {
        fixed!($subject, "Leapfrog", Leapfrog, [4.0, 12.0, 40.0, 120.0, 400.0, 1200.0]);
        fixed!($subject, "Srkn6b", Srkn6b, [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 80.0]);
        fixed!($subject, "Srkn14a", Srkn14a, [0.5, 0.8, 1.2, 2.0, 3.0, 5.0, 8.0]);
        adaptive!(
            $subject,
            "Dprkn12",
            Dprkn12,
            [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14],
            t_stops
        );
    };
}

/// Methods for systems of changing scale, whose accelerations contain no velocity.
macro_rules! encounters {
    ($subject:ident) => {
        adaptive!($subject, "Dop853", Dop853, [9, 10, 11, 12, 13, 14]);
        adaptive!($subject, "Taylor", Taylor::new(), [9, 11, 13, 14, 15]);
        adaptive!($subject, "Picard", Picard, [9, 10, 11, 12, 13, 14, 15], t_stops);
        adaptive!($subject, "Dprkn12", Dprkn12, [9, 10, 11, 12, 13, 14], t_stops);
    };
}

/// Adds rows with fixed steps, given as numbers of steps per radian of the fastest motion. Steps
/// end at the output times.
macro_rules! fixed {
    ($subject:ident, $name:literal, $method:expr, $steps_per_radian:expr) => {
        for density in $steps_per_radian.into_iter().step_by($subject.every) {
            let (Problem { q, v, times, .. }, end, dynamics) = $subject.parts();
            let steps = $subject.steps(density);
            $subject.add($name, format!("steps={steps}"), move || {
                let problem =
                    solve(black_box(&*dynamics), (0.0, end), q, v).method($method).steps(steps);
                methods::values(problem.t_stops(&times).t_eval(&times).run())
            });
        }
    };
}

/// Adds rows with relative and absolute tolerances 10^(−exponent). The states at the output times
/// are read from the dense output, or steps end at these times.
macro_rules! adaptive {
    ($subject:ident, $name:literal, $method:expr, $exponents:expr $(, $stops:ident)?) => {
        for exponent in $exponents.into_iter().step_by($subject.every) {
            let (Problem { q, v, times, .. }, end, dynamics) = $subject.parts();
            let tolerance = 10f64.powi(-exponent);
            $subject.add($name, format!("tol=1e-{exponent}"), move || {
                let problem = solve(black_box(&*dynamics), (0.0, end), q, v).method($method);
                methods::values(problem.rtol(tolerance).atol(tolerance)$(.$stops(&times))?.t_eval(&times).run())
            });
        }
    };
}

/// A problem with its dynamics and the list of its rows.
pub struct Subject<'a, const N: usize, D> {
    rows: &'a mut Vec<Row>,
    problem: Problem<N>,
    rate: f64,
    /// One setting in `every` is run.
    pub every: usize,
    dynamics: Rc<D>,
}

impl<'a, const N: usize, D> Subject<'a, N, D> {
    /// Creates a subject. `rate` is the approximate angular frequency of the fastest motion in
    /// rad/s.
    pub fn new(
        rows: &'a mut Vec<Row>,
        name: &'static str,
        rate: f64,
        every: usize,
        dynamics: D,
    ) -> Self {
        Self { rows, problem: Problem::new(name), rate, every, dynamics: Rc::new(dynamics) }
    }

    /// Returns the problem, its end time and its dynamics.
    pub fn parts(&self) -> (Problem<N>, f64, Rc<D>) {
        (self.problem.clone(), self.end(), Rc::clone(&self.dynamics))
    }

    /// Returns the number of steps, which are equally many between any two output times.
    pub fn steps(&self, steps_per_radian: f64) -> u64 {
        let intervals = self.problem.times.len() as f64;
        ((steps_per_radian * self.rate * self.end() / intervals).ceil() * intervals) as u64
    }

    /// Adds a row.
    pub fn add(
        &mut self,
        method: &str,
        setting: String,
        run: impl FnMut() -> Result<Run, String> + 'static,
    ) {
        let (system, method) = (self.problem.name.to_string(), method.to_string());
        self.rows.push(Row { system, method, setting, run: Box::new(run) });
    }

    fn end(&self) -> f64 {
        self.problem.times[self.problem.times.len() - 1]
    }
}

/// Returns the states at the output times.
pub fn values<const N: usize>(
    result: Result<Solution<f64, N>, Failure<f64, N>>,
) -> Result<Run, String> {
    let solution = result.map_err(|failure| failure.to_string())?;
    let values =
        solution.q.iter().zip(&solution.v).flat_map(|(q, v)| q.iter().chain(v).copied()).collect();
    Ok(Run { values, evaluations: solution.stats.evaluations })
}
