//! Reference values, from the table beside this file.

use ::systems::work_precision::problem::table;

/// P23: the time at which the upper link first reaches +π.
pub(crate) const FLIP: f64 = 12.5762618679385806941741444011;

/// The keyed pivot of K1 after 5 s: straight lines and Catmull–Rom curves.
pub(crate) const KEYED: [f64; 2] = [-0.129608683467, -0.128838666144];

/// Returns times, and coordinates and velocities at each, of a problem.
pub(crate) fn rows(problem: &str) -> Vec<(f64, Vec<f64>)> {
    let number = |word: &str| word.parse::<f64>().expect("a number");
    let lines = table(include_str!("reference.txt")).into_iter().filter(|line| line.0 == problem);
    lines.map(|(_, t, words)| (t, words.into_iter().map(number).collect())).collect()
}

/// Returns the coordinates and velocities of a problem at one of its times.
pub(crate) fn at(problem: &str, t: f64) -> Vec<f64> {
    rows(problem).into_iter().find(|row| row.0 == t).expect("a time of the table").1
}
