//! What turbines of a layout make and bear, as surrogates predict it: over the direction of the wind, over
//! their place in a wake, over what they do.

mod ask;
mod figures;
mod file;

use self::ask::{Asked, Question};
use self::file::LayoutFile;
use crate::DesignError;
use formats::linear_model::Port;
use std::path::{Path, PathBuf};
use surrogate::Prediction;

pub use figures::draw_layout;

/// The surrogate of this name tells the power, of which a layout has a sum and a gain.
pub const POWER: &str = "power";

/// A prediction and where it is of.
#[derive(Clone, Debug, PartialEq)]
pub struct LayoutRow {
    /// Place of the strategy and of the turbine in the file, from 0.
    pub strategy: usize,
    /// The turbine.
    pub turbine: usize,
    /// Direction of the wind (deg), lateral displacement (m), or the value of the input that is varied.
    pub at: f64,
    /// How far the rotor stands to the left of the middle of its record (m).
    pub shift: f64,
    /// Share of the direction in averages (–); 0 where it is none.
    pub weight: f64,
    /// What each surrogate says.
    pub predictions: Vec<Prediction>,
}

/// A value with the standard deviation of the curve that says it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncertain {
    /// The value (its unit).
    pub mean: f64,
    /// Its standard deviation (its unit).
    pub deviation: f64,
}

impl Uncertain {
    /// Half of the 95 % interval, normal.
    pub fn half_width_95(&self) -> f64 {
        const NORMAL_97_5: f64 = 1.959_963_984_540_054;
        NORMAL_97_5 * self.deviation
    }
}

/// A turbine, or all of them, in a strategy over all directions.
#[derive(Clone, Debug, PartialEq)]
pub struct LayoutAverage {
    /// Place of the strategy in the file, from 0.
    pub strategy: usize,
    /// That of the turbine; none of all turbines together, of which power alone is told.
    pub turbine: Option<usize>,
    /// Mean of each surrogate's output over the directions; none where it is not told.
    pub values: Vec<Option<Uncertain>>,
    /// The same over that of the first strategy, less one (–).
    pub changes: Vec<Option<Uncertain>>,
}

/// What surrogates predict of a layout.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// The file.
    pub path: PathBuf,
    /// Names of turbines and of strategies.
    pub turbines: Vec<String>,
    /// Those of the strategies; the first is what the others compare with.
    pub strategies: Vec<String>,
    /// What the surrogates predict, each by its name in the layout, with the unit of its output.
    pub outputs: Vec<Port>,
    /// Rotor diameter (m).
    pub diameter: f64,
    /// Every turbine of every strategy over the directions.
    pub directions: Vec<LayoutRow>,
    /// Turbines in wakes over the lateral displacement, in wind along the axis; empty where not asked for.
    pub displacements: Vec<LayoutRow>,
    /// One turbine of the first strategy over an input, which it names; none where not asked for.
    pub along: Option<(String, Vec<LayoutRow>)>,
    /// Means over the directions.
    pub averages: Vec<LayoutAverage>,
    /// What a user must know.
    pub warnings: Vec<String>,
}

/// Predicts the layout of the file at `path`.
///
/// # Errors
/// [`DesignError`] naming the file and what is wrong with it.
pub fn predict_layout(path: &Path) -> Result<Layout, DesignError> {
    let file = LayoutFile::read(path)?;
    let asked = Asked::new(path, &file)?;
    let mut warnings = Vec::new();
    let mut answered = |questions: &[(Question, f64, f64)]| {
        let only: Vec<Question> = questions.iter().map(|(question, ..)| question.clone()).collect();
        warnings.extend(asked.outside(&only)?);
        let answers = asked.answers(&only)?;
        let row = |(place, (question, at, weight)): (usize, &(Question, f64, f64))| LayoutRow {
            strategy: question.strategy,
            turbine: question.turbine,
            at: *at,
            shift: question.shift,
            weight: *weight,
            predictions: answers.iter().map(|of_one| of_one[place]).collect(),
        };
        Ok::<_, DesignError>(questions.iter().enumerate().map(row).collect::<Vec<_>>())
    };
    let directions = answered(&over_directions(&file))?;
    let displacements = answered(&over_displacements(&file))?;
    let along = match &file.along {
        Some(along) => Some((along.input.clone(), answered(&over_input(&file, along))?)),
        None => None,
    };
    let port =
        |one: &ask::Surrogate| Port { name: one.name.clone(), unit: one.model.output.unit.clone() };
    let outputs: Vec<Port> = asked.surrogates.iter().map(port).collect();
    Ok(Layout {
        path: path.to_owned(),
        turbines: file.turbine.iter().map(|turbine| turbine.name.clone()).collect(),
        strategies: file.strategy.iter().map(|strategy| strategy.name.clone()).collect(),
        averages: averages(&file, &outputs, &directions),
        outputs,
        diameter: file.diameter,
        directions,
        displacements,
        along,
        warnings,
    })
}

/// How far turbine number `turbine` stands to the left of the middle of the wake that it stands in (m) where
/// the wind is turned by `direction` (deg).
fn shift(file: &LayoutFile, turbine: usize, direction: f64) -> f64 {
    let own = &file.turbine[turbine];
    let before = own
        .behind
        .as_ref()
        .and_then(|name| file.turbine.iter().find(|turbine| turbine.name == *name));
    let Some(before) = before else { return 0.0 };
    let ([x, y], [x_before, y_before]) = (file.position(own), file.position(before));
    let (s, c) = direction.to_radians().sin_cos();
    // Along the wind's own left.
    (y - y_before) * c - (x - x_before) * s
}

/// All turbines in all directions, with the weight of each.
///
/// Source: van der Hoek et al., eq. 14, after Rott et al. (2018); the weights of the directions that are
/// asked make up one.
fn over_directions(file: &LayoutFile) -> Vec<(Question, f64, f64)> {
    let places = file.directions.range().places();
    let share = |direction: f64| {
        (-0.5 * ((direction - file.directions.mean) / file.directions.deviation).powi(2)).exp()
    };
    let total: f64 = places.iter().map(|direction| share(*direction)).sum();
    let mut questions = Vec::new();
    for strategy in 0..file.strategy.len() {
        for turbine in 0..file.turbine.len() {
            for &direction in &places {
                let shift = shift(file, turbine, direction);
                let question = Question { strategy, turbine, shift, direction, instead: None };
                questions.push((question, direction, share(direction) / total));
            }
        }
    }
    questions
}

/// Turbines that stand in wakes, moved across them.
fn over_displacements(file: &LayoutFile) -> Vec<(Question, f64, f64)> {
    let places = file.displacements.map_or(Vec::new(), |range| range.places());
    let mut questions = Vec::new();
    for strategy in 0..file.strategy.len() {
        for (turbine, _) in file.turbine.iter().enumerate().filter(|(_, one)| one.behind.is_some())
        {
            for &shift in &places {
                let question = Question { strategy, turbine, shift, direction: 0.0, instead: None };
                questions.push((question, shift, 0.0));
            }
        }
    }
    questions
}

/// One turbine of the first strategy over an input.
fn over_input(file: &LayoutFile, along: &file::Along) -> Vec<(Question, f64, f64)> {
    let turbine = file.turbine.iter().position(|turbine| turbine.name == along.turbine);
    let Some(turbine) = turbine else { return Vec::new() };
    let question = |value: f64| {
        let (direction, shift) = (0.0, shift(file, turbine, 0.0));
        let instead = Some((along.input.clone(), value));
        (Question { strategy: 0, turbine, shift, direction, instead }, value, 0.0)
    };
    along.range().places().into_iter().map(question).collect()
}

/// Means over the directions of `rows`, turbine by turbine, and of the power of all.
///
/// The errors of a surrogate at neighbouring directions are alike, so that deviations are added as they are;
/// those of two strategies count as independent.
fn averages(file: &LayoutFile, outputs: &[Port], rows: &[LayoutRow]) -> Vec<LayoutAverage> {
    let mean = |strategy: usize, turbine: Option<usize>, output: usize| {
        let mut found = Uncertain { mean: 0.0, deviation: 0.0 };
        let is_of = |row: &&LayoutRow| {
            row.strategy == strategy && turbine.is_none_or(|turbine| row.turbine == turbine)
        };
        for row in rows.iter().filter(is_of) {
            found.mean += row.weight * row.predictions[output].mean;
            found.deviation += row.weight * row.predictions[output].standard_deviation;
        }
        found
    };
    let mut all = Vec::new();
    for strategy in 0..file.strategy.len() {
        let turbines = (0..file.turbine.len()).map(Some).chain([None]);
        for turbine in turbines {
            let of = |strategy: usize| -> Vec<Option<Uncertain>> {
                let is_told = |port: &Port| turbine.is_some() || port.name == POWER;
                let outputs = outputs.iter().enumerate();
                outputs
                    .map(|(at, port)| is_told(port).then(|| mean(strategy, turbine, at)))
                    .collect()
            };
            let (values, first) = (of(strategy), of(0));
            let pairs = values.iter().zip(&first).map(|(value, first)| value.zip(*first));
            let changes = match strategy {
                0 => vec![None; values.len()],
                _ => {
                    pairs.map(|pair| pair.and_then(|(value, first)| change(value, first))).collect()
                }
            };
            all.push(LayoutAverage { strategy, turbine, values, changes });
        }
    }
    all
}

/// `value` over `first`, less one (–); none where that is nothing.
pub(crate) fn change(value: Uncertain, first: Uncertain) -> Option<Uncertain> {
    if first.mean == 0.0 {
        return None;
    }
    let ratio = value.mean / first.mean;
    let deviation = (value.deviation / first.mean).hypot(ratio * first.deviation / first.mean);
    Some(Uncertain { mean: ratio - 1.0, deviation })
}

impl Layout {
    /// Writes all predictions as CSV to `path`, whole or not at all: a row for each turbine, strategy and
    /// direction, displacement or input.
    ///
    /// # Errors
    /// [`DesignError::File`] where it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), DesignError> {
        let mut text = "over,at,strategy,turbine,shift [m],weight".to_owned();
        for Port { name, unit } in &self.outputs {
            let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
            text += &format!(",{name}{unit},{name}_deviation{unit}");
        }
        text.push('\n');
        let along = self.along.iter().map(|(input, rows)| (input.as_str(), rows));
        let parts = [("direction_deg", &self.directions), ("displacement_m", &self.displacements)];
        for (over, rows) in parts.into_iter().chain(along) {
            for row in rows {
                let (strategy, turbine) =
                    (&self.strategies[row.strategy], &self.turbines[row.turbine]);
                let LayoutRow { at, shift, weight, .. } = row;
                text += &format!("{over},{at},{strategy},{turbine},{shift},{weight}");
                for Prediction { mean, standard_deviation, .. } in &row.predictions {
                    text += &format!(",{mean},{standard_deviation}");
                }
                text.push('\n');
            }
        }
        Ok(formats::atomic::write(path, "predictions of a layout", text.as_bytes())?)
    }
}
