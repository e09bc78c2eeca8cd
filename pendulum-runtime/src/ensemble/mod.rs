//! Ensembles: many motions of one type of system, made from their index, solved in parallel and
//! reduced to what is wanted of them.
//!
//! [`Ensemble::new`] takes the indices and a function that makes problem k from k alone; nothing is
//! stored. [`map`](Ensemble::map) takes of each solution what is wanted, on the thread that solved
//! it, and [`reduce`](Mapped::reduce), [`fold`](Mapped::fold), [`collect`](Mapped::collect) or
//! [`for_each`](Mapped::for_each) put it together. The memory of a reduction does not depend on the
//! number of members.
//!
//! # The same bits
//!
//! Members come in shards of consecutive indices; their size is a function of the number of
//! members, or set by [`shard`](Ensemble::shard). Each shard is reduced in the order of its
//! indices, and shards are joined with their sibling in a binary tree over the index. The result
//! therefore has the same bits on any number of threads, of processes and of runs it was
//! interrupted into. Random numbers should come from the index, too, by a generator that
//! counts.
//!
//! # The way through
//!
//! | systems | way |
//! |---|---|
//! | generated, without control inputs, constraints and limits, smooth, driven by [`Analytic`](crate::motion::Analytic) motions if at all; no event that acts, no `t_stops` | side by side in the lanes of [`Batch`](crate::integrate::Batch), by [`Taylor`](crate::integrate::Taylor) |
//! | all others that `lagrangian!` has made | one by one, by [`Auto`](crate::integrate::Auto) |
//! | written by hand | one by one, by a method that is named |
//!
//! [`method`](Ensemble::method) goes one by one through the method that it names.
//!
//! # Threads
//!
//! With the feature `rayon` all threads of the pool take part, each with lanes of its own:
//! `ThreadPool::install` chooses another pool. Without the feature there is one thread.

mod builder;
mod checkpoint;
mod error;
mod gathered;
mod mapped;
mod record;
mod shard;
mod shards;
mod sink;
mod team;
mod threads;
mod tree;
mod way;

pub use builder::Ensemble;
pub use checkpoint::{Folder, Keep, Nowhere};
pub use error::EnsembleError;
pub use gathered::{FailedMember, Gathered, Progress, Tally};
pub use mapped::Mapped;
pub use record::Record;
pub use team::{Desk, Team};
pub use way::{Chosen, OneByOne, Way, WayDynamics};
