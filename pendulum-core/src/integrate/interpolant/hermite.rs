//! Dense output for methods that define no interpolant: polynomials through the states, and the
//! accelerations, at both ends of a step.

use crate::integrate::interpolant::Interpolant;
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::scalar::Float;

/// Creates the cubic through coordinates and velocities at both ends, and its derivative.
///
/// The cubic needs no accelerations. The error of the coordinates is h⁴/384·|q⁗|, the error of the
/// velocities about h³/40·|q⁗|.
pub(crate) fn cubic<T: Float, const N: usize>(
    interval: &StepInterval,
    from: &Endpoint<T, N>,
    to: &Endpoint<T, N>,
) -> Interpolant<T, N> {
    let h = interval.length::<T>();
    let mut interpolant = Interpolant::linear(interval, from, to);
    interpolant.clamp_coordinates(h, &from.v.high, &to.v.high);
    for i in 0..N {
        // The parabola through both velocities whose integral is the increment of the coordinate.
        let mean = (from.v.high[i] + to.v.high[i]) / T::from_f64(2.0);
        interpolant.v[1][i] = (interpolant.q[0][i] / h - mean) * T::from_f64(6.0);
    }
    interpolant.terms = 3;
    interpolant
}

/// Creates the quintic through coordinates, velocities and accelerations at both ends, and its
/// derivative.
///
/// The error of the coordinates is h⁶/46080·|q⁽⁶⁾|, the error of the velocities of order h⁵.
pub(crate) fn quintic<T: Float, const N: usize>(
    interval: &StepInterval,
    from: &Endpoint<T, N>,
    to: &Endpoint<T, N>,
    a0: &[T; N],
    a1: &[T; N],
) -> Interpolant<T, N> {
    let number = T::from_f64;
    let (h, half) = (interval.length::<T>(), number(0.5));
    let mut interpolant = Interpolant::hermite(interval, from, to, a0, a1);
    for i in 0..N {
        let [increment, q1, q2, ..] = interpolant.q.map(|term| term[i]);
        interpolant.q[3][i] = h * h * a0[i] * half + q1 - q2;
        interpolant.q[4][i] = h * h * a1[i] * half + q1 + q2 + q2 - interpolant.q[3][i];
        // The quartic with the velocities and accelerations of the cubic at both ends, whose
        // integral is the increment of the coordinate.
        let [v0, v1, v2, ..] = interpolant.v.map(|term| term[i]);
        let gap =
            (increment / h - from.v.high[i]) - v0 * half - v1 / number(6.0) - v2 / number(12.0);
        interpolant.v[3][i] = gap * number(30.0);
    }
    interpolant.terms = 5;
    interpolant
}
