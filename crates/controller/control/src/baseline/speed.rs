//! Rotor speed and wind in the controller: filtered measurements, and the wind estimated from them.

use super::constants::{Constants, MAXIMUM_NOTCHES};
use super::estimator::Estimator;
use basis::Measurements;
use lti::{LowPass, SecondOrder, Smoother};
use serde::{Deserialize, Serialize};

/// Corner of the filter on the power that the wind speed is guessed from without an estimator (rad/s): slower
/// than the rotor, faster than gusts as large as the rotor.
const POWER_FILTER_CORNER: f64 = 0.2;

/// Low-pass and notch filters on rotor speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SpeedFilter {
    low_pass: Smoother,
    notches: [SecondOrder; MAXIMUM_NOTCHES],
    n_notches: usize,
}

impl SpeedFilter {
    /// Filters that have settled at `rotor_speed` (rad/s).
    pub(crate) fn settled(rotor_speed: f64, constants: &Constants) -> Self {
        let mut notches = [SecondOrder::default(); MAXIMUM_NOTCHES];
        for (filter, notch) in notches.iter_mut().zip(&constants.speed_notches) {
            let (numerator, denominator) = (notch.numerator_damping, notch.denominator_damping);
            *filter = SecondOrder::notch(notch.frequency, numerator, denominator, rotor_speed);
        }
        Self {
            low_pass: smoother(rotor_speed, constants),
            notches,
            n_notches: constants.speed_notches.len().min(MAXIMUM_NOTCHES),
        }
    }

    /// Filtered rotor speed (rad/s) after `interval` (s) of `rotor_speed` (rad/s).
    pub(crate) fn update(&mut self, interval: f64, rotor_speed: f64) -> f64 {
        let low = self.low_pass.update(interval, rotor_speed);
        let notches = self.notches.iter_mut().take(self.n_notches);
        notches.fold(low, |speed, notch| notch.update(interval, speed))
    }

    /// Filtered rotor speed (rad/s).
    pub(super) fn value(&self) -> f64 {
        match self.n_notches {
            0 => self.low_pass.value(),
            n => self.notches[n - 1].value(),
        }
    }
}

/// What the wind speed is found from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[expect(clippy::large_enum_variant, reason = "one of each turbine, moved once")]
pub(super) enum Wind {
    /// Mechanical power taken off the shaft (W).
    Power(LowPass),
    /// Balance of torques on the rotor; torque and pitch lag as the speed that they meet there does.
    Balance { estimator: Estimator, torque: Smoother, pitch: Smoother },
}

impl Wind {
    /// The wind in which `measurements` with `torque` (N m) in force would not change.
    pub(super) fn settled(measurements: &Measurements, torque: f64, constants: &Constants) -> Self {
        let (rotor_speed, pitch) = (measurements.generator_speed, measurements.pitch.mean());
        match &constants.estimator {
            None => Self::Power(LowPass::settled(POWER_FILTER_CORNER, torque * rotor_speed)),
            Some(known) => Self::Balance {
                estimator: Estimator::settled(
                    rotor_speed,
                    torque,
                    pitch,
                    constants.rotor_radius,
                    known,
                    constants.wind_speed_filter_corner,
                ),
                torque: smoother(torque, constants),
                pitch: smoother(pitch, constants),
            },
        }
    }

    /// Wind speed (m/s) after the interval of `measurements` with `torque` (N m) in force, at whose end
    /// filtered speed is `rotor_speed` (rad/s).
    pub(super) fn update(
        &mut self,
        measurements: &Measurements,
        rotor_speed: f64,
        torque: f64,
        constants: &Constants,
    ) -> f64 {
        let interval = measurements.interval;
        match (&mut *self, &constants.estimator) {
            (Self::Balance { estimator, torque: torques, pitch }, Some(known)) => {
                let torque = torques.update(interval, torque);
                let pitch = pitch.update(interval, measurements.pitch.mean());
                let radius = constants.rotor_radius;
                estimator.update(interval, rotor_speed, torque, pitch, radius, known);
            }
            (Self::Power(power), _) => {
                power.update(interval, measurements.generator_torque * measurements.rotor_speed);
            }
            (Self::Balance { .. }, None) => {}
        }
        self.speed(constants)
    }

    /// Free-stream wind speed (m/s), smoothed.
    pub(super) fn speed(&self, constants: &Constants) -> f64 {
        match self {
            Self::Power(power) => wind_speed_of(power.value(), constants),
            Self::Balance { estimator, .. } => estimator.smoothed(),
        }
    }
}

/// The filter on rotor speed for another quantity, settled at `value`.
fn smoother(value: f64, constants: &Constants) -> Smoother {
    Smoother::settled(constants.speed_filter_corner, constants.speed_filter_damping, value)
}

/// Free-stream wind speed (m/s) in which the optimal rotor takes `shaft_power` (W) off the wind:
/// with P = k (λ U / R)³. Below the true speed wherever the rotor is not at its optimum, so also above rated.
fn wind_speed_of(shaft_power: f64, constants: &Constants) -> f64 {
    let rotor_speed = (shaft_power.max(0.0) / constants.torque_gain).cbrt();
    rotor_speed * constants.rotor_radius / constants.optimal_tip_speed_ratio
}
