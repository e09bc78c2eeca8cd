//! The widest vectors of the machine, found out while running.

/// Work that is compiled for several instruction sets: everything that `run` calls must be inlined into it.
pub(crate) trait Work {
    /// Does it.
    fn run(self);
}

/// Runs `work` with the widest vectors that the machine has.
///
/// Without the feature `simd` it runs as the rest of the program was compiled, with the same bits.
#[cfg(feature = "simd")]
#[inline]
pub(crate) fn widest(work: impl Work) {
    struct Op<W>(W);

    impl<W: Work> pulp::NullaryFnOnce for Op<W> {
        type Output = ();

        #[inline(always)]
        #[allow(clippy::inline_always)]
        fn call(self) {
            self.0.run();
        }
    }

    pulp::Arch::new().dispatch(Op(work));
}

/// Runs `work` as the rest of the program was compiled.
#[cfg(not(feature = "simd"))]
#[inline]
pub(crate) fn widest(work: impl Work) {
    work.run();
}
