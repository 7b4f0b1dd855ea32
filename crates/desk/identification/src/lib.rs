//! System identification: linear models from records of inputs and outputs.
//!
//! | wanted | use |
//! | --- | --- |
//! | a record fit to work on: detrended, decimated, split | [`Record`] |
//! | an input that moves everything in a band | [`excitation::pseudo_random_binary`] |
//! | a state-space model | [`pbsid::Subspace`] |
//! | how well a model fits | [`fit`] |
//! | a frequency response without a model | [`frequency::FrequencyResponse`] |
//! | a delay | [`delay`] |
//! | which input moves which output | [`decoupling`] |

pub mod decoupling;
pub mod delay;
mod error;
pub mod excitation;
mod filter;
pub mod fit;
pub mod frequency;
pub mod pbsid;
mod record;
#[cfg(test)]
mod simulate;

pub use error::IdentificationError;
pub use record::{Channel, Record, Trend};
