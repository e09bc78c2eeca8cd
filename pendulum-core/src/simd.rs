//! The widest vectors of the machine, detected at run time.
//!
//! Code is compiled for one instruction set, the oldest one that its platform allows. Loops over
//! [lanes](crate::scalar::Lanes) gain from wider vectors, so [`widest`] holds such work compiled
//! for each instruction set, and selects the best one of the machine. The results have the same
//! bits, because the compiler neither reorders nor fuses operations.
//!
//! ```
//! use pendulum_runtime::scalar::{Lanes, Real};
//! use pendulum_runtime::simd::{Work, widest};
//!
//! struct Sines<'a>(&'a mut Lanes<f64, 16>);
//!
//! impl Work for Sines<'_> {
//!     #[inline(always)]
//!     fn run(self) {
//!         *self.0 = self.0.sin();
//!     }
//! }
//!
//! let mut lanes = Lanes::splat(0.5);
//! widest(Sines(&mut lanes));
//! assert_eq!(lanes.0, [Real::sin(0.5); 16]);
//! ```

/// Work that is compiled for several instruction sets.
pub trait Work {
    /// Does the work. The functions and closures that it calls must be inlined: all others are
    /// compiled for the instruction set of the rest of the program.
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
#[inline]
pub fn widest(work: impl Work) {
    #[cfg(feature = "simd")]
    pulp::Arch::new().dispatch(Op(work));
    #[cfg(not(feature = "simd"))]
    work.run();
}

/// Runs `work` with vectors of at most 32 bytes on x86-64, otherwise as [`widest`]. For less
/// frequent work, to compile it for one instruction set less.
#[inline]
pub(crate) fn wide(work: impl Work) {
    #[cfg(all(feature = "simd", target_arch = "x86_64"))]
    if let Some(vectors) = pulp::x86::V3::try_new() {
        vectors.vectorize(Op(work));
    } else {
        work.run();
    }
    #[cfg(not(all(feature = "simd", target_arch = "x86_64")))]
    widest(work);
}
