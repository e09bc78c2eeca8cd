//! Errors of motions.

use core::fmt;

/// Reason for which a motion cannot be made from its keys.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MotionError {
    /// There is no key at all.
    NoKeys,
    /// A motion that repeats needs two keys.
    OneKey,
    /// A motion that repeats without a jump ends elsewhere than it begins.
    Open {
        /// The component, counted from zero.
        component: usize,
        /// Its value at the first key.
        first: f64,
        /// Its value at the last key.
        last: f64,
    },
    /// There are not as many times as values.
    Lengths {
        /// The number of times.
        times: usize,
        /// The number of values.
        values: usize,
    },
    /// A time, a value or a velocity is infinite or no number.
    NotFinite {
        /// The key, counted from zero.
        key: usize,
    },
    /// A key is not later than the one before it.
    NotIncreasing {
        /// The key, counted from zero.
        key: usize,
        /// Its time.
        time: f64,
    },
    /// The frame rate is not a positive number.
    Rate(f64),
    /// No frame is kept: every zeroth of them was asked for.
    Every,
    /// A gain is infinite or no number.
    Gain(f64),
    /// A limit of the speed is not positive.
    SpeedLimit(f64),
    /// The resolution of a function of time is not a positive number of seconds.
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
