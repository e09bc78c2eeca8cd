//! Motions that know all their derivatives.

use crate::motion::sample::Side;
use crate::motion::series::Series;
use crate::scalar::Real;
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
