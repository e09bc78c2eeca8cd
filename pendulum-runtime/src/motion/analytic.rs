//! Motions that know all their derivatives.

use super::{
    CatmullRom, Clip, Linear, Motion, Motions, Sample, Side, Sinusoid, Spline, Still, earlier,
};
use crate::jet::{InputSeries, Series};
use crate::real::Real;
use crate::time::Time;

/// A motion that is analytic but at certain times, and there from both sides: what
/// [`Taylor`](crate::integrate::Taylor) needs.
///
/// A [`Function`](super::Function) is none: a closure tells at most two of its derivatives.
///
/// ```
/// use pendulum_runtime::motion::Sinusoid;
/// use pendulum_runtime::prelude::*;
///
/// lagrangian! {
///     pub struct Shaken { l: m, g: m/s^2 = 9.81 }
///     coordinate q: rad;
///     driven x: [m; 2];
///     let r = x + l*[sin(q), -cos(q)];
///     kinetic = |ṙ|^2/2;
///     potential = g*height(r);
/// }
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let shaken = Shaken::new(0.5).driven_by(Sinusoid::new([0.1, 0.0], 3.0, [0.0, 0.0]));
/// let end = solve(&shaken, (0.0, 10.0), [0.3], [0.0]).method(Taylor::new()).rtol(1e-15).run()?.end;
/// # let _ = end;
/// # Ok(())
/// # }
/// ```
///
/// ```compile_fail,E0277
/// use pendulum_runtime::motion::Function;
/// use pendulum_runtime::prelude::*;
///
/// lagrangian! {
///     pub struct Shaken { l: m, g: m/s^2 = 9.81 }
///     coordinate q: rad;
///     driven x: [m; 2];
///     let r = x + l*[sin(q), -cos(q)];
///     kinetic = |ṙ|^2/2;
///     potential = g*height(r);
/// }
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let lift = Function::new(|t| [0.0, 0.5 * t * t]).velocity(|t| [0.0, t]).acceleration(|_| [0.0, 1.0]);
/// let shaken = Shaken::new(0.5).driven_by(lift);
/// let end = solve(&shaken, (0.0, 10.0), [0.3], [0.0]).method(Taylor::new()).rtol(1e-15).run()?.end;
/// # let _ = end;
/// # Ok(())
/// # }
/// ```
#[diagnostic::on_unimplemented(
    message = "the motion `{Self}` does not know all its derivatives",
    label = "`Taylor` needs the Taylor series of every motion",
    note = "drive by `Still`, `Sinusoid`, `Linear`, `CatmullRom`, `Spline`, `Clip` or a `Projected` one of these, implement `Analytic`, or use `Dop853`"
)]
pub trait Analytic<T: Real, const D: usize> {
    /// The first `count` Taylor coefficients at `t` of one component of the position; the others
    /// stay as they are.
    ///
    /// Where the motion is not analytic they are those of the motion on `side`.
    fn series(&self, t: Time, side: Side, component: usize, count: usize, position: &mut Series<T>);

    /// The first time after `t` at which the motion is not analytic; every kink is such a time.
    fn next_break(&self, t: f64) -> Option<f64>;

    /// The last such time before `t`.
    fn last_break(&self, t: f64) -> Option<f64>;

    /// The last kink before `t`.
    fn last_kink(&self, t: f64) -> Option<f64>;
}

impl<T: Real, const D: usize> Analytic<T, D> for Still<D> {
    fn series(&self, _: Time, _: Side, component: usize, count: usize, position: &mut Series<T>) {
        polynomial([self.position[component]], count, position);
    }

    fn next_break(&self, _: f64) -> Option<f64> {
        None
    }

    fn last_break(&self, _: f64) -> Option<f64> {
        None
    }

    fn last_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

impl<T: Real, const D: usize> Analytic<T, D> for Sinusoid<D> {
    /// k(k−1) x\[k\] = −ω² x\[k−2\].
    fn series(&self, t: Time, _: Side, component: usize, count: usize, position: &mut Series<T>) {
        let (a, w) = (self.amplitude[component], self.frequency);
        let (sin, cos) = self.sin_cos(component, t);
        let (mut even, mut odd) = (a * sin, a * w * cos);
        for (k, coefficient) in position.iter_mut().take(count).enumerate() {
            *coefficient = T::from_f64(even);
            let next = -(w * w * even) / ((k + 1) * (k + 2)) as f64;
            (even, odd) = (odd, next);
        }
        position[0] = T::from_f64(self.offset[component] + a * sin);
    }

    fn next_break(&self, _: f64) -> Option<f64> {
        None
    }

    fn last_break(&self, _: f64) -> Option<f64> {
        None
    }

    fn last_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

/// The coefficients of a polynomial, and zeros.
pub(super) fn polynomial<T: Real, const K: usize>(
    coefficients: [f64; K],
    count: usize,
    series: &mut Series<T>,
) {
    for (k, coefficient) in series.iter_mut().take(count).enumerate() {
        *coefficient = T::from_f64(coefficients.get(k).copied().unwrap_or(0.0));
    }
}

macro_rules! piecewise {
    ($($motion:ident)+) => {$(
        impl<T: Real, const D: usize> Analytic<T, D> for $motion<D> {
            fn series(&self, t: Time, side: Side, component: usize, count: usize, position: &mut Series<T>) {
                polynomial(self.pieces().cubic(t, side, component), count, position);
            }

            fn next_break(&self, t: f64) -> Option<f64> {
                self.pieces().next_key(t)
            }

            fn last_break(&self, t: f64) -> Option<f64> {
                self.pieces().last_key(t)
            }

            fn last_kink(&self, t: f64) -> Option<f64> {
                self.pieces().last_kink(t)
            }
        }
    )+};
}

piecewise!(Linear CatmullRom Spline Clip);

/// The motions of all driven inputs of a system, if every one is analytic.
pub trait AnalyticMotions<Inputs, T: Real>: Motions<Inputs> {
    /// The positions of all components, as [`Analytic::series`] gives them.
    fn series(&self, t: Time, side: Side, count: usize, components: &mut [InputSeries<T>]);

    /// The first time after `t` at which one of them is not analytic.
    fn next_break(&self, t: f64) -> Option<f64>;

    /// The last such time before `t`.
    fn last_break(&self, t: f64) -> Option<f64>;

    /// The last kink before `t`.
    fn last_kink(&self, t: f64) -> Option<f64>;
}

/// The motions of all driven inputs of a system, of which it shows at run time whether every one is
/// analytic.
///
/// The part of one that is not is missing in all other answers.
pub trait MaybeAnalytic<Inputs, T: Real>: Motions<Inputs> {
    /// Whether every one is analytic.
    fn is_analytic(&self) -> bool;

    /// The positions of all components, as [`Analytic::series`] gives them.
    fn series(&self, t: Time, side: Side, count: usize, components: &mut [InputSeries<T>]);

    /// The first time after `t` at which one of them is not analytic.
    fn next_break(&self, t: f64) -> Option<f64>;

    /// The last such time before `t`.
    fn last_break(&self, t: f64) -> Option<f64>;

    /// The last kink before `t`.
    fn last_kink(&self, t: f64) -> Option<f64>;
}

/// The later of two times.
fn later(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    earlier(a.map(|a| -a), b.map(|b| -b)).map(|time| -time)
}

/// The methods that both traits have, for motions of which `known` gives those that are analytic.
macro_rules! answers {
    ($this:ident, [$($known:expr, $dim:expr);*]) => {
        fn series(&$this, t: Time, side: Side, count: usize, components: &mut [InputSeries<T>]) {
            let mut components = components.iter_mut();
            $(for (component, series) in components.by_ref().take($dim).enumerate() {
                if let Some(motion) = $known {
                    motion.series(t, side, component, count, &mut series.position);
                }
            })*
        }

        fn next_break(&$this, t: f64) -> Option<f64> {
            let mut next = None;
            $(next = earlier(next, $known.and_then(|motion| motion.next_break(t)));)*
            next
        }

        fn last_break(&$this, t: f64) -> Option<f64> {
            let mut last = None;
            $(last = later(last, $known.and_then(|motion| motion.last_break(t)));)*
            last
        }

        fn last_kink(&$this, t: f64) -> Option<f64> {
            let mut last = None;
            $(last = later(last, $known.and_then(|motion| motion.last_kink(t)));)*
            last
        }
    };
}

macro_rules! nothing {
    ($($method:ident)+) => {
        fn series(&self, _: Time, _: Side, _: usize, _: &mut [InputSeries<T>]) {}

        $(fn $method(&self, _: f64) -> Option<f64> {
            None
        })+
    };
}

impl<T: Real> AnalyticMotions<(), T> for () {
    nothing!(next_break last_break last_kink);
}

impl<T: Real> MaybeAnalytic<(), T> for () {
    fn is_analytic(&self) -> bool {
        true
    }

    nothing!(next_break last_break last_kink);
}

macro_rules! tuples {
    ($(($($motion:ident $dim:ident $index:tt),+))+) => {$(
        impl<T: Real, $($motion: Motion<T, $dim> + Analytic<T, $dim>, const $dim: usize),+>
            AnalyticMotions<($(Sample<T, $dim>,)+), T> for ($($motion,)+)
        {
            answers!(self, [$(Some(&self.$index), $dim);+]);
        }

        impl<T: Real, $($motion: Motion<T, $dim>, const $dim: usize),+> MaybeAnalytic<($(Sample<T, $dim>,)+), T> for ($($motion,)+) {
            fn is_analytic(&self) -> bool {
                $(self.$index.analytic().is_some())&&+
            }

            answers!(self, [$(self.$index.analytic(), $dim);+]);
        }
    )+};
}

for_tuples_of_motions!(tuples);
