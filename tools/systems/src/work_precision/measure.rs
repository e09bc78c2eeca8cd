//! A row of the table: a system, a method and a setting, with its run and its timing.

use std::time::Instant;

/// The states at all output times, with coordinates before velocities, and the number of
/// evaluations.
#[derive(Clone, Debug)]
pub struct Run {
    /// All numbers in the order of `reference`.
    pub values: Vec<f64>,
    /// The number of evaluations of the accelerations, or of steps if the method has no
    /// evaluations.
    pub evaluations: u64,
}

/// A run, or the reason for its absence.
pub type Outcome = Result<Run, String>;

/// A row to be timed.
pub struct Row {
    /// The name of the system.
    pub system: String,
    /// The name of the method.
    pub method: String,
    /// The tolerance or the number of steps.
    pub setting: String,
    /// Runs the method once.
    pub run: Box<dyn FnMut() -> Outcome>,
}

impl std::fmt::Debug for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Row({}, {}, {})", self.system, self.method, self.setting)
    }
}

impl Row {
    /// Returns the shortest time of several runs, because interruptions only add time: at least
    /// three runs, as many as fit into a millisecond. Returns the first time of a long run.
    pub fn sample(&mut self) -> Result<(f64, Run), String> {
        let (mut seconds, run) = self.timed()?;
        if seconds < 0.05 {
            for _ in 0..(0.001 / seconds).clamp(2.0, 25.0) as usize {
                seconds = seconds.min(self.timed()?.0);
            }
        }
        Ok((seconds, run))
    }

    fn timed(&mut self) -> Result<(f64, Run), String> {
        let start = Instant::now();
        let outcome = std::hint::black_box((self.run)());
        let seconds = start.elapsed().as_secs_f64();
        outcome.map(|run| (seconds, run))
    }
}
