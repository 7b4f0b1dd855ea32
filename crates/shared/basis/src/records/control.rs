//! What controlled a turbine, as a summary tells it.

use crate::Sense;
use crate::keys::{Value, Values};
use serde::{Deserialize, Serialize};

/// What ran on a turbine, what it was set to do and what it found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ControlSummary {
    /// Kind, as the case file names it: `baseline`, `helix`, `pulse`, `phase-sync`, `meandering`, `steering`,
    /// `derate`, or one of your own.
    pub kind: String,
    /// The same with its settings in words, for people: `helix ccw 4.0° St 0.25`.
    pub description: String,
    /// What it was set to, key by key as in the case file, defaults included; absent in records that do not
    /// tell.
    #[serde(default)]
    pub settings: Option<Vec<ControlSetting>>,
    /// Periodic pitch that it was set to add; absent where it adds none, or none of constant amplitude.
    pub excitation: Option<PitchExcitation>,
    /// What it found or reached, in its own terms.
    pub findings: Vec<Finding>,
}

impl ControlSummary {
    /// A controller of this `kind`, called `description` in words, that adds no periodic pitch and has
    /// nothing to tell.
    pub fn plain(kind: &str, description: &str) -> Self {
        Self {
            kind: kind.to_owned(),
            description: description.to_owned(),
            settings: None,
            excitation: None,
            findings: Vec::new(),
        }
    }

    /// Whether `self` was set to do what `other` was; what they found may differ. Records that do not tell
    /// the settings are compared by their descriptions, which are rounded.
    pub fn is_set_as(&self, other: &Self) -> bool {
        let same_settings = match (&self.settings, &other.settings) {
            (Some(own), Some(others)) => own == others,
            _ => self.description == other.description,
        };
        self.kind == other.kind && same_settings && self.excitation == other.excitation
    }
}

/// A key of a controller in the case file with what it held.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ControlSetting {
    /// The key, with its unit where it is not SI: `amplitude_deg`.
    pub key: String,
    /// What it held, in the key's unit.
    pub value: SettingValue,
}

impl ControlSetting {
    /// All `values`, in their order.
    pub fn all(values: &Values) -> Vec<Self> {
        let setting = |(key, value): (&str, &Value)| Self {
            key: key.to_owned(),
            value: SettingValue::from(value),
        };
        values.iter().map(setting).collect()
    }
}

/// What a key held.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SettingValue {
    /// A number.
    Number(f64),
    /// A text or a word.
    Text(String),
    /// Several numbers.
    Numbers(Vec<f64>),
    /// Several names.
    Names(Vec<String>),
    /// The keys of a table.
    Table(Vec<ControlSetting>),
    /// The keys of each of several tables.
    Tables(Vec<Vec<ControlSetting>>),
}

impl From<&Value> for SettingValue {
    fn from(value: &Value) -> Self {
        match value {
            Value::Number(number) => Self::Number(*number),
            Value::Whole(number) => Self::Number(*number as f64),
            Value::Text(text) => Self::Text(text.clone()),
            Value::Numbers(numbers) => Self::Numbers(numbers.clone()),
            Value::Names(names) => Self::Names(names.clone()),
            Value::Table(values) => Self::Table(ControlSetting::all(values)),
            Value::Tables(tables) => Self::Tables(tables.iter().map(ControlSetting::all).collect()),
        }
    }
}

/// Periodic pitch of constant amplitude and frequency, as a controller was set to add it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PitchExcitation {
    /// Sense of the helix; absent where all blades pitch together.
    pub sense: Option<Sense>,
    /// Amplitude of each blade's pitch (deg).
    pub amplitude_deg: f64,
    /// Strouhal number f D / U with the target wind speed and the first turbine's rotor diameter (–).
    pub strouhal: f64,
    /// Lead of the pitch over the helix in the wind that comes in (deg); absent where it follows none.
    pub phase_offset_deg: Option<f64>,
    /// Time at which it fades in (s).
    pub start: f64,
    /// Time at which it fades out (s); absent where it never does.
    pub stop: Option<f64>,
}

/// Something that a controller found or reached: a number with its unit, or a remark alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// Name, in kebab case, such as `locked-share`.
    pub name: String,
    /// Value, in [`unit`](Self::unit); absent where there was nothing to find.
    pub value: Option<f64>,
    /// Unit of the value, `–` of a ratio.
    pub unit: String,
    /// What it is, in words.
    pub about: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn controllers_that_are_described_alike_are_told_apart_by_their_settings() {
        let set = |factor: f64| {
            let mut values = Values::default();
            values.set("factor", factor);
            values.set("sense", "cw");
            ControlSummary {
                settings: Some(ControlSetting::all(&values)),
                ..ControlSummary::plain("meandering", "meandering × 1.5 cw")
            }
        };
        assert!(set(1.5).is_set_as(&set(1.5)));
        assert!(!set(1.5).is_set_as(&set(1.501)));
        // Of an older record nothing but its words is known.
        let older = ControlSummary { settings: None, ..set(1.5) };
        assert!(older.is_set_as(&set(1.501)) && set(1.501).is_set_as(&older));
        let other =
            ControlSummary { description: "meandering × 2.0 cw".to_owned(), ..older.clone() };
        assert!(!older.is_set_as(&other));
    }
}
