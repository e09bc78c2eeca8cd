//! Columns of a solution: coordinates and velocities by name, energies along the motion.

use super::pushed::Pushed;
use crate::integrate::field::contacts::Contacts;
use crate::integrate::solution::{RunNumber, Solution};
use crate::integrate::state::State;
use crate::motion::Side;
use crate::scalar::Float;
use crate::system::label::Label;
use crate::system::name::{self, Name};
use crate::system::{Dynamics, Purpose, System, scalar_time};
use crate::time::Time;
use core::fmt;

/// Reason for which a solution has no column of a name.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ColumnError {
    /// The name asked for.
    pub name: String,
    /// The nearest name, if one is near enough to be meant.
    pub nearest: Option<String>,
    /// The names of all columns.
    pub columns: Vec<String>,
    /// The calls that give other quantities.
    hint: &'static str,
    /// True if the name is right and the values are gone.
    stale: bool,
}

/// The greatest number of names that a message lists.
const LISTED: usize = 12;

impl ColumnError {
    /// The error for a name that none of `columns` has; `hint` tells which calls give the rest.
    pub(super) fn new<'a>(
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
        Self { name: name.into(), nearest, columns, hint, stale: false }
    }

    /// The error for an output whose control inputs nobody has any more.
    fn stale(name: &str) -> Self {
        let name = name.into();
        Self { name, nearest: None, columns: Vec::new(), hint: "", stale: true }
    }

    /// The members of the family that the name is the name of.
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
        let Self { name, nearest, columns, hint, stale } = self;
        if *stale {
            return write!(
                f,
                "`{name}` needs the values of the sampled controller, which has not run or has run again since; ask before the next run, or clone the system for each run and ask the clone"
            );
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
    /// The names of all columns: `t`, the coordinates as written, the velocities with a dot, as
    /// `θ̇`, or with the suffix `_dot` where the block is in ASCII.
    pub fn column_names(&self) -> Vec<String> {
        self.labels.labels(N).names().map(String::from).collect()
    }

    /// The values of a coordinate, of a velocity or of the time `t` at all output times.
    ///
    /// Names are read as in a `lagrangian!` block: `"θ"` or `"theta"`; `"θ̇"`, `"theta_dot"` or
    /// `"dot(θ)"`; a member of a family as `"θ[2]"`, its velocity as `"θ̇[2]"` or `"theta_dot[2]"`.
    /// Coordinates without a name are `"q[0]"`, …, their velocities `"v[0]"`, ….
    ///
    /// # Errors
    /// A name that is none of them; the error has the nearest one.
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

    /// The accelerations q̈ at all output times, limits in contact included.
    ///
    /// At two states of the same time as [`energy`](Self::energy).
    ///
    /// Not numbers where a [sampled](crate::system::Sampled) controller has run again since.
    pub fn accelerations<D: Dynamics<N, Scalar = T>>(&self, dynamics: &D) -> Vec<[T; N]> {
        let stale = self.is_stale(dynamics);
        self.evaluate(|t, side, q, v, contacts| {
            if stale {
                return [T::from_f64(f64::NAN); N];
            }
            Pushed::new(dynamics, t, side, q, v, &contacts).accelerations
        })
    }

    /// The Jacobi integral q̇·∂L/∂q̇ − L at all output times, as
    /// [`Dynamics::energy_at`] gives it.
    ///
    /// Where two states have the same time, as [`every_step`](crate::integrate::Solve::every_step)
    /// gives them at a kink, driven inputs have their values before it for the first of them.
    pub fn energy<D: Dynamics<N, Scalar = T>>(&self, dynamics: &D) -> Vec<T> {
        self.evaluate(|t, side, q, v, _| {
            let inputs = dynamics.inputs_with(t, side, Purpose::Energy, q, v);
            dynamics.system().energy(scalar_time(t), q, v, &inputs)
        })
    }

    /// dE/dt at all output times: [`Dynamics::power_at`], less μ·∂h/∂t of the limits in contact.
    ///
    /// Its integral is the change of [`energy`](Self::energy), as ∫ power dt = E(t₁) − E(t₀), but
    /// for what impacts and events take away at once.
    ///
    /// At two states of the same time as [`energy`](Self::energy).
    ///
    /// Not numbers where a [sampled](crate::system::Sampled) controller has run again since.
    pub fn power<D: Dynamics<N, Scalar = T>>(&self, dynamics: &D) -> Vec<T> {
        let stale = self.is_stale(dynamics);
        self.evaluate(|t, side, q, v, contacts| {
            if stale {
                return T::from_f64(f64::NAN);
            }
            let inputs = dynamics.inputs_with(t, side, Purpose::Power, q, v);
            let power = dynamics.system().power(scalar_time(t), q, v, &inputs);
            if !contacts.any() {
                return power;
            }
            power + Pushed::new(dynamics, t, side, q, v, &contacts).power(dynamics, t, side, q)
        })
    }

    /// The conserved quantities of the system at all output times: a column for each name in
    /// `FACTS.conserved`, in this order.
    ///
    /// At two states of the same time as [`energy`](Self::energy).
    pub fn conserved<D: Dynamics<N, Scalar = T>>(&self, dynamics: &D) -> Vec<Vec<T>> {
        let count = <D::System as System<N>>::FACTS.conserved.len();
        let rows = self.evaluate(|t, side, q, v, _| {
            let inputs = dynamics.inputs(t, side, Purpose::Momenta);
            let mut values = vec![T::from_f64(0.0); count];
            dynamics.system().conserved(scalar_time(t), q, v, &inputs, &mut values);
            values
        });
        columns(&rows, count)
    }

    /// The multipliers λ of the constraints at all output times, limits in contact included: a
    /// column for each constraint that the equations hold, in the order of `FACTS.constraints`.
    ///
    /// At two states of the same time as [`energy`](Self::energy).
    ///
    /// Not numbers where a [sampled](crate::system::Sampled) controller has run again since.
    pub fn reactions<D: Dynamics<N, Scalar = T>>(&self, dynamics: &D) -> Vec<Vec<T>> {
        let count = <D::System as System<N>>::FACTS.held_constraints();
        if self.is_stale(dynamics) {
            return self.unknown(count);
        }
        let rows = self.evaluate(|t, side, q, v, contacts| {
            Pushed::new(dynamics, t, side, q, v, &contacts).multipliers
        });
        columns(&rows, count)
    }

    /// The multipliers μ ≥ 0 with which limits push at all output times, zero for those out of
    /// contact: a column for each limit h, in the order of `FACTS.limits`.
    ///
    /// The generalized force of a limit is μ ∂h/∂q: μ is an energy per unit of h. The impulses of
    /// impacts stand in [`impacts`](Self::impacts).
    ///
    /// At two states of the same time as [`energy`](Self::energy).
    ///
    /// Not numbers where a [sampled](crate::system::Sampled) controller has run again since.
    pub fn contact_forces<D: Dynamics<N, Scalar = T>>(&self, dynamics: &D) -> Vec<Vec<T>> {
        let count = <D::System as System<N>>::FACTS.limits.len();
        if self.is_stale(dynamics) {
            return self.unknown(count);
        }
        let rows = self.evaluate(|t, side, q, v, contacts| {
            Pushed::new(dynamics, t, side, q, v, &contacts).forces
        });
        columns(&rows, count)
    }

    /// One scalar of an output of the system at all output times: `"load"`, `"tip.x"`,
    /// `"tips[2].y"`. Accelerations and reactions in it have the forces of limits in contact.
    ///
    /// At two states of the same time as [`energy`](Self::energy).
    ///
    /// # Errors
    /// A name that no output has; the error has the nearest one. An output of a system with a
    /// [sampled](crate::system::Sampled) controller that has run again since.
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
                if self.is_stale(dynamics) {
                    return Err(ColumnError::stale(name));
                }
                return Ok(self.scalars(dynamics, index).swap_remove(scalar));
            }
            names.extend(own);
        }
        let hint = "; coordinates and velocities come by `solution.column(name)`, the energy by \
                    `solution.energy(&system)`";
        Err(ColumnError::new(name, names.iter().map(String::as_str), hint))
    }

    /// The scalars of the output with this index at all output times, a column for each.
    pub(super) fn scalars<D: Dynamics<N, Scalar = T>>(
        &self,
        dynamics: &D,
        index: usize,
    ) -> Vec<Vec<T>> {
        let count = <D::System as System<N>>::FACTS.outputs[index].count();
        if self.is_stale(dynamics) {
            return self.unknown(count);
        }
        let rows = self.evaluate(|t, side, q, v, contacts| {
            let inputs = dynamics.inputs_with(t, side, Purpose::Outputs, q, v);
            let mut values = vec![T::from_f64(0.0); count];
            let (system, time) = (dynamics.system(), scalar_time(t));
            if contacts.any() {
                let Pushed { accelerations: a, multipliers: λ, .. } =
                    Pushed::new(dynamics, t, side, q, v, &contacts);
                system.output_of(index, time, q, v, &a, &λ, &inputs, &mut values);
            } else {
                system.output(index, time, q, v, &inputs, &mut values);
            }
            values
        });
        columns(&rows, count)
    }

    /// Returns true if a sampled controller has not the samples of this solution.
    fn is_stale<D: Dynamics<N, Scalar = T>>(&self, dynamics: &D) -> bool {
        D::SAMPLED && RunNumber(dynamics.recorded()) != self.run
    }

    /// Columns of what is not a number.
    fn unknown(&self, count: usize) -> Vec<Vec<T>> {
        vec![vec![T::from_f64(f64::NAN); self.t.len()]; count]
    }

    /// A value for each output time, from the time, its side, the state and the limits in contact.
    ///
    /// The side is `Before` where the next state has the same time.
    fn evaluate<U>(&self, value: impl Fn(Time, Side, &[T; N], &[T; N], Contacts) -> U) -> Vec<U> {
        let one = |(index, state): (usize, State<T, N>)| {
            let kink = self.t.get(index + 1) == Some(&state.t);
            let side = if kink { Side::Before } else { Side::After };
            let contacts = self.contacts.get(index).copied().unwrap_or_default();
            let contacts = Contacts::from_bits(contacts);
            value(Time::new(state.t), side, &state.q, &state.v, contacts)
        };
        self.iter().enumerate().map(one).collect()
    }
}

/// The first `count` columns of a list of rows.
fn columns<T: Copy>(rows: &[impl AsRef<[T]>], count: usize) -> Vec<Vec<T>> {
    (0..count).map(|index| rows.iter().map(|row| row.as_ref()[index]).collect()).collect()
}
