//! Errors of motions.

use core::fmt;

/// The reason for which a motion cannot be created.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MotionError {
    /// An argument is out of its range.
    Argument {
        /// The quantity.
        name: &'static str,
        /// The given value.
        value: f64,
        /// The range of valid values.
        required: &'static str,
    },
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
}

impl fmt::Display for MotionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Argument { name, value, required } => {
                write!(f, "the {name} is {value}; it must be {required}")
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
        }
    }
}

impl core::error::Error for MotionError {}
