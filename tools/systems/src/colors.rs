//! The colours of curves.

use plotters::style::RGBColor;

/// Tableau's ten colours with two more, dark enough on white.
pub(crate) const COLORS: [RGBColor; 12] = [
    RGBColor(31, 119, 180),
    RGBColor(214, 39, 40),
    RGBColor(44, 160, 44),
    RGBColor(148, 103, 189),
    RGBColor(255, 127, 14),
    RGBColor(23, 150, 170),
    RGBColor(227, 80, 170),
    RGBColor(140, 86, 75),
    RGBColor(150, 150, 20),
    RGBColor(0, 80, 60),
    RGBColor(60, 60, 200),
    RGBColor(120, 0, 60),
];
