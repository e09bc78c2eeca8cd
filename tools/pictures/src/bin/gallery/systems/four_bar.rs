//! Four-bar linkage
//!
//! Three bars between two fixed pivots, closed by a constraint; its force is an output. `assemble`
//! finds a closed state near a guess.

use crate::picture::{Frame, Picture};
use crate::prelude::*;

lagrangian! {
    pub struct FourBar { l: [m; 3], d: m, m: [kg; 3], g: m/s^2 = 9.81 }
    coordinate alpha: rad;
    coordinate beta: rad;
    coordinate gamma: rad;
    let elbow = l[0]*cis(alpha);
    let tip = elbow + l[1]*cis(beta);
    kinetic = m[0]/6*l[0]^2*alpha_dot^2 + m[1]/2*|dot(elbow + l[1]/2*cis(beta))|^2
        + m[1]/24*l[1]^2*beta_dot^2 + m[2]/6*l[2]^2*gamma_dot^2;
    potential = g*(m[0]*height(elbow) + m[1]*height(elbow + tip) + m[2]*l[2]*sin(gamma))/2;
    constraint closed: tip = [d, 0] + l[2]*cis(gamma);
    output pull: [N; 2] = reaction(closed);
}

fn motion() -> Result<Solution<f64, 3>> {
    let bars = FourBar::new([0.4, 1.1, 0.8], 1.0, [0.5, 1.2, 0.7]);
    let start = assemble(&bars, 0.0, [1.0, 0.4, 1.8], [9.0, 0.0, 0.0]).hold("alpha").run()?;
    let motion = solve(&bars, (0.0, 4.0), start.q, start.v).rtol(1e-9).every(0.01).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let frames = motion()?.q.into_iter().map(|[alpha, beta, gamma]| {
        let elbow = [0.4 * alpha.cos(), 0.4 * alpha.sin()];
        let tip = [1.0 + 0.8 * gamma.cos(), 0.8 * gamma.sin()];
        // A point of the coupler, beside its middle.
        let side = [-0.3 * beta.sin(), 0.3 * beta.cos()];
        let point = [0, 1].map(|k| f64::midpoint(elbow[k], tip[k]) + side[k]);
        Frame::new([[0.0; 2], elbow, tip, [1.0, 0.0], tip, point, elbow, point])
    });
    Ok(Picture::new(frames))
}
