//! A surrogate beside what came true.

use super::pairs::{Columns, Held, Pairs, held};
use super::predict::outside;
use super::stored::regression;
use crate::DesignError;
use formats::surrogate_model::SurrogateModel;
use formats::table::Samples;
use std::path::PathBuf;
use surrogate::{LeaveOneOut, Validation};

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
    /// True and predicted values of the table's different inputs; where the coverage is not told, their
    /// deviations lack the noise that is not known.
    pub pairs: Vec<LeaveOneOut>,
    /// What a user must know.
    pub warnings: Vec<String>,
}

/// What to hold against what.
#[derive(Clone, Debug, PartialEq)]
pub struct ValidateQuestion {
    /// The surrogate.
    pub model: PathBuf,
    /// CSV with its inputs and its output.
    pub file: PathBuf,
    /// Column with a known standard deviation of each value, in its unit.
    pub deviation: Option<String>,
    /// Column with the number of the noise group of each row.
    pub group: Option<String>,
}

/// Holds a surrogate against a table.
///
/// # Errors
/// [`DesignError`] naming the file and what is wrong with it.
pub fn validate(question: &ValidateQuestion) -> Result<Validated, DesignError> {
    let model = SurrogateModel::read(&question.model)?;
    let found = regression(&model, &question.model)?;
    let ports = model.inputs.iter().chain([&model.output]);
    let further = question.deviation.iter().chain(&question.group).map(|name| name.trim());
    let names: Vec<&str> = ports.map(|port| port.name.as_str()).chain(further).collect();
    let samples = Samples::read(&question.file, &names)?;
    let rows: Vec<usize> = (0..samples.lines.len()).collect();
    let noise = Columns::new(&samples, model.inputs.len(), &question.deviation, &question.group)?;
    let table =
        Pairs { samples: &samples, rows: &rows, n_inputs: model.inputs.len(), noise: &noise };
    let failed = |source| DesignError::Surrogate { path: question.model.clone(), source };
    let Held { pairs, validation, unknown } = held(&found, &table).map_err(failed)?;
    let mut warnings = outside(&model, &samples);
    warnings.extend(unknown);
    Ok(Validated {
        n_rows: rows.len(),
        on_table: validation,
        left_out: found.leave_one_out().as_deref().and_then(Validation::of),
        warnings,
        pairs,
        model,
    })
}
