//! Solutions as data: columns by name, energies along the motion, tables.

mod column;
pub(crate) mod label;
mod name;
mod pushed;
#[cfg(feature = "serde")]
pub(crate) mod serial;
mod table;

pub use column::ColumnError;
pub use table::{LengthError, Table};
