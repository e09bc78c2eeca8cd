//! A single operation of a program: arithmetic, functions, numbers and the values of symbols.

use super::local;
use crate::algebra::expr::{Moment, Symbol};
use crate::algebra::functions::Function;
use crate::algebra::number;
use crate::algebra::number::Rational;
use crate::backend::Analysis;
use crate::model::Element;
use crate::schedule::{Op, Place};
use proc_macro2::{Ident, Literal, Punct, Spacing, TokenStream};
use quote::{format_ident, quote};

impl Analysis<'_, '_> {
    pub(crate) fn operation(&self, op: &Op, at: impl Fn(Place) -> TokenStream) -> TokenStream {
        let scalar = self.scalar();
        let binary = |method: &str, a: Place, b: Place| {
            let (a, b, method) = (at(a), at(b), format_ident!("{method}"));
            quote!(#a.#method(#b))
        };
        let infix = |a: Place, sign: char, b: Place| {
            let (a, b, sign) = (at(a), at(b), Punct::new(sign, Spacing::Alone));
            quote!((#a #sign #b))
        };
        match *op {
            Op::Number(value) => number(value, &scalar),
            Op::Literal(ref literal) => decimal(literal, &scalar),
            Op::Pi => quote!(#scalar::pi()),
            Op::Load(symbol) => self.load(symbol),
            Op::Negative(a) => {
                let a = at(a);
                quote!((-#a))
            }
            Op::Add(a, b) => infix(a, '+', b),
            Op::Sub(a, b) => infix(a, '-', b),
            Op::Mul(a, b) => infix(a, '*', b),
            Op::Div(a, b) => infix(a, '/', b),
            Op::Sqrt(a) => {
                let a = at(a);
                quote!(#a.sqrt())
            }
            Op::Powf(a, b) => binary("powf", a, b),
            Op::Atan2(a, b) => binary("atan2", a, b),
            Op::Max(a, b) => binary("max", a, b),
            Op::Call(function, a) => self.function_call(function, &at(a)),
            Op::SinCos(_) => TokenStream::new(),
            Op::Part(function, pair) => {
                let name = local(if function == Function::Sin { "s" } else { "c" }, pair.0);
                quote!(#name)
            }
        }
    }

    /// Returns the call of a function on a value.
    pub(super) fn function_call(&self, function: Function, value: &TokenStream) -> TokenStream {
        let krate = &self.krate;
        match function {
            Function::Table(index, order) => {
                let (rows, order) =
                    (self.part_of_table(index, "rows"), Literal::u8_unsuffixed(order));
                quote!(#krate::__private::table(#rows, #order, #value))
            }
            Function::Knots(index, digit) => {
                let (knots, digit) =
                    (self.part_of_table(index, "knots"), Literal::u8_unsuffixed(digit));
                quote!(#krate::__private::knots(#knots, #digit, #value))
            }
            _ => {
                let method = format_ident!("{}", function.row().name);
                let order = function.order().map(Literal::u8_unsuffixed);
                quote!(#value.#method(#order))
            }
        }
    }

    fn load(&self, symbol: Symbol) -> TokenStream {
        match symbol {
            Symbol::Parameter(scalar) => {
                let quantity =
                    self.model.parameters.iter().rfind(|quantity| quantity.first <= scalar);
                let Some(quantity) = quantity else { return TokenStream::new() };
                let (name, offset) = (quantity.name, scalar - quantity.first);
                match quantity.length() {
                    _ if quantity.is_body() => {
                        let lengths = if quantity.element == Element::Solid { 3 } else { 2 };
                        match offset.checked_sub(1) {
                            None => quote!(self.#name.mass),
                            Some(part) if part < lengths => quote!(self.#name.center[#part]),
                            Some(part) => {
                                let part = part - lengths;
                                quote!(self.#name.central[#part])
                            }
                        }
                    }
                    Some(_) => quote!(self.#name[#offset]),
                    None => quote!(self.#name),
                }
            }
            Symbol::Moment(first, moment) => {
                let body = self.model.parameters.iter().rfind(|quantity| quantity.first <= first);
                let Some(name) = body.map(|body| body.name) else { return TokenStream::new() };
                match moment {
                    Moment::Inertia => quote!(self.#name.inertia()),
                    Moment::Difference => {
                        quote!((self.#name.moments()[0] - self.#name.moments()[2]))
                    }
                    Moment::Product => quote!(self.#name.moments()[1]),
                    Moment::About(axis) => {
                        let axis = usize::from(axis);
                        quote!(self.#name.inertia()[(#axis, #axis)])
                    }
                    Moment::Mixed(pair) => {
                        let place = 3 + usize::from(pair);
                        quote!(self.#name.moments()[#place])
                    }
                }
            }
            // Points of integration are eliminated with the integral, and velocities of positions
            // and entries of rotations when the equations are solved.
            Symbol::Point(..) | Symbol::Auxiliary(_) | Symbol::Position(_) | Symbol::Entry(..) => {
                quote!(::core::unreachable!())
            }
            // Equations contain the expressions of accelerations and multipliers. Here, their
            // values are arguments, as are those of what the equations do not contain.
            Symbol::Acceleration(index) => quote!(accelerations[#index]),
            Symbol::Multiplier(index) => quote!(multipliers[#index]),
            Symbol::Contact(index) => quote!(__contacts[#index]),
            Symbol::Friction(index) => quote!(__frictions[#index]),
            Symbol::Time => quote!(t),
            Symbol::Coordinate(index) => quote!(q[#index]),
            Symbol::Velocity(index) => quote!(v[#index]),
            Symbol::Momentum(index) => quote!(p[#index]),
            Symbol::Target(index) => quote!(target[#index]),
            Symbol::Control { input, component } => {
                self.load(Symbol::Input { input, component, order: 0 })
            }
            Symbol::Input { input, component, order } => {
                let input = Literal::usize_unsuffixed(input);
                let order = format_ident!(
                    "{}",
                    ["position", "velocity", "acceleration"][usize::from(order)]
                );
                quote!(inputs.#input.#order[#component])
            }
        }
    }
}

fn number(value: Rational, scalar: &Ident) -> TokenStream {
    let sign = value.is_negative().then(|| quote!(-));
    if !value.fits_double() {
        // The nearest double, and its error for scalars of higher precision.
        let (high, low) = value.abs().words();
        let (high, rest) = (Literal::f64_unsuffixed(high), Literal::f64_unsuffixed(low.abs()));
        let rest_sign = (value.is_negative() != (low < 0.0)).then(|| quote!(-));
        return quote!((#scalar::from_f64(#sign #high) + #scalar::from_f64(#rest_sign #rest)));
    }
    let (top, bottom) = (value.numerator() as f64, value.denominator() as f64);
    let (top, bottom) = (Literal::f64_unsuffixed(top.abs()), Literal::f64_unsuffixed(bottom));
    if value.is_integer() {
        quote!(#scalar::from_f64(#sign #top))
    } else {
        quote!(#scalar::ratio(#sign #top, #bottom))
    }
}

fn decimal(literal: &number::Literal, scalar: &Ident) -> TokenStream {
    match literal {
        number::Literal::Exact(value) => number(*value, scalar),
        number::Literal::Decimal(digits) => {
            let value = Literal::f64_unsuffixed(digits.parse().unwrap_or(f64::NAN));
            quote!(#scalar::from_f64(#value))
        }
    }
}
