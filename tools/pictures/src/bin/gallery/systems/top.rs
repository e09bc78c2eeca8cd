//! Heavy top
//!
//! A symmetric top whose tip stays where it is, in Euler's angles: it precesses and nods. Two
//! momenta are conserved. The picture shows the path of the upper end of its axis.

use crate::picture::{Frame, Picture, seen};
use crate::prelude::*;

lagrangian! {
    pub struct Top { I: kg*m^2, J: kg*m^2, m: kg, l: m, g: m/s^2 = 9.81 }
    coordinate theta: rad;
    coordinate phi: rad;
    coordinate psi: rad;
    kinetic = I/2 * (theta_dot^2 + phi_dot^2*sin(theta)^2)
        + J/2 * (psi_dot + phi_dot*cos(theta))^2;
    potential = m*g*l*cos(theta);
}

fn motion() -> Result<Solution<f64, 3>> {
    let top = Top::new(2e-3, 1e-3, 0.2, 0.08);
    let spin = [0.0, 0.0, 45.0];
    let motion = solve(&top, (0.0, 3.0), [0.6, 0.0, 0.0], spin).rtol(1e-9).every(0.005).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let frames = motion()?.q.into_iter().map(|[theta, phi, _]| {
        let axis = [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
        Frame::new([[0.0; 2], seen(axis)])
    });
    Ok(Picture::new(frames))
}
