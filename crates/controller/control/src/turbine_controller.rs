//! What runs on one turbine.

use crate::{Baseline, Controller, Excitation};
use basis::{Commands, Measurements};
use serde::{Deserialize, Serialize};

/// Greedy control with an excitation on top; serialises whole, state included.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TurbineController {
    /// Torque and collective pitch.
    pub baseline: Baseline,
    /// What is added to the blades' pitch.
    pub excitation: Excitation,
}

impl TurbineController {
    /// `excitation` on top of `baseline`.
    pub fn new(baseline: Baseline, excitation: Excitation) -> Self {
        Self { baseline, excitation }
    }

    /// What runs, in words: "baseline", "helix ccw 4.0° St 0.25".
    pub fn describe(&self) -> String {
        self.excitation.describe()
    }
}

impl Controller for TurbineController {
    fn update(&mut self, measurements: &Measurements) -> Commands {
        let mut commands = self.baseline.update(measurements);
        self.excitation.add_to(&mut commands.pitch, measurements);
        commands
    }
}
