//! Phases of a helix in the wind: the true ones, and how well an estimate follows them.
//!
//! # What a wind phase is
//!
//! Symbols of van Vondelen et al. (2025), Eq. 20: ω_e excitation rate, t time since the run's start, A
//! amplitude, φ wind phase. The wind at a rotor is, in the fixed frame,
//!
//! ```text
//! U_tilt = A_tilt sin(ω_e t + φ_tilt)
//! U_yaw  = A_yaw  sin(ω_e t ± π/2 + φ_yaw)      upper sign: ccw, for which this is A_yaw cos(ω_e t + φ_yaw)
//! ```
//!
//! so that an undistorted helix has φ_tilt = φ_yaw in either sense, and a pitch command with the same phases
//! is in phase with the wind (their Eq. 22). Eq. 20 itself writes the upper sign alone. Positive tilt is more
//! wind on the upper rotor half, positive yaw more wind at azimuth 90°, the right half looking downwind.

mod agreement;
mod coherence;
mod filter;
mod lines;
mod moments;
mod truth;

pub use agreement::{Agreement, agreement};
pub use coherence::{Coherence, coherence};
pub use filter::{Band, Narrowband, narrowband};
pub use lines::{Lines, line_azimuth, lines_to_fixed_frame, winds_of_lines};
pub use moments::fixed_frame_moments;
pub use truth::{AxisWind, GroundTruth, ground_truth};

use crate::AnalysisError;
use basis::Sense;
use std::f64::consts::TAU;

/// Reference of the phases: the upstream turbine's excitation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// Excitation rate ω_e in the fixed frame (rad/s).
    pub rate: f64,
    /// Sense of the helix; its yaw leads its tilt by [`Sense::yaw_lead`].
    pub sense: Sense,
}

impl Reference {
    /// Excitation frequency (Hz).
    pub fn frequency(&self) -> f64 {
        self.rate / TAU
    }

    /// Tilt wind (m/s) of `amplitude` (m/s) and `phase` (rad) at `time` (s).
    pub fn tilt_wind(&self, time: f64, amplitude: f64, phase: f64) -> f64 {
        amplitude * (self.rate * time + phase).sin()
    }

    /// Yaw wind (m/s) of `amplitude` (m/s) and `phase` (rad) at `time` (s).
    pub fn yaw_wind(&self, time: f64, amplitude: f64, phase: f64) -> f64 {
        amplitude * (self.rate * time + self.sense.yaw_lead() + phase).sin()
    }
}

/// The interval (s) of equally spaced `times` (s).
///
/// # Errors
/// [`AnalysisError::TooShort`] with fewer than two; [`AnalysisError::UnevenTimes`] where a step differs by
/// more than a thousandth from the mean one, as after a gap or a change of sampling rate.
pub fn uniform_interval(times: &[f64]) -> Result<f64, AnalysisError> {
    let [first, .., last] = times else {
        return Err(AnalysisError::TooShort { n_samples: times.len(), needed: 2 });
    };
    let interval = (last - first) / (times.len() - 1) as f64;
    // A step that is not a number is uneven too.
    let even = |step: f64| (step - interval).abs() <= 1e-3 * interval;
    match times.windows(2).position(|pair| !even(pair[1] - pair[0])) {
        None => Ok(interval),
        Some(index) => Err(AnalysisError::UnevenTimes {
            index: index + 1,
            step: times[index + 1] - times[index],
            interval,
        }),
    }
}

#[cfg(test)]
mod tests;
