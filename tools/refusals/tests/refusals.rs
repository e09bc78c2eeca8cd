//! Blocks that do not compile, with the complete expected messages at the user's tokens, and blocks
//! that compile.

/// Set `TRYBUILD=overwrite` to rewrite the expected messages.
#[test]
fn refused_blocks_say_what_to_do() {
    let cases = trybuild::TestCases::new();
    cases.compile_fail("tests/refusals/*.rs");
    cases.pass("tests/blocks/*.rs");
}
