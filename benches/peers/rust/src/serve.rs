//! The other end of `peer.rs` of the benchmark, where the lines are described.

use systems::work_precision::measure::{Row, Run};
use std::io::Write;

/// Offers `rows` to the process that has started this one.
pub fn serve(versions: &str, rows: &mut [Row]) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{versions}")?;
    for Row { system, method, setting, .. } in &*rows {
        writeln!(out, "{system}\t{method}\t{setting}")?;
    }
    writeln!(out, "ready")?;
    out.flush()?;
    for line in std::io::stdin().lines() {
        let Some(row) = line?.trim().parse().ok().and_then(|index: usize| rows.get_mut(index)) else { break };
        match row.sample() {
            Ok((seconds, Run { values, evaluations })) => {
                write!(out, "{seconds:?} {evaluations}")?;
                for value in values {
                    write!(out, " {value:?}")?;
                }
                writeln!(out)?;
            }
            Err(reason) => writeln!(out, "failed {}", reason.replace('\n', " "))?,
        }
        out.flush()?;
    }
    Ok(())
}
