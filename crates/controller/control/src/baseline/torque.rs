//! Generator torque: optimal tip-speed ratio below rated, held rotor speed at both ends, rated power above.

use super::{Constants, bounded};
use serde::{Deserialize, Serialize};

/// State of torque control.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Torque {
    /// Integral part of the speed controller (N m).
    integral: f64,
    /// Last command (N m).
    command: f64,
}

impl Torque {
    /// Torque control that has settled at `rotor_speed` (rad/s).
    pub(crate) fn settled(constants: &Constants, rotor_speed: f64) -> Self {
        let command = greedy(constants, rotor_speed, upper_limit(constants, rotor_speed));
        Self { integral: command, command }
    }

    /// Torque control that goes on from `command` (N m) without a step, whatever the distance of
    /// `rotor_speed` (rad/s) from its `reference` (rad/s).
    pub(super) fn continued(
        command: f64,
        rotor_speed: f64,
        reference: f64,
        constants: &Constants,
    ) -> Self {
        let most = upper_limit(constants, rotor_speed);
        let command = bounded(command, constants.minimum_torque, most);
        let proportional = constants.torque_gains.proportional * (rotor_speed - reference);
        let integral = bounded(command - proportional, constants.minimum_torque, most);
        Self { integral, command }
    }

    /// Torque (N m) for the filtered `rotor_speed` (rad/s) over `interval` (s) along k ω²; the rotor is kept
    /// at or below `speed_reference` (rad/s) as long as torque can.
    ///
    /// A PI speed controller between two limits that close on k ω² away from minimum and rated speed:
    /// Hansen and Henriksen, "Basic DTU Wind Energy controller", DTU Wind Energy E-0028, 2013, §2.1.
    pub(super) fn follow_greedy(
        &mut self,
        interval: f64,
        rotor_speed: f64,
        speed_reference: f64,
        constants: &Constants,
    ) -> f64 {
        let most = upper_limit(constants, rotor_speed);
        let greedy = greedy(constants, rotor_speed, most);
        let slow = rotor_speed < 0.5 * (constants.minimum_rotor_speed + speed_reference);
        let (reference, low, high) = if slow {
            (constants.minimum_rotor_speed, constants.minimum_torque.min(greedy), greedy)
        } else {
            (speed_reference, greedy, most)
        };
        self.hold(interval, rotor_speed - reference, [low, high], constants)
    }

    /// Torque (N m) for the filtered `rotor_speed` (rad/s) over `interval` (s) that brings the rotor to
    /// `reference` (rad/s).
    pub(crate) fn track(
        &mut self,
        interval: f64,
        rotor_speed: f64,
        reference: f64,
        constants: &Constants,
    ) -> f64 {
        let limits = [constants.minimum_torque, upper_limit(constants, rotor_speed)];
        self.hold(interval, rotor_speed - reference, limits, constants)
    }

    /// PI control of the speed `error` (rad/s) within limits on torque (N m) and its rate.
    fn hold(
        &mut self,
        interval: f64,
        error: f64,
        [low, high]: [f64; 2],
        constants: &Constants,
    ) -> f64 {
        let gains = constants.torque_gains;
        self.integral = bounded(self.integral + gains.integral * error * interval, low, high);
        let wanted = bounded(gains.proportional * error + self.integral, low, high);
        let change = constants.maximum_torque_rate * interval;
        self.command += bounded(wanted - self.command, -change, change);
        self.command
    }

    /// Last command (N m).
    pub(super) fn command(&self) -> f64 {
        self.command
    }
}

/// Greatest torque (N m) at `rotor_speed` (rad/s): rated torque, or less where rated power takes less.
fn upper_limit(constants: &Constants, rotor_speed: f64) -> f64 {
    let limit = if constants.constant_power {
        let speed = rotor_speed.max(constants.rated_rotor_speed);
        constants.rated_power / (constants.generator_efficiency * speed)
    } else {
        constants.rated_torque
    };
    bounded(limit, constants.minimum_torque, constants.maximum_torque)
}

/// k ω², at most `most` (N m).
fn greedy(constants: &Constants, rotor_speed: f64, most: f64) -> f64 {
    bounded(constants.torque_gain * rotor_speed * rotor_speed, constants.minimum_torque, most)
}
