//! Groups: all pendulums of one type, with their places and the operations of a scene on all of
//! them.

pub(super) mod alone;
pub(super) mod any;
pub(super) mod carry;
pub(super) mod change;
pub(super) mod criterion;
pub(super) mod frequency;
pub(super) mod hung;
pub(super) mod members;
pub(super) mod rest;
pub(super) mod saved;
pub(super) mod sleep;
