//! Loads of a turbine, as a summary tells them.

use super::Statistic;
use serde::{Deserialize, Serialize};

/// One figure of one moment of a turbine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Load {
    /// Channel of the series that it is made of, by OpenFAST's name, such as `RootMyb1`.
    pub channel: String,
    /// Unit of the value, such as `kN m`.
    pub unit: String,
    /// What the figure is.
    #[serde(flatten)]
    pub kind: LoadKind,
    /// The figure, in [`unit`](Self::unit).
    pub value: f64,
    /// The figure relative to the same turbine in the compared run, minus one (–); absent where nothing is
    /// compared, and of a load that is zero there.
    pub change: Option<Statistic>,
}

/// What is reported of a moment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum LoadKind {
    /// Standard deviation.
    Deviation,
    /// Damage-equivalent load, as a range from peak to peak: rainflow counting without mean correction.
    DamageEquivalent {
        /// Slope of the Wöhler line (–).
        slope: f64,
        /// How often the equivalent load repeats (Hz).
        reference_frequency_hz: f64,
    },
}

impl LoadKind {
    /// Whether it is a damage-equivalent load.
    pub fn is_damage_equivalent(self) -> bool {
        matches!(self, Self::DamageEquivalent { .. })
    }
}
