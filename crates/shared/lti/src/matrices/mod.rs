//! State-space systems as matrices, and what is worked out of them. Dense linear algebra is faer's.
//!
//! | wanted | use |
//! | --- | --- |
//! | systems put together | [`series`], [`parallel`], [`append`], [`feedback`], [`lower_fractional`] |
//! | a system of a transfer function | [`TransferFunction`] |
//! | continuous to discrete time | [`bilinear`], [`zero_order_hold`] |
//! | discrete to continuous time | [`inverse_bilinear`], [`inverse_hold`] |
//! | a delay | [`sample_delay`], [`pade_delay`] |
//! | response, poles, zeros, norms | methods of [`StateSpace`] |
//! | matrix equations | [`lyapunov`], [`discrete_lyapunov`], [`riccati`], [`discrete_riccati`] |
//! | a system of lower order | [`balanced_truncation`] |

mod balanced;
mod delay;
pub mod dense;
mod discretisation;
mod error;
mod exponential;
mod interconnection;
mod lyapunov;
mod modes;
mod norms;
mod response;
mod riccati;
mod state_space;
mod transfer_function;
mod zeros;

#[cfg(test)]
mod tests;

pub use balanced::{Balanced, balanced_truncation};
pub use delay::{pade_delay, sample_delay};
pub use discretisation::{bilinear, inverse_bilinear, inverse_hold, zero_order_hold};
pub use error::MatrixError;
pub use exponential::{exponential, logarithm};
pub use interconnection::{append, feedback, lower_fractional, parallel, series};
pub use lyapunov::{discrete_lyapunov, lyapunov};
pub use norms::PeakGain;
pub use response::relative_gain_array;
pub use riccati::{discrete_riccati, discrete_riccati_residual, riccati, riccati_residual};
pub use state_space::StateSpace;
pub use transfer_function::TransferFunction;
