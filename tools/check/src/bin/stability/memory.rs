//! The memory in use.

/// Returns the bytes of resident memory of this process, if the system provides them.
pub(crate) fn memory() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/statm").ok()?;
    text.split_whitespace().nth(1)?.parse::<f64>().ok().map(|pages| pages * 4096.0)
}
