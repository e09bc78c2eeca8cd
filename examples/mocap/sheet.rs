//! Tables of the swings.

use crate::hung::{Hung, Swing};
use std::fmt::Write;

/// Returns the table of the swings.
pub(crate) fn swings(pendulums: &[Hung]) -> String {
    let mut text = format!(
        "{:<12}{:>12}{:>14}{:>12}{:>20}",
        "pendulum", "mass", "peak: spline", "linear keys", "largest difference"
    );
    for hung in pendulums {
        let [spline, linear] = [&hung.spline, &hung.linear].map(|swing| swing.peak().to_degrees());
        let apart = hung.spline.apart(&hung.linear).0.to_degrees();
        let _ = write!(
            text,
            "\n{:<12}{:>10.1} g{spline:>13.1}°{linear:>11.1}°{apart:>19.1}°",
            hung.place.label,
            1e3 * hung.mass
        );
    }
    text
}

/// Returns the largest differences between the generated and the hand-written equations: of the
/// accelerations along the swing and of the angles at its end.
pub(crate) fn difference(pendulums: &[Hung]) -> String {
    let largest = |value: &dyn Fn(&Hung) -> f64| pendulums.iter().map(value).fold(0.0, f64::max);
    let acceleration = largest(&|hung| hung.difference);
    let of = largest(&|hung| hung.acceleration);
    let end = largest(&|hung| hung.spline.apart(&hung.hand).1);
    format!("{acceleration:.1e} rad/s² of {of:.0} rad/s² along the swing, {end:.1e} rad at its end")
}

/// Returns comma-separated values: the time, and for each pendulum its pivot on the spline and the
/// angles on the spline, on linear keys, and by the hand-written equation.
pub(crate) fn values(times: &[f64], pendulums: &[Hung]) -> String {
    let mut text = String::from("t [s]");
    for hung in pendulums {
        for column in [
            "x [m]",
            "y [m]",
            "angle spline [rad]",
            "angle linear keys [rad]",
            "angle hand-written [rad]",
        ] {
            let _ = write!(text, ",{} {column}", hung.place.label);
        }
    }
    for (row, t) in times.iter().enumerate() {
        let _ = write!(text, "\n{t:.6}");
        for hung in pendulums {
            let [x, y] = hung.pivot[row];
            let angles =
                [&hung.spline, &hung.linear, &hung.hand].map(|swing: &Swing| swing.angles[row]);
            let _ =
                write!(text, ",{x:.6},{y:.6},{:.9},{:.9},{:.9}", angles[0], angles[1], angles[2]);
        }
    }
    text.push('\n');
    text
}
