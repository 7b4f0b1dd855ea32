//! A study from case file to report: every run of a case, with its files.

pub mod channels;
pub mod watcher;
