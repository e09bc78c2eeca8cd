//! Charged particle
//!
//! A particle in a uniform magnetic field and an electric field across it. The Lagrangian does not
//! split into kinetic and potential energy: the vector potential stands beside the velocity. The
//! particle drifts at a right angle to both fields.

use crate::picture::{Frame, Picture};
use crate::prelude::*;

lagrangian! {
    pub struct Charge { m: kg, q: C, B: T, E: V/m }
    coordinate x: m;
    coordinate y: m;
    let A = B/2 * [-y, x];
    lagrangian = m/2 * (x_dot^2 + y_dot^2) + q*inner(A, [x_dot, y_dot]) + q*E*y;
}

fn motion() -> Result<Solution<f64, 2>> {
    let charge = Charge::new(1.0, 1.0, 1.0, 0.3);
    let motion = solve(&charge, (0.0, 32.0), [0.0; 2], [1.0, 0.0]).rtol(1e-9).every(0.06).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    Ok(Picture::new(motion()?.q.into_iter().map(|q| Frame::new([q]))))
}
