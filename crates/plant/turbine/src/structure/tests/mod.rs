//! Checks of the whole structure: closed forms, balances, symmetries, published frequencies.

mod conservation;
mod frequencies;
mod invariants;
mod momentum;
mod rigid;
mod samples;
mod sections;
