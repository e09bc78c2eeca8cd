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
    /// Less than a minute in all.
    Quick,
    /// A few minutes.
    Usual,
    /// As long as it takes.
    Long,
}

impl Scale {
    /// The value for this scale.
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

/// One measurement.
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

    /// Returns true if a miss has a reason that is known.
    pub(crate) fn is_explained(&self) -> bool {
        !self.why.is_empty()
    }

    /// The line that is printed.
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

    /// The row of the table of values.
    pub(crate) fn row(&self, title: &str) -> String {
        let (least, greatest) = match self.bar {
            Bar::AtMost(bar) => (String::new(), bar),
            Bar::Between(least, greatest) => (least.to_string(), greatest),
        };
        let Self { id, what, measured, .. } = self;
        format!("{id},\"{title}\",\"{what}\",{measured:e},{least},{greatest:e},{}", self.holds())
    }
}

/// A number of two digits, or a count as it is.
fn digits(value: f64) -> String {
    if value == 0.0 || (value == value.round() && value.abs() < 1e4) {
        format!("{value}")
    } else if 0.01 <= value.abs() && value.abs() < 1e4 {
        format!("{value:.3}")
    } else {
        format!("{value:.1e}")
    }
}

/// A picture that curves belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Figure {
    Energy,
    Phase,
    Separation,
    Kinks,
}

/// Points of one method.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    pub(crate) figure: Figure,
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
}

/// The findings of a test.
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

    /// A number that must not exceed its bar; what is not a number does.
    pub(crate) fn at_most(
        &mut self,
        what: impl Into<String>,
        measured: f64,
        bar: f64,
    ) -> &mut Check {
        self.check(what, measured, Bar::AtMost(bar))
    }

    /// A number between two others.
    pub(crate) fn between(
        &mut self,
        what: impl Into<String>,
        measured: f64,
        least: f64,
        greatest: f64,
    ) -> &mut Check {
        self.check(what, measured, Bar::Between(least, greatest))
    }

    /// The number of cases that fail their condition; none may.
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
    /// Sets the text of the line if the bar is missed.
    pub(crate) fn because(&mut self, why: &'static str) {
        self.why = why;
    }
}
