//! Collective pitch: least pitch below rated, rated rotor speed above.

use super::{Constants, PitchGains, bounded};
use serde::{Deserialize, Serialize};

/// State of collective pitch control.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Pitch {
    /// Integral part of the speed controller (rad).
    integral: f64,
    /// Last command (rad).
    command: f64,
}

impl Pitch {
    /// Pitch control that has settled at `pitch` (rad).
    pub(super) fn settled(pitch: f64) -> Self {
        Self { integral: pitch, command: pitch }
    }

    /// Collective pitch (rad) for the filtered `rotor_speed` (rad/s) over `interval` (s), at least `least`
    /// (rad).
    ///
    /// PI control with gains scheduled by the last command. The integral part stays within the limits on
    /// pitch and stands still while the limit on pitch rate holds it back, so that it never winds up.
    pub(super) fn update(
        &mut self,
        interval: f64,
        rotor_speed: f64,
        speed_reference: f64,
        least: f64,
        constants: &Constants,
    ) -> f64 {
        let most = constants.maximum_pitch.max(least);
        let gains = scheduled(&constants.pitch_gains, self.command);
        let error = rotor_speed - speed_reference;
        let change = constants.maximum_pitch_rate * interval;
        let step = gains.integral * error * interval;
        let integral = bounded(self.integral + step, least, most);
        let wanted = bounded(gains.proportional * error + integral, least, most);
        let given = bounded(wanted, self.command - change, self.command + change);
        let held_back = (wanted - given) * step > 0.0;
        self.integral = if held_back { bounded(self.integral, least, most) } else { integral };
        self.command = given;
        given
    }

    /// Last command (rad).
    pub(super) fn command(&self) -> f64 {
        self.command
    }
}

/// Gains at `pitch` (rad), linear between rows and constant beyond them; no gains without rows.
fn scheduled(rows: &[PitchGains], pitch: f64) -> PitchGains {
    let none = PitchGains { pitch, proportional: 0.0, integral: 0.0 };
    let above = rows.partition_point(|row| row.pitch <= pitch);
    match (above.checked_sub(1).map(|below| rows[below]), rows.get(above).copied()) {
        (None, None) => none,
        (Some(row), None) | (None, Some(row)) => row,
        (Some(low), Some(high)) => {
            let share = (pitch - low.pitch) / (high.pitch - low.pitch);
            let between = |a: f64, b: f64| a + share * (b - a);
            PitchGains {
                pitch,
                proportional: between(low.proportional, high.proportional),
                integral: between(low.integral, high.integral),
            }
        }
    }
}

/// Least collective pitch (rad) at `wind_speed` (m/s), linear between rows and constant beyond them.
pub(crate) fn least_pitch(wind_speed: f64, constants: &Constants) -> f64 {
    let rows = &constants.minimum_pitch;
    let above = rows.partition_point(|row| row.wind_speed <= wind_speed);
    match (above.checked_sub(1).map(|below| rows[below]), rows.get(above)) {
        (None, None) => constants.fine_pitch,
        (Some(row), None) => row.pitch,
        (None, Some(row)) => row.pitch,
        (Some(low), Some(high)) => {
            let share = (wind_speed - low.wind_speed) / (high.wind_speed - low.wind_speed);
            low.pitch + share * (high.pitch - low.pitch)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_are_linear_between_rows_and_constant_beyond() {
        let row = |pitch, proportional, integral| PitchGains { pitch, proportional, integral };
        let rows = [row(0.1, 1.0, 0.1), row(0.2, 0.5, 0.3)];
        assert_eq!(scheduled(&rows, 0.0).proportional, 1.0);
        assert_eq!(scheduled(&rows, 0.1).integral, 0.1);
        assert!((scheduled(&rows, 0.15).proportional - 0.75).abs() < 1e-15);
        assert!((scheduled(&rows, 0.15).integral - 0.2).abs() < 1e-15);
        assert_eq!(scheduled(&rows, 0.9).integral, 0.3);
        assert_eq!(scheduled(&[], 0.9).proportional, 0.0);
    }
}
