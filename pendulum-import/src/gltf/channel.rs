//! Channels of animations: the keys of a translation, a scale or a rotation.

use super::accessor::Source;
use super::error::GltfError;
use super::json::{index, list, member};
use super::track::{Arcs, Track, Turn, vanishing};
use super::{MEND, unit};
use pendulum_core::motion::{Curve, MotionError};
use serde_json::Value;
use std::collections::BTreeSet;

/// Times, values and their interpolation.
type Keys<const D: usize> = (Vec<f64>, Vec<[f64; D]>, Interpolation);

/// The interpolation between two keys.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Interpolation {
    Step,
    Linear,
    CubicSpline,
}

/// Returns the time of the last key of the samplers that move nodes.
pub(super) fn duration(
    source: &Source<'_>,
    samplers: &[Value],
    used: &BTreeSet<usize>,
) -> Result<f64, GltfError> {
    let mut last = 0.0;
    let mut inputs = BTreeSet::new();
    for (number, sampler) in samplers.iter().enumerate().filter(|(number, _)| used.contains(number))
    {
        let fail = |what| GltfError::new(format!("samplers[{number}]"), what, MEND);
        let input = index(sampler, "input").map_err(fail)?;
        // Channels usually have the same times.
        if !inputs.insert(input) {
            continue;
        }
        let times = source.read::<1>(input);
        let times = times.map_err(|error| error.within(&format!("samplers[{number}].input")))?;
        last = times.iter().fold(last, |last, &[time]| if last < time { time } else { last });
    }
    if last.is_finite() {
        Ok(last)
    } else {
        Err(GltfError::new("samplers", "a key at an infinite time", MEND))
    }
}

pub(super) fn track(
    source: &Source<'_>,
    animation: &Value,
    channel: &Value,
) -> Result<Track, GltfError> {
    let (times, values, interpolation) = keys::<3>(source, animation, channel)?;
    let curve = match interpolation {
        Interpolation::Step => Curve::steps(&times, &values),
        Interpolation::Linear => Curve::linear(&times, &values),
        Interpolation::CubicSpline => cubic(&times, &values),
    };
    Ok(Track::Keyed(curve.map_err(unfit)?))
}

pub(super) fn turn(
    source: &Source<'_>,
    animation: &Value,
    channel: &Value,
) -> Result<Turn, GltfError> {
    let (times, mut values, interpolation) = keys::<4>(source, animation, channel)?;
    let tangents = interpolation == Interpolation::CubicSpline;
    let [first, each] = if tangents { [1, 3] } else { [0, 1] };
    let keys = values.iter_mut().skip(first).step_by(each);
    for (key, value) in keys.enumerate() {
        let what = || GltfError::new("output", format!("key {key} is no unit quaternion"), MEND);
        let length = unit(*value).ok_or_else(what)?;
        if !tangents {
            *value = length;
        }
    }
    Ok(match interpolation {
        Interpolation::Step => Turn::Steps(Curve::steps(&times, &values).map_err(unfit)?),
        Interpolation::Linear => Turn::Arcs(Arcs::new(&times, &values)),
        Interpolation::CubicSpline => {
            let curve = cubic(&times, &values).map_err(unfit)?;
            if let Some(key) = vanishing(&curve) {
                let what = format!("the quaternion vanishes between key {key} and key {}", key + 1);
                return Err(GltfError::new(
                    "output",
                    what,
                    "turn by less than half a turn from key to key",
                ));
            }
            Turn::Cubic(curve)
        }
    })
}

/// Returns the times and values of a channel, with three values per key if there are tangents.
fn keys<const D: usize>(
    source: &Source<'_>,
    animation: &Value,
    channel: &Value,
) -> Result<Keys<D>, GltfError> {
    let number = index(channel, "sampler").map_err(|what| GltfError::new("sampler", what, MEND))?;
    let place = format!("samplers[{number}]");
    let fail = |what: String| GltfError::new(&*place, what, MEND);
    let sampler = list(animation, "samplers").get(number);
    let sampler = sampler.ok_or_else(|| fail("does not exist".into()))?;
    let interpolation = match member(sampler, "interpolation").map(Value::as_str) {
        None | Some(Some("LINEAR")) => Interpolation::Linear,
        Some(Some("STEP")) => Interpolation::Step,
        Some(Some("CUBICSPLINE")) => Interpolation::CubicSpline,
        Some(_) => return Err(fail("an unknown interpolation".into())),
    };
    let within = |part: &str, error: GltfError| error.within(&format!("{place}.{part}"));
    let input = index(sampler, "input").map_err(fail)?;
    let output = index(sampler, "output").map_err(fail)?;
    let times = source.read::<1>(input).map_err(|error| within("input", error))?;
    let values = source.read::<D>(output).map_err(|error| within("output", error))?;
    let times: Vec<f64> = times.into_iter().map(|[time]| time).collect();
    let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    if values.len() != each * times.len() {
        return Err(fail(format!(
            "{} times but {} values; {each} a time are needed",
            times.len(),
            values.len()
        )));
    }
    // Any curve checks its keys.
    Curve::steps(&times, &values[..times.len()]).map_err(|error| fail(error.to_string()))?;
    if times[0] < 0.0 {
        return Err(fail(format!("key 0 at {} s lies before the beginning", times[0])));
    }
    if let Some(key) = values.iter().position(|value| value.iter().any(|part| !part.is_finite())) {
        return Err(fail(format!("value {key} is infinite or no number")));
    }
    Ok((times, values, interpolation))
}

/// Creates cubics from three values per key: an arriving tangent, the value and a leaving tangent.
/// Tangents are velocities.
fn cubic<const D: usize>(times: &[f64], values: &[[f64; D]]) -> Result<Curve<D>, MotionError> {
    let points: Vec<[f64; D]> = values.iter().skip(1).step_by(3).copied().collect();
    let slopes: Vec<_> =
        (0..times.len() - 1).map(|key| [values[3 * key + 2], values[3 * key + 3]]).collect();
    Curve::hermite(times, &points, &slopes)
}

/// The error of a curve whose keys were not checked when they were read.
#[expect(clippy::needless_pass_by_value, reason = "it is passed to `map_err`")]
fn unfit(error: MotionError) -> GltfError {
    GltfError::new("sampler", error.to_string(), MEND)
}
