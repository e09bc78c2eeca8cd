//! What the zoo and the stress table have in common: runs on several threads, and measurements
//! against bars.

pub mod crowd;
pub mod report;
