//! Settings shared by many integrations.

use crate::integrate::events::Event;
use crate::integrate::output::Output;

/// The settings of the members of an [`Ensemble`](crate::ensemble::Ensemble).
#[derive(Clone, Debug)]
pub struct Settings<'a, T, const N: usize, C> {
    pub(crate) controller: C,
    pub(crate) output: Output<'a>,
    pub(crate) dense: bool,
    pub(crate) stops: &'a [f64],
    pub(crate) events: Vec<Event<'a, T, N>>,
    pub(crate) max_steps: u64,
}

impl<T, const N: usize, C> Settings<'_, T, N, C> {
    /// Creates the settings of a [`solve`](crate::integrate::solve) without further calls.
    pub(crate) fn new(controller: C) -> Self {
        Self {
            controller,
            output: Output::End,
            dense: false,
            stops: &[],
            events: Vec::new(),
            max_steps: 10_000_000,
        }
    }
}
