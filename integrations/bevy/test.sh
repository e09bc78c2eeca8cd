#!/usr/bin/env bash
# Builds and tests bones in Bevy, with its own lock file; arguments go to `cargo test`.
set -euo pipefail
cd "$(dirname "$0")"
export CARGO_TERM_COLOR=never CARGO_INCREMENTAL=0
cargo fmt --check
cargo clippy --locked --all-targets -- -D warnings
cargo test --locked "$@"
RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps
