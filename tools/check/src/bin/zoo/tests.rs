//! The default method and `Picard` on difficult systems: no error is far above the tolerance.

use crate::case::Method;
use crate::{Options, measured, report};

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
    let rows = measured(&Options { count: 6, threads: 2, families, methods, ..Options::default() });
    for method in [Method::Default, Method::Picard] {
        let runs = report::merits(&rows, method).len();
        assert!(runs >= 6 * names.len() - 2, "{runs} runs of {method:?} came to an end");
        // The bars of the program are looser. The measured values here are at most 0.3.
        let above = |bound: f64| report::wrong(&rows, method, bound);
        assert!(above(10.0).is_empty(), "{:#?}", above(10.0));
        assert!(above(1.0).len() <= 1, "{:#?}", above(1.0));
        for row in &rows {
            let worst = |method| {
                let merits = row.of(method).map(|(_, m)| m.merit.as_ref());
                merits.map(|merit| merit.map_or(f64::INFINITY, |merit| merit.0)).fold(0.0, f64::max)
            };
            let (own, other) = (worst(method), worst(Method::Dop853));
            let name = row.family.name;
            assert!(own <= 3.0 * other.max(0.3), "{name}: {own} by {method:?}, {other} by Dop853");
        }
    }
}
