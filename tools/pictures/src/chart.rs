//! Curves, dots and texts on two axes.

use crate::axis::Scale;
use crate::labels::spread;
use crate::{Axis, FINE, color, px, text};
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use std::error::Error;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Plane<'a> = DrawingArea<SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// A line through points.
#[derive(Clone, Debug)]
pub struct Curve {
    points: Vec<(f64, f64)>,
    name: String,
    color: RGBColor,
    width: f64,
    opacity: f64,
    dashed: bool,
    marked: bool,
    filled: bool,
}

impl Curve {
    /// Creates a grey line of two pixels without a name.
    pub fn new(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self {
            points: points.into_iter().collect(),
            name: String::new(),
            color: color::GREY,
            width: 2.0,
            opacity: 1.0,
            dashed: false,
            marked: false,
            filled: false,
        }
    }

    /// Sets the name, which is written at the end of the line.
    pub fn name(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Sets the colour.
    pub fn color(mut self, color: RGBColor) -> Self {
        self.color = color;
        self
    }

    /// Sets the width in pixels.
    pub fn width(mut self, width: f64) -> Self {
        self.width = width;
        self
    }

    /// Sets the opacity; 0 is invisible.
    pub fn opacity(mut self, opacity: f64) -> Self {
        self.opacity = opacity;
        self
    }

    /// Draws the line with dashes.
    pub fn dashed(mut self) -> Self {
        self.dashed = true;
        self
    }

    /// Draws a dot at every point.
    pub fn marked(mut self) -> Self {
        self.marked = true;
        self
    }

    /// Fills the area enclosed by the line.
    pub fn filled(mut self) -> Self {
        self.filled = true;
        self
    }
}

/// Curves, dots and texts on two axes.
#[derive(Clone, Debug)]
pub struct Chart {
    title: String,
    x: Axis,
    y: Axis,
    equal: bool,
    curves: Vec<Curve>,
    dots: Vec<(f64, f64, f64, RGBColor)>,
    texts: Vec<(f64, f64, String, RGBColor)>,
}

impl Chart {
    /// Creates an empty chart.
    pub fn new(x: Axis, y: Axis) -> Self {
        let (title, curves, dots, texts) = (String::new(), Vec::new(), Vec::new(), Vec::new());
        Self { title, x, y, equal: false, curves, dots, texts }
    }

    /// Creates a drawing: a chart without axes and with equal scales in both directions.
    pub fn drawing() -> Self {
        Self { equal: true, ..Self::new(Axis::bare(), Axis::bare()) }
    }

    /// Sets the title above the chart.
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// Adds a curve above the previous curves.
    pub fn curve(mut self, curve: Curve) -> Self {
        self.curves.push(curve);
        self
    }

    /// Adds a line through points whose colour changes along the line from one hue to another, in
    /// degrees.
    pub fn way(
        mut self,
        points: impl IntoIterator<Item = (f64, f64)>,
        (from, to): (f64, f64),
    ) -> Self {
        let points: Vec<(f64, f64)> = points.into_iter().collect();
        let piece = points.len().div_ceil(60).max(1);
        for start in (0..points.len().saturating_sub(1)).step_by(piece) {
            let end = (start + piece + 1).min(points.len());
            let hue = from + (to - from) * start as f64 / points.len() as f64;
            let curve = Curve::new(points[start..end].iter().copied());
            self = self.curve(curve.color(color::hue(hue)));
        }
        self
    }

    /// Adds a dot of `radius` pixels above all curves.
    pub fn dot(mut self, (x, y): (f64, f64), radius: f64, color: RGBColor) -> Self {
        self.dots.push((x, y, radius, color));
        self
    }

    /// Adds a text centred at a point.
    pub fn text(mut self, (x, y): (f64, f64), text: impl Into<String>, color: RGBColor) -> Self {
        self.texts.push((x, y, text.into(), color));
        self
    }

    fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        let dots = self.dots.iter().map(|dot| (dot.0, dot.1));
        let texts = self.texts.iter().map(|text| (text.0, text.1));
        self.curves.iter().flat_map(|curve| curve.points.iter().copied()).chain(dots).chain(texts)
    }

    pub(crate) fn draw(&self, area: &Area<'_>) -> Result<(), Box<dyn Error>> {
        let (width, height) = area.dim_in_pixel();
        let (width, height) = (f64::from(width), f64::from(height));
        let mut xs = self.x.ends(self.points().map(|point| point.0));
        let mut ys = self.y.ends(self.points().map(|point| point.1));
        let bare = [&self.x, &self.y].map(|axis| axis.scale == Scale::Bare);
        // The widest letters are as wide as the font is high; most are half as wide.
        let longest = |texts: &mut dyn Iterator<Item = usize>| texts.max().unwrap_or(0) as f64;
        let fine = f64::from(FINE);
        let y_ticks = self.y.ticks(ys, (height / (34.0 * fine)) as usize);
        let ticks = longest(&mut y_ticks.iter().map(|tick| tick.1.chars().count()));
        // Wide curves have bold names.
        let names = self.curves.iter().map(|curve| {
            let letter = if 3.0 <= curve.width { 8.6 } else { 7.6 };
            letter * curve.name.chars().count() as f64
        });
        let names = names.fold(0.0, f64::max);
        let left = if bare[1] { 12.0 } else { 36.0 + 8.0 * ticks } * fine;
        let right = if names == 0.0 { 14.0 } else { 34.0 + names } * fine;
        let top = if self.title.is_empty() { 10.0 } else { 40.0 } * fine;
        let bottom = if bare[0] { 10.0 } else { 50.0 } * fine;
        let (across, up) = (width - left - right, height - top - bottom);
        if self.equal {
            let scale = ((xs.1 - xs.0) / across).max((ys.1 - ys.0) / up);
            let widened = |(from, to): (f64, f64), pixels: f64| {
                let (middle, half) = (f64::midpoint(from, to), scale * pixels / 2.0);
                (middle - half, middle + half)
            };
            (xs, ys) = (widened(xs, across), widened(ys, up));
        }
        let (ends_x, ends_y) =
            ((left as i32)..((width - right) as i32), (top as i32)..((height - bottom) as i32));
        // Pixels are counted downwards.
        let (x0, y0) = area.get_base_pixel();
        let plane = area.apply_coord_spec(Cartesian2d::<RangedCoordf64, RangedCoordf64>::new(
            xs.0..xs.1,
            ys.0..ys.1,
            (x0 + ends_x.start..x0 + ends_x.end, y0 + ends_y.end..y0 + ends_y.start),
        ));
        self.draw_axes(area, &plane, (xs, ys), &y_ticks)?;
        if !self.title.is_empty() {
            let style = text::style(15, color::TEXT).middle();
            let middle = i32::midpoint(ends_x.start, ends_x.end);
            area.draw(&Text::new(self.title.clone(), (middle, px(20)), style))?;
        }
        for curve in &self.curves {
            self.draw_curve(&plane, curve, (xs, ys))?;
        }
        for &(x, y, radius, color) in &self.dots {
            let at = (self.x.place(x), self.y.place(y));
            plane.draw(&Circle::new(at, (radius * fine) as i32, color.filled()))?;
        }
        for (x, y, words, color) in &self.texts {
            let at = (self.x.place(*x), self.y.place(*y));
            plane.draw(&Text::new(words.clone(), at, text::style(14, *color).middle()))?;
        }
        self.draw_names(area, &plane, ends_x.end, (xs, ys))
    }

    fn draw_axes(
        &self,
        area: &Area<'_>,
        plane: &Plane<'_>,
        (xs, ys): ((f64, f64), (f64, f64)),
        y_ticks: &[(f64, String)],
    ) -> Result<(), Box<dyn Error>> {
        let (x0, y0) = area.get_base_pixel();
        let pixel = |x: f64, y: f64| {
            let (x, y) = plane.map_coordinate(&(x, y));
            (x - x0, y - y0)
        };
        let (corner, far) = (pixel(xs.0, ys.0), pixel(xs.1, ys.1));
        let mesh = color::GREY.mix(0.28).stroke_width(FINE);
        let small = text::style(13, color::TEXT);
        let most = (f64::from(far.0 - corner.0) / (64.0 * f64::from(FINE))) as usize;
        for (place, words) in self.x.ticks(xs, most.max(2)) {
            let (x, _) = pixel(place, ys.0);
            area.draw(&PathElement::new([(x, corner.1), (x, far.1)], mesh))?;
            area.draw(&Text::new(words, (x, corner.1 + px(14)), small.middle()))?;
        }
        for (place, words) in y_ticks {
            let (_, y) = pixel(xs.0, *place);
            area.draw(&PathElement::new([(corner.0, y), (far.0, y)], mesh))?;
            area.draw(&Text::new(words.clone(), (corner.0 - px(8), y), small.right()))?;
        }
        let middle = (i32::midpoint(corner.0, far.0), i32::midpoint(corner.1, far.1));
        let style = text::style(14, color::TEXT);
        if !self.x.name.is_empty() {
            let at = (middle.0, corner.1 + px(36));
            area.draw(&Text::new(self.x.name.clone(), at, style.middle()))?;
        }
        if !self.y.name.is_empty() {
            let turned = style.middle().transform(FontTransform::Rotate270);
            area.draw(&Text::new(self.y.name.clone(), (px(16), middle.1), turned))?;
        }
        Ok(())
    }

    fn draw_curve(
        &self,
        plane: &Plane<'_>,
        curve: &Curve,
        (xs, ys): ((f64, f64), (f64, f64)),
    ) -> Result<(), Box<dyn Error>> {
        let fine = f64::from(FINE);
        let style = curve.color.mix(curve.opacity).stroke_width((curve.width * fine) as u32);
        let inside = |(x, y): (f64, f64)| {
            let edge = [1e-9 * (xs.1 - xs.0), 1e-9 * (ys.1 - ys.0)];
            (xs.0 - edge[0]..=xs.1 + edge[0]).contains(&x)
                && (ys.0 - edge[1]..=ys.1 + edge[1]).contains(&y)
        };
        let places = curve.points.iter().map(|&(x, y)| (self.x.place(x), self.y.place(y)));
        let places: Vec<(f64, f64)> = places.filter(|place| inside(*place)).collect();
        if curve.filled {
            plane.draw(&Polygon::new(places.clone(), curve.color.mix(0.1).filled()))?;
        }
        if curve.dashed {
            let dashes = DashedPathElement::new(places.clone(), 6 * FINE, 5 * FINE, style);
            plane.draw(&dashes)?;
        } else {
            plane.draw(&PathElement::new(places.clone(), style))?;
        }
        if curve.marked {
            for place in places {
                let radius = ((curve.width + 1.4) * fine) as i32;
                plane.draw(&Circle::new(place, radius, curve.color.filled()))?;
            }
        }
        Ok(())
    }

    /// Writes the names of the curves into the margin, connected to their ends by lines.
    fn draw_names(
        &self,
        area: &Area<'_>,
        plane: &Plane<'_>,
        right: i32,
        (xs, ys): ((f64, f64), (f64, f64)),
    ) -> Result<(), Box<dyn Error>> {
        let (x0, y0) = area.get_base_pixel();
        let mut rows = Vec::new();
        for curve in self.curves.iter().filter(|curve| !curve.name.is_empty()) {
            let places = curve.points.iter().map(|&(x, y)| (self.x.place(x), self.y.place(y)));
            let inside =
                places.filter(|place| place.0 <= xs.1 + 1e-9 && (ys.0..=ys.1).contains(&place.1));
            // The end is the rightmost point.
            if let Some(end) = inside.max_by(|a, b| a.0.total_cmp(&b.0)) {
                let (x, y) = plane.map_coordinate(&end);
                rows.push((curve, (x - x0, y - y0)));
            }
        }
        let wanted: Vec<f64> = rows.iter().map(|row| f64::from(row.1.1)).collect();
        let (top, bottom) =
            (plane.map_coordinate(&(xs.0, ys.1)).1, plane.map_coordinate(&(xs.0, ys.0)).1);
        let gap = f64::from(px(19));
        let heights = spread(&wanted, gap, f64::from(top - y0), f64::from(bottom - y0));
        for ((curve, end), height) in rows.into_iter().zip(heights) {
            let at = (right + px(22), height as i32);
            let thin = curve.color.mix(0.5).stroke_width(FINE);
            let joint = (right + px(6), end.1);
            area.draw(&PathElement::new([end, joint, (at.0 - px(4), at.1)], thin))?;
            let style = text::style(14, curve.color);
            let style = if 3.0 <= curve.width { style.bold() } else { style.left() };
            area.draw(&Text::new(curve.name.clone(), at, style))?;
        }
        Ok(())
    }
}
