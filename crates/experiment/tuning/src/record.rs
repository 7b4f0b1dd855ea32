//! What was found, as files: numbers for programs, data for tables.

use crate::{Tuned, TuningError};
use formats::atomic;
use search::{History, Normal};
use serde_json::{Value, json};

/// What the files hold, in words.
const WHAT: &str = "what a tuning found";

/// Writes `tuning.json` and `data.csv` of `tuned`, whose `outputs` have these names, into its folder, and
/// what `cheaper` sources gave into theirs.
///
/// # Errors
/// [`TuningError::File`].
pub(crate) fn write(
    tuned: &Tuned,
    cheaper: &[History],
    outputs: &[String],
) -> Result<(), TuningError> {
    for (source, history) in tuned.file.cheaper.iter().zip(cheaper) {
        let path = tuned.directory.join(&source.name).join("data.csv");
        atomic::write(&path, WHAT, csv(tuned, history, outputs).as_bytes())?;
    }
    let history = &tuned.found.history;
    let text = serde_json::to_string_pretty(&tuned.to_json()).expect("plain numbers and texts");
    atomic::write(&tuned.directory.join("tuning.json"), WHAT, (text + "\n").as_bytes())?;
    atomic::write(
        &tuned.directory.join("data.csv"),
        WHAT,
        csv(tuned, history, outputs).as_bytes(),
    )?;
    Ok(())
}

fn normal(normal: &Normal) -> Value {
    json!({
        "mean": normal.mean,
        "standard_deviation": normal.deviation,
        "interval_95": normal.band_95(),
    })
}

impl Tuned {
    /// How alike each cheaper source is found to be: the correlation of its curves with those that are
    /// searched (–); none where it cannot be told.
    pub(crate) fn likenesses(&self) -> Vec<Option<f64>> {
        let sources = 0..self.file.cheaper.len();
        sources.map(|source| self.found.sum.likeness(source).ok()).collect()
    }

    fn cheaper_to_json(&self) -> Value {
        let both = self.file.cheaper.iter().zip(self.likenesses());
        both.map(|(source, likeness)| {
            json!({ "name": source.name, "runs": source.n_runs, "correlation": likeness })
        })
        .collect()
    }

    /// All of it, as `tuning.json` has it; gains over the baseline's array power (–).
    pub fn to_json(&self) -> Value {
        let found = &self.found;
        let named = |point: &[f64]| -> Value {
            let pairs = self.file.variables.iter().zip(point);
            pairs.map(|(variable, value)| (variable.key.clone(), json!(value))).collect()
        };
        let optimum = |optimum: &search::Optimum| {
            let turbines = self.turbines.iter().zip(&optimum.outputs);
            let of_turbine = |(name, value): (&String, &Normal)| (name.clone(), normal(value));
            let places = self.file.variables.iter().zip(&optimum.place_95);
            json!({
                "point": named(&optimum.point),
                "overrides": self.file.overrides(&optimum.point),
                "gain": normal(&optimum.value),
                "turbines": turbines.map(of_turbine).collect::<Value>(),
                "place_95": places
                    .map(|(variable, ends)| (variable.key.clone(), json!(ends)))
                    .collect::<Value>(),
                "greatest_gain_95": optimum.greatest_95,
            })
        };
        let step = |step: &search::Step| {
            json!({
                "runs": step.n_evaluations,
                "points": step.proposal.points.iter().map(|point| named(point)).collect::<Vec<_>>(),
                "expected_gain": step.proposal.expected_gain,
                "optimum": optimum(&step.optimum),
            })
        };
        let of_compromise = |one: &crate::Compromise| {
            let setting = |(point, gain, load): &(Vec<f64>, Normal, Normal)| {
                let (gain, load) = (normal(gain), normal(load));
                json!({ "point": named(point), "gain": gain, "load_change": load })
            };
            json!({
                "channel": one.channel,
                "exponent": one.exponent,
                "settings": one.settings.iter().map(setting).collect::<Vec<_>>(),
            })
        };
        let places = found
            .optimum
            .places
            .iter()
            .map(|(point, share)| json!({ "point": named(point), "probability": share }));
        json!({
            "format": "wakemix tuning result 1",
            "run": self.file.run,
            "baseline": self.file.baseline,
            "optimum": optimum(&found.optimum),
            "optimum_places": places.collect::<Vec<_>>(),
            "cheaper": self.cheaper_to_json(),
            "shared_deviation": found.sum.shared_deviation(),
            "expected_gain_of_one_more": found.expected_gain,
            "ended_settled": found.is_settled,
            "iterations": found.steps.iter().map(step).collect::<Vec<_>>(),
            "compromises": self.compromises.iter().map(of_compromise).collect::<Vec<_>>(),
        })
    }
}

/// A line for every block of every run in `history`: its number, the variables, the block, then the
/// outputs (–).
fn csv(tuned: &Tuned, history: &History, outputs: &[String]) -> String {
    let variables = tuned.file.variables.iter().map(|variable| variable.key.clone());
    let head: Vec<String> = std::iter::once("point".to_owned())
        .chain(variables)
        .chain(std::iter::once("block".to_owned()))
        .chain(outputs.iter().cloned())
        .collect();
    let mut text = head.join(",") + "\n";
    for (index, (point, evaluation)) in history.points.iter().zip(&history.evaluations).enumerate()
    {
        let n_blocks = evaluation.outputs.iter().map(Vec::len).min().unwrap_or(0);
        for block in 0..n_blocks {
            let values = evaluation.outputs.iter().map(|blocks| blocks[block].to_string());
            let line: Vec<String> = std::iter::once((index + 1).to_string())
                .chain(point.iter().map(f64::to_string))
                .chain(std::iter::once((block + 1).to_string()))
                .chain(values)
                .collect();
            text += &(line.join(",") + "\n");
        }
    }
    text
}
