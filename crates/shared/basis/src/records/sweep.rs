//! What a sweep is made of: keys, the studies and runs that their values make, and what came of each.

use super::Statistic;
use serde::{Deserialize, Serialize};

/// Version of the layout of [`Sweep`].
///
/// 2: the gains in each wind name their study and seed.
pub const SWEEP_SCHEMA_VERSION: u32 = 2;

/// What is swept: every combination of values has its study and run. `sweep.json` is this, written out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// [`SWEEP_SCHEMA_VERSION`] of the writer.
    pub schema_version: u32,
    /// Name of the case.
    pub case: String,
    /// The swept keys, in the order of the case file; the last one changes fastest.
    pub keys: Vec<SweptKey>,
    /// The studies, each with a wind, a layout and a flow of its own.
    pub studies: Vec<SweptStudy>,
    /// The runs of every study.
    pub runs: Vec<SweptRun>,
}

/// One swept key.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SweptKey {
    /// The key as the case file names it, such as `control.T1.strouhal`.
    pub key: String,
    /// As much of its end as tells it from the others, such as `strouhal`; names of studies and runs hold it.
    pub label: String,
    /// Whether its values make studies, not runs of one study.
    pub of_studies: bool,
}

/// A study of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweptStudy {
    /// Its folder in that of the sweep; empty where that is the study's own.
    pub folder: String,
    /// The values of the keys that make studies.
    pub settings: Vec<Setting>,
}

/// A run of each of a sweep's studies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweptRun {
    /// Its name.
    pub run: String,
    /// Name of the run of the case file that it was made from.
    pub base: String,
    /// The values of the keys that it was made with; none for a run that no swept key is about.
    pub settings: Vec<Setting>,
}

/// A value of a swept key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// The key.
    pub key: String,
    /// Its value, in the unit of the case file.
    pub value: SweptValue,
}

/// What a swept key holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SweptValue {
    /// A whole number.
    Whole(i64),
    /// A number.
    Number(f64),
    /// A text or word.
    Text(String),
    /// Several numbers.
    Numbers(Vec<f64>),
}

impl SweptValue {
    /// The number, where it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Whole(number) => Some(*number as f64),
            Self::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// As it stands in a table or in a name: the fewest digits that tell it.
    pub fn words(&self) -> String {
        match self {
            Self::Whole(number) => number.to_string(),
            Self::Number(number) => shortest(*number),
            Self::Text(text) => text.clone(),
            Self::Numbers(numbers) => {
                numbers.iter().map(|number| shortest(*number)).collect::<Vec<_>>().join("-")
            }
        }
    }
}

/// `number` with the fewest digits that tell it, with an exponent where it is far from one.
fn shortest(number: f64) -> String {
    let digits = format!("{number:?}");
    digits.strip_suffix(".0").map_or(digits.clone(), str::to_owned)
}

/// What came of a sweep: a row for each run, all winds together that differ in their seed alone.
/// `table.json` is this, written out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepTable {
    /// [`SWEEP_SCHEMA_VERSION`] of the writer.
    pub schema_version: u32,
    /// Name of the case.
    pub case: String,
    /// The swept keys but for the seed of the wind.
    pub keys: Vec<SweptKey>,
    /// Seeds of the wind, where they are swept.
    pub seeds: Vec<u64>,
    /// Whether the wind holds wakes, so that powers add up to something.
    pub has_wakes: bool,
    /// The rows.
    pub rows: Vec<SweepRow>,
    /// What a reader of the numbers must know, in sentences.
    pub remarks: Vec<String>,
}

/// A run of a sweep, in every wind that it met.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepRow {
    /// Name of the run.
    pub run: String,
    /// Name of the run of the case file that it was made from.
    pub base: String,
    /// Run that its gains compare with, in the same wind.
    pub compare_with: Option<String>,
    /// Values of the swept keys but for the seed.
    pub settings: Vec<Setting>,
    /// Folders of its studies in that of the sweep, one for each wind.
    pub studies: Vec<String>,
    /// Seeds of these winds.
    pub seeds: Vec<u64>,
    /// Of each turbine, of those downstream together, and of all.
    pub parts: Vec<SweepPart>,
}

/// What came of one turbine, or of several together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepPart {
    /// Name of the turbine; `downstream` or `all` for several.
    pub name: String,
    /// Electrical power (W): with one wind over its blocks, with several over the means in each.
    pub power: Statistic,
    /// Its gain over the compared run in the same wind (–), with an interval from blocks or, with several
    /// winds, from them.
    pub gain: Option<Statistic>,
    /// The gain in each wind; empty with one.
    pub gains: Vec<WindGain>,
    /// Damage-equivalent loads of a turbine, by channel; none of several together.
    pub loads: Vec<SweepLoad>,
}

/// A gain in one wind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindGain {
    /// Folder of the study in that of the sweep.
    pub study: String,
    /// Seed of the wind.
    pub seed: u64,
    /// Gain of the mean power over that of the compared run (–).
    pub gain: f64,
}

/// A damage-equivalent load of a turbine in a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepLoad {
    /// Channel.
    pub channel: String,
    /// Unit of the load.
    pub unit: String,
    /// Slope of the Wöhler line (–).
    pub slope: f64,
    /// The load, in its unit; over the winds where there are several.
    pub value: Statistic,
    /// Its change against the compared run in the same wind (–), with an interval as for the gain.
    pub change: Option<Statistic>,
}

impl SweepTable {
    /// Names of the turbines, in the order of the rows, and of all together behind them where there is such a
    /// thing.
    pub fn part_names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for part in self.rows.iter().flat_map(|row| &row.parts) {
            if !names.contains(&part.name.as_str()) {
                names.push(&part.name);
            }
        }
        names.sort_by_key(|name| *name == "all");
        names
    }
}

impl SweepRow {
    /// The value of `key`.
    pub fn value(&self, key: &str) -> Option<&SweptValue> {
        self.settings.iter().find(|setting| setting.key == key).map(|setting| &setting.value)
    }

    /// The damage-equivalent load of `channel` of the turbine called `turbine`.
    pub fn load(&self, turbine: &str, channel: &str) -> Option<&SweepLoad> {
        self.part(turbine)?.loads.iter().find(|load| load.channel == channel)
    }

    /// What came of the turbine, or of those together, called `name`.
    pub fn part(&self, name: &str) -> Option<&SweepPart> {
        self.parts.iter().find(|part| part.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_the_fewest_digits_that_tell_them() {
        let numbers = SweptValue::Numbers(vec![5.0, -0.5]);
        let values =
            [SweptValue::Whole(3), SweptValue::Number(0.25), SweptValue::Number(3.0), numbers];
        assert_eq!(values.map(|value| value.words()), ["3", "0.25", "3", "5--0.5"]);
        assert_eq!(SweptValue::Number(1e308).words(), "1e308");
    }
}
