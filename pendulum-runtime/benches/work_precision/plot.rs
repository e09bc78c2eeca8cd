//! Pictures of the systems, with the error on the horizontal axis, decreasing to the right, and the
//! time on the vertical axis.

use crate::summary;
use crate::table::{Entry, Party};
use pictures::{Axis, Chart, Curve, Picture, RGBColor, color};
use std::error::Error;
use std::path::Path;

/// The methods of this crate that are drawn, with the colour and the width of their curves.
const OURS: [(&str, RGBColor, f64); 6] = [
    ("Picard", color::ORANGE, 4.0),
    ("Taylor", color::BLUE, 2.0),
    ("Dop853", color::GREEN, 2.0),
    ("Srkn14a", color::PURPLE, 2.0),
    ("Gauss<4>", color::PINK, 2.0),
    ("Rk4", color::OCHRE, 2.0),
];

/// The rows of peers that are drawn: the faster rows, whose equations are written by hand.
const PEERS: [(&str, &str); 3] = [
    ("heyoka simplified", "heyoka"),
    ("ode_solvers Dop853 by hand", "ode_solvers Dop853"),
    ("differential-equations Dop853 by hand", "differential-equations Dop853"),
];

/// The error at which the title compares times.
const ERROR: f64 = 1e-10;

/// Draws the entries of one system.
pub fn draw(
    path: &Path,
    system: &str,
    note: &str,
    entries: &[Entry],
) -> Result<(), Box<dyn Error>> {
    let of_system: Vec<&Entry> = entries.iter().filter(|entry| entry.system == system).collect();
    let mut chart = Chart::new(
        Axis::digits("largest error over all output times, coordinates and velocities"),
        Axis::logarithmic("seconds"),
    );
    for (method, name) in PEERS {
        chart = chart.curve(Curve::new(points(&of_system, method)).name(name).dashed().marked());
    }
    // The widest curve is drawn last, over all others.
    for (method, color, width) in OURS.into_iter().rev() {
        let curve = Curve::new(points(&of_system, method)).name(method).marked();
        chart = chart.curve(curve.color(color).width(width));
    }
    let note = format!("{note}. Peers: equations written by hand.");
    Picture::new(title(system, &of_system), (960, 600)).note(note).chart(chart).save(path)
}

/// Returns the errors and seconds of a method, in the order of the errors.
fn points(entries: &[&Entry], method: &str) -> Vec<(f64, f64)> {
    let own = entries.iter().filter(|entry| entry.method == method);
    // The logarithm of an error of zero would be infinite.
    let mut points: Vec<(f64, f64)> =
        own.filter_map(|entry| Some((entry.error()?.max(1e-17), entry.seconds()))).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

/// Returns a title that compares the best time of this crate with the best time of the peers at
/// equal error.
fn title(system: &str, entries: &[&Entry]) -> String {
    let motion = match system {
        "simple" => "A pendulum",
        "moving" => "A pendulum on a moving pivot",
        "moving_compound" => "A compound pendulum on a moving pivot",
        "elastic" => "A pendulum on a spring",
        "double_regular" => "A double pendulum that swings gently",
        "double_chaotic" => "A chaotic double pendulum",
        "chain5" => "A chain of five pendulums",
        "kepler" => "A planet on an ellipse",
        "henon_heiles" => "A star of Hénon and Heiles",
        "pythagorean" => "The Pythagorean three bodies",
        other => other,
    };
    let of = |ours: bool| -> Vec<&Entry> {
        let party = |entry: &&&Entry| (entry.party() == Party::Ours) == ours;
        entries.iter().filter(party).copied().collect()
    };
    match (summary::best(&of(true), ERROR, None), summary::best(&of(false), ERROR, None)) {
        (Some((own, method)), Some((peer, _))) => format!(
            "{motion} to an error of 1e-10: {method} takes {}, the fastest peer {}",
            duration(own),
            duration(peer)
        ),
        (Some((own, method)), None) => {
            format!("{motion} to an error of 1e-10: {method} takes {}", duration(own))
        }
        _ => format!("{motion}: run time against error"),
    }
}

/// Formats seconds with two digits.
fn duration(seconds: f64) -> String {
    let (value, unit) = if seconds < 1e-3 { (1e6 * seconds, "µs") } else { (1e3 * seconds, "ms") };
    if value < 10.0 { format!("{value:.1} {unit}") } else { format!("{value:.0} {unit}") }
}
