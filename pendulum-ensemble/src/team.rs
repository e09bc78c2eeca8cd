//! Teams: several processes that solve one ensemble.

/// A set of processes that share the shards of an ensemble; one process is the root. Libraries for
/// communication between processes can implement this trait, as the package `pendulum-mpi` does.
///
/// A team is used only on the thread that calls [`fold_in`](super::Mapped::fold_in).
pub trait Team {
    /// Returns the part of the team that is shared by all threads of this process.
    fn desk(&self) -> &dyn Desk;

    /// Returns `true` in the root, the process that gets the value.
    fn is_root(&self) -> bool;

    /// Transfers data until this process has finished; in the root, until all processes have
    /// finished. In the root, `receive` gets the index and the bytes of each shard of the other
    /// processes.
    fn serve(&self, receive: &mut dyn FnMut(usize, &[u8]));
}

/// The part of a [`Team`] that is shared by all threads of a process.
pub trait Desk: Sync {
    /// Returns the next shard that no process has started, counted from 0. An index beyond the last
    /// shard, or `None`, ends the work.
    fn take(&self) -> Option<usize>;

    /// Sends a finished shard to the root.
    fn send(&self, shard: usize, bytes: Vec<u8>);

    /// Informs [`Team::serve`] that all threads of this process have finished.
    fn finish(&self);
}
