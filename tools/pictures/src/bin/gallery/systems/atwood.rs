//! Swinging machine of Atwood
//!
//! Two bodies on one rope over two pulleys; the lighter one may swing. Its swing holds the heavier
//! one up.

use crate::picture::{Frame, Picture};
use crate::prelude::*;

lagrangian! {
    pub struct Atwood { M: kg, m: kg, g: m/s^2 = 9.81 }
    coordinate r: m;
    coordinate theta: rad;
    let bob = r * [sin(theta), -cos(theta)];
    kinetic = M/2 * r_dot^2 + m/2 * |dot(bob)|^2;
    potential = M*g*r + m*g*height(bob);
}

fn motion() -> Result<Solution<f64, 2>> {
    let machine = Atwood::new(3.0, 1.0);
    let start = [1.0, 1.5];
    let motion = solve(&machine, (0.0, 8.0), start, [0.0; 2]).rtol(1e-10).every(0.015).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let frames = motion()?.q.into_iter().map(|[r, theta]| {
        let bob = [r * theta.sin(), -r * theta.cos()];
        Frame::new([[-1.2, -1.2 + r], [-1.2, 0.0], [0.0; 2], bob])
    });
    Ok(Picture::new(frames))
}
