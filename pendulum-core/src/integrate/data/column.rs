//! Columns of a solution: coordinates and velocities by name, energies along the motion.

use super::pushed::Pushed;
use crate::integrate::field::contacts::Contacts;
use crate::integrate::field::phase::Phase;
use crate::integrate::solution::{RunNumber, Solution};
use crate::integrate::state::State;
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::label::Label;
use crate::system::name::{self, Name};
use crate::system::{Dynamics, Purpose, System};
use crate::time::Time;
use core::fmt;

/// The reason why a solution has no column with a given name.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ColumnError {
    /// The name requested.
    pub name: String,
    /// The nearest name, if one is similar enough.
    pub nearest: Option<String>,
    /// The names of all columns.
    pub columns: Vec<String>,
    /// A hint at the calls that return other quantities.
    hint: &'static str,
    reason: Reason,
}

/// The reason why there are no values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Reason {
    /// No column has the name.
    Unknown,
    /// A sampled controller does not have the samples of the solution.
    Stale,
    /// The solution does not contain the motion within its steps.
    NotDense,
    /// An event changed the state by an action whose derivatives are unknown.
    Action,
    /// The argument in the hint changes its sign in the same step as another one.
    Jumps,
    /// A number is not finite.
    NotFinite,
}

/// The maximum number of names listed in a message.
const LISTED: usize = 12;

impl ColumnError {
    /// Creates the error for a name that is not in `columns`; `hint` names the calls that return
    /// other quantities.
    pub(crate) fn new<'a>(
        name: &str,
        columns: impl Iterator<Item = &'a str>,
        hint: &'static str,
    ) -> Self {
        let columns: Vec<String> = columns.map(String::from).collect();
        let wanted = name::read(name);
        let length = wanted.base.chars().count();
        let limit = if length < 2 { 2 } else { 2 + length / 4 * 2 };
        // `dq` and `vq` are velocities.
        let velocity = ["v_", "v", "d_", "d"].into_iter().find_map(|sign| {
            let velocity = Name { base: wanted.base.strip_prefix(sign)?.into(), dots: 1 };
            columns.iter().find(|column| name::read(column) == velocity)
        });
        let nearest = columns
            .iter()
            .map(|column| (name::distance(&wanted, &name::read(column)), column))
            .filter(|&(distance, _)| distance <= limit)
            .min_by_key(|&(distance, _)| distance)
            .map(|(_, column)| column);
        let nearest = velocity.or(nearest).cloned();
        Self { name: name.into(), nearest, columns, hint, reason: Reason::Unknown }
    }

    /// Creates the error for a quantity that needs the motion within the steps.
    pub(crate) fn not_dense(name: &str) -> Self {
        Self::because(name, Reason::NotDense)
    }

    /// Creates the error for a derivative of a motion that the action of an event has changed.
    pub(crate) fn action(name: &str) -> Self {
        Self::because(name, Reason::Action)
    }

    /// Creates the error for a derivative of a motion, a step of which passes two jumps of the
    /// accelerations, the second where `argument` changes its sign.
    pub(crate) fn jumps(name: &str, argument: &'static str) -> Self {
        Self { hint: argument, ..Self::because(name, Reason::Jumps) }
    }

    /// Creates the error for a quantity that is infinite or NaN.
    pub(crate) fn not_finite(name: &str) -> Self {
        Self::because(name, Reason::NotFinite)
    }

    fn because(name: &str, reason: Reason) -> Self {
        Self { name: name.into(), nearest: None, columns: Vec::new(), hint: "", reason }
    }

    /// Returns the members of the family with this name.
    fn members(&self) -> Vec<&str> {
        let Name { base, dots } = name::read(&self.name);
        let member = |column: &&str| {
            let found = name::read(column);
            found.dots == dots
                && found.base.strip_prefix(&base).is_some_and(|index| index.starts_with('['))
        };
        self.columns.iter().map(String::as_str).filter(member).collect()
    }
}

impl fmt::Display for ColumnError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, nearest, columns, hint, reason } = self;
        let why = match reason {
            Reason::Unknown => "",
            Reason::Stale => {
                " needs the values of the sampled controller, which has not run or has run again since; ask before the next run, or clone the system for each run and ask the clone"
            }
            Reason::NotDense => {
                " needs the motion within the steps; add `.dense()` before `.run()`"
            }
            Reason::Action => {
                " does not reach beyond an event whose action changes the state; end the run there, and begin the next one with the changed state"
            }
            Reason::Jumps => {
                return write!(
                    f,
                    "`{name}` is lost where `{hint}` changes its sign in the same step as another argument; take shorter steps, or a method with tolerances, whose steps end there"
                );
            }
            Reason::NotFinite => {
                " is not finite; an acceleration has no derivative in one of the states"
            }
        };
        if *reason != Reason::Unknown {
            return write!(f, "`{name}`{why}");
        }
        if let [first, .., last] = self.members()[..] {
            return write!(f, "`{name}` is a family; name a member, `{first}` … `{last}`");
        }
        if name::read(name).dots == 2 {
            return write!(
                f,
                "a solution holds no accelerations, so there is no column `{name}`; evaluate them by `solution.accelerations(&system)`"
            );
        }
        write!(f, "there is no column `{name}`; ")?;
        if let Some(nearest) = nearest {
            return write!(f, "did you mean `{nearest}`?");
        }
        if columns.is_empty() {
            return write!(f, "there are none{hint}");
        }
        write!(f, "there are ")?;
        for (index, column) in columns.iter().take(LISTED).enumerate() {
            write!(f, "{}`{column}`", if index == 0 { "" } else { ", " })?;
        }
        write!(f, "{}{hint}", if LISTED < columns.len() { ", …" } else { "" })
    }
}

impl core::error::Error for ColumnError {}

impl<T: Float, const N: usize> Solution<T, N> {
    /// Returns the names of all columns: `t`, the coordinates as written, and the velocities with a
    /// dot, as `θ̇`, or with the suffix `_dot` if the block is in ASCII.
    pub fn column_names(&self) -> Vec<String> {
        self.labels.labels(N).names().map(String::from).collect()
    }

    /// Returns the values of a coordinate, of a velocity or of the time `t` at all output times.
    ///
    /// Names are parsed as in a `lagrangian!` block: `"θ"` or `"theta"`; `"θ̇"`, `"theta_dot"` or
    /// `"dot(θ)"`; a member of a family as `"θ[2]"`, its velocity as `"θ̇[2]"` or `"theta_dot[2]"`.
    /// Coordinates without a name are `"q[0]"`, …, their velocities `"v[0]"`, ….
    ///
    /// # Errors
    /// Returns an error for any other name; the error contains the nearest name.
    pub fn column(&self, name: &str) -> Result<Vec<T>, ColumnError> {
        let wanted = name::read(name);
        if wanted == name::read("t") {
            return Ok(self.t.iter().map(|&t| T::from_f64(t)).collect());
        }
        let labels = self.labels.labels(N);
        let found =
            |labels: &[Label]| labels.iter().position(|label| name::read(&label.name) == wanted);
        if let Some(index) = found(&labels.coordinates) {
            return Ok(self.q.iter().map(|q| q[index]).collect());
        }
        if let Some(index) = found(&labels.velocities) {
            return Ok(self.v.iter().map(|v| v[index]).collect());
        }
        let hint = "; outputs of the system come by `solution.output(&system, name)`, its energy by \
                    `solution.energy(&system)`";
        Err(ColumnError::new(name, labels.names(), hint))
    }

    /// Returns the accelerations q̈ at all output times, including the forces of limits in contact
    /// and of dry friction.
    ///
    /// Two states at the same time are treated as in [`energy`](Self::energy).
    ///
    /// # Errors
    /// Returns an error if a [sampled](crate::system::Sampled) controller has run again since.
    pub fn accelerations<D: Dynamics<N, Scalar = T>>(
        &self,
        dynamics: &D,
    ) -> Result<Vec<[T; N]>, ColumnError> {
        self.fresh(dynamics, "accelerations")?;
        let one = |phase: &Phase<'_, D, N>, contacts| Pushed::new(phase, &contacts).accelerations;
        Ok(self.evaluate(dynamics, one))
    }

    /// Returns the Jacobi integral q̇·∂L/∂q̇ − L at all output times, like [`Dynamics::energy_at`].
    ///
    /// If two states have the same time, as at a kink with
    /// [`every_step`](crate::integrate::Solve::every_step), the first of them uses the values of
    /// driven inputs before the kink.
    pub fn energy<D: Dynamics<N, Scalar = T>>(&self, dynamics: &D) -> Vec<T> {
        self.evaluate(dynamics, |phase, _| {
            let inputs = phase.inputs(Purpose::Energy);
            dynamics.system().energy(phase.at(&inputs))
        })
    }

    /// Returns dE/dt at all output times: [`Dynamics::power_at`], less μ·∂h/∂t of the limits in
    /// contact, plus the power of dry friction.
    ///
    /// [`work`](Self::work) is its integral.
    ///
    /// Two states at the same time are treated as in [`energy`](Self::energy).
    ///
    /// # Errors
    /// Returns an error if a [sampled](crate::system::Sampled) controller has run again since.
    pub fn power<D: Dynamics<N, Scalar = T>>(&self, dynamics: &D) -> Result<Vec<T>, ColumnError> {
        self.fresh(dynamics, "power")?;
        Ok(self.evaluate(dynamics, |phase, contacts| power(phase, &contacts)))
    }

    /// Returns the conserved quantities of the system at all output times: a column for each name
    /// in `FACTS.conserved`, in this order.
    ///
    /// Two states at the same time are treated as in [`energy`](Self::energy).
    pub fn conserved<D: Dynamics<N, Scalar = T>>(&self, dynamics: &D) -> Vec<Vec<T>> {
        let count = <D::System as System<N>>::FACTS.conserved.len();
        let rows = self.evaluate(dynamics, |phase, _| {
            let inputs = phase.momentum_inputs();
            let mut values = vec![T::from_f64(0.0); count];
            dynamics.system().conserved(phase.at(&inputs), &mut values);
            values
        });
        columns(&rows, count)
    }

    /// Returns the multipliers λ of the constraints at all output times, including the effect of
    /// limits in contact: a column for each constraint that the equations hold, in the order of
    /// `FACTS.constraints`.
    ///
    /// Two states at the same time are treated as in [`energy`](Self::energy).
    ///
    /// # Errors
    /// Returns an error if a [sampled](crate::system::Sampled) controller has run again since.
    pub fn reactions<D: Dynamics<N, Scalar = T>>(
        &self,
        dynamics: &D,
    ) -> Result<Vec<Vec<T>>, ColumnError> {
        let count = <D::System as System<N>>::FACTS.held_constraints();
        self.fresh(dynamics, "reactions")?;
        let rows =
            self.evaluate(dynamics, |phase, contacts| Pushed::new(phase, &contacts).multipliers);
        Ok(columns(&rows, count))
    }

    /// Returns the multipliers μ ≥ 0 of the limits at all output times, zero for limits out of
    /// contact: a column for each limit h, in the order of `FACTS.limits`.
    ///
    /// The generalized force of a limit is μ ∂h/∂q: μ is an energy per unit of h. The impulses of
    /// impacts are in [`impacts`](Self::impacts).
    ///
    /// Two states at the same time are treated as in [`energy`](Self::energy).
    ///
    /// # Errors
    /// Returns an error if a [sampled](crate::system::Sampled) controller has run again since.
    pub fn contact_forces<D: Dynamics<N, Scalar = T>>(
        &self,
        dynamics: &D,
    ) -> Result<Vec<Vec<T>>, ColumnError> {
        let count = <D::System as System<N>>::FACTS.limits.len();
        self.fresh(dynamics, "contact_forces")?;
        let rows = self.evaluate(dynamics, |phase, contacts| Pushed::new(phase, &contacts).forces);
        Ok(columns(&rows, count))
    }

    /// Returns the forces of the dry frictions at all output times: a column for each rate r, in the
    /// order of `FACTS.frictions`, positive if the force acts towards positive rates.
    ///
    /// The generalized force of a friction is φ ∂r/∂q̇: φ is a power per unit of r, and −φ r the
    /// heat. Where frictions that stick depend on each other, only the sum of their effects is
    /// determined; the later ones then have no force.
    ///
    /// Two states at the same time are treated as in [`energy`](Self::energy).
    ///
    /// # Errors
    /// Returns an error if a [sampled](crate::system::Sampled) controller has run again since.
    pub fn friction_forces<D: Dynamics<N, Scalar = T>>(
        &self,
        dynamics: &D,
    ) -> Result<Vec<Vec<T>>, ColumnError> {
        let count = <D::System as System<N>>::FACTS.frictions.len();
        self.fresh(dynamics, "friction_forces")?;
        let rows =
            self.evaluate(dynamics, |phase, contacts| Pushed::new(phase, &contacts).frictions);
        Ok(columns(&rows, count))
    }

    /// Returns one scalar of an output of the system at all output times: `"load"`, `"tip.x"`,
    /// `"tips[2].y"`. Accelerations and reactions in it include the forces of limits in contact.
    ///
    /// Two states at the same time are treated as in [`energy`](Self::energy).
    ///
    /// # Errors
    /// Returns an error for a name that no output has; the error contains the nearest name. Also
    /// returns an error for a system with a [sampled](crate::system::Sampled) controller that has
    /// run again since.
    pub fn output<D: Dynamics<N, Scalar = T>>(
        &self,
        dynamics: &D,
        name: &str,
    ) -> Result<Vec<T>, ColumnError> {
        let outputs = <D::System as System<N>>::FACTS.outputs;
        let (wanted, mut names) = (name::read(name), Vec::new());
        for (index, output) in outputs.iter().enumerate() {
            let own = output.names();
            if let Some(scalar) = own.iter().position(|own| name::read(own) == wanted) {
                self.fresh(dynamics, name)?;
                return Ok(self.scalars(dynamics, index).swap_remove(scalar));
            }
            names.extend(own);
        }
        let hint = "; coordinates and velocities come by `solution.column(name)`, the energy by \
                    `solution.energy(&system)`";
        Err(ColumnError::new(name, names.iter().map(String::as_str), hint))
    }

    /// Returns the scalars of the output with this index at all output times, one column per
    /// scalar.
    pub(super) fn scalars<D: Dynamics<N, Scalar = T>>(
        &self,
        dynamics: &D,
        index: usize,
    ) -> Vec<Vec<T>> {
        let count = <D::System as System<N>>::FACTS.outputs[index].count();
        let rows = self.evaluate(dynamics, |phase, contacts| {
            let inputs = phase.inputs(Purpose::Outputs);
            let mut values = vec![T::from_f64(0.0); count];
            let (system, at) = (dynamics.system(), phase.at(&inputs));
            if contacts.any() {
                let Pushed { accelerations: a, multipliers: λ, forces: μ, frictions: φ, .. } =
                    Pushed::new(phase, &contacts);
                system.output_of(index, at, &a, [&λ, &μ, &φ], &mut values);
            } else {
                system.output(index, at, &mut values);
            }
            values
        });
        columns(&rows, count)
    }

    /// Returns an error if a sampled controller does not have the samples of this solution, which
    /// the quantity `name` needs.
    pub(super) fn fresh<D: Dynamics<N, Scalar = T>>(
        &self,
        dynamics: &D,
        name: &str,
    ) -> Result<(), ColumnError> {
        if D::SAMPLED && RunNumber(dynamics.recorded()) != self.run {
            return Err(ColumnError::because(name, Reason::Stale));
        }
        Ok(())
    }

    /// Computes a value for each output time, from the state and the limits in contact.
    ///
    /// The side is `Before` if the next state has the same time.
    fn evaluate<D: Dynamics<N, Scalar = T>, U>(
        &self,
        dynamics: &D,
        value: impl Fn(&Phase<'_, D, N>, Contacts) -> U,
    ) -> Vec<U> {
        let one = |(index, state): (usize, State<T, N>)| {
            let kink = self.t.get(index + 1) == Some(&state.t);
            let side = if kink { Side::Before } else { Side::After };
            let contacts = self.contacts.get(index).copied().unwrap_or_default();
            let contacts = Contacts::from_bits(contacts);
            let t = Time::new(state.t);
            value(&Phase { dynamics, t, side, q: &state.q, v: &state.v }, contacts)
        };
        self.iter().enumerate().map(one).collect()
    }
}

/// Returns dE/dt at a state, with the power of the limits in contact and of the frictions.
pub(super) fn power<D: Dynamics<N, Scalar: Float>, const N: usize>(
    phase: &Phase<'_, D, N>,
    contacts: &Contacts,
) -> D::Scalar {
    let power = phase.dynamics.system().power(phase.at(&phase.inputs(Purpose::Power)));
    if contacts.any() { power + Pushed::new(phase, contacts).power(phase) } else { power }
}

/// Returns the first `count` columns of a list of rows.
fn columns<T: Copy>(rows: &[impl AsRef<[T]>], count: usize) -> Vec<Vec<T>> {
    (0..count).map(|index| rows.iter().map(|row| row.as_ref()[index]).collect()).collect()
}
