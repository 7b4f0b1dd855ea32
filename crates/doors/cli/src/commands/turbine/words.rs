//! Figures of a turbine in what suits its size.

use wakemix::turbine::Definition;

/// Least power that is told in megawatts (W), and least mass in tonnes (kg).
const LARGE: f64 = 1e3;

/// `power` (W) in what suits it.
pub(super) fn power(power: f64) -> String {
    if power < LARGE { format!("{power:.2} W") } else { format!("{:.3} MW", 1e-6 * power) }
}

/// `mass` (kg) of a blade in what suits it.
pub(super) fn blade_mass(mass: f64) -> String {
    if mass < LARGE { format!("{mass:.4} kg each") } else { format!("{:.2} t each", 1e-3 * mass) }
}

/// What pitches the blades of `definition`, and how far motors go for it.
pub(super) fn swashplate(definition: &Definition) -> String {
    match &definition.swashplate {
        None => "none: each blade has an actuator of its own".to_owned(),
        Some(plate) => format!(
            "{:.1}° of its motors pitch all blades by 1°; cyclic {:.3} of that with the rotor, {:.3} against it; bias {:.2}° tilt, {:.2}° yaw; slack {:.1}°",
            plate.motor_ratio(),
            plate.gains[0],
            plate.gains[1],
            plate.bias[0].to_degrees(),
            plate.bias[1].to_degrees(),
            plate.slack.to_degrees()
        ),
    }
}
