//! Individual pitch control: tilt and yaw moment of the rotor driven to zero.

use super::constants::{IndividualPitch, PitchFloor};
use basis::mbc::{to_blades, to_fixed_frame};
use basis::{FixedFrame, Measurements, PerBlade};
use serde::{Deserialize, Serialize};

/// State of individual pitch control: the integral parts of tilt and yaw (rad).
///
/// Root moments go to the fixed frame, a PI controller for each of tilt and yaw turns them into pitch, and
/// that goes back to the blades with an azimuth offset, which makes up for what actuators and blades lag
/// behind.
///
/// Source: Bossanyi, "Individual blade pitch control for load reduction", Wind Energy 6, 2003; with the
/// azimuth offset of Mulders, Pamososuryo, Disario, van Wingerden, Wind Energy 22, 2019.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Individual {
    tilt: f64,
    yaw: f64,
}

impl Individual {
    /// What each blade adds (rad) to `collective` (rad) over `interval` (s) in a wind of `wind_speed` (m/s),
    /// amplitude within the limit and above the floor, whose scheduled form stands at `least_pitch` (rad),
    /// fixed one at `fine_pitch` (rad).
    pub(super) fn update(
        &mut self,
        measurements: &Measurements,
        wind_speed: f64,
        collective: f64,
        [fine_pitch, least_pitch]: [f64; 2],
        constants: &IndividualPitch,
    ) -> PerBlade<f64> {
        let n_blades = measurements.pitch.len();
        let moments = to_fixed_frame(measurements.azimuth, &measurements.flap_moments);
        let room = match constants.floor {
            PitchFloor::None => f64::INFINITY,
            PitchFloor::Fine => collective - fine_pitch,
            PitchFloor::Least => collective - least_pitch,
        };
        let limit = (constants.limit * smooth_step(wind_speed, constants.ramp)).min(room).max(0.0);
        if !(moments.tilt.is_finite() && moments.yaw.is_finite()) {
            return PerBlade::splat(n_blades, 0.0);
        }
        let gain = constants.integral * measurements.interval;
        [self.tilt, self.yaw] =
            within(limit, [self.tilt + gain * moments.tilt, self.yaw + gain * moments.yaw]);
        let [tilt, yaw] = within(
            limit,
            [
                self.tilt + constants.proportional * moments.tilt,
                self.yaw + constants.proportional * moments.yaw,
            ],
        );
        let pitch = FixedFrame { average: 0.0, tilt, yaw };
        let azimuth = measurements.azimuth + constants.azimuth_offset.unwrap_or(0.0);
        to_blades(azimuth, pitch, n_blades)
    }
}

/// `vector` no longer than `limit`, in its own direction.
fn within(limit: f64, vector: [f64; 2]) -> [f64; 2] {
    let length = vector[0].hypot(vector[1]);
    if length > limit { vector.map(|part| part * limit / length) } else { vector }
}

/// Nothing below the first of `ramp`, all above the second, a cubic without kinks between.
fn smooth_step(value: f64, ramp: [f64; 2]) -> f64 {
    if value >= ramp[1] {
        return 1.0;
    }
    let share = ((value - ramp[0]) / (ramp[1] - ramp[0])).max(0.0);
    share * share * (3.0 - 2.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramps_without_a_step() {
        assert_eq!(smooth_step(8.0, [9.0, 11.0]), 0.0);
        assert!((smooth_step(10.0, [9.0, 11.0]) - 0.5).abs() < 1e-15);
        assert_eq!(smooth_step(12.0, [9.0, 11.0]), 1.0);
        assert_eq!(smooth_step(9.0, [9.0, 9.0]), 1.0);
    }

    #[test]
    fn a_vector_is_shortened_in_its_direction() {
        assert_eq!(within(10.0, [3.0, 4.0]), [3.0, 4.0]);
        let [a, b] = within(1.0, [3.0, 4.0]);
        assert!((a - 0.6).abs() < 1e-15 && (b - 0.8).abs() < 1e-15);
        assert_eq!(within(0.0, [3.0, 4.0]), [0.0, 0.0]);
    }
}
