//! The measurements of a test and their bars.

/// A row of the stress table.
#[derive(Clone, Copy)]
pub(crate) struct Test {
    pub(crate) id: &'static str,
    pub(crate) title: &'static str,
    pub(crate) run: fn(Scale, &mut Report),
}

/// The length of the runs.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Scale {
    /// Less than a minute for all tests.
    Quick,
    /// A few minutes.
    Usual,
    /// The full length, about an hour.
    Long,
}

impl Scale {
    /// Returns the value for this scale.
    pub(crate) fn pick<T>(self, quick: T, usual: T, long: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Usual => usual,
            Self::Long => long,
        }
    }
}

/// The condition on a measured number.
#[derive(Clone, Copy)]
pub(crate) enum Bar {
    AtMost(f64),
    Between(f64, f64),
}

impl Bar {
    fn met(self, measured: f64) -> bool {
        match self {
            Self::AtMost(bar) => measured <= bar,
            Self::Between(least, greatest) => least <= measured && measured <= greatest,
        }
    }
}

impl std::fmt::Display for Bar {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match *self {
            Self::AtMost(bar) => write!(f, "{}", digits(bar)),
            Self::Between(least, greatest) => {
                write!(f, "{} to {}", digits(least), digits(greatest))
            }
        }
    }
}

/// A measurement.
#[derive(Clone)]
pub(crate) struct Check {
    pub(crate) id: &'static str,
    pub(crate) what: String,
    pub(crate) measured: f64,
    pub(crate) bar: Bar,
    why: &'static str,
}

impl Check {
    pub(crate) fn holds(&self) -> bool {
        self.bar.met(self.measured)
    }

    /// Returns `true` if a miss has a known reason.
    pub(crate) fn is_explained(&self) -> bool {
        !self.why.is_empty()
    }

    /// Returns the printed line.
    pub(crate) fn line(&self, title: &str) -> String {
        let Self { id, what, measured, bar, why } = self;
        let measured = digits(*measured);
        let verdict = match (self.holds(), *why) {
            (true, _) => "holds".to_owned(),
            (false, "") => "misses".to_owned(),
            (false, why) => format!("misses: {why}"),
        };
        format!("{id} {title}: {what} … measured {measured}, bar {bar}, {verdict}")
    }

    /// Returns the row of the table of values.
    pub(crate) fn row(&self, title: &str) -> String {
        let (least, greatest) = match self.bar {
            Bar::AtMost(bar) => (String::new(), bar),
            Bar::Between(least, greatest) => (least.to_string(), greatest),
        };
        let Self { id, what, measured, .. } = self;
        format!("{id},\"{title}\",\"{what}\",{measured:e},{least},{greatest:e},{}", self.holds())
    }
}

/// Formats a number with few digits, or a count as an integer.
fn digits(value: f64) -> String {
    if value == 0.0 || (value == value.round() && value.abs() < 1e4) {
        format!("{value}")
    } else if 0.01 <= value.abs() && value.abs() < 1e4 {
        format!("{value:.3}")
    } else {
        format!("{value:.1e}")
    }
}

/// The picture of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Figure {
    Energy,
    Phase,
    Separation,
    Kinks,
}

/// The points of a method.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    pub(crate) figure: Figure,
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
}

/// The measurements of a test.
#[derive(Default)]
pub(crate) struct Report {
    pub(crate) id: &'static str,
    pub(crate) checks: Vec<Check>,
    pub(crate) curves: Vec<Curve>,
}

impl Report {
    pub(crate) fn new(id: &'static str) -> Self {
        Self { id, ..Self::default() }
    }

    fn check(&mut self, what: impl Into<String>, measured: f64, bar: Bar) -> &mut Check {
        self.checks.push(Check { id: self.id, what: what.into(), measured, bar, why: "" });
        let last = self.checks.len() - 1;
        &mut self.checks[last]
    }

    /// Adds a number that must not exceed its bar. NaN exceeds every bar.
    pub(crate) fn at_most(
        &mut self,
        what: impl Into<String>,
        measured: f64,
        bar: f64,
    ) -> &mut Check {
        self.check(what, measured, Bar::AtMost(bar))
    }

    /// Adds a number that must be between two bounds.
    pub(crate) fn between(
        &mut self,
        what: impl Into<String>,
        measured: f64,
        least: f64,
        greatest: f64,
    ) -> &mut Check {
        self.check(what, measured, Bar::Between(least, greatest))
    }

    /// Adds the number of cases that fail their condition, which must be zero.
    pub(crate) fn failures(
        &mut self,
        what: impl Into<String>,
        cases: impl IntoIterator<Item = bool>,
    ) -> &mut Check {
        let failed = cases.into_iter().filter(|holds| !holds).count();
        self.check(what, failed as f64, Bar::AtMost(0.0))
    }

    pub(crate) fn curve(
        &mut self,
        figure: Figure,
        name: impl Into<String>,
        points: Vec<(f64, f64)>,
    ) {
        self.curves.push(Curve { figure, name: name.into(), points });
    }
}

impl Check {
    /// Sets the reason printed if the bar is missed.
    pub(crate) fn because(&mut self, why: &'static str) {
        self.why = why;
    }
}
