//! What crosses the wall between plant and controller.

use crate::PerBlade;
use serde::{Deserialize, Serialize};

/// What a turbine's instruments read at one control instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Time since the start of the run (s).
    pub time: f64,
    /// Control interval that the next command holds for (s).
    pub interval: f64,
    /// Rotor azimuth, blade 1, zero up, clockwise seen from upwind (rad, [0, 2π)).
    pub azimuth: f64,
    /// Rotor speed (rad/s).
    pub rotor_speed: f64,
    /// Generator speed on the low-speed side, over the gear ratio: rotor speed but for the twist of the shaft (rad/s).
    pub generator_speed: f64,
    /// Blade pitch angles, positive to feather (rad).
    pub pitch: PerBlade<f64>,
    /// Generator torque on the low-speed side (N m).
    pub generator_torque: f64,
    /// Electrical power (W).
    pub power: f64,
    /// Rotor thrust, along the shaft, positive downwind (N).
    pub thrust: f64,
    /// Aerodynamic torque on the shaft (N m).
    pub aerodynamic_torque: f64,
    /// Rotor-averaged axial wind speed at the blades, induction included where the flow resolves it (m/s).
    pub rotor_wind_speed: f64,
    /// Blade root out-of-plane bending moments, positive where thrust bends the blade (N m).
    pub flap_moments: PerBlade<f64>,
    /// Blade root in-plane bending moments about the axis downwind (N m); zero where nothing tells them.
    pub edge_moments: PerBlade<f64>,
    /// Fore-aft acceleration of the tower top, positive downwind (m/s²); zero on a rigid tower.
    pub tower_top_acceleration: f64,
}

/// What a controller asks of its turbine until the next control instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Commands {
    /// Blade pitch angles, positive to feather (rad).
    pub pitch: PerBlade<f64>,
    /// Generator torque on the low-speed side (N m).
    pub generator_torque: f64,
}
