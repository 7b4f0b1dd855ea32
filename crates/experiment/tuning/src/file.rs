//! The study file: what is tuned, over which ranges, with how many runs.

mod check;

use crate::TuningError;
use formats::{FileError, atomic, shipped};
use search::{Acquisition, Axis, Design, Settings, Shape, Space};
use serde::Deserialize;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// What the file holds, in words.
pub(crate) const WHAT: &str = "a study of a tuning";
/// Where its keys are told.
const FIX: &str = "write it as docs/tuning.md has it";

/// A tuning as its file asks for it, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct TuningFile {
    /// The file.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// Case file, or name of a shipped case.
    pub case: PathBuf,
    /// Run that is tuned.
    pub run: String,
    /// Run that it compares with.
    pub baseline: String,
    /// The variables.
    pub variables: Vec<Variable>,
    /// Length of the blocks (s).
    pub block: f64,
    /// Covariance function.
    pub shape: Shape,
    /// How points are chosen.
    pub acquisition: Acquisition,
    /// The first design.
    pub design: Design,
    /// Points of one that is drawn (–).
    pub n_first: usize,
    /// Runs in all, the baseline aside (–).
    pub budget: usize,
    /// Expected gain below which it ends (–).
    pub least_gain: Option<f64>,
    /// Runs at a time (–).
    pub parallel: usize,
    /// Seed.
    pub seed: u64,
    /// Channels whose equivalent loads are followed, each with its Wöhler exponent (–).
    pub loads: Vec<(String, f64)>,
    /// Overrides of the case in every run.
    pub set: Vec<String>,
    /// Sources of cheaper data.
    pub cheaper: Vec<Cheaper>,
}

/// A case that costs less and is like the one that is tuned: coarser, or of another solver.
#[derive(Clone, Debug, PartialEq)]
pub struct Cheaper {
    /// What it is called; its runs are in the folder of this name.
    pub name: String,
    /// Case file, or name of a shipped case, with the same two runs.
    pub case: PathBuf,
    /// Overrides of it.
    pub set: Vec<String>,
    /// Runs, its baseline aside (–).
    pub n_runs: usize,
}

/// What is varied.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Key of the case, as `--set` takes it; `control.…` is that of the run that is tuned.
    pub key: String,
    /// Name in tables and figures.
    pub name: String,
    /// Unit in words; empty where it has none.
    pub unit: String,
    /// Its range.
    pub axis: Axis,
}

/// The file as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Raw {
    case: Spanned<String>,
    run: Spanned<String>,
    baseline: Option<Spanned<String>>,
    #[serde(default)]
    objective: Objective,
    #[serde(default)]
    kernel: KernelName,
    #[serde(default)]
    acquisition: AcquisitionName,
    #[serde(default = "one")]
    seed: u64,
    block: Option<Spanned<f64>>,
    variable: Vec<Spanned<RawVariable>>,
    budget: Spanned<RawBudget>,
    #[serde(default)]
    design: Option<Spanned<RawDesign>>,
    loads: Option<Spanned<RawLoads>>,
    #[serde(default)]
    cheaper: Vec<Spanned<RawCheaper>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawCheaper {
    name: String,
    case: Option<String>,
    #[serde(default)]
    set: Vec<String>,
    runs: Spanned<usize>,
}

fn one() -> u64 {
    1
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Objective {
    #[default]
    Power,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum KernelName {
    #[default]
    Matern32,
    Matern52,
    SquaredExponential,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum AcquisitionName {
    #[default]
    ExpectedImprovement,
    KnowledgeGradient,
    UpperBound,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawVariable {
    key: Spanned<String>,
    name: Option<String>,
    #[serde(default)]
    unit: String,
    from: Spanned<f64>,
    to: Spanned<f64>,
    step: Option<Spanned<f64>>,
    #[serde(default)]
    mirrored: bool,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawBudget {
    runs: Spanned<usize>,
    least_gain: Option<Spanned<f64>>,
    parallel: Option<Spanned<usize>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawDesign {
    first: Option<Spanned<usize>>,
    points: Option<Spanned<Vec<Vec<f64>>>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawLoads {
    channels: Vec<String>,
    exponent: Option<f64>,
}

impl TuningFile {
    /// Reads the file at `path`, and of the case that it names the runs.
    ///
    /// # Errors
    /// [`TuningError::File`] with line, key and fix; [`TuningError::Study`] for a case that cannot be read.
    pub fn read(path: &Path) -> Result<Self, TuningError> {
        let text = atomic::read_text(path, WHAT)?;
        let raw: Raw = toml::from_str(&text).map_err(|error| {
            FileError::content(WHAT, path, error.to_string().trim_end().to_owned(), FIX)
        })?;
        check::checked(raw, path, text)
    }

    /// What is searched over.
    ///
    /// # Errors
    /// [`TuningError::Search`].
    pub fn space(&self) -> Result<Space, TuningError> {
        Ok(Space::new(self.variables.iter().map(|variable| variable.axis).collect())?)
    }

    /// How it is searched, where `n_turbines` make the power.
    pub(crate) fn settings(&self, n_turbines: usize) -> Settings {
        let weights = [vec![1.0; n_turbines], vec![0.0; self.loads.len()]].concat();
        Settings {
            weights,
            shape: self.shape,
            acquisition: self.acquisition,
            design: self.design.clone(),
            n_first: self.n_first,
            budget: self.budget,
            n_at_a_time: self.parallel,
            least_gain: self.least_gain,
            // All runs meet the same wind, and the same run gives the same bits.
            share_blocks: true,
            may_repeat: false,
            seed: self.seed,
            cheaper: Vec::new(),
        }
    }

    /// The tuning of cheaper source number `index` as though it were one of its own, without a search.
    pub(crate) fn of_cheaper(&self, index: usize) -> Self {
        let Cheaper { case, set, n_runs, .. } = self.cheaper[index].clone();
        // Another seed, so that its points are others than those of the first design.
        let seed = self.seed.wrapping_add(1 + index as u64);
        let (design, n_first) = (Design::Hypercube, n_runs);
        Self {
            case,
            set,
            budget: n_runs,
            design,
            n_first,
            seed,
            cheaper: Vec::new(),
            ..self.clone()
        }
    }

    /// Whether every key is one of the tuned run alone, so that one baseline serves all points.
    pub(crate) fn is_of_run_alone(&self) -> bool {
        let own = format!("run.{}.", self.run);
        let is_own = |key: &str| key.starts_with("control.") || key.starts_with(&own);
        self.variables.iter().all(|variable| is_own(&variable.key))
    }

    /// Overrides of the case that make `point`.
    pub fn overrides(&self, point: &[f64]) -> Vec<String> {
        let of = |(variable, value): (&Variable, &f64)| variable.overrides(&self.run, *value);
        let set = self.set.iter().cloned();
        set.chain(self.variables.iter().zip(point).flat_map(of)).collect()
    }

    /// `point` in words: "St = 0.25, amplitude = 4°".
    pub fn words(&self, point: &[f64]) -> String {
        let one = |(variable, value): (&Variable, &f64)| {
            format!("{} = {}", variable.name, variable.value_with_unit(*value))
        };
        self.variables.iter().zip(point).map(one).collect::<Vec<_>>().join(", ")
    }
}

impl Variable {
    /// Overrides of the case that make `value` in the run called `run`.
    fn overrides(&self, run: &str, value: f64) -> Vec<String> {
        let key = match self.key.strip_prefix("control.") {
            Some(rest) => format!("run.{run}.control.{rest}"),
            None => self.key.clone(),
        };
        if self.axis.gap == 0.0 {
            return vec![format!("{key}={value:?}")];
        }
        // f_β = f_r + St U/D, van der Hoek et al., Eq. 12: what is negative turns the other way.
        let table = key.rsplit_once('.').map_or("", |(table, _)| table);
        let sense = if value < 0.0 { "cw" } else { "ccw" };
        vec![format!("{key}={:?}", value.abs()), format!("{table}.sense=\"{sense}\"")]
    }

    /// "4°", "600 s".
    pub(crate) fn value_with_unit(&self, value: f64) -> String {
        let digits = format!("{value:.4}");
        let short = digits.trim_end_matches('0').trim_end_matches('.');
        match self.unit.as_str() {
            "" => short.to_owned(),
            "°" => format!("{short}°"),
            unit => format!("{short} {unit}"),
        }
    }

    /// Name with unit, as axes have it.
    pub(crate) fn label(&self) -> String {
        format!("{} ({})", self.name, if self.unit.is_empty() { "–" } else { &self.unit })
    }
}

/// Where the case called `name` in the file at `path` is: beside that file, or one that comes with the
/// program.
fn case_path(path: &Path, name: &str) -> PathBuf {
    let beside = path.parent().unwrap_or(Path::new("")).join(name);
    if !beside.exists() && shipped::find(name).is_some() { PathBuf::from(name) } else { beside }
}

#[cfg(test)]
mod tests;
