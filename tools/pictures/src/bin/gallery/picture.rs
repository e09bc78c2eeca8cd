//! An animated picture of a motion: the path of a point, and the moving line to which the point
//! belongs.

use std::fmt::Write;

/// The size of a picture in pixels; `MARGIN` is the margin around the drawing.
const SIZE: [f64; 2] = [320.0, 220.0];
const MARGIN: f64 = 12.0;

/// The largest number of positions of a moving point, that of a line at least, and the largest
/// number of points of the path.
const POSES: usize = 360;
const FEWEST: usize = 120;
const POINTS: usize = 800;

/// A line through points at one time, with its shadow. The last point draws the path.
pub(crate) struct Frame {
    line: Vec<[f64; 2]>,
    shadow: Vec<[f64; 2]>,
}

impl Frame {
    pub(crate) fn new(line: impl IntoIterator<Item = [f64; 2]>) -> Self {
        Self { line: line.into_iter().collect(), shadow: Vec::new() }
    }

    /// Creates a frame of a line in space, seen from `distance`, with its shadow on a floor at the
    /// height `floor`.
    pub(crate) fn in_space(
        line: impl IntoIterator<Item = [f64; 3]>,
        floor: f64,
        distance: f64,
    ) -> Self {
        let pairs = line.into_iter().map(|[x, y, z]| {
            let [own, below] = [z, floor].map(|height| perspective([x, y, height], distance));
            (own, below)
        });
        let (line, shadow) = pairs.unzip();
        Self { line, shadow }
    }
}

/// Frames at equal intervals of time, shown in an animation of eight seconds.
pub(crate) struct Picture {
    frames: Vec<Frame>,
    mark: Option<[f64; 2]>,
}

impl Picture {
    pub(crate) fn new(frames: impl Iterator<Item = Frame>) -> Self {
        Self { frames: frames.collect(), mark: None }
    }

    /// Returns the same picture with a fixed dot.
    pub(crate) fn with_mark(self, mark: [f64; 2]) -> Self {
        Self { mark: Some(mark), ..self }
    }

    /// Returns the picture as SVG, in colours that are visible on white and on black.
    pub(crate) fn svg(&self) -> String {
        let points = || {
            let all = self.frames.iter().flat_map(|frame| frame.line.iter().chain(&frame.shadow));
            all.chain(&self.mark)
        };
        let range = |k: usize| {
            points().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| {
                [low.min(point[k]), high.max(point[k])]
            })
        };
        let [x, y] = [range(0), range(1)];
        let scale = [x, y]
            .into_iter()
            .zip(SIZE)
            .map(|([low, high], size)| (size - 2.0 * MARGIN) / (high - low))
            .fold(f64::INFINITY, f64::min);
        let place = |point: &[f64; 2]| {
            let [x, y] = [
                SIZE[0] / 2.0 + scale * (point[0] - f64::midpoint(x[0], x[1])),
                SIZE[1] / 2.0 - scale * (point[1] - f64::midpoint(y[0], y[1])),
            ];
            format!("{x:.1},{y:.1}")
        };
        let line = |points: &[[f64; 2]]| points.iter().map(place).collect::<Vec<_>>().join(" ");
        let every = self.frames.len().div_ceil(POINTS).max(1);
        let path: Vec<_> = self
            .frames
            .iter()
            .step_by(every)
            .filter_map(|frame| frame.line.last().copied())
            .collect();
        let length = self.frames.first().map_or(1, |frame| frame.line.len().max(1));
        let every = self.frames.len().div_ceil((POSES / length).max(FEWEST)).max(1);
        let poses = || self.frames.iter().step_by(every);
        let seconds = 8;
        let [width, height] = SIZE;
        let mut text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' \
             viewBox='0 0 {width} {height}' fill='none' stroke-linecap='round' \
             stroke-linejoin='round'>\n\
             <polyline stroke='#3b8eea' stroke-width='1.2' stroke-opacity='.8' points='{}'/>\n",
            line(&path)
        );
        if let Some(mark) = &self.mark {
            let at = place(mark);
            let (x, y) = at.split_once(',').unwrap_or_default();
            let _ = writeln!(text, "<circle cx='{x}' cy='{y}' r='6' fill='#e0a030'/>");
        }
        let mut moving = |style: &str, of: fn(&Frame) -> &[[f64; 2]]| {
            let values: Vec<_> = poses().map(|frame| line(of(frame))).collect();
            if poses().next().is_some_and(|frame| 1 < of(frame).len()) {
                // Writing to a string cannot fail.
                let _ = writeln!(
                    text,
                    "<polyline stroke='#8a8f98' {style} points='{}'><animate attributeName='points' \
                     dur='{seconds}s' repeatCount='indefinite' values='{}'/></polyline>",
                    values[0],
                    values.join(";")
                );
            }
        };
        moving("stroke-width='5' stroke-opacity='.25'", |frame| &frame.shadow);
        moving("stroke-width='2.5'", |frame| &frame.line);
        let ends: Vec<_> = poses().filter_map(|frame| frame.line.last()).map(place).collect();
        let at = |k: usize| {
            let one = |place: &String| place.split(',').nth(k).unwrap_or_default().to_owned();
            ends.iter().map(one).collect::<Vec<_>>()
        };
        let (x, y) = (at(0), at(1));
        let animate = |name: &str, values: &[String]| {
            format!(
                "<animate attributeName='{name}' dur='{seconds}s' repeatCount='indefinite' \
                 values='{}'/>",
                values.join(";")
            )
        };
        let _ = writeln!(
            text,
            "<circle cx='{}' cy='{}' r='5' fill='#e4572e'>{}{}</circle>",
            x.first().map_or("0", |x| x),
            y.first().map_or("0", |y| y),
            animate("cx", &x),
            animate("cy", &y)
        );
        text + "</svg>\n"
    }
}

/// Projects a point in space for a viewer slightly above it.
pub(crate) fn seen([x, y, z]: [f64; 3]) -> [f64; 2] {
    let (sin, cos) = 0.5_f64.sin_cos();
    let (across, away) = (x * cos - y * sin, x * sin + y * cos);
    [across, 0.94 * z + 0.34 * away]
}

/// Projects a point in space for a viewer at `distance` from the origin, slightly above it.
fn perspective(point: [f64; 3], distance: f64) -> [f64; 2] {
    let [across, up] = seen(point);
    // What `seen` leaves out is the depth.
    let [x, y, z] = point;
    let (sin, cos) = 0.5_f64.sin_cos();
    let depth = 0.94 * (x * sin + y * cos) - 0.34 * z;
    [across, up].map(|part| part * distance / (distance + depth))
}
