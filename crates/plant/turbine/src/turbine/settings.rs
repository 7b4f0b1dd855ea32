//! What a turbine is built with besides its definition.

use crate::aero::{TowerInfluence, rotor};

/// Aerodynamic model and initial condition of a turbine.
#[derive(Clone, Debug, PartialEq)]
pub struct TurbineSettings {
    /// Which model gives the rotor's induction.
    pub induction: Induction,
    /// Whether blades, tower and drive train bend; otherwise only the rotor turns.
    pub flexible: bool,
    /// Air density (kg/m³).
    pub air_density: f64,
    /// Turn of the nacelle about the vertical, from facing −x, counter-clockwise seen from above (rad).
    pub yaw: f64,
    /// Rotor speed (rad/s).
    pub rotor_speed: f64,
    /// Azimuth of blade 1 (rad).
    pub azimuth: f64,
    /// Pitch of all blades (rad).
    pub pitch: f64,
}

/// Which model gives the rotor's induction.
#[derive(Clone, Debug, PartialEq)]
pub enum Induction {
    /// The resolved flow: the winds given to the turbine contain it, and the flow receives the turbine's
    /// forces.
    ByFlow {
        /// Gaussian width of the forces (m).
        smearing_length: f64,
        /// Distance of the points between which the flow interpolates the wind (m); 0 where it does not.
        sample_spacing: f64,
        /// Whether sections have dynamic stall; otherwise their polars hold at once.
        dynamic_stall: bool,
    },
    /// The resolved flow, which feels bound vortices: the winds given to the turbine contain what all of them
    /// induce, and the turbine is told how they [answer](basis::Answer) to the circulation of its elements.
    ByBoundVortices {
        /// As for [`ByFlow`](Self::ByFlow).
        dynamic_stall: bool,
        /// What the blades feel of the tower, which such air knows nothing of.
        tower: Option<TowerInfluence>,
    },
    /// Blade-element momentum theory in the turbine: the winds given do not contain it.
    ByMomentum(rotor::BemSettings),
}
