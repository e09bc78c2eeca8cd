//! Cubic Bézier curves, their parts, and their approximation by chords.

/// A point of the plane.
pub(super) type Point = [f64; 2];

/// The number of chords per curve in the search for crossings and winding numbers.
pub(super) const CHORDS: usize = 16;

/// A cubic Bézier curve; lines are curves with `straight` = `true`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Curve {
    pub(super) points: [Point; 4],
    pub(super) straight: bool,
}

impl Curve {
    pub(super) fn count(&self) -> usize {
        if self.straight { 1 } else { CHORDS }
    }

    pub(super) fn at(&self, t: f64) -> Point {
        let [a, b, c, d] = self.points;
        let s = 1.0 - t;
        [0, 1].map(|k| s * s * (s * a[k] + 3.0 * t * b[k]) + t * t * (3.0 * s * c[k] + t * d[k]))
    }

    pub(super) fn slope(&self, t: f64) -> Point {
        let [a, b, c, d] = self.points;
        let s = 1.0 - t;
        [0, 1].map(|k| {
            3.0 * (s * s * (b[k] - a[k]) + 2.0 * s * t * (c[k] - b[k]) + t * t * (d[k] - c[k]))
        })
    }

    pub(super) fn chords(&self) -> impl Iterator<Item = [Point; 2]> {
        let count = self.count();
        let point = move |index: usize| match index {
            0 => self.points[0],
            _ if index == count => self.points[3],
            _ => self.at(index as f64 / count as f64),
        };
        (0..count).map(move |index| [point(index), point(index + 1)])
    }

    /// Returns the part between two parameters (de Casteljau 1959, in blossom form).
    pub(super) fn part(&self, from: f64, to: f64) -> Self {
        if from == 0.0 && to == 1.0 {
            return *self;
        }
        let blossom = |parameters: [f64; 3]| {
            let mut points = self.points;
            for (level, t) in parameters.into_iter().enumerate() {
                for k in 0..3 - level {
                    points[k] = [0, 1]
                        .map(|axis| points[k][axis] + t * (points[k + 1][axis] - points[k][axis]));
                }
            }
            points[0]
        };
        let points =
            [[from, from, from], [from, from, to], [from, to, to], [to, to, to]].map(blossom);
        Self { points, ..*self }
    }
}
