//! The table `pitch_actuator.swashplate`: three rods in place of an actuator on each blade.

use super::error::{Place, Step::Key, TurbineFileError};
use serde::{Deserialize, Serialize};
use turbine::actuators::{self, Drive, lead_of};

/// Fewest blades whose average, tilt and yaw pitch a plate can give each on its own.
const LEAST_BLADES: usize = 3;

/// A swashplate; limits and lag of its motors are those of `pitch_actuator`, in collective pitch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Swashplate {
    /// Where the figures come from.
    pub source: String,
    /// Travel of a rod a turn of its motor, by a nut on a threaded shaft (m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub travel_per_turn: Option<f64>,
    /// Arm of a motor that turns to and fro (m), in place of the threaded shaft.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crank_length: Option<f64>,
    /// Shaft to rods (m).
    pub rod_radius: f64,
    /// Shaft to pitch links (m).
    pub link_radius: f64,
    /// Pitch axis of a blade to its link (m).
    pub horn_length: f64,
    /// Azimuth of the first rod (deg).
    pub rod_azimuth_deg: f64,
    /// Tilt and yaw of the blades' pitch with the plate straight (deg).
    pub bias_deg: [f64; 2],
    /// Play of the plate about the shaft, either way (deg).
    pub slack_deg: f64,
    /// Tilt of the plate over that of the rods, where its direction goes round with the rotor (–).
    pub gain_with_rotor: f64,
    /// The same where it goes against the rotor (–).
    pub gain_against_rotor: f64,
}

/// The same in the definition of a turbine of `n_blades` blades that pitch within `limits` (deg).
///
/// # Errors
/// [`TurbineFileError::Value`] for a plate without what moves its rods or with both, for too few blades, and
/// for rods that cannot pitch blades as far as their limits.
pub(super) fn swashplate_of(
    plate: &Swashplate,
    n_blades: usize,
    limits: [f64; 2],
    place: &Place,
) -> Result<actuators::Swashplate, TurbineFileError> {
    let path = [Key("pitch_actuator"), Key("swashplate")];
    if plate.source.trim().is_empty() {
        let path = [path[0], path[1], Key("source")];
        let fix = "name publication or input set, and say what is estimated";
        return Err(place.error(&path, "a source", "an empty text", fix));
    }
    if n_blades < LEAST_BLADES {
        let expected = format!("{LEAST_BLADES} blades at least");
        let fix =
            "leave [pitch_actuator.swashplate] out: each blade then has an actuator of its own";
        return Err(place.error(&path, expected, format!("n_blades = {n_blades}"), fix));
    }
    let drive = match (plate.travel_per_turn, plate.crank_length) {
        (Some(travel), None) => Drive::Screw { lead: lead_of(travel) },
        (None, Some(length)) => Drive::Crank { length },
        (travel, _) => {
            let found = if travel.is_some() { "both" } else { "neither" };
            let fix = "give travel_per_turn for a threaded shaft, or crank_length for an arm";
            let expected = "travel_per_turn or crank_length";
            return Err(place.error(&path, expected, found, fix));
        }
    };
    // A horn, or a crank, that stands across goes no farther.
    let [low, high] = limits;
    let farthest = low.abs().max(high.abs());
    let reach = plate.crank_length.map_or(1.0, |crank| (crank / plate.horn_length).min(1.0));
    let reach = reach.asin().to_degrees();
    if farthest > reach {
        let key = if high > low.abs() { "maximum_pitch_deg" } else { "minimum_pitch_deg" };
        let expected = format!("at most {reach:.1}° either way, as far as horn and crank reach");
        let fix = "narrow the limits of pitch, or correct horn_length and crank_length";
        let path = [Key("pitch_actuator"), Key(key)];
        return Err(place.error(&path, expected, format!("{farthest}°"), fix));
    }
    Ok(actuators::Swashplate {
        drive,
        rod_radius: plate.rod_radius,
        link_radius: plate.link_radius,
        horn_length: plate.horn_length,
        rod_azimuth: plate.rod_azimuth_deg.to_radians(),
        bias: plate.bias_deg.map(f64::to_radians),
        slack: plate.slack_deg.to_radians(),
        gains: [plate.gain_with_rotor, plate.gain_against_rotor],
    })
}

#[cfg(test)]
mod tests {
    use super::super::{TurbineFileError, parse, write};
    use crate::library;

    const PLATE: &str = "[pitch_actuator.swashplate]\nsource = \"a sketch\"\ntravel_per_turn = 0.05\n\
        rod_radius = 0.8\nlink_radius = 0.9\nhorn_length = 0.7\nrod_azimuth_deg = 30.0\n\
        bias_deg = [0.0, 0.2]\nslack_deg = 2.0\ngain_with_rotor = 1.1\ngain_against_rotor = 0.9\n\n";

    /// The NREL 5 MW turbine with `plate`, its pitch between −5° and 85°.
    fn with(plate: &str) -> String {
        let text = library::text("nrel-5mw").unwrap();
        let maximum = text.lines().find(|line| line.starts_with("maximum_pitch_deg")).unwrap();
        let text = text.replacen(maximum, "maximum_pitch_deg = 85.0", 1);
        text.replacen("[operation]", &format!("{plate}[operation]"), 1)
    }

    fn error_of(from: &str, to: &str) -> TurbineFileError {
        assert!(PLATE.contains(from), "{from}");
        parse("mine.toml", &with(&PLATE.replacen(from, to, 1))).unwrap_err()
    }

    #[test]
    fn any_turbine_can_have_one() {
        let file = parse("mine.toml", &with(PLATE)).unwrap();
        let plate = file.definition.swashplate.expect("a plate");
        // A turn of the motors moves the rods by 5 cm.
        let turn = plate.motor_at((0.05_f64 / 0.7).asin());
        assert!((turn - std::f64::consts::TAU).abs() < 1e-12);
        assert_eq!((plate.gains, plate.bias[0]), ([1.1, 0.9], 0.0));
        let written = write(&toml::from_str(&with(PLATE)).unwrap());
        assert!(written.missing.is_empty(), "{:?}", written.missing);
        assert_eq!(parse("a", &written.text).unwrap(), file);
        let crank = PLATE.replace("travel_per_turn = 0.05", "crank_length = 0.75");
        let written = write(&toml::from_str(&with(&crank)).unwrap());
        assert!(parse("b", &written.text).unwrap().definition.swashplate.is_some());
    }

    #[test]
    fn what_no_plate_can_be_is_refused_with_key_and_fix() {
        let cases = [
            ("travel_per_turn = 0.05\n", "", "found neither", "crank_length for an arm"),
            (
                "rod_radius",
                "crank_length = 0.7\nrod_radius",
                "found both",
                "crank_length for an arm",
            ),
            (
                "travel_per_turn = 0.05",
                "crank_length = 0.5",
                "maximum_pitch_deg",
                "narrow the limits",
            ),
            ("\"a sketch\"", "\" \"", "swashplate.source", "say what is estimated"),
            ("horn_length = 0.7", "horn_length = 0.0", "horn_length", "check figure and unit"),
            ("gain_with_rotor = 1.1", "gain_with_rotor = nan", "gain_with_rotor", "check figure"),
        ];
        for (from, to, expected, fix) in cases {
            let error = error_of(from, to);
            let text =
                format!("{error} {:?}", miette::Diagnostic::help(&error).map(|h| h.to_string()));
            assert!(text.contains("mine.toml") && text.contains(expected), "{text}");
            assert!(text.contains(fix), "{text}");
        }
        let two = with(PLATE).replacen("n_blades = 3", "n_blades = 2", 1);
        let error = parse("mine.toml", &two).unwrap_err().to_string();
        assert!(error.contains("3 blades at least"), "{error}");
    }
}
