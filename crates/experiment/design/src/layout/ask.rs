//! What surrogates are asked of a layout: the wind on the quarters of each rotor, its yaw, its control.

use super::file::{LayoutFile, WHAT};
use crate::DesignError;
use crate::model::five_digits;
use crate::regression::regression;
use flow::inflow::{CutPlanes, Disc, InflowError, PlaneMeans, SECTOR_NAMES};
use formats::surrogate_model::SurrogateModel;
use formats::{FileError, turbulence_box};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use surrogate::{Outside, Prediction, Regression};

/// Where a surrogate's input comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    /// Mean speed on a quarter of the rotor.
    Speed(usize),
    /// Turbulence intensity there.
    Intensity(usize),
    /// Turn of the nacelle from the axis of the record.
    Yaw,
    /// The same from the mean wind over the rotor.
    Misalignment,
    /// What the strategy says.
    Given,
}

/// What a strategy calls the turn of a nacelle, and what follows from it and the record.
const YAW: &str = "yaw_deg";
const MISALIGNMENT: &str = "yaw_misalignment_deg";

/// Whether the input called `input` is what `name` says: all of its name, or what follows a dot in it.
fn is_called(input: &str, name: &str) -> bool {
    input.strip_suffix(name).is_some_and(|front| front.is_empty() || front.ends_with('.'))
}

impl Source {
    fn of(input: &str) -> Self {
        for (quarter, name) in SECTOR_NAMES.iter().enumerate() {
            if is_called(input, &format!("sector_{name}.wind_speed")) {
                return Self::Speed(quarter);
            }
            if is_called(input, &format!("sector_{name}.turbulence_intensity")) {
                return Self::Intensity(quarter);
            }
        }
        match input {
            _ if is_called(input, YAW) => Self::Yaw,
            _ if is_called(input, MISALIGNMENT) => Self::Misalignment,
            _ => Self::Given,
        }
    }

    /// What a strategy calls the input called `input`; none where it does not tell it.
    fn key(self, input: &str) -> Option<&str> {
        match self {
            Self::Speed(_) | Self::Intensity(_) => None,
            Self::Misalignment => Some(YAW),
            Self::Yaw | Self::Given => Some(input),
        }
    }

    /// Whether a strategy that says `name` tells the input called `input`.
    fn is_given(self, input: &str, name: &str) -> bool {
        self.key(input)
            .is_some_and(|key| is_called(key, name) || key == YAW && is_called(name, key))
    }
}

/// A surrogate, with what its inputs are.
pub(super) struct Surrogate {
    /// What the layout calls it.
    pub(super) name: String,
    pub(super) path: PathBuf,
    pub(super) model: SurrogateModel,
    regression: Regression,
    sources: Vec<Source>,
}

/// One turbine in one wind.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Question {
    /// Strategy and turbine, by their places in the file.
    pub(super) strategy: usize,
    pub(super) turbine: usize,
    /// How far the rotor stands to the left of the middle of its record (m).
    pub(super) shift: f64,
    /// How far the wind is turned counter-clockwise from the layout's axis (deg).
    pub(super) direction: f64,
    /// An input that has another value than the strategy's.
    pub(super) instead: Option<(String, f64)>,
}

/// All that is asked.
pub(super) struct Asked<'a> {
    path: &'a Path,
    file: &'a LayoutFile,
    pub(super) surrogates: Vec<Surrogate>,
    /// Means of each record.
    winds: BTreeMap<PathBuf, PlaneMeans>,
}

impl<'a> Asked<'a> {
    /// Reads surrogates and records of the layout `file` at `path`.
    ///
    /// # Errors
    /// [`DesignError`] naming the file and what is wrong with it.
    pub(super) fn new(path: &'a Path, file: &'a LayoutFile) -> Result<Self, DesignError> {
        let read = |(name, path): (&String, &PathBuf)| {
            let model = SurrogateModel::read(path)?;
            let regression = regression(&model, path)?;
            let sources = model.inputs.iter().map(|port| Source::of(&port.name)).collect();
            let (name, path) = (name.clone(), path.clone());
            Ok(Surrogate { name, path, model, regression, sources })
        };
        let surrogates =
            file.surrogates.iter().map(read).collect::<Result<Vec<_>, DesignError>>()?;
        let mut asked = Self { path, file, surrogates, winds: BTreeMap::new() };
        asked.check_names()?;
        for record in file.strategy.iter().flat_map(|strategy| strategy.wind.values()) {
            if !asked.winds.contains_key(record) {
                asked.winds.insert(record.clone(), means(record, file)?);
            }
        }
        Ok(asked)
    }

    fn refused(&self, problem: String, fix: String) -> DesignError {
        FileError::content(WHAT, self.path, problem, &fix).into()
    }

    /// Whether every input that is given is one of a surrogate.
    fn check_names(&self) -> Result<(), DesignError> {
        let ports =
            || self.surrogates.iter().flat_map(|one| one.model.inputs.iter().zip(&one.sources));
        let is_own = |name: &str| ports().any(|(port, source)| source.is_given(&port.name, name));
        let refused = |key: String, name: &str| {
            if is_called(name, MISALIGNMENT) {
                let problem = format!("{key}: {name} follows from the wind of the record");
                return self.refused(problem, format!("give {YAW}, the turn from the axis"));
            }
            let own: BTreeSet<&str> =
                ports().filter_map(|(port, source)| source.key(&port.name)).collect();
            let own = own.into_iter().collect::<Vec<_>>().join(", ");
            let problem = format!("{key}: no surrogate has the input {name}");
            self.refused(problem, format!("give one of {own}, or leave it out"))
        };
        for strategy in &self.file.strategy {
            for (turbine, inputs) in &strategy.inputs {
                if let Some(name) = inputs.keys().find(|name| !is_own(name)) {
                    let key = format!("strategy {}, inputs.{turbine}", strategy.name);
                    return Err(refused(key, name));
                }
            }
        }
        match &self.file.along {
            Some(along) if !is_own(&along.input) => {
                Err(refused("along.input".to_owned(), &along.input))
            }
            _ => Ok(()),
        }
    }

    /// What all surrogates say to `questions`: those of one surrogate together.
    ///
    /// # Errors
    /// [`DesignError`] for an input that nothing tells, and for a rotor that leaves its record.
    pub(super) fn answers(
        &self,
        questions: &[Question],
    ) -> Result<Vec<Vec<Prediction>>, DesignError> {
        let answers = |one: &Surrogate| {
            let points = self.points(one, questions)?;
            let failed = |source| DesignError::Surrogate { path: one.path.clone(), source };
            one.regression.predict(&points.concat(), 0).map_err(failed)
        };
        self.surrogates.iter().map(answers).collect()
    }

    /// Inputs of `surrogate` at `questions`.
    fn points(
        &self,
        surrogate: &Surrogate,
        questions: &[Question],
    ) -> Result<Vec<Vec<f64>>, DesignError> {
        questions.iter().map(|question| self.point(surrogate, question)).collect()
    }

    fn point(&self, surrogate: &Surrogate, question: &Question) -> Result<Vec<f64>, DesignError> {
        let strategy = &self.file.strategy[question.strategy];
        let turbine = &self.file.turbine[question.turbine].name;
        let record = &strategy.wind[turbine];
        let disc =
            Disc { y: question.shift, z: self.file.hub_height, radius: 0.5 * self.file.diameter };
        let wind = &self.winds[record];
        let outside = |error: InflowError| {
            let problem = format!(
                "strategy {}, turbine {turbine}, {:.1} m to the left of the middle of {}: {error}",
                strategy.name,
                question.shift,
                record.display()
            );
            self.refused(
                problem,
                "record a wider or higher slice, or take a smaller range".to_owned(),
            )
        };
        let sectors = wind.sectors(disc).map_err(outside)?;
        let value = |(port, source): (&formats::linear_model::Port, &Source)| {
            let own = strategy.inputs.get(turbine).into_iter().flatten();
            let instead = question.instead.iter().map(|(name, value)| (name, value));
            let given = instead.chain(own).find(|(name, _)| source.is_given(&port.name, name));
            let given = given.map(|(_, value)| *value);
            match *source {
                Source::Speed(quarter) => Ok(sectors[quarter].wind_speed),
                Source::Intensity(quarter) => Ok(sectors[quarter].turbulence_intensity),
                // The nacelle stays where it is when the wind turns.
                Source::Yaw => Ok(given.unwrap_or(0.0) - question.direction),
                Source::Misalignment => {
                    let across = wind.direction(disc).map_err(outside)?.to_degrees();
                    Ok(given.unwrap_or(0.0) - question.direction - across)
                }
                Source::Given => given.ok_or_else(|| {
                    let problem = format!(
                        "strategy {} does not tell the input {} of the surrogate {} for turbine {turbine}",
                        strategy.name, port.name, surrogate.name
                    );
                    self.refused(problem, format!("add inputs.{turbine} = {{ \"{}\" = … }}", port.name))
                }),
            }
        };
        surrogate.model.inputs.iter().zip(&surrogate.sources).map(value).collect()
    }

    /// A sentence for each input of surrogates that leaves at `questions` what they were trained on; those of
    /// one table say the same.
    ///
    /// # Errors
    /// As [`answers`](Self::answers).
    pub(super) fn outside(&self, questions: &[Question]) -> Result<Vec<String>, DesignError> {
        let mut told: Vec<(Vec<&str>, String)> = Vec::new();
        for surrogate in &self.surrogates {
            let points = self.points(surrogate, questions)?;
            for (input, range) in surrogate.model.ranges.iter().enumerate() {
                let asked: Vec<f64> = points.iter().map(|point| point[input]).collect();
                let Some(out) = Outside::of(input, *range, &asked) else { continue };
                let question = &questions[out.furthest_point];
                let port = &surrogate.model.inputs[input];
                let sentence = format!(
                    "{} of {} questions lie outside the {} to {} {} of {} that was trained on, the furthest is {} (strategy {}, turbine {}); little is known there",
                    out.n_points,
                    points.len(),
                    five_digits(range[0]),
                    five_digits(range[1]),
                    port.unit,
                    port.name,
                    five_digits(out.furthest),
                    self.file.strategy[question.strategy].name,
                    self.file.turbine[question.turbine].name,
                );
                match told.iter_mut().find(|(_, other)| *other == sentence) {
                    Some((names, _)) => names.push(&surrogate.name),
                    None => told.push((vec![&surrogate.name], sentence)),
                }
            }
        }
        Ok(told.into_iter().map(|(names, told)| format!("{}: {told}", names.join(", "))).collect())
    }
}

/// Means over the block of the record at `path` that the layout `file` takes.
fn means(path: &Path, file: &LayoutFile) -> Result<PlaneMeans, DesignError> {
    const RECORD: &str = "a record of wind";
    let planes = turbulence_box::open(path)?;
    let mut planes = CutPlanes::new(planes, &file.cut(), file.hub_height).map_err(|error| {
        FileError::content(RECORD, path, error.to_string(), "change `block` of the layout")
    })?;
    PlaneMeans::of(&mut planes, file.wind_speed).map_err(|error| {
        let fix = "record it again, or name another one";
        FileError::content(RECORD, path, error.to_string(), fix).into()
    })
}
