//! Linear time-invariant systems in discrete time: lags and filters of first and second order, roots of
//! polynomials.
//!
//! | wanted | use | discretised |
//! | --- | --- | --- |
//! | lag without state of its own | [`lag::first`], [`lag::second`] | exact for an input that is held |
//! | a low-pass of first order | [`LowPass`] | exact for an input held over the interval |
//! | low-pass, high-pass, notch, second order | [`SecondOrder`] | bilinear, exact at its own frequency |
//! | a low-pass without distortion of phase | [`fir::low_pass`] | sinc under a window |
//! | poles | [`roots`] | |
//! | several inputs and outputs | [`Recursion`] | as given |
//!
//! The interval is given with every sample, so that a filter works at any. Filters are plain data that
//! serialise whole.

pub mod fir;
pub mod lag;
mod low_pass;
#[cfg(feature = "matrices")]
pub mod matrices;
mod recursion;
mod roots;
mod second_order;

pub use low_pass::{LowPass, Smoother};
pub use num_complex::Complex64;
pub use recursion::Recursion;
pub use roots::roots;
pub use second_order::SecondOrder;
