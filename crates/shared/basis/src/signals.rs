//! What crosses the wall between plant and controller, and the truth behind it.

use crate::PerBlade;
use crate::scan::Scan;
use serde::{Deserialize, Serialize};

/// True state of a turbine at one control instant, which records keep. Controllers never see it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Time since the start of the run (s).
    pub time: f64,
    /// Control interval that the next command holds for (s).
    pub interval: f64,
    /// Rotor azimuth, blade 1, zero up, clockwise seen from upwind (rad, [0, 2π)).
    pub azimuth: f64,
    /// Rotor speed (rad/s).
    pub rotor_speed: f64,
    /// Generator speed on the low-speed side, over the gear ratio: rotor speed but for the twist of the shaft
    /// (rad/s).
    pub generator_speed: f64,
    /// Blade pitch angles, positive to feather (rad).
    pub pitch: PerBlade<f64>,
    /// Turn of the nacelle from facing the mean wind, counter-clockwise seen from above (rad).
    pub yaw: f64,
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
    /// Blade root in-plane bending moments about the axis downwind (N m); zero where the model has none.
    pub edge_moments: PerBlade<f64>,
    /// Fore-aft acceleration of the tower top, positive downwind (m/s²); zero on a rigid tower.
    pub tower_top_acceleration: f64,
}

impl Truth {
    /// State of a machine of `n_blades` at rest in still air at time zero: zeros, to be overwritten by what a
    /// trial is about.
    pub fn at_rest(n_blades: usize) -> Self {
        let none = PerBlade::splat(n_blades, 0.0);
        Self {
            time: 0.0,
            interval: 0.0,
            azimuth: 0.0,
            rotor_speed: 0.0,
            generator_speed: 0.0,
            pitch: none,
            yaw: 0.0,
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

    /// What perfect instruments show of it: everything that has an instrument, bit for bit.
    pub fn measured(&self) -> Measurements<'static> {
        Measurements {
            time: self.time,
            interval: self.interval,
            azimuth: self.azimuth,
            rotor_speed: self.rotor_speed,
            generator_speed: self.generator_speed,
            pitch: self.pitch,
            yaw: self.yaw,
            generator_torque: self.generator_torque,
            power: self.power,
            flap_moments: self.flap_moments,
            edge_moments: self.edge_moments,
            tower_top_acceleration: self.tower_top_acceleration,
            readings: &[],
        }
    }
}

/// What a turbine's instruments show at one control instant.
///
/// Thrust, aerodynamic torque and the wind at the rotor have no instrument, so they are not here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurements<'a> {
    /// Time since the start of the run (s).
    pub time: f64,
    /// Control interval that the next command holds for (s).
    pub interval: f64,
    /// Rotor azimuth, blade 1, zero up, clockwise seen from upwind (rad, [0, 2π)).
    pub azimuth: f64,
    /// Rotor speed (rad/s).
    pub rotor_speed: f64,
    /// Generator speed on the low-speed side, over the gear ratio (rad/s).
    pub generator_speed: f64,
    /// Blade pitch angles, positive to feather (rad).
    pub pitch: PerBlade<f64>,
    /// Turn of the nacelle from facing the mean wind, counter-clockwise seen from above (rad); always
    /// as it is.
    pub yaw: f64,
    /// Generator torque on the low-speed side (N m).
    pub generator_torque: f64,
    /// Electrical power (W).
    pub power: f64,
    /// Blade root out-of-plane bending moments, positive where thrust bends the blade (N m).
    pub flap_moments: PerBlade<f64>,
    /// Blade root in-plane bending moments about the axis downwind (N m).
    pub edge_moments: PerBlade<f64>,
    /// Fore-aft acceleration of the tower top, positive downwind (m/s²).
    pub tower_top_acceleration: f64,
    /// What the turbine's further sensors show, by their names.
    pub readings: &'a [Reading],
}

/// What one further sensor shows, such as a lidar.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Name of the sensor in the case file.
    pub sensor: String,
    /// Its values, in the order of its channels, in SI units; a lidar's go on behind them, as
    /// [`Scan`] has it.
    pub values: Vec<f64>,
}

impl Measurements<'_> {
    /// What perfect instruments show of [`Truth::at_rest`].
    pub fn at_rest(n_blades: usize) -> Self {
        Truth::at_rest(n_blades).measured()
    }

    /// What the further sensor called `sensor` shows; none where the turbine has no such sensor.
    pub fn reading(&self, sensor: &str) -> Option<&[f64]> {
        let reading = self.readings.iter().find(|reading| reading.sensor == sensor)?;
        Some(&reading.values)
    }

    /// The latest scan of the lidar called `sensor`; none where the turbine has no such sensor, or it is no
    /// lidar.
    pub fn scan(&self, sensor: &str) -> Option<Scan<'_>> {
        Scan::of(self.reading(sensor)?)
    }
}

/// What a controller asks of its turbine until the next control instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Commands {
    /// Blade pitch angles, positive to feather (rad).
    pub pitch: PerBlade<f64>,
    /// Generator torque on the low-speed side (N m).
    pub generator_torque: f64,
    /// Rate at which the nacelle turns, counter-clockwise seen from above (rad/s); zero lets it stand.
    pub yaw_rate: f64,
}
