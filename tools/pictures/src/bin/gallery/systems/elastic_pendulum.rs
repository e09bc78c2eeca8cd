//! Elastic pendulum
//!
//! A bob on a spring. Where the spring is twice as fast as the swing, the energy wanders from one
//! to the other and back.

use crate::picture::{Frame, Picture};
use crate::prelude::*;

lagrangian! {
    pub struct ElasticPendulum { m: kg, k: N/m, L: m, g: m/s^2 = 9.81 }
    coordinate r: m;
    coordinate theta: rad;
    let bob = r * [sin(theta), -cos(theta)];
    kinetic = m/2 * |dot(bob)|^2;
    potential = m*g*height(bob) + k/2 * (r - L)^2;
}

fn motion() -> Result<Solution<f64, 2>> {
    let pendulum = ElasticPendulum::new(1.0, 29.43, 1.0);
    let motion =
        solve(&pendulum, (0.0, 30.0), [1.7, 0.1], [0.0; 2]).rtol(1e-9).every(0.03).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let frames = motion()?
        .q
        .into_iter()
        .map(|[r, theta]| Frame::new([[0.0; 2], [r * theta.sin(), -r * theta.cos()]]));
    Ok(Picture::new(frames))
}
