//! Dzhanibekov's handle
//!
//! A handle like a T floats and turns about its stem, the axis of its middle moment of inertia. It
//! turns over, again and again, although nothing acts on it. All three components of the angular
//! momentum are found.

use crate::picture::{Frame, Picture};
use crate::prelude::*;

lagrangian! {
    pub struct Handle { B: solid }
    coordinate R: rotation;
    kinetic = integral(p in B, |dot(R*p)|^2 / 2);
}

fn motion() -> Result<Solution<f64, 4>> {
    let bar = Solid::rod(2.0, [-0.1, -0.4, 0.0], [-0.1, 0.4, 0.0])?;
    let stem = Solid::rod(1.0, [-0.1, 0.0, 0.0], [0.5, 0.0, 0.0])?;
    let handle = Handle::new(Solid::compound([bar, stem])?);
    let upright = Attitude::from_directions([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let start = Handle::start().R(upright, Rates::body([7.0, 0.01, 0.01]));
    let motion = solve(&handle, (0.0, 12.0), start.q, start.v).rtol(1e-9).every(0.02).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let corners = [[-0.1, -0.4, 0.0], [-0.1, 0.4, 0.0], [-0.1, 0.0, 0.0], [0.5, 0.0, 0.0]];
    let frames = motion()?.q.into_iter().map(|q| {
        let turn = Attitude::from_quaternion(q);
        Frame::in_space(corners.map(|point| turn * point), -0.7, 3.0)
    });
    Ok(Picture::new(frames))
}
