//! A pivot with 24 keys a second, for tests of driven motions with kinks.

/// Returns the keys K_i = 0.1 sin(0.12 i) + 0.004 (u_i − ½) at the times (i − 1)/24, starting at
/// i = 0. The numbers u_i are from a linear congruential generator.
pub fn keys() -> (Vec<f64>, Vec<[f64; 2]>) {
    let mut state = 12345u32;
    let mut next = || {
        state = state.wrapping_mul(1664525).wrapping_add(1013904223);
        f64::from(state >> 8) / f64::from(1u32 << 24) - 0.5
    };
    let times = (0..400).map(|i| (f64::from(i) - 1.0) / 24.0).collect();
    let values =
        (0..400).map(|i| [0.1 * (0.12 * f64::from(i)).sin() + 0.004 * next(), 0.0]).collect();
    (times, values)
}
