//! The language: the results of generated code for blocks of every kind.

#![allow(confusable_idents, mixed_script_confusables, missing_docs)]

pub mod attitudes;
pub mod bodies;
pub mod chains;
pub mod conserved;
pub mod frictions;
pub mod high_precision;
pub mod jacobians;
pub mod jets;
pub mod kinks;
pub mod links;
pub mod modes;
pub mod momenta;
pub mod note;
pub mod outputs;
pub mod random_systems;
pub mod readme;
pub mod scale;
pub mod singular;
pub mod solids;
pub mod space;
pub mod stages;
pub mod states;
pub mod table_parameters;
pub mod tables;
pub mod vectors;
