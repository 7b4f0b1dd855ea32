//! Recorded validations: each compares the program with a closed form, a published figure or another program.
//!
//! `wakemix validate NAME` repeats one and prints measured against expected; `docs/validation/` keeps the record.

pub mod row;

pub use row::Row;

/// A validation that can be repeated by name.
pub struct Validation {
    /// Name on the command line.
    pub name: &'static str,
    /// What is compared with what.
    pub about: &'static str,
    /// Roughly how long it takes on two cores (minutes).
    pub minutes: &'static str,
    /// Makes the comparison.
    pub run: fn() -> Vec<Row>,
}

/// All of them.
pub const VALIDATIONS: &[Validation] = &[];
