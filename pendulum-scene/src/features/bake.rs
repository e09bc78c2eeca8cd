//! Baked motions: curves that replace a simulation.

use crate::error::SceneError;
use crate::handle::Handle;
use crate::scene::Scene;
use crate::state::hermite;
use crate::system::SceneSystem;
use pendulum_core::scalar::Float;

/// The motion of a pendulum as keys. The motion between two keys is the cubic through the
/// coordinates and velocities at both keys (Hermite).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "Keys<T>",
        into = "Keys<T>",
        bound(
            serialize = "T: Clone + serde::Serialize",
            deserialize = "T: serde::Deserialize<'de>"
        )
    )
)]
pub struct Baked<T, const N: usize> {
    /// The length of a tick in seconds.
    step: f64,
    /// The ticks of the keys, counted from the first key.
    ticks: Vec<u32>,
    states: Vec<([T; N], [T; N])>,
}

/// The serialized keys, which `serde` reads for any number of coordinates, before validation.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct Keys<T> {
    step: f64,
    ticks: Vec<u32>,
    states: Vec<(Vec<T>, Vec<T>)>,
}

#[cfg(feature = "serde")]
impl<T, const N: usize> From<Baked<T, N>> for Keys<T> {
    fn from(Baked { step, ticks, states }: Baked<T, N>) -> Self {
        let states = states.into_iter().map(|(q, v)| (q.into(), v.into())).collect();
        Self { step, ticks, states }
    }
}

#[cfg(feature = "serde")]
impl<T, const N: usize> TryFrom<Keys<T>> for Baked<T, N> {
    type Error = &'static str;

    fn try_from(Keys { step, ticks, states }: Keys<T>) -> Result<Self, Self::Error> {
        if ticks.is_empty() || ticks.len() != states.len() {
            return Err("not one state for each key");
        }
        if !ticks.is_sorted_by(|a, b| a < b) {
            return Err("keys that are not in ascending order");
        }
        let states =
            states.into_iter().map(|(q, v)| Some((q.try_into().ok()?, v.try_into().ok()?)));
        let states = states.collect::<Option<_>>().ok_or("another number of coordinates")?;
        Ok(Self { step, ticks, states })
    }
}

impl<T: Float, const N: usize> Baked<T, N> {
    /// Returns an iterator over the keys: the time in seconds since the first key, coordinates and
    /// velocities.
    pub fn keys(&self) -> impl Iterator<Item = (f64, [T; N], [T; N])> {
        self.ticks
            .iter()
            .zip(&self.states)
            .map(|(&tick, &(q, v))| (f64::from(tick) * self.step, q, v))
    }

    /// Returns the coordinates at `ticks` ticks after the first key; outside of the keys, the
    /// coordinates of the nearest key.
    ///
    /// If every tick is a key, the result has the same bits as [`Scene::pose`].
    pub fn at(&self, ticks: f64) -> [T; N] {
        let last = self.ticks.len() - 1;
        let key = self.ticks.partition_point(|&key| f64::from(key) <= ticks);
        if key == 0 || last == 0 {
            return self.states[0].0;
        }
        if last < key {
            return self.states[last].0;
        }
        self.between(key - 1, key, ticks)
    }

    fn between(&self, from: usize, to: usize, ticks: f64) -> [T; N] {
        between(
            self.step,
            [self.ticks[from], self.ticks[to]],
            [self.states[from], self.states[to]],
            ticks,
        )
    }
}

/// Evaluates the cubic between the states at two ticks.
fn between<T: Float, const N: usize>(
    step: f64,
    ends: [u32; 2],
    states: [([T; N], [T; N]); 2],
    ticks: f64,
) -> [T; N] {
    let length = f64::from(ends[1] - ends[0]);
    hermite(step * length, (ticks - f64::from(ends[0])) / length, &states)
}

impl<T: Float> Scene<T> {
    /// Returns the motions of `pendulums` over the next `ticks` ticks as keys. Each coordinate
    /// differs from the [pose](Self::pose) by at most `bound` at all times. The scene stays
    /// unchanged.
    ///
    /// With a bound of zero, every tick is a key, and the curve has the same bits as the
    /// simulation.
    ///
    /// # Errors
    /// Returns an error if a pendulum belongs to another scene, or if the bound is negative,
    /// infinite or NaN.
    pub fn bake<S: SceneSystem<T, N>, const N: usize>(
        &mut self,
        pendulums: &[Handle<S, N>],
        ticks: u32,
        bound: f64,
    ) -> Result<Vec<Baked<T, N>>, SceneError> {
        if !(0.0..f64::INFINITY).contains(&bound) {
            return Err(SceneError::Setting {
                name: "bound",
                value: bound,
                required: "zero or positive",
            });
        }
        for &pendulum in pendulums {
            self.parts_of(pendulum)?;
        }
        let snapshot = self.snapshot();
        let mut live: Vec<Vec<([T; N], [T; N])>> =
            pendulums.iter().map(|&pendulum| vec![self.state(pendulum)]).collect();
        for _ in 0..ticks {
            self.advance_ticks(1);
            for (&pendulum, live) in pendulums.iter().zip(&mut live) {
                live.push(self.state(pendulum));
            }
        }
        self.restore(&snapshot)?;
        let step = self.step();
        Ok(live.iter().map(|live| thinned(step, live, bound)).collect())
    }
}

/// Returns the maximum of |p| on [0, 1] for the cubic p with the given values at 0, ⅓, ⅔ and 1.
fn farthest([a, b, c, d]: [f64; 4]) -> f64 {
    let linear = 0.5 * (-11.0 * a + 18.0 * b - 9.0 * c + 2.0 * d);
    let square = 4.5 * (2.0 * a - 5.0 * b + 4.0 * c - d);
    let cubic = 4.5 * (-a + 3.0 * b - 3.0 * c + d);
    let at = |x: f64| (a + x * (linear + x * (square + x * cubic))).abs();
    // The roots of the derivative are computed without cancellation.
    let root = (square * square - 3.0 * cubic * linear).max(0.0).sqrt();
    let sum = -(square + root.copysign(square));
    let inside = |x: f64| if 0.0 < x && x < 1.0 { at(x) } else { 0.0 };
    a.abs().max(d.abs()).max(inside(sum / (3.0 * cubic))).max(inside(linear / sum))
}

/// Selects keys by a greedy search: each key is as far from the previous key as the bound allows.
fn thinned<T: Float, const N: usize>(
    step: f64,
    live: &[([T; N], [T; N])],
    bound: f64,
) -> Baked<T, N> {
    let last = live.len() - 1;
    let fits = |from: usize, to: usize| {
        let ends = [from as u32, to as u32];
        (from..to).all(|tick| {
            let off = |part: f64| {
                let baked = between(step, ends, [live[from], live[to]], tick as f64 + part);
                let pose = hermite(step, part, &[live[tick], live[tick + 1]]);
                core::array::from_fn::<f64, N, _>(|i| (baked[i] - pose[i]).to_f64())
            };
            let off = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(off);
            (0..N).all(|i| farthest(off.map(|off| off[i])) <= bound)
        })
    };
    let mut baked = Baked { step, ticks: vec![0], states: vec![live[0]] };
    let mut from = 0;
    while from < last {
        // Doubling followed by bisection needs a logarithmic number of trials.
        let (mut good, mut stride) = (from + 1, 2);
        while 0.0 < bound && from + stride <= last && fits(from, from + stride) {
            good = from + stride;
            stride *= 2;
        }
        let mut bad = (from + stride).min(last + 1);
        while 0.0 < bound && good + 1 < bad {
            let middle = good.midpoint(bad);
            if fits(from, middle) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        baked.ticks.push(good as u32);
        baked.states.push(live[good]);
        from = good;
    }
    baked
}

#[cfg(test)]
mod tests {
    use super::farthest;

    #[test]
    fn the_farthest_of_a_cubic_is_found() {
        let check = |cubic: fn(f64) -> f64| {
            let found = farthest([0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(cubic));
            let tried = (0..=10_000).map(|k| cubic(f64::from(k) * 1e-4).abs()).fold(0.0, f64::max);
            assert!((found - tried).abs() < 1e-7, "{found} for {tried}");
        };
        check(|x| x * (1.0 - x));
        check(|x| x * (1.0 - x) * (0.5 - x));
        check(|x| 1.0 - 3.0 * x + x * x - 2.0 * x * x * x);
        check(|_| 0.25);
        check(|x| 2.0 * x - 1.5);
        check(|x| x * x * (1.0 - x));
    }
}
