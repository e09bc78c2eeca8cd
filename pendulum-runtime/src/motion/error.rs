//! Errors of motions.

use core::fmt;

/// The reason for which a motion cannot be created.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MotionError {
    /// There are no keys.
    NoKeys,
    /// A repeating motion has fewer than two keys.
    OneKey,
    /// The first and last values of a periodic motion differ.
    Open {
        /// The component, counted from zero.
        component: usize,
        /// The value at the first key.
        first: f64,
        /// The value at the last key.
        last: f64,
    },
    /// The numbers of times and values differ.
    Lengths {
        /// The number of times.
        times: usize,
        /// The number of values.
        values: usize,
    },
    /// A time, a value or a velocity is infinite or NaN.
    NotFinite {
        /// The key, counted from zero.
        key: usize,
    },
    /// The time of a key is not later than that of the key before.
    NotIncreasing {
        /// The key, counted from zero.
        key: usize,
        /// The time of the key.
        time: f64,
    },
    /// The frame rate is not a positive number.
    Rate(f64),
    /// `every` is zero, so no frame would be kept.
    Every,
    /// A gain is infinite or NaN.
    Gain(f64),
    /// A speed limit is not positive.
    SpeedLimit(f64),
    /// The resolution of a function of time is not a positive and finite number of seconds.
    Resolution(f64),
}

impl fmt::Display for MotionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoKeys => {
                write!(f, "a motion needs at least one key; use `Still` for a point at rest")
            }
            Self::OneKey => {
                write!(f, "a motion that repeats needs at least two keys; the last closes the loop")
            }
            Self::Open { component, first, last } => {
                write!(
                    f,
                    "component {component} begins at {first:?} and ends at {last:?}; repeat the value of the first key at the end of the period"
                )
            }
            Self::Lengths { times, values } => {
                write!(f, "{times} times but {values} values; give each key one of both")
            }
            Self::NotFinite { key } => {
                write!(f, "key {key} is infinite or no number; leave it out or mend it")
            }
            Self::NotIncreasing { key, time } => {
                write!(
                    f,
                    "key {key} at {time} s is not later than the key before it; sort the keys and drop doubles"
                )
            }
            Self::Rate(rate) => {
                write!(f, "a frame rate of {rate} Hz; give a positive number of frames a second")
            }
            Self::Gain(gain) => {
                write!(f, "a gain of {gain}; give a finite number, 1 for the motion as it is")
            }
            Self::SpeedLimit(limit) => {
                write!(f, "a speed limit of {limit} m/s; give a positive number, infinity for none")
            }
            Self::Resolution(seconds) => {
                write!(
                    f,
                    "a resolution of {seconds} s; give a positive number of seconds, the shortest time in which the motion changes"
                )
            }
            Self::Every => {
                write!(f, "`every` is 0, and no frame is kept; give 1 to keep all of them")
            }
        }
    }
}

impl core::error::Error for MotionError {}
