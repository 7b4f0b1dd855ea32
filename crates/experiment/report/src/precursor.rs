//! What there is to tell of a precursor: an atmosphere that was spun up and recorded as wind.

use crate::{DensityFigure, TrackFigure};

/// Everything that the page of a precursor tells.
#[derive(Clone, Debug, PartialEq)]
pub struct PrecursorRecords {
    /// Its name.
    pub name: String,
    /// What it is for, in one line.
    pub description: Option<String>,
    /// Its file as run (TOML).
    pub case_text: String,
    /// Version of the program that made it.
    pub version: String,
    /// What a reader of the numbers must know.
    pub warnings: Vec<String>,
    /// The wind at hub height.
    pub hub: HubWind,
    /// Further facts: what it is, value with unit, remark.
    pub facts: Vec<[String; 3]>,
    /// How steady it was: of the spin-up, of the record.
    pub drifts: Vec<DriftRow>,
    /// Means over level and record, from the ground up.
    pub levels: Vec<LevelRow>,
    /// What the layer did over time.
    pub tracks: Vec<TrackFigure>,
    /// What the levels did over time.
    pub maps: Vec<TimeHeightMap>,
    /// Spectra at hub height; absent where the record is too short.
    pub spectra: Option<DensityFigure>,
    /// Coherence at hub height of points side by side, at some frequencies; may be empty.
    pub coherence: Vec<CoherenceLine>,
    /// Time when the record began (s).
    pub record_from: f64,
}

/// The wind at hub height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HubWind {
    /// Hub height (m).
    pub height: f64,
    /// Diameter of the rotors that it is for (m), where it is known.
    pub rotor_diameter: Option<f64>,
    /// Mean speed in the record (m/s).
    pub speed: f64,
    /// Where it comes from (deg, clockwise from north).
    pub direction_deg: f64,
    /// Standard deviation of u over the speed (–).
    pub turbulence_intensity: f64,
}

/// Means of two blocks, one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct DriftRow {
    /// Of which time, in words.
    pub name: String,
    /// Length of a block (s).
    pub block: f64,
    /// Speed at hub height (m/s).
    pub speed: [f64; 2],
    /// Where that wind comes from (deg, clockwise from north).
    pub direction_deg: [f64; 2],
    /// Friction velocity (m/s).
    pub friction_velocity: [f64; 2],
    /// Change of the speed over its mean (–).
    pub speed_change: f64,
    /// Change of the direction (deg), the shorter way round.
    pub turn_deg: f64,
    /// Change of the friction velocity over its mean (–).
    pub friction_change: f64,
    /// Whether that is steady.
    pub is_steady: bool,
}

/// Means of one level over the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelRow {
    /// Height (m).
    pub height: f64,
    /// Speed (m/s).
    pub speed: f64,
    /// Where the wind comes from (deg, clockwise from north).
    pub direction_deg: f64,
    /// √(2k/3) over speed (–).
    pub turbulence_intensity: f64,
    /// Flux of momentum (m²/s²).
    pub stress: f64,
    /// Potential temperature (K).
    pub temperature: f64,
}

/// A quantity over time and height.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeHeightMap {
    /// What it is, in a few words.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Times (s), ascending.
    pub times: Vec<f64>,
    /// Heights (m), ascending.
    pub heights: Vec<f64>,
    /// A value for each time and height, heights fastest (unit of the map).
    pub values: Vec<f64>,
}

/// Coherence over the distance at one frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct CoherenceLine {
    /// Frequency (Hz).
    pub frequency: f64,
    /// Distance (m) and coherence (–).
    pub points: Vec<[f64; 2]>,
    /// The same of a model; may be empty.
    pub model: Vec<[f64; 2]>,
}
