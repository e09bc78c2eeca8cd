//! The table of all measurements, and its conversion to and from CSV.

use std::path::Path;

/// An entry of the table.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The name of the system.
    pub system: String,
    /// The name of the method.
    pub method: String,
    /// The tolerance or the number of steps.
    pub setting: String,
    /// The seconds in each round, or their median if the entry comes from a file.
    pub samples: Vec<f64>,
    /// The error and the number of evaluations, or the reason of the failure.
    pub result: Result<(f64, u64), String>,
}

impl Entry {
    /// Creates an entry without samples.
    pub fn new([system, method, setting]: [String; 3]) -> Self {
        Self { system, method, setting, samples: Vec::new(), result: Err("not run".to_string()) }
    }

    /// Returns the error; `None` if the entry has failed.
    pub fn error(&self) -> Option<f64> {
        self.result.as_ref().ok().map(|(error, _)| *error)
    }

    /// Returns the median of the times.
    pub fn seconds(&self) -> f64 {
        median(&mut self.samples.clone())
    }

    /// Returns the origin of the method.
    pub fn party(&self) -> Party {
        let parties = [Party::Heyoka, Party::OdeSolvers, Party::DifferentialEquations];
        parties
            .into_iter()
            .find(|party| self.method.starts_with(party.prefix()))
            .unwrap_or(Party::Ours)
    }
}

/// The origin of a method, which is the prefix of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Party {
    /// This crate.
    Ours,
    /// The Python package heyoka.
    Heyoka,
    /// The crate `ode_solvers`.
    OdeSolvers,
    /// The crate `differential-equations`.
    DifferentialEquations,
}

impl Party {
    fn prefix(self) -> &'static str {
        match self {
            Party::Ours => "",
            Party::Heyoka => "heyoka",
            Party::OdeSolvers => "ode_solvers",
            Party::DifferentialEquations => "differential-equations",
        }
    }
}

/// Returns the largest difference of `values` from the `reference`, which has two words; NaN if a
/// value is NaN.
pub fn largest_error(values: &[f64], reference: &[(f64, f64)]) -> f64 {
    let distances =
        values.iter().zip(reference).map(|(value, (high, low))| ((value - high) - low).abs());
    distances.fold(0.0, |largest, distance| if distance <= largest { largest } else { distance })
}

const HEADER: &str = "system,method,setting,error,seconds,evaluations";

/// Writes all entries. A failed entry has the error `failed`, without time and evaluations.
pub fn write(path: &Path, entries: &[Entry]) -> std::io::Result<()> {
    let line = |entry: &Entry| {
        let Entry { system, method, setting, .. } = entry;
        let result = match entry.result {
            Ok((error, evaluations)) => {
                format!("{error:.3e},{:.6e},{evaluations}", entry.seconds())
            }
            Err(_) => "failed,,".to_string(),
        };
        format!("{system},{method},{setting},{result}\n")
    };
    let text: String =
        std::iter::once(format!("{HEADER}\n")).chain(entries.iter().map(line)).collect();
    std::fs::write(path, text)
}

/// Reads a table of another program, with columns in any order and possibly further columns.
/// Invalid lines are omitted.
pub fn read(path: &Path) -> Result<Vec<Entry>, String> {
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').map(str::trim).collect();
    let column = |name: &str| {
        header.iter().position(|word| *word == name).ok_or_else(|| format!("no column `{name}`"))
    };
    let columns = ["system", "method", "setting", "error", "seconds", "evaluations"].map(column);
    let [system, method, setting, error, seconds, evaluations] = columns;
    let [system, method, setting, error, seconds, evaluations] =
        [system?, method?, setting?, error?, seconds?, evaluations?];
    let entries = lines.filter_map(|line| {
        let words: Vec<&str> = line.split(',').map(str::trim).collect();
        let word = |index: usize| words.get(index).copied();
        let mut entry = Entry::new(
            [system, method, setting].map(|index| word(index).unwrap_or_default().to_string()),
        );
        let number = |index: usize| {
            word(index)?.parse::<f64>().ok().filter(|value| 0.0 <= *value && value.is_finite())
        };
        if word(error)? == "failed" {
            entry.result = Err("failed".to_string());
        } else {
            entry.result = Ok((number(error)?, number(evaluations).unwrap_or(0.0) as u64));
            entry.samples = vec![number(seconds).filter(|seconds| 0.0 < *seconds)?];
        }
        Some(entry)
    });
    Ok(entries.collect())
}

/// Returns the median of `values`; infinity if there are none.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::INFINITY)
}
