//! Facts about a system that are known before it runs.

use crate::system::inputs::Input;

/// What `lagrangian!` knows about a system before it runs.
// Each is a fact of its own, not a state.
#[allow(clippy::struct_excessive_bools)]
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Facts {
    /// The name of the struct.
    pub name: &'static str,
    /// The coordinates as written, a family as `θ[0]`, `θ[1]`, ….
    pub coordinates: &'static [&'static str],
    /// The parameters in the order of [`System::map`], a vector as `c.x`, `c.y`, a family as
    /// `m[0]`, ….
    pub parameters: &'static [&'static str],
    /// The units of the parameters as written, empty where none was given.
    pub units: &'static [&'static str],
    /// The driven inputs in the order of declaration.
    pub inputs: &'static [Input],
    /// Neither time nor a driven input stands in the equations.
    pub autonomous: bool,
    /// The time itself stands in the equations, beside driven inputs.
    pub explicit_time: bool,
    /// The energy is T(p) + V(q, t): the mass matrix is constant and no velocity multiplies a
    /// function of the coordinates.
    pub separable: bool,
    /// The accelerations contain no velocity.
    pub velocity_free: bool,
    /// The mass matrix contains neither coordinates, velocities nor time.
    pub constant_mass_matrix: bool,
    /// There is a `dissipation` or `force` statement.
    pub nonconservative: bool,
    /// No `abs`, `sign`, `min` or `max` of something that moves stands in the accelerations.
    pub smooth: bool,
    /// The accelerations are linear in coordinates and velocities, with coefficients that the
    /// parameters alone decide.
    pub linear: bool,
    /// The coordinates that do not stand in the Lagrangian, by index.
    pub cyclic: &'static [usize],
    /// The conserved quantities that [`System::conserved`] gives, in terms of the momenta: `p_φ`,
    /// `x·p_y − y·p_x`. The energy is not among them; it is conserved where [`System::power`] is
    /// zero, as it is without `dissipation` and `force` if neither time nor a driven input stands
    /// in the energy.
    pub conserved: &'static [&'static str],
    /// The parameters that the accelerations do not need.
    pub unused: &'static [&'static str],
    /// The equations of motion, one line a coordinate.
    pub equations: &'static str,
    pub(crate) latex: &'static str,
    /// `lagrangian!` has made the system, so that it has a mass matrix.
    pub(crate) derived: bool,
}

impl Facts {
    /// The facts of a system about which nothing is known but its names.
    pub const fn new(name: &'static str, coordinates: &'static [&'static str]) -> Self {
        Self {
            name,
            coordinates,
            parameters: &[],
            units: &[],
            inputs: &[],
            autonomous: false,
            explicit_time: true,
            separable: false,
            velocity_free: false,
            constant_mass_matrix: false,
            nonconservative: true,
            smooth: false,
            linear: false,
            cyclic: &[],
            conserved: &[],
            unused: &[],
            equations: "",
            latex: "",
            derived: false,
        }
    }

    /// The equations of motion in LaTeX, one line a coordinate.
    pub const fn latex(&self) -> &'static str {
        self.latex
    }
}
