//! The `lagrangian!` macro of the `pendulum` workspace: from a Lagrangian to Rust code.

/// Expands a Lagrangian to a type that implements `pendulum_runtime::system::System`.
///
/// Programs call it through `pendulum_runtime::lagrangian!`, which passes the path of the runtime
/// and documents the language.
#[proc_macro]
pub fn lagrangian(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    pendulum_compiler::expand(input.into()).into()
}

/// Returns the keywords of the language as documented items, for editors.
#[doc(hidden)]
#[proc_macro]
pub fn words(_: proc_macro::TokenStream) -> proc_macro::TokenStream {
    pendulum_compiler::words().into()
}
