//! The extended Kalman filter with the rotor's blade-element model as measurement function.

use super::clock::{Clock, Use};
use super::estimate::{HelixEstimate, Status};
use super::filter::{Filter, FilterState, Instant, Readings};
use super::flap::Bend;
use super::options::{HelixOptions, Jacobian};
use super::rotor::{self, Rotor, RotorKinematics};
use super::settings::{HelixSettings, check};
use super::state_estimate::{MEAN_WIND, N_STATES, Vector};
use crate::{EstimationError, Estimator};
use basis::{Measurements, PerBlade};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use turbine::Definition;

/// Estimates mean wind, amplitude and phases of a helix from the moments at the blade roots, while its own
/// rotor pitches.
///
/// The filter of van Vondelen et al. (2025), Eqs. 8-21; [`HelixOptions`] hold what they leave open.
/// Parameters come from the case; [`HelixEstimator::state`] is the whole state.
#[derive(Clone, Debug)]
pub struct HelixEstimator {
    filter: Filter,
    rotor: Rotor,
    rated_speed: f64,
    /// Control interval (s).
    interval: f64,
    memory: rotor::Memory,
    state: HelixEstimatorState,
}

/// State of the estimator; a run restored from it continues with the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HelixEstimatorState {
    filter: FilterState,
    rotor: rotor::RotorModelState,
    clock: Clock,
    status: Status,
}

impl HelixEstimator {
    /// An estimator on a turbine of `definition`.
    ///
    /// # Errors
    /// [`EstimationError`] for settings out of range, noise that is not positive definite, an excitation
    /// above the Nyquist rate of the updates, or a rotor of fewer than three blades.
    pub fn new(
        definition: &Arc<Definition>,
        settings: &HelixSettings,
        options: HelixOptions,
    ) -> Result<Self, EstimationError> {
        check(definition, settings, &options)?;
        let filter = Filter::new(definition, settings, options);
        let rotor = Rotor::new(definition, settings, &options);
        let state = HelixEstimatorState {
            filter: filter.blank(),
            rotor: rotor.start(),
            clock: Clock::new(definition.n_blades),
            status: Status::Waiting,
        };
        let memory = rotor.memory();
        let (rated_speed, interval) = (definition.rated_rotor_speed, settings.interval);
        Ok(Self { filter, rotor, rated_speed, interval, memory, state })
    }

    /// Its options.
    pub fn options(&self) -> &HelixOptions {
        &self.filter.options
    }

    /// What the next update will use `measurements` for.
    pub(super) fn looks_at(&self, measurements: &Measurements) -> Use {
        let mut clock = self.state.clock;
        let every = self.filter.options.update_every;
        clock.look(measurements, every, self.interval, self.rated_speed)
    }

    pub(super) fn filter(&self) -> &Filter {
        &self.filter
    }

    pub(super) fn filter_state(&self) -> &FilterState {
        &self.state.filter
    }

    pub(super) fn status(&self) -> Status {
        self.state.status
    }

    /// Angle of the excitation (rad) at the time of the moments of `measurements`, reading delay included.
    fn angle(&self, measurements: &Measurements) -> f64 {
        self.filter.rate * (measurements.time - self.filter.options.rotor.reading_delay)
    }

    /// Initialises with the uniform wind that gives the mean of the moments; false unless all moments are
    /// usable.
    fn begin(&mut self, kinematics: &RotorKinematics, readings: &Readings) -> bool {
        if readings.iter().any(Option::is_none) {
            return false;
        }
        let mean_moment = readings.map(|reading| reading.unwrap_or(0.0)).mean();
        let Self { rotor, memory, state, .. } = self;
        let wind = rotor.settle(mean_moment, kinematics, &mut state.rotor, memory);
        state.filter = self.filter.blank();
        state.filter.estimate = self.filter.start(wind);
        true
    }

    fn assimilate(
        &mut self,
        interval: f64,
        readings: &Readings,
        measurements: &Measurements,
    ) -> Status {
        let kinematics = self.rotor.kinematics(measurements);
        if self.state.status == Status::Waiting {
            return if self.begin(&kinematics, readings) {
                Status::Tracking
            } else {
                Status::Waiting
            };
        }
        let angle = self.angle(measurements);
        let Self { filter, rotor, memory, state, .. } = self;
        filter.predict(interval, &mut state.filter);
        let pitch_wind = rotor.wind_equivalent_of_pitch(&kinematics);
        let (wind, wind_slopes) = filter.wind(&state.filter.estimate.mean, angle, pitch_wind);
        let expected = rotor.advance(interval, wind, &kinematics, &mut state.rotor, memory);
        let slopes = match filter.options.jacobian {
            Jacobian::Analytic => Filter::blade_slopes(kinematics.azimuth, &expected, &wind_slopes),
            Jacobian::CentralDifferences { step } => {
                self.differences(step, angle, &kinematics, &expected.bend)
            }
        };
        let now = Instant { interval, angle, azimuth: kinematics.azimuth, wind, pitch_wind };
        let n_used = {
            let Self { filter, state, .. } = self;
            filter.correct(&now, &expected, &slopes, readings, &mut state.filter)
        };
        if !self.state.filter.estimate.is_finite() {
            let wind = if wind.average.is_finite() { wind.average } else { 0.5 * rotor::WINDS[1] };
            self.state.filter = self.filter.blank();
            self.state.filter.estimate = self.filter.start(wind);
            return Status::Restarted;
        }
        match n_used {
            0 => Status::Holding,
            n if n < readings.len() => Status::Partial,
            _ => Status::Tracking,
        }
    }

    /// Slopes of each blade's moment over the states by central differences of the whole measurement
    /// function, wake held. van Vondelen et al. (2025), Eq. 18.
    fn differences(
        &self,
        step: f64,
        angle: f64,
        kinematics: &RotorKinematics,
        bend: &Bend,
    ) -> PerBlade<Vector> {
        let mean = &self.state.filter.estimate.mean;
        let pitch_wind = self.rotor.wind_equivalent_of_pitch(kinematics);
        let mut slopes = PerBlade::splat(self.rotor.n_blades(), [0.0; N_STATES]);
        for index in 0..N_STATES {
            let beside = |distance: f64| {
                let mut beside = *mean;
                beside[index] += distance;
                let (wind, _) = self.filter.wind(&beside, angle, pitch_wind);
                self.rotor.moments_beside(wind, kinematics, bend, &self.memory, &self.state.rotor)
            };
            let (up, down) = (beside(0.5 * step), beside(-0.5 * step));
            for ((slopes, up), down) in slopes.iter_mut().zip(up.iter()).zip(down.iter()) {
                slopes[index] = (up - down) / step;
            }
        }
        slopes
    }
}

impl Estimator for HelixEstimator {
    type Estimate = HelixEstimate;
    type State = HelixEstimatorState;

    fn update(&mut self, measurements: &Measurements) -> HelixEstimate {
        let every = self.filter.options.update_every;
        let look = self.state.clock.look(measurements, every, self.interval, self.rated_speed);
        match look {
            Use::Nothing => {}
            Use::Blind(interval) => {
                if self.state.status != Status::Waiting {
                    self.filter.predict(interval, &mut self.state.filter);
                    self.state.status = Status::Holding;
                }
            }
            Use::Seen(interval, readings) => {
                self.state.status = self.assimilate(interval, &readings, measurements);
            }
        }
        let angle = self.filter.rate * measurements.time;
        let angle = if angle.is_finite() { angle } else { 0.0 };
        HelixEstimate::of(&self.filter, &self.state.filter, angle, self.state.status)
    }

    fn state(&self) -> &HelixEstimatorState {
        &self.state
    }

    fn restore(&mut self, state: HelixEstimatorState) {
        self.state = state;
    }
}

impl Filter {
    /// For a turbine of `definition`.
    pub(super) fn new(
        definition: &Definition,
        settings: &HelixSettings,
        options: HelixOptions,
    ) -> Self {
        Self {
            options,
            sense: settings.sense,
            rate: settings.rate,
            diameter: definition.rotor_diameter(),
            interval: settings.interval * options.update_every as f64,
            n_blades: definition.n_blades,
        }
    }
}

impl HelixEstimator {
    /// Estimated mean wind (m/s); zero before the first measurement.
    pub fn mean_wind(&self) -> f64 {
        self.state.filter.estimate.mean[MEAN_WIND]
    }
}
