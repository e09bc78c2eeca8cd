//! Solutions as data: columns by name, energies along the motion, tables.

mod column;
mod pushed;
#[cfg(feature = "serde")]
mod serial;
mod table;
mod work;

pub use column::ColumnError;
pub use table::{LengthError, Table};
pub use work::Work;
