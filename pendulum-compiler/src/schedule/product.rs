//! Products and powers: constants are grouped, and there is a single division.

use super::program::mul;
use super::term::{Factor, Term, multiply, unit};
use super::{Op, Place, Schedule};
use crate::algebra::expr::{Dependencies, Id};
use crate::algebra::number::Rational;

/// The greatest exponent whose power is computed by itself.
const STEEP: i64 = 64;

impl Schedule<'_> {
    /// Computes a product without its sign. Returns its place and whether the sign is negative.
    ///
    /// Factors that depend only on parameters are grouped, so that their product is computed once,
    /// during preparation.
    pub(super) fn product(&mut self, term: &Term) -> (Place, bool) {
        if let Some((quotient, exponent, rest)) = steep(term) {
            let (quotient, flipped) = self.product(&quotient);
            let power = self.whole_power(quotient, exponent);
            let (place, negative) =
                if rest == unit() { (power, false) } else { self.times(power, &rest) };
            return (place, negative ^ (flipped && exponent % 2 == 1));
        }
        if let Some(terms) = self.spread(term) {
            return self.sum(terms);
        }
        let (parameter_only, mut moving) = self.split(term);
        let mut negative = term.coefficient.is_negative();
        let mut parameter_only =
            Some(parameter_only).filter(|parameter_only| *parameter_only != unit());
        if let Some(constant) = &parameter_only
            && constant.coefficient.within(60).is_some()
            && let Some(index) = moving.iter().position(|&(factor, exponent)| {
                exponent == Rational::ONE && self.takes_in(factor.id, 1)
            })
            && moving[index].0.scale.is_none()
        {
            let scale = self.scale(constant.clone());
            moving[index].0.scale = Some(scale);
            parameter_only = None;
        }
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for (factor, exponent) in moving {
            let side = if exponent.is_negative() { &mut below } else { &mut above };
            let vanishing = self.vanishes(term, (factor, exponent));
            side.push((self.rank(factor.id), factor, exponent.abs(), vanishing));
        }
        let top = self.side(above, &mut negative);
        let bottom = self.side(below, &mut negative);
        let constant = parameter_only.map(|parameter_only| self.constant(&parameter_only));
        let top = match (constant, top) {
            (Some(constant), Some(top)) => Some(self.program.push(mul(constant, top))),
            (constant, top) => constant.or(top),
        };
        let place = match (top, bottom) {
            (Some(top), Some(bottom)) => self.program.push(Op::Div(top, bottom)),
            (Some(top), None) => top,
            (None, bottom) => {
                let one = self.program.push(Op::Number(Rational::ONE));
                match bottom {
                    Some(bottom) => self.program.push(Op::Div(one, bottom)),
                    None => one,
                }
            }
        };
        (place, negative)
    }

    /// Computes the product of a value and a product.
    fn times(&mut self, value: Place, rest: &Term) -> (Place, bool) {
        let (place, negative) = self.product(rest);
        (self.program.push(mul(value, place)), negative)
    }

    /// Returns the magnitude of the factors that depend only on parameters, and the other factors.
    pub(super) fn split(&self, term: &Term) -> (Term, Vec<(Factor, Rational)>) {
        let (factors, moving) = term
            .factors
            .iter()
            .partition(|(factor, _)| factor.scale.is_none() && self.parameter_only(factor.id));
        (Term { coefficient: term.coefficient.abs(), factors }, moving)
    }

    /// Computes a product of parameters and numbers.
    fn constant(&mut self, term: &Term) -> Place {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for &(factor, exponent) in &term.factors {
            let side = if exponent.is_negative() { &mut below } else { &mut above };
            side.push((0, factor, exponent.abs(), false));
        }
        let mut sign = false;
        let top = self.side(above, &mut sign);
        let bottom = self.side(below, &mut sign);
        let top = match top {
            Some(top) if term.coefficient == Rational::ONE => top,
            Some(top) => {
                let number = self.program.push(Op::Number(term.coefficient));
                self.program.push(mul(number, top))
            }
            None => self.program.push(Op::Number(term.coefficient)),
        };
        match bottom {
            Some(bottom) => self.program.push(Op::Div(top, bottom)),
            None => top,
        }
    }

    /// Computes the product of some positive powers, each with its rank and whether it is kept from
    /// zero.
    fn side(
        &mut self,
        mut factors: Vec<(u8, Factor, Rational, bool)>,
        negative: &mut bool,
    ) -> Option<Place> {
        factors.sort_unstable();
        let mut product: Option<Place> = None;
        for (_, factor, exponent, vanishing) in factors {
            let power = match factor.scale {
                None if vanishing => {
                    let power = self.power(factor.id, exponent);
                    self.off_zero(power)
                }
                None => self.power(factor.id, exponent),
                Some(scale) => {
                    let (place, flipped) = self.scaled_sum(factor.id, scale);
                    *negative ^= flipped;
                    place
                }
            };
            product = Some(match product {
                Some(product) => self.program.push(mul(product, power)),
                None => power,
            });
        }
        product
    }

    /// Returns the rank of a factor in a product. The factor that changes least often comes first.
    fn rank(&self, base: Id) -> u8 {
        let dependencies = self.graph.dependencies(base);
        if dependencies
            .any(Dependencies::VELOCITY.or(Dependencies::MOMENTUM).or(Dependencies::TARGET))
        {
            3
        } else if dependencies.any(Dependencies::COORDINATE) {
            2
        } else {
            u8::from(dependencies.any(Dependencies::TIME.or(Dependencies::INPUT)))
        }
    }

    /// Computes a positive power: by repeated squaring if the exponent is whole, by a square root
    /// for a half, otherwise by `powf`.
    ///
    /// Large whole exponents are no exception. `powf` is more accurate, but it is NaN at negative
    /// numbers and its series at zero, and squaring is as accurate as the base: its error is that
    /// of the power if the base is off by one rounding.
    fn power(&mut self, base: Id, exponent: Rational) -> Place {
        let value = self.value(base);
        let whole = exponent.numerator() / exponent.denominator();
        let fraction = exponent.add(Rational::whole(i64::try_from(whole).unwrap_or(0)).negative());
        match (i64::try_from(whole), fraction) {
            (Ok(whole), Some(fraction)) if fraction.is_zero() => self.whole_power(value, whole),
            (Ok(whole), Some(fraction)) if whole <= STEEP && fraction == Rational::HALF => {
                let root = self.program.push(Op::Sqrt(value));
                if whole == 0 {
                    return root;
                }
                let power = self.whole_power(value, whole);
                self.program.push(mul(power, root))
            }
            _ => {
                let exponent = self.program.push(Op::Number(exponent));
                self.program.push(Op::Powf(value, exponent))
            }
        }
    }

    fn whole_power(&mut self, value: Place, exponent: i64) -> Place {
        match exponent {
            0 => self.program.push(Op::Number(Rational::ONE)),
            1 => value,
            _ => {
                let half = self.whole_power(value, exponent / 2);
                let square = self.program.push(Op::Mul(half, half));
                if exponent % 2 == 0 { square } else { self.program.push(mul(square, value)) }
            }
        }
    }
}

/// Splits a product with at least two large whole powers into a product of their bases, a common
/// exponent, and the rest.
///
/// In ((t - c)/w)^100 with w = 1e-4, w^100 is zero in `f64`, and the quotient of the powers is not a
/// number where the power of the quotient is zero.
fn steep(term: &Term) -> Option<(Term, i64, Term)> {
    let large = |(factor, exponent): &(Factor, Rational)| {
        let exponent = exponent.integer().filter(|exponent| STEEP < exponent.abs())?;
        factor.scale.is_none().then_some((*factor, exponent))
    };
    let powers: Vec<(Factor, i64)> = term.factors.iter().filter_map(large).collect();
    let common = powers.iter().map(|(_, exponent)| exponent.abs()).min()?;
    if powers.len() < 2 {
        return None;
    }
    let (mut quotient, mut rest) = (unit(), term.clone());
    for (factor, exponent) in powers {
        multiply(&mut quotient.factors, factor, Rational::whole(exponent.signum()));
        multiply(&mut rest.factors, factor, Rational::whole(-common * exponent.signum()));
    }
    Some((quotient, common, rest))
}
