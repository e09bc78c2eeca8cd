//! Foucault's pendulum
//!
//! A long pendulum on a turning floor, for small swings, in the coordinates of somebody on the
//! floor: `cis(w*t)` turns them into those of a room at rest. Here the floor turns once while the
//! pendulum swings a dozen times.

use crate::picture::{Frame, Picture};
use crate::prelude::*;

lagrangian! {
    pub struct Foucault { m: kg, L: m, w: rad/s, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    let r = [x, y] * cis(w*t);
    kinetic = m/2 * |dot(r)|^2;
    potential = m*g/(2*L) * |r|^2;
}

fn motion() -> Result<Solution<f64, 2>> {
    let pendulum = Foucault::new(28.0, 67.0, 0.032);
    let motion =
        solve(&pendulum, (0.0, 196.0), [3.0, 0.0], [0.0; 2]).rtol(1e-9).every(0.4).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    Ok(Picture::new(motion()?.q.into_iter().map(|q| Frame::new([q]))))
}
