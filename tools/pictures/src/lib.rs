//! Charts and drawings as SVG, drawn by `plotters`, readable on light and on dark ground.
//!
//! A [`Picture`] is a title above [`Chart`]s side by side. Curves carry their names at their ends,
//! and there is no ground: what is behind the picture is seen through it, and every colour of
//! [`color`] stands out from white as well as from black.

mod axis;
mod chart;
pub mod color;
mod labels;
mod text;

pub use axis::Axis;
pub use chart::{Chart, Curve};
pub use plotters::style::RGBColor;

use plotters::prelude::*;
use std::error::Error;
use std::path::Path;

/// Pixels of `plotters`, which are integers, within a pixel of the picture.
const FINE: u32 = 10;

/// A title above charts side by side.
#[derive(Clone, Debug)]
pub struct Picture {
    title: String,
    note: String,
    size: (u32, u32),
    charts: Vec<Chart>,
}

impl Picture {
    /// A picture of `width` × `height` pixels; the title is best a sentence.
    pub fn new(title: impl Into<String>, size: (u32, u32)) -> Self {
        Self { title: title.into(), note: String::new(), size, charts: Vec::new() }
    }

    /// Adds a small line below.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }

    /// Adds a chart to the right of those before; all are of one width.
    pub fn chart(mut self, chart: Chart) -> Self {
        self.charts.push(chart);
        self
    }

    /// The text of the SVG.
    pub fn svg(&self) -> Result<String, Box<dyn Error>> {
        let (width, height) = self.size;
        let fine = (width * FINE, height * FINE);
        let mut svg = String::new();
        let root = SVGBackend::with_string(&mut svg, fine).into_drawing_area();
        let (mut top, mut bottom) = (0, height);
        if !self.title.is_empty() {
            let at = (px(16), px(24));
            root.draw(&Text::new(self.title.clone(), at, text::style(18, color::TEXT).bold()))?;
            top = 44;
        }
        if !self.note.is_empty() {
            bottom -= 22;
            let at = (px(16), px(bottom as i32 + 8));
            root.draw(&Text::new(self.note.clone(), at, text::style(12, color::TEXT).left()))?;
        }
        let area = root.margin(top * FINE, (height - bottom) * FINE, 0, 0);
        for (chart, part) in self.charts.iter().zip(area.split_evenly((1, self.charts.len()))) {
            chart.draw(&part)?;
        }
        root.present()?;
        drop((area, root));
        // The same picture in pixels of the usual size.
        let [from, to] = [fine, self.size].map(|(w, h)| format!(r#"width="{w}" height="{h}""#));
        Ok(svg.replacen(&from, &to, 1))
    }

    /// Writes the picture, and the folder of it where there is none.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Box<dyn Error>> {
        if let Some(folder) = path.as_ref().parent() {
            std::fs::create_dir_all(folder)?;
        }
        Ok(std::fs::write(path, self.svg()?)?)
    }
}

/// Fine pixels.
fn px(pixels: i32) -> i32 {
    pixels * FINE as i32
}
