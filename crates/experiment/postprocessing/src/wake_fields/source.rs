//! Where fields come from: averages by phase that were kept, planes and volumes of a run, files of others.

use super::settings::{self, AZIMUTHS, FIELD, FROM, TURBINE};
use super::{Angles, refused};
use crate::PostprocessingError;
use crate::phase::query::folder_of;
use crate::request::Request;
use analysis::phases::PhaseInstant;
use basis::records::FieldSetting;
use formats::fields::FieldFile;
use formats::records::{RunFolder, StoredPhaseAverages, is_phase_averages};
use std::path::{Path, PathBuf};

/// Planes that are looked for first, in this order.
const FIRST: [&str; 2] = ["streamwise", "hub-height"];

/// Fields of a wake.
pub(crate) enum Fields {
    /// Averages by phase, made before, and the file that they lie in.
    Averages(Box<StoredPhaseAverages>, PathBuf),
    /// Instants.
    Instants(Box<Instants>),
}

/// Fields at instants, with their phases.
pub(crate) struct Instants {
    /// The file.
    pub(crate) file: FieldFile,
    /// What they were taken of.
    pub(crate) setting: FieldSetting,
    /// Azimuths; none where they are not told.
    pub(crate) angles: Option<Angles>,
    /// The instants that count, by their place.
    pub(crate) places: std::ops::Range<usize>,
}

impl Fields {
    /// The fields that `request` is about; averages that were kept where `averages`.
    ///
    /// # Errors
    /// [`PostprocessingError`] for files that cannot be read, or do not tell what is needed.
    pub(crate) fn open(request: &Request, averages: bool) -> Result<Self, PostprocessingError> {
        let path = request.run();
        let is_run = path.join("manifest.json").is_file();
        let file = if is_run { in_run(request, path, averages)? } else { path.to_owned() };
        if is_phase_averages(&file) {
            if !averages {
                let fix = "name the file of the instants, or a run that kept them (output.plane_interval)";
                return Err(refused(&file, "holds averages, where instants are needed", fix));
            }
            let stored = Box::new(StoredPhaseAverages::open(&file)?);
            return Ok(Self::Averages(stored, file));
        }
        let opened = FieldFile::open(&file, settings::lengths(request))?;
        let opened = opened.with_zeros(settings::zeros(request));
        let found = match is_run && opened.found().diameter.is_none() {
            // Volumes tell no setting; the planes beside them do.
            true => found_beside(path).unwrap_or_else(|| opened.found().clone()),
            false => opened.found().clone(),
        };
        let setting = settings::of_fields(request, &file, &found)?;
        let angles = match request.text(AZIMUTHS.name) {
            Some(table) => Some(Angles::of_table(Path::new(table))?),
            None if is_run => Some(Angles::of_run(&folder_of(path), request.text(TURBINE.name))?),
            None => None,
        };
        let needs_times = angles.is_some() || request.number(FROM.name).is_some();
        if needs_times && !opened.has_times() && opened.times().len() > 1 {
            return Err(refused(&file, NO_TIMES, TELL_TIMES));
        }
        let from = request.number(FROM.name).unwrap_or(f64::NEG_INFINITY);
        if from.is_nan() {
            return Err(PostprocessingError::Setting {
                setting: FROM.name,
                given: request.text(FROM.name).unwrap_or_default().to_owned(),
                expected: "a time in seconds is expected",
                fix: "write such as 20",
            });
        }
        let first = opened.times().partition_point(|time| *time < from);
        let places = first..opened.times().len();
        if places.is_empty() {
            let fix = "count from an earlier time with --from";
            return Err(refused(&file, format!("has no instant from {from} s on"), fix));
        }
        Ok(Self::Instants(Box::new(Instants { file: opened, setting, angles, places })))
    }

    /// The instants alone.
    ///
    /// # Errors
    /// Those of [`Fields::open`].
    pub(crate) fn instants(request: &Request) -> Result<Instants, PostprocessingError> {
        match Self::open(request, false)? {
            Self::Instants(instants) => Ok(*instants),
            Self::Averages(..) => Err(refused(
                request.run(),
                "holds averages, where instants are needed",
                "name the file of the instants",
            )),
        }
    }
}

impl Instants {
    /// Instants that count (s).
    pub(crate) fn times(&self) -> &[f64] {
        &self.file.times()[self.places.clone()]
    }

    /// First and last instant that count (s).
    pub(crate) fn span(&self) -> [f64; 2] {
        let times = self.times();
        [times[0], times[times.len() - 1]]
    }

    /// The instants that count with their azimuths; zeros where they are not told.
    ///
    /// # Errors
    /// [`PostprocessingError::Fields`] for an instant beyond the azimuths.
    pub(crate) fn phases(&self) -> Result<Vec<PhaseInstant>, PostprocessingError> {
        let Some(angles) = &self.angles else {
            let still = |time: &f64| PhaseInstant { time: *time, rotor: 0.0, helix: None };
            return Ok(self.times().iter().map(still).collect());
        };
        let phase = |time: &f64| match angles.at(*time) {
            Some((rotor, helix)) => Ok(PhaseInstant { time: *time, rotor, helix }),
            None => {
                let problem = format!("has an instant at {time} s, beyond the azimuths");
                let fix = "give azimuths over the time of all fields";
                Err(refused(self.file.path(), problem, fix))
            }
        };
        self.times().iter().map(phase).collect()
    }
}

/// The file or folder of the run at `path` that `request` means.
fn in_run(request: &Request, path: &Path, averages: bool) -> Result<PathBuf, PostprocessingError> {
    let folder = folder_of(path);
    if let Some(name) = request.text(FIELD.name) {
        let kept = folder.phase_averages_path(name);
        if averages && kept.is_file() {
            return Ok(kept);
        }
        if name == "volumes" {
            return Ok(folder.volumes_path());
        }
        let instants = folder.instants_path(name);
        if instants.is_file() {
            return Ok(instants);
        }
        let kept = kept_names(&folder, averages)?;
        let fix = match kept.is_empty() {
            true => NO_INSTANTS.to_owned(),
            false => format!("name one that it keeps with --field: {}", kept.join(", ")),
        };
        return Err(refused(path, format!("keeps nothing called `{name}`"), fix));
    }
    if averages && let Some(kept) = kept_averages(&folder)? {
        return Ok(kept);
    }
    let named = FIRST.into_iter().map(|name| folder.instants_path(name)).find(|one| one.is_file());
    match named {
        Some(file) => Ok(file),
        None => Err(refused(path, "keeps neither planes at instants nor averages", NO_INSTANTS)),
    }
}

/// What `--field` may name in `folder`, of `averages` by phase, too, where they will do.
fn kept_names(folder: &RunFolder, averages: bool) -> Result<Vec<String>, PostprocessingError> {
    let mut names = Vec::new();
    if averages {
        let paths = folder.phase_averages_paths()?;
        let all = paths.iter().filter_map(|path| RunFolder::phase_averages_name(path));
        names.extend(all.map(str::to_owned));
    }
    names.extend(folder.instants_names()?);
    let volumes = std::fs::read_dir(folder.volumes_path());
    if volumes.is_ok_and(|mut files| files.next().is_some()) {
        names.push("volumes".to_owned());
    }
    Ok(names)
}

/// The averages by phase that the run in `folder` kept: of those the first that reaches along the wind, as
/// most analyses need it, or else the first.
fn kept_averages(folder: &RunFolder) -> Result<Option<PathBuf>, PostprocessingError> {
    let mut first = None;
    for path in folder.phase_averages_paths()? {
        if StoredPhaseAverages::open(&path)?.head.grid.n_points[0] > 1 {
            return Ok(Some(path));
        }
        first.get_or_insert(path);
    }
    Ok(first)
}

/// That a file tells no times, and what to do.
pub(crate) const NO_TIMES: &str = "does not tell the times of its instants, which are needed";
pub(crate) const TELL_TIMES: &str = "write them: a variable `time` (NetCDF), SOLUTIONTIME of each zone (Tecplot), field data `TimeValue` in text (.vti)";
const NO_INSTANTS: &str =
    "make the run again with `output.plane_interval`, or name a plane that it keeps with --field";

/// What a plane in the run at `path` tells of what it was taken of.
fn found_beside(path: &Path) -> Option<formats::fields::FoundSetting> {
    let files = folder_of(path).plane_files().ok()?;
    let open = |file: &PathBuf| FieldFile::open(file, formats::fields::Lengths::Metres).ok();
    files.iter().filter(|file| file.extension().is_some_and(|e| e == "nc")).find_map(|file| {
        let found = open(file)?.found().clone();
        found.diameter.is_some().then_some(found)
    })
}
