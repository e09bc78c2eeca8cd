//! A method written outside of the crate: the Runge–Kutta pair of Bogacki and Shampine, with its
//! error estimate and its interpolant, beside `Dop853`.
//!
//! `cargo run --release --example own_method` prints errors and steps, and writes
//! `target/own-method.svg`.

#![allow(mixed_script_confusables, missing_docs)]

mod bogacki_shampine;
mod tableau;
#[cfg(test)]
mod tests;

use bogacki_shampine::BogackiShampine;
use pendulum_runtime::integrate::Event;
use pendulum_runtime::prelude::*;
use pictures::{Axis, Chart, Curve, Picture, color};

lagrangian! {
    pub struct Pendulum { L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    let r = L*[sin(θ), -cos(θ)];
    kinetic = |ṙ|^2/2;
    potential = g*height(r);
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let pendulum = Pendulum::new(0.5);
    let run = || solve(&pendulum, (0.0, 10.0), [1.3], [0.0]);
    let exact = run().rtol(1e-13).dense().run()?;
    // The largest error at 1001 times, and the number of steps.
    let measured = |solution: &Solution<f64, 1>| {
        let errors = (0..=1000).map(|k| f64::from(k) / 100.0).map(|t| {
            let angle = |run: &Solution<f64, 1>| run.at(t).map_or(f64::NAN, |state| state.q[0]);
            (angle(solution) - angle(&exact)).abs()
        });
        (errors.fold(0.0, f64::max), solution.stats.accepted as f64)
    };
    let (mut own, mut other) = (Vec::new(), Vec::new());
    println!("A pendulum over 10 s from 1.3 rad: largest error in rad, and steps\n");
    println!("   rtol     BogackiShampine            Dop853");
    for rtol in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9] {
        own.push(measured(&run().method(BogackiShampine).rtol(rtol).dense().run()?));
        other.push(measured(&run().method(Dop853).rtol(rtol).dense().run()?));
        let ((error, steps), (error8, steps8)) = (own[own.len() - 1], other[other.len() - 1]);
        println!("{rtol:7.0e}   {error:9.1e} {steps:7}   {error8:9.1e} {steps8:7}");
    }
    // Event times are located on the interpolant.
    let hanging = Event::new(|_, θ, _| θ[0]);
    let swing = run().method(BogackiShampine).rtol(1e-8).events([hanging]).run()?;
    let times: Vec<f64> = swing.events.iter().map(|event| event.time.to_f64()).collect();
    println!("\n{} times through θ = 0; the period is {:.6} s", times.len(), times[2] - times[0]);

    let chart = Chart::new(Axis::digits("largest error in rad"), Axis::logarithmic("steps"))
        .curve(Curve::new(other).name("Dop853").marked())
        .curve(Curve::new(own).name("BogackiShampine").color(color::ORANGE).width(3.0).marked());
    Picture::new("A method of one's own beside Dop853: order three against eight", (960, 480))
        .chart(chart)
        .save("target/own-method.svg")?;
    println!("written: target/own-method.svg");
    Ok(())
}
