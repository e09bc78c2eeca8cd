//! An animated picture of tails: SVG whose `animate` elements list the values of all keys.

use crate::{BONES, SECONDS, Tail};
use std::fmt::Write;

/// The size of a stage in pixels, the place of its middle at the height of the head, and pixels to a
/// metre.
const SIZE: [f64; 2] = [490.0, 560.0];
const MIDDLE: [f64; 2] = [245.0, 96.0];
const METRE: f64 = 640.0;
/// The left, right, upper and lower end of the curves below, and their pixels to a metre.
const CHART: [f64; 4] = [20.0, 470.0, 400.0, 540.0];
const TALL: f64 = 200.0;
/// Keys a second.
const KEYS: u32 = 30;

/// The tails at one frame rate.
pub(crate) struct Tails {
    pub(crate) run: Vec<(f64, Tail)>,
    pub(crate) color: String,
    pub(crate) label: String,
}

/// The tails at all frame rates.
pub(crate) struct Stage {
    title: &'static str,
    pub(crate) tails: Vec<Tails>,
}

impl Stage {
    pub(crate) fn new(title: &'static str) -> Self {
        Self { title, tails: Vec::new() }
    }
}

/// Returns the tail at `t`, on the straight lines between frames.
fn at(run: &[(f64, Tail)], t: f64) -> Tail {
    let after = run.partition_point(|(time, _)| *time < t).clamp(1, run.len() - 1);
    let ((t0, from), (t1, to)) = (&run[after - 1], &run[after]);
    let part = ((t - t0) / (t1 - t0)).clamp(0.0, 1.0);
    core::array::from_fn(|k| [0, 1].map(|i| from[k][i] + part * (to[k][i] - from[k][i])))
}

/// Returns the animation of an attribute with a value at each key.
fn animation(attribute: &str, value: impl Fn(f64) -> String) -> String {
    let keys: Vec<_> =
        (0..=SECONDS * KEYS).map(|k| value(f64::from(k) / f64::from(KEYS))).collect();
    format!(
        r#"<animate attributeName="{attribute}" dur="{SECONDS}s" repeatCount="indefinite" values="{}"/>"#,
        keys.join(";")
    )
}

/// Writes the stages side by side.
pub(crate) fn save(stages: &[Stage], path: &str) -> Result<(), Box<dyn std::error::Error>> {
    let (width, height) = (SIZE[0] * stages.len() as f64, SIZE[1]);
    let mut svg = format!(
        concat!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}" "#,
            r#"font-family="Helvetica, Arial, sans-serif" font-size="13" fill="none" "#,
            r#"stroke-linecap="round" stroke-linejoin="round">"#,
            "\n<title>One tail at five frame rates: as bones in a scene, and by the formula of VRM</title>\n",
            r#"<rect width="{0}" height="{1}" fill="white"/>"#,
            "\n"
        ),
        width, height
    );
    for (index, Stage { title, tails }) in stages.iter().enumerate() {
        let [left, right, top, bottom] = CHART;
        let middle = f64::midpoint(top, bottom);
        writeln!(svg, r#"<g transform="translate({} 0)">"#, index as f64 * SIZE[0])?;
        writeln!(
            svg,
            r##"<text x="20" y="30" font-size="17" font-weight="bold" fill="#333">{title}</text>"##
        )?;
        let caption = "frames a second, and how far the tip is from that at 60";
        writeln!(svg, r##"<text x="20" y="54" font-size="12" fill="#777">{caption}</text>"##)?;
        writeln!(svg, r##"<path d="M{left} {middle}H{right}" stroke="#ccc"/>"##)?;
        for (row, Tails { run, color, label }) in tails.iter().enumerate() {
            let y = 76.0 + 18.0 * row as f64;
            writeln!(svg, r#"<text x="20" y="{y}" fill="{color}">{label}</text>"#)?;
            let points = |t: f64| {
                let ends = at(run, t).map(|[x, y]| {
                    format!("{:.1},{:.1}", MIDDLE[0] + METRE * x, MIDDLE[1] - METRE * y)
                });
                ends.join(" ")
            };
            writeln!(
                svg,
                r#"<polyline points="{}" stroke="{color}" stroke-width="7" opacity="0.6">{}</polyline>"#,
                points(2.35),
                animation("points", points)
            )?;
            let mut curve = String::new();
            for (t, tail) in run {
                let x = left + (right - left) * t / f64::from(SECONDS);
                let y = middle - TALL * (tail[BONES][0] - tail[0][0]);
                write!(curve, "{x:.1},{y:.1} ")?;
            }
            writeln!(svg, r#"<polyline points="{curve}" stroke="{color}" stroke-width="1.5"/>"#)?;
        }
        let head = |t: f64| format!("{:.1}", MIDDLE[0] + METRE * crate::head(t)[0]);
        writeln!(
            svg,
            r##"<circle cx="{}" cy="{}" r="16" fill="#444">{}</circle>"##,
            head(2.35),
            MIDDLE[1] - 6.0,
            animation("cx", head)
        )?;
        let now = |t: f64| format!("{:.1}", left + (right - left) * t / f64::from(SECONDS));
        writeln!(
            svg,
            r##"<rect x="{left}" y="{top}" width="1" height="{}" fill="#888">{}</rect>"##,
            bottom - top,
            animation("x", now)
        )?;
        let caption = format!("from the head to the tip, sideways, over {SECONDS} s");
        writeln!(svg, r##"<text x="20" y="556" font-size="12" fill="#777">{caption}</text></g>"##)?;
    }
    svg.push_str("</svg>\n");
    std::fs::write(path, svg)?;
    Ok(())
}
