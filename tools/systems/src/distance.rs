//! The distance of a state from the exact one.

/// The largest difference from the exact state; not a number if a component is not.
pub fn distance<const N: usize>((q, v): ([f64; N], [f64; N]), exact: &[f64]) -> f64 {
    let differences = q.iter().chain(&v).zip(exact).map(|(x, exact)| (x - exact).abs());
    differences.fold(0.0, |largest, x| if x <= largest { largest } else { x })
}
