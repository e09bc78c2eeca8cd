//! The drawing with moving joints: `animateTransform` elements in the groups of the joints.

use crate::UNITS;
use crate::bake::{Course, FRAMES, RATE};
use crate::dance::PERIOD;
use crate::rig::{Keyed, Rig};
use pendulum_runtime::import::svg::DrawnJoint;
use pendulum_runtime::motion::{Derivatives, Motion, Sample, Side};
use std::fmt::Write;

/// Returns the text of the animated drawing.
pub(crate) fn draw(text: &str, rig: &Rig<'_>, courses: &[Course]) -> String {
    let mut parts: Vec<(usize, String)> = Vec::new();
    for keyed in &rig.keyed {
        let (turns, shifts) = frames(keyed);
        let mut part = String::new();
        if shifts.iter().any(|&shift| shift != [0.0; 2]) {
            part += &element("translate", shifts.iter().map(|[x, y]| format!("{x:.2} {y:.2}")));
        }
        parts.push((keyed.joint.inside, part + &rotation(keyed.joint, &turns)));
    }
    for (hung, course) in rig.feathers.iter().zip(courses) {
        parts.push((hung.joint.inside, rotation(hung.joint, course.swings())));
    }
    parts.sort_by_key(|part| part.0);
    let (mut drawn, mut from) = (String::new(), 0);
    for (inside, part) in parts {
        drawn.push_str(&text[from..inside]);
        drawn.push_str(&part);
        from = inside;
    }
    drawn + &text[from..]
}

/// Returns the turns of a keyed joint at each frame, in radians, and its shifts, in pixels of the
/// joint's group.
pub(crate) fn frames(keyed: &Keyed<'_>) -> (Vec<f64>, Vec<[f64; 2]>) {
    let times = || (0..FRAMES).map(|frame| (frame as f64 / RATE as f64).into());
    let turn = |t| {
        let sample: Sample<f64, 1> = keyed.turn.sample(t, Side::After, Derivatives::POSITION);
        sample.position[0]
    };
    let shift = |t| {
        let sample: Sample<f64, 2> = keyed.way.sample(t, Side::After, Derivatives::POSITION);
        let [x, y] = sample.position.map(|metres| metres / UNITS.pixel / keyed.joint.scale);
        [x, -y]
    };
    (times().map(turn).collect(), times().map(shift).collect())
}

fn rotation(joint: &DrawnJoint, angles: &[f64]) -> String {
    let values = angles.iter().map(|&angle| {
        let [degrees, x, y] = joint.rotation(angle);
        format!("{degrees:.2} {x:.1} {y:.1}")
    });
    element("rotate", values)
}

/// Returns an element with one value for each frame; the first value, repeated at the end, closes
/// the loop.
fn element(kind: &str, values: impl Iterator<Item = String>) -> String {
    let mut values: Vec<String> = values.collect();
    values.push(values[0].clone());
    let mut text = String::new();
    // Writing to a `String` never fails.
    let _ = write!(
        text,
        r#"<animateTransform attributeName="transform" additive="sum" type="{kind}" dur="{PERIOD}s" repeatCount="indefinite" values="{}"/>"#,
        values.join(";")
    );
    text
}
