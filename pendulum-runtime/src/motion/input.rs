//! The needs of a system of its inputs, driven and controlled.

use crate::motion::sample::Derivatives;

/// Needs of a system of one of its inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input {
    /// The name as written.
    pub name: &'static str,
    /// The number of components.
    pub components: usize,
    /// It is a control input, which has a position alone: the value that the controller gives.
    pub control: bool,
    /// Derivatives that accelerations and forces need.
    pub accelerations: Derivatives,
    /// Derivatives that momenta, velocities and momentum rates need.
    pub momenta: Derivatives,
    /// Derivatives that the energy needs.
    pub energy: Derivatives,
    /// Derivatives that the power needs.
    pub power: Derivatives,
    /// Derivatives that the outputs need.
    pub outputs: Derivatives,
}

/// The output for which a driven input is sampled.
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
    /// The derivatives that `purpose` needs.
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
