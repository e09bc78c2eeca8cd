//! Errors of operations on a scene, and faults of its pendulums.

use core::fmt;
use pendulum_core::error::{Coordinate, Error};

/// An error of an operation on a scene; the scene keeps its previous state.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SceneError {
    /// A frame time is negative, infinite or NaN.
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
    /// A coordinate or velocity given for a pendulum is infinite or NaN.
    State {
        /// The coordinate.
        coordinate: Coordinate,
        /// The value given.
        value: f64,
    },
    /// A joint does not belong to this scene.
    Joint(u32),
    /// A joint that carries pendulums is to be removed.
    Carries {
        /// The joint.
        joint: u32,
        /// The number of driven inputs that it serves.
        inputs: u32,
    },
    /// A pendulum that carries a joint is to be removed.
    CarriesJoint {
        /// The name of the type of the pendulum.
        kind: &'static str,
        /// The index of the pendulum among the pendulums of its type.
        index: u32,
        /// The joint.
        joint: u32,
    },
    /// A joint that a pendulum carries is to get another motion.
    Carried(u32),
    /// An output cannot carry a joint.
    Output {
        /// The name given.
        name: String,
        /// The requirement.
        required: &'static str,
    },
    /// All that a bundle contains has been removed, or belongs to another scene.
    Bundle,
    /// A joint is told to be where it is not live: it follows a motion.
    NotLive(u32),
    /// A position given for a live joint is infinite or NaN.
    Position {
        /// The joint.
        joint: u32,
        /// The component.
        component: usize,
        /// The value given.
        value: f64,
    },
    /// A pendulum does not belong to this scene.
    Pendulum {
        /// The name of the type of the pendulum.
        kind: &'static str,
        /// The index of the pendulum among the pendulums of its type.
        index: u32,
    },
    /// The motion of a joint lacks a derivative that the equations need.
    Derivative {
        /// The driven input.
        input: &'static str,
        /// 0 for the position, 1 for the velocity, 2 for the acceleration.
        derivative: usize,
    },
    /// A pendulum has no state of rest.
    Restless {
        /// The name of the type of the pendulum.
        kind: &'static str,
        /// The index of the pendulum among the pendulums of its type.
        index: u32,
    },
    /// A state violates the constraints or limits of its system, or cannot be brought onto them.
    Constraint(Error),
    /// The mass matrix is not positive definite, for example because a mass is negative.
    Inertia(Error),
    /// A pendulum is too fast: it would need more than 1024 steps in a tick.
    Frequency {
        /// The name of the type of the pendulum.
        kind: &'static str,
        /// The index of the pendulum among the pendulums of its type.
        index: u32,
        /// The angular frequency of the fastest small motions of the pendulum, in rad/s.
        frequency: f64,
        /// The length of a tick in seconds.
        step: f64,
        /// The relative phase error by which steps are chosen.
        tolerance: f64,
    },
    /// A table among the parameters is not that of the other pendulums of the type.
    Tables {
        /// The name of the type of the pendulum.
        kind: &'static str,
    },
    /// No system has a parameter of this name.
    Parameter {
        /// The name given.
        name: String,
        /// The existing names.
        parameters: Vec<&'static str>,
    },
    /// The value of a parameter is infinite or NaN.
    ParameterValue {
        /// The parameter.
        name: String,
        /// The value given.
        value: f64,
    },
    /// The value of a control input is infinite or NaN.
    Input {
        /// The control input.
        input: &'static str,
        /// The component.
        component: usize,
        /// The value given.
        value: f64,
    },
    /// A snapshot belongs to another scene or is damaged; contains a description of the difference.
    Snapshot(&'static str),
    /// The integration over the time in which a pendulum was hidden has failed.
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
            Self::Tables { kind } => write!(
                f,
                "the pendulums of `{kind}` in a scene share their tables, and this one has others; hang it in a scene of its own"
            ),
            Self::Joint(index) => write!(
                f,
                "joint {index} is not in this scene, or has been removed; use the handle that `joint` of this scene gave"
            ),
            Self::Carries { joint, inputs } => write!(
                f,
                "joint {joint} still drives {inputs} inputs of pendulums that stay; remove these first"
            ),
            Self::CarriesJoint { kind, index, joint } => write!(
                f,
                "`{kind}` {index} carries joint {joint}; remove the joint first, or all of it by `remove_bundle`"
            ),
            Self::Carried(joint) => write!(
                f,
                "joint {joint} is an output of the pendulum that carries it; set the state of this pendulum instead"
            ),
            Self::Output { name, required } => {
                write!(f, "`{name}` cannot carry the joint; it has to be {required}")
            }
            Self::Bundle => write!(f, "nothing of this bundle is in this scene any more"),
            Self::NotLive(index) => write!(
                f,
                "joint {index} follows a motion; add it by `live` to move it, or use `set_motion`"
            ),
            Self::Position { joint, component, value } => write!(
                f,
                "component {component} of the position of joint {joint} is {value:?}; give a finite number"
            ),
            Self::Pendulum { kind, index } => {
                write!(
                    f,
                    "`{kind}` {index} is not in this scene, or has been removed; use the handle that `hang` of this scene gave"
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
                    "`{kind}` {index} does not come to rest; set its state, or change the force that drives it"
                )
            }
            Self::Frequency { kind, index, frequency, step, tolerance } => write!(
                f,
                "`{kind}` {index} swings with {frequency:.3e} rad/s, which takes more than 1024 steps in a tick of {step:.3e} s for a tolerance of {tolerance:?}; use more ticks a second or a larger tolerance, put a rod in place of a stiff spring, or integrate it by `solve`"
            ),
            Self::Parameter { name, parameters } if parameters.is_empty() => {
                write!(f, "there is no parameter `{name}`; the system has no parameters")
            }
            Self::Parameter { name, parameters } => {
                write!(f, "there is no parameter `{name}`; there are `{}`", parameters.join("`, `"))
            }
            Self::ParameterValue { name, value } => {
                write!(f, "parameter `{name}` cannot be {value:?}; give a finite number")
            }
            Self::Input { input, component, value } => write!(
                f,
                "component {component} of the input `{input}` cannot be {value:?}; give a finite number"
            ),
            Self::Snapshot(what) => write!(
                f,
                "the snapshot does not belong to this scene: {what}; restore it in the scene in which it was taken"
            ),
            Self::Constraint(error) | Self::Inertia(error) => error.fmt(f),
            Self::Integration(_) => write!(
                f,
                "the motion while the pendulum was hidden could not be computed; show it with `Resume::Unchanged` or `Resume::Rest`"
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

/// A fault of a pendulum whose state is no longer finite. The pendulum keeps its last finite state.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SceneFault {
    /// The name of the type of the pendulum.
    pub kind: &'static str,
    /// The index of the pendulum among the pendulums of its type, in the order of hanging.
    pub index: u32,
    /// The time at the beginning of the tick that failed, in seconds.
    pub t: f64,
    /// The cause of the fault.
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
    use core::error::Error as _;
    use pendulum_core::error::Error;

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
