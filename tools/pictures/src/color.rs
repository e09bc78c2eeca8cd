//! Colours with sufficient contrast on white and on black.

use plotters::style::RGBColor;

/// The colour for the subject of a picture.
pub const ORANGE: RGBColor = RGBColor(226, 88, 34);
/// A colour for curves.
pub const BLUE: RGBColor = RGBColor(54, 128, 214);
/// A colour for curves.
pub const GREEN: RGBColor = RGBColor(36, 145, 82);
/// A colour for curves.
pub const PURPLE: RGBColor = RGBColor(153, 101, 214);
/// A colour for curves.
pub const PINK: RGBColor = RGBColor(210, 78, 146);
/// A colour for curves.
pub const OCHRE: RGBColor = RGBColor(163, 119, 34);
/// A colour for curves.
pub const TEAL: RGBColor = RGBColor(18, 140, 155);
/// The colour of curves shown for comparison.
pub const GREY: RGBColor = RGBColor(130, 130, 134);
/// The colour of titles, labels and ticks.
pub const TEXT: RGBColor = RGBColor(118, 118, 124);

/// All colours for curves, beginning with that of the subject.
pub const CURVES: [RGBColor; 7] = [ORANGE, BLUE, GREEN, PURPLE, PINK, OCHRE, TEAL];

/// Returns a colour for a hue in degrees, for gradients. All hues are about equally light.
pub fn hue(degrees: f64) -> RGBColor {
    // Linear interpolation between neighbours in a table of colours of similar lightness.
    const CIRCLE: [(f64, f64, f64); 6] = [
        (214.0, 72.0, 66.0),
        (150.0, 124.0, 20.0),
        (36.0, 145.0, 60.0),
        (18.0, 138.0, 160.0),
        (84.0, 112.0, 230.0),
        (190.0, 76.0, 190.0),
    ];
    let place = degrees.rem_euclid(360.0) / 60.0;
    let (from, part) = (place as usize % 6, place.fract());
    let mix = |a: f64, b: f64| (a + (b - a) * part).round() as u8;
    let (a, b) = (CIRCLE[from], CIRCLE[(from + 1) % 6]);
    RGBColor(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

#[cfg(test)]
mod tests {
    use super::{CURVES, GREY, TEXT, hue};
    use plotters::style::RGBColor;

    /// Returns the contrast as defined by WCAG 2.
    fn contrast(a: RGBColor, b: RGBColor) -> f64 {
        let luminance = |color: RGBColor| {
            let part = |value: u8| {
                let value = f64::from(value) / 255.0;
                if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
            };
            0.2126 * part(color.0) + 0.7152 * part(color.1) + 0.0722 * part(color.2)
        };
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn colors_stand_out_from_light_and_from_dark_ground() {
        let hues = (0..36).map(|k| hue(10.0 * f64::from(k)));
        for color in CURVES.into_iter().chain([GREY, TEXT]).chain(hues) {
            for ground in [RGBColor(255, 255, 255), RGBColor(13, 17, 23)] {
                let contrast = contrast(color, ground);
                assert!(3.0 <= contrast, "{color:?} on {ground:?}: {contrast:.2}");
            }
        }
    }
}
