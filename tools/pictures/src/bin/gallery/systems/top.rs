//! Heavy top
//!
//! A cone on its tip, in any attitude: it precesses and nods. The energy is an integral over the
//! solid, and the momenta about its axis and about the vertical are found. The picture shows the
//! path of the middle of its base.

use crate::picture::{Frame, Picture};
use crate::prelude::*;
use std::f64::consts::FRAC_PI_6;

lagrangian! {
    pub struct Top { B: solid, g: m/s^2 = 9.81 }
    coordinate R: rotation;
    kinetic = integral(p in B, |dot(R*p)|^2 / 2);
    potential = integral(p in B, g*height(R*p));
}

fn motion() -> Result<Solution<f64, 4>> {
    let top = Top::new(Solid::cone(0.2, 0.05, 0.1)?);
    let attitude = Attitude::from_axis_angle([1.0, 0.0, 0.0], 0.6);
    let start = Top::start().R(attitude, Rates::body([0.0, 0.0, 300.0]));
    let motion = solve(&top, (0.0, 2.0), start.q, start.v).rtol(1e-9).every(0.004).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let frames = motion()?.q.into_iter().map(|q| {
        let turn = Attitude::from_quaternion(q);
        let rim =
            (0..=12).map(|k| FRAC_PI_6 * f64::from(k)).map(|a| [0.5 * a.cos(), 0.5 * a.sin(), 1.0]);
        let line = [[0.0; 3]].into_iter().chain(rim).chain([[0.0; 3], [0.0, 0.0, 1.0]]);
        Frame::in_space(line.map(|point| turn * point), 0.0, 4.0)
    });
    Ok(Picture::new(frames))
}
