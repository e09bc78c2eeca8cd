//! Errors of requests to a scene, and faults of its pendulums.

use crate::error::{Coordinate, Error};
use core::fmt;

/// Reason for which a scene did not do what it was asked to; the scene is as it was before.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SceneError {
    /// A frame time is negative, infinite or no number.
    FrameTime(f64),
    /// A setting is out of its range.
    Setting {
        /// The setting.
        name: &'static str,
        /// The value given.
        value: f64,
        /// The requirement.
        required: &'static str,
    },
    /// A coordinate or velocity that a pendulum was given is infinite or not a number.
    State {
        /// The coordinate.
        coordinate: Coordinate,
        /// The value given.
        value: f64,
    },
    /// A joint does not belong to this scene.
    Joint(u32),
    /// A pendulum does not belong to this scene.
    Pendulum {
        /// The name of its type.
        kind: &'static str,
        /// Its number among those of its type.
        index: u32,
    },
    /// The motion of a joint lacks a derivative that the equations need.
    Derivative {
        /// The driven input.
        input: &'static str,
        /// 1 for the velocity, 2 for the acceleration.
        derivative: usize,
    },
    /// A pendulum comes to rest nowhere.
    Restless {
        /// The name of its type.
        kind: &'static str,
        /// Its number among those of its type.
        index: u32,
    },
    /// A state does not fulfil the constraints of its system, or cannot be brought onto them.
    Constraint(Error),
    /// The mass matrix is not positive definite: a negative mass.
    Inertia(Error),
    /// A pendulum is too fast: in a tick it would take more than 1024 steps.
    Frequency {
        /// The name of its type.
        kind: &'static str,
        /// Its number among those of its type.
        index: u32,
        /// The angular frequency of its fastest small motions, in rad/s.
        frequency: f64,
        /// The length of a tick in seconds.
        step: f64,
        /// The relative error of the phase for which steps are chosen.
        tolerance: f64,
    },
    /// No system of the type has a parameter of that name.
    Parameter {
        /// The name given.
        name: String,
        /// The names that there are.
        parameters: Vec<&'static str>,
    },
    /// The value of a parameter is infinite or no number.
    ParameterValue {
        /// The parameter.
        name: String,
        /// The value given.
        value: f64,
    },
    /// A snapshot was taken of another scene, or damaged since; what does not fit.
    Snapshot(&'static str),
    /// The time in which a pendulum was hidden could not be made up for.
    Integration(Error),
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FrameTime(dt) => write!(
                f,
                "a frame of {dt:?} s cannot be advanced by; give zero or a positive, finite time"
            ),
            Self::Setting { name, value, required } => {
                write!(f, "`{name}` is {value:?}; it has to be {required}")
            }
            Self::State { coordinate, value } => {
                write!(f, "the state of {coordinate} is {value:?}; give a finite number")
            }
            Self::Joint(index) => write!(
                f,
                "joint {index} is not in this scene; use the handle that `joint` of this scene gave"
            ),
            Self::Pendulum { kind, index } => {
                write!(
                    f,
                    "`{kind}` {index} is not in this scene; use the handle that `hang` of this scene gave"
                )
            }
            Self::Derivative { input, derivative } => {
                let name = ["position", "velocity", "acceleration"]
                    .get(*derivative)
                    .unwrap_or(&"derivative");
                write!(
                    f,
                    "the motion that drives `{input}` has no {name}, which the equations or outputs need; give one that has"
                )
            }
            Self::Restless { kind, index } => {
                write!(
                    f,
                    "`{kind}` {index} comes to rest nowhere; set its state, or change what drives it on"
                )
            }
            Self::Frequency { kind, index, frequency, step, tolerance } => write!(
                f,
                "`{kind}` {index} swings with {frequency:.3e} rad/s, which takes more than 1024 steps in a tick of {step:.3e} s for a tolerance of {tolerance:?}; use more ticks a second or a larger tolerance, put a rod in place of a stiff spring, or integrate it by `solve`"
            ),
            Self::Parameter { name, parameters } if parameters.is_empty() => {
                write!(f, "there is no parameter `{name}`, nor any other")
            }
            Self::Parameter { name, parameters } => {
                write!(f, "there is no parameter `{name}`; there are `{}`", parameters.join("`, `"))
            }
            Self::ParameterValue { name, value } => {
                write!(f, "parameter `{name}` was to become {value:?}; give a finite number")
            }
            Self::Snapshot(what) => write!(
                f,
                "the snapshot is not one of this scene: {what}; restore it where it was taken"
            ),
            Self::Constraint(error) | Self::Inertia(error) => error.fmt(f),
            Self::Integration(_) => write!(
                f,
                "the time in which the pendulum was hidden could not be made up for; show it by `Resume::Unchanged` or `Resume::Rest`"
            ),
        }
    }
}

impl core::error::Error for SceneError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Integration(error) => Some(error),
            Self::Constraint(error) | Self::Inertia(error) => error.source(),
            _ => None,
        }
    }
}

/// A pendulum whose state has ceased to be finite: it hangs frozen where it was last good.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SceneFault {
    /// The name of its type.
    pub kind: &'static str,
    /// Its number among those of its type, in the order of hanging.
    pub index: u32,
    /// The beginning of the tick in which it happened, in seconds.
    pub t: f64,
    /// The error.
    pub error: Error,
}

impl fmt::Display for SceneFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` {}: {}", self.kind, self.index, self.error)
    }
}

#[cfg(test)]
mod tests {
    use super::SceneError;
    use crate::error::Error;
    use core::error::Error as _;

    #[test]
    fn causes_are_sources_and_no_part_of_the_message() {
        let cause = Error::MaxSteps { t: 1.0, max_steps: 7 };
        let error = SceneError::Integration(cause.clone());
        assert_eq!(error.source().unwrap().to_string(), cause.to_string());
        assert!(!error.to_string().contains(&cause.to_string()), "{error}");
        assert!(SceneError::Joint(0).source().is_none());
    }

    #[test]
    fn a_catch_up_that_fails_names_the_other_ways_to_show_a_pendulum() {
        let message = SceneError::Integration(Error::MaxSteps { t: 1.0, max_steps: 7 }).to_string();
        assert!(message.contains("`Resume::Unchanged` or `Resume::Rest`"), "{message}");
    }
}
