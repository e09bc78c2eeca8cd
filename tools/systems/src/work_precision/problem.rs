//! The problem of each system.

use std::sync::LazyLock;

/// A problem: integrates from the state at 0 to the states at `times`.
#[derive(Clone, Debug)]
pub struct Problem<const N: usize> {
    /// The name of the system.
    pub name: &'static str,
    /// The coordinates at 0.
    pub q: [f64; N],
    /// The velocities at 0.
    pub v: [f64; N],
    /// The output times in ascending order. The last is the end.
    pub times: Vec<f64>,
}

impl<const N: usize> Problem<N> {
    /// Creates the problem with this name in `reference.txt`.
    ///
    /// # Panics
    /// Panics if `reference.txt` does not contain the system.
    pub fn new(name: &'static str) -> Self {
        let mut rows = lines(name);
        let start = rows.next().expect("reference.txt knows the system");
        let value = |i: usize| start.2[i].parse().expect("a number");
        let times = rows.map(|line| line.1).collect();
        Self {
            name,
            q: core::array::from_fn(value),
            v: core::array::from_fn(|i| value(N + i)),
            times,
        }
    }
}

/// A line of `reference.txt`: the system, the time, and the coordinates and velocities as decimals.
pub type Line = (&'static str, f64, Vec<&'static str>);

/// Returns the lines of a system.
pub fn lines(name: &str) -> impl Iterator<Item = &'static Line> {
    LINES.iter().filter(move |line| line.0 == name)
}

static LINES: LazyLock<Vec<Line>> = LazyLock::new(|| table(include_str!("reference.txt")));

/// Returns the lines of a table in the form of `reference.txt`.
///
/// # Panics
/// Panics if a line does not begin with a name and a time.
pub fn table(text: &'static str) -> Vec<Line> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines
        .map(|line| {
            let mut words = line.split_whitespace();
            let (name, time) = (words.next().expect("a name"), words.next().expect("a time"));
            (name, time.parse().expect("a time"), words.collect())
        })
        .collect()
}
