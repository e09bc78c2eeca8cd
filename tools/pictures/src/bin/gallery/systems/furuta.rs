//! Furuta's pendulum
//!
//! An arm turns in the horizontal plane, with a pendulum at its end. A motor would turn the arm by
//! `input tau: N*m;` and `force phi = tau;`.

use crate::picture::{Frame, Picture, seen};
use crate::prelude::*;

lagrangian! {
    pub struct Furuta { I: kg*m^2, R: m, m: kg, l: m, g: m/s^2 = 9.81 }
    coordinate phi: rad;
    coordinate theta: rad;
    let elbow = R * [cos(phi), sin(phi), 0];
    let bob = elbow + l * [-sin(theta)*sin(phi), sin(theta)*cos(phi), -cos(theta)];
    kinetic = I/2 * phi_dot^2 + m/2 * |dot(bob)|^2;
    potential = m*g*height(bob);
}

fn motion() -> Result<Solution<f64, 2>> {
    let furuta = Furuta::new(0.01, 0.3, 0.1, 0.4);
    let motion =
        solve(&furuta, (0.0, 8.0), [0.0, 2.8], [0.6, 0.0]).rtol(1e-9).every(0.015).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let frames = motion()?.q.into_iter().map(|[phi, theta]| {
        let elbow = [0.3 * phi.cos(), 0.3 * phi.sin(), 0.0];
        let side = 0.4 * theta.sin();
        let down = -0.4 * theta.cos();
        let bob = [elbow[0] - side * phi.sin(), elbow[1] + side * phi.cos(), down];
        Frame::new([seen([0.0; 3]), seen(elbow), seen(bob)])
    });
    Ok(Picture::new(frames))
}
