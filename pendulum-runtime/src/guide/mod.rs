//! Guides, a page for each subject; every program in them is a test.
//!
//! | page | answers |
//! |---|---|
//! | [`language`] | How is a system written down? |
//! | [`gallery`] | Which systems are there to begin with? |
//! | [`choosing_a_method`] | Which integrator, which tolerance, which step? |
//! | [`motions`] | How does a program prescribe the motion of a joint? |
//! | [`results`] | How are states, columns and tables read, and steps taken by hand? |
//! | [`control`] | How does a program steer a motion, and how do bodies bounce? |
//! | [`bodies`] | How are shapes, drawings and densities turned into bodies? |
//! | [`space`] | How do bodies turn in space? |
//! | [`constraints`] | How are closed loops, rolling and end stops written? |
//! | [`friction`] | How do things stick, slip and rub in contacts? |
//! | [`scenes`] | How do many pendulums move in every frame of an animation? |
//! | [`ensembles`] | How are thousands of motions computed, on all cores? |
//! | [`analysis`] | Where does a system rest, how does it vibrate, what does it depend on? |
//! | [`fit`] | Which parameters explain what was measured? |
//! | [`accuracy`] | How large are the errors, and how long does it take? |
//! | [`reliability`] | What happens with bad input? |

// Pages of docs.rs have no files beside them: definitions of pictures as data stand before those of
// paths, and count. `cargo run --release -p pictures --features compiler --bin gallery` writes
// them.

#[doc = include_str!("language.md")]
pub mod language {}

#[doc = include_str!("figures/gallery.uri")]
#[doc = include_str!("gallery.md")]
pub mod gallery {}

#[doc = include_str!("bodies.md")]
pub mod bodies {}

#[doc = include_str!("space.md")]
pub mod space {}

#[doc = include_str!("choosing_a_method.md")]
pub mod choosing_a_method {}

#[doc = include_str!("motions.md")]
pub mod motions {}

// Its program is a test of `tools/pictures`: no published crate depends on plotters.
#[doc = include_str!("results.md")]
#[cfg_attr(not(doctest), doc = include_str!("picture.md"))]
pub mod results {}

#[doc = include_str!("control.md")]
pub mod control {}

#[doc = include_str!("constraints.md")]
pub mod constraints {}

#[doc = include_str!("friction.md")]
pub mod friction {}

#[doc = include_str!("figures/scenes.uri")]
#[doc = include_str!("scenes.md")]
pub mod scenes {}

#[doc = include_str!("figures/ensembles.uri")]
#[doc = include_str!("ensembles.md")]
pub mod ensembles {}

#[doc = include_str!("analysis.md")]
pub mod analysis {}

#[doc = include_str!("fit.md")]
pub mod fit {}

#[doc = include_str!("figures/accuracy.uri")]
#[doc = include_str!("accuracy.md")]
pub mod accuracy {}

#[doc = include_str!("reliability.md")]
pub mod reliability {}
