//! Integrators: one method a file, and around them what knows no method's name.
//!
//! [`solve`] integrates from start to end, [`Integrator`] step by step. A method that is wrong for
//! a system does not compile for it.
//!
//! | method | order | evaluations a step | steps | for |
//! |---|---|---|---|---|
//! | [`SymplecticEuler`] | 1 | 1 | fixed | a baseline |
//! | [`Leapfrog`] | 2 | 1 | fixed | velocity-free systems, animation |
//! | [`Srkn6b`] | 4 | 6 | fixed | velocity-free systems |
//! | [`Srkn14a`] | 6 | 14 | fixed | velocity-free systems, long, down to rounding |
//! | [`QuinlanTremaine<P>`](QuinlanTremaine) | 8, 10, 12 | 1 | fixed | velocity-free systems, long, the fewest evaluations for a given error |
//! | [`Dprkn8`] | 8 | 8 | adaptive | velocity-free systems, errors 1e-2 … 1e-5 |
//! | [`Dprkn12`] | 12 | 17 | adaptive | velocity-free systems, errors 1e-5 … rounding |
//! | [`Rk4`] | 4 | 4 | fixed | any system, animation |
//! | [`Gauss<S>`](Gauss) | 2S | implicit | fixed | any conservative system, long; stiff ones by Newton's method |
//! | [`Rodas4`] | 4 | 6 and the Jacobians | adaptive | stiff springs and dampers |
//! | [`Tsit5`] | 5 | 6 | adaptive | any system, errors 1e-2 … 1e-6 |
//! | [`Dop853`] | 8 | 12 | adaptive | any system, errors 1e-6 … 1e-13 |
//! | [`Picard`] | 16 | eight in one go, four to seven times | adaptive | any generated system, errors 1e-2 … 1e-13: the fastest of all for most |
//! | [`Taylor`] | 2 … 30 | its order | adaptive | any generated system, errors 1e-5 … rounding |
//!
//! [`Batch`] takes many motions of one system through `Taylor` side by side.
//!
//! [`Auto`], which `solve` uses unless told otherwise, chooses among them.
//!
//! Velocity-free are systems with a constant mass matrix whose accelerations contain no velocity;
//! `lagrangian!` knows them. Adaptive methods take fixed steps too. All of them sum the state with
//! compensation and keep the time in two words.

pub mod method;

/// Controllers of steps, for bounds on them.
pub mod controller {
    pub use super::step::controller::{
        Controller, ControllerState, StepContext, StepLaw, Trial, Verdict,
    };
}

mod assemble;
pub(crate) mod batch;
pub(crate) mod data;
pub(crate) mod events;
mod integrator;
pub(crate) mod interpolant;
pub(crate) mod methods;
mod observe;
pub(crate) mod output;
mod saved;
pub(crate) mod schemes;
pub(crate) mod settings;
mod solution;
mod solve;
mod state;
pub(crate) mod step;

pub use assemble::{Assemble, assemble};
pub use batch::{Batch, Batched, Outcome, Problem};
pub use data::{ColumnError, LengthError, Table};
pub use events::impact::impact;
pub use events::{Direction, Event, Occurrence, Status};
pub use integrator::{Integrator, StatesAt, Steps};
pub use methods::auto::Auto;
pub use methods::dop853::Dop853;
pub use methods::dprkn8::Dprkn8;
pub use methods::dprkn12::Dprkn12;
pub use methods::gauss::{Gauss, Newton, Sweeps};
pub use methods::leapfrog::Leapfrog;
pub use methods::picard::{LaneDynamics, Picard};
pub use methods::quinlan_tremaine::QuinlanTremaine;
pub use methods::rattle::Rattle;
pub use methods::rk4::Rk4;
pub use methods::rodas4::Rodas4;
pub use methods::srkn6b::Srkn6b;
pub use methods::srkn14a::Srkn14a;
pub use methods::symplectic_euler::SymplecticEuler;
pub use methods::taylor::Taylor;
pub use methods::tsit5::Tsit5;
pub use observe::Step;
pub use saved::Saved;
pub use solution::{Failure, Impact, Solution, States, Stats};
pub use solve::{Solve, solve};
pub use state::State;
pub use step::adaptive::AdaptiveStep;
pub use step::fixed::FixedStep;
