//! A tall block that is let go on an edge: it rocks from corner to corner, loses a part of its
//! speed at each impact, and comes to rest. Columns in earthquakes move in this way, and furniture.
//!
//! `cargo run --release --example rocking` prints what each impact leaves of the speed beside the
//! formula of G. W. Housner, Bull. Seismol. Soc. Am. 53 (1963) 403, and draws the motion into
//! `target/rocking.svg`, on the left corner in blue, on the right one in orange.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::prelude::*;
use pictures::{Axis, Chart, Curve, Picture, color};
use std::error::Error;

lagrangian! {
    pub struct Block { m: kg, b: m, h: m, μ: 1, g: m/s^2 = 9.81 }
    coordinate p: [m; 2];
    coordinate θ: rad;
    let left  = p + [h*sin(θ) - b*cos(θ), -h*cos(θ) - b*sin(θ)];
    let right = p + [h*sin(θ) + b*cos(θ), -h*cos(θ) + b*sin(θ)];
    kinetic   = m/2*(|dot(p)|^2 + (b^2 + h^2)*θ̇^2/3);
    potential = m*g*p.y;
    limit heel: left.y  >= 0, restitution = 0, friction = μ along dot(left).x;
    limit toe:  right.y >= 0, restitution = 0, friction = μ along dot(right).x;
}

fn main() -> Result<(), Box<dyn Error>> {
    let block = Block::new(1.0, 0.2, 0.8, 0.5);
    let Block::<f64> { b, h, .. } = block;
    let α = (b / h).atan();
    // On its left corner, at the origin.
    let θ = 0.8 * α;
    let start = [b * θ.cos() - h * θ.sin(), b * θ.sin() + h * θ.cos(), θ];
    let run = solve(&block, (0.0, 10.0), start, [0.0; 3]).rtol(1e-10).dense().run()?;

    let formula = 1.0 - 1.5 * α.sin().powi(2);
    println!("     t in s   corner  speed after over before  Housner");
    for impact in run.impacts.iter().take(8) {
        let left = impact.after.v[2] / impact.state.v[2];
        println!("{:11.7}  {:6}  {left:23.10}  {formula:.10}", impact.time.to_f64(), impact.name);
    }
    println!("after {} impacts θ = {:.1e} rad", run.impacts.len(), run.end.q[2]);

    let (mut course, mut phase) = (
        Chart::new(Axis::linear("t in s"), Axis::linear("θ in rad")),
        Chart::new(Axis::linear("θ in rad"), Axis::linear("rate of θ in rad/s")),
    );
    let impacts = run.impacts.iter().map(|impact| impact.time.to_f64());
    let times: Vec<f64> = [0.0].into_iter().chain(impacts).chain([10.0]).collect();
    for pair in times.windows(2) {
        let inside = (1..100).map(|i| pair[0] + f64::from(i) / 100.0 * (pair[1] - pair[0]));
        let states: Vec<_> = inside.filter_map(|t| run.at(t).ok()).collect();
        let left = states.get(states.len() / 2).is_some_and(|state| 0.0 < state.q[2]);
        let color = if left { color::BLUE } else { color::ORANGE };
        course = course.curve(Curve::new(states.iter().map(|s| (s.t, s.q[2]))).color(color));
        phase = phase.curve(Curve::new(states.iter().map(|s| (s.q[2], s.v[2]))).color(color));
    }
    Picture::new("A block rocks on its left (blue) and right corner (orange)", (1000, 420))
        .chart(course)
        .chart(phase)
        .save("target/rocking.svg")?;
    println!("target/rocking.svg");
    Ok(())
}
