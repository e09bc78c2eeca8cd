//! Texts of a size and a colour.

use crate::FINE;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const FONT: &str = "Helvetica, Arial, sans-serif";

/// A style that is not anchored yet.
#[derive(Clone, Copy)]
pub(crate) struct Style {
    size: u32,
    color: RGBColor,
}

/// A style of letters of `size` pixels.
pub(crate) fn style(size: u32, color: RGBColor) -> Style {
    Style { size, color }
}

impl Style {
    fn at(self, horizontal: HPos, weight: FontStyle) -> TextStyle<'static> {
        // The backend divides sizes by 1.24.
        let size = f64::from(self.size * FINE) * 1.24;
        let font = FontDesc::new(FontFamily::Name(FONT), size, weight);
        font.color(&self.color).pos(Pos::new(horizontal, VPos::Center))
    }

    /// Begins where it is put.
    pub(crate) fn left(self) -> TextStyle<'static> {
        self.at(HPos::Left, FontStyle::Normal)
    }

    /// Begins where it is put, in bold letters.
    pub(crate) fn bold(self) -> TextStyle<'static> {
        self.at(HPos::Left, FontStyle::Bold)
    }

    /// Has its middle where it is put.
    pub(crate) fn middle(self) -> TextStyle<'static> {
        self.at(HPos::Center, FontStyle::Normal)
    }

    /// Ends where it is put.
    pub(crate) fn right(self) -> TextStyle<'static> {
        self.at(HPos::Right, FontStyle::Normal)
    }
}
