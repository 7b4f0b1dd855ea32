//! The input file of the ROSCO controller.

use super::deck::Deck;
use crate::turbine_file::{
    Controller, IndividualPitch, PitchFloor, SetPointSmoothing, TorqueControl, TowerDamping,
    TurbineFileError,
};
use std::f64::consts::PI;

/// Pitch (rad) that the controller's smoother divides by: 30°, ROSCO's `ControllerBlocks.f90`.
const SMOOTHER_PITCH: f64 = 0.524;

/// Constants on the low-speed side, gains on measured minus reference speed; `source` names the deck.
///
/// The torque gain is the deck's, which a controller that tracks the tip-speed ratio does not use.
pub(crate) fn controller(
    deck: &Deck,
    gear_ratio: f64,
    source: String,
) -> Result<Controller, TurbineFileError> {
    let (torque_control, constant_power) = torque_control(deck)?;
    let to_rpm = |generator_speed: f64| generator_speed / gear_ratio * 30.0 / PI;
    let rows = |keys: [&'static str; 2]| -> Result<Vec<[f64; 2]>, TurbineFileError> {
        let (first, second) = (deck.numbers(keys[0])?, deck.numbers(keys[1])?);
        if first.len() != second.len() {
            let expected = format!("{} numbers, as many as {}", first.len(), keys[0]);
            return Err(deck.value(keys[1])?.error(&expected));
        }
        Ok(first.into_iter().zip(second).map(|(a, b)| [a, b]).collect())
    };
    let minimum_pitch = match mode(deck, "PS_Mode", 1.0)? {
        0.0 => Vec::new(),
        _ => rows(["PS_WindSpeeds", "PS_BldPitchMin"])?,
    };
    let smoothing = mode(deck, "SS_Mode", 1.0)?;
    let proportional = rows(["PC_GS_angles", "PC_GS_KP"])?;
    let integral = rows(["PC_GS_angles", "PC_GS_KI"])?;
    let gains = proportional
        .iter()
        .zip(&integral)
        .map(|([pitch, kp], [_, ki])| [pitch.to_degrees(), -gear_ratio * kp, -gear_ratio * ki]);
    let least = minimum_pitch.iter().map(|row| row[1]).fold(f64::INFINITY, f64::min);
    let fine_pitch = deck.number("PC_FinePit")?;
    Ok(Controller {
        source,
        rated_power_kw: deck.number("VS_RtPwr")? / 1e3,
        rated_rotor_speed_rpm: to_rpm(deck.number("PC_RefSpd")?),
        minimum_rotor_speed_rpm: to_rpm(deck.number("VS_MinOMSpd")?),
        optimal_tip_speed_ratio: deck.number("VS_TSRopt")?,
        torque_gain: gear_ratio.powi(3) * deck.number("VS_Rgn2K")?,
        rated_torque: gear_ratio * deck.number("VS_RtTq")?,
        minimum_torque: gear_ratio * deck.number("VS_MinTq")?,
        maximum_torque: gear_ratio * deck.number("VS_MaxTq")?,
        maximum_torque_rate: gear_ratio * deck.number("VS_MaxRat")?,
        constant_power,
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
            torque_shift: smoothing * deck.number("SS_VSGain")? / SMOOTHER_PITCH,
            pitch_shift: smoothing * deck.number("SS_PCGain")?,
            filter_corner: deck.number("F_SSCornerFreq")?,
        },
        speed_filter_corner: deck.number("F_LPFCornerFreq")?,
        speed_filter_damping: match mode(deck, "F_LPFType", 1.0)? {
            2.0 => Some(deck.number("F_LPFDamping")?),
            _ => None,
        },
        speed_notches: speed_notches(deck)?,
        torque_control: Some(torque_control),
        wind_speed_filter_corner: wind_speed_filter_corner(deck)?,
        tower_damping: tower_damping(deck)?,
        individual_pitch: individual_pitch(deck)?,
    })
}

/// The number before a mode's `key`, `default` where the deck has none.
fn mode(deck: &Deck, key: &'static str, default: f64) -> Result<f64, TurbineFileError> {
    if !deck.has(key) {
        return Ok(default);
    }
    let number = deck.number(key)?;
    let is_mode = number.fract() == 0.0 && (0.0..=10.0).contains(&number);
    if is_mode { Ok(number) } else { Err(deck.value(key)?.error("a whole number from 0 to 10")) }
}

/// How torque is controlled, and whether power is constant above rated.
///
/// Up to version 2.8 one number says both; then power has its own.
fn torque_control(deck: &Deck) -> Result<(TorqueControl, bool), TurbineFileError> {
    use TorqueControl::{KOmegaSquared, TipSpeedRatio};
    let number = deck.number("VS_ControlMode")?;
    if !deck.has("VS_ConstPower") {
        return match number {
            0.0 => Ok((KOmegaSquared, false)),
            1.0 => Ok((KOmegaSquared, true)),
            2.0 => Ok((TipSpeedRatio, false)),
            3.0 => Ok((TipSpeedRatio, true)),
            _ => Err(deck.value("VS_ControlMode")?.error("0, 1, 2 or 3")),
        };
    }
    let constant_power = mode(deck, "VS_ConstPower", 0.0)? != 0.0;
    match number {
        // The third finds its speed from the power by the same constant, so it stands still where the first
        // does.
        1.0 | 3.0 => Ok((KOmegaSquared, constant_power)),
        2.0 => Ok((TipSpeedRatio, constant_power)),
        _ => Err(deck.value("VS_ControlMode")?.error("1, 2 or 3")),
    }
}

/// Notch filters on generator speed: frequency (rad/s), damping ratios of numerator and denominator (–).
fn speed_notches(deck: &Deck) -> Result<Vec<[f64; 3]>, TurbineFileError> {
    // One filter for speed and tower motion, up to version 2.7.
    if matches!(mode(deck, "F_NotchType", 0.0)?, 1.0 | 3.0) {
        let dampings = deck.numbers("F_NotchBetaNumDen")?;
        let [numerator, denominator] = dampings[..] else {
            return Err(deck.value("F_NotchBetaNumDen")?.error("two numbers"));
        };
        return Ok(vec![[deck.number("F_NotchCornerFreq")?, numerator, denominator]]);
    }
    let n_notches = mode(deck, "F_GenSpdNotch_N", 0.0)? as usize;
    if n_notches == 0 {
        return Ok(Vec::new());
    }
    let keys = ["F_NotchFreqs", "F_NotchBetaNum", "F_NotchBetaDen"];
    let [frequencies, numerators, denominators] = keys.map(|key| deck.numbers(key));
    let (frequencies, numerators, denominators) = (frequencies?, numerators?, denominators?);
    let indices = deck.numbers("F_GenSpdNotch_Ind")?;
    let filter = |index: &f64| {
        let place = (*index as usize).checked_sub(1)?;
        Some([*frequencies.get(place)?, *numerators.get(place)?, *denominators.get(place)?])
    };
    indices
        .iter()
        .take(n_notches)
        .map(|index| {
            filter(index).ok_or_else(|| match deck.value("F_GenSpdNotch_Ind") {
                Ok(value) => value.error("numbers of filters, from 1, that F_NotchFreqs lists"),
                Err(error) => error,
            })
        })
        .collect()
}

/// Corner of the filter between the estimated wind and torque (rad/s), where the deck has one.
fn wind_speed_filter_corner(deck: &Deck) -> Result<Option<f64>, TurbineFileError> {
    // From version 2.10 on the speed that commands the torque has a filter of its own.
    let keys = ["F_VSRefSpdCornerFreq", "F_WECornerFreq"];
    keys.into_iter().find(|key| deck.has(key)).map(|key| deck.number(key)).transpose()
}

fn tower_damping(deck: &Deck) -> Result<Option<TowerDamping>, TurbineFileError> {
    if mode(deck, "TD_Mode", 0.0)? == 0.0 {
        return Ok(None);
    }
    Ok(Some(TowerDamping {
        gain: deck.number("FA_KI")?,
        high_pass_corner: deck.number("FA_HPFCornerFreq")?,
        limit_deg: deck.number("FA_IntSat")?.to_degrees(),
    }))
}

fn individual_pitch(deck: &Deck) -> Result<Option<IndividualPitch>, TurbineFileError> {
    match mode(deck, "IPC_ControlMode", 0.0)? {
        0.0 => return Ok(None),
        1.0 => {}
        _ => {
            let expected = "0 or 1, individual pitch once per revolution,";
            return Err(deck.value("IPC_ControlMode")?.error(expected));
        }
    }
    let ramp = deck.numbers("IPC_Vramp")?;
    let [start, full] = ramp[..] else {
        return Err(deck.value("IPC_Vramp")?.error("two wind speeds"));
    };
    let limit = if deck.has("IPC_IntSat") { "IPC_IntSat" } else { "IPC_SatLim" };
    Ok(Some(IndividualPitch {
        proportional: deck.number("IPC_KP")?,
        integral: deck.number("IPC_KI")?,
        azimuth_offset_deg: Some(deck.number("IPC_aziOffset")?.to_degrees()),
        limit_deg: deck.number(limit)?.to_degrees(),
        ramp: [start, full],
        floor: match mode(deck, "IPC_SatMode", 2.0)? {
            0.0 => PitchFloor::None,
            2.0 => PitchFloor::FinePitch,
            _ => PitchFloor::MinimumPitch,
        },
    }))
}
