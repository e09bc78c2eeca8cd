//! Cart and pole
//!
//! A cart on a rail carries a pole that swings freely. The total momentum along the rail is
//! conserved, which the documentation of the struct says.

use crate::picture::{Frame, Picture};
use crate::prelude::*;

lagrangian! {
    pub struct CartPole { M: kg, m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate theta: rad;
    let bob = [x, 0] + L * [sin(theta), -cos(theta)];
    kinetic = M/2 * x_dot^2 + m/2 * |dot(bob)|^2;
    potential = m*g*height(bob);
}

fn motion() -> Result<Solution<f64, 2>> {
    let cart = CartPole::new(2.0, 1.0, 0.5);
    let motion = solve(&cart, (0.0, 6.0), [0.0, 2.6], [0.15, 0.0]).rtol(1e-9).every(0.01).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let frames = motion()?.q.into_iter().map(|[x, theta]| {
        let bob = [x + 0.5 * theta.sin(), -0.5 * theta.cos()];
        Frame::new([[x - 0.12, 0.0], [x + 0.12, 0.0], [x, 0.0], bob])
    });
    Ok(Picture::new(frames))
}
