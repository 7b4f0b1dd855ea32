//! Chores of the repository: `cargo run -p xtask -- tidy` checks the house against ARCHITECTURE.md.
fn main() {}
