//! The widest vectors of the machine, found out while running.

/// Work that is compiled for several instruction sets: everything that `run` calls must be inlined
/// into it.
pub(crate) trait Work {
    /// Does it.
    fn run(self);
}

/// Work as `pulp` wants it.
#[cfg(feature = "simd")]
struct Op<W>(W);

#[cfg(feature = "simd")]
impl<W: Work> pulp::NullaryFnOnce for Op<W> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::inline_always)]
    fn call(self) {
        self.0.run();
    }
}

/// Runs `work` with the widest vectors that the machine has.
///
/// Without the feature `simd` it runs as the rest of the program was compiled, with the same bits.
#[cfg(feature = "simd")]
#[inline]
pub(crate) fn widest(work: impl Work) {
    pulp::Arch::new().dispatch(Op(work));
}

/// The same, but with vectors of at most 32 bytes on x86-64: for what is done less often, so that
/// it is compiled once less.
#[cfg(feature = "simd")]
#[inline]
pub(crate) fn wide(work: impl Work) {
    #[cfg(target_arch = "x86_64")]
    if let Some(vectors) = pulp::x86::V3::try_new() {
        vectors.vectorize(Op(work));
    } else {
        work.run();
    }
    #[cfg(not(target_arch = "x86_64"))]
    widest(work);
}

/// Runs `work` as the rest of the program was compiled.
#[cfg(not(feature = "simd"))]
#[inline]
pub(crate) fn wide(work: impl Work) {
    work.run();
}

/// Runs `work` as the rest of the program was compiled.
#[cfg(not(feature = "simd"))]
#[inline]
pub(crate) fn widest(work: impl Work) {
    work.run();
}
