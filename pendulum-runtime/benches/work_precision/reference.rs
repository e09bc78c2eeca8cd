//! The reference states, in two words each.

use systems::work_precision::problem::lines;

/// Returns the reference values of a system at all output times, coordinates before velocities,
/// each as a sum of two doubles.
pub fn reference(name: &str) -> Vec<(f64, f64)> {
    lines(name)
        .filter(|line| line.1 != 0.0)
        .flat_map(|line| line.2.iter().map(|text| split(text)))
        .collect()
}

/// Splits a decimal number into the nearest double and the double nearest to the remainder.
fn split(text: &str) -> (f64, f64) {
    let high: f64 = text.parse().expect("a number");
    (high, (scaled(text) - scaled(&format!("{high:.32}"))) as f64 / 1e32)
}

/// Returns the number times 10³², truncated to an integer.
fn scaled(text: &str) -> i128 {
    let (negative, digits) = text.strip_prefix('-').map_or((false, text), |digits| (true, digits));
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let value = format!("{whole}{fraction:0<32.32}")
        .parse::<i128>()
        .expect("fewer than six digits before the point");
    if negative { -value } else { value }
}
