//! What can be set of all analyses of fields.

use super::refused;
use crate::PostprocessingError;
use crate::request::{AnalysisSetting, Request, Takes};
use basis::records::FieldSetting;
use formats::fields::{FoundSetting, Lengths, Zeros};
use std::path::Path;

/// The plane or volume of a run.
pub(crate) const FIELD: AnalysisSetting = setting(
    "field",
    "NAME",
    Takes::Text,
    "Plane or volume of a run, such as streamwise or volumes; what it averaged by phase, or the plane along the wind, when left out",
);
/// The turbine whose phases count.
pub(crate) const TURBINE: AnalysisSetting = setting(
    "turbine",
    "NAME",
    Takes::Text,
    "Turbine of a run whose rotor and pitch make the phases; the first when left out",
);
/// Rotor diameter.
pub(crate) const DIAMETER: AnalysisSetting =
    setting("diameter", "M", Takes::Number, "Rotor diameter (m); that in the file when left out");
/// Free-stream speed.
pub(crate) const WIND_SPEED: AnalysisSetting = setting(
    "wind-speed",
    "M/S",
    Takes::Number,
    "Free-stream speed (m/s); that in the file when left out",
);
/// Middle of the rotor.
pub(crate) const HUB: AnalysisSetting = setting(
    "hub",
    "X,Y,Z",
    Takes::Text,
    "Middle of the rotor (m), such as 0,0,0.8; that in the file when left out",
);
/// Unit of bare lengths.
pub(crate) const LENGTHS: AnalysisSetting = AnalysisSetting {
    name: "lengths",
    value: "UNIT",
    takes: Takes::Choice(&[("m", "Metres"), ("mm", "Millimetres")]),
    about: "Unit of lengths that have none in the file; m when left out",
};
/// What vectors of zeros are.
pub(crate) const ZEROS: AnalysisSetting = AnalysisSetting {
    name: "zeros",
    value: "MEANING",
    takes: Takes::Choice(&[
        ("air", "Air that stands still"),
        ("holes", "Holes, as programs for particle images write them"),
    ]),
    about: "What a velocity of exactly zero means in fields that are not a run's; air when left out, and counted",
};
/// Azimuths beside measured fields.
pub(crate) const AZIMUTHS: AnalysisSetting = setting(
    "azimuths",
    "CSV",
    Takes::Text,
    "Table with time, Azimuth_deg and, for a helix, Helix_deg, of fields that are not a run's",
);
/// Bins a revolution.
pub(crate) const BINS: AnalysisSetting = setting(
    "bins",
    "N",
    Takes::Number,
    "Bins of rotor azimuth in a revolution; 12 of 30° when left out",
);
/// Helix cycles of the bins.
pub(crate) const CYCLES: AnalysisSetting = setting(
    "cycles",
    "N",
    Takes::Number,
    "Helix cycles that the bins go over, 0 for bins of the rotor alone; 3 where there is a helix when left out",
);
/// Width of a window.
pub(crate) const WIDTH: AnalysisSetting = setting(
    "width",
    "DEG",
    Takes::Number,
    "Width of a window of helix azimuth (deg); 40 when left out",
);
/// Memory of a strip.
pub(crate) const MEMORY: AnalysisSetting = setting(
    "memory",
    "MB",
    Takes::Number,
    "Memory of a strip of points (MB), one row of points at least; 256 when left out",
);
/// Frequency of the rotor.
pub(crate) const ROTOR_HZ: AnalysisSetting = setting(
    "rotor-hz",
    "HZ",
    Takes::Number,
    "Rotor frequency (Hz), where neither a run's series nor --azimuths tell it",
);
/// Frequency of the helix.
#[cfg(feature = "modes")]
pub(crate) const EXCITATION_HZ: AnalysisSetting = setting(
    "excitation-hz",
    "HZ",
    Takes::Number,
    "Frequency of the helix (Hz), where neither a run's series nor --azimuths tell it",
);
/// Start of what counts.
pub(crate) const FROM: AnalysisSetting =
    setting("from", "S", Takes::Number, "Time from which instants count (s); all when left out");

pub(crate) const fn setting(
    name: &'static str,
    value: &'static str,
    takes: Takes,
    about: &'static str,
) -> AnalysisSetting {
    AnalysisSetting { name, value, takes, about }
}

/// Unit of bare lengths that `request` asks for.
pub(crate) fn lengths(request: &Request) -> Lengths {
    match request.text(LENGTHS.name) {
        Some("mm") => Lengths::Millimetres,
        _ => Lengths::Metres,
    }
}

/// What vectors of zeros are, as `request` says.
pub(crate) fn zeros(request: &Request) -> Zeros {
    match request.text(ZEROS.name) {
        Some("holes") => Zeros::Holes,
        _ => Zeros::Air,
    }
}

/// A whole number that `request` asks for under `setting`; `default` where it does not.
///
/// # Errors
/// [`PostprocessingError::Setting`] for what is no whole number from `least` on.
pub(crate) fn whole(
    request: &Request,
    setting: &AnalysisSetting,
    least: usize,
    default: usize,
) -> Result<usize, PostprocessingError> {
    let Some(text) = request.text(setting.name) else { return Ok(default) };
    let value = text.parse().ok().filter(|value| *value >= least && *value <= 100_000);
    let (expected, fix) = match least {
        0 => ("a whole number of 0 or more is expected", "write such as 0 or 3"),
        1 => ("a whole number of 1 or more is expected", "write such as 12"),
        _ => ("a whole number of 4 or more is expected", "write such as 128"),
    };
    let setting = setting.name;
    value.ok_or_else(|| PostprocessingError::Setting {
        setting,
        given: text.to_owned(),
        expected,
        fix,
    })
}

/// A number above zero that `request` asks for under `setting`; `default` where it does not.
///
/// # Errors
/// [`PostprocessingError::Setting`] for what is none.
pub(crate) fn positive(
    request: &Request,
    setting: &AnalysisSetting,
    default: f64,
) -> Result<f64, PostprocessingError> {
    let Some(value) = request.number(setting.name) else { return Ok(default) };
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(PostprocessingError::Setting {
        setting: setting.name,
        given: request.text(setting.name).unwrap_or_default().to_owned(),
        expected: "a number above 0 is expected",
        fix: "write such as 40 or 0.58",
    })
}

/// What fields at `path` were taken of: what `request` says, else what was `found` in them.
///
/// # Errors
/// [`PostprocessingError::Fields`] where speed, diameter or hub are told by neither.
pub(crate) fn of_fields(
    request: &Request,
    path: &Path,
    found: &FoundSetting,
) -> Result<FieldSetting, PostprocessingError> {
    let number = |setting: &AnalysisSetting, found: Option<f64>, what: &str| {
        let value = request.number(setting.name).or(found);
        let value = value.filter(|value| *value > 0.0 && value.is_finite());
        value.ok_or_else(|| {
            let fix = format!("give it with --{} {}", setting.name, setting.value);
            refused(path, format!("does not tell {what}"), fix)
        })
    };
    let hub = match request.text(HUB.name) {
        Some(text) => Some(three(text)?),
        None => found.hub,
    };
    let name = found.name.clone();
    Ok(FieldSetting {
        name: name
            .unwrap_or_else(|| path.file_stem().unwrap_or_default().to_string_lossy().into_owned()),
        wind_speed: number(&WIND_SPEED, found.wind_speed, "the free-stream speed")?,
        turbulence_intensity: found.turbulence_intensity,
        diameter: number(&DIAMETER, found.diameter, "the rotor diameter")?,
        hub: hub.ok_or_else(|| {
            refused(path, "does not tell where the rotor is", "give it with --hub X,Y,Z")
        })?,
    })
}

/// Three numbers between commas.
pub(crate) fn three(text: &str) -> Result<[f64; 3], PostprocessingError> {
    let values: Option<Vec<f64>> = text
        .split(',')
        .map(|part| part.trim().parse().ok().filter(|v: &f64| v.is_finite()))
        .collect();
    values.and_then(|values| values.try_into().ok()).ok_or_else(|| PostprocessingError::Setting {
        setting: HUB.name,
        given: text.to_owned(),
        expected: "three numbers between commas are expected",
        fix: "write such as 0,0,0.8",
    })
}
