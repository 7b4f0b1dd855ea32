//! Covariance kernels and their derivatives.
//!
//! Source: Rasmussen and Williams, "Gaussian Processes for Machine Learning", 2006, §4.2; the periodic one
//! MacKay, "Introduction to Gaussian processes", 1998, as in their Eq. 4.31.

use crate::SurrogateError;
use std::f64::consts::PI;

/// Covariance function up to its scale, over r² = Σ ((x − x′)/ℓ)² unless it says otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// exp(−2 Σ sin²(π (x − x′)/p)/ℓ²): periodic and smooth.
    Periodic {
        /// Period p, in the unit of the inputs.
        period: f64,
    },
    /// exp(−r²/2): very smooth.
    SquaredExponential,
    /// (1 + √3 r) exp(−√3 r): one derivative.
    Matern32,
    /// (1 + √5 r + 5 r²/3) exp(−√5 r): two derivatives.
    Matern52,
    /// (1 + r²/(2 α))^(−α): very smooth, of many lengths at once.
    RationalQuadratic {
        /// Exponent α (–).
        exponent: f64,
    },
}

/// Hyperparameters, over which the marginal likelihood is maximised.
#[derive(Clone, Debug, PartialEq)]
pub struct Hyperparameters {
    /// Variance of the values about their mean (unit of the values, squared).
    pub signal_variance: f64,
    /// Length ℓ for each dimension (unit of that input; – for the periodic kernel).
    pub lengths: Vec<f64>,
    /// Variance of the noise on each observation, beyond what is known (unit of the values, squared).
    pub noise_variance: f64,
}

impl Hyperparameters {
    pub(crate) fn check(&self, n_dimensions: usize) -> Result<(), SurrogateError> {
        if self.lengths.len() != n_dimensions {
            let found = self.lengths.len();
            return Err(SurrogateError::Lengths { what: "lengths", found, needed: n_dimensions });
        }
        let positive = |what, value: f64| {
            let good = value > 0.0 && value.is_finite();
            good.then_some(()).ok_or(SurrogateError::NotPositive { what, value })
        };
        positive("the signal's variance", self.signal_variance)?;
        self.lengths.iter().try_for_each(|length| positive("a length", *length))?;
        if self.noise_variance == 0.0 {
            return Ok(());
        }
        positive("the noise's variance", self.noise_variance)
    }
}

impl Shape {
    pub(crate) fn check(self) -> Result<(), SurrogateError> {
        let (what, value) = match self {
            Self::Periodic { period } => ("the period", period),
            Self::RationalQuadratic { exponent } => ("the exponent", exponent),
            _ => return Ok(()),
        };
        let is_good = value > 0.0 && value.is_finite();
        is_good.then_some(()).ok_or(SurrogateError::NotPositive { what, value })
    }

    /// Squared distance of two numbers along one dimension, in lengths.
    fn square(self, difference: f64, length: f64) -> f64 {
        match self {
            Self::Periodic { period } => 4.0 * ((PI * difference / period).sin() / length).powi(2),
            _ => (difference / length).powi(2),
        }
    }

    /// Correlation of the values at `a` and `b`, of `lengths` (–).
    ///
    /// # Errors
    /// [`SurrogateError::Lengths`] where they do not have one number of dimensions,
    /// [`SurrogateError::NotPositive`] for a length.
    pub fn correlation(self, lengths: &[f64], a: &[f64], b: &[f64]) -> Result<f64, SurrogateError> {
        let (signal_variance, lengths) = (1.0, lengths.to_vec());
        let parameters = Hyperparameters { signal_variance, lengths, noise_variance: 0.0 };
        parameters.check(a.len())?;
        parameters.check(b.len())?;
        Ok(self.covariance(&parameters, a, b))
    }

    /// Covariance of the values at `a` and `b` (unit of the values, squared).
    pub(crate) fn covariance(self, parameters: &Hyperparameters, a: &[f64], b: &[f64]) -> f64 {
        parameters.signal_variance * self.of_square(self.total(parameters, a, b)).0
    }

    /// The covariance; on return `slopes` holds its derivatives by the logarithm of each length.
    pub(crate) fn slopes(
        self,
        parameters: &Hyperparameters,
        a: &[f64],
        b: &[f64],
        slopes: &mut [f64],
    ) -> f64 {
        let (value, slope) = self.of_square(self.total(parameters, a, b));
        for (index, (a, b)) in a.iter().zip(b).enumerate() {
            // A longer length shrinks its own square: d r²/d ln ℓ = −2 (Δ/ℓ)².
            let square = self.square(a - b, parameters.lengths[index]);
            slopes[index] = -2.0 * square * slope * parameters.signal_variance;
        }
        parameters.signal_variance * value
    }

    fn total(self, parameters: &Hyperparameters, a: &[f64], b: &[f64]) -> f64 {
        let lengths = &parameters.lengths;
        a.iter().zip(b).zip(lengths).map(|((a, b), length)| self.square(a - b, *length)).sum()
    }

    /// The function and its derivative over the squared distance.
    fn of_square(self, square: f64) -> (f64, f64) {
        match self {
            Self::Periodic { .. } | Self::SquaredExponential => {
                squared_exponential(square, f64::exp)
            }
            Self::Matern32 => matern32(square, f64::exp),
            Self::Matern52 => matern52(square, f64::exp),
            Self::RationalQuadratic { exponent } => rational_quadratic(square, exponent),
        }
    }
}

/// Value and derivative of exp(−s/2) at the squared distance s, by the exponential `exp`.
#[inline(always)]
pub(crate) fn squared_exponential(square: f64, exp: impl Fn(f64) -> f64) -> (f64, f64) {
    let value = exp(-0.5 * square);
    (value, -0.5 * value)
}

/// Of Matérn's kernel with one derivative.
#[inline(always)]
pub(crate) fn matern32(square: f64, exp: impl Fn(f64) -> f64) -> (f64, f64) {
    let distance = (3.0 * square).sqrt();
    let decay = exp(-distance);
    ((1.0 + distance) * decay, -1.5 * decay)
}

/// Of Matérn's kernel with two derivatives.
#[inline(always)]
pub(crate) fn matern52(square: f64, exp: impl Fn(f64) -> f64) -> (f64, f64) {
    let distance = (5.0 * square).sqrt();
    let decay = exp(-distance);
    let value = (1.0 + distance + distance * distance / 3.0) * decay;
    (value, -5.0 / 6.0 * (1.0 + distance) * decay)
}

/// Of the rational quadratic kernel of `exponent` α.
#[inline(always)]
pub(crate) fn rational_quadratic(square: f64, exponent: f64) -> (f64, f64) {
    let base = 1.0 + square / (2.0 * exponent);
    let value = (-exponent * base.ln()).exp();
    (value, -0.5 * value / base)
}
