//! The list of tuples of joints.

/// Passes tuples of one to eight joints to a macro: for each member the names of its type and of
/// its dimension, and its index.
macro_rules! for_tuples_of_joints {
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
