//! The Lyapunov spectrum of a double pendulum beside its running estimate.
//!
//! `cargo run --release --example lyapunov` prints the exponents with their standard errors, that
//! of Hénon and Heiles' star as well, and writes `target/lyapunov.svg`.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::analysis::{LyapunovSpectrum, Variational, lyapunov, variational_size};
use std::error::Error;
use std::fmt::Write;
use systems::problems::{Double, HenonHeiles};

const SIZE: usize = variational_size(2, 0);
const COLOURS: [&str; 4] = ["#d1495b", "#edae49", "#66a182", "#2e8bc0"];

/// The running estimates over the logarithm of time, and at the right the spectrum with two
/// standard errors.
fn picture(spectrum: &LyapunovSpectrum) -> Result<String, std::fmt::Error> {
    let most = 1.5 * spectrum.exponents[0];
    let y = |exponent: f64| 210.0 - 180.0 * (exponent / most).clamp(-1.0, 1.0);
    let x = |t: f64| 70.0 + 560.0 * t.ln() / spectrum.time.ln();
    let mut svg = String::from(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 860 460' font-family='sans-serif' font-size='13'>\n\
         <rect width='860' height='460' fill='white'/>\n",
    );
    writeln!(svg, "<path d='M70 {0:.1}H700' stroke='#bbb'/>", y(0.0))?;
    for power in 0..=spectrum.time.log10() as i32 {
        let t = 10.0_f64.powi(power);
        writeln!(svg, "<path d='M{:.1} 30v360' stroke='#e8e8e8'/>", x(t))?;
        writeln!(svg, "<text x='{:.1}' y='410' text-anchor='middle'>{t} s</text>", x(t))?;
    }
    for (index, colour) in COLOURS.iter().enumerate() {
        let mut path = String::new();
        let mut last = 0.0;
        for (t, exponents) in spectrum.running() {
            if last + 0.5 < x(t) {
                last = x(t);
                write!(path, "{:.1},{:.1} ", x(t), y(exponents[index]))?;
            }
        }
        writeln!(
            svg,
            "<polyline points='{path}' fill='none' stroke='{colour}' stroke-width='2'/>"
        )?;
        let (exponent, error) = (spectrum.exponents[index], spectrum.standard_errors[index]);
        let (from, to) = (y(exponent + 2.0 * error), y(exponent - 2.0 * error));
        let (middle, label) = (y(exponent), y(exponent) + [4.0, -8.0, 16.0, 4.0][index]);
        writeln!(svg, "<path d='M660 {from:.1}V{to:.1}' stroke='{colour}' stroke-width='3'/>")?;
        writeln!(svg, "<circle cx='660' cy='{middle:.1}' r='5' fill='{colour}'/>")?;
        writeln!(
            svg,
            "<text x='710' y='{label:.1}' fill='{colour}'>{exponent:+.4} ± {error:.4} /s</text>"
        )?;
    }
    svg.push_str(
        "<text x='70' y='442'>Lyapunov exponents of a double pendulum: means until t</text></svg>\n",
    );
    Ok(svg)
}

fn main() -> Result<(), Box<dyn Error>> {
    let double = Variational::<_, 2, SIZE>::new(Double::new([1.0; 2], [1.0; 2], 9.81));
    let spectrum = lyapunov(&double, 0.0, [2.0, 2.0], [0.0; 2]).transient(50.0).run(2e4)?;
    println!("double pendulum, sum {:.0e}\n{spectrum}\n", spectrum.sum());
    std::fs::write("target/lyapunov.svg", picture(&spectrum)?)?;

    let star = Variational::<_, 2, SIZE>::new(HenonHeiles::new(1.0));
    let run = lyapunov(&star, 0.0, [0.0, -0.25], [0.42, 0.0]).transient(500.0).interval(5.0);
    let spectrum = run.run(1e5)?;
    println!("Hénon and Heiles, sum {:.0e}\n{spectrum}\ntarget/lyapunov.svg", spectrum.sum());
    Ok(())
}
