//! What runs on one turbine.

use crate::excitation::ExcitationState;
use crate::{Baseline, Controller, Excitation};
use basis::{Commands, Measurements};
use serde::{Deserialize, Serialize};

/// Greedy control with an excitation on top.
#[derive(Clone, Debug)]
pub struct TurbineController {
    /// Torque and collective pitch.
    pub baseline: Baseline,
    /// What is added to the blades' pitch.
    pub excitation: Excitation,
}

/// Everything of a controller that time changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ControllerState {
    baseline: Baseline,
    excitation: ExcitationState,
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

    /// Everything that time changes, for a checkpoint.
    pub fn state(&self) -> ControllerState {
        ControllerState { baseline: self.baseline.clone(), excitation: self.excitation.state() }
    }

    /// Continues from `state`, which a controller of the same settings gave.
    pub fn restore(&mut self, state: ControllerState) {
        self.baseline = state.baseline;
        self.excitation.restore(state.excitation);
    }
}

impl Controller for TurbineController {
    fn update(&mut self, measurements: &Measurements) -> Commands {
        let mut commands = self.baseline.update(measurements);
        self.excitation.add_to(&mut commands.pitch, measurements);
        commands
    }
}
