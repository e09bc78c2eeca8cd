//! Integrators: one file per method, and the parts that all methods share.
//!
//! [`solve`] integrates from start to end, [`Integrator`] step by step. A method that does not
//! support a system does not compile for it.
//!
//! | method | order | evaluations a step | steps | for |
//! |---|---|---|---|---|
//! | [`SymplecticEuler`] | 1 | 1 | fixed | a baseline |
//! | [`Leapfrog`] | 2 | 1 | fixed | velocity-free systems, animation |
//! | [`Srkn6b`] | 4 | 6 | fixed | velocity-free systems |
//! | [`Srkn14a`] | 6 | 14 | fixed | velocity-free systems, long runs, errors down to rounding |
//! | [`Dprkn12`] | 12 | 17 | adaptive | velocity-free systems, also written by hand, errors 1e-2 … rounding |
//! | [`Rk4`] | 4 | 4 | fixed | any system, animation |
//! | [`Gauss<S>`](Gauss) | 2S | implicit | fixed | any conservative system, long runs; stiff systems by Newton's method |
//! | [`Rattle<P>`](Rattle) | 2, 4, 6, 8 | 2, 6, 10, 18 | fixed | velocity-free systems with constraints of positions, long |
//! | [`Rodas4`] | 4 | 6 and the Jacobians | adaptive | stiff springs and dampers |
//! | [`Dop853`] | 8 | 12 | adaptive | any system, also written by hand, errors 1e-2 … 1e-13 |
//! | [`Picard`] | 16 | 4–7 sweeps, each of which evaluates all 8 nodes at once | adaptive | any generated system, errors 1e-2 … 1e-13: the fastest method for most systems |
//! | [`Taylor`] | 2 … 30 | the order of the step | adaptive | any generated system, errors 1e-5 … rounding |
//!
//! [`Batch`] integrates many motions of one system side by side with `Taylor`.
//!
//! [`Auto`], the default method of `solve`, chooses among the methods.
//!
//! Velocity-free systems have a constant mass matrix and accelerations that contain no velocity;
//! `lagrangian!` detects them. Adaptive methods can also take fixed steps. All methods sum the
//! state with compensation and store the time in two words.

pub mod method;

/// The methods, one per file.
pub(crate) mod methods {
    pub(crate) mod auto;
    pub(crate) mod dop853;
    pub(crate) mod dprkn12;
    pub(crate) mod gauss;
    pub(crate) mod leapfrog;
    pub(crate) mod picard;
    pub(crate) mod rattle;
    pub(crate) mod rk4;
    pub(crate) mod rodas4;
    pub(crate) mod srkn14a;
    pub(crate) mod srkn6b;
    pub(crate) mod symplectic_euler;
    pub(crate) mod taylor;

    /// The public names of the methods, for this module and for the prelude.
    pub(crate) mod names {
        pub use super::auto::Auto;
        pub use super::dop853::Dop853;
        pub use super::dprkn12::Dprkn12;
        pub use super::gauss::Gauss;
        pub use super::leapfrog::Leapfrog;
        pub use super::picard::Picard;
        pub use super::rattle::Rattle;
        pub use super::rk4::Rk4;
        pub use super::rodas4::Rodas4;
        pub use super::srkn6b::Srkn6b;
        pub use super::srkn14a::Srkn14a;
        pub use super::symplectic_euler::SymplecticEuler;
        pub use super::taylor::Taylor;
    }
}

/// Controllers of step sizes, for use in trait bounds.
pub mod controller {
    pub use super::step::controller::{Controller, ControllerState, StepContext};
}

/// The projection onto constraints, for programs that take steps of their own.
pub mod constraints {
    pub use super::step::projection::{misfit, nearest, start};
}

/// The steps of a motion with limits, for programs that keep the states of many motions themselves,
/// as scenes do.
pub mod limits {
    pub use super::step::integration::limited::{accelerations, advance, start};
    pub use super::step::meeting::{PARTS, stays_open};
    pub use super::step::standing::Standings;
}

mod assemble;
pub(crate) mod batch;
pub(crate) mod data;
pub(crate) mod events;
pub(crate) mod field;
mod integrator;
pub(crate) mod interpolant;
pub(crate) mod linear;
pub mod members;
mod observe;
pub(crate) mod output;
mod pace;
pub(crate) mod schemes;
pub(crate) mod settings;
mod solution;
mod solve;
pub(crate) mod state;
mod stats;
pub(crate) mod step;
pub(crate) mod times;

pub use assemble::{Assemble, assemble};
pub use batch::{Batch, Batched, Outcome, Problem};
pub use data::{ColumnError, LengthError, Table, Work};
pub use events::{Direction, Event, Occurrence, Status};
pub use field::response::impact;
pub use integrator::Integrator;
pub use methods::gauss::Newton;
pub use methods::names::*;
pub use methods::picard::LaneDynamics;
pub use observe::Step;
pub use schemes::splitting::Splitting;
pub use solution::{Failure, Solution, States};
pub use solve::{Solve, solve};
pub use state::State;
pub use state::impact::Impact;
pub use state::saved::Saved;
pub use state::slip::Slip;
pub use stats::{ConstraintStats, Extreme, Stats};
pub use step::adaptive::AdaptiveStep;
pub use step::fixed::FixedStep;
