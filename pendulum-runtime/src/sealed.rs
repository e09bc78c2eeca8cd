//! The supertrait of traits that only this crate implements.

/// Belongs to types of this crate, and to tuples and functions of them.
pub trait Sealed {}

impl Sealed for () {}

macro_rules! tuples {
    ($(($($member:ident $dim:ident $index:tt),+))+) => {$(
        impl<$($member: Sealed),+> Sealed for ($($member,)+) {}
    )+};
}

for_tuples_of_motions!(tuples);
