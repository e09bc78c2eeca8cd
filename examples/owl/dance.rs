//! The dance: the motions of the keyed joints, as keys over four seconds that repeat.

use pendulum_runtime::motion::{Curve, MotionError};

/// The length of the dance, in seconds.
pub(crate) const PERIOD: f64 = 4.0;

type Keys = &'static [(f64, f64)];

/// The turns of joints in degrees, counter-clockwise. The turns of the left side mirror those of
/// the right.
const TURNS: [(&str, Keys); 7] = [
    ("owl", &[(0.0, 0.0), (0.5, 0.0), (1.2, 4.0), (1.9, -4.0), (2.7, 0.0), (3.2, 0.0)]),
    (
        "head",
        &[
            (0.0, 0.0),
            (0.25, -9.0),
            (0.6, -10.0),
            (0.9, 0.0),
            (1.6, 3.0),
            (2.7, 0.0),
            (3.0, 12.0),
            (3.5, 13.0),
            (3.8, 2.0),
        ],
    ),
    (
        "wing-right",
        &[
            (0.0, -44.0),
            (0.3, -45.0),
            (0.72, 20.0),
            (1.02, -34.0),
            (1.32, 22.0),
            (1.62, -34.0),
            (1.92, 20.0),
            (2.24, -28.0),
            (2.6, 6.0),
            (3.0, -38.0),
            (3.4, -45.0),
        ],
    ),
    (
        "hand-right",
        &[
            (0.0, -22.0),
            (0.4, -24.0),
            (0.62, -14.0),
            (0.86, 16.0),
            (1.16, -20.0),
            (1.46, 16.0),
            (1.76, -20.0),
            (2.06, 14.0),
            (2.4, -16.0),
            (2.75, 8.0),
            (3.1, -20.0),
            (3.5, -23.0),
        ],
    ),
    (
        "tail",
        &[
            (0.0, 0.0),
            (0.5, 0.0),
            (0.9, 7.0),
            (1.2, -7.0),
            (1.5, 7.0),
            (1.8, -7.0),
            (2.2, 5.0),
            (2.8, -9.0),
            (3.1, 4.0),
            (3.5, 0.0),
        ],
    ),
    (
        "ear-right",
        &[
            (0.0, 0.0),
            (0.15, 8.0),
            (0.35, -2.0),
            (0.6, 0.0),
            (2.7, 0.0),
            (3.15, -12.0),
            (3.3, 7.0),
            (3.45, -9.0),
            (3.7, 0.0),
        ],
    ),
    (
        "ear-left",
        &[(0.0, 0.0), (0.3, -9.0), (0.5, 2.0), (0.8, 0.0), (2.7, 0.0), (3.0, 4.0), (3.3, 0.0)],
    ),
];

/// The position of the owl, in pixels to the right and up.
const ALONG: Keys =
    &[(0.0, 0.0), (0.55, 0.0), (1.2, -16.0), (1.95, 16.0), (2.65, 1.0), (2.8, 0.0), (3.3, 0.0)];
const UP: Keys = &[
    (0.0, 0.0),
    (0.3, 0.0),
    (0.6, 2.0),
    (0.78, 18.0),
    (1.05, 50.0),
    (1.35, 44.0),
    (1.65, 62.0),
    (1.95, 52.0),
    (2.3, 46.0),
    (2.68, 3.0),
    (2.78, 0.0),
    (3.0, 0.0),
    (3.5, 0.0),
];

/// Returns the turn of a joint relative to its parent, in radians. A joint that is not in the dance
/// rests.
pub(crate) fn turn(name: &str) -> Result<Curve<1>, MotionError> {
    let of = |name: &str| TURNS.iter().find(|(joint, _)| *joint == name).map(|&(_, keys)| keys);
    let mirror =
        |name: &str| name.strip_suffix("left").and_then(|start| of(&format!("{start}right")));
    let (keys, sign) = match (of(name), mirror(name)) {
        (Some(keys), _) => (keys, 1.0),
        (None, Some(keys)) => (keys, -1.0),
        (None, None) => (&[(0.0, 0.0)][..], 1.0),
    };
    let values: Vec<[f64; 1]> =
        keys.iter().map(|&(_, degrees)| [sign * degrees.to_radians()]).collect();
    closed(keys.iter().map(|&(time, _)| time).collect(), values)
}

/// Returns the path of the root joint in metres.
pub(crate) fn way(name: &str, pixel: f64) -> Result<Curve<2>, MotionError> {
    if name != "owl" {
        return closed(vec![0.0], vec![[0.0; 2]]);
    }
    // Each coordinate has its own spline; both are sampled at the union of their key times.
    let times = |keys: Keys| keys.iter().map(|&(time, _)| time).collect::<Vec<_>>();
    let [along, up] = [ALONG, UP]
        .map(|keys| closed(times(keys), keys.iter().map(|&(_, value)| [pixel * value]).collect()));
    let (along, up) = (along?, up?);
    let count = 80;
    let grid: Vec<f64> = (0..count).map(|key| PERIOD * f64::from(key) / f64::from(count)).collect();
    let at = |spline: &Curve<1>, t: f64| {
        use pendulum_runtime::motion::{Derivatives, Motion, Sample, Side};
        let sample: Sample<f64, 1> = spline.sample(t.into(), Side::After, Derivatives::POSITION);
        sample.position[0]
    };
    let values = grid.iter().map(|&t| [at(&along, t), at(&up, t)]).collect();
    closed(grid, values)
}

/// Returns the smooth curve through keys that returns to the first key.
fn closed<const D: usize>(
    mut times: Vec<f64>,
    mut values: Vec<[f64; D]>,
) -> Result<Curve<D>, MotionError> {
    times.push(PERIOD);
    values.push(values[0]);
    Curve::periodic(&times, &values)
}
