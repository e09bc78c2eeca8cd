//! Motions and bodies from files: `bvh` and `gltf` read motions, `svg` joints and bodies, and `gltf`
//! also reads spring bones and writes motions back. Each is behind the feature of its name.
//!
//! ```
//! # #[cfg(feature = "bvh")]
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use pendulum_core::motion::{Derivatives, Motion, Sample, Side};
//! use pendulum_core::time::Time;
//! use pendulum_import::bvh::Bvh;
//!
//! let text = "HIERARCHY
//! ROOT hand { OFFSET 0 0 0 CHANNELS 1 Yposition }
//! MOTION
//! Frames: 3
//! Frame Time: 0.5
//! 0
//! 90
//! 0";
//! // The hand in metres; the file counts in centimetres.
//! let hand = Bvh::read(text)?.motion("hand", 0.01)?;
//! let raised: Sample<f64, 3> = hand.sample(Time::new(0.5), Side::After, Derivatives::POSITION);
//! assert!((raised.position[1] - 0.9).abs() < 1e-15);
//! # Ok(())
//! # }
//! # #[cfg(not(feature = "bvh"))]
//! # fn main() {}
//! ```
#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "bvh")]
pub mod bvh;
#[cfg(feature = "gltf")]
pub mod gltf;
#[cfg(feature = "svg")]
pub mod svg;

/// Reads at most `most` bytes of a file. Folders, devices and pipes, which may have no end, are no
/// files.
#[cfg(any(feature = "bvh", feature = "gltf"))]
fn contents(path: &std::path::Path, most: u64) -> std::io::Result<Vec<u8>> {
    use std::io::{Error, ErrorKind, Read as _};
    let data = std::fs::metadata(path)?;
    if !data.is_file() {
        return Err(Error::other("it is no regular file"));
    }
    let mut bytes = Vec::new();
    // A file of zeros needs no space on a disk, and may be longer than any memory.
    let length = usize::try_from(data.len().min(most)).unwrap_or(usize::MAX);
    bytes.try_reserve_exact(length).map_err(|_| ErrorKind::OutOfMemory)?;
    std::fs::File::open(path)?.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(all(test, any(feature = "bvh", feature = "gltf", feature = "svg")))]
mod random;
