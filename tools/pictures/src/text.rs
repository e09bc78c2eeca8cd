//! Texts with size and colour.

use crate::FINE;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const FONT: &str = "Helvetica, Arial, sans-serif";

/// A text style without anchor.
#[derive(Clone, Copy)]
pub(crate) struct Style {
    size: u32,
    color: RGBColor,
}

/// Creates a style of letters of `size` pixels.
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

    /// Returns a style whose anchor is at the beginning of the text.
    pub(crate) fn left(self) -> TextStyle<'static> {
        self.at(HPos::Left, FontStyle::Normal)
    }

    /// Returns a bold style whose anchor is at the beginning of the text.
    pub(crate) fn bold(self) -> TextStyle<'static> {
        self.at(HPos::Left, FontStyle::Bold)
    }

    /// Returns a style whose anchor is in the middle of the text.
    pub(crate) fn middle(self) -> TextStyle<'static> {
        self.at(HPos::Center, FontStyle::Normal)
    }

    /// Returns a style whose anchor is at the end of the text.
    pub(crate) fn right(self) -> TextStyle<'static> {
        self.at(HPos::Right, FontStyle::Normal)
    }
}
