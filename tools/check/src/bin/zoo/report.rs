//! Tables and bars.

use crate::case::Method;
use crate::families::Family;
use crate::measure::{Measured, Measurement};
use std::collections::BTreeMap;
use std::fmt::Write;

/// A family with its runs.
pub(crate) struct Row<'a> {
    pub(crate) family: &'a Family,
    pub(crate) runs: Vec<Measured>,
    /// The runs without a reference.
    pub(crate) lost: Vec<(usize, String)>,
}

/// Returns the quantile of the sorted `values` at the fraction `part`.
pub(crate) fn quantile(values: &[f64], part: f64) -> f64 {
    if values.is_empty() {
        return f64::NAN;
    }
    values[((values.len() - 1) as f64 * part).round() as usize]
}

/// Returns the number of values above a bound.
pub(crate) fn above(values: &[f64], bound: f64) -> usize {
    values.iter().filter(|value| bound < **value).count()
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}

impl Row<'_> {
    pub(crate) fn of(&self, method: Method) -> impl Iterator<Item = (&Measured, &Measurement)> {
        self.runs
            .iter()
            .flat_map(|run| run.measurements.iter().map(move |m| (run, m)))
            .filter(move |(_, m)| m.method == method)
    }

    fn merits(&self, method: Method) -> Vec<f64> {
        sorted(self.of(method).filter_map(|(_, m)| m.merit.as_ref().ok()).map(|merit| merit.0))
    }

    fn methods(&self) -> Vec<Method> {
        Method::ALL.into_iter().filter(|method| self.of(*method).next().is_some()).collect()
    }
}

/// Formats a number with two significant digits.
fn short(x: f64) -> String {
    if x.is_nan() {
        "–".into()
    } else if x == 0.0 || (0.01..999.5).contains(&x) {
        if x < 9.95 { format!("{x:.2}") } else { format!("{x:.0}") }
    } else {
        format!("{x:.0e}")
    }
}

/// Returns the table of families and methods.
pub(crate) fn table(rows: &[Row<'_>]) -> String {
    let mut text = String::from(
        "family                 method     median     90 %      max  > 100 > 1000 failed dense 90 %   time\n",
    );
    for row in rows {
        for method in row.methods() {
            let merits = row.merits(method);
            let merit = |m: &Measurement| m.merit.as_ref().ok().map(|merit| merit.1);
            let dense = sorted(row.of(method).filter_map(|(_, m)| merit(m)));
            let times = sorted(row.of(method).filter_map(|(_, m)| m.time));
            let failed = row.of(method).filter(|(_, m)| m.merit.is_err()).count();
            let [a, b, c] = [0.5, 0.9, 1.0].map(|part| short(quantile(&merits, part)));
            let [i, j] = [short(quantile(&dense, 0.9)), short(quantile(&times, 0.5))];
            let [d, e] = [100.0, 1000.0].map(|bound| above(&merits, bound));
            let (name, method) = (row.family.name, method.name());
            let _ = writeln!(
                text,
                "{name:22} {method:8} {a:>8} {b:>8} {c:>8} {d:>6} {e:>6} {failed:>6} {i:>10} {j:>6}"
            );
        }
    }
    text
}

/// Returns the tables of the documentation: all families by method; and each family with the median
/// amplification, the runs without a reference, and for each method the median, the 90 % quantile
/// and the largest merit, and its time relative to that of `Dop853`.
pub(crate) fn markdown(rows: &[Row<'_>]) -> String {
    let mut text = String::from(
        "| all | runs | median | 90 % | above 100 | above 1000 | errors |\n|---|---|---|---|---|---|---|\n",
    );
    for method in Method::ALL {
        let merits = merits(rows, method);
        if merits.is_empty() {
            continue;
        }
        let [median, most] = [0.5, 0.9].map(|part| short(quantile(&merits, part)));
        let [d, e] = [100.0, 1000.0].map(|bound| above(&merits, bound));
        let (name, runs, failed) = (method.name(), merits.len(), failed(rows, method));
        let _ = writeln!(text, "| {name} | {runs} | {median} | {most} | {d} | {e} | {failed} |");
    }
    let names = Method::ALL.map(Method::name).join(" | ");
    let _ = writeln!(
        text,
        "\n| family | amplified | lost | {names} |\n|{}",
        "---|".repeat(3 + Method::ALL.len())
    );
    for row in rows {
        let amplifications = sorted(row.runs.iter().map(|run| run.amplification));
        let (amplified, lost) = (short(quantile(&amplifications, 0.5)), row.lost.len());
        let _ = write!(text, "| {} | {amplified} | {lost}", row.family.name);
        for method in Method::ALL {
            let merits = row.merits(method);
            let times = sorted(row.of(method).filter_map(|(_, m)| m.time));
            let [a, b, c] = [0.5, 0.9, 1.0].map(|part| short(quantile(&merits, part)));
            let _ = match (merits.is_empty(), times.is_empty()) {
                (true, _) => write!(text, " | –"),
                (_, true) => write!(text, " | {a} / {b} / {c}"),
                _ => write!(text, " | {a} / {b} / {c}, {}", short(quantile(&times, 0.5))),
            };
        }
        let _ = writeln!(text, " |");
    }
    text
}

/// Returns the number of runs that ended in an error.
pub(crate) fn failed(rows: &[Row<'_>], method: Method) -> usize {
    rows.iter().flat_map(|row| row.of(method)).filter(|(_, m)| m.merit.is_err()).count()
}

/// Returns the number of runs without a reference, and the number of all runs.
pub(crate) fn lost(rows: &[Row<'_>]) -> (usize, usize) {
    let lost = rows.iter().map(|row| row.lost.len()).sum();
    (lost, lost + rows.iter().map(|row| row.runs.len()).sum::<usize>())
}

/// Describes the accuracy of the references, with a line for each family.
pub(crate) fn references(rows: &[Row<'_>]) -> String {
    let mut text = String::new();
    for row in rows {
        let worst = row.runs.iter().map(|run| run.doubt).fold(0.0, f64::max);
        let part = row.runs.iter().map(|run| run.doubt / (run.tolerance * run.amplification));
        let amplifications = sorted(row.runs.iter().map(|run| run.amplification));
        let _ = writeln!(
            text,
            "{:22} digits {:4.1}, doubt over tolerance {:7.0e}, amplification median {:7.1e} most {:7.1e}",
            row.family.name,
            -worst.log10(),
            part.fold(0.0, f64::max),
            quantile(&amplifications, 0.5),
            quantile(&amplifications, 1.0)
        );
        for (run, why) in &row.lost {
            let _ = writeln!(text, "    run {run} has no reference: {why}");
        }
    }
    text
}

/// Returns the summary of each method over all families, with every run above the bound and every
/// failure.
pub(crate) fn summary(rows: &[Row<'_>]) -> String {
    let mut text = String::new();
    for method in Method::ALL {
        let merits = merits(rows, method);
        if merits.is_empty() {
            continue;
        }
        let mut failures = BTreeMap::<&str, usize>::new();
        let runs = rows.iter().flat_map(|row| row.of(method));
        for why in runs.filter_map(|(_, m)| m.merit.as_ref().err()) {
            *failures.entry(why).or_default() += 1;
        }
        let _ = writeln!(
            text,
            "{:8} {} runs: median {}, 90 % {}, above 100 {:.2} %, above 1000 {}, failures {:?}",
            method.name(),
            merits.len(),
            short(quantile(&merits, 0.5)),
            short(quantile(&merits, 0.9)),
            100.0 * above(&merits, 100.0) as f64 / merits.len() as f64,
            above(&merits, 1000.0),
            failures
        );
        let worse: Vec<String> = worse(rows, method, 0.0);
        if !worse.is_empty() {
            let _ = writeln!(text, "         90 % above 3 × that of Dop853: {}", worse.join(", "));
        }
    }
    text
}

/// Returns the families in which the 90 % quantile is more than three times the larger of that of
/// `Dop853` and `floor`.
pub(crate) fn worse(rows: &[Row<'_>], method: Method, floor: f64) -> Vec<String> {
    let mut names = Vec::new();
    for row in rows {
        let (own, other) =
            (quantile(&row.merits(method), 0.9), quantile(&row.merits(Method::Dop853), 0.9));
        if own > 3.0 * other.max(floor) {
            names.push(format!("{} ({} : {})", row.family.name, short(own), short(other)));
        }
    }
    names
}

/// Returns the runs above a bound, with the options that repeat them.
pub(crate) fn wrong(rows: &[Row<'_>], method: Method, bound: f64) -> Vec<String> {
    let mut lines = Vec::new();
    for row in rows {
        for (Measured { run, tolerance, amplification, start, .. }, m) in row.of(method) {
            let merit = m.merit.as_ref().map_or(f64::NAN, |merit| merit.0);
            if bound < merit {
                let (name, method, merit) = (row.family.name, method.name(), short(merit));
                lines.push(format!(
                    "--family '{name}' --run {run} --method {method}: tolerance {tolerance:.2e}, \
                     amplification {amplification:.1e}, merit {merit}, {start}"
                ));
            }
        }
    }
    lines
}

/// Returns the sorted merits of a method over all families.
pub(crate) fn merits(rows: &[Row<'_>], method: Method) -> Vec<f64> {
    sorted(rows.iter().flat_map(|row| row.merits(method)))
}
