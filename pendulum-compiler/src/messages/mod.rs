//! The catalogue: each message of the compiler once, as a function of what it names.
//!
//! A file holds the messages of a layer, by the mistake. [`Text`] is made here alone, and [`Errors`]
//! take nothing else, so that no pass has words of its own.

/// A message, as `format!` writes it.
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
    use std::path::Path;

    /// Calls that would make an error of words that are not in the catalogue: those of syn.
    const CALLS: &[&str] = &["Error::new", ".error(\"", ".error(format!", ".error(&format!"];

    #[test]
    fn no_pass_has_words_of_its_own() {
        let mut files = 0;
        let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src")];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.extend(Some(path).filter(|path| !path.ends_with("src/messages")));
                    continue;
                }
                let source = fs::read_to_string(&path).unwrap();
                files += 1;
                for call in CALLS {
                    assert!(!source.contains(call), "{call} in {}", path.display());
                }
            }
        }
        assert!(50 < files, "{files}");
    }
}
