//! The catalogue of messages: each message of the compiler is a function of its details. The doc
//! comment of the function names the mistake.
//!
//! Each file contains the messages of a layer, ordered by subject and name. [`Text`] can be created
//! only in this module, and [`Errors`] accept no other messages, so that passes cannot contain
//! texts.

/// Formats a message with the syntax of `format!`.
macro_rules! text {
    ($($part:tt)*) => { $crate::messages::text::Text(format!($($part)*)) };
}

mod errors;
pub(crate) mod expected;
pub(crate) mod lower;
pub(crate) mod mechanics;
pub(crate) mod model;
pub(crate) mod shared;
pub(crate) mod syntax;
mod text;
pub(crate) mod unit;

pub(crate) use errors::{Errors, Range};
pub(crate) use text::Text;

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::{Path, PathBuf};

    /// Calls of syn that would create an error with a message outside the catalogue.
    const CALLS: &[&str] = &["Error::new", ".error(\"", ".error(format!", ".error(&format!"];

    fn root() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
    }

    /// Returns the source files of the compiler outside this folder.
    fn sources() -> Vec<PathBuf> {
        let mut files = Vec::new();
        let mut folders = vec![root()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if !path.is_dir() {
                    files.push(path);
                } else if !path.starts_with(root().join("messages")) {
                    folders.push(path);
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

    /// Four words in a row count as a sentence. Backends are not checked because they write
    /// documentation.
    #[test]
    fn no_pass_has_sentences_of_its_own() {
        let passes = ["algebra", "mechanics", "model", "schedule", "syntax"];
        let passes = passes.map(|pass| root().join(pass));
        let is_pass = |path: &&PathBuf| passes.iter().any(|pass| path.starts_with(pass));
        for path in sources().iter().filter(is_pass) {
            let source = fs::read_to_string(path).unwrap();
            let code = source.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
            // The table of functions contains descriptions for editors.
            let texts = ["reason =", "meaning: \""];
            let lines = code.lines().filter(|line| {
                !line.trim_start().starts_with("//")
                    && !texts.iter().any(|text| line.contains(text))
            });
            for literal in lines.flat_map(|line| line.split('"').skip(1).step_by(2)) {
                let words = literal.split(' ').collect::<Vec<_>>();
                let word = |word: &&str| !word.is_empty() && word.chars().all(char::is_alphabetic);
                let sentence = words.windows(4).any(|words| words.iter().all(word));
                assert!(!sentence, "{literal} in {}", path.display());
            }
        }
    }
}
