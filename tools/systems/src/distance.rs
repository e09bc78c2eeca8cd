//! The distance of a state from the exact state.

/// Returns the largest difference from the exact state, or NaN if a component is NaN.
pub fn distance<const N: usize>((q, v): ([f64; N], [f64; N]), exact: &[f64]) -> f64 {
    let differences = q.iter().chain(&v).zip(exact).map(|(x, exact)| (x - exact).abs());
    differences.fold(0.0, |largest, x| if x <= largest { largest } else { x })
}
