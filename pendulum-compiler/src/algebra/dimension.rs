//! Dimensions: products of powers of kilograms, metres, seconds, amperes and kelvins.

use super::number::{Rational, superscript};
use std::fmt;

/// The exponents of kilogram, metre, second, ampere and kelvin. The radian is a pure number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Dimension(pub(crate) [Rational; 5]);

impl Dimension {
    pub(crate) const PURE: Self = Self([Rational::ZERO; 5]);

    pub(crate) fn of(name: &str) -> Option<Self> {
        UNITS.iter().find(|row| row.0 == name).map(|row| Self::whole(row.1))
    }

    /// Creates the dimension with these exponents.
    pub(crate) fn whole(exponents: [i64; 5]) -> Self {
        Self(exponents.map(Rational::whole))
    }

    /// Returns `self` · `other`^`power`.
    pub(crate) fn times(self, other: Self, power: Rational) -> Option<Self> {
        let mut result = self;
        for (own, other) in result.0.iter_mut().zip(other.0) {
            *own = own.add(other.mul(power)?)?;
        }
        Some(result)
    }
}

/// The units of the language: names, exponents, and descriptions for editors.
#[rustfmt::skip]
pub(crate) const UNITS: &[(&str, [i64; 5], &str)] = &[
    ("rad", [ 0,  0,  0,  0, 0], "The radian, a pure number."),
    ("kg",  [ 1,  0,  0,  0, 0], "The kilogram, of masses."),
    ("m",   [ 0,  1,  0,  0, 0], "The metre, of lengths."),
    ("s",   [ 0,  0,  1,  0, 0], "The second, of times."),
    ("A",   [ 0,  0,  0,  1, 0], "The ampere, of currents."),
    ("K",   [ 0,  0,  0,  0, 1], "The kelvin, of temperatures."),
    ("Hz",  [ 0,  0, -1,  0, 0], "The hertz, of frequencies."),
    ("N",   [ 1,  1, -2,  0, 0], "The newton, of forces."),
    ("J",   [ 1,  2, -2,  0, 0], "The joule, of energies."),
    ("W",   [ 1,  2, -3,  0, 0], "The watt, of powers."),
    ("C",   [ 0,  0,  1,  1, 0], "The coulomb, of charges."),
    ("V",   [ 1,  2, -3, -1, 0], "The volt, of potentials."),
    ("F",   [-1, -2,  4,  2, 0], "The farad, of capacitances."),
    ("H",   [ 1,  2, -2, -2, 0], "The henry, of inductances."),
    ("ohm", [ 1,  2, -3, -2, 0], "The ohm, of resistances."),
    ("T",   [ 1,  0, -2, -1, 0], "The tesla, of magnetic fields."),
];

impl fmt::Display for Dimension {
    /// Writes the dimension as a product and quotient of units, such as kg·m/s².
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = |sign: bool| {
            let powers = ["kg", "m", "s", "A", "K"]
                .into_iter()
                .zip(self.0)
                .filter(move |(_, power)| !power.is_zero() && power.is_negative() == sign);
            powers.map(|(name, power)| match power.abs() {
                Rational::ONE => name.to_owned(),
                power => match power.integer() {
                    Some(power) => format!("{name}{}", superscript(power)),
                    None => format!("{name}^({power})"),
                },
            })
        };
        let above: Vec<String> = named(false).collect();
        let below: Vec<String> = named(true).collect();
        let top = match (above.is_empty(), below.is_empty()) {
            (true, true) => return write!(f, "a pure number"),
            (true, false) => "1".to_owned(),
            _ => above.join("·"),
        };
        match below.as_slice() {
            [] => write!(f, "{top}"),
            [one] => write!(f, "{top}/{one}"),
            several => write!(f, "{top}/({})", several.join("·")),
        }
    }
}
