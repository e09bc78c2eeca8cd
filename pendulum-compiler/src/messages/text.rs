//! The text of a message.

use std::fmt;

/// A message of the catalogue: the mistake, followed by a semicolon and advice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Text(pub(super) String);

impl fmt::Display for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}
