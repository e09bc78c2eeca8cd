//! Errors and their messages.
//!
//! A message stands in the function that checks, beside its reason; [`shared`] has those of several
//! checks. Each is made by [`message!`], and [`Errors`] accept nothing else, so that a test finds
//! them all and keeps their form: the mistake, then what is right or what to write.

mod errors;
pub(crate) mod shared;

pub(crate) use errors::{Errors, Range};
use std::fmt;

/// A message: the mistake, followed by what is right or by advice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Text(pub(crate) String);

impl fmt::Display for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Formats a message with the syntax of `format!`.
macro_rules! message {
    ($($part:tt)*) => { $crate::messages::Text(format!($($part)*)) };
}

pub(crate) use message;

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::{Path, PathBuf};

    /// Calls of syn that would create an error without a [`Text`].
    const CALLS: &[&str] = &["Error::new", ".error(\"", ".error(format!", ".error(&format!"];

    fn root() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
    }

    /// Returns the source files of the compiler, without those that define messages and errors.
    fn sources() -> Vec<PathBuf> {
        let mut files = Vec::new();
        let mut folders = vec![root()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                let own = ["messages/mod.rs", "messages/errors.rs"].map(|own| root().join(own));
                if path.is_dir() {
                    folders.push(path);
                } else if !own.contains(&path) {
                    files.push(path);
                }
            }
        }
        assert!(50 < files.len(), "{files:?}");
        files
    }

    #[test]
    fn errors_are_made_here_alone() {
        for path in sources() {
            let source = fs::read_to_string(&path).unwrap();
            for call in CALLS {
                assert!(!source.contains(call), "{call} in {}", path.display());
            }
        }
    }

    /// The messages without advice: there is nothing to write, or the error before says what.
    const BARE: &[&str] = &["`{first}` is declared here first", "an expression is missing here"];

    #[test]
    fn messages_have_one_form() {
        let mut count = 0;
        for path in sources() {
            let source = fs::read_to_string(&path).unwrap();
            for part in source.split("message!(").skip(1) {
                let literal = part.trim_start().strip_prefix('"').expect("a literal");
                let lines = literal.split('"').next().unwrap_or_default().split("\\\n");
                let text: String = lines.map(str::trim_start).collect();
                // What is right or to be written. It may be a part that messages have in common.
                let marks = ["; ", ": ", ", but ", ", and ", "{instead}", "{NO_"];
                let advice = marks.iter().any(|mark| text.contains(mark));
                let first = text.chars().next().is_some_and(char::is_uppercase);
                let form = !first && !text.ends_with(['.', ' ']) && !text.contains("  ");
                assert!(form && (advice || BARE.contains(&text.as_str())), "{text}");
                count += 1;
            }
        }
        assert!(150 < count, "{count}");
    }
}
