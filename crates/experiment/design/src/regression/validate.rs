//! A surrogate beside what came true.

use super::predict::outside;
use super::stored::regression;
use crate::DesignError;
use formats::surrogate_model::SurrogateModel;
use formats::table::Samples;
use std::collections::BTreeMap;
use std::path::Path;
use surrogate::{LeaveOneOut, Regression, SurrogateError, Validation};

/// A surrogate held against a table.
#[derive(Clone, Debug)]
pub struct Validated {
    /// The surrogate.
    pub model: SurrogateModel,
    /// Rows of the table (–).
    pub n_rows: usize,
    /// On the table, rows of the same inputs as one.
    pub on_table: Option<Validation>,
    /// On what it was trained on, each input predicted from all others; none through inducing points.
    pub left_out: Option<Validation>,
    /// True and predicted values of the table's different inputs.
    pub pairs: Vec<LeaveOneOut>,
    /// What a user must know.
    pub warnings: Vec<String>,
}

/// Rows of a table: inputs first, then the output.
pub(super) struct Pairs<'a> {
    pub(super) samples: &'a Samples,
    pub(super) rows: &'a [usize],
    pub(super) n_inputs: usize,
}

/// Means of the output at the different inputs of `table` beside what `found` says of them. The noise is
/// that of the first group.
pub(super) fn pairs(found: &Regression, table: &Pairs) -> Result<Vec<LeaveOneOut>, SurrogateError> {
    let mut place_of: BTreeMap<Vec<u64>, usize> = BTreeMap::new();
    let (mut inputs, mut values) = (Vec::new(), Vec::<Vec<f64>>::new());
    for row in table.rows {
        let (input, rest) = table.samples.row(*row).split_at(table.n_inputs);
        let key = input.iter().map(|x| (x + 0.0).to_bits()).collect();
        let place = *place_of.entry(key).or_insert(values.len());
        if place == values.len() {
            inputs.extend_from_slice(input);
            values.push(Vec::new());
        }
        values[place].push(rest[0]);
    }
    let noise = found.parameters().noise.first().copied().unwrap_or(0.0);
    let predictions = found.predict(&inputs, 0)?;
    let pair = |(values, prediction): (&Vec<f64>, surrogate::Prediction)| {
        let n = values.len() as f64;
        let variance = prediction.standard_deviation.powi(2) + noise / n;
        LeaveOneOut {
            value: values.iter().sum::<f64>() / n,
            mean: prediction.mean,
            standard_deviation: variance.sqrt(),
        }
    };
    Ok(values.iter().zip(predictions).map(pair).collect())
}

/// Holds the surrogate in `model` against the table in `file`.
///
/// # Errors
/// [`DesignError`] naming the file and what is wrong with it.
pub fn validate(model_file: &Path, file: &Path) -> Result<Validated, DesignError> {
    let model = SurrogateModel::read(model_file)?;
    let found = regression(&model, model_file)?;
    let ports = model.inputs.iter().chain([&model.output]);
    let names: Vec<&str> = ports.map(|port| port.name.as_str()).collect();
    let samples = Samples::read(file, &names)?;
    let rows: Vec<usize> = (0..samples.lines.len()).collect();
    let table = Pairs { samples: &samples, rows: &rows, n_inputs: model.inputs.len() };
    let failed = |source| DesignError::Surrogate { path: model_file.to_owned(), source };
    let pairs = pairs(&found, &table).map_err(failed)?;
    Ok(Validated {
        n_rows: rows.len(),
        on_table: Validation::of(&pairs),
        left_out: found.leave_one_out().as_deref().and_then(Validation::of),
        warnings: outside(&model, &samples),
        pairs,
        model,
    })
}
