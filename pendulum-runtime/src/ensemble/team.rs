//! Other processes that take part in an ensemble.

/// Processes that share the shards of an ensemble, one of which is the root: what a library that
/// moves data between them implements, as the package `pendulum-mpi` does.
///
/// It stays on the thread that calls [`fold_in`](super::Mapped::fold_in).
pub trait Team {
    /// The side that all threads of this process see.
    type Desk: Desk;

    /// The side that all threads of this process see.
    fn desk(&self) -> &Self::Desk;

    /// Returns true in the process that gets the value.
    fn is_root(&self) -> bool;

    /// Moves data until this process is through, the root until all are: there `receive` takes the
    /// shards of others.
    fn serve(&self, receive: &mut dyn FnMut(usize, &[u8]));
}

/// The side of a [`Team`] that all threads of a process see.
pub trait Desk: Sync {
    /// The next shard that no process has begun, counted from 0; any number beyond the last, or
    /// `None`, ends it.
    fn take(&self) -> Option<usize>;

    /// Sends a finished shard to the root.
    fn send(&self, shard: usize, bytes: Vec<u8>);

    /// Tells [`Team::serve`] that all threads of this process are through.
    fn finish(&self);
}
