//! Destinations of mapped values: reductions and lists.

use std::sync::{Mutex, PoisonError};

/// A reduction of mapped members, first within a shard, then between shards.
pub(super) trait Sink<R>: Sync {
    /// The reduction of consecutive members of a shard. Checkpoints store the reductions of whole
    /// shards.
    type Part: Send;

    /// The reduction of one or more shards.
    type Whole: Send;

    /// Returns the part without members.
    fn empty(&self) -> Self::Part;

    /// Adds the next member; `value` is `None` if the member failed.
    fn add(&self, part: Self::Part, index: usize, value: Option<R>) -> Self::Part;

    /// Converts the part of a finished shard.
    fn settle(&self, part: Self::Part) -> Self::Whole;

    /// Joins two reductions; the second has the greater indices.
    fn join(&self, first: Self::Whole, second: Self::Whole) -> Self::Whole;
}

/// A fold defined by three functions.
pub(super) struct Fold<I, A, M> {
    pub(super) identity: I,
    pub(super) add: A,
    pub(super) merge: M,
}

impl<R, P, I, A, M> Sink<R> for Fold<I, A, M>
where
    P: Send,
    I: Fn() -> P + Sync,
    A: Fn(P, R) -> P + Sync,
    M: Fn(P, P) -> P + Sync,
{
    type Part = P;
    type Whole = P;

    fn empty(&self) -> P {
        (self.identity)()
    }

    fn add(&self, part: P, _: usize, value: Option<R>) -> P {
        match value {
            Some(value) => (self.add)(part, value),
            None => part,
        }
    }

    fn settle(&self, part: P) -> P {
        part
    }

    fn join(&self, first: P, second: P) -> P {
        (self.merge)(first, second)
    }
}

/// The indices and values of the members that were solved.
pub(super) type Indexed<R> = Vec<(usize, R)>;

/// A sink that collects all members in a list.
pub(super) struct List;

impl<R: Send> Sink<R> for List {
    type Part = Indexed<R>;
    type Whole = Indexed<R>;

    fn empty(&self) -> Indexed<R> {
        Vec::new()
    }

    fn add(&self, mut part: Indexed<R>, index: usize, value: Option<R>) -> Indexed<R> {
        part.extend(value.map(|value| (index, value)));
        part
    }

    fn settle(&self, part: Indexed<R>) -> Indexed<R> {
        part
    }

    fn join(&self, mut first: Indexed<R>, second: Indexed<R>) -> Indexed<R> {
        first.extend(second);
        first
    }
}

/// A sink that passes each member of a finished shard to a function.
pub(super) struct Each<T> {
    pub(super) take: Mutex<T>,
}

impl<R: Send, T: FnMut(usize, R) + Send> Sink<R> for Each<T> {
    type Part = Indexed<R>;
    type Whole = ();

    fn empty(&self) -> Indexed<R> {
        List.empty()
    }

    fn add(&self, part: Indexed<R>, index: usize, value: Option<R>) -> Indexed<R> {
        List.add(part, index, value)
    }

    fn settle(&self, part: Indexed<R>) {
        let mut take = self.take.lock().unwrap_or_else(PoisonError::into_inner);
        for (index, value) in part {
            take(index, value);
        }
    }

    fn join(&self, (): (), (): ()) {}
}
