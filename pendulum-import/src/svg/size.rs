//! A check for shapes that would be converted to an almost unlimited number of curves.
//!
//! `usvg` converts arcs to curves within a tenth of a pixel. Their number n = (1.1163·10·r)^(1/6)
//! has no bound, and is not accessible before the conversion. Sizes are therefore checked
//! beforehand.

use svgtypes::{PathParser, PathSegment};
use usvg::roxmltree::Node;

/// The greatest supported length in pixels: 150 curves per ellipse.
const GREATEST: f64 = 1e12;

/// The attributes with lengths of shapes made of arcs, and with the lengths to which percentages
/// refer.
const LENGTHS: [&str; 10] = ["cx", "cy", "height", "r", "rx", "ry", "viewBox", "width", "x", "y"];

/// Returns `true` if an element is too large to be converted.
pub(super) fn is_vast(element: Node<'_, '_>) -> bool {
    match element.tag_name().name() {
        "circle" | "ellipse" | "rect" | "svg" => {
            LENGTHS.iter().filter_map(|name| element.attribute(*name)).any(has_vast_number)
        }
        "path" => element.attribute("d").is_some_and(has_vast_arc),
        _ => false,
    }
}

/// Returns `true` if a number at the start of a word of a text is too large.
fn has_vast_number(text: &str) -> bool {
    text.split(|c: char| c.is_whitespace() || c == ',').any(|word| {
        let end =
            word.find(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c))).unwrap_or(word.len());
        // A trailing `e` may belong to a unit.
        let number = word[..end]
            .parse()
            .or_else(|_| word[..end].trim_end_matches(['e', 'E']).parse::<f64>());
        number.is_ok_and(|number| GREATEST < number.abs())
    })
}

/// Returns `true` if an arc of a path may belong to an ellipse that is too large.
fn has_vast_arc(path: &str) -> bool {
    // A bound for the distance of all points so far.
    let mut reach = 0.0;
    // Segments after an error are not drawn.
    for segment in PathParser::from(path).map_while(Result::ok) {
        if let PathSegment::EllipticalArc { rx, ry, x, y, .. } = segment {
            let (short, long) =
                if rx.abs() < ry.abs() { (rx.abs(), ry.abs()) } else { (ry.abs(), rx.abs()) };
            let span = reach + x.abs() + y.abs();
            // The ellipse grows if the ends are too far apart for it.
            let growth = if short < span { span / short } else { 1.0 };
            // NaN does not count as too large.
            let fine = long * growth <= GREATEST;
            if 0.0 < short && !fine {
                return true;
            }
        }
        reach += match segment {
            PathSegment::MoveTo { x, y, .. }
            | PathSegment::LineTo { x, y, .. }
            | PathSegment::CurveTo { x, y, .. }
            | PathSegment::SmoothCurveTo { x, y, .. }
            | PathSegment::Quadratic { x, y, .. }
            | PathSegment::SmoothQuadratic { x, y, .. }
            | PathSegment::EllipticalArc { x, y, .. } => x.abs() + y.abs(),
            PathSegment::HorizontalLineTo { x, .. } => x.abs(),
            PathSegment::VerticalLineTo { y, .. } => y.abs(),
            PathSegment::ClosePath { .. } => 0.0,
        };
    }
    false
}

#[cfg(test)]
mod tests {
    use super::{has_vast_arc, has_vast_number};

    #[test]
    fn only_vast_numbers_are_vast() {
        for text in ["", "x", "1e12", "-3px", "1.5em", "2e3em", "0 0 100,200", "NaN", "50%"] {
            assert!(!has_vast_number(text), "{text}");
        }
        for text in ["1e13", "-1e38px", "0 0 1e30 1", "1e13em", "2e400"] {
            assert!(has_vast_number(text), "{text}");
        }
    }

    #[test]
    fn only_arcs_of_vast_ellipses_are_vast() {
        for path in [
            "M0 0L1e38 0",
            "M0 0A5 5 0 0 1 6.1e-17 10",
            "M0 0a0 1e300 0 0 1 9 9",
            "M1 1a25,25 -30 0,1 50,-25",
            "M0 0A1e-9 1 0 011 1",
            "A",
        ] {
            assert!(!has_vast_arc(path), "{path}");
        }
        for path in [
            "M0 0A1e38 5 0 0 1 9 9",
            "M0 0a1e-100 1 0 0 1 1 0",
            "M1e30 0a1 1 0 0 1 1 0z",
            "M0 0h-1e30A1 1 0 001 1",
        ] {
            assert!(has_vast_arc(path), "{path}");
        }
    }
}
