//! Bead on a turning hoop
//!
//! A bead slides without friction on a hoop that turns about its vertical diameter. Above a speed
//! of √(g/R) the lowest point is no longer stable. The hoop has a known motion, so that the energy
//! is not conserved.

use crate::picture::{Frame, Picture, seen};
use crate::prelude::*;

lagrangian! {
    pub struct Bead { m: kg, R: m, w: rad/s, g: m/s^2 = 9.81 }
    coordinate theta: rad;
    let p = R * [sin(theta)*cos(w*t), sin(theta)*sin(w*t), -cos(theta)];
    kinetic = m/2 * |dot(p)|^2;
    potential = m*g*height(p);
}

fn motion() -> Result<Solution<f64, 1>> {
    let bead = Bead::new(0.1, 0.5, 6.0);
    let motion = solve(&bead, (0.0, 10.0), [0.2], [0.0]).rtol(1e-9).every(0.015).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let motion = motion()?;
    let frames = motion.t.iter().zip(&motion.q).map(|(t, &[theta])| {
        let (sin, cos) = (6.0 * t).sin_cos();
        let on_hoop = |angle: f64| seen([angle.sin() * cos, angle.sin() * sin, -angle.cos()]);
        let hoop =
            (0..=18).map(|k| on_hoop(theta + f64::from(k - 18) * core::f64::consts::TAU / 18.0));
        Frame::new(hoop)
    });
    Ok(Picture::new(frames))
}
