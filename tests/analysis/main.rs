//! Solutions as data, and what is computed from systems and motions beside the motion itself.

#![allow(mixed_script_confusables, missing_docs)]

mod columns;
#[cfg(feature = "csv")]
mod csv;
mod outputs;
#[cfg(feature = "serde")]
mod serde;
mod state_space;
