//! Checks of the whole structure: closed forms, balances, symmetries, published frequencies.

mod frequencies;
mod samples;
