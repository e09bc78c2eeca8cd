//! Measurements and their bars.

/// A test of the stress table.
#[derive(Clone, Copy, Debug)]
pub struct Test {
    /// The short name, as S7.
    pub id: &'static str,
    /// What goes wrong.
    pub title: &'static str,
    /// Adds the measurements.
    pub run: fn(Scale, &mut Report),
}

/// The length of the runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Less than a minute for all tests.
    Quick,
    /// A few minutes.
    Usual,
    /// The full length, about an hour.
    Long,
}

impl Scale {
    /// Returns the value for this scale.
    pub fn pick<T>(self, quick: T, usual: T, long: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Usual => usual,
            Self::Long => long,
        }
    }
}

/// A measurement.
#[derive(Clone, Debug)]
pub struct Check {
    id: &'static str,
    what: String,
    measured: f64,
    /// The bounds on the number. NaN is outside of all.
    least: Option<f64>,
    greatest: f64,
    why: &'static str,
}

impl Check {
    /// Returns `true` if the bar is met.
    pub fn holds(&self) -> bool {
        self.least.is_none_or(|least| least <= self.measured) && self.measured <= self.greatest
    }

    /// Sets a number that must not exceed its bar. NaN exceeds every bar.
    pub fn at_most(&mut self, measured: f64, bar: f64) -> &mut Self {
        (self.measured, self.least, self.greatest) = (measured, None, bar);
        self
    }

    /// Sets a number that must be between two bounds.
    pub fn between(&mut self, measured: f64, least: f64, greatest: f64) -> &mut Self {
        (self.measured, self.least, self.greatest) = (measured, Some(least), greatest);
        self
    }

    /// Sets the number of cases that fail their condition, which must be zero.
    pub fn failures(&mut self, cases: impl IntoIterator<Item = bool>) -> &mut Self {
        let failed = cases.into_iter().filter(|holds| !holds).count();
        self.at_most(failed as f64, 0.0)
    }

    /// Sets the reason printed if the bar is missed.
    pub fn because(&mut self, why: &'static str) {
        self.why = why;
    }

    /// Returns `true` if a miss has a known reason.
    pub fn is_explained(&self) -> bool {
        !self.why.is_empty()
    }

    /// Returns the printed line.
    pub fn line(&self, title: &str) -> String {
        let Self { id, what, measured, least, greatest, why } = self;
        let [measured, greatest] = [*measured, *greatest].map(digits);
        let least = least.map_or(String::new(), |least| format!("{} to ", digits(least)));
        let verdict = match (self.holds(), *why) {
            (true, _) => "holds".to_owned(),
            (false, "") => "misses".to_owned(),
            (false, why) => format!("misses: {why}"),
        };
        format!("{id} {title}: {what} … measured {measured}, bar {least}{greatest}, {verdict}")
    }

    /// Returns the row of the table of values.
    pub fn row(&self, title: &str) -> String {
        let Self { id, what, measured, least, greatest, .. } = self;
        let least = least.map_or(String::new(), |least| least.to_string());
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
pub enum Figure {
    /// The energy of long runs.
    Energy,
    /// The phase of long runs.
    Phase,
    /// The distance of chaotic motions.
    Separation,
    /// The error of motions with kinks.
    Kinks,
}

/// The points of a method.
#[derive(Clone, Debug)]
pub struct Curve {
    /// The picture.
    pub figure: Figure,
    /// The name at its end.
    pub name: String,
    /// The points in the order of x.
    pub points: Vec<(f64, f64)>,
}

/// The measurements of a test.
#[derive(Debug, Default)]
pub struct Report {
    id: &'static str,
    /// The measurements, in order.
    pub checks: Vec<Check>,
    /// The curves for pictures.
    pub curves: Vec<Curve>,
}

impl Report {
    /// Creates the report of a test or of a method.
    pub fn new(id: &'static str) -> Self {
        Self { id, ..Self::default() }
    }

    /// Adds a row, which misses its bar until it has a measurement.
    pub fn row(&mut self, what: impl Into<String>) -> &mut Check {
        let (what, measured) = (what.into(), f64::NAN);
        let check = Check { id: self.id, what, measured, least: None, greatest: 0.0, why: "" };
        self.checks.push(check);
        let last = self.checks.len() - 1;
        &mut self.checks[last]
    }

    /// Adds a curve to a picture.
    pub fn curve(&mut self, figure: Figure, name: impl Into<String>, points: Vec<(f64, f64)>) {
        self.curves.push(Curve { figure, name: name.into(), points });
    }
}
