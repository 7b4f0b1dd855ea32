//! The controller's constants: what ties them to one another, and their form in SI.

use super::document::{self, Controller};
use super::error::{Place, Step::Key, TurbineFileError};
use control::baseline::{
    Constants, IndividualPitch, MAXIMUM_NOTCHES, MinimumPitch, Notch, PitchFloor, PitchGains,
    SetPointSmoothing, TorqueControl, TorqueGains, TowerDamping, WIND_SPEED_FILTER_CORNER,
};
use std::f64::consts::PI;

/// What the group `controller` may hold beyond what holds for each of its numbers.
pub(super) fn check(controller: &Controller, place: &Place) -> Result<(), TurbineFileError> {
    let at = |key| [Key("controller"), Key(key)];
    let rated = controller.rated_rotor_speed_rpm;
    let minimum = controller.minimum_rotor_speed_rpm;
    place.within(&at("minimum_rotor_speed_rpm"), minimum, 0.0, rated, " rpm")?;
    let (least, most) = (controller.rated_torque, controller.maximum_torque);
    place.within(&at("maximum_torque"), most, least, 1e10, " N m")?;
    let fine = controller.fine_pitch_deg;
    place.within(&at("maximum_pitch_deg"), controller.maximum_pitch_deg, fine, 180.0, "°")?;
    let speeds: Vec<f64> = controller.minimum_pitch.iter().map(|row| row[0]).collect();
    place.rising("controller", "minimum_pitch", &speeds, 0, true)?;
    let pitches: Vec<f64> = controller.pitch_gains.iter().map(|row| row[0]).collect();
    place.rising("controller", "pitch_gains", &pitches, 1, true)?;
    if controller.speed_notches.len() > MAXIMUM_NOTCHES {
        return Err(place.error(
            &at("speed_notches"),
            format!("{MAXIMUM_NOTCHES} rows at most"),
            controller.speed_notches.len().to_string(),
            "leave out the notches that matter least",
        ));
    }
    if let Some(individual) = &controller.individual_pitch {
        let [start, full] = individual.ramp;
        let ramp = [Key("controller"), Key("individual_pitch"), Key("ramp")];
        place.within(&ramp, full, start, 1e3, " m/s")?;
    }
    Ok(())
}

/// The controller's constants in SI, without what estimates the wind; `rotor_radius` (m) and
/// `generator_efficiency` (–) stand elsewhere in the file.
pub fn controller_of(
    controller: &Controller,
    rotor_radius: f64,
    generator_efficiency: f64,
) -> Constants {
    let minimum_pitch =
        |row: &[f64; 2]| MinimumPitch { wind_speed: row[0], pitch: row[1].to_radians() };
    let pitch_gains = |row: &[f64; 3]| PitchGains {
        pitch: row[0].to_radians(),
        proportional: row[1],
        integral: row[2],
    };
    Constants {
        rotor_radius,
        optimal_tip_speed_ratio: controller.optimal_tip_speed_ratio,
        torque_gain: controller.torque_gain,
        minimum_rotor_speed: from_rpm(controller.minimum_rotor_speed_rpm),
        rated_rotor_speed: from_rpm(controller.rated_rotor_speed_rpm),
        rated_torque: controller.rated_torque,
        rated_power: 1e3 * controller.rated_power_kw,
        generator_efficiency,
        minimum_torque: controller.minimum_torque,
        maximum_torque: controller.maximum_torque,
        maximum_torque_rate: controller.maximum_torque_rate,
        constant_power: controller.constant_power,
        torque_gains: TorqueGains {
            proportional: controller.torque_proportional,
            integral: controller.torque_integral,
        },
        fine_pitch: controller.fine_pitch_deg.to_radians(),
        minimum_pitch: controller.minimum_pitch.iter().map(minimum_pitch).collect(),
        maximum_pitch: controller.maximum_pitch_deg.to_radians(),
        maximum_pitch_rate: controller.maximum_pitch_rate_deg_s.to_radians(),
        pitch_gains: controller.pitch_gains.iter().map(pitch_gains).collect(),
        set_point_smoothing: SetPointSmoothing {
            torque_shift: controller.set_point_smoothing.torque_shift,
            pitch_shift: controller.set_point_smoothing.pitch_shift,
            filter_corner: controller.set_point_smoothing.filter_corner,
        },
        speed_filter_corner: controller.speed_filter_corner,
        speed_filter_damping: controller.speed_filter_damping,
        speed_notches: controller
            .speed_notches
            .iter()
            .map(|[frequency, numerator_damping, denominator_damping]| Notch {
                frequency: *frequency,
                numerator_damping: *numerator_damping,
                denominator_damping: *denominator_damping,
            })
            .collect(),
        torque_control: controller.torque_control.map(|given| match given {
            document::TorqueControl::KOmegaSquared => TorqueControl::KOmegaSquared,
            document::TorqueControl::TipSpeedRatio => TorqueControl::TipSpeedRatio,
        }),
        wind_speed_filter_corner: controller
            .wind_speed_filter_corner
            .unwrap_or(WIND_SPEED_FILTER_CORNER),
        estimator: None,
        tower_damping: controller.tower_damping.as_ref().map(|damping| TowerDamping {
            gain: damping.gain,
            high_pass_corner: damping.high_pass_corner,
            limit: damping.limit_deg.to_radians(),
        }),
        individual_pitch: controller.individual_pitch.as_ref().map(individual_pitch_of),
    }
}

fn individual_pitch_of(given: &document::IndividualPitch) -> IndividualPitch {
    IndividualPitch {
        proportional: given.proportional,
        integral: given.integral,
        azimuth_offset: given.azimuth_offset_deg.map(f64::to_radians),
        limit: given.limit_deg.to_radians(),
        ramp: given.ramp,
        floor: match given.floor {
            document::PitchFloor::None => PitchFloor::None,
            document::PitchFloor::FinePitch => PitchFloor::Fine,
            document::PitchFloor::MinimumPitch => PitchFloor::Least,
        },
    }
}

/// Speed (rad/s) of one in revolutions per minute.
pub(super) fn from_rpm(speed: f64) -> f64 {
    speed * PI / 30.0
}
