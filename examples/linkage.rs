//! Andrews' squeezing mechanism: seven bodies in three closed loops, driven by a motor.
//!
//! `cargo run --release --example linkage` writes `target/linkage.svg`: the mechanism at eight times
//! within 0.03 s, with the paths of its joints, and the error of each method over its time.

#![allow(mixed_script_confusables, confusable_idents, missing_docs)]

use pendulum_runtime::prelude::*;
use std::error::Error;
use std::fmt::Write;
use std::time::Instant;

lagrangian! {
    /// Hairer and Wanner, Solving Ordinary Differential Equations II (1996), section VII.7.
    pub struct Andrews {
        m: [kg; 7], J: [kg*m^2; 7], A: [m; 2], B: [m; 2], C: [m; 2],
        d: m = 0.028, da: m = 0.0115, e: m = 0.02, ea: m = 0.01421, zf: m = 0.02, fa: m = 0.01421,
        rr: m = 0.007, ra: m = 0.00092, ss: m = 0.035, sa: m = 0.01874, sb: m = 0.01043,
        sc: m = 0.018, sd: m = 0.02, zt: m = 0.04, ta: m = 0.02308, tb: m = 0.00916,
        u: m = 0.04, ua: m = 0.01228, ub: m = 0.00449, k: N/m = 4530, l: m = 0.07785,
        motor: N*m = 0.033,
    }
    coordinate β: rad;
    coordinate Θ: rad;
    coordinate γ: rad;
    coordinate Φ: rad;
    coordinate δ: rad;
    coordinate Ω: rad;
    coordinate ε: rad;
    let crank = rr*cis(β);
    let p = crank - d*cis(β + Θ);
    kinetic = (m[0]*ra^2 + J[0])/2*β̇^2 + m[1]/2*|dot(crank - da*cis(β + Θ))|^2
        + J[1]/2*(β̇ + Θ̇)^2 + (m[2]*(sa^2 + sb^2) + J[2])/2*γ̇^2
        + m[3]/2*|dot(zt*cis(δ) - i*(e - ea)*cis(Φ + δ))|^2 + J[3]/2*(Φ̇ + δ̇)^2
        + (m[4]*(ta^2 + tb^2) + J[4])/2*δ̇^2
        + m[5]/2*|dot((zf - fa)*cis(Ω + ε) - i*u*cis(ε))|^2 + J[5]/2*(Ω̇ + ε̇)^2
        + (m[6]*(ua^2 + ub^2) + J[6])/2*ε̇^2;
    let spring = B + (sd - i*sc)*cis(γ);
    potential = k/2*(|spring - C| - l)^2;
    force β = motor;
    constraint first: p + i*ss*cis(γ) = B;
    constraint second: p + i*e*cis(Φ + δ) - zt*cis(δ) = A;
    constraint third: p - zf*cis(Ω + ε) + i*u*cis(ε) = A;
    output crank_pin: [m; 2] = crank;
    output joint: [m; 2] = p;
    output left: [m; 2] = A + zt*cis(δ);
    output right: [m; 2] = A - i*u*cis(ε);
    output hook: [m; 2] = spring;
    output pull: N = |reaction(first)|;
}

const START: [f64; 7] = [
    -0.061713890014276450,
    0.0,
    0.45527981916307038,
    0.22266839016588588,
    0.48736497954384255,
    -0.22266839016588588,
    1.2305474445498212,
];
/// β at 0.03 s, to more digits than a double has.
const END: f64 = 15.810771195153707097;

fn mechanism() -> Andrews {
    let m = [0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498];
    let j = [2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5];
    Andrews::new(m, j, [-0.06934, -0.00227], [-0.03635, 0.03273], [0.014, 0.072])
}

/// Draws a state at a place of the picture.
fn draw(
    svg: &mut String,
    own: &Andrews,
    state: &State<f64, 7>,
    x: f64,
    y: f64,
) -> std::fmt::Result {
    let State { t, q, v } = state;
    let place = |p: [f64; 2]| format!("{:.1},{:.1}", x + 2600.0 * p[0], y - 2600.0 * p[1]);
    let bar = |points: &[[f64; 2]], color: &str| {
        let points: Vec<String> = points.iter().map(|&p| place(p)).collect();
        format!("<polyline points='{}' stroke='{color}'/>\n", points.join(" "))
    };
    let (pin, p) = (own.crank_pin(*t, q, v), own.joint(*t, q, v));
    let (left, right, hook) = (own.left(*t, q, v), own.right(*t, q, v), own.hook(*t, q, v));
    svg.push_str(&bar(&[own.C, hook], "#e9b44c"));
    svg.push_str(&bar(&[own.B, hook, p, own.B], "#5aa9e6"));
    svg.push_str(&bar(&[own.A, left, p], "#7fc8a9"));
    svg.push_str(&bar(&[own.A, right, p], "#c38d9e"));
    svg.push_str(&bar(&[[0.0; 2], pin, p], "#e27d60"));
    for fixed in [[0.0; 2], own.A, own.B, own.C] {
        let center = place(fixed);
        let (x, y) = center.split_once(',').unwrap_or_default();
        writeln!(svg, "<circle cx='{x}' cy='{y}' r='4' fill='#dfe6ee' stroke='none'/>")?;
    }
    let (x, y) = (x - 60.0, y + 95.0);
    writeln!(svg, "<text x='{x}' y='{y}' fill='#8a949e' stroke='none'>{:.1} ms</text>", 1e3 * t)
}

fn main() -> Result<(), Box<dyn Error>> {
    let own = mechanism();
    let run = || solve(&own, (0.0, 0.03), START, [0.0; 7]);
    let solution = run().rtol(1e-12).atol(1e-12).every(0.03 / 7.0).run()?;
    let mut svg = String::from(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1280 900' font-family='sans-serif' font-size='16'>\n\
         <rect width='1280' height='900' fill='#101418'/>\n\
         <g fill='none' stroke-width='4' stroke-linejoin='round' stroke-linecap='round'>\n",
    );
    for (k, state) in solution.iter().enumerate() {
        draw(
            &mut svg,
            &own,
            &state,
            240.0 + 300.0 * (k % 4) as f64,
            230.0 + 250.0 * (k / 4) as f64,
        )?;
    }
    svg.push_str("</g>\n");
    // The error of β over the time, least of several runs.
    let mut rows = Vec::new();
    macro_rules! curve {
        ($name:literal, $color:literal, $method:expr) => {{
            let mut points = Vec::new();
            for digits in 4..=12 {
                let rtol = 10f64.powi(-digits);
                let mut least = f64::INFINITY;
                let mut error = 0.0;
                for _ in 0..50 {
                    let clock = Instant::now();
                    let end = run().method($method).rtol(rtol).atol(rtol).run()?.end;
                    least = least.min(clock.elapsed().as_secs_f64());
                    error = (end.q[0] - END).abs().max(1e-15);
                }
                points.push((error, least));
            }
            let (error, time) = points[4];
            println!("{}: error {error:.0e} rad in {:.0} µs", $name, 1e6 * time);
            rows.push(($name, $color, points));
        }};
    }
    curve!("Picard", "#e27d60", Picard);
    curve!("Dop853", "#5aa9e6", Dop853);
    curve!("Taylor", "#7fc8a9", Taylor::new());
    let at = |(error, time): (f64, f64)| {
        (760.0 - 40.0 * (error.log10() + 8.0), 860.0 - 110.0 * (time / 5e-5).log10())
    };
    writeln!(svg, "<g fill='none' stroke-width='3'>")?;
    for (index, (name, color, points)) in rows.into_iter().enumerate() {
        let places: Vec<String> = points
            .into_iter()
            .map(|point| format!("{:.1},{:.1}", at(point).0, at(point).1))
            .collect();
        writeln!(svg, "<polyline points='{}' stroke='{color}'/>", places.join(" "))?;
        let y = 690 + 26 * index;
        writeln!(svg, "<text x='500' y='{y}' fill='{color}' stroke='none'>{name}</text>")?;
    }
    writeln!(
        svg,
        "</g>\n<g fill='#8a949e'><text x='640' y='892'>error of the crank: 1e-4 rad on the left, 1e-15 rad on the right</text>\n\
         <text x='560' y='860'>50 µs</text><text x='560' y='750'>0.5 ms</text>\n\
         <text x='30' y='700' fill='#dfe6ee' font-size='22'>Andrews' squeezing mechanism</text>\n\
         <text x='30' y='730'>seven bodies, three loops, one motor;</text>\n\
         <text x='30' y='752'>six constraints kept to rounding</text></g></svg>"
    )?;
    std::fs::write("target/linkage.svg", svg)?;
    println!("{}", solution.stats);
    let end = &solution.end;
    println!(
        "β = {:.12} rad at 0.03 s, the first loop pulls with {:.3} N; target/linkage.svg",
        end.q[0],
        own.pull(end.t, &end.q, &end.v)
    );
    Ok(())
}
