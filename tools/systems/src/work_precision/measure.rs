//! One row of the table: a system, a method, a setting, and how they are run and timed.

use std::time::Instant;

/// The states at all output times, coordinates before velocities, and what they took.
#[derive(Clone, Debug)]
pub struct Run {
    /// All numbers in the order of `reference`.
    pub values: Vec<f64>,
    /// Evaluations of the accelerations; steps where a method has no evaluations.
    pub evaluations: u64,
}

/// A run, or why there is none.
pub type Outcome = Result<Run, String>;

/// Something to be timed.
pub struct Row {
    /// The name of the system.
    pub system: String,
    /// The name of the method.
    pub method: String,
    /// The tolerance or the number of steps.
    pub setting: String,
    /// Runs it once.
    pub run: Box<dyn FnMut() -> Outcome>,
}

impl std::fmt::Debug for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Row({}, {}, {})", self.system, self.method, self.setting)
    }
}

impl Row {
    /// The shortest of at least three runs, as many as fit into a millisecond, because
    /// interruptions only add; of a long run the first.
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
