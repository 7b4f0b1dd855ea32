//! What a folder keeps of a tuning beside its runs: the points, round by round.

use crate::TuningFile;
use serde::{Deserialize, Serialize};

/// The file's form.
const FORMAT: &str = "wakemix tuning 1";

/// The points of a tuning.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rounds {
    format: String,
    run: String,
    baseline: String,
    pub(crate) variables: Vec<Key>,
    pub(crate) rounds: Vec<Round>,
}

/// A variable as it was when the tuning began.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Key {
    pub(crate) key: String,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

/// Points that were proposed together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Round {
    pub(crate) points: Vec<Vec<f64>>,
    pub(crate) expected_gain: Option<f64>,
}

impl Rounds {
    /// Nothing proposed yet of what `file` asks for.
    pub(crate) fn new(file: &TuningFile) -> Self {
        let variables = file.variables.iter().map(|variable| Key {
            key: variable.key.clone(),
            from: variable.axis.from,
            to: variable.axis.to,
        });
        Self {
            format: FORMAT.to_owned(),
            run: file.run.clone(),
            baseline: file.baseline.clone(),
            variables: variables.collect(),
            rounds: Vec::new(),
        }
    }

    /// What of it is not as in `before`, with both.
    pub(crate) fn differs(&self, before: &Self) -> Option<(&'static str, String, String)> {
        let words = |keys: &[Key]| {
            let one = |key: &Key| format!("{} from {} to {}", key.key, key.from, key.to);
            keys.iter().map(one).collect::<Vec<_>>().join(" and ")
        };
        let parts = [
            ("form", before.format.clone(), self.format.clone()),
            ("run", before.run.clone(), self.run.clone()),
            ("baseline", before.baseline.clone(), self.baseline.clone()),
            ("variable", words(&before.variables), words(&self.variables)),
        ];
        parts.into_iter().find(|(_, before, now)| before != now)
    }
}
