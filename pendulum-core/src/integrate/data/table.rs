//! A table of columns with names and units.

use super::column::ColumnError;
use crate::integrate::solution::Solution;
use crate::scalar::Float;
use crate::system::label::Labels;
use crate::system::name;
use crate::system::{Dynamics, System};
use core::fmt;

/// Columns of equal length with their names and units: the states of a [`Solution`], and any
/// further columns.
///
/// `{}` prints the first and the last five rows of nine columns with six digits, `{:#}` all rows
/// and columns. A precision sets the number of digits (`{:.12}`).
///
/// ```
/// use pendulum_runtime::prelude::*;
///
/// # mod system {
/// pendulum_runtime::lagrangian! {
///     pub struct Spring { k: N/m, m: kg }
///     coordinate x: m;
///     kinetic = m*ẋ^2/2;
///     potential = k*x^2/2;
/// }
/// # }
/// # use system::Spring;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let spring = Spring::new(4.0, 1.0);
/// let solution = solve(&spring, (0.0, 1.0), [1.0], [0.0]).every(0.25).run()?;
/// let table = solution.table().with("energy", "J", solution.energy(&spring))?;
/// assert_eq!(table.header().collect::<Vec<_>>(), ["t [s]", "x [m]", "ẋ [m/s]", "energy [J]"]);
/// assert!(table.column("energy")?.iter().all(|energy| (energy - 2.0).abs() < 1e-5));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Table<T> {
    /// The times, which a short scalar cannot represent.
    t: Vec<f64>,
    columns: Vec<Column<T>>,
}

#[derive(Clone, Debug, PartialEq)]
struct Column<T> {
    name: String,
    unit: String,
    values: Vec<T>,
}

/// The error for a column with a length other than the number of rows of its table.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LengthError {
    /// The name of the column.
    pub name: String,
    /// The length of the column.
    pub length: usize,
    /// The number of rows of the table.
    pub rows: usize,
}

impl fmt::Display for LengthError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, length, rows } = self;
        write!(
            f,
            "the column `{name}` has {length} numbers, the table {rows} rows; give one number a row"
        )
    }
}

impl core::error::Error for LengthError {}

impl<T: Float, const N: usize> Solution<T, N> {
    /// Returns a table of time, coordinates and velocities at all output times.
    pub fn table(&self) -> Table<T> {
        let time = Column {
            name: "t".into(),
            unit: "s".into(),
            values: self.t.iter().map(|&t| T::from_f64(t)).collect(),
        };
        let mut columns = vec![time];
        let Labels { coordinates, velocities } = self.labels.labels(N);
        for (labels, rows) in [(coordinates, &self.q), (velocities, &self.v)] {
            columns.extend(labels.into_iter().enumerate().map(|(index, label)| Column {
                name: label.name,
                unit: label.unit,
                values: rows.iter().map(|row| row[index]).collect(),
            }));
        }
        Table { t: self.t.clone(), columns }
    }
}

impl<T: Float, const N: usize> Solution<T, N> {
    /// Returns a table of time, coordinates, velocities and the outputs of the system at all output
    /// times.
    ///
    /// At a kink the outputs are those after the kink, as in [`energy`](Self::energy).
    ///
    /// # Errors
    /// Returns an error if a [sampled](crate::system::Sampled) controller has run again since.
    pub fn table_with_outputs<D: Dynamics<N, Scalar = T>>(
        &self,
        dynamics: &D,
    ) -> Result<Table<T>, ColumnError> {
        self.fresh(dynamics, "outputs")?;
        let mut table = self.table();
        for (index, output) in <D::System as System<N>>::FACTS.outputs.iter().enumerate() {
            let named = output.names().into_iter().zip(self.scalars(dynamics, index));
            table.columns.extend(named.map(|(name, values)| Column {
                name,
                unit: output.unit.into(),
                values,
            }));
        }
        Ok(table)
    }

    /// Returns a table of time, coordinates, velocities and the multipliers of the constraints at
    /// all output times: `λ_rod`, `λ_loop.x`, with their units.
    ///
    /// At a kink the multipliers are those after the kink, as in [`energy`](Self::energy).
    ///
    /// # Errors
    /// Returns an error if a [sampled](crate::system::Sampled) controller has run again since.
    pub fn table_with_reactions<D: Dynamics<N, Scalar = T>>(
        &self,
        dynamics: &D,
    ) -> Result<Table<T>, ColumnError> {
        let mut table = self.table();
        let constraints = <D::System as System<N>>::FACTS.constraints;
        let named = constraints.iter().zip(self.reactions(dynamics)?);
        table.columns.extend(named.map(|(constraint, values)| Column {
            name: format!("λ_{}", constraint.name),
            unit: constraint.reaction_unit.into(),
            values,
        }));
        Ok(table)
    }
}

impl<T: Float> Table<T> {
    /// Adds a column to the table; the unit may be empty.
    ///
    /// # Errors
    /// Returns an error if the column does not have one number for each row.
    pub fn with(
        mut self,
        name: impl Into<String>,
        unit: impl Into<String>,
        values: Vec<T>,
    ) -> Result<Self, LengthError> {
        let (name, rows) = (name.into(), self.rows());
        if values.len() != rows {
            return Err(LengthError { name, length: values.len(), rows });
        }
        self.columns.push(Column { name, unit: unit.into(), values });
        Ok(self)
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.t.len()
    }

    /// Returns the names of all columns, each with its unit in brackets if it has one: `θ [rad]`.
    pub fn header(&self) -> impl Iterator<Item = String> {
        self.columns.iter().map(|Column { name, unit, .. }| {
            if unit.is_empty() { name.clone() } else { format!("{name} [{unit}]") }
        })
    }

    /// Returns the numbers of the column with this name, as parsed by [`Solution::column`].
    ///
    /// # Errors
    /// Returns an error for a name that no column has; the error contains the nearest name.
    pub fn column(&self, name: &str) -> Result<&[T], ColumnError> {
        let wanted = name::read(name);
        let found = self.columns.iter().find(|column| name::read(&column.name) == wanted);
        found.map(|column| column.values.as_slice()).ok_or_else(|| {
            ColumnError::new(name, self.columns.iter().map(|column| column.name.as_str()), "")
        })
    }

    /// Returns the numbers of a row.
    ///
    /// # Panics
    /// Panics if the table has no such row.
    pub fn row(&self, index: usize) -> impl Iterator<Item = T> {
        self.columns.iter().map(move |column| column.values[index])
    }
}

#[cfg(feature = "csv")]
impl<T: Float + fmt::Display + fmt::LowerExp> Table<T> {
    /// Writes the table as comma-separated values in UTF-8: the [header](Self::header) and one line
    /// per row, with as many digits as are necessary to distinguish the numbers.
    ///
    /// # Errors
    /// Returns the errors of the writer.
    pub fn to_csv(&self, writer: impl std::io::Write) -> std::io::Result<()> {
        fn text<U: Float + fmt::Display + fmt::LowerExp>(value: U) -> String {
            let magnitude = value.to_f64().abs();
            let short = magnitude == 0.0 || (1e-5..1e16).contains(&magnitude);
            if short || !value.is_finite() { format!("{value}") } else { format!("{value:e}") }
        }
        let mut csv = csv::Writer::from_writer(writer);
        csv.write_record(self.header())?;
        for row in 0..self.rows() {
            csv.write_field(text(self.t[row]))?;
            for column in &self.columns[1..] {
                csv.write_field(text(column.values[row]))?;
            }
            csv.write_record(None::<&[u8]>)?;
        }
        csv.flush()
    }
}

#[cfg(feature = "csv")]
impl<T: Float + fmt::Display + fmt::LowerExp, const N: usize> Solution<T, N> {
    /// Writes time, coordinates and velocities as comma-separated values with a header of names and
    /// units, like [`Table::to_csv`]. Use [`table`](Self::table) and [`Table::with`] for further
    /// columns.
    ///
    /// # Errors
    /// Returns the errors of the writer.
    pub fn to_csv(&self, writer: impl std::io::Write) -> std::io::Result<()> {
        self.table().to_csv(writer)
    }
}

/// The number of rows that are printed at each end without `#`.
const ENDS: usize = 5;

/// The number of columns that are printed without `#`.
const COLUMNS: usize = 9;

impl<T: Float> fmt::Display for Table<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = f.precision().unwrap_or(6).max(1);
        let most = if f.alternate() { self.columns.len() } else { COLUMNS };
        let shown: Vec<usize> = if f.alternate() || self.rows() <= 2 * ENDS {
            (0..self.rows()).collect()
        } else {
            (0..ENDS).chain(self.rows() - ENDS..self.rows()).collect()
        };
        let mut lines = vec![self.header().take(most).collect::<Vec<_>>()];
        let text = |value: T| number(value.to_f64(), digits);
        lines.extend(shown.iter().map(|&row| {
            let values = self.row(row).take(most).skip(1).map(text);
            core::iter::once(number(self.t[row], digits)).chain(values).collect()
        }));
        let width = |column: usize| {
            lines.iter().map(|line| columns(&line[column])).max().unwrap_or_default()
        };
        let widths: Vec<usize> = (0..lines[0].len()).map(width).collect();
        let more = if most < self.columns.len() { " …" } else { "" };
        for (index, line) in lines.iter().enumerate() {
            if index == ENDS + 1 && shown.len() < self.rows() {
                let left = self.rows() - shown.len();
                writeln!(f, "… {left} row{} more …", if left == 1 { "" } else { "s" })?;
            }
            for (column, (cell, width)) in line.iter().zip(&widths).enumerate() {
                let gap = if column == 0 { 0 } else { 2 };
                write!(f, "{:1$}{cell}", "", gap + width - columns(cell))?;
            }
            writeln!(f, "{more}")?;
        }
        Ok(())
    }
}

/// Returns the width of a text in columns of a terminal; marks above letters have no width.
fn columns(text: &str) -> usize {
    text.chars().filter(|letter| !('\u{300}'..'\u{370}').contains(letter)).count()
}

/// Formats a number with this many significant digits, and with an exponent if it is very large or
/// very small.
fn number(value: f64, digits: usize) -> String {
    let magnitude = value.abs();
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let scientific = format!("{value:.*e}", digits - 1);
    let exponent: i32 = scientific
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse().ok())
        .unwrap_or_default();
    if (1e-4..1e15).contains(&magnitude) && exponent < digits as i32 {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        return format!("{value:.decimals$}");
    }
    scientific
}

/// Prints the table of the states, the reason why the integration ended, and the counters.
impl<T: Float, const N: usize> fmt::Display for Solution<T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.table(), f)?;
        writeln!(f, "{:?} at t = {}", self.status, self.end.t)?;
        self.stats.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [0.1, -123.456789, 1e-7, 123456.7, 1234567.0, 0.0, -0.00012345678]
                .map(|value| number(value, 6)),
            ["0.100000", "-123.457", "1.00000e-7", "123457", "1.23457e6", "0", "-0.000123457"]
                .map(String::from)
        );
        // Rounding changes the number of digits before the point.
        assert_eq!(number(999999.7, 6), "1.00000e6");
        assert_eq!(number(9.9999996, 6), "10.0000");
        assert_eq!(number(f64::NAN, 6), "NaN");
    }
}
