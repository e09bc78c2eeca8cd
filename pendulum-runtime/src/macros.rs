//! The macro that users write; it tells the procedural macro where this crate is.

/// Takes a Lagrangian, differentiates it while the crate compiles and emits a type that implements
/// [`System`](crate::system::System).
///
/// The language is described at [`pendulum_macros::lagrangian`].
#[macro_export]
macro_rules! lagrangian {
    ($($token:tt)*) => { $crate::__private::lagrangian! { $crate; $($token)* } };
}
