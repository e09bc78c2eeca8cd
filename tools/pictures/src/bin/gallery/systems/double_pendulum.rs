//! Double pendulum
//!
//! Two rods without mass, each with a bob at its end. Positions are written in Cartesian
//! coordinates; `lagrangian!` finds the angles that matter. Small differences at the start grow
//! by a factor of ten within a second or two.

use crate::picture::{Frame, Picture};
use crate::prelude::*;

lagrangian! {
    pub struct DoublePendulum { m: [kg; 2], l: [m; 2], g: m/s^2 = 9.81 }
    coordinate theta[2]: rad;
    let bob[k in 0..2] = sum(j in 0..=k, l[j] * [sin(theta[j]), -cos(theta[j])]);
    kinetic = sum(k in 0..2, m[k]/2 * |dot(bob[k])|^2);
    potential = sum(k in 0..2, m[k]*g*height(bob[k]));
}

fn motion() -> Result<Solution<f64, 2>> {
    let pendulum = DoublePendulum::new([1.0, 0.6], [1.0, 0.8]);
    let motion =
        solve(&pendulum, (0.0, 12.0), [2.2, 1.6], [0.0; 2]).rtol(1e-9).every(0.02).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let frames = motion()?.q.into_iter().map(|[a, b]| {
        let knee = [a.sin(), -a.cos()];
        Frame::new([[0.0; 2], knee, [knee[0] + 0.8 * b.sin(), knee[1] - 0.8 * b.cos()]])
    });
    Ok(Picture::new(frames))
}
