//! Every file that is read or written, and nothing but.
//!
//! Files appear whole or not at all ([`atomic`]); an error names the file, what was being done, and the fix.

pub mod atomic;
pub mod case;

pub use atomic::FileError;
