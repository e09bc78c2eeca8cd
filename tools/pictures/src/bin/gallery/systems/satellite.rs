//! Satellite with wheels
//!
//! Three wheels in a satellite turn it: what they take from their motors, the satellite loses. A
//! feedback law points it towards the stars that it looks for. The angular momentum of everything
//! together stays, and is found.

use crate::picture::{Frame, Picture};
use crate::prelude::*;

lagrangian! {
    pub struct Satellite { B: solid, A: kg*m^2 }
    coordinate R: rotation;
    coordinate rho[3]: rad;
    input tau: [N*m; 3];
    let w = transpose(R)*angular_velocity(R);
    kinetic = integral(p in B, |dot(R*p)|^2 / 2)
        + A/2*|w + [rho_dot[0], rho_dot[1], rho_dot[2]]|^2;
    force rho[0] = tau.x;
    force rho[1] = tau.y;
    force rho[2] = tau.z;
}

fn motion() -> Result<Solution<f64, 7>> {
    let law = |_: f64, q: &[f64; 7], v: &[f64; 7]| {
        let [turn, rates] = [q, v].map(|all| [all[0], all[1], all[2], all[3]]);
        let turn = Attitude::from_quaternion(turn);
        let rates = Rates::from_derivative(turn, rates).in_body(turn);
        // What a wheel gets turns the satellite the other way.
        let [x, y, z] = turn.to_rotation_vector();
        [0.02 * x + 0.5 * rates[0], 0.02 * y + 0.5 * rates[1], 0.02 * z + 0.5 * rates[2]]
    };
    let satellite = Satellite::new(Solid::cuboid(30.0, [0.5, 1.6, 0.4])?, 0.02);
    let start = Satellite::start()
        .R(Attitude::from_axis_angle([1.0, 2.0, -1.0], 2.4), Rates::body([0.1, -0.05, 0.15]));
    let motion = solve(&satellite.controlled_by(law), (0.0, 120.0), start.q, start.v)
        .rtol(1e-9)
        .every(0.2)
        .run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let sheet = [[-0.2, 0.2], [-0.2, 1.0], [0.2, 1.0], [0.2, -1.0], [-0.2, -1.0], [-0.2, 0.2]];
    let sheet = sheet.map(|[x, y]| [x, y, 0.0]);
    let frames = motion()?.q.into_iter().map(|[w, x, y, z, ..]| {
        let turn = Attitude::from_quaternion([w, x, y, z]);
        let line = sheet.into_iter().chain([[0.2, 0.2, 0.0], [0.0; 3], [0.0, 0.0, 0.8]]);
        Frame::in_space(line.map(|point| turn * point), -1.2, 5.0)
    });
    Ok(Picture::new(frames))
}
