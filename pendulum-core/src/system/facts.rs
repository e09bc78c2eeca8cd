//! Facts about a system that are known before it runs.

use crate::error::Coordinate;
use crate::motion::input::Input;
use crate::system::constraints::{Constraint, Friction, Limit};
use crate::system::inputs::Output;

/// Defines [`Facts`] from a list of fields, each with its value for unknown systems.
macro_rules! facts {
    ($($(#[$documentation:meta])* $visibility:vis $name:ident: $kind:ty = $unknown:expr,)+) => {
        /// Everything that `lagrangian!` derives about a system at compile time.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub struct Facts {
            $($(#[$documentation])* $visibility $name: $kind,)+
            /// `true` if `lagrangian!` generated the system, which implies that it has a mass
            /// matrix.
            pub(crate) derived: bool,
        }

        impl Facts {
            const UNKNOWN: Self = Self { $($name: $unknown,)+ derived: false };
        }

        /// All fields of [`Facts`], for code outside of this crate, to which `Facts` is
        /// non-exhaustive.
        #[derive(Clone, Copy, Debug)]
        #[allow(missing_docs)]
        pub struct Known {
            $(pub $name: $kind,)+
        }

        /// Creates the facts of a generated system.
        pub const fn facts(known: Known) -> Facts {
            Facts { $($name: known.$name,)+ derived: true }
        }
    };
}

facts! {
    /// The name of the struct.
    pub name: &'static str = "",
    /// The names of the coordinates in the source, followed by those of the states; a family is
    /// `θ[0]`, `θ[1]`, …, a vector `x.x`, `x.y`, ….
    pub coordinates: &'static [&'static str] = &[],
    /// The units of the coordinates in the source, empty if none is given.
    pub coordinate_units: &'static [&'static str] = &[],
    /// The number of states: of scalars whose `rate` is given. They are the last coordinates. Their
    /// places among the velocities and among the momenta hold their rates, and their diagonal
    /// entries in the mass matrix are one.
    pub states: usize = 0,
    /// `true` if the rate of a state contains a control input.
    pub controlled_rates: bool = false,
    /// The names of the parameters in the order of [`System::map`](crate::system::System::map); a
    /// vector is `c.x`, `c.y`, …, a family `m[0]`, ….
    pub parameters: &'static [&'static str] = &[],
    /// The units of the parameters in the source, empty if none is given.
    pub units: &'static [&'static str] = &[],
    /// The powers of the metre in the units of the parameters; `None` if a unit is neither given
    /// nor follows from others, or if a table has points with lengths.
    pub metres: &'static [Option<f64>] = &[],
    /// The driven inputs in the order of declaration, followed by the control inputs.
    pub inputs: &'static [Input] = &[],
    /// The outputs in the order of declaration.
    pub outputs: &'static [Output] = &[],
    /// The scalar constraints in the order of declaration: first the constraints that have
    /// multipliers, then the redundant ones.
    pub constraints: &'static [Constraint] = &[],
    /// The scalar limits in the order of declaration.
    pub limits: &'static [Limit] = &[],
    /// The scalar rates with dry friction in the order of declaration.
    pub frictions: &'static [Friction] = &[],
    /// The constraints whose reactions enter frictions by their size: the first multiplier of each
    /// and the number of its components.
    pub loads: &'static [[usize; 2]] = &[],
    /// `true` if the equations contain neither the time nor an input. The gaps of limits may
    /// contain them.
    pub autonomous: bool = false,
    /// `true` if the equations or the gaps of limits contain the time explicitly, not only through
    /// driven inputs.
    pub explicit_time: bool = true,
    /// `true` if the energy is T(p) + V(q, t): the mass matrix is constant, and no velocity
    /// multiplies a function of the coordinates.
    pub separable: bool = false,
    /// `true` if the accelerations contain no velocity.
    pub velocity_free: bool = false,
    /// `true` if the mass matrix contains neither coordinates, velocities nor time.
    pub constant_mass_matrix: bool = false,
    /// `true` if there is a `dissipation` or `force` statement, or a control input or a state in an
    /// energy.
    pub nonconservative: bool = true,
    /// `true` if the accelerations contain no table, and no `abs`, `sign`, `min` or `max` of a
    /// varying quantity.
    pub smooth: bool = false,
    /// The arguments of `sign`, `abs`, `min` and `max` in accelerations and limits, as text; that
    /// of `max(a, b)` is a − b. Steps end where one of them changes its sign. A table has several,
    /// which change their signs at its knots.
    pub switches: &'static [&'static str] = &[],
    /// The arguments of functions that change where the argument is of the order of one, such as
    /// `tanh`, as text. Steps are short enough to resolve these functions.
    pub layers: &'static [&'static str] = &[],
    /// `true` if the accelerations are linear in coordinates and velocities, with coefficients that
    /// depend only on parameters.
    pub linear: bool = false,
    /// The indices of the coordinates that do not occur in the Lagrangian.
    pub cyclic: &'static [usize] = &[],
    /// The conserved quantities that [`System::conserved`](crate::system::System::conserved)
    /// computes, in terms of the momenta: `p_φ`, `x·p_y − y·p_x`. The energy is not in this list.
    /// It is conserved if [`System::power`](crate::system::System::power) is zero, for example
    /// without `dissipation` and `force` if the energy contains neither time nor a driven input.
    pub conserved: &'static [&'static str] = &[],
    /// The parameters on which neither accelerations, constraints nor limits depend.
    pub unused: &'static [&'static str] = &[],
    /// The cost of an evaluation of the accelerations, in multiplications.
    pub cost: usize = 0,
    /// The equations of motion, one line per coordinate.
    pub equations: &'static str = "",
    /// The equations of motion in LaTeX, one line per coordinate.
    pub latex: &'static str = "",
}

impl Facts {
    /// Creates the facts of a system of which only the names are known.
    pub const fn new(name: &'static str, coordinates: &'static [&'static str]) -> Self {
        Self { name, coordinates, ..Self::UNKNOWN }
    }

    /// Returns the coordinate with this index, without a name if the facts do not list it.
    pub fn coordinate(&self, index: usize) -> Coordinate {
        Coordinate { index, name: self.coordinates.get(index).copied().unwrap_or("") }
    }

    /// Returns the number of constraints with multipliers; the redundant constraints come after
    /// them.
    pub const fn held_constraints(&self) -> usize {
        let mut index = 0;
        while index < self.constraints.len() && !self.constraints[index].redundant {
            index += 1;
        }
        index
    }

    /// Returns `true` if every constraint is the length of a `rotation`.
    pub(crate) const fn only_rotations(&self) -> bool {
        let mut index = 0;
        // The constraint of the rotation `R` is `|R|`, which is no name of a user's constraint.
        while index < self.constraints.len() && self.constraints[index].name.as_bytes()[0] == b'|' {
            index += 1;
        }
        index == self.constraints.len()
    }

    /// Returns the number of driven inputs; the control inputs come after them.
    pub(crate) const fn driven(&self) -> usize {
        let mut index = 0;
        while index < self.inputs.len() && !self.inputs[index].control {
            index += 1;
        }
        index
    }
}
