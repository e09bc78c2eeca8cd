//! Jets: the Taylor coefficients of a motion, computed order by order.
//!
//! `lagrangian!` emits one recurrence for each operation of its equations (Jorba and Zou 2005); the
//! mass matrix is factored once for all orders. All series are in powers of the time since their
//! start: x(t₀ + h) = Σ x\[k\] hᵏ.

// Sums must be inlined to use an order that is known at compile time.
#![allow(clippy::inline_always)]

mod dynamics;
mod factors;
mod order;
mod path;
mod recurrences;
pub mod series;
mod sum;
#[cfg(test)]
mod tests;

pub use crate::motion::series::{InputSeries, LENGTH, MAX_ORDER, Series};
pub use dynamics::JetDynamics;
pub use factors::Factors;
pub use order::{Calling, Constant, First, Order, Running, Second};
pub use path::{Path, Reciprocals, Work};
pub use recurrences::{Called, Jets, Looped, Unrolled, Unrolling};
pub use sum::Pairs;
