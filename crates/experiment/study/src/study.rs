//! A study in its folder: which of its runs are to be made, and how one is, from simulation to summary.

use crate::columns::Columns;
use crate::gains::{self, Comparison};
use crate::options::StudyOptions;
use crate::outputs::Outputs;
use crate::prepared::Prepared;
use crate::ready::Ready;
use crate::same_case::{Standing, WindDigests, another, check_longer, check_same, standing};
use crate::simulate::{Ending, Job, simulate};
use crate::summarise::{self, Left};
use crate::{Observer, StudyError};
use basis::records::{Cost, Summary};
use farm::case::Run;
use formats::leftovers;
use formats::lock::Lock;
use formats::records::{self, Manifest, PitchResponseRecord, RunFolder};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

/// Folders of a study, and which of its runs are to be made.
pub(crate) struct Study<'a> {
    pub(crate) outputs: &'a Outputs,
    pub(crate) directory: PathBuf,
    /// One per run of the case.
    pub(crate) folders: Vec<RunFolder>,
    /// Runs that are asked for, by their places in the case.
    pub(crate) wanted: Vec<usize>,
    /// Those of them that are not complete, or go on for longer.
    pub(crate) open: Vec<usize>,
    /// Those that go on for longer.
    longer: Vec<usize>,
    /// SHA-256 of the files of wind when the study began.
    pub(crate) wind: WindDigests,
    resume: bool,
}

impl<'a> Study<'a> {
    /// The study of `prepared` in `directory`, of which the runs at the places `wanted` are asked for, as
    /// `options` say; what its folder holds is left as it is.
    ///
    /// # Errors
    /// [`StudyError::OutputExists`], [`StudyError::NoManifest`],
    /// [`StudyError::OtherCase`], [`StudyError::OtherFile`], [`StudyError::NotLengthened`], and
    /// [`StudyError::File`] for a folder that cannot be written into.
    pub(crate) fn open(
        options: &StudyOptions,
        outputs: &'a Outputs,
        prepared: &Prepared,
        (directory, wanted): (PathBuf, Vec<usize>),
    ) -> Result<Self, StudyError> {
        let runs = &prepared.case.runs;
        let folders: Vec<RunFolder> =
            runs.iter().map(|run| RunFolder::new(&directory, &run.name)).collect();
        if !options.overwrite && !options.dry_run {
            let unknown = wanted.iter().map(|&index| &folders[index]).find(|f| f.is_unknown());
            if let Some(folder) = unknown {
                return Err(StudyError::NoManifest { directory: folder.path().to_owned() });
            }
        }
        let keeps = options.resume || options.overwrite || options.dry_run;
        if !keeps && wanted.iter().any(|&index| folders[index].holds_results()) {
            return Err(StudyError::OutputExists { directory });
        }
        if !options.dry_run {
            formats::atomic::check_folder(&directory)?;
        }
        // To read long files of wind takes time, which a dry run of nothing kept can do without.
        let is_new =
            options.dry_run && !options.resume && !folders.iter().any(RunFolder::is_complete);
        let wind = if is_new { WindDigests::new() } else { prepared.wind_digests()? };
        let (open, longer, resume) = (Vec::new(), Vec::new(), options.resume);
        let mut study = Self { outputs, directory, folders, wanted, open, longer, wind, resume };
        if resume {
            study.find_longer(prepared)?;
        }
        study.open = study.wanted.clone();
        study.leave_complete();
        study.check_compared(prepared)?;
        Ok(study)
    }

    /// Finds out which of the wanted runs go on for longer than they were made.
    fn find_longer(&mut self, prepared: &Prepared) -> Result<(), StudyError> {
        for &index in &self.wanted {
            let (run, folder) = (&prepared.case.runs[index], &self.folders[index]);
            if let Standing::Shorter(before) = standing(prepared, &self.wind, run, folder)? {
                check_longer(prepared, run, folder, before)?;
                self.longer.push(index);
            }
        }
        Ok(())
    }

    /// Takes from the open runs those that are complete, where they go on.
    pub(crate) fn leave_complete(&mut self) {
        if self.resume {
            let (folders, longer) = (&self.folders, &self.longer);
            self.open.retain(|index| !folders[*index].is_complete() || longer.contains(index));
        }
    }

    /// Nothing where every run with which an open one compares, and which is not made again, is of this case.
    fn check_compared(&self, prepared: &Prepared) -> Result<(), StudyError> {
        for &index in &self.open {
            // Gains are over a run of the same wind, or over none.
            if let Some(other) = gains::compared(prepared, index)
                && !self.open.contains(&other)
                && self.folders[other].is_complete()
            {
                let run = &prepared.case.runs[other];
                check_same(prepared, &self.wind, run, &self.folders[other])?;
            }
        }
        Ok(())
    }

    /// Locks the runs that are asked for, so that no other process writes them, and takes away what killed
    /// processes have left in the study's own folder; the locks end with what is given.
    ///
    /// # Errors
    /// [`StudyError::File`] says who else writes one of them; [`StudyError::OutputExists`] when one was made
    /// meanwhile.
    pub(crate) fn lock(
        &self,
        options: &StudyOptions,
        observer: &mut dyn Observer,
    ) -> Result<Vec<Lock>, StudyError> {
        let folders = || self.wanted.iter().map(|&index| &self.folders[index]);
        let mut locks = folders().map(RunFolder::lock).collect::<Result<Vec<Lock>, _>>()?;
        // The one that made the folder goes last, and takes it away where nothing came into it.
        locks.reverse();
        if !locks.iter().all(Lock::is_held) {
            observer.warned(&format!(
                "the file system of {} knows no locks: see to it that no other process writes these runs",
                self.directory.display()
            ));
        }
        let keeps = options.resume || options.overwrite;
        if !keeps && folders().any(RunFolder::holds_results) {
            return Err(StudyError::OutputExists { directory: self.directory.clone() });
        }
        leftovers::remove_abandoned(&self.directory, None)?;
        Ok(locks)
    }

    /// Keeps what was `found` of pitch responses in the study's folder, beside what those who make other runs
    /// of it have kept there.
    ///
    /// # Errors
    /// [`StudyError::File`].
    pub(crate) fn keep_pitch_responses(
        &self,
        found: &[PitchResponseRecord],
    ) -> Result<(), StudyError> {
        if self.wanted.len() == self.folders.len() {
            return Ok(records::write_pitch_responses(&self.directory, found)?);
        }
        Ok(records::add_pitch_responses(&self.directory, found)?)
    }

    /// Makes run number `index`, which is the `place`-th of as many as are to be made, from simulation to
    /// summary; a break when `stop` asked for an end.
    ///
    /// # Errors
    /// [`StudyError`].
    pub(crate) fn make(
        &self,
        ready: &Ready,
        index: usize,
        place: (usize, usize),
        stop: &AtomicBool,
        observer: &mut dyn Observer,
    ) -> Result<ControlFlow<()>, StudyError> {
        let (prepared, folder) = (&ready.prepared, &self.folders[index]);
        let run = &prepared.referred(&prepared.case.runs[index])?;
        if self.resume && folder.holds_results() && !folder.checkpoint_path().exists() {
            let name = &run.name;
            observer.warned(&format!("{name} left no checkpoint: it begins at time zero again"));
        }
        let wind = self.same_wind(&ready.prepared, &run.name)?;
        let manifest = begin_run(&ready.prepared, wind, (index, run), folder, self.resume)?;
        let (outputs, resume) = (self.outputs, self.resume);
        let job = Job { ready, run, folder, outputs, resume, place };
        match simulate(&job, stop, observer)? {
            Ending::Interrupted => Ok(ControlFlow::Break(())),
            Ending::Complete { cost, left, warnings, backend } => {
                let mut summary = self.summary(ready, (index, run), &left, cost)?;
                summary.warnings.extend(warnings);
                let known = &ready.prepared.warnings;
                let n_known = known.iter().filter(|warning| warning.concerns(&run.name)).count();
                for warning in &summary.warnings[n_known..] {
                    observer.warned(&warning.message);
                }
                records::write_manifest(folder, &manifest.finish(&backend))?;
                // The summary comes last: with it the run is complete.
                records::write_summary(folder, &summary)?;
                if !ready.prepared.case.output.keeps_checkpoint {
                    folder.remove_checkpoint()?;
                }
                observer.finished(&summary);
                Ok(ControlFlow::Continue(()))
            }
        }
    }

    /// SHA-256 of the files of wind as they are now, before the run called `run`.
    ///
    /// # Errors
    /// [`StudyError::ChangedWind`] when they are not what they were when the study began.
    fn same_wind(&self, prepared: &Prepared, run: &str) -> Result<WindDigests, StudyError> {
        let wind = prepared.wind_digests()?;
        match another(&self.wind, &wind) {
            None => Ok(wind),
            Some((file, sha256)) => {
                Err(StudyError::ChangedWind { run: run.to_owned(), file, sha256 })
            }
        }
    }

    /// The numbers of `run`, number `index`, with its gains where the run that it compares with is there.
    fn summary(
        &self,
        ready: &Ready,
        (index, run): (usize, &Run),
        left: &[Left],
        cost: Cost,
    ) -> Result<Summary, StudyError> {
        let (prepared, folder) = (&ready.prepared, &self.folders[index]);
        let mut columns = Columns::open(folder, prepared)?;
        let mut summary = summarise::summarise(prepared, run, &mut columns, left, cost)?;
        if let Comparison::Made(other, mut there) =
            gains::comparison(prepared, &self.wind, index, &self.folders)?
        {
            gains::add(&mut summary, (run, &mut columns), (other, &mut there))?;
        }
        // For these numbers columns of the series were read.
        let peak_memory = formats::machine::peak_memory();
        summary.cost.peak_memory = summary.cost.peak_memory.max(peak_memory);
        Ok(summary)
    }
}

/// On return the folder of `run`, number `index`, is ready: empty but for the manifest, which tells of
/// `wind`, or as an interrupted run left it when `resume`.
fn begin_run(
    prepared: &Prepared,
    wind: WindDigests,
    (index, run): (usize, &Run),
    folder: &RunFolder,
    resume: bool,
) -> Result<Manifest, StudyError> {
    folder.remove_leftovers()?;
    if resume && folder.checkpoint_path().exists() && folder.manifest_path().exists() {
        let mut manifest = records::read_manifest(folder)?;
        if manifest.case_text != prepared.case_text {
            // It goes on for longer, or other runs have come beside it.
            folder.reopen()?;
            manifest = manifest.going_on(&prepared.case_text, index);
            records::write_manifest(folder, &manifest)?;
        }
        return Ok(manifest);
    }
    folder.clear()?;
    folder.create()?;
    let texts = prepared.turbine_texts.iter().map(|(name, text)| (name.as_str(), text.as_str()));
    let version = env!("CARGO_PKG_VERSION");
    let manifest = Manifest::start(version, &prepared.case, &prepared.case_text, index, texts);
    let manifest = manifest.in_wind(wind).with_libraries(&prepared.libraries_of(run));
    records::write_manifest(folder, &manifest)?;
    Ok(manifest)
}
