//! Facts about a system that are known before it runs.

use crate::motion::input::Input;
use crate::system::constraints::{Constraint, Limit};
use crate::system::inputs::Output;

/// Defines [`Facts`] from the list of all facts, each with its value where nothing is known.
macro_rules! facts {
    ($($(#[$documentation:meta])* $visibility:vis $name:ident: $kind:ty = $unknown:expr,)+) => {
        /// Everything that `lagrangian!` knows about a system before it runs.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub struct Facts {
            $($(#[$documentation])* $visibility $name: $kind,)+
            /// `lagrangian!` has made the system, so that it has a mass matrix.
            pub(crate) derived: bool,
        }

        impl Facts {
            const UNKNOWN: Self = Self { $($name: $unknown,)+ derived: false };
        }

        /// All fields of [`Facts`], for code outside of this crate that cannot name them all.
        #[derive(Clone, Copy, Debug)]
        #[allow(missing_docs)]
        pub struct Known {
            $(pub $name: $kind,)+
        }

        /// The facts of a generated system.
        pub const fn facts(known: Known) -> Facts {
            Facts { $($name: known.$name,)+ derived: true }
        }
    };
}

facts! {
    /// The name of the struct.
    pub name: &'static str = "",
    /// The coordinates as written, a family as `θ[0]`, `θ[1]`, ….
    pub coordinates: &'static [&'static str] = &[],
    /// The units of the coordinates as written, empty where none was given.
    pub coordinate_units: &'static [&'static str] = &[],
    /// The parameters in the order of [`System::map`](crate::system::System::map), a vector as
    /// `c.x`, `c.y`, a family as `m[0]`, ….
    pub parameters: &'static [&'static str] = &[],
    /// The units of the parameters as written, empty where none was given.
    pub units: &'static [&'static str] = &[],
    /// The driven inputs in the order of declaration, and after them the control inputs.
    pub inputs: &'static [Input] = &[],
    /// The outputs in the order of declaration.
    pub outputs: &'static [Output] = &[],
    /// The scalar constraints: those that the equations hold, in the order of declaration, and
    /// after them the redundant ones.
    pub constraints: &'static [Constraint] = &[],
    /// The scalar limits in the order of declaration.
    pub limits: &'static [Limit] = &[],
    /// Neither time nor an input stands in the equations.
    pub autonomous: bool = false,
    /// The time itself stands in the equations, beside driven inputs.
    pub explicit_time: bool = true,
    /// The energy is T(p) + V(q, t): the mass matrix is constant and no velocity multiplies a
    /// function of the coordinates.
    pub separable: bool = false,
    /// The accelerations contain no velocity.
    pub velocity_free: bool = false,
    /// The mass matrix contains neither coordinates, velocities nor time.
    pub constant_mass_matrix: bool = false,
    /// There is a `dissipation` or `force` statement, or a control input in an energy.
    pub nonconservative: bool = true,
    /// No `abs`, `sign`, `min` or `max` of something that moves stands in the accelerations.
    pub smooth: bool = false,
    /// The accelerations are linear in coordinates and velocities, with coefficients that the
    /// parameters alone decide.
    pub linear: bool = false,
    /// The coordinates that do not stand in the Lagrangian, by index.
    pub cyclic: &'static [usize] = &[],
    /// The conserved quantities that [`System::conserved`](crate::system::System::conserved) gives,
    /// in terms of the momenta: `p_φ`, `x·p_y − y·p_x`. The energy is not among them; it is
    /// conserved where [`System::power`](crate::system::System::power) is zero, as it is without
    /// `dissipation` and `force` if neither time nor a driven input stands in the energy.
    pub conserved: &'static [&'static str] = &[],
    /// The parameters that neither the accelerations nor the constraints and limits need.
    pub unused: &'static [&'static str] = &[],
    /// The equations of motion, one line a coordinate.
    pub equations: &'static str = "",
    /// The equations of motion in LaTeX, one line a coordinate.
    pub latex: &'static str = "",
}

impl Facts {
    /// The facts of a system about which nothing is known but its names.
    pub const fn new(name: &'static str, coordinates: &'static [&'static str]) -> Self {
        Self { name, coordinates, ..Self::UNKNOWN }
    }

    /// The number of constraints that the equations hold: redundant ones come after them.
    pub const fn held_constraints(&self) -> usize {
        let mut index = 0;
        while index < self.constraints.len() && !self.constraints[index].redundant {
            index += 1;
        }
        index
    }

    /// The number of driven inputs: the control inputs come after them.
    pub(crate) const fn driven(&self) -> usize {
        let mut index = 0;
        while index < self.inputs.len() && !self.inputs[index].control {
            index += 1;
        }
        index
    }
}
