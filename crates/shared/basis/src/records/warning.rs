//! What a reader of a summary must know before using its numbers.

use serde::{Deserialize, Serialize};

/// A warning.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Warning {
    /// What it is about.
    pub kind: WarningKind,
    /// Turbine that it is about; absent where it is about the whole run.
    pub turbine: Option<String>,
    /// What happened, in words, and how to fix it.
    pub message: String,
}

/// What a warning is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WarningKind {
    /// The case or its turbines, as seen before the run: a coarse grid, too few blocks, a controller's file
    /// of another rotor.
    Setup,
    /// A turbine did not pitch as far as it was set to, or a pitch limit held it back.
    PitchHeldBack,
    /// A controller could not do what it was set to do for part of the time.
    Controller,
    /// A blade's tip moved faster than the flow's numerical speed of sound.
    TipSpeed,
    /// A rotor turned much faster than a real machine is let.
    Overspeed,
    /// A turbine's blades stood in the cores of other turbines' vortices for more than a little of the time.
    VortexCores,
    /// A gain is not defined: the run compared with has no power, or no load, to be a share of.
    GainUndefined,
    /// Runs of one study were made with unlike versions of the case, of a turbine, of a file of wind or of
    /// the program, or on machines that compute otherwise.
    MixedRuns,
}
