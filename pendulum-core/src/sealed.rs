//! The supertrait of traits that can only be implemented in this crate.

/// Implemented for types of this crate, and for tuples of them.
pub trait Sealed {}

impl Sealed for () {}

macro_rules! tuples {
    ($(($($member:ident $dim:ident $index:tt),+))+) => {$(
        impl<$($member: Sealed),+> Sealed for ($($member,)+) {}
    )+};
}

for_tuples_of_motions!(tuples);
