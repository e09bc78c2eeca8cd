//! The methods: digits, orders, stops and conserved quantities.

#![allow(mixed_script_confusables, missing_docs)]

pub mod acts;
pub mod arguments;
pub mod around;
pub mod auto;
pub mod back;
pub mod barely;
pub mod batch;
pub mod control;
pub mod extremes;
pub mod far;
pub mod fast_drive;
pub mod gauss;
pub mod kicks;
pub mod known;
pub mod listed;
pub mod picard;
pub mod problems;
pub mod saved;
pub mod stiff;
pub mod taylor;
pub mod tiny;
pub mod tolerances;
