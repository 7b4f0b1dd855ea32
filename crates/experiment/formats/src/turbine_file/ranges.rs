//! What each number of a turbine file may be: one table, and the one place where numbers are held against it.
//!
//! Every number passes here, whatever wrote it: a number without a row in the table is refused, so that none
//! is ever taken unchecked. What ties one number to another stands where the group is read.

use super::document::{Controller, Document};
use super::error::{
    Place,
    Step::{self, Key, Row},
    TurbineFileError,
};
use basis::keys::Range;
use toml::Value;

/// What one number may be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub(super) range: Range,
    /// Follows the figures of an error.
    unit: &'static str,
}

const fn from(low: f64, high: f64, unit: &'static str) -> Limits {
    Limits { range: Range { low, open: false, high }, unit }
}

const fn above(low: f64, high: f64, unit: &'static str) -> Limits {
    Limits { range: Range { low, open: true, high }, unit }
}

const HEIGHT: Limits = from(-500.0, 1000.0, " m height");
const SPAN: Limits = from(0.0, 300.0, " m span");
const TWIST: Limits = from(-90.0, 90.0, "° twist");
const SHAPE: Limits = from(-1e4, 1e4, "");
const DAMPING_RATIO: Limits = from(0.0, 0.2, " damping ratio");
const CORNER: Limits = above(0.0, 1e4, " rad/s");
const ACTUATED: Limits = from(0.05, 5.0, "");
const PLATE_LENGTH: Limits = above(0.0, 30.0, " m");
const PITCH: Limits = from(-90.0, 180.0, "°");
const TORQUE: Limits = from(0.0, 1e10, " N m");
const GAIN: Limits = from(0.0, 1e12, "");
const WIND_SPEED: Limits = from(0.0, 200.0, " m/s");
const COEFFICIENT: Limits = from(-100.0, 100.0, "");
const ANGLE: Limits = from(-360.0, 360.0, "°");
const AMPLITUDE: Limits = from(0.0, 90.0, "°");

/// Key, as a path with `*` for any one key, and what its numbers may be: one for all of them, or one for each
/// column of a row. The highest are some ten times those of the largest turbines built, or more;
/// speeds and rates are those of models in wind tunnels.
const RANGES: &[(&str, &[Limits])] = &[
    ("n_blades", &[from(0.0, 1e3, " blades")]),
    ("rotor.hub_radius", &[above(0.0, 30.0, " m")]),
    ("rotor.tip_radius", &[from(0.1, 300.0, " m")]),
    ("rotor.precone_deg", &[from(-30.0, 30.0, "°")]),
    ("rotor.shaft_tilt_deg", &[from(-30.0, 30.0, "°")]),
    ("rotor.overhang", &[from(-50.0, 50.0, " m")]),
    ("rotor.hub_height", &[above(0.0, 1000.0, " m")]),
    (
        "blade.stations",
        &[
            SPAN,
            above(0.0, 30.0, " m chord"),
            TWIST,
            from(-100.0, 100.0, " m prebend"),
            from(-100.0, 100.0, " m sweep"),
        ],
    ),
    ("blade_structure.*.coefficients", &[SHAPE]),
    ("blade_structure.*.damping_ratio", &[DAMPING_RATIO]),
    (
        "blade_structure.sections",
        &[
            SPAN,
            TWIST,
            above(0.0, 1e5, " kg/m"),
            above(0.0, 1e14, " N m² flapwise"),
            above(0.0, 1e14, " N m² edgewise"),
        ],
    ),
    ("tower.base_height", &[HEIGHT]),
    ("tower.top_height", &[above(0.0, 1000.0, " m")]),
    ("tower.top_to_shaft", &[from(0.0, 50.0, " m")]),
    ("tower.profile", &[HEIGHT, above(0.0, 100.0, " m"), from(0.0, 3.0, " drag coefficient")]),
    (
        "tower.sections",
        &[
            HEIGHT,
            above(0.0, 1e6, " kg/m"),
            above(0.0, 1e16, " N m² fore-aft"),
            above(0.0, 1e16, " N m² side-to-side"),
        ],
    ),
    ("tower.*.coefficients", &[SHAPE]),
    ("tower.*.damping_ratio", &[DAMPING_RATIO]),
    ("hub.mass", &[above(0.0, 1e7, " kg")]),
    ("hub.inertia", &[above(0.0, 1e10, " kg m²")]),
    ("nacelle.mass", &[above(0.0, 1e8, " kg")]),
    ("nacelle.yaw_inertia", &[above(0.0, 1e12, " kg m²")]),
    ("nacelle.center_of_mass", &[from(-100.0, 100.0, " m")]),
    ("nacelle.yaw_bearing_mass", &[from(0.0, 1e7, " kg")]),
    ("drive_train.gear_ratio", &[from(1.0, 1000.0, "")]),
    ("drive_train.generator_inertia", &[above(0.0, 1e10, " kg m²")]),
    ("drive_train.gearbox_efficiency", &[from(0.5, 1.0, ", a share")]),
    ("drive_train.generator_efficiency", &[from(0.5, 1.0, ", a share")]),
    ("drive_train.stiffness", &[above(0.0, 1e16, " N m/rad")]),
    ("drive_train.damping", &[from(0.0, 1e14, " N m s/rad")]),
    ("pitch_actuator.natural_frequency", &[above(0.0, 1e4, " rad/s")]),
    ("pitch_actuator.damping_ratio", &[ACTUATED]),
    ("pitch_actuator.maximum_rate_deg_s", &[from(0.01, 1e4, "°/s")]),
    ("pitch_actuator.minimum_pitch_deg", &[from(-90.0, 90.0, "°")]),
    ("pitch_actuator.maximum_pitch_deg", &[PITCH]),
    ("pitch_actuator.swashplate.travel_per_turn", &[above(0.0, 10.0, " m a turn")]),
    ("pitch_actuator.swashplate.crank_length", &[PLATE_LENGTH]),
    ("pitch_actuator.swashplate.rod_radius", &[PLATE_LENGTH]),
    ("pitch_actuator.swashplate.link_radius", &[PLATE_LENGTH]),
    ("pitch_actuator.swashplate.horn_length", &[PLATE_LENGTH]),
    ("pitch_actuator.swashplate.rod_azimuth_deg", &[ANGLE]),
    ("pitch_actuator.swashplate.bias_deg", &[from(-10.0, 10.0, "°")]),
    ("pitch_actuator.swashplate.slack_deg", &[from(0.0, 45.0, "°")]),
    ("pitch_actuator.swashplate.gain_with_rotor", &[above(0.0, 5.0, "")]),
    ("pitch_actuator.swashplate.gain_against_rotor", &[above(0.0, 5.0, "")]),
    ("operation.cut_in_wind_speed", &[from(0.0, 100.0, " m/s")]),
    ("operation.cut_out_wind_speed", &[above(0.0, 100.0, " m/s")]),
    ("controller.rated_power_kw", &[from(1e-5, 1e5, " kW")]),
    ("controller.rated_rotor_speed_rpm", &[from(0.1, 1e4, " rpm")]),
    ("controller.minimum_rotor_speed_rpm", &[from(0.0, 1e4, " rpm")]),
    ("controller.optimal_tip_speed_ratio", &[from(1.0, 20.0, "")]),
    ("controller.torque_gain", &[above(0.0, 1e14, " N m s²")]),
    ("controller.rated_torque", &[above(0.0, 1e10, " N m")]),
    ("controller.minimum_torque", &[TORQUE]),
    ("controller.maximum_torque", &[TORQUE]),
    ("controller.maximum_torque_rate", &[above(0.0, 1e12, " N m/s")]),
    ("controller.torque_proportional", &[GAIN]),
    ("controller.torque_integral", &[GAIN]),
    ("controller.fine_pitch_deg", &[from(-30.0, 30.0, "°")]),
    ("controller.maximum_pitch_deg", &[PITCH]),
    ("controller.maximum_pitch_rate_deg_s", &[above(0.0, 1e3, "°/s")]),
    ("controller.minimum_pitch", &[WIND_SPEED, PITCH]),
    ("controller.pitch_gains", &[PITCH, from(-1e4, 1e4, " s"), from(-1e4, 1e4, "")]),
    ("controller.set_point_smoothing.torque_shift", &[from(0.0, 1e4, " 1/rad")]),
    ("controller.set_point_smoothing.pitch_shift", &[from(0.0, 1e4, "")]),
    ("controller.set_point_smoothing.filter_corner", &[CORNER]),
    ("controller.speed_filter_corner", &[CORNER]),
    ("controller.speed_filter_damping", &[ACTUATED]),
    (
        "controller.speed_notches",
        &[CORNER, from(0.0, 100.0, " damping ratio"), above(0.0, 100.0, " damping ratio")],
    ),
    ("controller.wind_speed_filter_corner", &[CORNER]),
    ("controller.tower_damping.gain", &[from(0.0, 1e4, " rad s/m")]),
    ("controller.tower_damping.high_pass_corner", &[CORNER]),
    ("controller.tower_damping.limit_deg", &[AMPLITUDE]),
    ("controller.individual_pitch.proportional", &[from(0.0, 1e3, " rad/(N m)")]),
    ("controller.individual_pitch.integral", &[from(0.0, 1e4, " rad/(N m s)")]),
    ("controller.individual_pitch.azimuth_offset_deg", &[ANGLE]),
    ("controller.individual_pitch.limit_deg", &[AMPLITUDE]),
    ("controller.individual_pitch.ramp", &[from(0.0, 1e3, " m/s")]),
    ("airfoils.polar.reynolds_number", &[above(0.0, 1e10, "")]),
    (
        "airfoils.polar.table",
        &[ANGLE, COEFFICIENT, from(-1.0, 100.0, " drag coefficient"), COEFFICIENT],
    ),
    ("airfoils.polar.unsteady.zero_lift_angle_deg", &[ANGLE]),
    ("airfoils.polar.unsteady.upper_separation_angle_deg", &[ANGLE]),
    ("airfoils.polar.unsteady.lower_separation_angle_deg", &[ANGLE]),
    ("airfoils.polar.unsteady.normal_force_slope", &[from(-1e3, 1e3, " 1/rad")]),
    ("airfoils.polar.unsteady.upper_critical_normal_force", &[COEFFICIENT]),
    ("airfoils.polar.unsteady.lower_critical_normal_force", &[COEFFICIENT]),
    ("airfoils.polar.unsteady.zero_lift_drag", &[from(-1.0, 100.0, " drag coefficient")]),
    ("airfoils.polar.unsteady.zero_lift_moment", &[COEFFICIENT]),
    ("airfoils.polar.unsteady.time_constants", &[from(0.0, 1e3, " half chords")]),
    ("airfoils.polar.unsteady.indicial_amplitudes", &[COEFFICIENT]),
    ("airfoils.polar.unsteady.indicial_exponents", &[from(0.0, 1e3, "")]),
];

/// What the numbers at `path` may be, column by column; none where the table has no row for it.
fn row_of(path: &[Step]) -> Option<&'static [Limits]> {
    let keys = || {
        path.iter().filter_map(|step| match step {
            Key(key) => Some(*key),
            Row(_) => None,
        })
    };
    let is_there = |pattern: &str| {
        let mut keys = keys();
        let all =
            pattern.split('.').all(|part| keys.next().is_some_and(|k| part == "*" || part == k));
        all && keys.next().is_none()
    };
    RANGES.iter().find(|(pattern, _)| is_there(pattern)).map(|(_, limits)| *limits)
}

/// What the number in `column` (from 0) of a row may be.
fn limits_in(row: Option<&'static [Limits]>, column: usize) -> Option<&'static Limits> {
    match row? {
        [one] => Some(one),
        columns => columns.get(column),
    }
}

/// Nothing when every number of `document` is finite and in its range.
///
/// # Errors
/// [`TurbineFileError::Value`] of the first that is not.
pub(super) fn check(document: &Document, place: &Place) -> Result<(), TurbineFileError> {
    let tree = Value::try_from(document).map_err(|error| {
        place.error(&[], "numbers that TOML can hold", error.to_string(), "check the figures")
    })?;
    hold(&tree, (None, 0), &mut Vec::new(), place)
}

/// The same of a group `controller` alone.
///
/// # Errors
/// Those of [`check`].
pub(super) fn check_controller(
    controller: &Controller,
    place: &Place,
) -> Result<(), TurbineFileError> {
    check(&Document { controller: Some(controller.clone()), ..Document::default() }, place)
}

/// Holds every number in `value` at `path` against its range: that of the `column` of `row`.
fn hold<'t>(
    value: &'t Value,
    (row, column): (Option<&'static [Limits]>, usize),
    path: &mut Vec<Step<'t>>,
    place: &Place,
) -> Result<(), TurbineFileError> {
    let number = match value {
        Value::Table(table) => {
            for (key, value) in table {
                path.push(Key(key));
                hold(value, (row_of(path), 0), path, place)?;
                path.pop();
            }
            return Ok(());
        }
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                path.push(Row(index));
                hold(item, (row, index), path, place)?;
                path.pop();
            }
            return Ok(());
        }
        Value::Float(number) => *number,
        Value::Integer(number) => *number as f64,
        _ => return Ok(()),
    };
    let expected = match limits_in(row, column) {
        Some(limits) if limits.range.contains(number) => return Ok(()),
        Some(limits) => limits.words(),
        None => "no number: no range is known for this key".to_owned(),
    };
    let fix = "check figure and unit; keys without a unit are SI";
    Err(place.error(path, expected, format!("{number:?}"), fix))
}

impl Limits {
    /// In words, such as `0.5 to 1, a share`.
    fn words(&self) -> String {
        let Range { low, open, high } = self.range;
        let high = format!("{}{}", figure(high), self.unit);
        match open {
            true if low == 0.0 => format!("a number above zero, at most {high}"),
            true => format!("a number above {}, at most {high}", figure(low)),
            false => format!("{} to {high}", figure(low)),
        }
    }
}

/// `value` without rows of zeros.
fn figure(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e6).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

#[cfg(test)]
mod tests;
