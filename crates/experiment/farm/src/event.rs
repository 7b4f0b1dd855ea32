//! What happens in time in the wind of a case.

use control::Sense;
use flow::inflow::deterministic::Change;
use serde::{Deserialize, Serialize};

/// What happens in time in a wind without turbulence. Times in s since the run's start.
///
/// It is the [`deterministic::Event`](flow::inflow::deterministic::Event) of the same name, with lengths in
/// diameters of the first turbine and its hub as the place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum WindEvent {
    /// The wind changes at all places alike.
    Everywhere(Change),
    /// Extreme wind shear over the first turbine's rotor.
    ExtremeShear {
        /// Beginning (s).
        start: f64,
        /// Duration (s).
        duration: f64,
        /// Largest change of speed one radius above the hub (m/s).
        vertical: f64,
        /// The same one radius to its left, looking downwind (m/s).
        horizontal: f64,
    },
    /// Slow air that circles around the first turbine's hub.
    RotatingDisk(CirclingDisk),
}

/// A disk of slow air that circles, in diameters of the first turbine.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CirclingDisk {
    /// Speed inside (m/s).
    pub speed: f64,
    /// Half-axes along y and z of the ellipse on which its centre runs (diameters).
    pub offsets_diameters: [f64; 2],
    /// Radius (diameters).
    pub radius_diameters: f64,
    /// Width over which the speed changes at its edge (diameters).
    pub edge_diameters: f64,
    /// Strouhal number f D / U of circling at time zero and after the sweep (–).
    pub strouhal: [f64; 2],
    /// Duration of the sweep (s).
    pub sweep: f64,
    /// Sense of rotation, looking downwind.
    pub sense: Sense,
}
