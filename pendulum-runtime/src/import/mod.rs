//! Motions and bodies from files.

#[cfg(feature = "bvh")]
pub mod bvh;
#[cfg(feature = "gltf")]
pub mod gltf;
#[cfg(feature = "svg")]
pub mod svg;
