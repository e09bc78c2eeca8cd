//! The page: the drawing, the baked motions, and a script that blends them.

use crate::animation::frames;
use crate::bake::{Baked, Course, FRAMES};
use crate::dance::PERIOD;
use crate::rig::Rig;
use base64::prelude::{BASE64_STANDARD, Engine};
use serde_json::{Value, json};

/// The unit of the angles in the page, in radians.
const UNIT: f64 = 1e-4;

/// Returns the text of the page. `values` are the baked gravitational accelerations and damping
/// ratios, and `shown` contains the indices of the initial ones.
pub(crate) fn write(
    text: &str,
    rig: &Rig<'_>,
    baked: &Baked,
    values: [&[f64]; 2],
    shown: [usize; 2],
) -> String {
    // Text before the root, such as an XML declaration, is not allowed in a page.
    let drawing = &text[text.find("<svg").unwrap_or(0)..];
    let data = data(rig, baked, values, shown);
    let [gravities, dampings] = values.map(|values| values.len().to_string());
    let (feathers, joints) = (rig.feathers.len().to_string(), rig.keyed.len().to_string());
    let parts = [
        ("COUNT", feathers.as_str()),
        ("JOINTS", &joints),
        ("GRAVITIES", &gravities),
        ("DAMPINGS", &dampings),
        ("DRAWING", drawing.trim_end()),
        ("DATA", &data),
    ];
    // Inserted text is not searched again.
    let mut pieces = include_str!("page.html").split('@');
    let mut page = pieces.next().unwrap_or_default().to_string();
    for piece in pieces {
        match parts.iter().find(|(name, _)| *name == piece) {
            Some((_, part)) => page += part,
            None => page += piece,
        }
    }
    page
}

fn data(
    rig: &Rig<'_>,
    baked: &Baked,
    [gravities, dampings]: [&[f64]; 2],
    shown: [usize; 2],
) -> String {
    let feathers: Vec<Value> = rig
        .feathers
        .iter()
        .map(|hung| {
            let [sign, x, y] = hung.joint.rotation(1.0);
            json!([hung.joint.name, cents(x), cents(y), sign.signum()])
        })
        .collect();
    let joints: Vec<Value> = rig
        .keyed
        .iter()
        .map(|keyed| {
            let (turns, shifts) = frames(keyed);
            let [_, x, y] = keyed.joint.rotation(0.0);
            let degrees = turns.iter().map(|&turn| cents(keyed.joint.rotation(turn)[0]));
            let degrees: Vec<f64> = degrees.collect();
            let mut joint =
                json!({"id": keyed.joint.name, "x": cents(x), "y": cents(y), "turns": degrees});
            if shifts.iter().any(|&shift| shift != [0.0; 2]) {
                let shifts: Vec<_> = shifts.iter().map(|shift| shift.map(cents)).collect();
                joint["shifts"] = json!(shifts);
            }
            joint
        })
        .collect();
    let swings = baked.courses.iter().flatten().flat_map(Course::swings);
    let bytes: Vec<u8> =
        swings.flat_map(|swing| ((swing / UNIT).round() as i16).to_le_bytes()).collect();
    let data = json!({
        "period": PERIOD,
        "frames": FRAMES,
        "unit": UNIT.to_degrees(),
        "gravities": gravities,
        "dampings": dampings,
        "shown": shown,
        "feathers": feathers,
        "joints": joints,
        "swings": BASE64_STANDARD.encode(bytes),
    });
    // Without `<`, no name can end the script.
    data.to_string().replace('<', "\\u003c")
}

/// Rounds a length or an angle to two decimal places.
fn cents(value: f64) -> f64 {
    (100.0 * value).round() / 100.0
}
