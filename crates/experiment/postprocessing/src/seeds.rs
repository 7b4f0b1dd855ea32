//! Gains of one case in several winds: studies that differ in the wind's seed, beside each other and
//! together.

mod error;

pub use error::SeedsError;

use crate::PostprocessingError;
use crate::error::{InRecords, case_of};
use analysis::statistics::independent;
use basis::records::{Statistic, Summary};
use farm::case::Case;
use formats::case;
use formats::records::{self, Manifest, RunFolder};
use std::path::{Path, PathBuf};

/// A question to several studies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GainsQuestion {
    /// Folders of the studies, two or more.
    pub studies: Vec<PathBuf>,
    /// Runs whose gains are asked for; all that compare with another when empty.
    pub runs: Vec<String>,
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub struct GainsAnswer {
    /// Name of the case.
    pub case: String,
    /// Seed of the wind of each study (–), in the order of the question.
    pub seeds: Vec<u64>,
    /// Turbines that stand downstream of the first.
    pub downstream: Vec<String>,
    /// Run by run.
    pub runs: Vec<RunGains>,
    /// Gains that are left out because a run compared with has no power, and where, in words.
    pub undefined: Vec<String>,
}

/// Gains of one run in all winds.
#[derive(Clone, Debug, PartialEq)]
pub struct RunGains {
    /// Name of the run.
    pub run: String,
    /// Run that it compares with.
    pub compare_with: String,
    /// Of each turbine that is there in both runs, of all downstream of the first together where they are two
    /// or more, and of the whole array; the latter two where the same turbines are there in both runs.
    pub parts: Vec<PartGains>,
}

/// Gains of one turbine or of several together.
#[derive(Clone, Debug, PartialEq)]
pub struct PartGains {
    /// Name of the turbine; `downstream` or `all` for several.
    pub name: String,
    /// Power over that of the compared run in the same wind, minus one (–), study by study.
    pub gains: Vec<f64>,
    /// Their mean, with its 95 % interval by Student's t over the studies (–).
    pub together: Statistic,
}

/// A study as far as its gains need it.
pub(crate) struct Study<'q> {
    pub(crate) folder: &'q Path,
    pub(crate) runs: Vec<(Manifest, Summary)>,
}

impl Study<'_> {
    pub(crate) fn find(&self, run: &str) -> Option<&(Manifest, Summary)> {
        self.runs.iter().find(|(manifest, _)| manifest.run == run)
    }

    /// Runs that compare with one that is there.
    pub(crate) fn compared(&self) -> Vec<String> {
        let is_compared = |summary: &Summary| {
            summary.compare_with.as_deref().is_some_and(|other| self.find(other).is_some())
        };
        let runs = self.runs.iter().filter(|(_, summary)| is_compared(summary));
        runs.map(|(manifest, _)| manifest.run.clone()).collect()
    }
}

/// A run and the one that it compares with, in one wind.
pub(crate) struct Pair<'s> {
    /// Folder of the study.
    pub(crate) folder: &'s Path,
    pub(crate) run: &'s (Manifest, Summary),
    pub(crate) other: &'s (Manifest, Summary),
}

/// What the studies that `question` names tell together of the gains of their runs.
///
/// Gains are ratios of mean powers minus one, as in [`analysis::statistics::gain`]; winds of unlike seeds are
/// taken as independent.
///
/// # Errors
/// [`PostprocessingError::Seeds`] for studies that do not belong together, and [`PostprocessingError`] for
/// records that cannot be read.
pub fn gains_over_seeds(question: &GainsQuestion) -> Result<GainsAnswer, PostprocessingError> {
    if question.studies.len() < 2 {
        return Err(SeedsError::TooFew { n_studies: question.studies.len() }.into());
    }
    let mut studies = Vec::with_capacity(question.studies.len());
    for folder in &question.studies {
        studies.push(Study { folder, runs: records::read_summaries(folder)? });
    }
    let names = wanted(question, &studies)?;
    let mut answer = GainsAnswer {
        case: studies[0].runs[0].1.case.clone(),
        seeds: Vec::new(),
        downstream: Vec::new(),
        runs: Vec::with_capacity(names.len()),
        undefined: Vec::new(),
    };
    for name in &names {
        let pairs = pairs(&studies.iter().collect::<Vec<_>>(), name)?;
        answer.seeds = seeds(&pairs)?;
        let folder = RunFolder::new(pairs[0].folder, name);
        answer.downstream = downstream(&case_of(&folder, &pairs[0].run.0)?);
        let gains = run_gains(&pairs, &answer.downstream, &mut answer.undefined);
        answer.runs.push(gains.in_records(&folder.summary_path())?);
    }
    Ok(answer)
}

/// The runs that `question` is about; all `studies` have gains of them.
fn wanted(question: &GainsQuestion, studies: &[Study<'_>]) -> Result<Vec<String>, SeedsError> {
    let common: Vec<String> = studies[0]
        .compared()
        .into_iter()
        .filter(|run| studies.iter().all(|study| study.compared().contains(run)))
        .collect();
    let mut wanted: Vec<String> = question.runs.clone();
    if wanted.is_empty() {
        for run in studies.iter().flat_map(Study::compared) {
            if !wanted.contains(&run) {
                wanted.push(run);
            }
        }
    }
    if wanted.is_empty() {
        return Err(SeedsError::NoGains { folder: studies[0].folder.to_owned() });
    }
    for study in studies {
        let own = study.compared();
        let missing: Vec<String> =
            wanted.iter().filter(|run| !own.contains(run)).cloned().collect();
        if !missing.is_empty() {
            return Err(SeedsError::Runs { folder: study.folder.to_owned(), missing, common });
        }
    }
    Ok(wanted)
}

/// The run `name` of each of `studies` with the one that it compares with; all of one case but for the seed.
pub(crate) fn pairs<'s>(
    studies: &[&'s Study<'_>],
    name: &str,
) -> Result<Vec<Pair<'s>>, SeedsError> {
    let mut pairs: Vec<Pair<'s>> = Vec::with_capacity(studies.len());
    for study in studies {
        let found = study.find(name).and_then(|run| {
            let other = study.find(run.1.compare_with.as_deref()?)?;
            Some(Pair { folder: study.folder, run, other })
        });
        let pair = found.ok_or_else(|| SeedsError::NoGains { folder: study.folder.to_owned() })?;
        if let Some(first) = pairs.first() {
            for (here, there) in [(pair.run, first.run), (pair.other, first.other)] {
                check_alike(here, there, study.folder, studies[0].folder)?;
            }
        }
        pairs.push(pair);
    }
    Ok(pairs)
}

/// Whether two runs are of the same turbines and, but for the seed, of the same case.
fn check_alike(
    (manifest, summary): &(Manifest, Summary),
    (first, first_summary): &(Manifest, Summary),
    folder: &Path,
    first_folder: &Path,
) -> Result<(), SeedsError> {
    let run = manifest.run.clone();
    let (here, there) = (turbine_names(summary), turbine_names(first_summary));
    if here != there {
        let reported = |names: &[String], folder: &Path| {
            format!("{} in {}", names.join(", "), folder.display())
        };
        let turbines = [reported(&here, folder), reported(&there, first_folder)];
        return Err(SeedsError::Turbines { run, turbines });
    }
    let same_case = manifest.run == first.run && unseeded(manifest) == unseeded(first);
    if same_case && manifest.turbines_sha256 == first.turbines_sha256 {
        Ok(())
    } else {
        let folders = [folder.to_owned(), first_folder.to_owned()];
        Err(SeedsError::Cases { run, folders })
    }
}

pub(crate) fn turbine_names(summary: &Summary) -> Vec<String> {
    summary.turbines.iter().map(|turbine| turbine.name.clone()).collect()
}

/// What decides the bits of the run of `manifest` beside the seed of the wind.
fn unseeded(manifest: &Manifest) -> [u8; 32] {
    let text = match case::parse("the manifest's case", &manifest.case_text, &[]) {
        Ok(mut case) => {
            case.wind.seed = 0;
            case::write(&case)
        }
        Err(_) => manifest.case_text.clone(),
    };
    case::fingerprint(&text, &manifest.run)
}

/// The seed of the wind of each of `pairs` (–); no two winds are the same.
pub(crate) fn seeds(pairs: &[Pair<'_>]) -> Result<Vec<u64>, SeedsError> {
    let seeds: Vec<u64> = pairs.iter().map(|pair| pair.run.1.conditions.seed).collect();
    for (later, seed) in seeds.iter().enumerate() {
        if let Some(earlier) = seeds[..later].iter().position(|other| other == seed) {
            let folders = [earlier, later].map(|place| pairs[place].folder.to_owned());
            return Err(SeedsError::SameWind { seed: *seed, folders });
        }
    }
    Ok(seeds)
}

/// Names of the turbines of `case` that stand downstream of the first.
fn downstream(case: &Case) -> Vec<String> {
    let places = case.places();
    let first = places.iter().map(|[x, _]| *x).fold(f64::INFINITY, f64::min);
    let behind = case.turbines.iter().zip(&places).filter(|(_, [x, _])| *x > first);
    behind.map(|(turbine, _)| turbine.name.clone()).collect()
}

/// Gains of the run of `pairs`, wind by wind; `downstream` holds the turbines downstream of the first. What
/// is over no power is left out and told in `undefined`.
fn run_gains(
    pairs: &[Pair<'_>],
    downstream: &[String],
    undefined: &mut Vec<String>,
) -> Result<RunGains, PostprocessingError> {
    let [here, there] = [pairs[0].run, pairs[0].other].map(|(_, summary)| turbine_names(summary));
    let behind = |all: &[String]| -> Vec<String> {
        all.iter().filter(|name| downstream.contains(name)).cloned().collect()
    };
    let mut requested: Vec<(String, Vec<String>)> = here
        .iter()
        .filter(|name| there.contains(name))
        .map(|name| (name.clone(), vec![name.clone()]))
        .collect();
    // Without wakes no turbine feels another, so that a sum means nothing.
    let is_summed = pairs.iter().all(|pair| pair.run.1.has_wakes());
    if is_summed && behind(&here) == behind(&there) && behind(&here).len() > 1 {
        requested.push(("downstream".to_owned(), behind(&here)));
    }
    if is_summed && here == there {
        requested.push(("all".to_owned(), here.clone()));
    }
    let mut parts = Vec::with_capacity(requested.len());
    for (name, turbines) in requested {
        let mut gains = Vec::with_capacity(pairs.len());
        for pair in pairs {
            match gain(&pair.run.1, &pair.other.1, &turbines) {
                Some(gain) => gains.push(gain),
                None => {
                    let ([run, other], folder) =
                        ([pair.run, pair.other].map(|(run, _)| &run.run), pair.folder.display());
                    undefined.push(format!(
                        "{run}: the gain of {name} over {other} is not defined: its power there is zero in {folder}"
                    ));
                }
            }
        }
        if gains.len() == pairs.len() {
            parts.push(PartGains { name, together: independent(&gains)?, gains });
        }
    }
    let [run, compare_with] = [pairs[0].run, pairs[0].other].map(|(run, _)| run.run.clone());
    Ok(RunGains { run, compare_with, parts })
}

/// Mean power of `turbines` together in `summary` over that in `other`, minus one (–); none where that is
/// zero.
pub(crate) fn gain(summary: &Summary, other: &Summary, turbines: &[String]) -> Option<f64> {
    let power = |summary: &Summary| -> f64 {
        let requested = summary.turbines.iter().filter(|turbine| turbines.contains(&turbine.name));
        requested.map(|turbine| turbine.power.mean).sum()
    };
    let compared = power(other);
    (compared != 0.0).then(|| power(summary) / compared - 1.0)
}

#[cfg(test)]
mod tests;
