//! Solutions as data, and what is computed from systems and motions beside the motion itself.

#![allow(mixed_script_confusables, missing_docs)]

mod columns;
