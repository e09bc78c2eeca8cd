//! Errors of BVH files.

use core::fmt;

/// The reason for which a BVH file cannot be read: the place in the file, the error and a remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BvhError {
    /// The name of the file; `None` if a text was read.
    pub file: Option<String>,
    /// The line and column, both counted from one; `None` if the error is not at a place in the
    /// file.
    pub at: Option<(usize, usize)>,
    /// The error.
    pub what: String,
    /// The remedy.
    pub advice: &'static str,
}

impl BvhError {
    pub(super) fn new(at: (usize, usize), what: String, advice: &'static str) -> Self {
        Self { file: None, at: Some(at), what, advice }
    }

    pub(super) fn of_call(what: String, advice: &'static str) -> Self {
        Self { file: None, at: None, what, advice }
    }

    /// Adds the name of the file to the error.
    pub(super) fn within(mut self, name: &str) -> Self {
        self.file = Some(name.to_owned());
        self
    }
}

impl fmt::Display for BvhError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{file}: ")?;
        }
        if let Some((line, column)) = self.at {
            write!(f, "line {line}, column {column}: ")?;
        }
        write!(f, "{}; {}", self.what, self.advice)
    }
}

impl core::error::Error for BvhError {}
