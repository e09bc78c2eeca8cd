//! The recurrences of functions and powers.

use super::writer::Writer;
use crate::algebra::functions::{Derivative, Divisor, Function, Series, Sign};
use crate::backend::rust::local;
use crate::schedule::Place;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

/// The number of coefficients of a series of the runtime.
const LENGTH: usize = 32;

impl Writer<'_, '_, '_> {
    /// Writes a function of one argument.
    pub(super) fn call(&mut self, place: Place, function: Function, a: Place) {
        let scalar = self.analysis.scalar();
        let one = quote!(series::constant(#scalar::from_f64(1.0), order));
        match function.row().derivative {
            Derivative::Call(.., Series::Circular) => {
                self.sin_cos(place, a);
                let name = local(if function == Function::Sin { "s" } else { "c" }, place.0);
                self.values[place.0] = quote!(#name);
            }
            Derivative::Call(.., Series::Hyperbolic(part)) => {
                let (pair, x) = (self.pair(), self.value(a));
                let (x, both) = (self.shared("a", place, &x), local("b", place.0));
                let rate = self.rate(&x);
                self.lines.extend(quote! {
                    let #both = series::sinh_cosh(#x, &#rate, &#pair, &path.reciprocals, order);
                    #pair[k] = #both;
                });
                self.values[place.0] = quote!(#both[#part]);
            }
            Derivative::Itself => {
                let x = self.value(a);
                self.exponential(place, &x);
            }
            Derivative::OneAndSquare(sign) => {
                let sign = if sign == Sign::Plus { quote!(+) } else { quote!(-) };
                let slope = |slot: &TokenStream| quote!(#one #sign series::square(&#slot, order));
                self.halves += 3;
                self.integrated(place, function, a, slope);
            }
            Derivative::Times(sign, factor) => {
                self.call(place, factor, a);
                let factor = self.whole(place);
                let sign = (sign == Sign::Minus).then(|| quote!(-));
                let slope =
                    |slot: &TokenStream| quote!(#sign series::product(&#slot, &#factor, order));
                self.halves += 4;
                self.integrated(place, function, a, slope);
            }
            Derivative::Reciprocal(divisor, sign) => {
                let (x, series) = (self.value(a), self.whole(a));
                let x = self.shared("a", place, &x);
                let divisor = match divisor {
                    Divisor::Argument => series,
                    Divisor::OnePlusSquare => {
                        self.halves += 1;
                        self.kept(&quote!(#one + series::square(&#series, order)))
                    }
                    Divisor::RootOfOneMinusSquare => {
                        let (root, lead) = (self.slot(), self.lead());
                        self.halves += 2;
                        let below = self.shared(
                            "b",
                            place,
                            &quote!(#one - series::square(&#series, order)),
                        );
                        self.lines
                            .extend(quote!(#root[k] = series::sqrt(#below, &#root, #lead, order);));
                        root
                    }
                };
                let (start, rate) =
                    (self.analysis.function_call(function, &x), quote!(series::rate(#x, order)));
                self.inverse(place, &start, &rate, &divisor, sign == Sign::Minus);
            }
            Derivative::Call(_, slope, Series::Linear) => {
                let (x, lead) = (self.value(a), self.lead());
                let x = self.shared("a", place, &x);
                let slope = self.analysis.function_call(slope, &x);
                self.name(place, &quote!(series::leading(|| #slope, #lead, order) * #x));
            }
            Derivative::Call(.., Series::Family) => {
                let (x, series) = (self.value(a), self.whole(a));
                let start = self.shared("a", place, &quote!(#series[0]));
                let rate = self.slots;
                self.rate(&x);
                let first = self.slots;
                self.slots += LENGTH;
                self.halves += 16;
                let order = Literal::u8_unsuffixed(function.order().unwrap_or(0));
                let member = if let Function::Table(index, _) = function {
                    let (krate, rows) =
                        (&self.analysis.krate, self.analysis.part_of_table(index, "rows"));
                    quote!(#krate::__private::table(#rows, #order + n, #start))
                } else {
                    let method = format_ident!("{}", function.row().name);
                    quote!(#start.#method(#order + n))
                };
                self.name(
                    place,
                    &quote!({
                        let (known, own) = work.series.split_at_mut(#first);
                        series::family(|n| #member, &known[#rate], own, &path.reciprocals, order)
                    }),
                );
                self.series.insert(place, quote!(work.series[#first]));
            }
            Derivative::Zero => {
                let x = self.value(a);
                let value = self.analysis.function_call(function, &x);
                // Only the value at order 0 is used. At other orders, the value is meaningless.
                self.name(place, &quote!(series::constant(#value, order)));
            }
        }
    }

    /// Writes a function of which `slope` is the derivative, given its series.
    fn integrated(
        &mut self,
        place: Place,
        function: Function,
        a: Place,
        slope: impl FnOnce(&TokenStream) -> TokenStream,
    ) {
        let (x, slot, slopes) = (self.value(a), self.slot(), self.slot());
        let x = self.shared("a", place, &x);
        let rate = self.rate(&x);
        let start = self.analysis.function_call(function, &x);
        let value = quote!(series::integral(|| #start, &#rate, &#slopes, &path.reciprocals, order));
        self.name_in(place, &value, slot.clone());
        let slope = slope(&slot);
        self.lines.extend(quote!(#slopes[k] = #slope;));
    }

    /// Writes exp x.
    fn exponential(&mut self, place: Place, x: &TokenStream) {
        let (x, slot) = (self.shared("e", place, x), self.slot());
        let rate = self.rate(&x);
        self.halves += 2;
        let value = quote!(series::integral(|| #x.exp(), &#rate, &#slot, &path.reciprocals, order));
        self.name_in(place, &value, slot);
    }

    /// Writes a function with the value `start` and the derivative `rate` divided by `divisor`.
    fn inverse(
        &mut self,
        place: Place,
        start: &TokenStream,
        rate: &TokenStream,
        divisor: &TokenStream,
        negative: bool,
    ) {
        let (slot, lead, sign) = (self.slot(), self.lead(), negative.then(|| quote!(-)));
        self.halves += 2;
        let slope = self.shared(
            "r",
            place,
            &quote!(series::slope(#sign #rate, &#divisor, &#slot, #lead, order)),
        );
        self.lines.extend(quote!(#slot[k] = #slope;));
        self.name(place, &quote!(series::from_rate(|| #start, #slope, &path.reciprocals, order)));
    }

    /// Writes the angle of the point (x, y), whose rate is (x ẏ − y ẋ)/(x² + y²).
    pub(super) fn angle(&mut self, place: Place, y: Place, x: Place) {
        let (y_value, x_value) = (self.value(y), self.value(x));
        let (y_value, x_value) =
            (self.shared("a", place, &y_value), self.shared("b", place, &x_value));
        let (y, x) = (self.whole(y), self.whole(x));
        let (y_rate, x_rate) = (self.rate(&y_value), self.rate(&x_value));
        self.halves += 6;
        let divisor = self.kept(&quote!(series::square(&#x, order) + series::square(&#y, order)));
        let rate =
            quote!((series::behind(&#y_rate, &#x, order) - series::behind(&#x_rate, &#y, order)));
        self.inverse(place, &quote!(#y_value.atan2(#x_value)), &rate, &divisor, false);
    }

    /// Writes a power: a single recurrence if the exponent depends only on parameters, otherwise
    /// exp(b ln a).
    pub(super) fn power(&mut self, place: Place, a: Place, b: Place) {
        if self.parameter_only[b.0] {
            let (a, b, slot, lead) = (self.whole(a), self.constant(b), self.slot(), self.lead());
            self.halves += 3;
            let value = quote!(series::power(&#a, #b, &#slot, #lead, &path.reciprocals, order));
            self.name_in(place, &value, slot);
            return;
        }
        if self.parameter_only[a.0] {
            let (a, b, lead) = (self.constant(a), self.value(b), self.lead());
            let logarithm =
                self.shared("l", place, &quote!(series::leading(|| #a.ln(), #lead, order)));
            self.exponential(place, &quote!(#b * #logarithm));
            return;
        }
        self.call(place, Function::Ln, a);
        let logarithm = self.values[place.0].clone();
        let (logarithm, b) = (self.kept(&logarithm), self.whole(b));
        self.halves += 2;
        self.series.remove(&place);
        self.exponential(place, &quote!(series::product(&#b, &#logarithm, order)));
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn series_are_as_long_as_in_the_runtime() {
        assert_eq!(super::LENGTH, pendulum_runtime::jet::LENGTH);
    }
}
