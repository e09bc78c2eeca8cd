//! A pendulum on a spring that gives its energy from the spring to the swing and back: columns of a
//! solution, its energy, a table as CSV.
//!
//! `cargo run --release --features csv --example spring_pendulum` prints the table, and writes
//! `target/spring-pendulum.csv` and `target/spring-pendulum.svg`.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::prelude::*;
use std::error::Error;
use std::fmt::Write;

lagrangian! {
    pub struct SpringPendulum { m: kg, k: N/m, L: m, g: m/s^2 = 9.81 }
    coordinate r: m;
    coordinate θ: rad;
    let y = r * [sin(θ), -cos(θ)];
    kinetic   = m/2 * |ẏ|^2;
    potential = k/2 * (r - L)^2 + m*g*height(y);
}

/// A curve of numbers between −1 and 1 over a box.
fn curve(values: &[f64], [x, y, width, height]: [f64; 4], colour: &str) -> String {
    let point = |(index, value): (usize, &f64)| {
        let along = index as f64 / (values.len() - 1) as f64;
        format!("{:.1},{:.1}", x + width * along, y - height * value)
    };
    let points: Vec<String> = values.iter().enumerate().map(point).collect();
    let points = points.join(" ");
    format!("<polyline points='{points}' fill='none' stroke='{colour}' stroke-width='1.5'/>\n")
}

fn main() -> Result<(), Box<dyn Error>> {
    // The spring vibrates twice while the pendulum swings once: k/m = 4 g/(L + m g/k).
    let pendulum = SpringPendulum::new(1.0, 3.0 * 9.81, 1.0);
    let rest = 1.0 + 1.0 / 3.0;
    let (q, v) = ([rest + 0.25, 0.02], [0.0, 0.0]);
    let solution = solve(&pendulum, (0.0, 60.0), q, v).rtol(1e-11).every(0.02).run()?;

    let energy = solution.energy(&pendulum);
    let (r, θ) = (solution.column("r")?, solution.column("θ")?);
    let table = solution.table().with("energy", "J", energy.clone())?;
    println!("{table}\n{}", solution.stats);
    let drift = energy.iter().map(|e| (e - energy[0]).abs()).fold(0.0, f64::max);
    println!("energy kept to {drift:.1e} J");
    table.to_csv(std::fs::File::create("target/spring-pendulum.csv")?)?;

    let mut svg = String::from(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1000 480' font-family='sans-serif' font-size='14'>\n\
         <rect width='1000' height='480' fill='#faf8f4'/>\n",
    );
    // The path of the bob, later pieces in other colours.
    for (index, piece) in solution.q.windows(2).enumerate() {
        let [x0, y0, x1, y1] = [piece[0], piece[1]]
            .map(|[r, θ]| [230.0 + 400.0 * r * θ.sin(), 250.0 + 400.0 * (r * θ.cos() - rest)])
            .concat()[..]
        else {
            continue;
        };
        let hue = 200.0 + 160.0 * index as f64 / solution.len() as f64;
        writeln!(
            svg,
            "<path d='M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}' stroke='hsl({hue:.0},60%,50%)'/>"
        )?;
    }
    let stretch: Vec<f64> = r.iter().map(|r| (r - rest) / 0.4).collect();
    svg += &curve(&stretch, [480.0, 140.0, 480.0, 90.0], "#2e8bc0");
    svg += &curve(&θ, [480.0, 350.0, 480.0, 120.0], "#d1495b");
    svg += "<text x='480' y='30' fill='#2e8bc0'>stretch of the spring</text>\n";
    svg += "<text x='480' y='260' fill='#d1495b'>angle of the swing</text>\n";
    svg +=
        "<text x='30' y='30'>path of the bob</text><text x='880' y='470'>60 seconds</text></svg>\n";
    std::fs::write("target/spring-pendulum.svg", svg)?;
    println!("target/spring-pendulum.csv, target/spring-pendulum.svg");
    Ok(())
}
