//! Settings of sleep.

use crate::scalar::{Float, Lane};
use crate::scene::error::SceneError;
use crate::scene::scene::Scene;

impl<T: Lane + Float> Scene<T> {
    /// Lets pendulums that hardly move fall asleep while their joints rest: a pendulum falls asleep
    /// if its energy does not suffice to move a coordinate by more than `tolerance` from the state
    /// of rest. A suitable tolerance moves the tip by half a pixel. With `None`, the initial value,
    /// pendulums do not sleep.
    ///
    /// A sleeping pendulum keeps its coordinates and is not computed. It wakes in the tick in which
    /// its joints move again, as given by [`rest_until`](crate::motion::Motion::rest_until), when
    /// one of its properties is changed, and by [`wake`](Self::wake). A pendulum never sleeps if it
    /// has no state of rest, if that state is not a minimum of its energy, if its equations depend
    /// explicitly on time, or if it has constraints.
    ///
    /// # Errors
    /// Returns an error if the tolerance is not positive and finite.
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

    /// Wakes all sleeping pendulums.
    pub(crate) fn wake_all(&mut self) {
        for (_, group) in &mut self.groups {
            group.wake_all();
        }
    }
}
