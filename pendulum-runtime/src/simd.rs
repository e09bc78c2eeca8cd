//! The widest vectors of the machine, detected at run time.

/// Work that is compiled for several instruction sets. All functions called by `run` must be
/// inlined.
pub(crate) trait Work {
    /// Does the work.
    fn run(self);
}

/// Adapts [`Work`] to `pulp`.
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

/// Runs `work` with the widest vectors that the machine supports.
///
/// Without the feature `simd`, `work` is compiled like the rest of the program and has the same
/// bits.
#[cfg(feature = "simd")]
#[inline]
pub(crate) fn widest(work: impl Work) {
    pulp::Arch::new().dispatch(Op(work));
}

/// Runs `work` with vectors of at most 32 bytes on x86-64, otherwise as [`widest`]. For less
/// frequent work, to compile it for one instruction set less.
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

/// Runs `work`, compiled like the rest of the program.
#[cfg(not(feature = "simd"))]
#[inline]
pub(crate) fn wide(work: impl Work) {
    work.run();
}

/// Runs `work`, compiled like the rest of the program.
#[cfg(not(feature = "simd"))]
#[inline]
pub(crate) fn widest(work: impl Work) {
    work.run();
}
