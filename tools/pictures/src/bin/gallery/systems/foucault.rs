//! Foucault's pendulum
//!
//! A long pendulum in the coordinates of somebody on the turning earth: x is north, y west and z
//! up. The earth turns it about its axis, and the plane of the swing turns with the sine of the
//! latitude. Here the earth turns once while the pendulum swings a dozen times.

use crate::picture::{Frame, Picture};
use crate::prelude::*;

lagrangian! {
    pub struct Foucault { m: kg, L: m, w: rad/s, latitude: rad, g: m/s^2 = 9.81 }
    coordinate p: [m; 3];
    let earth = rotation([cos(latitude), 0, sin(latitude)], w*t);
    kinetic = m/2 * |dot(earth*p)|^2;
    potential = m*g*height(p);
    constraint rod: |p| = L;
}

fn motion() -> Result<Solution<f64, 3>> {
    let pendulum = Foucault::new(28.0, 67.0, 0.032, 0.853);
    let down = -(67.0_f64.powi(2) - 9.0).sqrt();
    let motion =
        solve(&pendulum, (0.0, 196.0), [3.0, 0.0, down], [0.0; 3]).rtol(1e-9).every(0.4).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let frames = motion()?.q.into_iter().map(|[x, y, z]| {
        // The last metres of the wire.
        let line = [[0.94 * x, 0.94 * y, 0.94 * z + 67.0], [x, y, z + 67.0]];
        Frame::in_space(line, -0.5, 12.0)
    });
    Ok(Picture::new(frames))
}
