//! Errors of integrations. Each contains the time, the quantity and a remedy.

mod message;

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
    /// A quantity by whose unit a system is to be scaled has none that is known.
    Unit {
        /// The name in the source.
        quantity: &'static str,
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
    /// The argument of a table leaves its points, beyond which the table is refused.
    Table {
        /// The time.
        t: f64,
        /// The name of the table in the source.
        name: &'static str,
        /// The argument.
        argument: f64,
        /// The first and the last point.
        ends: [f64; 2],
    },
    /// A table among the parameters is not that of the first system of a batch.
    OtherTables,
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
    /// A constraint whose reaction presses a dry friction exerts an impulse, and the part of the
    /// friction in it is not known.
    FrictionImpulse {
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

impl std::error::Error for Error {}
