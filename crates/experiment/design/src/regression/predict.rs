//! A surrogate asked at the rows of a table.

use super::stored::{mean_curve, regression};
use crate::DesignError;
use crate::model::five_digits;
use formats::surrogate_model::SurrogateModel;
use formats::table::Samples;
use std::path::{Path, PathBuf};
use surrogate::Outside;

/// What to ask a surrogate.
#[derive(Clone, Debug, PartialEq)]
pub struct PredictQuestion {
    /// The surrogate.
    pub model: PathBuf,
    /// CSV with its inputs.
    pub file: PathBuf,
    /// Whether means are enough, which are many times faster.
    pub means_only: bool,
    /// Noise group of the observations whose band is told.
    pub group: usize,
}

/// What it says.
#[derive(Clone, Debug)]
pub struct Predicted {
    /// The surrogate.
    pub model: SurrogateModel,
    /// The rows that were asked.
    pub samples: Samples,
    /// Mean at each of them (unit of the output).
    pub means: Vec<f64>,
    /// Noise group of the observation whose deviation is told, the first is 0.
    pub group: usize,
    /// Standard deviations of the curve and of one more observation with the estimated noise of its group,
    /// without what was known of rows beyond; empty where means were enough.
    pub deviations: Vec<[f64; 2]>,
    /// What a user must know.
    pub warnings: Vec<String>,
}

/// Asks a surrogate.
///
/// # Errors
/// [`DesignError`] naming the file and what is wrong with it.
pub fn predict(question: &PredictQuestion) -> Result<Predicted, DesignError> {
    let model = SurrogateModel::read(&question.model)?;
    let names: Vec<&str> = model.inputs.iter().map(|port| port.name.as_str()).collect();
    let samples = Samples::read(&question.file, &names)?;
    let warnings = outside(&model, &samples);
    let failed = |source| DesignError::Surrogate { path: question.model.clone(), source };
    let (mut means, mut deviations) = (Vec::new(), Vec::new());
    if question.means_only {
        means = mean_curve(&model, &question.model)?.means(&samples.values, 0);
    } else {
        let found = regression(&model, &question.model)?;
        for prediction in found.predict(&samples.values, question.group).map_err(failed)? {
            means.push(prediction.mean);
            deviations.push([prediction.standard_deviation, prediction.observation_deviation]);
        }
    }
    Ok(Predicted { model, samples, means, group: question.group, deviations, warnings })
}

/// A sentence for each input whose values leave what the surrogate was trained on.
pub(super) fn outside(model: &SurrogateModel, samples: &Samples) -> Vec<String> {
    let of_input = |(input, range): (usize, &[f64; 2])| {
        let asked: Vec<f64> = (0..samples.lines.len()).map(|row| samples.row(row)[input]).collect();
        let out = Outside::of(input, *range, &asked)?;
        let port = &model.inputs[input];
        Some(format!(
            "{}: {} of {} rows lie outside the {} to {} {} of {} that the surrogate was trained on, the first in line {}, the furthest {} in line {}; it says little there",
            samples.path.display(),
            out.n_points,
            samples.lines.len(),
            five_digits(range[0]),
            five_digits(range[1]),
            port.unit,
            port.name,
            samples.lines[out.first],
            five_digits(out.furthest),
            samples.lines[out.furthest_point],
        ))
    };
    model.ranges.iter().enumerate().filter_map(of_input).collect()
}

impl Predicted {
    /// Which noise the deviation of an observation holds, as the end of its column's name.
    fn held(&self) -> String {
        let group = match self.model.noise_variances.len() {
            0 | 1 => String::new(),
            _ => format!("_of_group_{}", self.group),
        };
        let has_known = self.model.observations.known_variances.iter().any(|known| *known > 0.0);
        group + if has_known { "_without_known_noise" } else { "" }
    }

    /// Writes rows and predictions as CSV to `path`, whole or not at all.
    ///
    /// # Errors
    /// [`DesignError::File`] where it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), DesignError> {
        let output = &self.model.output;
        let unit =
            if output.unit.is_empty() { String::new() } else { format!(" [{}]", output.unit) };
        let mut text = String::new();
        for column in &self.samples.columns {
            let unit =
                if column.unit.is_empty() { String::new() } else { format!(" [{}]", column.unit) };
            text += &format!("{}{unit},", column.name);
        }
        text += &format!("{}{unit}", output.name);
        if !self.deviations.is_empty() {
            let held = self.held();
            text +=
                &format!(",{0}_deviation{unit},{0}_observation_deviation{held}{unit}", output.name);
        }
        text.push('\n');
        for (row, mean) in self.means.iter().enumerate() {
            self.samples.row(row).iter().for_each(|value| text += &format!("{value},"));
            text += &format!("{mean}");
            if let Some([curve, observation]) = self.deviations.get(row) {
                text += &format!(",{curve},{observation}");
            }
            text.push('\n');
        }
        Ok(formats::atomic::write(path, "predictions", text.as_bytes())?)
    }
}
