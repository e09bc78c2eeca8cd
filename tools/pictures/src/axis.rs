//! Axes: linear, logarithmic, and descending logarithmic for errors.

/// An axis of a chart.
#[derive(Clone, Debug)]
pub struct Axis {
    pub(crate) name: String,
    pub(crate) scale: Scale,
    range: Option<(f64, f64)>,
    pub(crate) unit: &'static str,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scale {
    Linear,
    Logarithmic,
    /// Logarithmic and descending: small numbers are on the right.
    Digits,
    /// Linear without ticks.
    Bare,
}

impl Axis {
    fn new(name: impl Into<String>, scale: Scale) -> Self {
        Self { name: name.into(), scale, range: None, unit: "" }
    }

    /// Creates a linear axis.
    pub fn linear(name: impl Into<String>) -> Self {
        Self::new(name, Scale::Linear)
    }

    /// Creates a logarithmic axis.
    pub fn logarithmic(name: impl Into<String>) -> Self {
        Self::new(name, Scale::Logarithmic)
    }

    /// Creates a descending logarithmic axis for errors: smaller errors are further to the right.
    pub fn digits(name: impl Into<String>) -> Self {
        Self::new(name, Scale::Digits)
    }

    /// Creates an axis without ticks and name.
    pub fn bare() -> Self {
        Self::new("", Scale::Bare)
    }

    /// Sets the ends of the axis. The default is the range of its curves.
    pub fn range(mut self, from: f64, to: f64) -> Self {
        self.range = Some((from, to));
        self
    }

    /// Sets a sign after the numbers, such as °.
    pub fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    /// Returns the position of a value along the axis, from left to right or upwards.
    pub(crate) fn place(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear | Scale::Bare => value,
            Scale::Logarithmic => value.log10(),
            Scale::Digits => -value.log10(),
        }
    }

    /// Returns the positions of both ends.
    pub(crate) fn ends(&self, values: impl Iterator<Item = f64>) -> (f64, f64) {
        if let Some((from, to)) = self.range {
            return (self.place(from), self.place(to));
        }
        let (low, high) = values
            .map(|value| self.place(value))
            .filter(|place| place.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let (low, high) = if low < high { (low, high) } else { (low.min(0.0), high.max(1.0)) };
        let edge = 0.02 * (high - low);
        match self.scale {
            Scale::Bare => (low - edge, high + edge),
            Scale::Linear => (low - edge, high + edge),
            // A wider margin, which includes a power of ten just outside of the values.
            Scale::Logarithmic | Scale::Digits => (low - 1.5 * edge, high + 1.5 * edge),
        }
    }

    /// Returns the positions and the texts of ticks.
    pub(crate) fn ticks(&self, (low, high): (f64, f64), most: usize) -> Vec<(f64, String)> {
        let (step, digits) = match self.scale {
            Scale::Bare => return Vec::new(),
            Scale::Logarithmic | Scale::Digits if high - low < 2.0 => {
                return self.short_ticks((low, high));
            }
            Scale::Linear => nice_step(high - low, most),
            Scale::Logarithmic | Scale::Digits => {
                let steps = [1.0, 2.0, 3.0, 5.0, 10.0];
                let fits = |step: &f64| (high - low) / step <= most as f64;
                (steps.into_iter().find(fits).unwrap_or(20.0), 0)
            }
        };
        let first = (low / step - 1e-9).ceil() as i64;
        let last = (high / step + 1e-9).floor() as i64;
        let text = |place: f64| match self.scale {
            Scale::Linear | Scale::Bare => format!("{place:.digits$}{}", self.unit),
            Scale::Logarithmic => power(place),
            Scale::Digits => power(-place),
        };
        (first..=last)
            .map(|index| index as f64 * step)
            // Adding zero removes the sign of −0.
            .map(|place| (place, text(place + 0.0)))
            .collect()
    }

    /// Returns ticks at 1, 2 and 5 times each power of ten.
    fn short_ticks(&self, (low, high): (f64, f64)) -> Vec<(f64, String)> {
        let sign = if self.scale == Scale::Digits { -1.0 } else { 1.0 };
        let (first, last) = ((sign * low).min(sign * high), (sign * low).max(sign * high));
        let powers = first.floor() as i32..=last.ceil() as i32;
        let ticks = powers.flat_map(|exponent| [1, 2, 5].map(|factor| (factor, exponent)));
        ticks
            .map(|(factor, exponent)| {
                let place = f64::from(factor).log10() + f64::from(exponent);
                (place, format!("{factor}e{exponent}"))
            })
            .filter(|(place, _)| (first..=last).contains(place))
            .map(|(place, text)| (sign * place, text))
            .collect()
    }
}

/// Formats a power of ten as `1e5`, which uses only characters available in every font.
fn power(exponent: f64) -> String {
    match exponent.round() as i32 {
        0 => "1".to_owned(),
        exponent => format!("1e{exponent}"),
    }
}

/// Returns the finest step of 1, 2 or 5 times a power of ten that results in at most `most` ticks,
/// and its number of decimals.
fn nice_step(length: f64, most: usize) -> (f64, usize) {
    let least = length / most as f64;
    let power = least.log10().floor();
    let (mut factor, mut exponent) = (least / 10f64.powf(power), power as i32);
    factor = [1.0, 2.0, 5.0].into_iter().find(|nice| factor <= nice + 1e-9).unwrap_or(10.0);
    if factor == 10.0 {
        (factor, exponent) = (1.0, exponent + 1);
    }
    (factor * 10f64.powi(exponent), (-exponent).max(0) as usize)
}

#[cfg(test)]
mod tests {
    use super::Axis;

    fn texts(axis: &Axis, ends: (f64, f64), most: usize) -> Vec<String> {
        axis.ticks(ends, most).into_iter().map(|tick| tick.1).collect()
    }

    #[test]
    fn ticks_of_linear_axes_are_round() {
        let axis = Axis::linear("");
        assert_eq!(
            texts(&axis, (-0.3, 1.1), 8),
            ["-0.2", "0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(texts(&axis, (0.0, 60.0), 6), ["0", "10", "20", "30", "40", "50", "60"]);
        assert_eq!(
            texts(&axis.clone().unit("°"), (-50.0, 50.0), 5),
            ["-40°", "-20°", "0°", "20°", "40°"]
        );
    }

    #[test]
    fn short_logarithmic_axes_have_ticks_between_the_powers() {
        let ends = (-2.5, -0.9);
        assert_eq!(
            texts(&Axis::logarithmic(""), ends, 8),
            ["5e-3", "1e-2", "2e-2", "5e-2", "1e-1"]
        );
    }

    #[test]
    fn errors_shrink_to_the_right() {
        let axis = Axis::digits("");
        let ends = axis.ends([1e-12, 1e-2].into_iter());
        assert_eq!(texts(&axis, ends, 6), ["1e-2", "1e-4", "1e-6", "1e-8", "1e-10", "1e-12"]);
    }
}
