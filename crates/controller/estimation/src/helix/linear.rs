//! The earlier method: a linear Kalman filter around one operating point.
//!
//! After van Vondelen et al. (2023), "Phase synchronization for Helix enhanced wake mixing in downstream wind
//! turbines", IFAC-PapersOnLine 56, 8426: moments are linear in wind and pitch, the helix an undamped
//! oscillator, which here stands still as sine and cosine components against the excitation. Kept for
//! comparison.

use super::clock::{Clock, Use};
use super::estimate::{HelixEstimate, Status};
use super::filter::{Filter, FilterState, Instant};
use super::flap::Bend;
use super::options::{HelixOptions, Rotor as RotorOptions, Wake, positive};
use super::rotor::{Expected, Rotor, RotorKinematics};
use super::settings::{HelixSettings, check};
use super::state_estimate::MEAN_WIND;
use super::wave::Form;
use crate::{EstimationError, Estimator};
use basis::mbc::to_blades;
use basis::{FixedFrame, Measurements, PerBlade};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use turbine::Definition;

/// Steps by which slopes at the operating point are found: wind (m/s) and pitch (rad).
const WIND_STEP: f64 = 0.2;
const PITCH_STEP: f64 = 0.005;

/// Operating point of the linearisation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OperatingPoint {
    /// Mean wind (m/s).
    pub wind: f64,
    /// Rotor speed (rad/s).
    pub rotor_speed: f64,
    /// Pitch of all blades (rad).
    pub pitch: f64,
}

/// Estimates the helix with a model of the moments linearised about one operating point.
#[derive(Clone, Debug)]
pub struct LinearEstimator {
    filter: Filter,
    rated_speed: f64,
    interval: f64,
    point: OperatingPoint,
    /// Moment (N m) at the point, its slopes over wind (N m/(m/s)) and pitch (N m/rad).
    moment: f64,
    wind_slope: f64,
    pitch_slope: f64,
    state: LinearEstimatorState,
}

/// State of the estimator; a run restored from it continues with the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LinearEstimatorState {
    filter: FilterState,
    clock: Clock,
    status: Status,
}

impl LinearEstimator {
    /// An estimator on a turbine of `definition`, linear around `point`, with the noise and control intervals
    /// of `options`; derivatives are those of a steady wake and of rigid blades.
    ///
    /// # Errors
    /// Those of [`HelixEstimator::new`](super::HelixEstimator::new), and for an operating point out of range.
    pub fn new(
        definition: &Arc<Definition>,
        settings: &HelixSettings,
        point: OperatingPoint,
        options: HelixOptions,
    ) -> Result<Self, EstimationError> {
        let rotor = RotorOptions { wake: Wake::Static, flexible: false, ..options.rotor };
        let options = HelixOptions {
            form: Form::Quadrature,
            rotor,
            bias: None,
            eddies: None,
            response: None,
            rate: None,
            adaptation: None,
            huber_limit: None,
            roundness: 0.0,
            ..options
        };
        check(definition, settings, &options)?;
        positive("wind of the operating point (m/s)", point.wind)?;
        positive("rotor speed of the operating point (rad/s)", point.rotor_speed)?;
        let n_blades = definition.n_blades;
        let model = Rotor::new(definition, settings, &options);
        let mean_moment = |wind: f64, pitch: f64| {
            let pitch = PerBlade::splat(n_blades, pitch);
            moment_at_rest(&model, wind, point.rotor_speed, pitch)
        };
        let between = |step: f64, up: f64, down: f64| (up - down) / step;
        let OperatingPoint { wind, pitch, .. } = point;
        let half = [0.5 * WIND_STEP, 0.5 * PITCH_STEP];
        let filter = Filter::new(definition, settings, options);
        let state = LinearEstimatorState {
            filter: filter.blank(),
            clock: Clock::new(n_blades),
            status: Status::Waiting,
        };
        Ok(Self {
            filter,
            rated_speed: definition.rated_rotor_speed,
            interval: settings.interval,
            point,
            moment: mean_moment(wind, pitch),
            wind_slope: between(
                WIND_STEP,
                mean_moment(wind + half[0], pitch),
                mean_moment(wind - half[0], pitch),
            ),
            pitch_slope: between(
                PITCH_STEP,
                mean_moment(wind, pitch + half[1]),
                mean_moment(wind, pitch - half[1]),
            ),
            state,
        })
    }

    fn expected(&self, wind: FixedFrame, measurements: &Measurements) -> Expected {
        let winds = to_blades(measurements.azimuth, wind, measurements.pitch.len());
        let moments = PerBlade::from_fn(winds.len(), |blade| {
            self.moment
                + self.wind_slope * (winds[blade] - self.point.wind)
                + self.pitch_slope * (measurements.pitch[blade] - self.point.pitch)
        });
        let slopes = PerBlade::splat(winds.len(), self.wind_slope);
        Expected { moments, slopes, bend: Bend::none(measurements.azimuth) }
    }
}

impl Estimator for LinearEstimator {
    type Estimate = HelixEstimate;
    type State = LinearEstimatorState;

    fn update(&mut self, measurements: &Measurements) -> HelixEstimate {
        let every = self.filter.options.update_every;
        let angle = self.filter.rate * measurements.time;
        let look = self.state.clock.look(measurements, every, self.interval, self.rated_speed);
        let LinearEstimatorState { filter: state, status, .. } = &mut self.state;
        if *status == Status::Waiting {
            if let Use::Seen(..) = look {
                state.estimate = self.filter.start(self.point.wind);
                *status = Status::Tracking;
            }
        } else {
            match look {
                Use::Nothing => {}
                Use::Blind(interval) => {
                    self.filter.predict(interval, state);
                    *status = Status::Holding;
                }
                Use::Seen(interval, readings) => {
                    self.filter.predict(interval, state);
                    let (wind, wind_slopes) =
                        self.filter.wind(&state.estimate.mean, angle, [0.0; 2]);
                    let azimuth = measurements.azimuth;
                    let expected = self.expected(wind, measurements);
                    let slopes = Filter::blade_slopes(azimuth, &expected, &wind_slopes);
                    let now = Instant { interval, angle, azimuth, wind, pitch_wind: [0.0; 2] };
                    let state = &mut self.state.filter;
                    let n_used = self.filter.correct(&now, &expected, &slopes, &readings, state);
                    self.state.status = match n_used {
                        0 => Status::Holding,
                        n if n < readings.len() => Status::Partial,
                        _ => Status::Tracking,
                    };
                }
            }
        }
        if !self.state.filter.estimate.is_finite() {
            self.state.filter = self.filter.blank();
            self.state.filter.estimate = self.filter.start(self.point.wind);
            self.state.status = Status::Restarted;
        }
        let angle = if angle.is_finite() { angle } else { 0.0 };
        HelixEstimate::of(&self.filter, &self.state.filter, angle, self.state.status)
    }

    fn state(&self) -> &LinearEstimatorState {
        &self.state
    }

    fn restore(&mut self, state: LinearEstimatorState) {
        self.state = state;
    }
}

impl LinearEstimator {
    /// Estimated mean wind (m/s); zero before the first measurement.
    pub fn mean_wind(&self) -> f64 {
        self.state.filter.estimate.mean[MEAN_WIND]
    }
}

/// Mean blade moment (N m) of `model` at rest in an even `wind` (m/s), at `rotor_speed` (rad/s) and `pitch`
/// (rad).
fn moment_at_rest(model: &Rotor, wind: f64, rotor_speed: f64, pitch: PerBlade<f64>) -> f64 {
    let (mut state, mut memory) = (model.start(), model.memory());
    let wind = FixedFrame { average: wind, ..FixedFrame::default() };
    let kinematics = RotorKinematics { azimuth: 0.0, rotor_speed, pitch };
    model.rest(wind, &kinematics, &mut state, &mut memory);
    model.advance(1.0, wind, &kinematics, &mut state, &mut memory).moments.mean()
}
