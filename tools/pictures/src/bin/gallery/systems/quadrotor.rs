//! Quadrotor
//!
//! Four rotors push along the axis of their frame, and turn it by the differences of their thrusts.
//! A feedback law pulls it home from where somebody threw it, on its side. The same law as a
//! program of a flight computer is `.sampled(0.005, law)`.

use crate::picture::{Frame, Picture};
use crate::prelude::*;

lagrangian! {
    pub struct Quadrotor { m: kg, J: [kg*m^2; 3, 3], l: m, k: m, g: m/s^2 = 9.81 }
    coordinate x: [m; 3];
    coordinate R: rotation;
    input f: [N; 4];
    let r(p) = x + R*p;
    let w = transpose(R)*angular_velocity(R);
    kinetic = m/2*|dot(x)|^2 + inner(w, J*w)/2;
    potential = m*g*height(x);
    force r([l, 0, 0]) = f[0]*(R*[0, 0, 1]);
    force r([0, l, 0]) = f[1]*(R*[0, 0, 1]);
    force r([-l, 0, 0]) = f[2]*(R*[0, 0, 1]);
    force r([0, -l, 0]) = f[3]*(R*[0, 0, 1]);
    torque R = k*(f[0] - f[1] + f[2] - f[3])*(R*[0, 0, 1]);
}

fn motion() -> Result<Solution<f64, 7>> {
    let law = |_: f64, q: &[f64; 7], v: &[f64; 7]| {
        let [turn, rates] = [q, v].map(|all| [all[3], all[4], all[5], all[6]]);
        let turn = Attitude::from_quaternion(turn);
        let rates = Rates::from_derivative(turn, rates).in_body(turn);
        // The force that is wanted, along the axes of the frame.
        let [a, b, c] = [0, 1, 2].map(|k| -1.8 * q[k] - 2.4 * v[k]);
        let [x, y, z] = turn.inverse() * [a, b, c + 1.2 * 9.81];
        let size = (x * x + y * y + z * z).sqrt();
        let (roll, pitch) = (-y / size - 0.15 * rates[0], x / size - 0.15 * rates[1]);
        let (lift, yaw) = (z / 4.0, -2.0 * rates[2]);
        [
            lift - 2.0 * pitch + yaw,
            lift + 2.0 * roll - yaw,
            lift + 2.0 * pitch + yaw,
            lift - 2.0 * roll - yaw,
        ]
    };
    let moments = [0.012, 0.012, 0.024, 0.0, 0.0, 0.0];
    let drone = Quadrotor::new(1.2, moments, 0.25, 0.02).controlled_by(law);
    let tilted = Attitude::from_axis_angle([0.0, 1.0, 0.0], -1.5);
    let start = Quadrotor::start()
        .x([1.6, 0.8, -0.5], [-1.0, 2.0, 3.0])
        .R(tilted, Rates::body([0.0, 0.0, 4.0]));
    let motion = solve(&drone, (0.0, 6.0), start.q, start.v).rtol(1e-9).every(0.01).run()?;
    Ok(motion)
}

pub(crate) fn picture() -> Result<Picture> {
    let l = 0.25;
    let arms = [[l, 0.0], [-l, 0.0], [0.0; 2], [0.0, l], [0.0, -l], [0.0; 2]];
    let frames = motion()?.q.into_iter().map(|[x, y, z, turn @ ..]| {
        let turn = Attitude::from_quaternion(turn);
        let line = arms.map(|[a, b]| {
            let [u, v, w] = turn * [a, b, 0.0];
            [x + u, y + v, z + w]
        });
        Frame::in_space(line, -1.0, 6.0)
    });
    Ok(Picture::new(frames))
}
