//! The `lagrangian!` macro of the `pendulum` workspace: a Lagrangian in, Rust out.

/// Takes a Lagrangian and emits a type that implements `pendulum_runtime::system::System`.
///
/// Programs call it by [`pendulum_runtime::lagrangian!`], which tells it where the runtime is; the
/// language is described there.
///
/// [`pendulum_runtime::lagrangian!`]:
///     https://docs.rs/pendulum-runtime/latest/pendulum_runtime/macro.lagrangian.html
#[proc_macro]
pub fn lagrangian(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    pendulum_compiler::expand(input.into()).into()
}

/// The words of the language as documented items, for editors.
#[doc(hidden)]
#[proc_macro]
pub fn words(_: proc_macro::TokenStream) -> proc_macro::TokenStream {
    pendulum_compiler::words().into()
}
