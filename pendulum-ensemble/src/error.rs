//! Errors of whole ensembles.

use core::fmt;
use pendulum_core::error::Error;
use std::io;
use std::path::PathBuf;

/// An error that ended an ensemble. Failed members do not end an ensemble.
#[derive(Debug)]
#[non_exhaustive]
pub enum EnsembleError {
    /// A setting is out of its range.
    Setting(Error),
    /// The index of a part is not less than the number of parts.
    Part {
        /// The index given.
        index: usize,
        /// The number of parts given.
        parts: usize,
    },
    /// The folder of the checkpoint contains shards of a run with other settings.
    Refused {
        /// The folder.
        folder: PathBuf,
        /// The hash of the settings in the folder.
        found: u64,
        /// The hash of the settings of this run.
        hash: u64,
        /// The first difference of the settings; empty if unknown.
        difference: String,
    },
    /// The checkpoint could not be read or written; finished shards are kept.
    Io {
        /// The folder.
        folder: PathBuf,
        /// The cause.
        error: io::Error,
    },
}

impl fmt::Display for EnsembleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Setting(error) => error.fmt(f),
            Self::Part { index, parts } => write!(
                f,
                "there is no part {index} of {parts}; give an index from 0 on that is less than the number of parts"
            ),
            Self::Refused { folder, found, hash, difference } => {
                write!(
                    f,
                    "`{}` contains shards of a run with other settings: their hash is {found:016x}, that of this run is {hash:016x}",
                    folder.display()
                )?;
                if !difference.is_empty() {
                    write!(f, " ({difference})")?;
                }
                write!(f, "; give another folder, or remove this one")
            }
            Self::Io { folder, error } => write!(
                f,
                "the checkpoint in `{}` fails: {error}; finished shards stay there, and the next run continues from them",
                folder.display()
            ),
        }
    }
}

impl std::error::Error for EnsembleError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Setting(error) => Some(error),
            Self::Io { error, .. } => Some(error),
            Self::Part { .. } | Self::Refused { .. } => None,
        }
    }
}

impl From<Error> for EnsembleError {
    fn from(error: Error) -> Self {
        Self::Setting(error)
    }
}

#[cfg(test)]
mod tests {
    use super::EnsembleError;

    #[test]
    fn a_part_beyond_the_last_says_which_indices_there_are() {
        assert_eq!(
            EnsembleError::Part { index: 3, parts: 3 }.to_string(),
            "there is no part 3 of 3; give an index from 0 on that is less than the number of parts"
        );
    }
}
