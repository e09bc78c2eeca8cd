//! Settings of sleep.

use crate::scalar::{Float, Lane};
use crate::scene::error::SceneError;
use crate::scene::scene::Scene;

impl<T: Lane + Float> Scene<T> {
    /// Lets pendulums sleep that hardly move: those whose energy would not lift any coordinate by
    /// more than `tolerance` from where they come to rest, while their joints rest too. Choose what
    /// moves the tip by half a pixel. `None`, as at first: nobody sleeps.
    ///
    /// A sleeper keeps its coordinates and costs nothing. It wakes with the tick in which its joint
    /// moves again, which the motion says [beforehand](crate::motion::Motion::rest_until), when
    /// something about it is changed, and when it is told to. A pendulum that comes to rest
    /// nowhere, or not at a minimum of its energy, or in whose equations the time itself stands,
    /// never sleeps.
    ///
    /// # Errors
    /// A tolerance that is not positive.
    pub fn set_sleep(&mut self, tolerance: Option<f64>) -> Result<(), SceneError> {
        if let Some(value) = tolerance
            && !(0.0 < value && value < f64::INFINITY)
        {
            return Err(SceneError::Setting { name: "sleep", value, required: "positive" });
        }
        self.sleep = tolerance;
        for (_, group) in &mut self.groups {
            group.forget_criteria();
        }
        if tolerance.is_none() {
            self.wake_all();
        }
        Ok(())
    }

    /// Wakes all that sleep.
    pub(crate) fn wake_all(&mut self) {
        for (_, group) in &mut self.groups {
            self.dirty |= group.wake_due(i64::MAX);
        }
    }
}
