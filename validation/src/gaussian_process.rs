//! Gaussian-process regression beside scikit-learn's.

use crate::Row;
use crate::folds::worst;
use crate::row::Tolerance::AtMost;
use serde::Deserialize;
use surrogate::{
    Kernel, NoiseGroups, Observations, Parameters, Part, Regression, RegressionSettings, Shape,
    Term, Trend,
};

const SCIKIT_LEARN: &str = "scikit-learn 1.9.1";
const BEST_OF_TEN: &str = "scikit-learn 1.9.1, best of ten starts";

/// What `validation/scripts/gaussian_process_regressions.py` found.
const REGRESSIONS: &str = include_str!("../data/surrogate/regressions.json");

#[derive(Deserialize)]
struct Regressions {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    name: String,
    terms: Vec<TermOfCase>,
    noise: f64,
    inputs: Vec<f64>,
    values: Vec<f64>,
    known: Vec<f64>,
    points: Vec<f64>,
    log: f64,
    means: Vec<f64>,
    variances: Vec<f64>,
    best_log: f64,
}

#[derive(Deserialize)]
struct TermOfCase {
    variance: f64,
    parts: Vec<PartOfCase>,
}

#[derive(Deserialize)]
struct PartOfCase {
    shape: String,
    lengths: Vec<f64>,
    period: Option<f64>,
    exponent: Option<f64>,
}

impl PartOfCase {
    fn part(&self) -> Part {
        let shape = match self.shape.as_str() {
            "periodic" => Shape::Periodic { period: self.period.expect("a period") },
            "rational-quadratic" => {
                Shape::RationalQuadratic { exponent: self.exponent.expect("an exponent") }
            }
            "matern-32" => Shape::Matern32,
            "matern-52" => Shape::Matern52,
            _ => Shape::SquaredExponential,
        };
        let inputs = (0..self.lengths.len()).collect();
        Part { shape, inputs, lengths: self.lengths.clone() }
    }
}

impl Case {
    fn kernel(&self) -> Kernel {
        let term = |term: &TermOfCase| Term {
            variance: term.variance,
            parts: term.parts.iter().map(PartOfCase::part).collect(),
        };
        Kernel { terms: self.terms.iter().map(term).collect() }
    }

    fn observations(&self) -> Observations {
        Observations {
            inputs: self.inputs.clone(),
            n_dimensions: self.inputs.len() / self.values.len(),
            values: self.values.clone(),
            variances: self.known.clone(),
        }
    }
}

/// Posterior and likelihood, without a trend the marginal one, at given hyperparameters, and the best
/// likelihood found, on ten data sets.
///
/// # Panics
/// When the stored data sets cannot be read or used.
pub fn gaussian_process() -> Vec<Row> {
    let Regressions { cases } = serde_json::from_str(REGRESSIONS).expect("stored data sets");
    let settings = RegressionSettings {
        trend: Trend::Zero,
        noise: NoiseGroups::One,
        ..RegressionSettings::default()
    };
    let fixed = |case: &Case| {
        let parameters = Parameters { kernel: case.kernel(), noise: vec![case.noise] };
        Regression::new(&parameters, &case.observations(), &settings).expect("stored data")
    };
    let given: Vec<(&Case, Regression)> = cases.iter().map(|case| (case, fixed(case))).collect();
    let row = |what: String, measured, expected, unit, source| Row {
        what,
        measured,
        expected,
        tolerance: AtMost,
        unit,
        source,
    };
    let apart = |of: &dyn Fn(&Case, &Regression) -> Vec<f64>| {
        worst(given.iter().flat_map(|(case, found)| of(case, found)).map(f64::abs))
    };
    let means = apart(&|case, found| {
        let own = found.means(&case.points).expect("stored points");
        own.iter().zip(&case.means).map(|(own, other)| own - other).collect()
    });
    let variances = apart(&|case, found| {
        let own = found.predict(&case.points, 0).expect("stored points");
        let variance = own.iter().map(|own| own.standard_deviation.powi(2));
        variance.zip(&case.variances).map(|(own, other)| own - other).collect()
    });
    let logs = apart(&|case, found| vec![found.log_marginal_likelihood() - case.log]);
    let at =
        |what: &str| format!("ten data sets, given hyperparameters: largest difference of {what}");
    let mut rows = vec![
        row(at("a posterior mean"), means, 1e-8, "unit of the values", SCIKIT_LEARN),
        row(at("a posterior variance"), variances, 1e-8, "their square", SCIKIT_LEARN),
        row(at("the log marginal likelihood"), logs, 1e-6, "–", SCIKIT_LEARN),
    ];
    rows.extend(cases.iter().map(|case| {
        let found = Regression::fit(&case.kernel(), &case.observations(), &settings);
        let own = found.expect("stored data").log_marginal_likelihood();
        let what = format!("{}: best log marginal likelihood, below", case.name);
        row(what, case.best_log - own, 1e-4, "–", BEST_OF_TEN)
    }));
    rows
}
