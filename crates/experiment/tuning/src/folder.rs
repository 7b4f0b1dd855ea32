//! The folder of a tuning: where its runs are, and which points were proposed.

use crate::rounds::{Key, Round, Rounds};
use crate::{TuningError, TuningFile};
use formats::lock::Lock;
use formats::{FileError, atomic};
use search::Proposal;
use std::path::{Path, PathBuf};

/// What the file of points holds, in words.
const WHAT: &str = "the points of a tuning";

/// The folder, with what was proposed so far.
#[derive(Debug)]
pub(crate) struct Folder {
    directory: PathBuf,
    rounds: Rounds,
    /// Keeps other processes out.
    _lock: Lock,
}

/// Where the points stand in `directory`.
fn points_path(directory: &Path) -> PathBuf {
    directory.join("points.json")
}

impl Folder {
    /// The folder at `directory` of the tuning that `file` asks for: a new one, or, to `resume`, one that was
    /// begun.
    ///
    /// # Errors
    /// [`TuningError::Begun`], [`TuningError::NothingToResume`], [`TuningError::Other`],
    /// [`TuningError::File`].
    pub(crate) fn open(
        directory: PathBuf,
        file: &TuningFile,
        resume: bool,
    ) -> Result<Self, TuningError> {
        let path = points_path(&directory);
        match (path.is_file(), resume) {
            (true, false) => return Err(TuningError::Begun { directory }),
            (false, true) => return Err(TuningError::NothingToResume { directory }),
            _ => {}
        }
        atomic::check_folder(&directory)?;
        let lock = Lock::take(&directory.join(".tuning.lock"), "the tuning")?;
        let mut rounds = Rounds::new(file);
        if resume {
            let before = read(&path)?;
            if let Some((what, before, now)) = rounds.differs(&before) {
                return Err(TuningError::Other { directory, what, before, now });
            }
            rounds.rounds = before.rounds;
        }
        let folder = Self { directory, rounds, _lock: lock };
        folder.write()?;
        Ok(folder)
    }

    fn write(&self) -> Result<(), TuningError> {
        let text = serde_json::to_string_pretty(&self.rounds).expect("plain numbers and texts");
        Ok(atomic::write(&points_path(&self.directory), WHAT, (text + "\n").as_bytes())?)
    }

    /// The folder itself.
    pub(crate) fn path(&self) -> &Path {
        &self.directory
    }

    /// Folder of the study that makes the baseline.
    pub(crate) fn baseline(&self) -> PathBuf {
        self.directory.join("baseline")
    }

    /// Folder of the study that makes point number `index`, from 0.
    pub(crate) fn point(&self, index: usize) -> PathBuf {
        self.directory.join(format!("point-{:03}", index + 1))
    }

    /// The points of `proposal`, kept; where its round was kept before, those that it had then. Gives the
    /// number of the first of them too.
    ///
    /// # Errors
    /// [`TuningError::File`].
    pub(crate) fn keep(
        &mut self,
        proposal: &Proposal,
    ) -> Result<(usize, Vec<Vec<f64>>), TuningError> {
        if self.rounds.rounds.len() <= proposal.round {
            let Proposal { points, expected_gain, .. } = proposal.clone();
            self.rounds.rounds.push(Round { points, expected_gain });
            self.write()?;
        }
        let before = &self.rounds.rounds[..proposal.round];
        let first = before.iter().map(|round| round.points.len()).sum();
        Ok((first, self.rounds.rounds[proposal.round].points.clone()))
    }
}

/// Whether a tuning was begun in `directory`.
pub(crate) fn is_begun(directory: &Path) -> bool {
    points_path(directory).is_file()
}

/// What was proposed in the tuning in `directory`; nothing where none was begun.
pub(crate) fn n_points(directory: &Path) -> usize {
    let found = read(&points_path(directory)).ok();
    found.map_or(0, |found| found.rounds.iter().map(|round| round.points.len()).sum())
}

fn read(path: &Path) -> Result<Rounds, TuningError> {
    let text = atomic::read_text(path, WHAT)?;
    let fix = "restore the file, or tune into another folder with -o";
    let refused = |problem: String| FileError::content(WHAT, path, problem, fix);
    let found: Rounds = serde_json::from_str(&text).map_err(|error| refused(error.to_string()))?;
    let n = found.variables.len();
    let points = found.rounds.iter().flat_map(|round| &round.points);
    for (index, point) in points.enumerate() {
        let is_in = |(value, Key { from, to, .. }): (&f64, &Key)| (*from..=*to).contains(value);
        if point.len() != n || !point.iter().zip(&found.variables).all(is_in) {
            let problem = format!("point {} is not {n} numbers within the ranges", index + 1);
            return Err(refused(problem).into());
        }
    }
    if found.rounds.iter().any(|round| round.points.is_empty()) {
        return Err(refused("a round has no points".to_owned()).into());
    }
    Ok(found)
}
