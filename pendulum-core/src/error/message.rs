//! The messages of errors: what is wrong and what to do.

use super::{Coordinate, Error, Part, Quantity, Suspect};
use core::fmt;

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
            Self::Unit { quantity } => write!(
                f,
                "the unit of `{quantity}` is not known or does not include the lengths of a table; a system is scaled by the units of its parameters, as in `k: N/m`"
            ),
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
            Self::Table { t, name, argument, ends: [first, last] } => write!(
                f,
                "at t = {t:?} the argument {argument:?} of the table `{name}` leaves its points, from {first:?} to {last:?}; \
                 add points, or let it go on along its tangents by `outside = linear` or `Table::linear`"
            ),
            Self::OtherTables => f.write_str(
                "the systems of a batch share their tables, and this one has others; run it with `solve`, in an `Ensemble` or in a batch of its own",
            ),
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
            Self::FrictionImpulse { t, friction } => write!(
                f,
                "at t = {t:?} velocities jump, and the constraint that presses the friction {friction} exerts an impulse, of which the friction takes a part that is not known; \
                 let the speed of an input change within a short time, or press the friction by a `limit`"
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
