//! Surrogates as files: JSON with every number that a prediction takes, which any language reads as it is
//! (`examples/surrogate/predict.py`).

use crate::FileError;
use crate::atomic;
use crate::linear_model::Port;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What the file is, with the version of its form.
const FORMAT: &str = "wakemix surrogate 1";
/// What the file holds, in words.
const WHAT: &str = "a surrogate";

/// A Gaussian process: the mean at x is c₀ + Σ c x + Σ weight × k(x, point), k being a sum of products.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurrogateModel {
    format: String,
    /// What it is, in a line.
    pub description: String,
    /// Inputs, in the order of a point.
    pub inputs: Vec<Port>,
    /// Least and greatest value of each input that it was trained on (unit of the input).
    pub ranges: Vec<[f64; 2]>,
    /// What is predicted.
    pub output: Port,
    /// `zero`, `constant` or `linear`.
    pub trend: String,
    /// c₀ and c of the trend; as many as it has (unit of the output, and that over the input's).
    pub coefficients: Vec<f64>,
    /// Summands of the kernel.
    pub kernel: Vec<StoredTerm>,
    /// Estimated noise variance of each group (unit of the output, squared).
    pub noise_variances: Vec<f64>,
    /// Natural logarithm of the profile likelihood of the data that it was trained on, the trend's
    /// coefficients at their optimum (–); without a trend it is the marginal likelihood.
    pub log_marginal_likelihood: f64,
    /// What was added to the diagonal of the covariance so that it could be factorised (unit of the output,
    /// squared).
    pub jitter: f64,
    /// Inducing points that it was made with (–); none where it is exact.
    pub n_inducing: Option<usize>,
    /// Points behind the mean, in the units of the inputs.
    pub points: Vec<Vec<f64>>,
    /// Weight of each (1 over the unit of the output).
    pub weights: Vec<f64>,
    /// What it was trained on.
    pub observations: StoredObservations,
}

/// One summand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredTerm {
    /// Variance (unit of the output, squared).
    pub variance: f64,
    /// Factors.
    pub parts: Vec<StoredPart>,
}

/// One factor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredPart {
    /// `squared-exponential`, `matern32`, `matern52`, `rational-quadratic` or `periodic`.
    pub shape: String,
    /// Inputs that it looks at, the first is 0.
    pub inputs: Vec<usize>,
    /// Length for each (unit of the input; – where periodic).
    pub lengths: Vec<f64>,
    /// Exponent of a rational quadratic (–).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exponent: Option<f64>,
    /// Period of a periodic part (unit of the input).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<f64>,
}

/// Observations at different inputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredObservations {
    /// Inputs; the points themselves where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inputs: Option<Vec<Vec<f64>>>,
    /// Mean of the replicates of each (unit of the output).
    pub values: Vec<f64>,
    /// Replicates (–).
    pub counts: Vec<f64>,
    /// Squares of the replicates about their mean, summed (unit of the output, squared).
    pub within: Vec<f64>,
    /// Known variance of one replicate (unit of the output, squared).
    pub known_variances: Vec<f64>,
    /// Group of noise of each, the first is 0.
    pub groups: Vec<usize>,
}

/// All but what the format says of itself.
pub type Fields = (Vec<StoredTerm>, StoredObservations);

impl SurrogateModel {
    /// A model of its `kernel` and `observations`, all else still empty.
    pub fn new(description: String, output: Port, (kernel, observations): Fields) -> Self {
        Self {
            format: FORMAT.to_owned(),
            description,
            inputs: Vec::new(),
            ranges: Vec::new(),
            output,
            trend: String::new(),
            coefficients: Vec::new(),
            kernel,
            noise_variances: Vec::new(),
            log_marginal_likelihood: 0.0,
            jitter: 0.0,
            n_inducing: None,
            points: Vec::new(),
            weights: Vec::new(),
            observations,
        }
    }

    /// Reads the file at `path`.
    ///
    /// # Errors
    /// [`FileError::System`] where it cannot be read, [`FileError::Content`] with the place where it is none.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let text = atomic::read_text(path, WHAT)?;
        let refused = |problem: String| {
            let fix = "write it again with `wakemix surrogate train`";
            FileError::content(WHAT, path, problem, fix)
        };
        let model: Self =
            serde_json::from_str(&text).map_err(|error| refused(error.to_string()))?;
        model.check().map_err(refused)?;
        Ok(model)
    }

    /// Writes the file at `path`, whole or not at all.
    ///
    /// # Errors
    /// [`FileError::System`] where it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        let text = serde_json::to_string(self).expect("plain numbers and texts");
        atomic::write(path, WHAT, (text + "\n").as_bytes())
    }

    /// # Errors
    /// What of it does not fit, in words.
    fn check(&self) -> Result<(), String> {
        if self.format != FORMAT {
            return Err(format!("`format` is \"{}\" where \"{FORMAT}\" is expected", self.format));
        }
        let n_inputs = self.inputs.len();
        if n_inputs == 0 {
            return Err("`inputs` is empty".to_owned());
        }
        let observed = self.observations.inputs.as_ref().unwrap_or(&self.points);
        let rows = self.points.iter().chain(observed);
        if rows.into_iter().any(|row| row.len() != n_inputs) {
            return Err(format!("a point has not {n_inputs} numbers, as `inputs` asks for"));
        }
        let of = &self.observations;
        let lists = [&of.values, &of.counts, &of.within, &of.known_variances];
        if lists.iter().any(|list| list.len() != observed.len())
            || of.groups.len() != observed.len()
        {
            return Err("the lists of `observations` are not of one length".to_owned());
        }
        if self.weights.len() != self.points.len() || self.ranges.len() != n_inputs {
            return Err("`weights` or `ranges` has not a number for each point or input".to_owned());
        }
        if self.coefficients.len() > 1 + n_inputs {
            return Err("`coefficients` has more numbers than a trend".to_owned());
        }
        let numbers = self.points.iter().chain(observed).flatten().chain(&self.weights);
        let numbers = numbers.chain(lists.into_iter().flatten()).chain(&self.coefficients);
        if numbers.chain(&self.noise_variances).any(|value| !value.is_finite()) {
            return Err("it holds what is not a finite number".to_owned());
        }
        Ok(())
    }
}
