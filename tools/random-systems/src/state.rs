//! A random state of a system: all numbers are of the order of one, and none is round.

use super::evaluate::{Constants, Points};
use super::reference::State;
use super::tree::{Kind, System};
use systems::random::Random;

/// Returns the state of a seed. Every number is exact in `f64`, except for the moments of bodies,
/// which are computed from `f64` points.
pub fn state(system: &System, seed: u64) -> State<f64> {
    let mut random = Random(seed);
    let count = system.count();
    let mut bodies = Vec::new();
    for parameter in &system.parameters {
        let body = (parameter.kind == Kind::Body).then(|| {
            let mut point = || {
                (random.uniform(0.2, 0.5), [random.uniform(-0.8, 1.2), random.uniform(-0.8, 1.2)])
            };
            Points((0..4).map(|_| point()).collect())
        });
        bodies.push(body);
    }
    let mut parameters = Vec::new();
    for (parameter, body) in system.parameters.iter().zip(&bodies) {
        match body {
            Some(points) => parameters.extend(moments(points)),
            None => {
                parameters.extend((0..parameter.kind.count()).map(|_| random.uniform(0.4, 1.5)));
            }
        }
    }
    let mut some =
        |count: usize| (0..count).map(|_| random.uniform(-1.3, 1.4)).collect::<Vec<f64>>();
    let (q, v) = (some(count), some(count));
    let t = some(1)[0] + 1.5;
    let inputs = system
        .inputs
        .iter()
        .map(|input| (0..input.components).map(|_| [0; 4].map(|_| some(1)[0])).collect())
        .collect();
    State { constants: Constants { parameters, bodies }, t, q, v, inputs }
}

/// Returns mass, centre and central moments.
pub fn moments<T: pendulum_runtime::scalar::Real>(points: &Points<T>) -> [T; 6] {
    let zero = T::from_f64(0.0);
    let sum =
        |part: &dyn Fn(T, [T; 2]) -> T| points.0.iter().fold(zero, |sum, &(w, p)| sum + part(w, p));
    let mass = sum(&|w, _| w);
    let (x, y) = (sum(&|w, p| w * p[0]) / mass, sum(&|w, p| w * p[1]) / mass);
    let xx = sum(&|w, p| w * (p[0] - x) * (p[0] - x));
    let xy = sum(&|w, p| w * (p[0] - x) * (p[1] - y));
    let yy = sum(&|w, p| w * (p[1] - y) * (p[1] - y));
    [mass, x, y, xx, xy, yy]
}

/// Returns the state in higher precision, with the moments of bodies recomputed.
pub fn precise<T: pendulum_runtime::scalar::Real>(system: &System, state: &State<f64>) -> State<T> {
    let mut precise = state.map(T::from_f64);
    for (index, body) in precise.constants.bodies.iter().enumerate() {
        if let Some(points) = body {
            let first = system.first_parameter(index);
            precise.constants.parameters[first..first + 6].copy_from_slice(&moments(points));
        }
    }
    precise
}
