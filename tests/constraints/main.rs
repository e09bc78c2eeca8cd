//! Constraints: generated functions against dual numbers and dense algebra, problems with known
//! digits and closed forms, limits.

#![allow(mixed_script_confusables, confusable_idents, missing_docs, uncommon_codepoints)]

pub mod assembly;
pub mod discs;
pub mod frictions;
pub mod generated;
pub mod heat;
pub mod limits;
pub mod moving_limits;
pub mod plates;
pub mod problems;
pub mod pushed;
pub mod rattle;
pub mod room;
pub mod rough;
pub mod small_motions;
pub mod strikes;
pub mod together;
pub mod wires;
