//! The file of weights: what a controller is to do.

use crate::DesignError;
use formats::{FileError, atomic};
use lti::matrices::{StateSpace, TransferFunction};
use serde::Deserialize;
use std::fmt;
use std::path::Path;
use synthesis::{SynthesisError, control_weight, performance_weight};

/// What the file holds, in words.
const WHAT: &str = "weights of a controller";

/// How a controller is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Least peak of the weighted loop over all frequencies.
    #[default]
    HInfinity,
    /// Least mean square of it under white noise.
    H2,
    /// Linear quadratic regulator and Kalman filter.
    Lqg,
    /// The same with integral action.
    Lqi,
}

/// The file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct WeightsFile {
    #[serde(default)]
    pub(crate) method: Method,
    /// Of the sensitivity, Eq. 11 or any transfer function.
    pub(crate) performance: Option<Weight>,
    /// Of the complementary sensitivity.
    pub(crate) complementary: Option<Weight>,
    /// Of the control, Eq. 12 or any transfer function.
    pub(crate) control: Option<Weight>,
    #[serde(default)]
    pub(crate) quadratic: Quadratic,
    /// Order that the controller is reduced to, before the predictor is added.
    pub(crate) order: Option<usize>,
}

/// One weight, the same on every channel. Continuous time, rad/s.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged, deny_unknown_fields)]
pub(crate) enum Weight {
    /// (s/M + ω)/(s + A ω).
    FirstOrder { bandwidth: f64, peak: f64, attenuation: f64 },
    /// scale B² (s² + √2 ω s + ω²)/(s² + √2 B ω s + (B ω)²).
    SecondOrder { corner: f64, ratio: f64, scale: f64 },
    /// Coefficients, highest power first.
    Rational { numerator: Vec<f64>, denominator: Vec<f64> },
}

/// Weights of a linear quadratic problem: outputs and controls, and the noises on states and measurements.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Quadratic {
    pub(crate) outputs: f64,
    pub(crate) controls: f64,
    /// Of the integrated errors, with integral action.
    pub(crate) integrals: f64,
    /// Variance of noise on the inputs over that of the measurements.
    pub(crate) input_noise: f64,
    pub(crate) measurement_noise: f64,
}

impl Default for Quadratic {
    fn default() -> Self {
        Self {
            outputs: 1.0,
            controls: 1.0,
            integrals: 0.01,
            input_noise: 1.0,
            measurement_noise: 1.0,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::HInfinity => "H-infinity",
            Self::H2 => "H2",
            Self::Lqg => "LQG",
            Self::Lqi => "LQG with integral action",
        })
    }
}

impl WeightsFile {
    /// Reads the file at `path`.
    ///
    /// # Errors
    /// [`DesignError::File`] with line and key.
    pub(crate) fn read(path: &Path) -> Result<Self, DesignError> {
        let text = atomic::read_text(path, WHAT)?;
        toml::from_str(&text).map_err(|error| {
            let fix = "write it as docs/control-design.md has it";
            FileError::content(WHAT, path, error.to_string().trim_end().to_owned(), fix).into()
        })
    }
}

impl Weight {
    /// It, on each of `channels`.
    ///
    /// # Errors
    /// [`SynthesisError`] naming the number that is out of range.
    pub(crate) fn on(&self, channels: usize) -> Result<StateSpace, SynthesisError> {
        let one = match self {
            Self::FirstOrder { bandwidth, peak, attenuation } => {
                performance_weight(*bandwidth, *peak, *attenuation)?
            }
            Self::SecondOrder { corner, ratio, scale } => control_weight(*corner, *ratio, *scale)?,
            Self::Rational { numerator, denominator } => TransferFunction {
                numerator: numerator.clone(),
                denominator: denominator.clone(),
                interval: None,
            }
            .state_space()?,
        };
        Ok(one.repeated(channels)?)
    }

    /// Its gain (–) at `frequency` (rad/s).
    ///
    /// # Errors
    /// [`SynthesisError`] for a pole there.
    pub(crate) fn gain(&self, frequency: f64) -> Result<f64, SynthesisError> {
        let response = self.on(1)?.response(frequency)?;
        Ok(response[(0, 0)].norm())
    }
}
