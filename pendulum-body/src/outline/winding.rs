//! Winding numbers of an outline on both sides of each of its curves.

use super::Outline;
use super::curve::Curve;
use super::curve::Point;
use pendulum_core::body::BodyError;
use pendulum_core::scalar::Real;

impl Outline {
    /// Returns the pieces of the curves between all crossings. The weight of a piece is 1 if only
    /// its left side is inside, −1 if only its right side is inside, and otherwise 0.
    pub(super) fn boundary(&self, slack: f64) -> Result<Vec<(Curve, f64)>, BodyError> {
        let cuts = self.cuts()?;
        // Runs of curves without cuts between them, which have a common weight.
        let mut runs: Vec<Vec<Curve>> = Vec::new();
        for (ring, cuts) in self.rings.iter().zip(&cuts) {
            runs.push(Vec::new());
            for (curve, cuts) in ring.iter().zip(cuts) {
                let mut from = 0.0;
                for &cut in cuts {
                    let last = runs.len() - 1;
                    if from < cut {
                        runs[last].push(curve.part(from, cut));
                    }
                    runs.push(Vec::new());
                    from = cut;
                }
                let last = runs.len() - 1;
                if from < 1.0 {
                    runs[last].push(curve.part(from, 1.0));
                }
            }
        }
        let chords: Vec<Vec<[Point; 2]>> =
            runs.iter().map(|run| run.iter().flat_map(Curve::chords).collect()).collect();
        let all: Vec<[Point; 2]> = chords.iter().flatten().copied().collect();
        let strips = [Strips::new(&all, 1), Strips::new(&all, 0)];
        let mut boundary = Vec::new();
        let mut before = 0;
        for (index, run) in runs.iter().enumerate() {
            let length = |chord: &[Point; 2]| {
                let [x, y] = [chord[1][0] - chord[0][0], chord[1][1] - chord[0][1]];
                x * x + y * y
            };
            let Some(longest) = (0..chords[index].len())
                .max_by(|&a, &b| length(&chords[index][a]).total_cmp(&length(&chords[index][b])))
            else {
                continue;
            };
            let right =
                winding_to_the_right(before + longest, chords[index][longest], &strips, slack);
            before += chords[index].len();
            let sides = [right + 1, right].map(|winding| i32::from(self.rule.inside(winding)));
            let weight = f64::from(sides[0] - sides[1]);
            boundary.extend(run.iter().map(|&curve| (curve, weight)));
        }
        Ok(boundary)
    }
}

/// Returns the winding number on the right side of the midpoint of chord `number`, from the
/// crossings of a ray with the chords in `strips` across y and x. Chords closer than `slack`
/// coincide.
fn winding_to_the_right(number: usize, own: [Point; 2], strips: &[Strips; 2], slack: f64) -> i32 {
    let [x, y] = [0, 1].map(|axis| 0.5 * (own[0][axis] + own[1][axis]));
    // Coincident chords must use the same axis in spite of rounding errors. The constant is
    // arbitrary, because no drawing has lines of exactly this slope.
    let steep = (own[1][0] - own[0][0]).abs() <= 0.7310585786 * (own[1][1] - own[0][1]).abs();
    let mut winding = 0;
    let met = if steep { strips[0].at(y) } else { strips[1].at(x) };
    for &(other, [from, to]) in met.iter().filter(|(other, _)| *other != number) {
        // The ray leads along x, or along y with the axes rotated by a quarter turn.
        let (from, to, x, y) =
            if steep { (from, to, x, y) } else { ([from[1], -from[0]], [to[1], -to[0]], y, -x) };
        if (from[1] <= y) == (to[1] <= y) {
            continue;
        }
        let at = from[0] + (y - from[1]) / (to[1] - from[1]) * (to[0] - from[0]);
        // The numbers of coincident chords define their order along the ray.
        if if (x - at).abs() <= slack { number < other } else { x < at } {
            winding += if from[1] <= y { 1 } else { -1 };
        }
    }
    // The ray starts on the right side of the chord if the chord leads upwards, otherwise on its
    // left side.
    let up = if steep { own[0][1] < own[1][1] } else { own[1][0] < own[0][0] };
    if up { winding } else { winding - 1 }
}

/// Chords in strips across one axis, to find the chords that a line along the other axis may cross.
struct Strips {
    low: f64,
    /// The number of strips per metre.
    scale: f64,
    /// The chords in each strip, with their numbers.
    chords: Vec<Vec<(usize, [Point; 2])>>,
}

impl Strips {
    fn new(chords: &[[Point; 2]], axis: usize) -> Self {
        let values = || chords.iter().flatten().map(|point| point[axis]);
        let (low, high) =
            (values().fold(f64::INFINITY, Real::min), values().fold(f64::NEG_INFINITY, Real::max));
        // The square root limits the memory for chords that span all strips.
        let count = 1 + 2 * Real::sqrt(chords.len() as f64) as usize;
        let scale = count as f64 / (high - low);
        let scale = if scale.is_finite() { scale } else { 0.0 };
        let mut strips = Self { low, scale, chords: vec![Vec::new(); count] };
        for (number, chord) in chords.iter().enumerate() {
            let [a, b] = chord.map(|point| strips.strip(point[axis]));
            for strip in &mut strips.chords[if a < b { a..=b } else { b..=a }] {
                strip.push((number, *chord));
            }
        }
        strips
    }

    /// Returns the index of the strip of a value, with the same rounding for chords and lines.
    fn strip(&self, value: f64) -> usize {
        let place = (value - self.low) * self.scale;
        (place as usize).min(self.chords.len() - 1)
    }

    fn at(&self, value: f64) -> &[(usize, [Point; 2])] {
        &self.chords[self.strip(value)]
    }
}
