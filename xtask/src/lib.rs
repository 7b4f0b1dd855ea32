//! Chores of the repository.

pub mod tidy;
