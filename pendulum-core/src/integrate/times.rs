//! Times in the direction of an integration.

use crate::error::Error;

/// Checks that `times` are finite, within the interval and in its direction.
pub(crate) fn in_order(
    name: &'static str,
    times: &[f64],
    start: f64,
    end: f64,
) -> Result<(), Error> {
    let onwards = direction(start, end);
    let mut least = onwards * start;
    for (index, &time) in times.iter().enumerate() {
        if !(least <= onwards * time && onwards * time <= onwards * end) {
            return Err(Error::Times { name, index, time });
        }
        least = onwards * time;
    }
    Ok(())
}

/// Returns −1 for an interval that leads back in time, otherwise 1.
pub(crate) fn direction(start: f64, end: f64) -> f64 {
    if end < start { -1.0 } else { 1.0 }
}

/// Returns `true` if an integration from `start` to `end` reaches `a` before `b`.
pub(crate) fn precedes(a: f64, b: f64, (start, end): (f64, f64)) -> bool {
    if end < start { b < a } else { a < b }
}
