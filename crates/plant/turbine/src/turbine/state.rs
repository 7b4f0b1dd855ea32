//! What a turbine remembers from one interval to the next, as checkpoints keep it.

use super::aerodynamics::AerodynamicState;
use super::nacelle::NacelleState;
use crate::actuators::{PitchState, SwashplateState};
use crate::structure::StructureState;
use basis::PerBlade;
use serde::{Deserialize, Serialize};

/// State of a turbine; a run restored from it continues with the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TurbineState {
    pub(super) structure: StructureState,
    pub(super) pitch: PerBlade<PitchState>,
    pub(super) swashplate: Option<SwashplateState>,
    pub(super) nacelle: NacelleState,
    pub(super) aerodynamics: AerodynamicState,
    pub(super) readings: Readings,
    pub(super) n_instants: u64,
    pub(super) n_limited: u64,
}

/// Loads and wind over the last interval.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Readings {
    pub(super) generator_torque: f64,
    pub(super) thrust: f64,
    pub(super) aerodynamic_torque: f64,
    pub(super) rotor_wind_speed: f64,
}

impl TurbineState {
    /// Of a turbine that has not run yet, its blades and its nacelle at rest as `structure` has them.
    /// A `swashplate` stands as the blades do.
    pub(super) fn at_start(
        structure: StructureState,
        aerodynamics: AerodynamicState,
        swashplate: Option<SwashplateState>,
    ) -> Self {
        let pitch = structure.pitch.map(|blade| PitchState { pitch: blade.angle, rate: 0.0 });
        let nacelle = NacelleState { angle: structure.yaw.angle, rate: 0.0 };
        Self {
            structure,
            pitch,
            swashplate,
            nacelle,
            aerodynamics,
            readings: Readings::default(),
            n_instants: 0,
            n_limited: 0,
        }
    }

    /// Smearing correction of each blade element, axial and along the rotation (m/s), blade after blade;
    /// empty where momentum theory gives the induction.
    pub fn smearing_corrections(&self) -> &[[f64; 2]] {
        match &self.aerodynamics {
            AerodynamicState::Line(corrections)
            | AerodynamicState::SeparatingLine(corrections, _) => corrections,
            AerodynamicState::Momentum(_) => &[],
        }
    }
}
