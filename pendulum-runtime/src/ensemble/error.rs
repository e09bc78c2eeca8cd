//! Errors of ensembles as wholes.

use crate::error::Error;
use core::fmt;

/// Why an ensemble did not run to its end; members that fail are no reason.
#[derive(Debug)]
#[non_exhaustive]
pub enum EnsembleError {
    /// A setting is out of its range.
    Setting(Error),
}

impl fmt::Display for EnsembleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Setting(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for EnsembleError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Setting(error) => Some(error),
        }
    }
}

impl From<Error> for EnsembleError {
    fn from(error: Error) -> Self {
        Self::Setting(error)
    }
}
