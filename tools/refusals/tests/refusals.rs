//! Blocks that do not compile: each message is ours, whole, at the user's token. And blocks that
//! do.

/// `TRYBUILD=overwrite` rewrites the expected messages.
#[test]
fn refused_blocks_say_what_to_do() {
    let cases = trybuild::TestCases::new();
    cases.compile_fail("tests/refusals/*.rs");
    cases.pass("tests/blocks/*.rs");
}
