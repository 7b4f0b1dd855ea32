//! Torque and collective pitch control: most power below rated, rated power above.

mod constants;
mod filter;
mod pitch;
mod torque;

use crate::Controller;
use basis::{Commands, Measurements, PerBlade};
pub use constants::{
    Constants, MinimumPitch, PitchGains, SetPointSmoothing, TorqueGains, greedy_torque_gain,
};
use filter::LowPass;
use pitch::{Pitch, least_pitch};
use serde::{Deserialize, Serialize};
use torque::Torque;

/// Corner of the filter on the power that the wind speed is estimated from (rad/s): slower than the rotor,
/// faster than gusts as large as the rotor.
const WIND_SPEED_FILTER_CORNER: f64 = 0.2;

/// Least distance of torque control's speed reference below pitch control's, relative to rated speed (–).
///
/// With one reference for both, the two loops can share the work at a pitch above the least one and a torque below
/// rated, for ever and at a loss of power; apart, only one of them can stand still at its reference.
const REFERENCE_DISTANCE: f64 = 0.005;

/// Greedy control: k ω² torque below rated, collective pitch above.
///
/// Starts without a bump from the first measurements it sees, and holds for any interval up to about 0.3 s.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Baseline {
    constants: Constants,
    state: Option<State>,
}

/// What the controller remembers from one instant to the next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct State {
    rotor_speed: LowPass,
    /// Relative shift of the two speed references (–).
    shift: LowPass,
    /// Mechanical power taken off the shaft (W).
    shaft_power: LowPass,
    torque: Torque,
    pitch: Pitch,
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

    /// Collective pitch last asked for (rad); fine pitch before the first update.
    pub fn collective_pitch(&self) -> f64 {
        self.state.as_ref().map_or(self.constants.fine_pitch, |state| state.pitch.command())
    }
}

impl Controller for Baseline {
    fn update(&mut self, measurements: &Measurements) -> Commands {
        let constants = &self.constants;
        let state = self.state.get_or_insert_with(|| State::settled(constants, measurements));
        let interval = measurements.interval;
        let rotor_speed = state.rotor_speed.update(interval, measurements.rotor_speed);
        let shaft_power = measurements.generator_torque * measurements.rotor_speed;
        let shaft_power = state.shaft_power.update(interval, shaft_power);
        let least_pitch = least_pitch(wind_speed(shaft_power, constants), constants);

        let shift = state.reference_shift(least_pitch, constants);
        let shift = constants.rated_rotor_speed * state.shift.update(interval, shift);
        let distance = REFERENCE_DISTANCE * constants.rated_rotor_speed;
        let torque_reference = constants.rated_rotor_speed - shift.max(0.0) - distance;
        let pitch_reference = constants.rated_rotor_speed - shift.min(0.0);

        let generator_torque =
            state.torque.update(interval, rotor_speed, torque_reference, constants);
        let pitch =
            state.pitch.update(interval, rotor_speed, pitch_reference, least_pitch, constants);
        Commands { pitch: PerBlade::splat(measurements.pitch.len(), pitch), generator_torque }
    }
}

impl State {
    fn settled(constants: &Constants, measurements: &Measurements) -> Self {
        let torque = Torque::settled(constants, measurements.rotor_speed);
        let shaft_power = torque.command() * measurements.rotor_speed;
        let least = least_pitch(wind_speed(shaft_power, constants), constants);
        let pitch = bounded(measurements.pitch.mean(), least, constants.maximum_pitch.max(least));
        let mut state = Self {
            rotor_speed: LowPass::settled(constants.speed_filter_corner, measurements.rotor_speed),
            shift: LowPass::settled(constants.set_point_smoothing.filter_corner, 0.0),
            shaft_power: LowPass::settled(WIND_SPEED_FILTER_CORNER, shaft_power),
            torque,
            pitch: Pitch::settled(pitch),
        };
        let shift = state.reference_shift(least, constants);
        state.shift = LowPass::settled(constants.set_point_smoothing.filter_corner, shift);
        state
    }

    /// Positive while pitch is at work (torque then leaves rotor speed to it), negative while power is missing.
    fn reference_shift(&self, least_pitch: f64, constants: &Constants) -> f64 {
        let smoothing = constants.set_point_smoothing;
        let power =
            self.torque.command() * self.rotor_speed.value() * constants.generator_efficiency;
        let missing = 1.0 - power / constants.rated_power;
        smoothing.torque_shift * (self.pitch.command() - least_pitch)
            - smoothing.pitch_shift * missing
    }
}

/// Free-stream wind speed (m/s) in which the optimal rotor takes `shaft_power` (W) off the wind:
/// with P = k (λ U / R)³. Below the true speed wherever the rotor is not at its optimum, so also above rated.
fn wind_speed(shaft_power: f64, constants: &Constants) -> f64 {
    let rotor_speed = (shaft_power.max(0.0) / constants.torque_gain).cbrt();
    rotor_speed * constants.rotor_radius / constants.optimal_tip_speed_ratio
}

/// `value` between `low` and `high`; unlike `clamp` it cannot panic, and a value that is no number becomes `low`.
fn bounded(value: f64, low: f64, high: f64) -> f64 {
    value.max(low).min(high)
}
