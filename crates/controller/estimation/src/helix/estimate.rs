//! What an estimator of the helix believes.

use super::belief::{BIAS, MEAN_WIND, PASSING, RATE};
use super::filter::{Filter, FilterState};
use super::trust::Trust;
use super::wave::{Axis, UNKNOWN_PHASE};
use crate::{Oscillation, Quantity};
use basis::angle::wrap_to_turn;
use basis::{FixedFrame, Sense};
use serde::{Deserialize, Serialize};

/// Belief about the helix in the wind that meets the rotor, at one control instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HelixEstimate {
    /// Mean wind over the rotor (m/s).
    pub mean_wind: f64,
    /// Its variance (m²/s²).
    pub mean_wind_variance: f64,
    /// Helix in the tilt component.
    pub tilt: Axis,
    /// Helix in the yaw component; its phase leaves the sense's lead of yaw over tilt aside.
    pub yaw: Axis,
    /// The helix's wind now; its average is zero (m/s).
    pub helix: FixedFrame,
    /// Tilt and yaw that last or pass without the helix: shear, eddies, what the model lacks (m/s); average zero.
    pub other: FixedFrame,
    /// Wind as the last moments alone tell it (m/s).
    pub told: FixedFrame,
    /// Which way the helix winds that was looked for.
    pub sense: Sense,
    /// Angle of the excitation, against which the phases of tilt and yaw are told (rad, [0, 2π)).
    pub angle: f64,
    /// Excitation rate (rad/s): the nominal one, unless it is estimated.
    pub rate: f64,
    /// Mean of the normalised innovation squared over an excitation period (–): one in a filter that knows its noise.
    pub innovation: f64,
    /// How far the phases can be trusted.
    pub trust: Trust,
    /// What the last measurements were good for.
    pub status: Status,
}

/// What the last measurements were good for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// Nothing has been read yet.
    #[default]
    Waiting,
    /// All blades were heard.
    Tracking,
    /// Some blades' moments were no numbers or stood still; the others were heard.
    Partial,
    /// No blade was heard: the belief goes on by itself and grows less certain.
    Holding,
    /// The numbers had come to no good; the filter began anew.
    Restarted,
}

impl HelixEstimate {
    /// From `state` at `angle` (rad) of the excitation.
    pub(super) fn of(filter: &Filter, state: &FilterState, angle: f64, status: Status) -> Self {
        let belief = &state.belief;
        let [tilt, yaw] = filter.axes(belief);
        let (wind, _) = filter.wind(&belief.mean, angle, [0.0; 2]);
        let other = FixedFrame {
            average: 0.0,
            tilt: belief.mean[BIAS] + belief.mean[PASSING],
            yaw: belief.mean[BIAS + 1] + belief.mean[PASSING + 1],
        };
        let trust = if status == Status::Waiting {
            Trust::default()
        } else {
            // What the model may get wrong of the rotor's own pitch looks like a helix.
            let wrong = filter.options.doubt * state.own[0].hypot(state.own[1]);
            let variance = |axis: &Axis| {
                let turned = wrong / axis.amplitude.max(f64::MIN_POSITIVE);
                axis.phase_variance + (turned * turned).min(UNKNOWN_PHASE)
            };
            state.watch.trust(variance(&tilt).max(variance(&yaw)))
        };
        Self {
            mean_wind: belief.mean[MEAN_WIND],
            mean_wind_variance: belief.covariance[MEAN_WIND][MEAN_WIND],
            tilt,
            yaw,
            helix: FixedFrame {
                average: 0.0,
                tilt: wind.tilt - other.tilt,
                yaw: wind.yaw - other.yaw,
            },
            other,
            told: state.told,
            sense: filter.sense,
            angle: wrap_to_turn(angle),
            rate: filter.rate + belief.mean[RATE],
            innovation: state.watch.innovation(),
            trust,
            status,
        }
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
