//! The pendulums of one type: where each stands, and what a scene does with all of them.

pub(super) mod frequency;
pub(super) mod members;
pub(super) mod rest;
