//! Taylor series of motions.

use crate::scalar::Real;

/// The number of coefficients of a [`Series`].
pub const LENGTH: usize = 32;

/// The highest order of a jet: the acceleration of a driven input needs two further coefficients of
/// its position.
pub const MAX_ORDER: usize = LENGTH - 2;

/// The coefficients of a quantity, starting with the constant one.
pub type Series<T> = [T; LENGTH];

/// The series of one component of a driven input.
#[derive(Clone, Copy, Debug)]
pub struct InputSeries<T> {
    /// x.
    pub position: Series<T>,
    /// ẋ.
    pub velocity: Series<T>,
    /// ẍ.
    pub acceleration: Series<T>,
}

impl<T: Real> InputSeries<T> {
    /// Creates series that are zero.
    pub fn zero() -> Self {
        Self { position: zero(), velocity: zero(), acceleration: zero() }
    }

    /// Computes velocity and acceleration from the position: the coefficients below `count`, and
    /// one more of the velocity.
    pub fn differentiate(&mut self, count: usize) {
        let count = count.min(MAX_ORDER);
        self.velocity[count] = self.position[count + 1] * T::from_f64((count + 1) as f64);
        for k in 0..count {
            self.velocity[k] = self.position[k + 1] * T::from_f64((k + 1) as f64);
            self.acceleration[k] = self.position[k + 2] * T::from_f64(((k + 1) * (k + 2)) as f64);
        }
    }
}

/// Returns the zero series.
pub(crate) fn zero<T: Real>() -> Series<T> {
    [T::from_f64(0.0); LENGTH]
}
