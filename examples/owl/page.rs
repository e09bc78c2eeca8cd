//! The page: the drawing, what was baked, and a script that blends it.

use crate::animation::frames;
use crate::bake::{Baked, Course, FRAMES};
use crate::dance::PERIOD;
use crate::rig::Rig;
use std::fmt::Write;

/// The angle that a number of the page stands for, in radians.
const UNIT: f64 = 1e-4;

/// The text of the page; `values` are the gravities and the damping ratios that were baked, `shown`
/// the numbers of those it starts with.
pub(crate) fn write(
    text: &str,
    rig: &Rig<'_>,
    baked: &Baked,
    values: [&[f64]; 2],
    shown: [usize; 2],
) -> String {
    // What stands before the root, such as an XML declaration, does not belong into a page.
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
    // What is put in is not looked through again.
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
    let mut json = String::new();
    let unit = UNIT.to_degrees();
    // Writing to a string does not fail.
    let _ = write!(
        json,
        r#"{{"period":{PERIOD},"frames":{FRAMES},"unit":{unit},"gravities":{gravities:?},"dampings":{dampings:?},"shown":{shown:?},"feathers":["#
    );
    for (index, hung) in rig.feathers.iter().enumerate() {
        let [sign, x, y] = hung.joint.rotation(1.0);
        let comma = if index == 0 { "" } else { "," };
        let _ = write!(json, "{comma}[{:?},{x:.2},{y:.2},{}]", hung.joint.name, sign.signum());
    }
    json.push_str("],\n\"joints\":[");
    for (index, keyed) in rig.keyed.iter().enumerate() {
        let (turns, shifts) = frames(keyed);
        let comma = if index == 0 { "" } else { ",\n" };
        let [_, x, y] = keyed.joint.rotation(0.0);
        let _ =
            write!(json, r#"{comma}{{"id":{:?},"x":{x:.2},"y":{y:.2},"turns":["#, keyed.joint.name);
        let degrees: Vec<String> =
            turns.iter().map(|&turn| format!("{:.2}", keyed.joint.rotation(turn)[0])).collect();
        json.push_str(&degrees.join(","));
        json.push(']');
        if shifts.iter().any(|&shift| shift != [0.0; 2]) {
            let pairs: Vec<String> =
                shifts.iter().map(|[x, y]| format!("[{x:.2},{y:.2}]")).collect();
            let _ = write!(json, r#","shifts":[{}]"#, pairs.join(","));
        }
        json.push('}');
    }
    let numbers = baked.courses.iter().flatten().flat_map(Course::swings);
    let bytes: Vec<u8> =
        numbers.flat_map(|swing| ((swing / UNIT).round() as i16).to_le_bytes()).collect();
    let _ = write!(json, "],\n\"swings\":\"{}\"}}", base64(&bytes));
    // No name ends the script.
    json.replace('<', "\\u003c")
}

/// RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let word = group
            .iter()
            .enumerate()
            .fold(0u32, |word, (at, &byte)| word | u32::from(byte) << (16 - 8 * at));
        for digit in 0..4 {
            let value = word >> (18 - 6 * digit) & 63;
            text.push(if digit <= group.len() { char::from(DIGITS[value as usize]) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::base64;

    /// RFC 4648, section 10.
    #[test]
    fn base64_has_the_vectors_of_its_standard() {
        for (bytes, text) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }
}
