//! The extended Kalman filter with the rotor's blade-element model inside.

use super::belief::{MEAN_WIND, N_STATES, Vector};
use super::clock::{Clock, Use};
use super::estimate::{HelixEstimate, Status};
use super::filter::{Filter, FilterState, Instant, Readings};
use super::flap::Bend;
use super::options::{Jacobian, Options, positive};
use super::rotor::{self, Posture, Rotor};
use crate::{EstimationError, Estimator};
use basis::{Measurements, PerBlade, Sense};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::sync::Arc;
use turbine::Definition;

/// What an estimator must be told of its turbine and of the helix that it looks for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// Which way the helix winds.
    pub sense: Sense,
    /// Excitation rate ω_e in the fixed frame (rad/s).
    pub rate: f64,
    /// Control interval (s).
    pub interval: f64,
    /// Air density (kg/m³).
    pub air_density: f64,
    /// Elements of each blade in the model (–); [`Setting::N_ELEMENTS`] are enough.
    pub n_elements: usize,
}

impl Setting {
    /// Elements of each blade (–) with which what the pitch of a rotor of this century does to its moments is right to well
    /// within a percent: an error there counts several times in the phase, as pitch does more to the moments than the helix.
    pub const N_ELEMENTS: usize = 16;
}

/// Finds mean wind, amplitude and phases of a helix in the moments at the blade roots, while its own rotor pitches.
///
/// The filter of van Vondelen et al. (2025), Eqs. 8-21, with what they leave open as [`Options`]. Parameters come from the
/// case; [`HelixEstimator::state`] is all that time changes.
#[derive(Clone, Debug)]
pub struct HelixEstimator {
    filter: Filter,
    rotor: Rotor,
    rated_speed: f64,
    /// Control interval (s).
    interval: f64,
    memory: rotor::Memory,
    state: State,
}

/// Everything that time changes; restoring it continues with the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    filter: FilterState,
    rotor: rotor::State,
    clock: Clock,
    status: Status,
}

impl HelixEstimator {
    /// An estimator on a turbine of `definition`.
    ///
    /// # Errors
    /// [`EstimationError`] for settings out of range, noise that is not positive definite, an excitation above the Nyquist
    /// rate of the updates, or a rotor of fewer than three blades.
    pub fn new(
        definition: &Arc<Definition>,
        setting: &Setting,
        options: Options,
    ) -> Result<Self, EstimationError> {
        check(definition, setting, &options)?;
        let filter = Filter {
            options,
            sense: setting.sense,
            rate: setting.rate,
            diameter: definition.rotor_diameter(),
        };
        let rotor = Rotor::new(definition, setting, &options);
        let state = State {
            filter: filter.blank(),
            rotor: rotor.start(),
            clock: Clock::new(definition.n_blades),
            status: Status::Waiting,
        };
        let memory = rotor.memory();
        let (rated_speed, interval) = (definition.rated_rotor_speed, setting.interval);
        Ok(Self { filter, rotor, rated_speed, interval, memory, state })
    }

    /// Choices.
    pub fn options(&self) -> &Options {
        &self.filter.options
    }

    /// Angle of the excitation (rad) when the moments of `measurements` were made.
    fn angle(&self, measurements: &Measurements) -> f64 {
        self.filter.rate * (measurements.time - self.filter.options.rotor.reading_delay)
    }

    /// Begins with the uniform wind that the mean of the moments tells; false where not all are told.
    fn begin(&mut self, posture: &Posture, readings: &Readings) -> bool {
        if readings.iter().any(Option::is_none) {
            return false;
        }
        let mean_moment = readings.map(|reading| reading.unwrap_or(0.0)).mean();
        let Self { rotor, memory, state, .. } = self;
        let wind = rotor.settle(mean_moment, posture, &mut state.rotor, memory);
        state.filter = self.filter.blank();
        state.filter.belief = self.filter.start(wind);
        true
    }

    fn see(&mut self, interval: f64, readings: &Readings, measurements: &Measurements) -> Status {
        let posture = self.rotor.posture(measurements);
        if self.state.status == Status::Waiting {
            return if self.begin(&posture, readings) { Status::Tracking } else { Status::Waiting };
        }
        let angle = self.angle(measurements);
        let Self { filter, rotor, memory, state, .. } = self;
        filter.predict(interval, &mut state.filter);
        let own = rotor.worth(&posture);
        let (wind, wind_slopes) = filter.wind(&state.filter.belief.mean, angle, own);
        let expected = rotor.advance(interval, wind, &posture, &mut state.rotor, memory);
        let slopes = match filter.options.jacobian {
            Jacobian::Analytic => Filter::blade_slopes(posture.azimuth, &expected, &wind_slopes),
            Jacobian::CentralDifferences { step } => {
                self.differences(step, angle, &posture, &expected.bend)
            }
        };
        let now = Instant { interval, angle, azimuth: posture.azimuth, wind, own };
        let n_heard = {
            let Self { filter, state, .. } = self;
            filter.correct(&now, &expected, &slopes, readings, &mut state.filter)
        };
        if !self.state.filter.belief.is_finite() {
            let wind = if wind.average.is_finite() { wind.average } else { 0.5 * rotor::WINDS[1] };
            self.state.filter = self.filter.blank();
            self.state.filter.belief = self.filter.start(wind);
            return Status::Restarted;
        }
        match n_heard {
            0 => Status::Holding,
            n if n < readings.len() => Status::Partial,
            _ => Status::Tracking,
        }
    }

    /// Slopes of each blade's moment over the states by central differences of the whole measurement function, wake held.
    /// van Vondelen et al. (2025), Eq. 18.
    fn differences(
        &self,
        step: f64,
        angle: f64,
        posture: &Posture,
        bend: &Bend,
    ) -> PerBlade<Vector> {
        let mean = &self.state.filter.belief.mean;
        let own = self.rotor.worth(posture);
        let mut slopes = PerBlade::splat(self.rotor.n_blades(), [0.0; N_STATES]);
        for index in 0..N_STATES {
            let beside = |distance: f64| {
                let mut beside = *mean;
                beside[index] += distance;
                let (wind, _) = self.filter.wind(&beside, angle, own);
                self.rotor.moments_beside(wind, posture, bend, &self.memory, &self.state.rotor)
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
    type State = State;

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
                self.state.status = self.see(interval, &readings, measurements);
            }
        }
        let angle = self.filter.rate * measurements.time;
        let angle = if angle.is_finite() { angle } else { 0.0 };
        HelixEstimate::of(&self.filter, &self.state.filter, angle, self.state.status)
    }

    fn state(&self) -> &State {
        &self.state
    }

    fn restore(&mut self, state: State) {
        self.state = state;
    }
}

pub(super) fn check(
    definition: &Definition,
    setting: &Setting,
    options: &Options,
) -> Result<(), EstimationError> {
    let Setting { rate, interval, air_density, n_elements, .. } = *setting;
    options.check()?;
    if definition.n_blades < 3 {
        return Err(EstimationError::FewBlades { n_blades: definition.n_blades });
    }
    positive("excitation rate (rad/s)", rate)?;
    positive("control interval (s)", interval)?;
    positive("air density (kg/m³)", air_density)?;
    positive("elements of a blade (–)", n_elements as f64)?;
    let interval = interval * options.update_every as f64;
    let (nyquist, rotor_speed) = (PI / interval, definition.rated_rotor_speed);
    if rate + rotor_speed >= nyquist {
        return Err(EstimationError::AboveNyquist { rate, rotor_speed, interval, nyquist });
    }
    Ok(())
}

impl HelixEstimator {
    /// Mean wind now believed (m/s); zero before the first reading.
    pub fn mean_wind(&self) -> f64 {
        self.state.filter.belief.mean[MEAN_WIND]
    }
}
