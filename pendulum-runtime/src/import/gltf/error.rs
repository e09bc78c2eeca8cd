//! Why a glTF file cannot be read.

use core::fmt;

/// Why a glTF file cannot be read: where in it, what is wrong, what to do.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfError {
    /// The part of the file, as `accessors[3]` or `animations[0].channels[2]`.
    pub place: String,
    /// What is wrong there.
    pub what: String,
    /// What to do about it.
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

    /// The same error, seen from what refers to the place.
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
