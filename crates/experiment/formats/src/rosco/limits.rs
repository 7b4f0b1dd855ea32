//! What a ROSCO input file may hold: the limits of a turbine file, stated with the keys of ROSCO.

use crate::openfast::deck::Deck;
use crate::turbine_file::{Controller, TurbineFileError, check_controller};

/// Keys of a turbine file's group `controller`, each with the key of ROSCO that it comes from; of several the
/// first that the file has.
const KEYS: [(&str, &str); 33] = [
    ("rated_power_kw", "VS_RtPwr"),
    ("rated_rotor_speed_rpm", "PC_RefSpd"),
    ("minimum_rotor_speed_rpm", "VS_MinOMSpd"),
    ("optimal_tip_speed_ratio", "VS_TSRopt"),
    ("torque_gain", "VS_Rgn2K"),
    ("rated_torque", "VS_RtTq"),
    ("minimum_torque", "VS_MinTq"),
    ("maximum_torque", "VS_MaxTq"),
    ("maximum_torque_rate", "VS_MaxRat"),
    ("torque_proportional", "VS_KP"),
    ("torque_integral", "VS_KI"),
    ("fine_pitch_deg", "PC_FinePit"),
    ("maximum_pitch_deg", "PC_MaxPit"),
    ("maximum_pitch_rate_deg_s", "PC_MaxRat"),
    ("minimum_pitch", "PS_WindSpeeds"),
    ("pitch_gains", "PC_GS_angles"),
    ("set_point_smoothing.torque_shift", "SS_VSGain"),
    ("set_point_smoothing.pitch_shift", "SS_PCGain"),
    ("set_point_smoothing.filter_corner", "F_SSCornerFreq"),
    ("speed_filter_corner", "F_LPFCornerFreq"),
    ("speed_filter_damping", "F_LPFDamping"),
    ("speed_notches", "F_NotchFreqs"),
    ("speed_notches", "F_NotchCornerFreq"),
    ("wind_speed_filter_corner", "F_VSRefSpdCornerFreq"),
    ("wind_speed_filter_corner", "F_WECornerFreq"),
    ("tower_damping.gain", "FA_KI"),
    ("tower_damping.high_pass_corner", "FA_HPFCornerFreq"),
    ("tower_damping.limit_deg", "FA_IntSat"),
    ("individual_pitch.proportional", "IPC_KP"),
    ("individual_pitch.integral", "IPC_KI"),
    ("individual_pitch.azimuth_offset_deg", "IPC_aziOffset"),
    ("individual_pitch.limit_deg", "IPC_IntSat"),
    ("individual_pitch.ramp", "IPC_Vramp"),
];

/// Nothing when `controller`, read from `deck`, holds what a turbine file may hold; errors call the deck
/// `file`.
///
/// # Errors
/// [`TurbineFileError::Value`] naming file, line, key of ROSCO and what was expected.
pub(super) fn check(
    controller: &Controller,
    deck: &Deck,
    file: &str,
) -> Result<(), TurbineFileError> {
    let Err(error) = check_controller(controller, file) else { return Ok(()) };
    let TurbineFileError::Value { key, expected, .. } = &error else { return Err(error) };
    let name = key.strip_prefix("controller.").unwrap_or(key);
    // Rows are numbered, the file's own key is that of them all.
    let name = name.split('[').next().unwrap_or(name);
    let place = KEYS.iter().find(|(known, key)| *known == name && deck.has(key));
    match place {
        Some((_, key)) => Err(deck.value(key)?.error(&format!("what makes the {name} {expected}"))),
        None => Err(error),
    }
}
