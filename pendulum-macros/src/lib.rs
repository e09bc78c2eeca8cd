//! The `lagrangian!` macro.

use proc_macro::TokenStream;

/// Placeholder until the language lands.
#[proc_macro]
pub fn lagrangian(_: TokenStream) -> TokenStream {
    TokenStream::new()
}
