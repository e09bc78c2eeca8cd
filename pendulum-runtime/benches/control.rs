//! The cost of feedback by a closure compared to the same law in the Lagrangian: `cargo bench -p
//! pendulum-runtime --bench control`.
//!
//! Both variants run alternately; the figures are the medians of their times.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::prelude::*;
use std::hint::black_box;
use std::time::Instant;

lagrangian! {
    pub struct Arm { m: [kg; 2], l: [m; 2], g: m/s^2 = 9.81 }
    coordinate θ[2]: rad;
    input τ: [N*m; 2];
    let y[k in 0..2] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..2, m[k]/2*|ẏ[k]|^2);
    potential = sum(k in 0..2, m[k]*g*height(y[k]));
    force θ[0] = τ.x;
    force θ[1] = τ.y;
}

lagrangian! {
    pub struct Written { m: [kg; 2], l: [m; 2], p: N*m, d: N*m*s, g: m/s^2 = 9.81 }
    coordinate θ[2]: rad;
    let y[k in 0..2] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..2, m[k]/2*|ẏ[k]|^2);
    potential = sum(k in 0..2, m[k]*g*height(y[k]));
    force θ[k in 0..2] = p*(1 - θ[k]) - d*θ̇[k];
}

const START: ([f64; 2], [f64; 2]) = ([0.3, -1.0], [0.0, 2.0]);

macro_rules! compare {
    ($name:literal, $method:expr, $rtol:expr) => {{
        let arm = Arm::new([1.0, 0.7], [0.6, 0.4])
            .controlled_by(|_, q, v| [0, 1].map(|k| 3.0 * (1.0 - q[k]) - 0.2 * v[k]));
        let written = Written::new([1.0, 0.7], [0.6, 0.4], 3.0, 0.2);
        let mut times = [Vec::new(), Vec::new()];
        let mut ends = [[0.0; 2]; 2];
        for _ in 0..31 {
            let start = Instant::now();
            let run = solve(black_box(&arm), (0.0, 20.0), START.0, START.1);
            ends[0] = run.method($method).rtol($rtol).run().unwrap().end.q;
            times[0].push(start.elapsed().as_secs_f64());
            let start = Instant::now();
            let run = solve(black_box(&written), (0.0, 20.0), START.0, START.1);
            ends[1] = run.method($method).rtol($rtol).run().unwrap().end.q;
            times[1].push(start.elapsed().as_secs_f64());
        }
        let median = |times: &mut Vec<f64>| {
            times.sort_by(f64::total_cmp);
            times[times.len() / 2] * 1e6
        };
        let [closure, own] = times.each_mut().map(median);
        let apart = (0..2).map(|i| (ends[0][i] - ends[1][i]).abs()).fold(0.0, f64::max);
        println!(
            "{:8} rtol {:.0e}: closure {closure:8.1} µs, written {own:8.1} µs, ratio {:.2}, ends apart by {apart:.0e}",
            $name,
            $rtol,
            closure / own
        );
    }};
}

fn main() {
    for rtol in [1e-6, 1e-9, 1e-12] {
        compare!("Dop853", Dop853, rtol);
        compare!("Picard", Picard, rtol);
        compare!("Rodas4", Rodas4, f64::max(rtol, 1e-6));
    }
}
