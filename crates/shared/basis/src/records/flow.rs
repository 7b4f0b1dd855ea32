//! What moved the air of a run, and what of it met a rotor.

use serde::{Deserialize, Serialize};

/// What moved the air.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FlowSummary {
    /// Name of the flow solver, the word of `flow.solver`.
    pub solver: String,
    /// Whether its wind holds the rotors' wakes, so that turbines feel one another.
    pub has_wakes: bool,
    /// What it cannot show, in sentences; empty where nothing is said of it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub limits: String,
    /// The grid of the domain and those of all boxes of finer cells, each before those in it; none where all
    /// cells are alike.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub grids: Vec<GridSummary>,
}

/// Cells of one size.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GridSummary {
    /// Corner with the least coordinates, farm frame (m).
    pub origin: [f64; 3],
    /// Extent along x, y, z (m).
    pub size: [f64; 3],
    /// Edge of a cell (m).
    pub spacing: f64,
    /// Cells, those beneath boxes included (–).
    pub n_cells: u64,
}

/// The wind on a quarter of a rotor's disc.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sector {
    /// Which quarter: `up`, `right`, `down` or `left`, looking downwind.
    pub name: String,
    /// Mean of the wind along the axis of the planes over the quarter (m/s).
    pub wind_speed: f64,
    /// Turbulence intensity over the quarter, of the free stream and not of this wind (–).
    pub turbulence_intensity: f64,
}
