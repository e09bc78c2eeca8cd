//! The default method and `Picard` on difficult systems: no error is far above the tolerance.

#![allow(missing_docs)]

use zoo::{Finding, Method, Options, findings};

/// Nine families with six starts each. The program measures sixty starts of many more families.
#[test]
fn errors_are_those_asked_for() {
    let names = [
        "moving",
        "contact 1e-2",
        "friction",
        "square wave 1e-2",
        "sign(sin 10t)",
        "kick",
        "kick at rest",
        "closure step",
        "kapitza 100 Hz",
    ];
    let families = names.map(String::from).to_vec();
    let methods = vec!["default".into(), "picard".into()];
    let found =
        findings(&Options { count: 6, families, methods, clock: false, ..Options::default() });
    for method in [Method::Default, Method::Picard] {
        let of = |bound: f64| -> Vec<&Finding> {
            let wrong =
                |finding: &&Finding| finding.merit.as_ref().is_ok_and(|merit| bound < *merit);
            found.iter().filter(|finding| finding.method == method).filter(wrong).collect()
        };
        let runs = found
            .iter()
            .filter(|finding| finding.method == method && finding.merit.is_ok())
            .count();
        assert!(runs >= 6 * names.len() - 2, "{runs} runs of {method:?} came to an end");
        // The bars of the program are looser. The measured values here are at most 0.3.
        assert!(of(10.0).is_empty(), "{:#?}", of(10.0));
        assert!(of(1.0).len() <= 1, "{:#?}", of(1.0));
        for name in names {
            let worst = |method| {
                let merits = found
                    .iter()
                    .filter(|finding| finding.method == method && finding.family == name);
                merits
                    .map(|finding| *finding.merit.as_ref().unwrap_or(&f64::INFINITY))
                    .fold(0.0, f64::max)
            };
            let (own, other) = (worst(method), worst(Method::Dop853));
            assert!(own <= 3.0 * other.max(0.3), "{name}: {own} by {method:?}, {other} by Dop853");
        }
    }
}
