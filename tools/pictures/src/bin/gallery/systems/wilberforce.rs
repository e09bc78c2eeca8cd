//! Wilberforce's pendulum
//!
//! A body hangs on a coil spring that turns as it stretches. The body moves up and down, then
//! turns, then moves up and down again. The picture shows the turn to the right and the height
//! upwards.

use crate::picture::{Frame, Picture};
use crate::prelude::*;

lagrangian! {
    pub struct Wilberforce { m: kg, I: kg*m^2, k: N/m, d: N*m, e: N }
    coordinate z: m;
    coordinate theta: rad;
    kinetic = m/2 * z_dot^2 + I/2 * theta_dot^2;
    potential = k/2 * z^2 + d/2 * theta^2 + e/2 * z*theta;
}

fn motion() -> Result<Solution<f64, 2>> {
    let body = Wilberforce::new(0.5, 1e-4, 5.0, 1e-3, 1e-2);
    let motion = solve(&body, (0.0, 40.0), [0.1, 0.0], [0.0; 2]).rtol(1e-9).every(0.05).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let frames = motion()?.q.into_iter().map(|[z, theta]| Frame::new([[theta / 7.0, z / 0.1]]));
    Ok(Picture::new(frames))
}
