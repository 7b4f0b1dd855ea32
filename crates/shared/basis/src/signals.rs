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

impl Measurements {
    /// What a machine of `n_blades` at rest in still air reads at time zero: zeros, to be overwritten by what a trial is about.
    pub fn at_rest(n_blades: usize) -> Self {
        let none = PerBlade::splat(n_blades, 0.0);
        Self {
            time: 0.0,
            interval: 0.0,
            azimuth: 0.0,
            rotor_speed: 0.0,
            generator_speed: 0.0,
            pitch: none,
            generator_torque: 0.0,
            power: 0.0,
            thrust: 0.0,
            aerodynamic_torque: 0.0,
            rotor_wind_speed: 0.0,
            flap_moments: none,
            edge_moments: none,
            tower_top_acceleration: 0.0,
        }
    }
}

/// What a controller asks of its turbine until the next control instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Commands {
    /// Blade pitch angles, positive to feather (rad).
    pub pitch: PerBlade<f64>,
    /// Generator torque on the low-speed side (N m).
    pub generator_torque: f64,
}
