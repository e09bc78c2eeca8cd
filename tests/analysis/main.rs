//! Solutions as data, and further analyses of systems and motions.

#![allow(confusable_idents, mixed_script_confusables, missing_docs)]

mod bicycle;
mod columns;
mod columns_by_name;
mod equilibrium;
mod exponents;
mod modes;
mod outputs;
mod rotations;
mod sections;
mod sensitivities;
mod state_space;
mod variational;
mod work;
