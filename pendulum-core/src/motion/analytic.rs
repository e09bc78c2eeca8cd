//! Motions with all their derivatives.

use crate::motion::sample::Side;
use crate::motion::series::Series;
use crate::scalar::Real;
use crate::time::Time;

/// A motion that is analytic except at certain times, where it is analytic from both sides.
/// [`Taylor`](crate::integrate::Taylor) requires this trait.
///
/// [`Function`](super::Function) does not implement it, because closures give at most two
/// derivatives.
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
    note = "drive by `Still`, `Sinusoid`, `Curve` or a `Projected` one of these, implement `Analytic`, or use `Dop853`"
)]
pub trait Analytic<T: Real, const D: usize> {
    /// Writes the first `count` Taylor coefficients at `t` of one component of the position; the
    /// remaining coefficients stay unchanged.
    ///
    /// At times at which the motion is not analytic, they are the coefficients of the motion on
    /// `side`.
    fn series(&self, t: Time, side: Side, component: usize, count: usize, position: &mut Series<T>);

    /// Returns the first time after `t` at which the motion is not analytic. Kinks are such times.
    fn next_break(&self, t: f64) -> Option<f64>;

    /// Returns the last time before `t` at which the motion is not analytic.
    fn last_break(&self, t: f64) -> Option<f64>;

    /// Returns the last kink before `t`.
    fn last_kink(&self, t: f64) -> Option<f64>;
}

/// Writes the coefficients of a polynomial to `series`, followed by zeros, up to `count`.
pub(super) fn polynomial<T: Real, const K: usize>(
    coefficients: [f64; K],
    count: usize,
    series: &mut Series<T>,
) {
    for (k, coefficient) in series.iter_mut().take(count).enumerate() {
        *coefficient = T::from_f64(coefficients.get(k).copied().unwrap_or(0.0));
    }
}
