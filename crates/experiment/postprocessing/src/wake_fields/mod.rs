//! Fields of wakes, of runs and of measurements alike: where they come from, their phases, their averages.

mod angles;
mod averages;
mod compared;
mod making;
mod maps;
mod plan;
pub(crate) mod settings;
mod shown;
mod source;
mod strips;

pub(crate) use angles::Angles;
pub(crate) use averages::Averaged;
pub(crate) use making::{Wanted, bins as averages_bins};
pub(crate) use maps::{axes, by_phase, panel, velocity_by_phase};
pub(crate) use source::Fields;
#[cfg(feature = "modes")]
pub(crate) use source::{Instants, NO_TIMES, TELL_TIMES};

use crate::PostprocessingError;
use basis::records::FieldSetting;
use std::path::Path;

/// That the fields at `path` do not do, because of `problem`; `fix` says what to do.
pub(crate) fn refused(
    path: &Path,
    problem: impl Into<String>,
    fix: impl Into<String>,
) -> PostprocessingError {
    let (problem, fix) = (problem.into(), fix.into());
    PostprocessingError::Fields { path: path.to_owned(), problem, fix }
}

/// The conditions of `setting` in words, as they stand below figures and tables.
pub(crate) fn conditions(setting: &FieldSetting) -> String {
    let turbulence = match setting.turbulence_intensity {
        Some(intensity) => format!(", turbulence intensity {:.1} %", 100.0 * intensity),
        None => ", turbulence intensity not told".to_owned(),
    };
    format!(
        "{}: {:.2} m/s{turbulence}, rotor of {:.2} m",
        setting.name, setting.wind_speed, setting.diameter
    )
}
