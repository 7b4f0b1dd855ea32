//! What controlled a turbine, as a summary tells it.

use crate::Sense;
use serde::{Deserialize, Serialize};

/// What ran on a turbine, what it was set to do and what it found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ControlSummary {
    /// Kind, as the case file names it: `baseline`, `helix`, `pulse`, `phase-sync`, `meandering`, or one of
    /// your own.
    pub kind: String,
    /// The same with its settings in words, for people: `helix ccw 4.0° St 0.25`.
    pub description: String,
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
            excitation: None,
            findings: Vec::new(),
        }
    }

    /// Whether `self` was set to do what `other` was; what they found may differ.
    pub fn is_set_as(&self, other: &Self) -> bool {
        self.kind == other.kind
            && self.description == other.description
            && self.excitation == other.excitation
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
