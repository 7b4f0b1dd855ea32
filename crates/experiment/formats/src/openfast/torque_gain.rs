//! Torque gain of a controller that tracks the tip-speed ratio, and so names none that fits.

use crate::turbine_file::{self, Controller, Document, TurbineFileError};
use control::baseline::greedy_torque_gain;
use turbine::aero::blade_element::Theory;
use turbine::steady::SteadyRotor;

/// Share of the wind speed at which the tracked tip-speed ratio meets rated rotor speed; the pitch there
/// stands for all below rated.
const TYPICAL_SHARE: f64 = 0.75;

/// On return the controller of `document` (all groups present) holds the rotor at its optimal tip-speed ratio
/// in air of `air_density` (kg/m³), by blade-element momentum, and its source says so.
pub(super) fn derive(
    document: &mut Document,
    air_density: f64,
    origin: &str,
) -> Result<(), TurbineFileError> {
    let file = turbine_file::check(document, origin)?;
    let Some(controller) = &mut document.controller else { return Ok(()) };
    let constants = file.controller;
    let (radius, ratio) = (constants.rotor_radius, constants.optimal_tip_speed_ratio);
    let wind_speed = TYPICAL_SHARE * constants.rated_rotor_speed * radius / ratio;
    let pitch = least_pitch(controller, wind_speed).to_radians();
    let rotor = SteadyRotor::new(&file.definition, Theory::default());
    let power = rotor.coefficients(ratio, pitch).power;
    controller.torque_gain = greedy_torque_gain(air_density, radius, power, ratio);
    controller.source += &format!(
        "; torque_gain by blade-element momentum (power coefficient {power:.4}), because the deck tracks the tip-speed ratio and does not use its own"
    );
    Ok(())
}

/// Least collective pitch (deg) at `wind_speed` (m/s), linear between rows.
fn least_pitch(controller: &Controller, wind_speed: f64) -> f64 {
    let rows = &controller.minimum_pitch;
    let high = rows.partition_point(|row| row[0] < wind_speed);
    match (high.checked_sub(1).and_then(|low| rows.get(low)), rows.get(high)) {
        (Some(low), Some(high)) => {
            low[1] + (wind_speed - low[0]) / (high[0] - low[0]) * (high[1] - low[1])
        }
        (Some(row), None) | (None, Some(row)) => row[1],
        (None, None) => controller.fine_pitch_deg,
    }
}
