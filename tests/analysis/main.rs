//! Solutions as data, and further analyses of systems and motions.

#![allow(confusable_idents, mixed_script_confusables, missing_docs)]

mod bicycle;
mod columns;
mod columns_by_name;
#[cfg(feature = "csv")]
mod csv;
mod equilibrium;
mod exponents;
mod modes;
mod outputs;
mod sections;
mod sensitivities;
#[cfg(feature = "serde")]
mod serde;
mod state_space;
mod variational;
mod work;
