//! A picture for each system: error across, seconds up, both logarithmic.

use crate::table::{Entry, Party};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::path::Path;
use systems::colors::COLORS;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Failure = Box<dyn std::error::Error>;

const WIDTH: u32 = 1120;
const LEGEND: u32 = 330;
const FONT: &str = "sans-serif";

/// Draws the entries of one system.
pub fn draw(path: &Path, system: &str, note: &str, entries: &[Entry]) -> Result<(), Failure> {
    let curves = curves(system, entries);
    let height = (120 + 26 * curves.len() as u32).max(720);
    let root = SVGBackend::new(path, (WIDTH, height)).into_drawing_area();
    root.fill(&WHITE)?;
    let (chart, legend) = root.split_horizontally(WIDTH - LEGEND);
    chart_of(&chart, system, note, &curves)?;
    legend_of(&legend, &curves)?;
    root.present()?;
    Ok(())
}

/// The points of one method and how they look.
struct Curve {
    name: String,
    party: Party,
    color: RGBColor,
    mark: usize,
    failed: usize,
    /// Error and seconds, in the order of the settings.
    points: Vec<(f64, f64)>,
}

fn curves(system: &str, entries: &[Entry]) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for entry in entries.iter().filter(|entry| entry.system == system) {
        let index =
            curves.iter().position(|curve| curve.name == entry.method).unwrap_or_else(|| {
                let (name, party) = (entry.method.clone(), entry.party());
                curves.push(Curve {
                    name,
                    party,
                    color: BLACK,
                    mark: 0,
                    failed: 0,
                    points: Vec::new(),
                });
                curves.len() - 1
            });
        match entry.error() {
            // An error of zero would lie at infinity.
            Some(error) => curves[index].points.push((error.max(1e-17), entry.seconds())),
            None => curves[index].failed += 1,
        }
    }
    let (mut ours, mut peers) = (0, 0);
    for curve in &mut curves {
        if curve.party == Party::Ours {
            let (red, green, blue) = COLORS[ours % COLORS.len()];
            (curve.color, curve.mark) = (RGBColor(red, green, blue), ours);
            ours += 1;
        } else {
            let grey = if curve.name.ends_with("by hand") || curve.name.ends_with("simplified") {
                150
            } else {
                90
            };
            let color = if curve.party == Party::Heyoka {
                RGBColor(0, 0, 0)
            } else {
                RGBColor(grey, grey, grey)
            };
            (curve.color, curve.mark) = (color, peers);
            peers += 1;
        }
    }
    curves
}

fn chart_of(area: &Area<'_>, system: &str, note: &str, curves: &[Curve]) -> Result<(), Failure> {
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let ends = |values: &mut dyn Iterator<Item = f64>, least: f64, greatest: f64| {
        let (low, high) = values
            .fold((f64::INFINITY, 0.0f64), |(low, high), value| (low.min(value), high.max(value)));
        let (low, high) = if low < high { (low, high) } else { (least, greatest) };
        (
            10f64.powf((low.log10() - 0.1).floor()).max(least),
            10f64.powf((high.log10() + 0.1).ceil()).min(greatest),
        )
    };
    let (left, right) = ends(&mut all().map(|point| point.0), 1e-18, 1e2);
    let (bottom, top) = ends(&mut all().map(|point| point.1), 1e-8, 1e3);
    let caption = (FONT, 22).into_font().color(&BLACK);
    let mut chart = ChartBuilder::on(area)
        .margin(14)
        .margin_bottom(34)
        .caption(system, caption)
        .x_label_area_size(52)
        .y_label_area_size(78)
        .build_cartesian_2d((left..right).log_scale(), (bottom..top).log_scale())?;
    let decades = |low: f64, high: f64| (high / low).log10().round() as usize + 1;
    let power = |value: &f64| match value.log10().round() as i32 {
        0 => "1".to_string(),
        exponent => format!("1e{exponent}"),
    };
    chart
        .configure_mesh()
        .x_labels(decades(left, right))
        .y_labels(decades(bottom, top))
        .x_label_formatter(&power)
        .y_label_formatter(&power)
        .light_line_style(RGBColor(244, 244, 244))
        .bold_line_style(RGBColor(222, 222, 222))
        .axis_style(RGBColor(60, 60, 60))
        .label_style((FONT, 15))
        .axis_desc_style((FONT, 16))
        .x_desc("largest error over all output times and components")
        .y_desc("seconds")
        .draw()?;
    for curve in curves {
        let inside: Vec<_> = curve
            .points
            .iter()
            .copied()
            .filter(|point| left <= point.0 && point.0 <= right)
            .collect();
        let line = curve.color.stroke_width(2);
        if curve.party == Party::Ours {
            chart.draw_series(LineSeries::new(inside.iter().copied(), line))?;
        } else {
            chart.draw_series(DashedLineSeries::new(inside.iter().copied(), 6, 4, line))?;
        }
        for point in inside {
            let at = chart.backend_coord(&point);
            mark(area, at, curve)?;
        }
    }
    let (width, height) = area.dim_in_pixel();
    let place = Pos::new(HPos::Right, VPos::Bottom);
    let style = (FONT, 12).into_font().color(&RGBColor(110, 110, 110)).pos(place);
    area.draw(&Text::new(note.to_string(), (width as i32 - 14, height as i32 - 8), style))?;
    Ok(())
}

fn legend_of(area: &Area<'_>, curves: &[Curve]) -> Result<(), Failure> {
    let left = Pos::new(HPos::Left, VPos::Center);
    let style = (FONT, 15).into_font().color(&BLACK).pos(left);
    for (row, curve) in curves.iter().enumerate() {
        let y = 62 + 26 * row as i32;
        let ends = [(8, y), (48, y)];
        if curve.party == Party::Ours {
            area.draw(&PathElement::new(ends, curve.color.stroke_width(2)))?;
        } else {
            for x in [8, 18, 28, 38] {
                area.draw(&PathElement::new([(x, y), (x + 6, y)], curve.color.stroke_width(2)))?;
            }
        }
        let (x0, y0) = area.get_base_pixel();
        mark(area, (x0 + 28, y0 + y), curve)?;
        let failed =
            if curve.failed == 0 { String::new() } else { format!(" ({} failed)", curve.failed) };
        area.draw(&Text::new(format!("{}{failed}", curve.name), (58, y), style.clone()))?;
    }
    Ok(())
}

/// A mark at a pixel of the whole picture: the shape tells methods of like colours apart.
fn mark(area: &Area<'_>, at: (i32, i32), curve: &Curve) -> Result<(), Failure> {
    let (x0, y0) = area.get_base_pixel();
    let (x, y) = (at.0 - x0, at.1 - y0);
    let (filled, r) = (curve.color.filled(), 5);
    let corners = |corners: &[(i32, i32)]| {
        corners.iter().map(|(dx, dy)| (x + dx, y + dy)).collect::<Vec<_>>()
    };
    match curve.mark % 5 {
        0 => area.draw(&Circle::new((x, y), r - 1, filled))?,
        1 => area.draw(&Rectangle::new([(x - 4, y - 4), (x + 4, y + 4)], filled))?,
        2 => area.draw(&Polygon::new(corners(&[(0, -r), (r, r - 1), (-r, r - 1)]), filled))?,
        3 => area.draw(&Polygon::new(corners(&[(0, -6), (6, 0), (0, 6), (-6, 0)]), filled))?,
        _ => area.draw(&Polygon::new(corners(&[(0, r), (r, 1 - r), (-r, 1 - r)]), filled))?,
    }
    Ok(())
}
