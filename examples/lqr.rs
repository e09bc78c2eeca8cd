//! A cart that swings its pole up and balances it, drawn in `target/lqr.svg`.
//!
//! Far from the top the force pumps energy into the pole (Åström and Furuta 2000); near the top a
//! linear quadratic regulator controls the cart. Its gain is the solution of Riccati's equation in
//! discrete time.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::analysis::state_space;
use pendulum_runtime::nalgebra::{Matrix4, RowVector4, SMatrix, Vector4};
use pendulum_runtime::prelude::*;
use pictures::{Chart, Curve, Picture, color};
use std::f64::consts::PI;

lagrangian! {
    #[derive(Clone)]
    pub struct CartPole { M: kg, m: kg, L: m, b: N*s/m, g: m/s^2 = 9.81 }
    coordinate s: m;
    coordinate θ: rad;
    input u: N;
    let tip = [s, 0] + L*[sin(θ), cos(θ)];
    kinetic = M/2*ṡ^2 + m/2*|dot(tip)|^2;
    potential = m*g*height(tip);
    dissipation = b/2*ṡ^2;
    force s = u;
    output tip: [m; 2] = tip;
}

/// Computes the gain of the regulator about the top for a period in seconds.
fn gain(cart: &CartPole, period: f64) -> Result<RowVector4<f64>, &'static str> {
    let model = state_space(&cart.clone().controlled_by(|_, _, _| 0.0), 0.0, &[0.0; 2], &[0.0; 2]);
    // A and B over a period, from the exponential of the matrix of both.
    let mut both = SMatrix::<f64, 5, 5>::zeros();
    both.view_mut((0, 0), (4, 4)).copy_from(&model.a);
    both.view_mut((0, 4), (4, 1)).copy_from(&model.b);
    let step = (both * period).exp();
    let (a, b) = (step.fixed_view::<4, 4>(0, 0), step.fixed_view::<4, 1>(0, 4));
    let (q, r) = (Matrix4::from_diagonal(&Vector4::new(2.0, 10.0, 0.1, 0.1)), 0.02);
    let mut p = q;
    for _ in 0..10_000 {
        let k = (b.transpose() * p * a) / (r + (b.transpose() * p * b)[0]);
        let next = q + a.transpose() * p * (a - b * k);
        if (next - p).norm() <= 1e-12 * next.norm() {
            return Ok(k);
        }
        p = next;
    }
    Err("Riccati's equation did not converge")
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (cart, period) = (CartPole::new(1.0, 0.2, 0.5, 0.1), 0.01);
    let (k, own) = (gain(&cart, period)?, cart.clone());
    let robot = cart.sampled(period, move |_, q, v| {
        let θ = (q[1] + PI).rem_euclid(2.0 * PI) - PI;
        if θ.abs() < 0.4 && v[1].abs() < 4.0 {
            return -(k * Vector4::new(q[0], θ, v[0], v[1]))[0];
        }
        // The missing energy of the pole. A force changes this energy in proportion to θ̇ cos θ.
        let lacks = own.m * own.L * (own.L * v[1] * v[1] / 2.0 + own.g * (θ.cos() - 1.0));
        (25.0 * lacks * v[1] * θ.cos()).clamp(-4.0, 4.0) - 2.0 * q[0] - v[0]
    });
    let run = solve(&robot, (0.0, 9.0), [0.0, PI], [0.0, 0.05]).rtol(1e-9).every(0.02).run()?;
    let tips: Vec<[f64; 2]> =
        run.iter().map(|state| robot.tip(state.t, &state.q, &state.v)).collect();
    let mut chart = Chart::drawing().curve(Curve::new([(-1.1, 0.0), (1.1, 0.0)]).opacity(0.5));
    for (k, (q, &[x, y])) in run.q.iter().zip(&tips).enumerate() {
        let late = 0.1 + 0.6 * (k as f64 / run.len() as f64).powi(2);
        chart = chart.curve(Curve::new([(q[0], 0.0), (x, y)]).width(1.0).opacity(late));
    }
    let way = Curve::new(tips.iter().map(|&[x, y]| (x, y))).color(color::ORANGE);
    Picture::new("A cart swings its pole up and balances it", (960, 560))
        .chart(chart.curve(way))
        .save("target/lqr.svg")?;
    let [s, θ] = run.end.q;
    println!("{}\npole off by {:.0e} rad, cart by {s:.0e} m: target/lqr.svg", run.stats, θ.sin());
    if θ.cos() < 0.9999 { Err("the pole has fallen".into()) } else { Ok(()) }
}
