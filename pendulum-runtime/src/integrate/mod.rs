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
//! | [`Srkn11b`] | 6 | 11 | fixed | velocity-free systems, long |
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
//! | [`Taylor`] | 2 … 30 | its order | adaptive, back in time too | any generated system, errors 1e-5 … rounding |
//!
//! [`Batch`] takes many motions of one system through `Taylor` side by side.
//!
//! [`Auto`], which `solve` uses unless told otherwise, chooses among them.
//!
//! Velocity-free are systems with a constant mass matrix whose accelerations contain no velocity;
//! `lagrangian!` knows them. Adaptive methods take fixed steps too. All of them sum the state with
//! compensation and keep the time in two words.

pub mod method;

mod adaptive_step;
mod auto;
mod batch;
pub(crate) mod blame;
mod control;
mod dense;
mod dop853;
mod dprkn12;
mod dprkn8;
mod driver;
mod event;
pub(crate) mod field;
mod fit;
mod fixed_step;
pub(crate) mod gap;
mod gauss;
mod hermite;
pub(crate) mod inertia;
mod integrator;
pub(crate) mod leapfrog;
mod linear;
mod multistep;
mod node;
mod nystrom;
mod output;
mod picard;
mod piece;
mod power;
mod quinlan_tremaine;
mod rk4;
mod rodas4;
mod root;
mod runge_kutta;
mod short;
mod solution;
mod solve;
pub(crate) mod span;
pub(crate) mod splitting;
mod srkn11b;
mod srkn14a;
pub(crate) mod srkn6b;
mod stepper;
pub(crate) mod sum;
mod symplectic_euler;
mod taylor;
mod tsit5;
mod watch;

pub use adaptive_step::AdaptiveStep;
pub use auto::Auto;
pub use batch::{Batch, Batched, Outcome, Problem};
pub use dop853::Dop853;
pub use dprkn8::Dprkn8;
pub use dprkn12::Dprkn12;
pub use event::{Direction, Event, Occurrence, Status};
pub use fixed_step::FixedStep;
pub use gauss::{Gauss, Newton, Sweeps};
pub use integrator::Integrator;
pub use leapfrog::Leapfrog;
pub use picard::{Picard, SideBySide};
pub use quinlan_tremaine::QuinlanTremaine;
pub use rk4::Rk4;
pub use rodas4::Rodas4;
pub use solution::{Failure, Solution, State, Stats};
pub use solve::{Solve, solve};
pub use srkn6b::Srkn6b;
pub use srkn11b::Srkn11b;
pub use srkn14a::Srkn14a;
pub use symplectic_euler::SymplecticEuler;
pub use taylor::Taylor;
pub use tsit5::Tsit5;

#[cfg(test)]
mod tests;
