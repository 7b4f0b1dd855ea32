//! The instants that a question about modes is put to, and the frequencies of their run.

use super::{ModesQuestion, Trouble};
use crate::PostprocessingError;
use crate::error::case_of;
use crate::phase::query::folder_of;
use analysis::modes::Snapshots;
use basis::records::Grid;
use control::excitation_rate;
use formats::netcdf::StoredInstants;
use formats::records::{self, RunFolder};
use std::f64::consts::TAU;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Ends of the names of planes that hold no instants.
const OTHERS: [&str; 3] = ["-mean.nc", "-last.nc", "-phases.nc"];

/// Instants in a file.
pub(super) struct Source {
    pub(super) stored: StoredInstants,
}

/// The frequencies of a run (Hz), as far as they are known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Frequencies {
    /// Excitation.
    pub(super) excitation: Option<f64>,
    /// Rotor.
    pub(super) rotor: Option<f64>,
}

impl Snapshots for Source {
    type Error = Trouble;

    fn grid(&self) -> &Grid {
        &self.stored.grid
    }

    fn times(&self) -> &[f64] {
        &self.stored.times
    }

    fn read(&mut self, steps: Range<usize>) -> Result<[Vec<f32>; 3], Trouble> {
        self.stored.read(steps).map_err(Trouble::File)
    }
}

impl Source {
    /// What `question` is put to.
    ///
    /// # Errors
    /// [`PostprocessingError`] where it cannot be read, or the run kept no plane at instants.
    pub(super) fn open(
        question: &ModesQuestion,
    ) -> Result<(Self, Frequencies), PostprocessingError> {
        let asked = Frequencies { excitation: question.excitation, rotor: question.rotor };
        if question.path.is_file() {
            let stored = StoredInstants::open(&question.path)?;
            return Ok((Self { stored }, asked));
        }
        let folder = folder_of(&question.path);
        let stored = StoredInstants::open(&plane_of(&folder, question.plane.as_deref())?)?;
        let of_run = frequencies(&folder)?;
        let frequencies = Frequencies {
            excitation: asked.excitation.or(of_run.excitation),
            rotor: asked.rotor.or(of_run.rotor),
        };
        Ok((Self { stored }, frequencies))
    }

    /// Case, run, plane and wind in words.
    pub(super) fn conditions(&self, frequencies: &Frequencies) -> String {
        let about = &self.stored.about;
        let mut parts: Vec<String> =
            [&about.case, &about.run, &about.plane].into_iter().flatten().cloned().collect();
        if parts.is_empty() {
            let name = self.stored.path().file_name().unwrap_or_default();
            parts.push(name.to_string_lossy().into_owned());
        }
        if let Some(speed) = about.wind_speed {
            parts.push(format!("{speed} m/s"));
        }
        if let Some(intensity) = about.turbulence_intensity {
            parts.push(format!("TI {} %", 100.0 * intensity));
        }
        if let Some(frequency) = frequencies.excitation {
            let strouhal = about.rotor_diameter.zip(about.wind_speed);
            let strouhal = strouhal
                .map(|(diameter, speed)| format!(" (St {:.2})", frequency * diameter / speed));
            parts.push(format!("f_e {frequency:.4} Hz{}", strouhal.unwrap_or_default()));
        }
        if let Some(frequency) = frequencies.rotor {
            parts.push(format!("f_r {frequency:.4} Hz"));
        }
        parts.join(", ")
    }
}

/// The file of the plane called `name`, or of the first, at instants in the run in `folder`.
fn plane_of(folder: &RunFolder, name: Option<&str>) -> Result<PathBuf, PostprocessingError> {
    if let Some(name) = name {
        let path = folder.instants_path(name);
        if path.is_file() {
            return Ok(path);
        }
    }
    let names = planes_in(&folder.planes_path());
    match (name, names.first()) {
        (None, Some(first)) => Ok(folder.instants_path(first)),
        (asked, _) => Err(PostprocessingError::NoInstants {
            folder: folder.path().to_owned(),
            plane: asked.map(str::to_owned),
            planes: names,
        }),
    }
}

/// Names of the planes at instants in `folder`, by name.
fn planes_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let name = |entry: fs::DirEntry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        let is_other = OTHERS.iter().any(|end| name.ends_with(end));
        name.strip_suffix(".nc").filter(|_| !is_other).map(str::to_owned)
    };
    let mut names: Vec<String> = entries.filter_map(name).collect();
    names.sort();
    names
}

/// The frequencies of the run in `folder`: of the first turbine downwind that pitches a helix, and of the
/// first rotor.
fn frequencies(folder: &RunFolder) -> Result<Frequencies, PostprocessingError> {
    let manifest = records::read_manifest(folder)?;
    let case = case_of(folder, &manifest)?;
    let summary = folder.is_complete().then(|| records::read_summary(folder)).transpose()?;
    let control = &case.runs[manifest.run_index].control;
    let strouhal = control.iter().find_map(|control| control.helix()).map(|(_, strouhal)| strouhal);
    let diameter = summary.as_ref().map(|summary| summary.conditions.rotor_diameter);
    let excitation = strouhal
        .zip(diameter)
        .map(|(strouhal, diameter)| excitation_rate(strouhal, case.wind.speed, diameter) / TAU);
    let first = summary.as_ref().and_then(|summary| summary.turbines.first());
    Ok(Frequencies { excitation, rotor: first.map(|turbine| turbine.rotor_speed.mean / TAU) })
}
