//! The points on which a case has turbulence made around its rotors, where it says so itself.

use serde::{Deserialize, Serialize};

/// Points in a plane across the wind, in its middle the hub of the first turbine.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MadeGrid {
    /// From the first column to the last (m).
    pub width: f64,
    /// From the lowest row to the highest (m).
    pub height: f64,
    /// Points along the width, at least 2 (–).
    pub columns: usize,
    /// Points along the height, at least 2 (–).
    pub rows: usize,
}

impl MadeGrid {
    /// Distance of neighbouring columns and of neighbouring rows (m).
    pub fn spacing(&self) -> [f64; 2] {
        [self.width / (self.columns - 1) as f64, self.height / (self.rows - 1) as f64]
    }
}
