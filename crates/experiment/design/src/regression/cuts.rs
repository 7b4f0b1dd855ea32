//! A surrogate along its inputs, one at a time and two at a time.

use super::stored::regression;
use crate::DesignError;
use formats::linear_model::Port;
use formats::surrogate_model::SurrogateModel;
use report::{SurrogateCut, SurrogateFigures, SurrogateMap};
use std::path::Path;
use surrogate::{LeaveOneOut, Prediction, Regression, Validation};

/// 97.5 % point of the normal distribution (–).
const NORMAL_97_5: f64 = 1.959_963_984_540_054;
/// Places along an input, in a cut and in a map (–).
const N_PLACES: [usize; 2] = [101, 41];

/// The curve along one input, all others at their means over the training data.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// Which input, the first is 0.
    pub input: usize,
    /// Places (unit of the input).
    pub places: Vec<f64>,
    /// What is predicted there.
    pub predictions: Vec<Prediction>,
}

fn label(port: &Port) -> String {
    if port.unit.is_empty() { port.name.clone() } else { format!("{} ({})", port.name, port.unit) }
}

/// Mean of each input over the training data.
fn middle(model: &SurrogateModel) -> Vec<f64> {
    let points = model.observations.inputs.as_ref().unwrap_or(&model.points);
    let mean =
        |input: usize| points.iter().map(|point| point[input]).sum::<f64>() / points.len() as f64;
    (0..model.inputs.len()).map(mean).collect()
}

fn places([low, high]: [f64; 2], n: usize) -> Vec<f64> {
    (0..n).map(|place| low + (high - low) * place as f64 / (n - 1) as f64).collect()
}

fn asked(found: &Regression, inputs: &[f64], path: &Path) -> Result<Vec<Prediction>, DesignError> {
    let failed = |source| DesignError::Surrogate { path: path.to_owned(), source };
    found.predict(inputs, 0).map_err(failed)
}

/// Cuts along every input of the surrogate `model` that was read from `path`.
///
/// # Errors
/// [`DesignError::Surrogate`] where it cannot be asked.
pub fn cuts(model: &SurrogateModel, path: &Path) -> Result<Vec<Cut>, DesignError> {
    cuts_of(&regression(model, path)?, model, path)
}

fn cuts_of(
    found: &Regression,
    model: &SurrogateModel,
    path: &Path,
) -> Result<Vec<Cut>, DesignError> {
    let middle = middle(model);
    let one = |(input, range): (usize, &[f64; 2])| {
        let places = places(*range, N_PLACES[0]);
        let mut inputs = Vec::new();
        for place in &places {
            let mut point = middle.clone();
            point[input] = *place;
            inputs.extend(point);
        }
        Ok(Cut { input, predictions: asked(found, &inputs, path)?, places })
    };
    model.ranges.iter().enumerate().map(one).collect()
}

/// True values beside predictions.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatter<'a> {
    /// Pairs of them.
    pub pairs: &'a [LeaveOneOut],
    /// How well they agree, in words.
    pub fit: String,
}

/// What validations say of errors, in words: `RMSPE 0.86 % of 700 inputs trained on, 1.65 % of 300 …`.
pub fn fit_in_words(validations: &[(&str, Option<Validation>)]) -> String {
    let told = validations.iter().filter_map(|(words, found)| Some((words, (*found)?)));
    let one = |(words, found): (&&str, Validation)| {
        format!("{:.2}\u{a0}% of {} inputs {words}", found.root_mean_square_percentage, found.n)
    };
    let told: Vec<String> = told.map(one).collect();
    if told.is_empty() { String::new() } else { format!("RMSPE {}", told.join(", ")) }
}

/// Draws the surrogate `model`, which was read from `path`, into `folder`/figures: predicted over true
/// values of `scatter`, or where there is none of each training input predicted from all others; cuts,
/// and a map over `two` of its inputs; gives the figures' names.
///
/// # Errors
/// [`DesignError::Surrogate`] where it cannot be asked, [`DesignError::Report`] where it cannot be drawn.
pub fn draw_surrogate(
    model: &SurrogateModel,
    path: &Path,
    scatter: Option<Scatter>,
    two: Option<[usize; 2]>,
    folder: &Path,
) -> Result<Vec<String>, DesignError> {
    let found = regression(model, path)?;
    let left_out = found.leave_one_out().unwrap_or_default();
    let scatter = scatter.unwrap_or_else(|| Scatter {
        fit: fit_in_words(&[("predicted from all others", Validation::of(&left_out))]),
        pairs: &left_out,
    });
    let cut = |cut: Cut| SurrogateCut {
        label: label(&model.inputs[cut.input]),
        places: cut.places,
        means: cut.predictions.iter().map(|found| found.mean).collect(),
        half_widths: half_widths(&cut.predictions),
    };
    let middle = middle(model);
    let held: Vec<String> = model
        .inputs
        .iter()
        .zip(&middle)
        .map(|(port, value)| {
            format!("{} {value:.4} {}", port.name, port.unit).trim_end().to_owned()
        })
        .collect();
    let figures = SurrogateFigures {
        output: label(&model.output),
        pairs: scatter.pairs.iter().map(|pair| [pair.value, pair.mean]).collect(),
        fit: scatter.fit,
        cuts: cuts_of(&found, model, path)?.into_iter().map(cut).collect(),
        maps: two.map(|two| maps(&found, model, path, two)).transpose()?,
        held: format!(
            "what is not along an axis stays at the mean of the training data: {}",
            held.join(", ")
        ),
    };
    Ok(report::write_surrogate(&figures, folder)?)
}

fn half_widths(predictions: &[Prediction]) -> Vec<f64> {
    predictions.iter().map(|found| NORMAL_97_5 * found.standard_deviation).collect()
}

fn maps(
    found: &Regression,
    model: &SurrogateModel,
    path: &Path,
    two: [usize; 2],
) -> Result<[SurrogateMap; 2], DesignError> {
    let [first, second] = two.map(|input| places(model.ranges[input], N_PLACES[1]));
    let middle = middle(model);
    let mut inputs = Vec::new();
    for y in &second {
        for x in &first {
            let mut point = middle.clone();
            (point[two[0]], point[two[1]]) = (*x, *y);
            inputs.extend(point);
        }
    }
    let predictions = asked(found, &inputs, path)?;
    let map = |title: String, values| SurrogateMap {
        title,
        labels: two.map(|input| label(&model.inputs[input])),
        ends: two.map(|input| model.ranges[input]),
        n: [N_PLACES[1]; 2],
        values,
    };
    let means = predictions.iter().map(|found| found.mean).collect();
    let output = label(&model.output);
    Ok([map(output.clone(), means), map(format!("± {output}, 95 %"), half_widths(&predictions))])
}
