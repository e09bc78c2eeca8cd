//! The `lagrangian!` macro of the `pendulum` workspace: a Lagrangian in, Rust out.

/// Takes a Lagrangian and emits a type that implements `pendulum_runtime::system::System`.
#[doc = include_str!("../language.md")]
#[proc_macro]
pub fn lagrangian(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    pendulum_compiler::expand(input.into()).into()
}
