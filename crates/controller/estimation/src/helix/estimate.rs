//! Estimate of the helix in the wind.

use super::filter::{Filter, FilterState};
use super::state_estimate::{BIAS, MEAN_WIND, N_STATES, PASSING, RATE, Vector, WAVE};
use super::trust::Trust;
use super::wave::{Axis, UNKNOWN_PHASE};
use crate::{Oscillation, Quantity};
use basis::angle::wrap_to_turn;
use basis::{FixedFrame, Sense};
use serde::{Deserialize, Serialize};

/// Estimate of the helix in the wind at the rotor, at one control instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HelixEstimate {
    /// Mean wind over the rotor (m/s).
    pub mean_wind: f64,
    /// Its variance (m²/s²).
    pub mean_wind_variance: f64,
    /// Helix in the tilt component.
    pub tilt: Axis,
    /// Helix in the yaw component; its phase is without the sense's lead of yaw over tilt.
    pub yaw: Axis,
    /// The helix's wind now; its average is zero (m/s).
    pub helix: FixedFrame,
    /// Standard deviation of tilt and yaw of the helix's wind now (m/s), to first order in its states.
    pub helix_deviation: [f64; 2],
    /// Tilt and yaw without the helix: shear, eddies and model error (m/s); average zero.
    pub other: FixedFrame,
    /// Instantaneous wind from the last moments alone (m/s).
    pub instantaneous: FixedFrame,
    /// Sense of the estimated helix.
    pub sense: Sense,
    /// Angle of the excitation, the reference of the phases of tilt and yaw (rad, [0, 2π)).
    pub angle: f64,
    /// Excitation rate (rad/s): the nominal one, unless it is estimated.
    pub rate: f64,
    /// Mean of the normalised innovation squared over an excitation period (–): one where the filter's noise
    /// is right.
    pub innovation: f64,
    /// Confidence in the phases.
    pub trust: Trust,
    /// How the last measurements were used.
    pub status: Status,
}

/// How the last measurements were used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// No measurement has been used yet.
    #[default]
    Waiting,
    /// The moments of all blades were used.
    Tracking,
    /// Some blades' moments were not numbers or did not change; the others were used.
    Partial,
    /// No moment was usable: the estimate is predicted and its variance grows.
    Holding,
    /// The state was not finite; the filter was restarted.
    Restarted,
}

impl HelixEstimate {
    /// From `state` at `angle` (rad) of the excitation.
    pub(super) fn of(filter: &Filter, state: &FilterState, angle: f64, status: Status) -> Self {
        let estimate = &state.estimate;
        let [tilt, yaw] = filter.axes(estimate);
        let (wind, _) = filter.wind(&estimate.mean, angle, [0.0; 2]);
        let helix_deviation = filter
            .helix_slopes(&estimate.mean, angle)
            .map(|slopes| estimate.variance_along(&slopes).max(0.0).sqrt());
        let other = FixedFrame {
            average: 0.0,
            tilt: estimate.mean[BIAS] + estimate.mean[PASSING],
            yaw: estimate.mean[BIAS + 1] + estimate.mean[PASSING + 1],
        };
        let trust = if status == Status::Waiting {
            Trust::default()
        } else {
            // An error of the model's response to the rotor's own pitch looks like a helix.
            let wrong =
                filter.options.model_uncertainty * state.pitch_wind[0].hypot(state.pitch_wind[1]);
            let variance = |axis: &Axis| {
                let turned = wrong / axis.amplitude.max(f64::MIN_POSITIVE);
                axis.phase_variance + (turned * turned).min(UNKNOWN_PHASE)
            };
            state.monitor.trust(variance(&tilt).max(variance(&yaw)))
        };
        Self {
            mean_wind: estimate.mean[MEAN_WIND],
            mean_wind_variance: estimate.covariance[MEAN_WIND][MEAN_WIND],
            tilt,
            yaw,
            helix: FixedFrame {
                average: 0.0,
                tilt: wind.tilt - other.tilt,
                yaw: wind.yaw - other.yaw,
            },
            helix_deviation,
            other,
            instantaneous: state.instantaneous,
            sense: filter.sense,
            angle: wrap_to_turn(angle),
            rate: filter.rate + estimate.mean[RATE],
            innovation: state.monitor.innovation(),
            trust,
            status,
        }
    }
}

impl Filter {
    /// Slopes of tilt and yaw of the helix's wind alone over the states, where those are `mean` and the
    /// excitation's angle is `angle` (rad).
    fn helix_slopes(&self, mean: &Vector, angle: f64) -> [Vector; 2] {
        let swing = self.options.form.swing(self.sense, &mean[WAVE..WAVE + 4], angle);
        [swing.tilt_slopes, swing.yaw_slopes].map(|of_wave| {
            let mut slopes = [0.0; N_STATES];
            slopes[WAVE..WAVE + 4].copy_from_slice(&of_wave);
            slopes
        })
    }
}

impl From<HelixEstimate> for Oscillation {
    fn from(estimate: HelixEstimate) -> Self {
        let HelixEstimate { tilt, yaw, sense, angle, rate, .. } = estimate;
        let yaw_phase = angle + sense.yaw_lead() + yaw.phase;
        Self {
            quantity: Quantity::Wind,
            rate,
            phases: [angle + tilt.phase, yaw_phase].map(wrap_to_turn),
            amplitudes: [tilt.amplitude, yaw.amplitude],
            trust: estimate.trust.overall(),
            held: matches!(estimate.status, Status::Waiting | Status::Holding),
        }
    }
}
