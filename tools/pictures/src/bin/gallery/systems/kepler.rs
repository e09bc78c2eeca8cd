//! Kepler's problem
//!
//! A planet around a sun that does not move. The angle does not stand in the equations, so that
//! its momentum is conserved, and the mass of the planet is not needed.

use crate::picture::{Frame, Picture};
use crate::prelude::*;

lagrangian! {
    pub struct Planet { m: kg, mu: m^3/s^2 }
    coordinate r: m;
    coordinate phi: rad;
    kinetic = m/2 * |dot(r * cis(phi))|^2;
    potential = -m*mu/r;
}

fn motion() -> Result<Solution<f64, 2>> {
    let planet = Planet::new(1.0, 1.0);
    // The nearest point of an ellipse with an eccentricity of 0.6.
    let motion = solve(&planet, (0.0, 6.3), [0.4, 0.0], [0.0, 5.0]).rtol(1e-9).every(0.02).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let frames =
        motion()?.q.into_iter().map(|[r, phi]| Frame::new([[r * phi.cos(), r * phi.sin()]]));
    Ok(Picture::new(frames).with_mark([0.0; 2]))
}
