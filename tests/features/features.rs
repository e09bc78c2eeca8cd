//! What the runtime has behind features: files, tables, text and threads.

#![allow(missing_docs)]

mod csv;
mod import;
mod scenes;
mod text;
mod threads;
