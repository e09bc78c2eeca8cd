//! Errors of glTF files.

use core::fmt;

/// The reason for which a glTF file cannot be read: the place in the file, the error and a remedy.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfError {
    /// The part of the file, such as `accessors[3]` or `animations[0].channels[2]`.
    pub place: String,
    /// The error.
    pub what: String,
    /// The remedy.
    pub advice: &'static str,
}

impl GltfError {
    pub(super) fn new(
        place: impl Into<String>,
        what: impl Into<String>,
        advice: &'static str,
    ) -> Self {
        Self { place: place.into(), what: what.into(), advice }
    }

    /// Adds the place that refers to the place of the error.
    pub(super) fn within(mut self, outer: &str) -> Self {
        self.place = format!("{outer}: {}", self.place);
        self
    }
}

impl fmt::Display for GltfError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}; {}", self.place, self.what, self.advice)
    }
}

impl core::error::Error for GltfError {}
