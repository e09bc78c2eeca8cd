//! The macro for users, which passes the path of this crate to the procedural macro, and the list
//! of tuples of motions.

/// Derives the equations of motion from a Lagrangian at compile time, and emits a type that
/// implements [`System`](crate::system::System).
///
#[doc = include_str!("language.md")]
#[macro_export]
macro_rules! lagrangian {
    ($($token:tt)*) => { $crate::__private::lagrangian! { $crate; $($token)* } };
}

/// Passes tuples of one to eight motions to a macro: for each member the names of its type and of
/// its dimension, and its index.
macro_rules! for_tuples_of_motions {
    ($implementation:ident) => {
        $implementation! {
            (A DA 0)
            (A DA 0, B DB 1)
            (A DA 0, B DB 1, C DC 2)
            (A DA 0, B DB 1, C DC 2, D DD 3)
            (A DA 0, B DB 1, C DC 2, D DD 3, E DE 4)
            (A DA 0, B DB 1, C DC 2, D DD 3, E DE 4, F DF 5)
            (A DA 0, B DB 1, C DC 2, D DD 3, E DE 4, F DF 5, G DG 6)
            (A DA 0, B DB 1, C DC 2, D DD 3, E DE 4, F DF 5, G DG 6, H DH 7)
        }
    };
}
