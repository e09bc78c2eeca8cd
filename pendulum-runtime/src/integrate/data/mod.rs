//! Solutions as data: columns by name, energies along the motion, tables.

#[cfg(feature = "serde")]
pub(crate) mod arrays;
mod column;
pub(crate) mod label;
mod name;
mod pushed;
#[cfg(feature = "serde")]
mod serial;
mod table;

pub use column::ColumnError;
pub use table::{LengthError, Table};
