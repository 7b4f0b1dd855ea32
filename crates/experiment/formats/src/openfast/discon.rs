//! The input file of the ROSCO controller.

use super::deck::Deck;
use super::elastodyn::Source;
use crate::turbine_file::{Controller, SetPointSmoothing, TurbineFileError};
use std::f64::consts::PI;

/// Pitch (rad) that the controller's smoother divides by: 30°, ROSCO's `ControllerBlocks.f90`.
const SMOOTHER_PITCH: f64 = 0.524;

/// Constants on the low-speed side, gains on measured minus reference speed.
///
/// The torque gain is the deck's, which a controller that tracks the tip-speed ratio does not use.
pub(super) fn controller(
    deck: &Deck,
    gear_ratio: f64,
    source: &Source,
) -> Result<Controller, TurbineFileError> {
    let to_rpm = |generator_speed: f64| generator_speed / gear_ratio * 30.0 / PI;
    let rows = |keys: [&'static str; 2]| -> Result<Vec<[f64; 2]>, TurbineFileError> {
        let (first, second) = (deck.numbers(keys[0])?, deck.numbers(keys[1])?);
        if first.len() != second.len() {
            let expected = format!("{} numbers, as many as {}", first.len(), keys[0]);
            return Err(deck.value(keys[1])?.error(&expected));
        }
        Ok(first.into_iter().zip(second).map(|(a, b)| [a, b]).collect())
    };
    let minimum_pitch = rows(["PS_WindSpeeds", "PS_BldPitchMin"])?;
    let proportional = rows(["PC_GS_angles", "PC_GS_KP"])?;
    let integral = rows(["PC_GS_angles", "PC_GS_KI"])?;
    let gains = proportional
        .iter()
        .zip(&integral)
        .map(|([pitch, kp], [_, ki])| [pitch.to_degrees(), -gear_ratio * kp, -gear_ratio * ki]);
    let least = minimum_pitch.iter().map(|row| row[1]).fold(f64::INFINITY, f64::min);
    let fine_pitch = deck.number("PC_FinePit")?;
    Ok(Controller {
        source: source(&[deck]),
        rated_power_kw: deck.number("VS_RtPwr")? / 1e3,
        rated_rotor_speed_rpm: to_rpm(deck.number("PC_RefSpd")?),
        minimum_rotor_speed_rpm: to_rpm(deck.number("VS_MinOMSpd")?),
        optimal_tip_speed_ratio: deck.number("VS_TSRopt")?,
        torque_gain: gear_ratio.powi(3) * deck.number("VS_Rgn2K")?,
        rated_torque: gear_ratio * deck.number("VS_RtTq")?,
        minimum_torque: gear_ratio * deck.number("VS_MinTq")?,
        maximum_torque: gear_ratio * deck.number("VS_MaxTq")?,
        maximum_torque_rate: gear_ratio * deck.number("VS_MaxRat")?,
        constant_power: deck.number("VS_ConstPower")? != 0.0,
        torque_proportional: -gear_ratio * gear_ratio * deck.number("VS_KP")?,
        torque_integral: -gear_ratio * gear_ratio * deck.number("VS_KI")?,
        fine_pitch_deg: if least.is_finite() { fine_pitch.max(least) } else { fine_pitch }
            .to_degrees(),
        maximum_pitch_deg: deck.number("PC_MaxPit")?.to_degrees(),
        maximum_pitch_rate_deg_s: deck.number("PC_MaxRat")?.to_degrees(),
        minimum_pitch: minimum_pitch
            .iter()
            .map(|[speed, pitch]| [*speed, pitch.to_degrees()])
            .collect(),
        pitch_gains: gains.collect(),
        set_point_smoothing: SetPointSmoothing {
            torque_shift: deck.number("SS_VSGain")? / SMOOTHER_PITCH,
            pitch_shift: deck.number("SS_PCGain")?,
            filter_corner: deck.number("F_SSCornerFreq")?,
        },
        speed_filter_corner: deck.number("F_LPFCornerFreq")?,
    })
}
