//! Steps that are shorter than the least number of single precision.

use crate::error::Error;
use crate::integrate::field::Field;
use crate::integrate::method::{self, Method};
use crate::integrate::state::endpoint::Endpoint;
use crate::integrate::state::interval::StepInterval;
use crate::integrate::step::controller::StepContext;
use crate::scalar::Float;
use crate::system::Dynamics;

/// Returns the least length of a step that the scalar represents with all its digits; 0 for scalars
/// with the range of `f64`.
#[inline]
pub(crate) fn shortest<T: Float>() -> f64 {
    if T::from_f64(1e300).is_finite() { 0.0 } else { f64::from(f32::MIN_POSITIVE) }
}

/// Returns `true` if the scalar cannot represent a step of the length `h`.
#[inline]
pub(crate) fn is_short<T: Float>(h: f64) -> bool {
    h.abs() < shortest::<T>()
}

/// Returns the end of a step with constant accelerations.
///
/// In 1e-38 s, a finite acceleration of single precision moves no coordinate by more than 1e-38,
/// and no velocity by more than a rounding error of the terms that cause such an acceleration. A
/// method of higher order would add nothing.
#[cold]
pub(crate) fn straight<T: Float, const N: usize, const W: bool>(
    field: &mut Field<'_, impl Dynamics<N, Scalar = T>, N, W>,
    interval: &StepInterval,
    from: &mut Endpoint<T, N>,
) -> Endpoint<T, N> {
    let a = from.start_acceleration(field);
    let mut to = Endpoint { t: interval.end, a: None, ..*from };
    for i in 0..N {
        let gain = times(interval.h, a[i]);
        to.q.add_one(i, times(interval.h, from.v.high[i] + T::from_f64(0.5) * gain));
        to.v.add_one(i, gain);
    }
    to
}

/// Takes a single step to a target at a distance that the scalar cannot represent.
#[cold]
pub(super) fn take<D, M, const N: usize>(
    context: StepContext<'_, '_, D, M, N>,
) -> Result<StepInterval, Error>
where
    D: Dynamics<N, Scalar: Float>,
    M: Method<D, N>,
{
    let StepContext { method, field, from, to, workspace, target, stats } = context;
    let interval = StepInterval::to(from.t, target);
    *to = straight(field, &interval, from);
    if !to.is_finite() {
        return Err(method::cause(method, field, &interval, from, workspace));
    }
    stats.accepted += 1;
    Ok(interval)
}

/// Returns h x, for an h that the scalar need not represent.
fn times<T: Float>(mut h: f64, mut x: T) -> T {
    const PART: f64 = f64::from_bits((1023 - 100) << 52);
    while h.abs() < PART && h != 0.0 {
        h /= PART;
        x *= T::from_f64(PART);
    }
    x * T::from_f64(h)
}

#[cfg(test)]
mod tests {
    use super::{is_short, times};
    use crate::scalar::DoubleDouble;

    #[test]
    fn products_need_no_length_in_single_precision() {
        assert_eq!(times(1e-60, 1e30_f32), 1e-30);
        assert_eq!(times(-1e-40, 3e38_f32), -0.03);
        assert_eq!(times(1e-300, 3e38_f32), 0.0);
        assert_eq!(times(0.5, 3.0_f32), 1.5);
    }

    #[test]
    fn only_single_precision_has_short_steps() {
        assert!(is_short::<f32>(1e-39) && is_short::<f32>(-1e-300) && !is_short::<f32>(2e-38));
        assert!(!is_short::<f64>(1e-300) && !is_short::<DoubleDouble>(1e-300));
    }
}
