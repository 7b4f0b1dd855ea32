//! Torque and collective pitch control: most power below rated, rated power above.

mod coefficients;
mod constants;
mod estimator;
mod individual_pitch;
mod kind;
mod pitch;
mod speed;
mod torque;
mod tower;

use crate::controller::{Controller, ForeignState, from_bytes, to_bytes};
use basis::{Commands, Measurements, PerBlade};
pub use coefficients::{CoefficientTable, CoefficientTableError};
pub use constants::{
    Constants, IndividualPitch, MAXIMUM_NOTCHES, MinimumPitch, Notch, PitchFloor, PitchGains,
    SetPointSmoothing, TorqueControl, TorqueGains, TowerDamping, WIND_SPEED_FILTER_CORNER,
    WindSpeedEstimator, greedy_torque_gain,
};
use individual_pitch::Individual;
pub use kind::BASELINE;
use lti::LowPass;
use pitch::Pitch;
pub(crate) use pitch::least_pitch;
use serde::{Deserialize, Serialize};
pub(crate) use speed::SpeedFilter;
use speed::Wind;
pub(crate) use torque::Torque;
use tower::TowerDamper;

/// Least distance of torque control's speed reference below pitch control's, relative to rated speed (–).
///
/// With one reference for both, the two loops can share the work at a pitch above the least one and a torque
/// below rated, for ever and at a loss of power; apart, only one of them can stand still at its reference.
const REFERENCE_DISTANCE: f64 = 0.005;

/// Greedy control: greatest power by torque below rated, collective pitch above; tower and individual-pitch
/// damping where its constants ask for them.
///
/// Starts without a bump from the first measurements it sees, and holds for any interval up to about 0.3 s.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Baseline {
    constants: Constants,
    state: Option<BaselineState>,
}

/// What the controller remembers from one instant to the next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct BaselineState {
    rotor_speed: SpeedFilter,
    wind: Wind,
    /// Relative shift of the two speed references (–).
    shift: LowPass,
    torque: Torque,
    pitch: Pitch,
    tower: Option<TowerDamper>,
    individual: Individual,
}

impl Baseline {
    /// Control of the turbine with `constants`.
    pub fn new(constants: Constants) -> Self {
        Self { constants, state: None }
    }

    /// Constants of the turbine.
    pub fn constants(&self) -> &Constants {
        &self.constants
    }

    /// Collective pitch last commanded (rad), without damping; fine pitch before the first update.
    pub fn collective_pitch(&self) -> f64 {
        self.state.as_ref().map_or(self.constants.fine_pitch, |state| state.pitch.command())
    }

    /// Free-stream wind speed estimated by the controller (m/s), smoothed; nothing before the first update.
    pub fn wind_speed(&self) -> Option<f64> {
        self.state.as_ref().map(|state| state.wind.speed(&self.constants))
    }
}

impl Controller for Baseline {
    fn update(&mut self, measurements: &Measurements) -> Commands {
        let constants = &self.constants;
        let state =
            self.state.get_or_insert_with(|| BaselineState::settled(constants, measurements));
        let interval = measurements.interval;
        let rotor_speed = state.rotor_speed.update(interval, measurements.generator_speed);
        let wind_speed =
            state.wind.update(measurements, rotor_speed, state.torque.command(), constants);
        let least_pitch = least_pitch(wind_speed, constants);

        let shift = state.reference_shift(least_pitch, constants);
        let shift = constants.rated_rotor_speed * state.shift.update(interval, shift);
        let pitch_reference = constants.rated_rotor_speed - shift.min(0.0);
        let generator_torque =
            state.ask_torque(interval, rotor_speed, wind_speed, shift, constants);
        let collective =
            state.pitch.update(interval, rotor_speed, pitch_reference, least_pitch, constants);
        let pitch = state.add_damping(measurements, wind_speed, collective, least_pitch, constants);
        Commands { pitch, generator_torque, yaw_rate: 0.0 }
    }

    fn describe(&self) -> String {
        "baseline".to_owned()
    }

    fn save(&self) -> Vec<u8> {
        to_bytes(&self.state)
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        self.state = from_bytes(state)?;
        Ok(())
    }
}

impl BaselineState {
    fn settled(constants: &Constants, measurements: &Measurements) -> Self {
        let rotor_speed = measurements.generator_speed;
        let mut torque = Torque::settled(constants, rotor_speed);
        let tracks = constants.torque_control() == TorqueControl::TipSpeedRatio;
        let in_force = if tracks && measurements.generator_torque > 0.0 {
            measurements.generator_torque
        } else {
            torque.command()
        };
        let wind = Wind::settled(measurements, in_force, constants);
        if tracks {
            let reference = tracking_speed(wind.speed(constants), 0.0, constants);
            torque = Torque::continued(in_force, rotor_speed, reference, constants);
        }
        let least = least_pitch(wind.speed(constants), constants);
        let pitch = bounded(measurements.pitch.mean(), least, constants.maximum_pitch.max(least));
        let tower = constants
            .tower_damping
            .as_ref()
            .map(|damping| TowerDamper::settled(measurements.tower_top_acceleration, damping));
        let mut state = Self {
            rotor_speed: SpeedFilter::settled(rotor_speed, constants),
            wind,
            shift: LowPass::settled(constants.set_point_smoothing.filter_corner, 0.0),
            torque,
            pitch: Pitch::settled(pitch),
            tower,
            individual: Individual::default(),
        };
        let shift = state.reference_shift(least, constants);
        state.shift = LowPass::settled(constants.set_point_smoothing.filter_corner, shift);
        state
    }

    /// Torque (N m) for the filtered `rotor_speed` (rad/s) in a wind of `wind_speed` (m/s), the references
    /// shifted by `shift` (rad/s).
    fn ask_torque(
        &mut self,
        interval: f64,
        rotor_speed: f64,
        wind_speed: f64,
        shift: f64,
        constants: &Constants,
    ) -> f64 {
        match constants.torque_control() {
            TorqueControl::KOmegaSquared => {
                let distance = REFERENCE_DISTANCE * constants.rated_rotor_speed;
                let reference = constants.rated_rotor_speed - shift.max(0.0) - distance;
                self.torque.follow_greedy(interval, rotor_speed, reference, constants)
            }
            TorqueControl::TipSpeedRatio => {
                let reference = tracking_speed(wind_speed, shift, constants);
                self.torque.track(interval, rotor_speed, reference, constants)
            }
        }
    }

    /// Positive while pitch is at work (torque then leaves rotor speed to it), negative while power is
    /// missing.
    fn reference_shift(&self, least_pitch: f64, constants: &Constants) -> f64 {
        let smoothing = constants.set_point_smoothing;
        let power =
            self.torque.command() * self.rotor_speed.value() * constants.generator_efficiency;
        let missing = 1.0 - power / constants.rated_power;
        smoothing.torque_shift * (self.pitch.command() - least_pitch)
            - smoothing.pitch_shift * missing
    }

    /// Pitch of each blade (rad): `collective` (rad) with what damps the tower and evens out the blades.
    fn add_damping(
        &mut self,
        measurements: &Measurements,
        wind_speed: f64,
        collective: f64,
        least_pitch: f64,
        constants: &Constants,
    ) -> PerBlade<f64> {
        let mut collective = collective;
        if let (Some(damper), Some(damping)) = (&mut self.tower, &constants.tower_damping) {
            let acceleration = measurements.tower_top_acceleration;
            let added = damper.update(measurements.interval, acceleration, damping);
            collective = bounded(collective + added, constants.fine_pitch, constants.maximum_pitch);
        }
        let mut pitch = PerBlade::splat(measurements.pitch.len(), collective);
        if let Some(individual) = &constants.individual_pitch {
            let floors = [constants.fine_pitch, least_pitch];
            let added =
                self.individual.update(measurements, wind_speed, collective, floors, individual);
            for (pitch, added) in pitch.iter_mut().zip(added.iter()) {
                *pitch += added;
            }
        }
        pitch
    }
}

/// Rotor speed (rad/s) that torque tracks in a wind of `wind_speed` (m/s): optimal tip-speed ratio, between
/// the least speed and one just below rated, less a `shift` (rad/s) while pitch is at work.
fn tracking_speed(wind_speed: f64, shift: f64, constants: &Constants) -> f64 {
    let optimal = constants.optimal_tip_speed_ratio * wind_speed / constants.rotor_radius;
    let most = (1.0 - REFERENCE_DISTANCE) * constants.rated_rotor_speed;
    (optimal.min(most) - shift.max(0.0)).max(constants.minimum_rotor_speed)
}

/// `value` between `low` and `high`; unlike `clamp` it cannot panic, and a value that is not a number becomes
/// `low`.
fn bounded(value: f64, low: f64, high: f64) -> f64 {
    value.max(low).min(high)
}
