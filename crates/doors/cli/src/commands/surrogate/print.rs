//! What `wakemix surrogate` prints: tables and JSON.

use crate::commands::output::columns;
use design::regression::{Trained, Validated};
use design::{SurrogateModel, SurrogateValidation};
use serde_json::json;
use wakemix::report::text_table::{Column, TextTable};

pub(super) fn parameters_text(model: &SurrogateModel) -> String {
    let unit = if model.output.unit.is_empty() { "–" } else { &model.output.unit };
    let mut table = TextTable::new(
        [Column::words("hyperparameter")],
        [Column::number("value"), Column::words("unit")],
    );
    let mut row = |name: String, value: f64, unit: &str| {
        table.row([name, format!("{value:.4e}"), unit.to_owned()]);
    };
    for (number, term) in model.kernel.iter().enumerate() {
        let before =
            if model.kernel.len() > 1 { format!("term {}, ", number + 1) } else { String::new() };
        row(format!("{before}deviation of the curve"), term.variance.sqrt(), unit);
        for part in &term.parts {
            let is_periodic = part.period.is_some();
            for (input, length) in part.inputs.iter().zip(&part.lengths) {
                let port = &model.inputs[*input];
                let unit = if is_periodic || port.unit.is_empty() { "–" } else { &port.unit };
                row(format!("{before}{}: length along {}", part.shape, port.name), *length, unit);
            }
            if let Some(exponent) = part.exponent {
                row(format!("{before}{}: exponent", part.shape), exponent, "–");
            }
        }
    }
    for (group, variance) in model.noise_variances.iter().enumerate() {
        let of = if model.noise_variances.len() > 1 {
            format!(" of group {group}")
        } else {
            String::new()
        };
        row(format!("deviation of the noise{of}"), variance.sqrt(), unit);
    }
    for (index, coefficient) in model.coefficients.iter().enumerate() {
        match index.checked_sub(1).map(|input| &model.inputs[input]) {
            None => row("constant of the trend".to_owned(), *coefficient, unit),
            Some(port) => {
                let over = if port.unit.is_empty() {
                    unit.to_owned()
                } else {
                    format!("{unit}/{}", port.unit)
                };
                row(format!("slope of the trend along {}", port.name), *coefficient, &over);
            }
        }
    }
    row("log profile likelihood".to_owned(), model.log_marginal_likelihood, "–");
    table.fitted(columns())
}

pub(super) fn parameters_json(model: &SurrogateModel) -> serde_json::Value {
    json!({
        "inputs": model.inputs,
        "output": model.output,
        "trend": model.trend,
        "coefficients": model.coefficients,
        "kernel": model.kernel,
        "noise_variances": model.noise_variances,
        "log_marginal_likelihood": model.log_marginal_likelihood,
        "jitter": model.jitter,
    })
}

pub(super) fn validations_text(rows: &[(&str, Option<SurrogateValidation>)], unit: &str) -> String {
    let unit = if unit.is_empty() { "–" } else { unit };
    let mut table = TextTable::new(
        [Column::words("on")],
        [
            Column::number("inputs"),
            Column::number(format!("RMSE ({unit})")),
            Column::number("RMSPE (%)"),
            Column::number("explained (%)"),
            Column::number("in 95 % band (%)"),
        ],
    );
    for (name, found) in rows.iter().filter_map(|(name, found)| Some((name, (*found)?))) {
        table.row([
            (*name).to_owned(),
            found.n.to_string(),
            format!("{:.4e}", found.root_mean_square),
            format!("{:.2}", found.root_mean_square_percentage),
            format!("{:.1}", 100.0 * found.explained),
            found.covered_95.map_or("–".to_owned(), |found| {
                let [low, high] = found.interval;
                format!("{:.1} ({low:.1} to {high:.1})", found.share)
            }),
        ]);
    }
    table.fitted(columns())
        + "RMSPE: root mean square of the error over the true value; rows of the same inputs count as their mean; in parentheses the 95 % interval of the share (Wilson)\n"
}

/// A row for each of several surrogates of one table, as document 004 has them in its table 4.
pub(super) fn outputs_text(all: &[Trained]) -> String {
    let mut table = TextTable::new(
        [Column::words("output")],
        [
            Column::number("trained on"),
            Column::number("RMSPE (%)"),
            Column::number("kept aside"),
            Column::number("RMSPE (%)"),
            Column::number("explained (%)"),
            Column::number("in 95 % band (%)"),
        ],
    );
    let percentage = |found: Option<SurrogateValidation>| {
        found.map_or(String::new(), |found| format!("{:.2}", found.root_mean_square_percentage))
    };
    for found in all {
        let [_, n_training, n_test] = found.n;
        let covered = found.on_test.and_then(|found| found.covered_95);
        table.row([
            found.model.output.name.clone(),
            n_training.to_string(),
            percentage(found.on_training),
            n_test.to_string(),
            percentage(found.on_test),
            found.on_test.map_or(String::new(), |found| format!("{:.1}", 100.0 * found.explained)),
            covered.map_or(String::new(), |found| {
                let [low, high] = found.interval;
                format!("{:.1} ({low:.1} to {high:.1})", found.share)
            }),
        ]);
    }
    table.fitted(columns())
        + "RMSPE: root mean square of the error over the true value (document 004, Eq. 13); rows of the same inputs count as their mean; explained and band: of what was kept aside\n"
}

fn validation_json(found: Option<SurrogateValidation>) -> serde_json::Value {
    found.map_or(serde_json::Value::Null, |found| {
        json!({
            "n": found.n,
            "rmse": found.root_mean_square,
            "rmspe_pc": found.root_mean_square_percentage,
            "explained": found.explained,
            "covered_95_pc": found.covered_95.map(|found| found.share),
            "covered_95_interval_pc": found.covered_95.map(|found| found.interval),
        })
    })
}

pub(super) fn train_json(found: &Trained) -> serde_json::Value {
    json!({
        "n_rows": found.n[0],
        "n_training": found.n[1],
        "n_test": found.n[2],
        "parameters": parameters_json(&found.model),
        "on_training": validation_json(found.on_training),
        "on_test": validation_json(found.on_test),
        "left_out": validation_json(found.left_out),
        "warnings": found.warnings,
    })
}

pub(super) fn validate_json(found: &Validated) -> serde_json::Value {
    json!({
        "n_rows": found.n_rows,
        "on_table": validation_json(found.on_table),
        "left_out": validation_json(found.left_out),
        "warnings": found.warnings,
    })
}
