//! Between a regression and its file.

use crate::DesignError;
use formats::FileError;
use formats::linear_model::Port;
use formats::surrogate_model::{StoredObservations, StoredPart, StoredTerm, SurrogateModel};
use formats::table::Column;
use std::path::Path;
use surrogate::{
    Collapsed, Kernel, MeanCurve, Parameters, Part, Regression, RegressionSettings, Shape, Term,
    Trend,
};

/// Names of shapes in files.
const SHAPES: [(&str, Shape); 5] = [
    ("squared-exponential", Shape::SquaredExponential),
    ("matern32", Shape::Matern32),
    ("matern52", Shape::Matern52),
    ("rational-quadratic", Shape::RationalQuadratic { exponent: 1.0 }),
    ("periodic", Shape::Periodic { period: 1.0 }),
];
/// Names of trends in files.
const TRENDS: [(&str, Trend); 3] =
    [("zero", Trend::Zero), ("constant", Trend::Constant), ("linear", Trend::Linear)];

/// Name and unit of a column.
pub(super) fn port(column: &Column) -> Port {
    Port { name: column.name.clone(), unit: column.unit.clone() }
}

fn rows(flat: &[f64], n_inputs: usize) -> Vec<Vec<f64>> {
    flat.chunks(n_inputs).map(<[f64]>::to_vec).collect()
}

fn stored_part(part: &Part) -> StoredPart {
    let is_one =
        |shape: Shape| std::mem::discriminant(&shape) == std::mem::discriminant(&part.shape);
    let name = SHAPES.iter().find(|(_, shape)| is_one(*shape)).map_or("", |(name, _)| name);
    let (exponent, period) = match part.shape {
        Shape::RationalQuadratic { exponent } => (Some(exponent), None),
        Shape::Periodic { period } => (None, Some(period)),
        _ => (None, None),
    };
    let (inputs, lengths) = (part.inputs.clone(), part.lengths.clone());
    StoredPart { shape: name.to_owned(), inputs, lengths, exponent, period }
}

/// The file's model of `found`, inputs and output of these `ports`.
pub(super) fn model(
    description: String,
    ports: [Vec<Port>; 2],
    found: &Regression,
) -> SurrogateModel {
    let [inputs, output] = ports;
    let n_inputs = inputs.len();
    let terms = found.parameters().kernel.terms.iter().map(|term| StoredTerm {
        variance: term.variance,
        parts: term.parts.iter().map(stored_part).collect(),
    });
    let of = found.collapsed();
    let range = |input: usize| {
        let column = of.inputs.iter().skip(input).step_by(n_inputs);
        let ends = [f64::INFINITY, f64::NEG_INFINITY];
        column.fold(ends, |[low, high], x| [low.min(*x), high.max(*x)])
    };
    let ranges = (0..n_inputs).map(range).collect();
    let (points, weights) = found.weighted_points();
    let observations = StoredObservations {
        inputs: found.sparse().map(|_| rows(&of.inputs, n_inputs)),
        values: of.values,
        counts: of.counts,
        within: of.within,
        known_variances: of.known,
        groups: of.groups,
    };
    let output =
        output.into_iter().next().unwrap_or(Port { name: String::new(), unit: String::new() });
    let mut model = SurrogateModel::new(description, output, (terms.collect(), observations));
    let trend = TRENDS.iter().find(|(_, trend)| *trend == found.trend());
    model.trend = trend.map_or("", |(name, _)| name).to_owned();
    (model.inputs, model.ranges) = (inputs, ranges);
    model.coefficients = found.coefficients().to_vec();
    model.noise_variances = found.parameters().noise.clone();
    model.log_marginal_likelihood = found.log_marginal_likelihood();
    model.jitter = found.jitter();
    model.n_inducing = found.sparse().map(|sparse| sparse.n_points);
    (model.points, model.weights) = (rows(&points, n_inputs), weights.to_vec());
    model
}

/// What stands in the file at `path` where something else should.
fn refused(path: &Path, problem: String) -> DesignError {
    let fix = "write it again with `wakemix surrogate train`";
    FileError::content("a surrogate", path, problem, fix).into()
}

fn part(stored: &StoredPart, path: &Path) -> Result<Part, DesignError> {
    let asks = |what: &str| {
        refused(path, format!("a part of shape \"{}\" lacks its `{what}`", stored.shape))
    };
    let found = SHAPES.iter().find(|(name, _)| *name == stored.shape);
    let shape = match found.map(|(_, shape)| *shape) {
        Some(Shape::Periodic { .. }) => {
            Shape::Periodic { period: stored.period.ok_or_else(|| asks("period"))? }
        }
        Some(Shape::RationalQuadratic { .. }) => {
            Shape::RationalQuadratic { exponent: stored.exponent.ok_or_else(|| asks("exponent"))? }
        }
        Some(shape) => shape,
        None => return Err(refused(path, format!("\"{}\" is no shape of a kernel", stored.shape))),
    };
    Ok(Part { shape, inputs: stored.inputs.clone(), lengths: stored.lengths.clone() })
}

/// Hyperparameters of the `model` that was read from `path`.
pub(super) fn parameters(model: &SurrogateModel, path: &Path) -> Result<Parameters, DesignError> {
    let term = |term: &StoredTerm| {
        let parts = term.parts.iter().map(|stored| part(stored, path)).collect::<Result<_, _>>()?;
        Ok(Term { variance: term.variance, parts })
    };
    let terms = model.kernel.iter().map(term).collect::<Result<_, DesignError>>()?;
    Ok(Parameters { kernel: Kernel { terms }, noise: model.noise_variances.clone() })
}

/// The mean curve alone.
pub(super) fn mean_curve(model: &SurrogateModel, path: &Path) -> Result<MeanCurve, DesignError> {
    let kernel = parameters(model, path)?.kernel;
    kernel.check(model.inputs.len()).map_err(|error| refused(path, error.to_string()))?;
    let (points, weights) = (model.points.concat(), model.weights.clone());
    Ok(MeanCurve::new(kernel, model.inputs.len(), &points, weights, model.coefficients.clone()))
}

/// The regression, its covariance factorised again.
pub(crate) fn regression(model: &SurrogateModel, path: &Path) -> Result<Regression, DesignError> {
    let of = &model.observations;
    let collapsed = Collapsed {
        inputs: of.inputs.as_ref().unwrap_or(&model.points).concat(),
        values: of.values.clone(),
        counts: of.counts.clone(),
        within: of.within.clone(),
        known: of.known_variances.clone(),
        groups: of.groups.clone(),
    };
    let trend = TRENDS.iter().find(|(name, _)| *name == model.trend);
    let trend = trend.map(|(_, trend)| *trend);
    let trend = trend.ok_or_else(|| refused(path, format!("\"{}\" is no trend", model.trend)))?;
    let mut settings = RegressionSettings { trend, ..RegressionSettings::default() };
    (settings.exact_up_to, settings.n_inducing) = match model.n_inducing {
        Some(n_inducing) => (0, n_inducing),
        None => (usize::MAX, 0),
    };
    let parameters = parameters(model, path)?;
    Regression::restore(&parameters, &collapsed, &settings)
        .map_err(|source| DesignError::Surrogate { path: path.to_owned(), source })
}
