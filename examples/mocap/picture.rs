//! An animated picture of a skeleton and the pendulums on it: SVG whose `animate` elements list the
//! values of all keys.

use std::fmt::{self, Write};

/// The size of the picture, in its own units.
const SIZE: [f64; 2] = [1200.0, 700.0];
/// The bounds of the stage: left, right, ground and top.
const STAGE: [f64; 4] = [50.0, 1150.0, 490.0, 72.0];
/// The bounds of the chart of the angles: left, right, bottom and top.
const CHART: [f64; 4] = [76.0, 1150.0, 668.0, 556.0];
/// The lengths of the trails in seconds, starting with the faintest trail.
const TRAILS: [f64; 3] = [0.9, 0.5, 0.22];
/// The smallest distance between the faint figures along the path, in metres.
const GHOSTS: f64 = 0.45;
/// The thickness in metres of a limb, of a limb shorter than a quarter metre, and of the trunk.
const THICK: [f64; 3] = [0.075, 0.03, 0.16];

/// The contents of the picture.
pub(crate) struct Picture<'a> {
    /// The limbs, as lists of joints from the trunk outwards.
    pub(crate) limbs: Vec<Vec<usize>>,
    /// The joint of the head.
    pub(crate) head: Option<usize>,
    /// The positions of the joints at the keys in metres: along the plane, up, and towards the eye.
    pub(crate) poses: &'a [Vec<[f64; 3]>],
    /// The pendulums.
    pub(crate) worn: Vec<Worn<'a>>,
    /// The time of the last key.
    pub(crate) seconds: f64,
    /// Samples of the swings per interval between two keys.
    pub(crate) fine: usize,
}

/// A pendulum on the body.
pub(crate) struct Worn<'a> {
    pub(crate) label: &'a str,
    pub(crate) color: &'a str,
    pub(crate) joint: usize,
    /// The outline at rest, in metres from the pivot.
    pub(crate) outline: &'a [[f64; 2]],
    pub(crate) pivot: &'a [[f64; 2]],
    /// The path of the tip, in metres.
    pub(crate) tips: &'a [[f64; 2]],
    /// The angle on the spline and on the linear keys, in radians.
    pub(crate) spline: &'a [f64],
    pub(crate) linear: &'a [f64],
}

/// A function that writes the value of an attribute at a key.
type Value<'a> = dyn Fn(usize, &mut String) -> fmt::Result + 'a;

/// The transformation from metres to the units of the picture.
#[derive(Clone, Copy)]
struct Frame {
    scale: f64,
    left: f64,
    ground: f64,
}

impl Frame {
    fn at(self, along: f64, up: f64) -> [f64; 2] {
        [STAGE[0] + (along - self.left) * self.scale, STAGE[2] - (up - self.ground) * self.scale]
    }

    /// Draws the ground with a tick at each metre.
    fn ground(self, svg: &mut String) -> fmt::Result {
        let [left, right, ground, _] = STAGE;
        writeln!(
            svg,
            r##"<rect x="{left}" y="{ground}" width="{}" height="9" fill="#f0f0f0"/>"##,
            right - left
        )?;
        writeln!(
            svg,
            r##"<path d="M{left} {ground}H{right}" stroke="#888" stroke-width="1.5"/>"##
        )?;
        let end = self.left + (right - left) / self.scale;
        for metre in self.left.ceil() as i64..=end.floor() as i64 {
            let [x, y] = self.at(metre as f64, self.ground);
            writeln!(
                svg,
                r##"<path d="M{x:.1} {y}v9" stroke="#888" stroke-width="1.5"/><text x="{x:.1}" y="{}" text-anchor="middle" fill="#666" font-size="13">{metre} m</text>"##,
                y + 25.0
            )?;
        }
        Ok(())
    }
}

impl Picture<'_> {
    /// Returns the text of the file.
    pub(crate) fn draw(&self) -> String {
        let mut svg = String::new();
        // Writing to a `String` never fails.
        let _ = self.write(&mut svg);
        svg
    }

    fn write(&self, svg: &mut String) -> fmt::Result {
        let frame = self.frame();
        writeln!(
            svg,
            r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {} {}" font-family="Helvetica, Arial, sans-serif" font-size="14" fill="#333">
<title>Feathers on captured motion</title>
<rect width="100%" height="100%" fill="#fff"/>
<text x="50" y="38" font-size="23" font-weight="bold" fill="#222">Feathers on captured motion</text>
<text x="50" y="59" fill="#666">compound pendulums that hang from the joints of a captured clip; their equation is derived from six lines of energies</text>"##,
            SIZE[0], SIZE[1]
        )?;
        frame.ground(svg)?;
        self.ghosts(svg, frame)?;
        for worn in &self.worn {
            self.trail(svg, frame, worn)?;
        }
        self.body(svg, frame)?;
        self.legend(svg)?;
        self.clock(svg)?;
        self.chart(svg)?;
        writeln!(svg, "</svg>")
    }

    /// Returns the frame in which the whole path is as large as the stage allows.
    fn frame(&self) -> Frame {
        let points = || self.poses.iter().flatten();
        let least = |axis: usize| points().map(|at| at[axis]).fold(f64::INFINITY, f64::min);
        let most = |axis: usize| points().map(|at| at[axis]).fold(f64::NEG_INFINITY, f64::max);
        let margin = 0.25;
        let (width, height) = (most(0) - least(0) + 2.0 * margin, most(1) - least(1) + 0.15);
        let scale = f64::min((STAGE[1] - STAGE[0]) / width, (STAGE[2] - STAGE[3]) / height);
        let spare = (STAGE[1] - STAGE[0]) / scale - width;
        Frame { scale, left: least(0) - margin - spare / 2.0, ground: least(1) - THICK[0] / 2.0 }
    }

    /// Draws the limbs from the farthest to the nearest, each after the pendulums that are farther
    /// away.
    fn body(&self, svg: &mut String, frame: Frame) -> fmt::Result {
        let count = self.poses.len() as f64;
        let depth =
            |joint: usize| self.poses.iter().map(|pose| pose[joint][2]).sum::<f64>() / count;
        let end = |limb: &[usize]| limb[limb.len() - 1];
        let mut limbs: Vec<&Vec<usize>> = self.limbs.iter().collect();
        limbs.sort_by(|a, b| depth(end(a)).total_cmp(&depth(end(b))));
        let mut worn: Vec<&Worn<'_>> = self.worn.iter().collect();
        worn.sort_by(|a, b| depth(a.joint).total_cmp(&depth(b.joint)));
        let mut worn = worn.into_iter().peekable();
        for limb in limbs {
            while let Some(worn) = worn.next_if(|worn| depth(worn.joint) < depth(end(limb)) - 0.15)
            {
                self.feather(svg, frame, worn)?;
            }
            let near = ((depth(end(limb)) - depth(0)) / 0.2 + 0.5).clamp(0.0, 1.0);
            self.limb(svg, frame, limb, near)?;
        }
        worn.try_for_each(|worn| self.feather(svg, frame, worn))
    }

    /// Draws the faint figures along the path.
    fn ghosts(&self, svg: &mut String, frame: Frame) -> fmt::Result {
        let thick = THICK[0] * frame.scale;
        let mut places: Vec<f64> = Vec::new();
        for pose in self.poses {
            let place = pose[0][0];
            if places.iter().any(|other| (place - other).abs() < GHOSTS) {
                continue;
            }
            places.push(place);
            write!(
                svg,
                r##"<path fill="none" stroke="#3e485c" stroke-opacity=".055" stroke-linecap="round" stroke-linejoin="round" stroke-width="{thick:.1}" d=""##
            )?;
            for limb in &self.limbs {
                for (index, &joint) in limb.iter().enumerate() {
                    let [x, y] = frame.at(pose[joint][0], pose[joint][1]);
                    write!(svg, "{}{x:.1} {y:.1}", if index == 0 { 'M' } else { 'L' })?;
                }
            }
            writeln!(svg, r#""/>"#)?;
        }
        Ok(())
    }

    /// Draws a limb as a round-capped line; `near` is 0 for the farthest and 1 for the nearest
    /// limb.
    fn limb(&self, svg: &mut String, frame: Frame, limb: &[usize], near: f64) -> fmt::Result {
        let first = &self.poses[0];
        let apart = |a: usize, b: usize| {
            let along = |axis: usize| first[a][axis] - first[b][axis];
            (0..3).map(|axis| along(axis) * along(axis)).sum::<f64>().sqrt()
        };
        // Joints at the same place are drawn once.
        let mut joints: Vec<usize> = limb.to_vec();
        joints.dedup_by(|after, before| apart(*after, *before) < 1e-6);
        let length: f64 = joints.windows(2).map(|pair| apart(pair[0], pair[1])).sum();
        if joints.len() < 2 {
            return Ok(());
        }
        let shade = |from: f64, to: f64| (from + (to - from) * near) as u8;
        let color = format!(
            "#{:02x}{:02x}{:02x}",
            shade(186.0, 62.0),
            shade(194.0, 72.0),
            shade(206.0, 92.0)
        );
        let thick = if length < 0.25 { THICK[1] } else { THICK[0] };
        self.line(svg, frame, &joints, &color, thick)?;
        // The trunk reaches from the hips to the last joint at which other limbs begin.
        let begins = |joint: &usize| self.limbs.iter().any(|limb| limb[0] == *joint);
        let is_trunk = self.head.is_some_and(|head| joints.contains(&head));
        if let Some(top) = joints.iter().rposition(begins).filter(|&top| is_trunk && 0 < top) {
            self.line(svg, frame, &joints[..=top], &color, THICK[2])?;
        }
        if let Some(head) = self.head.filter(|head| joints[1..].contains(head)) {
            let top = joints[joints.len() - 1];
            write!(svg, r#"<circle r="{:.1}" fill="{color}""#, 0.1 * frame.scale)?;
            let middle = |key: usize| {
                let [a, b] = [self.poses[key][head], self.poses[key][top]];
                frame.at(f64::midpoint(a[0], b[0]), f64::midpoint(a[1], b[1]))
            };
            let x = |key: usize, value: &mut String| write!(value, "{:.1}", middle(key)[0]);
            let y = |key: usize, value: &mut String| write!(value, "{:.1}", middle(key)[1]);
            self.moving(svg, &[("cx", &x), ("cy", &y)])?;
            writeln!(svg, "</circle>")?;
        }
        Ok(())
    }

    fn line(
        &self,
        svg: &mut String,
        frame: Frame,
        joints: &[usize],
        color: &str,
        thick: f64,
    ) -> fmt::Result {
        write!(
            svg,
            r#"<polyline fill="none" stroke="{color}" stroke-width="{:.1}" stroke-linecap="round" stroke-linejoin="round""#,
            thick * frame.scale
        )?;
        let points = |key: usize, value: &mut String| {
            joints.iter().try_for_each(|&joint| {
                let [x, y] = frame.at(self.poses[key][joint][0], self.poses[key][joint][1]);
                write!(value, "{x:.1},{y:.1} ")
            })
        };
        self.moving(svg, &[("points", &points)])?;
        writeln!(svg, "</polyline>")
    }

    /// Draws a feather, turned about its pivot.
    fn feather(&self, svg: &mut String, frame: Frame, worn: &Worn<'_>) -> fmt::Result {
        let color = worn.color;
        self.turning(svg, "translate", |key, value| {
            let [x, y] = frame.at(worn.pivot[key * self.fine][0], worn.pivot[key * self.fine][1]);
            write!(value, "{x:.1} {y:.1}")
        })?;
        self.turning(svg, "rotate", |key, value| {
            write!(value, "{:.1}", -worn.spline[key * self.fine].to_degrees())
        })?;
        write!(
            svg,
            r##"<path fill="{color}" fill-opacity=".88" stroke="#fff" stroke-width="1" stroke-linejoin="round" d=""##
        )?;
        for (index, [x, y]) in worn.outline.iter().enumerate() {
            let letter = if index == 0 { 'M' } else { 'L' };
            write!(svg, "{letter}{:.1} {:.1}", x * frame.scale, -y * frame.scale)?;
        }
        let shaft = lowest(worn.outline) * frame.scale;
        writeln!(
            svg,
            r##"z"/><path d="M0 0V{:.1}" stroke="#fff" stroke-opacity=".7" stroke-width="1.2"/></g><circle r="3" fill="#fff" stroke="{color}" stroke-width="1.6"/></g>"##,
            -shaft * 0.93
        )
    }

    /// Draws the path of a tip: the whole path faintly, and the last moments.
    fn trail(&self, svg: &mut String, frame: Frame, worn: &Worn<'_>) -> fmt::Result {
        let tips: Vec<[f64; 2]> = worn.tips.iter().map(|&[x, y]| frame.at(x, y)).collect();
        let mut reached = vec![0.0];
        let mut path = String::new();
        for (index, [x, y]) in tips.iter().enumerate() {
            if 0 < index {
                let [a, b] = tips[index - 1];
                reached.push(reached[index - 1] + ((x - a) * (x - a) + (y - b) * (y - b)).sqrt());
            }
            write!(path, "{}{x:.1} {y:.1}", if index == 0 { 'M' } else { 'L' })?;
        }
        let (color, total) = (worn.color, reached[reached.len() - 1].max(1.0));
        let id = worn.label.replace(' ', "-");
        writeln!(
            svg,
            r#"<path id="{id}" d="{path}" pathLength="{total:.1}" fill="none" stroke="{color}" stroke-linecap="butt" stroke-opacity=".17"/>"#
        )?;
        let rate = (tips.len() - 1) as f64 / self.seconds;
        for (step, lasting) in TRAILS.iter().enumerate() {
            let behind = (lasting * rate) as usize;
            write!(
                svg,
                r#"<path d="{path}" pathLength="{total:.1}" fill="none" stroke="{color}" stroke-width="{:.1}" stroke-opacity="{}""#,
                1.6 + 1.0 * step as f64,
                0.22 + 0.06 * step as f64
            )?;
            let dashes = |key: usize, value: &mut String| {
                let now = key * self.fine;
                let from = reached[now.saturating_sub(behind)];
                write!(value, "0 {from:.1} {:.1} {:.0}", reached[now] - from, total + 9.0)
            };
            self.moving(svg, &[("stroke-dasharray", &dashes)])?;
            writeln!(svg, "</path>")?;
        }
        Ok(())
    }

    fn legend(&self, svg: &mut String) -> fmt::Result {
        let mut x = CHART[0];
        let y = CHART[3] - 16.0;
        write!(svg, r##"<text x="50" y="{y}" fill="#222" font-weight="bold">angles</text>"##)?;
        x += 40.0;
        for worn in &self.worn {
            let length = -lowest(worn.outline) * 100.0;
            writeln!(
                svg,
                r#"<rect x="{x}" y="{}" width="16" height="10" rx="3" fill="{}"/><text x="{}" y="{y}">{}, {length:.0} cm</text>"#,
                y - 9.5,
                worn.color,
                x + 22.0,
                worn.label
            )?;
            x += 160.0;
        }
        writeln!(
            svg,
            r##"<path d="M{x} {0}h26" stroke="#555" stroke-width="1.6"/><text x="{1}" y="{y}">spline</text><path d="M{2} {0}h26" stroke="#555" stroke-width="1.6" stroke-dasharray="2 3"/><text x="{3}" y="{y}">linear keys</text>"##,
            y - 4.5,
            x + 32.0,
            x + 96.0,
            x + 128.0
        )
    }

    /// Draws the time as columns of digits that move behind a window.
    fn clock(&self, svg: &mut String) -> fmt::Result {
        let tenths = (self.seconds * 10.0).ceil().max(1.0) as usize;
        let (right, y, line) = (1150.0, 38.0, 40.0);
        writeln!(
            svg,
            r##"<clipPath id="window"><rect x="{}" y="14" width="200" height="32"/></clipPath>
<g clip-path="url(#window)" font-size="23" font-weight="bold" fill="#222"><text x="{right}" y="{y}" text-anchor="end">s</text><text x="{}" y="{y}" text-anchor="end">.</text>"##,
            right - 180.0,
            right - 32.0
        )?;
        // Tenths, then seconds: a column moves every `per` tenths and starts again after `last`.
        for (x, per, last) in [(right - 19.0, 1, 9), (right - 38.0, 10, (tenths - 1) / 10)] {
            write!(svg, r#"<g text-anchor="end">"#)?;
            for value in 0..=last {
                write!(svg, r#"<text x="{x}" y="{}">{value}</text>"#, y + line * value as f64)?;
            }
            write!(
                svg,
                r#"<animateTransform attributeName="transform" type="translate" calcMode="discrete" {} values=""#,
                self.timing()
            )?;
            for tenth in 0..tenths {
                write!(svg, "0 {};", -line * (tenth / per % (last + 1)) as f64)?;
            }
            svg.pop();
            writeln!(svg, r#""/></g>"#)?;
        }
        writeln!(svg, "</g>")
    }

    /// Draws the angles over time, and a line at the current time.
    fn chart(&self, svg: &mut String) -> fmt::Result {
        let [left, right, bottom, top] = CHART;
        let degrees = || {
            self.worn
                .iter()
                .flat_map(|worn| worn.spline.iter().chain(worn.linear))
                .map(|angle| angle.to_degrees())
        };
        let most = degrees().fold(30.0, |peak: f64, angle| peak.max(angle.abs()));
        let step = [15.0, 30.0, 45.0, 90.0, 180.0]
            .into_iter()
            .find(|step| most <= 2.2 * step)
            .unwrap_or(360.0 * (most / 720.0).ceil());
        let middle = f64::midpoint(top, bottom);
        let y = |angle: f64| middle - angle / most * (bottom - top) / 2.0;
        let x = |time: f64| left + time / self.seconds * (right - left);
        let lines = (most / step).floor() as i64;
        for line in -lines..=lines {
            let angle = line as f64 * step;
            writeln!(
                svg,
                r##"<path d="M{left} {0:.1}H{right}" stroke="{1}"/><text x="{2}" y="{3:.1}" text-anchor="end" font-size="12" fill="#666">{angle:.0}°</text>"##,
                y(angle),
                if line == 0 { "#bbb" } else { "#e6e6e6" },
                left - 6.0,
                y(angle) + 4.0
            )?;
        }
        let every = (self.seconds / 12.0).ceil().max(1.0) as usize;
        for second in (0..=self.seconds.floor() as usize).step_by(every) {
            writeln!(
                svg,
                r##"<path d="M{0:.1} {bottom}v5" stroke="#888"/><text x="{0:.1}" y="{1}" text-anchor="middle" font-size="12" fill="#666">{second} s</text>"##,
                x(second as f64),
                bottom + 19.0
            )?;
        }
        for worn in &self.worn {
            for (angles, style) in [
                (worn.spline, r#"stroke-width="1.6""#),
                (worn.linear, r#"stroke-width="1.3" stroke-dasharray="2 3""#),
            ] {
                write!(
                    svg,
                    r#"<polyline fill="none" stroke="{}" {style} stroke-linejoin="round" points=""#,
                    worn.color
                )?;
                for (index, angle) in angles.iter().enumerate().step_by(self.fine.div_ceil(2)) {
                    let time = self.seconds * index as f64 / (angles.len() - 1) as f64;
                    write!(svg, "{:.1},{:.1} ", x(time), y(angle.to_degrees()))?;
                }
                writeln!(svg, r#""/>"#)?;
            }
        }
        writeln!(
            svg,
            r##"<path d="M{left} {}V{bottom}" stroke="#222" stroke-width="1.2"><animateTransform attributeName="transform" type="translate" {} values="0 0;{} 0"/></path>"##,
            top - 4.0,
            self.timing(),
            right - left
        )
    }

    fn timing(&self) -> String {
        format!(r#"dur="{:.4}s" repeatCount="indefinite""#, self.seconds)
    }

    /// Writes the attributes of an element that has been opened: their values for programs without
    /// animation, and their animations.
    fn moving(&self, svg: &mut String, attributes: &[(&str, &Value<'_>)]) -> fmt::Result {
        for (name, value) in attributes {
            write!(svg, r#" {name}=""#)?;
            value(self.still(), svg)?;
            svg.push('"');
        }
        svg.push('>');
        for (name, value) in attributes {
            write!(svg, r#"<animate attributeName="{name}" {} values=""#, self.timing())?;
            self.values(svg, value)?;
        }
        Ok(())
    }

    /// Opens a group that moves or turns.
    fn turning(
        &self,
        svg: &mut String,
        kind: &str,
        value: impl Fn(usize, &mut String) -> fmt::Result,
    ) -> fmt::Result {
        write!(svg, r#"<g transform="{kind}("#)?;
        value(self.still(), svg)?;
        write!(
            svg,
            r#")"><animateTransform attributeName="transform" type="{kind}" {} values=""#,
            self.timing()
        )?;
        self.values(svg, value)
    }

    /// Returns the key that programs without animation show, at two thirds of the clip.
    fn still(&self) -> usize {
        2 * (self.poses.len() - 1) / 3
    }

    /// Writes one value for each key.
    fn values(
        &self,
        svg: &mut String,
        value: impl Fn(usize, &mut String) -> fmt::Result,
    ) -> fmt::Result {
        for key in 0..self.poses.len() {
            if 0 < key {
                svg.push(';');
            }
            value(key, svg)?;
        }
        write!(svg, r#""/>"#)
    }
}

/// Returns the height of the lowest point of an outline.
fn lowest(outline: &[[f64; 2]]) -> f64 {
    outline.iter().map(|point| point[1]).fold(0.0, f64::min)
}

#[cfg(test)]
mod tests {
    use super::{Picture, Worn};

    fn picture() -> String {
        let poses: Vec<Vec<[f64; 3]>> = (0..7)
            .map(|k| {
                vec![
                    [0.3 * f64::from(k), 1.0, 0.0],
                    [0.3 * f64::from(k), 1.6, 0.1],
                    [0.0, 0.0, -0.1],
                ]
            })
            .collect();
        let pivot: Vec<[f64; 2]> = (0..13).map(|k| [0.15 * f64::from(k), 1.6]).collect();
        let angles: Vec<f64> = (0..13).map(|k| 0.1 * f64::from(k)).collect();
        let worn = Worn {
            label: "head",
            color: "#009e73",
            joint: 1,
            outline: &[[0.02, 0.0], [0.0, -0.2], [-0.02, 0.0]],
            pivot: &pivot,
            tips: &pivot,
            spline: &angles,
            linear: &angles,
        };
        let limbs = vec![vec![0, 1], vec![0, 2]];
        Picture { limbs, head: Some(1), poses: &poses, worn: vec![worn], seconds: 1.25, fine: 2 }
            .draw()
    }

    #[test]
    fn every_element_is_closed() {
        let svg = picture();
        for name in [
            "svg",
            "g",
            "text",
            "path",
            "polyline",
            "circle",
            "rect",
            "animate",
            "animateTransform",
            "clipPath",
        ] {
            let opened = svg.matches(&format!("<{name} ")).count()
                + svg.matches(&format!("<{name}>")).count();
            let closed = svg.matches(&format!("</{name}>")).count();
            let alone = svg
                .split(&format!("<{name} "))
                .skip(1)
                .filter(|rest| rest[..rest.find('>').unwrap()].ends_with('/'))
                .count();
            assert_eq!(opened, closed + alone, "{name}");
        }
    }

    #[test]
    fn animations_have_a_finite_value_for_each_key() {
        let svg = picture();
        let lists: Vec<&str> =
            svg.split("values=\"").skip(1).map(|rest| &rest[..rest.find('"').unwrap()]).collect();
        let counts: Vec<usize> = lists.iter().map(|list| list.split(';').count()).collect();
        // Three strokes of the trail, two limbs, two coordinates of the head, two movements of the
        // feather; 13 tenths on the clock's two columns; the line in the chart.
        assert_eq!(counts.iter().filter(|&&count| count == 7).count(), 9, "{counts:?}");
        assert_eq!(counts.iter().filter(|&&count| count == 13).count(), 2, "{counts:?}");
        assert_eq!(counts.len(), 12, "{counts:?}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }
}
