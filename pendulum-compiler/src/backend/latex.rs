//! Equations in LaTeX: `\ddot{\theta} = -\frac{g \sin\theta}{L}`.

use crate::backend::layout::Layout;
use crate::syntax::name;
use std::fmt;

/// Returns an equation in LaTeX.
pub(crate) fn equation(parts: &[Layout]) -> String {
    parts.iter().map(Layout::to_string).collect()
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Layout::Plain(text) => f.write_str(text),
            Layout::Letter(letter) if name::is_greek(letter) => write!(f, "\\{letter}"),
            Layout::Letter(letter) => f.write_str(letter),
            Layout::Word(word) => write!(f, "\\mathrm{{{}}}", word.replace('_', "\\_")),
            Layout::Command(command) => f.write_str(command),
            Layout::Sign(sign) => write!(f, " {sign} "),
            Layout::Minus => f.write_str("-"),
            Layout::Comma => f.write_str(", "),
            Layout::Space => f.write_str(" "),
            Layout::Row(parts) => write!(f, "{{{}}}", equation(parts)),
            Layout::Dots(letter, 1) => write!(f, "\\dot{{{letter}}}"),
            Layout::Dots(letter, _) => write!(f, "\\ddot{{{letter}}}"),
            Layout::Below(base, index) => write!(f, "{base}_{{{}}}", equation(index)),
            Layout::Above(base, exponent) => write!(f, "{base}^{{{}}}", equation(exponent)),
            Layout::Fraction(above, below) => {
                write!(f, "\\frac{{{}}}{{{}}}", equation(above), equation(below))
            }
            Layout::Root(parts) => write!(f, "\\sqrt{{{}}}", equation(parts)),
            Layout::Fence([open, close], parts) => {
                write!(f, "\\left{open}{}\\right{close}", equation(parts))
            }
            Layout::TooLong => f.write_str("\\ldots\\text{ (too long to write out)}"),
        }
    }
}
