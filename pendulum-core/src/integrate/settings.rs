//! Settings shared by many integrations.

use crate::integrate::events::Event;
use crate::integrate::output::Output;

/// The settings of a [`solve`](crate::integrate::solve), and of the members of an ensemble.
#[derive(Clone, Debug)]
pub struct Settings<'a, T, const N: usize, C> {
    /// The controller of the step sizes.
    pub controller: C,
    /// The states to store.
    pub output: Output<'a>,
    /// Whether to store the motion within each step.
    pub dense: bool,
    /// The times at which steps end.
    pub stops: &'a [f64],
    /// The events to detect.
    pub events: Vec<Event<'a, T, N>>,
    /// The number of steps after which a motion fails.
    pub max_steps: u64,
}

impl<'a, T, const N: usize, C> Settings<'a, T, N, C> {
    /// Creates the settings of a `solve` without further calls.
    pub fn new(controller: C) -> Self {
        Self {
            controller,
            output: Output::End,
            dense: false,
            stops: &[],
            events: Vec::new(),
            max_steps: 10_000_000,
        }
    }

    /// Returns the same settings with another controller.
    pub fn with<B>(self, controller: B) -> Settings<'a, T, N, B> {
        let Self { output, dense, stops, events, max_steps, .. } = self;
        Settings { controller, output, dense, stops, events, max_steps }
    }
}
