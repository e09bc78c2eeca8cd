//! Driven and controlled inputs of a system.

use crate::motion::sample::Derivatives;

/// An input of a system and the derivatives of it that the functions of the system need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input {
    /// The name in the source.
    pub name: &'static str,
    /// The number of components.
    pub components: usize,
    /// `true` for a control input. A control input has a position only: the value from the
    /// controller.
    pub control: bool,
    /// The derivatives that accelerations and forces need.
    pub accelerations: Derivatives,
    /// The derivatives that momenta, velocities and momentum rates need.
    pub momenta: Derivatives,
    /// The derivatives that the energy needs.
    pub energy: Derivatives,
    /// The derivatives that the power needs.
    pub power: Derivatives,
    /// The derivatives that the outputs need.
    pub outputs: Derivatives,
}

/// The function of a system for which its inputs are sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Purpose {
    /// [`System::accelerations`](crate::system::System::accelerations) and
    /// [`System::forces`](crate::system::System::forces).
    Accelerations,
    /// [`System::momenta`](crate::system::System::momenta),
    /// [`System::velocities`](crate::system::System::velocities),
    /// [`System::momentum_rates`](crate::system::System::momentum_rates) and
    /// [`System::mass_matrix`](crate::system::System::mass_matrix).
    Momenta,
    /// [`System::energy`](crate::system::System::energy) and the two energies of
    /// [`SplitEnergy`](crate::system::SplitEnergy).
    Energy,
    /// [`System::power`](crate::system::System::power).
    Power,
    /// [`System::output`](crate::system::System::output).
    Outputs,
}

impl Input {
    /// Returns the derivatives that `purpose` needs.
    pub const fn derivatives(&self, purpose: Purpose) -> Derivatives {
        match purpose {
            Purpose::Accelerations => self.accelerations,
            Purpose::Momenta => self.momenta,
            Purpose::Energy => self.energy,
            Purpose::Power => self.power,
            Purpose::Outputs => self.outputs,
        }
    }
}
