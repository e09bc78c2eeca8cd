//! Charts and drawings as SVG, drawn by `plotters`, legible on light and dark backgrounds.
//!
//! A [`Picture`] is a title above [`Chart`]s in a row. Curves have their names at their ends. The
//! background is transparent, and every colour of [`color`] has sufficient contrast on white and on
//! black.

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

/// The program of the guide that draws, with its own features of plotters.
#[cfg(doctest)]
#[doc = include_str!("../../../pendulum-runtime/src/guide/picture.md")]
pub struct Guide;

/// The number of integer pixels of `plotters` per pixel of the picture.
const FINE: u32 = 10;

/// A title above charts in a row.
#[derive(Clone, Debug)]
pub struct Picture {
    title: String,
    note: String,
    size: (u32, u32),
    charts: Vec<Chart>,
}

impl Picture {
    /// Creates a picture of `width` × `height` pixels. The title should be a sentence.
    pub fn new(title: impl Into<String>, size: (u32, u32)) -> Self {
        Self { title: title.into(), note: String::new(), size, charts: Vec::new() }
    }

    /// Adds a line in small letters below the charts.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }

    /// Adds a chart to the right of the previous charts. All charts have the same width.
    pub fn chart(mut self, chart: Chart) -> Self {
        self.charts.push(chart);
        self
    }

    /// Returns the text of the SVG.
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
        // The size of the picture in ordinary pixels.
        let [from, to] = [fine, self.size].map(|(w, h)| format!(r#"width="{w}" height="{h}""#));
        Ok(svg.replacen(&from, &to, 1))
    }

    /// Writes the picture to a file. Creates the folder if it does not exist.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Box<dyn Error>> {
        if let Some(folder) = path.as_ref().parent() {
            std::fs::create_dir_all(folder)?;
        }
        Ok(std::fs::write(path, self.svg()?)?)
    }
}

/// Converts to the integer pixels of `plotters`.
fn px(pixels: i32) -> i32 {
    pixels * FINE as i32
}
