//! Errors of integrations. Each contains the time, the quantity and a remedy.

use core::fmt;

/// The reason for which an integration stopped or did not begin.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The interval is not finite, or it ends before it begins and the method cannot go backwards
    /// in time.
    Interval {
        /// The requested start.
        start: f64,
        /// The requested end.
        end: f64,
    },
    /// A coordinate or velocity of the initial state is infinite or NaN.
    InitialState {
        /// The part of the state.
        part: Part,
        /// The coordinate.
        coordinate: Coordinate,
        /// The given value.
        value: f64,
    },
    /// A setting is out of its range.
    Setting {
        /// The method of the builder that set it.
        name: &'static str,
        /// The given value.
        value: f64,
        /// The range of valid values.
        required: &'static str,
    },
    /// An entry of a list of times is NaN, outside of the interval, or out of order.
    Times {
        /// The method of the builder that received the list.
        name: &'static str,
        /// The index of the entry.
        index: usize,
        /// The entry.
        time: f64,
    },
    /// A solution holds no state at a time.
    NoState {
        /// The time.
        t: f64,
        /// The first and the last time of the dense output; `None` without dense output.
        dense: Option<(f64, f64)>,
    },
    /// A number is infinite or NaN.
    NotFinite {
        /// The time of the evaluation.
        t: f64,
        /// The quantity.
        what: Quantity,
        /// The parameters that are zero, infinite or NaN: possible causes if `what` is an
        /// acceleration, or a velocity from a finite momentum.
        suspects: Vec<Suspect>,
    },
    /// A saved integration does not contain the state of its sampled controller.
    SavedController,
    /// A sampled controller belongs to another integration, which began later.
    Controller {
        /// The time of the sample.
        t: f64,
    },
    /// No velocity has a given finite momentum, at a kink or within an implicit step.
    NoVelocity {
        /// The time.
        t: f64,
        /// The coordinate of the momentum.
        coordinate: Coordinate,
    },
    /// The mass matrix is not positive definite: a mass is negative, or an inertia becomes
    /// negative.
    NegativeInertia {
        /// The time of the evaluation.
        t: f64,
        /// The coordinate of the pivot in the elimination, in the order of declaration.
        coordinate: Coordinate,
        /// The pivot: the inertia of the coordinate if the coordinates declared before it are free
        /// and those declared after it are fixed.
        pivot: f64,
        /// The parameters that are negative: possible causes.
        suspects: Vec<Suspect>,
    },
    /// The state does not satisfy a constraint.
    Inconsistent {
        /// The time.
        t: f64,
        /// The part of the state that does not satisfy the constraint.
        part: Part,
        /// `true` if the velocities do not satisfy the rate of a constraint on positions.
        rate: bool,
        /// The constraint.
        constraint: &'static str,
        /// The misfit of the constraint or of its rate.
        residual: f64,
        /// The unit of the constraint, empty if it is unknown.
        unit: &'static str,
        /// `true` if the constraint is redundant, so that it does not follow from the others.
        redundant: bool,
    },
    /// No state close to a guess satisfies the constraints.
    NotAssembled {
        /// The time.
        t: f64,
        /// The part of the state that was searched for.
        part: Part,
        /// `true` if the residual is that of the rate of a constraint on positions.
        rate: bool,
        /// The constraint with the largest misfit at the end of the search.
        constraint: &'static str,
        /// The misfit of the constraint or of its rate.
        residual: f64,
        /// The unit of the constraint, empty if it is unknown.
        unit: &'static str,
    },
    /// A coordinate to be held does not exist.
    NoCoordinate {
        /// The given name.
        name: String,
        /// The coordinates of the system.
        coordinates: &'static [&'static str],
    },
    /// A constraint depends on the constraints before it, or its gradient vanishes. Its force is
    /// undetermined, and there are several branches of the motion.
    DependentConstraints {
        /// The time.
        t: f64,
        /// The constraint.
        constraint: &'static str,
        /// The independence of the constraint, from 0 to 1.
        independence: f64,
    },
    /// A state violates a limit.
    Penetration {
        /// The time.
        t: f64,
        /// The limit.
        limit: &'static str,
        /// The gap of the limit, which is negative.
        gap: f64,
        /// The unit of the limit, empty if it is unknown.
        unit: &'static str,
    },
    /// Limits move towards each other until no state fulfils them all.
    NoRoom {
        /// The time.
        t: f64,
        /// The limit that cannot be kept from closing.
        limit: &'static str,
        /// The limit against it; `None` if constraints hold the system there.
        other: Option<&'static str>,
    },
    /// A coefficient of restitution is outside of [0, 1].
    Restitution {
        /// The time of the impact.
        t: f64,
        /// The limit.
        limit: &'static str,
        /// The coefficient.
        value: f64,
    },
    /// A limit stays in contact, but the method does not support contact forces.
    Contact {
        /// The time at which the contact begins.
        t: f64,
        /// The limit.
        limit: &'static str,
        /// The method.
        method: &'static str,
    },
    /// A system with limits cannot be integrated backwards in time.
    NoWayBack {
        /// The time reached.
        t: f64,
        /// The first limit.
        limit: &'static str,
    },
    /// A system has dry friction, and the method does not support its force.
    Friction {
        /// The time reached.
        t: f64,
        /// The friction.
        friction: &'static str,
        /// The method.
        method: &'static str,
    },
    /// A system with dry friction cannot be integrated backwards in time.
    FrictionBack {
        /// The time reached.
        t: f64,
        /// The first friction.
        friction: &'static str,
    },
    /// The force of a dry friction, its bound, or its share in the force of a contact is negative.
    NegativeFriction {
        /// The time.
        t: f64,
        /// The friction.
        friction: &'static str,
        /// The value.
        value: f64,
    },
    /// No accelerations fulfil the laws of all contacts and dry frictions, or several do (Painlevé
    /// 1895): friction presses a body into its contact.
    NoGrip {
        /// The time.
        t: f64,
        /// The friction.
        friction: &'static str,
    },
    /// A switch stays at its change of sign, because the accelerations on both sides lead back to
    /// it.
    Sliding {
        /// The time reached.
        t: f64,
        /// The argument of `sign`, `abs`, `min` or `max`.
        argument: &'static str,
    },
    /// Step control requires a step below the resolution of time.
    StepSizeUnderflow {
        /// The time reached.
        t: f64,
        /// The required step.
        step: f64,
        /// The coordinate with the largest error.
        coordinate: Coordinate,
    },
    /// The iteration for the equations of an implicit step diverged.
    NoConvergence {
        /// The time of the stage with the largest residual, or of the end of the step.
        t: f64,
        /// The length of the step.
        step: f64,
        /// The coordinate with the largest residual, or with the largest acceleration.
        coordinate: Coordinate,
    },
    /// The allowed number of steps is reached or does not suffice.
    MaxSteps {
        /// The time reached.
        t: f64,
        /// The allowed number of steps.
        max_steps: u64,
    },
    /// The function of an event returned NaN.
    Event {
        /// The time of the evaluation.
        t: f64,
        /// The index of the event in the given list.
        event: usize,
    },
    /// The action of an event set a number that is not finite; the state is the one before the
    /// action.
    Action {
        /// The time of the event.
        t: f64,
        /// The index of the event in the given list.
        event: usize,
        /// The coordinate or velocity.
        what: Quantity,
    },
    /// The times of an event accumulate: the intervals between its actions become shorter and
    /// shorter, and a certain time is never passed.
    Accumulation {
        /// The extrapolated time of the accumulation.
        t: f64,
        /// The index of the event in the given list.
        event: usize,
    },
    /// The action of an event leaves the motion at a zero of the function of the event.
    EventStays {
        /// The time of the event.
        t: f64,
        /// The index of the event in the given list.
        event: usize,
    },
    /// An event has an action, which an integration backwards in time would have to undo.
    Backwards {
        /// The time at which the integration backwards was to begin.
        t: f64,
        /// The index of the event in the given list.
        event: usize,
    },
    /// A saved integration does not match the one to be resumed.
    Saved {
        /// The system of the saved integration.
        system: String,
        /// The method of the saved integration.
        method: String,
    },
    /// A motion returned a next kink or break that is not later than the time in question.
    Kink {
        /// The time in question.
        t: f64,
        /// The returned time.
        kink: f64,
    },
}

/// A part of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The coordinates q.
    Position,
    /// The velocities q̇.
    Velocity,
}

/// A generalized coordinate, given by index and name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coordinate {
    /// The index in `q` and `v`.
    pub index: usize,
    /// The name in the source, empty if it is unknown.
    pub name: &'static str,
}

/// A quantity that must be finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Quantity {
    /// A component of the sample of a driven input.
    Input {
        /// The name of the input in the source.
        name: &'static str,
        /// The index of the component.
        component: usize,
        /// The order of the derivative: 0 for the position, 1 for the velocity, 2 for the
        /// acceleration.
        derivative: usize,
    },
    /// A component of the value returned by a controller.
    Control {
        /// The name of the control input in the source.
        name: &'static str,
        /// The index of the component.
        component: usize,
    },
    /// A generalized acceleration.
    Acceleration(Coordinate),
    /// A coordinate.
    Position(Coordinate),
    /// A velocity.
    Velocity(Coordinate),
    /// The Taylor series of a generalized acceleration that is finite itself.
    Series(Coordinate),
}

/// A parameter with a value that is a likely cause of an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Suspect {
    /// The name of the parameter in the source.
    pub parameter: &'static str,
    /// The value of the parameter.
    pub value: f64,
}

/// Writes the misfit of a constraint or of its rate, with its unit.
fn misfit(
    f: &mut fmt::Formatter<'_>,
    kind: &str,
    constraint: &str,
    verb: &str,
    (rate, residual, unit): (bool, f64, &str),
) -> fmt::Result {
    let (what, per) = if rate { ("the rate of the ", " per second") } else { ("the ", "") };
    let space = if unit.is_empty() { "" } else { " " };
    write!(f, "{what}{kind} {constraint} {verb} off by {residual:?}{space}{unit}{per}")
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Interval { start, end }
                if start < end && start.is_finite() && end.is_finite() =>
            {
                write!(
                    f,
                    "the length of the interval from {start:?} to {end:?} is beyond the range of f64; give a shorter interval"
                )
            }
            Self::Interval { start, end } if start.is_finite() && end.is_finite() => {
                write!(
                    f,
                    "the end {end:?} lies before the start {start:?}; swap them or, to go back in time, implement `kink_before` for \
                     every motion; sampled controllers go forwards only"
                )
            }
            Self::Interval { start, end } => {
                write!(
                    f,
                    "the interval from {start:?} to {end:?} is not finite; give two finite times"
                )
            }
            Self::InitialState { part, coordinate, value } => {
                let part = match part {
                    Part::Position => "position",
                    Part::Velocity => "velocity",
                };
                write!(f, "the initial {part} of {coordinate} is {value:?}; give a finite number")
            }
            Self::Setting { name, value, required } => {
                write!(f, "`{name}` is {value:?}, but has to be {required}")
            }
            Self::Times { name, index, time } => {
                write!(
                    f,
                    "entry {index} of `{name}` is {time:?}; give finite times within the interval, in its direction"
                )
            }
            Self::NoState { t, dense: None } => {
                write!(
                    f,
                    "the solution holds its output times alone, not the state at t = {t:?}; call `dense` before `run`"
                )
            }
            Self::NoState { t, dense: Some((start, end)) } => {
                write!(
                    f,
                    "t = {t:?} lies outside of the solution; give a time from {start:?} to {end:?}"
                )
            }
            Self::NotFinite { t, what, ref suspects } => {
                write!(f, "at t = {t:?} the {what} is not finite; ")?;
                match (what, suspects.split_first()) {
                    (_, Some((first, rest))) => {
                        write!(f, "check parameter {first}")?;
                        rest.iter().try_for_each(|suspect| write!(f, ", {suspect}"))
                    }
                    (Quantity::Input { .. }, None) => {
                        write!(f, "check the motion that drives it at this time")
                    }
                    (Quantity::Control { .. }, None) => {
                        write!(f, "check the controller at this time and in the state before")
                    }
                    (Quantity::Acceleration(_), None) => {
                        write!(
                            f,
                            "the mass matrix may be singular or a function outside its domain there, or the steps are too long for a motion that grows; check the state before, and at a pole of angles or of polar coordinates take components with a constraint"
                        )
                    }
                    (Quantity::Series(_), None) => write!(
                        f,
                        "a part of the equations overflows, as 1/(1 + exp(x)) for a large x, is not smooth, or the mass matrix is almost singular there; \
                         try `Dop853` or `Picard`, or functions that stay finite, as `tanh` and `sech`"
                    ),
                    (_, None) => write!(
                        f,
                        "the motion has left the range of numbers, try a smaller step or tolerance"
                    ),
                }
            }
            Self::NoVelocity { t, coordinate } => write!(
                f,
                "at t = {t:?} no velocity was found for the momentum of {coordinate}; the Lagrangian may not reach it at any velocity: \
                 check the forces and the jumps of driven inputs before"
            ),
            Self::NegativeInertia { t, coordinate, pivot, ref suspects } => {
                write!(f, "at t = {t:?} the inertia of {coordinate} is negative, {pivot:?}; ")?;
                match suspects.split_first() {
                    Some((first, rest)) => {
                        write!(f, "check parameter {first}")?;
                        rest.iter().try_for_each(|suspect| write!(f, ", {suspect}"))
                    }
                    None => write!(
                        f,
                        "the kinetic energy has to be positive for every velocity, check the state there"
                    ),
                }
            }
            Self::Inconsistent { t, rate, constraint, residual, unit, redundant, .. } => {
                let kind = if redundant { "redundant constraint" } else { "constraint" };
                write!(f, "at t = {t:?} ")?;
                misfit(f, kind, constraint, "is", (rate, residual, unit))?;
                f.write_str(if redundant {
                    "; it does not follow from the others, declare it without `redundant`"
                } else {
                    "; begin with a state that fulfils it, as `assemble` finds one, or take shorter steps"
                })
            }
            Self::NotAssembled { t, rate, constraint, residual, unit, .. } => {
                write!(f, "at t = {t:?} no state near the guess fulfils the constraints: ")?;
                misfit(f, "constraint", constraint, "stays", (rate, residual, unit))?;
                f.write_str("; guess elsewhere, hold fewer coordinates, or check the parameters")
            }
            Self::NoCoordinate { ref name, coordinates } => {
                write!(f, "there is no coordinate `{name}` to hold; there are ")?;
                for (index, own) in coordinates.iter().enumerate() {
                    write!(f, "{}`{own}`", if index == 0 { "" } else { ", " })?;
                }
                Ok(())
            }
            Self::DependentConstraints { t, constraint, independence } => write!(
                f,
                "at t = {t:?} the constraint {constraint} depends on those before it, or its gradient vanishes: \
                 {independence:.1e} of it is left; leave it out, declare it `redundant`, stop before \
                 that state, or let longer steps go over it by a tolerance of 1e-8 or more"
            ),
            Self::Penetration { t, limit, gap, unit } => {
                let space = if unit.is_empty() { "" } else { " " };
                write!(
                    f,
                    "at t = {t:?} the gap of the limit {limit} is {gap:?}{space}{unit}; begin with a state in which it is not negative"
                )
            }
            Self::NoRoom { t, limit, other } => {
                write!(f, "at t = {t:?} the limit {limit} leaves no room between itself and ")?;
                match other {
                    Some(other) => write!(f, "the limit {other}")?,
                    None => f.write_str("the constraints")?,
                }
                f.write_str("; end before that time, or keep them apart")
            }
            Self::Restitution { t, limit, value } => write!(
                f,
                "at t = {t:?} the restitution of the limit {limit} is {value:?}; it has to be from 0 (no rebound) to 1"
            ),
            Self::Contact { t, limit, method } => write!(
                f,
                "at t = {t:?} the limit {limit} stays in contact, and {method} does not know its force; \
                 use `Dop853`, `Rk4` or, for adaptive steps, `Auto`"
            ),
            Self::NoWayBack { t, limit } => write!(
                f,
                "at t = {t:?} there is no way back over the impacts on the limit {limit}; integrate forwards in time"
            ),
            Self::Friction { t, friction, method } => write!(
                f,
                "at t = {t:?} the friction {friction} acts, and {method} does not know its force; \
                 use `Dop853`, `Rk4` or, for adaptive steps, `Auto`"
            ),
            Self::FrictionBack { t, friction } => write!(
                f,
                "at t = {t:?} there is no way back over the friction {friction}: what sticks does not show how it has come to rest; integrate forwards in time"
            ),
            Self::NegativeFriction { t, friction, value } => write!(
                f,
                "at t = {t:?} the force of the friction {friction}, its `static` or its factor of a reaction is {value:?}; it has to be zero or positive, check its parameters and signs"
            ),
            Self::NoGrip { t, friction } => write!(
                f,
                "at t = {t:?} no motion, or more than one, fulfils the laws of the friction {friction} and of all contacts: the friction presses a body into the contact that it acts in (Painlevé's paradox); \
                 lower the coefficient of friction, or put a spring into the contact"
            ),
            Self::Sliding { t, argument } => write!(
                f,
                "at t = {t:?} the motion has to stay where {argument} changes its sign: on either side the accelerations lead back; \
                 make the change gradual, or write dry friction as a `friction` in place of `sign(v)`"
            ),
            Self::StepSizeUnderflow { t, step, coordinate } => write!(
                f,
                "at t = {t:?} the step size fell to {step:?} for the sake of {coordinate}; the motion may be singular there: \
                 stop before it, loosen the tolerances, or choose coordinates that stay regular"
            ),
            Self::NoConvergence { t, step, coordinate } => write!(
                f,
                "at t = {t:?} the equations of a step of {step:?} s could not be solved for {coordinate}; \
                 try a shorter step or, if a spring or damper is stiff, `Gauss` with Newton's method"
            ),
            Self::MaxSteps { t, max_steps } => write!(
                f,
                "{max_steps} steps do not suffice from t = {t:?}; raise `max_steps`, loosen the tolerances or lengthen the step; if the motion diverges, check the signs of gains and of friction, and the period of a controller; dry friction needs a `friction` in place of `sign(v)`"
            ),
            Self::Event { t, event } => write!(
                f,
                "at t = {t:?} the function of event {event} gives something that is not a number; it has to be defined wherever the motion goes"
            ),
            Self::SavedController => write!(
                f,
                "the state of a sampled controller is no part of what was saved; begin the run anew, or give the feedback by `controlled_by`"
            ),
            Self::Controller { t } => write!(
                f,
                "at t = {t:?} the sampled controller serves an integration that began later; clone the system, and give each \
                 integration a controller of its own"
            ),
            Self::Action { t, event, what } => write!(
                f,
                "at t = {t:?} the action of event {event} gives a {what} that is not finite; check what `then` does to the state there"
            ),
            Self::Accumulation { t, event } => write!(
                f,
                "event {event} acts again and again, each time sooner, and never passes t = {t:?}; \
                 let it come to rest by `.rest_below(speed)`, make it terminal, or end before that time"
            ),
            Self::EventStays { t, event } => write!(
                f,
                "at t = {t:?} event {event} acts and the motion stays where its function is zero; \
                 let the action give a velocity that leads away, or end there by `.terminal()` or `.rest_below(speed)`"
            ),
            Self::Backwards { t, event } => write!(
                f,
                "event {event} acts, and there is no way back in time from t = {t:?}; leave out `then`, or go forwards"
            ),
            Self::Saved { ref system, ref method } => write!(
                f,
                "the saved integration, of `{system}` by `{method}`, does not fit; \
                 build the integrator with the same system, method, steps and events, and restore what `save` gave"
            ),
            Self::Kink { t, kink } => {
                write!(
                    f,
                    "a motion says that its next kink or break after t = {t:?} is at {kink:?}; `next_kink` and `next_break` have to give a later time or `None`"
                )
            }
        }
    }
}

impl std::error::Error for Error {}

impl fmt::Display for Coordinate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.name.is_empty() {
            write!(f, "coordinate {}", self.index)
        } else {
            write!(f, "`{}`", self.name)
        }
    }
}

impl fmt::Display for Suspect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`, which is {:?}", self.parameter, self.value)
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Input { name, component, derivative } => {
                let derivative = ["position", "velocity", "acceleration"][derivative.min(2)];
                write!(f, "{derivative} of the driven input `{name}` (component {component})")
            }
            Self::Control { name, component } => {
                write!(f, "control input `{name}` (component {component})")
            }
            Self::Acceleration(coordinate) => write!(f, "acceleration of {coordinate}"),
            Self::Position(coordinate) => write!(f, "position of {coordinate}"),
            Self::Velocity(coordinate) => write!(f, "velocity of {coordinate}"),
            Self::Series(coordinate) => {
                write!(f, "Taylor series of the acceleration of {coordinate}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Coordinate, Error, Part, Quantity, Suspect};

    const THETA: Coordinate = Coordinate { index: 0, name: "θ" };

    #[test]
    fn messages_name_time_place_and_remedy() {
        let suspects = vec![
            Suspect { parameter: "L", value: 0.0 },
            Suspect { parameter: "g", value: f64::NAN },
        ];
        let error = Error::NotFinite { t: 1.5, what: Quantity::Acceleration(THETA), suspects };
        let message = "at t = 1.5 the acceleration of `θ` is not finite; check parameter `L`, which is 0.0, `g`, which is NaN";
        assert_eq!(error.to_string(), message);

        let what = Quantity::Input { name: "x", component: 1, derivative: 2 };
        let error = Error::NotFinite { t: 0.25, what, suspects: vec![] };
        assert_eq!(
            error.to_string(),
            "at t = 0.25 the acceleration of the driven input `x` (component 1) is not finite; check the motion that drives it at this time"
        );

        let error =
            Error::InitialState { part: Part::Velocity, coordinate: THETA, value: f64::NAN };
        assert_eq!(error.to_string(), "the initial velocity of `θ` is NaN; give a finite number");
    }

    #[test]
    fn a_momentum_without_a_velocity_is_not_blamed_on_the_step() {
        let message = Error::NoVelocity { t: 0.5, coordinate: THETA }.to_string();
        assert!(
            message.starts_with("at t = 0.5 no velocity was found for the momentum of `θ`; "),
            "{message}"
        );
        assert!(!message.contains("step"), "{message}");
    }

    #[test]
    fn a_nameless_coordinate_is_numbered() {
        assert_eq!(Coordinate { index: 3, name: "" }.to_string(), "coordinate 3");
    }

    #[test]
    fn intervals_that_are_reversed_and_infinite_differ() {
        let message = Error::Interval { start: 1.0, end: 0.0 }.to_string();
        assert!(message.contains("before") && message.contains("`kink_before`"), "{message}");
        assert!(
            Error::Interval { start: -1e308, end: 1e308 }.to_string().contains("beyond the range")
        );
        assert!(Error::Interval { start: 1.0, end: f64::INFINITY }.to_string().contains("finite"));
    }
}
