//! Optimised predictor-based subspace identification (PBSID-opt), for open and closed loops alike.
//!
//! The system is sought in its innovation form x(k+1) = A x + B u + K e, y = C x + D u + e with white e.
//! With Ã = A − K C, B̃ = [B − K D, K] and z = [u; y] the same is x(k+1) = Ã x + B̃ z, y = C x + D u + e, so
//! that over a past of p samples, after which Ãᵖ is as good as nothing,
//!
//! y(k) = Σ C Ãⁱ⁻¹ B̃ z(k − i) + D u(k) + e(k), i from 1 to p.
//!
//! 1. Least squares gives the coefficients C Ãⁱ⁻¹ B̃, a vector autoregression with inputs
//!    ([`Regularisation`]).
//! 2. Shifted, they fill the product of extended observability and controllability, whose block (j, i) is
//!    C Ãⁱ⁺ʲ⁻¹ B̃, j from 0 to f − 1, zero where i + j > p; times the past it is the effect of the state x(k)
//!    on f future outputs.
//! 3. Its singular values tell the order; its left vectors give the state sequence. Rows are weighted by the
//!    inverse root of the innovations' covariance, for innovations are what disturbs them.
//! 4. Least squares over the state sequence gives C, D and e, then A, B and K.
//!
//! Sources: Chiuso, "The role of vector autoregressive modeling in predictor-based subspace identification",
//! Automatica 43, 2007; van der Veen, van Wingerden, Bergamasco, Lovera and Verhaegen, "Closed-loop subspace
//! identification methods: an overview", IET Control Theory Appl. 7, 2013.

mod factor;
mod realisation;
mod regression;
mod riccati;
mod subspace;
#[cfg(test)]
mod tests;

pub use realisation::InnovationModel;
pub use subspace::Subspace;

/// How the coefficients of the vector autoregression are kept from following noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Regularisation {
    /// Not: the solution of least squares, and of least norm where there are several. For records without
    /// noise, and for inputs that move at all frequencies; in a narrow band noise takes it over.
    Exact,
    /// A penalty on their squares (Tikhonov), one for each output, chosen where generalised cross-validation
    /// is least. Source: Golub, Heath and Wahba, Technometrics 21, 1979.
    CrossValidated,
}

/// What to identify with. Channels are divided by their deviations first, so nothing here has a unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Samples of past that predict an output (–).
    pub past: usize,
    /// Samples of future whose prediction tells the state (–), no more than the past.
    pub future: usize,
    /// Whether an input moves an output within the same sample.
    pub feedthrough: bool,
    /// Of the vector autoregression.
    pub regularisation: Regularisation,
}
