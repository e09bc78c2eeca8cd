//! The Lyapunov spectrum of a double pendulum beside its running estimate.
//!
//! `cargo run --release --example lyapunov` prints the exponents with their standard errors, as
//! well as those of Hénon and Heiles' star, and writes `target/lyapunov.svg`.

#![allow(mixed_script_confusables, missing_docs)]

use indicatif::ProgressBar;
use pendulum_runtime::analysis::{LyapunovSpectrum, Variational, lyapunov, variational_size};
use pictures::{Axis, Chart, Curve, Picture, color};
use std::error::Error;
use std::time::Duration;
use systems::problems::{Double, HenonHeiles};

const SIZE: usize = variational_size(2, 0);

/// Draws the running estimates over the logarithm of time.
fn picture(spectrum: &LyapunovSpectrum) -> Picture {
    let most = 1.5 * spectrum.exponents[0];
    let estimates = Axis::linear("mean until t, in 1/s").range(-most, most);
    let mut chart = Chart::new(Axis::logarithmic("t in s"), estimates);
    for (index, color) in color::CURVES.into_iter().take(4).enumerate() {
        let (exponent, error) = (spectrum.exponents[index], spectrum.standard_errors[index]);
        // About one point for each pixel.
        let (mut last, mut points) = (0.0, Vec::new());
        for (t, exponents) in spectrum.running() {
            if last + 0.01 < t.ln() {
                last = t.ln();
                points.push((t, exponents[index].clamp(-most, most)));
            }
        }
        let name = format!("{exponent:+.4} ± {error:.4} /s");
        chart = chart.curve(Curve::new(points).color(color).name(name));
    }
    let title = "The Lyapunov exponents of a double pendulum: two pairs of opposite sign";
    Picture::new(title, (960, 480)).chart(chart)
}

fn main() -> Result<(), Box<dyn Error>> {
    // Hidden if stderr is not a terminal.
    let spinner = ProgressBar::new_spinner().with_message("following both motions");
    spinner.enable_steady_tick(Duration::from_millis(200));
    let double = Variational::<_, 2, SIZE>::new(Double::new([1.0; 2], [1.0; 2], 9.81));
    let spectrum = lyapunov(&double, 0.0, [2.0, 2.0], [0.0; 2]).transient(50.0).run(2e4)?;
    println!("double pendulum, sum {:.0e}\n{spectrum}\n", spectrum.sum());
    picture(&spectrum).save("target/lyapunov.svg")?;

    let star = Variational::<_, 2, SIZE>::new(HenonHeiles::new(1.0));
    let run = lyapunov(&star, 0.0, [0.0, -0.25], [0.42, 0.0]).transient(500.0).interval(5.0);
    let spectrum = run.run(1e5)?;
    spinner.finish_and_clear();
    println!("Hénon and Heiles, sum {:.0e}\n{spectrum}\ntarget/lyapunov.svg", spectrum.sum());
    Ok(())
}
