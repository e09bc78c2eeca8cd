//! The pictures: energy and phase against time, separation of chaotic runs, error against step over
//! kinks.

use crate::report::{Curve, Figure};
use ::systems::colors::COLORS;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;
use std::path::Path;

const SIZE: (u32, u32) = (960, 560);
const LEGEND: u32 = 250;
const FONT: &str = "sans-serif";

/// The texts of a picture.
struct Page {
    figure: Figure,
    file: &'static str,
    title: &'static str,
    x: &'static str,
    y: &'static str,
    /// True if time or step runs logarithmically.
    logarithmic: bool,
    /// Straight lines for comparison: a name, a factor and a power of x; or, on a linear axis, a
    /// rate of growth.
    guides: &'static [(&'static str, f64, f64)],
}

const PAGES: &[Page] = &[
    Page {
        figure: Figure::Energy,
        file: "stability-energy.svg",
        title: "Pendulum from 1.3 rad: error of the energy up to t",
        x: "t in s",
        y: "largest error, relative to the energy above rest",
        logarithmic: true,
        guides: &[("√t", 2e-17, 0.5), ("t", 1e-17, 1.0)],
    },
    Page {
        figure: Figure::Phase,
        file: "stability-phase.svg",
        title: "Pendulum from 1.3 rad: error of the phase",
        x: "t in s",
        y: "error in s",
        logarithmic: true,
        guides: &[("t", 3e-17, 1.0), ("t√t", 1e-18, 1.5)],
    },
    Page {
        figure: Figure::Separation,
        file: "stability-separation.svg",
        title: "Double pendulum: distance of two motions that start a last digit apart",
        x: "t in s",
        y: "distance",
        logarithmic: false,
        guides: &[("exp 0.46 t", 1e-16, 0.46)],
    },
    Page {
        figure: Figure::Kinks,
        file: "stability-kinks.svg",
        title: "Pivot keyed 24 times a second: error after 5 s",
        x: "step in s",
        y: "error in rad",
        logarithmic: true,
        guides: &[("h", 1.0, 1.0), ("h²", 1.0, 2.0), ("h⁴", 30.0, 4.0)],
    },
];

/// Draws every picture that has curves; gives the names of the files.
pub(crate) fn draw(folder: &Path, curves: &[Curve]) -> Result<Vec<&'static str>, Box<dyn Error>> {
    let mut drawn = Vec::new();
    for page in PAGES {
        let own: Vec<&Curve> = curves
            .iter()
            .filter(|curve| curve.figure == page.figure && !curve.points.is_empty())
            .collect();
        if !own.is_empty() {
            page.draw(&folder.join(page.file), &own)?;
            drawn.push(page.file);
        }
    }
    Ok(drawn)
}

impl Page {
    fn draw(&self, path: &Path, curves: &[&Curve]) -> Result<(), Box<dyn Error>> {
        let all = || curves.iter().flat_map(|curve| &curve.points);
        let ends = |values: &mut dyn Iterator<Item = f64>| {
            values
                .filter(|value| value.is_finite())
                .fold((f64::INFINITY, 0.0f64), |(low, high), value| {
                    (low.min(value), high.max(value))
                })
        };
        let decades = |(low, high): (f64, f64)| {
            (10f64.powf((low.log10() + 1e-9).floor()), 10f64.powf((high.log10() - 1e-9).ceil()))
        };
        let (bottom, top) = decades(ends(&mut all().map(|point| point.1)));
        let x = ends(&mut all().map(|point| point.0));
        let (left, right) = if self.logarithmic { decades(x) } else { (0.0, x.1) };

        let root = SVGBackend::new(path, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let (area, legend) = root.split_horizontally(SIZE.0 - LEGEND);
        // Everything is drawn in logarithms, so that both kinds of axis are one.
        let to = |x: f64| if self.logarithmic { x.log10() } else { x };
        let mut chart = ChartBuilder::on(&area)
            .margin(12)
            .caption(self.title, (FONT, 18).into_font().color(&BLACK))
            .x_label_area_size(46)
            .y_label_area_size(70)
            .build_cartesian_2d(to(left)..to(right), bottom.log10()..top.log10())?;
        let power = |exponent: f64| {
            if exponent == 0.0 { "1".to_owned() } else { format!("1e{exponent:.0}") }
        };
        let (x_label, y_label) = (
            |value: &f64| {
                if !self.logarithmic {
                    return format!("{value}");
                }
                // Labels stand at whole powers only.
                if (value - value.round()).abs() < 1e-6 {
                    power(value.round())
                } else {
                    String::new()
                }
            },
            |value: &f64| {
                if (value - value.round()).abs() < 1e-6 {
                    power(value.round())
                } else {
                    String::new()
                }
            },
        );
        chart
            .configure_mesh()
            .disable_x_mesh()
            .x_labels(if self.logarithmic { (to(right) - to(left)) as usize + 1 } else { 10 })
            .y_labels(((top / bottom).log10() as usize + 1).min(20))
            .max_light_lines(0)
            .bold_line_style(RGBColor(225, 225, 225))
            .axis_style(RGBColor(60, 60, 60))
            .x_label_formatter(&x_label)
            .y_label_formatter(&y_label)
            .label_style((FONT, 14))
            .axis_desc_style((FONT, 15))
            .x_desc(self.x)
            .y_desc(self.y)
            .draw()?;
        let grey = RGBColor(150, 150, 150);
        for &(name, factor, rate) in self.guides {
            let height = |x: f64| {
                if self.logarithmic {
                    factor.log10() + rate * x
                } else {
                    factor.log10() + rate * x * std::f64::consts::LOG10_E
                }
            };
            let points: Vec<(f64, f64)> = (0..=200)
                .map(|k| to(left) + (to(right) - to(left)) * f64::from(k) / 200.0)
                .map(|x| (x, height(x)))
                .collect();
            let inside: Vec<_> = points
                .into_iter()
                .filter(|point| bottom.log10() <= point.1 && point.1 <= top.log10())
                .collect();
            let end = inside.get(inside.len() * 19 / 20).copied();
            chart.draw_series(DashedLineSeries::new(inside, 5, 4, grey.stroke_width(1)))?;
            let style = (FONT, 14)
                .into_font()
                .color(&RGBColor(90, 90, 90))
                .pos(Pos::new(HPos::Right, VPos::Bottom));
            chart.draw_series(end.map(|end| Text::new(name.to_owned(), end, style.clone())))?;
        }
        let colors = COLORS.map(|(red, green, blue)| RGBColor(red, green, blue));
        for (curve, color) in curves.iter().zip(colors) {
            let points = curve.points.iter().map(|point| (to(point.0), point.1.log10()));
            chart.draw_series(LineSeries::new(points, color.stroke_width(2)))?;
        }
        let style = (FONT, 14).into_font().color(&BLACK).pos(Pos::new(HPos::Left, VPos::Center));
        let names = curves.iter().map(|curve| curve.name.as_str()).zip(colors);
        for (row, (name, color)) in names.enumerate() {
            let y = 56 + 24 * row as i32;
            legend.draw(&PathElement::new([(4, y), (34, y)], color.stroke_width(2)))?;
            legend.draw(&Text::new(name.to_owned(), (42, y), style.clone()))?;
        }
        root.present()?;
        Ok(())
    }
}
