//! What the baseline controller must know of its turbine.

use serde::{Deserialize, Serialize};

/// Constants of torque and collective pitch control; everything on the low-speed side of the gearbox.
///
/// Gains act on *measured minus reference* rotor speed and are positive when more speed asks for more
/// torque or more pitch. Controller decks that define them on the high-speed shaft or on *reference minus
/// measured* are converted where they are read: with gearbox ratio N, speeds are 1/N times the deck's,
/// torques and torque rates N times, pitch gains −N times, torque gains −N² times and the torque constant
/// N³ times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Constants {
    /// Rotor radius, hub centre to tip (m).
    pub rotor_radius: f64,
    /// Tip-speed ratio of greatest power coefficient at fine pitch (–).
    pub optimal_tip_speed_ratio: f64,
    /// Torque over rotor speed squared below rated (N m s²), see [`greedy_torque_gain`].
    pub torque_gain: f64,
    /// Lowest rotor speed that torque control keeps (rad/s).
    pub minimum_rotor_speed: f64,
    /// Rotor speed at rated power (rad/s).
    pub rated_rotor_speed: f64,
    /// Generator torque at rated power (N m).
    pub rated_torque: f64,
    /// Electrical power at rated (W).
    pub rated_power: f64,
    /// Electrical power over mechanical power (–).
    pub generator_efficiency: f64,
    /// Least generator torque (N m).
    pub minimum_torque: f64,
    /// Greatest generator torque (N m).
    pub maximum_torque: f64,
    /// Fastest change of generator torque (N m/s).
    pub maximum_torque_rate: f64,
    /// Above rated: constant power when true, constant torque when false.
    pub constant_power: bool,
    /// Gains of torque control at minimum and rated rotor speed.
    pub torque_gains: TorqueGains,
    /// Collective pitch below rated (rad).
    pub fine_pitch: f64,
    /// Least collective pitch against wind speed, rising wind speed; empty where [`Constants::fine_pitch`] holds throughout.
    pub minimum_pitch: Vec<MinimumPitch>,
    /// Greatest collective pitch (rad).
    pub maximum_pitch: f64,
    /// Fastest change of collective pitch (rad/s).
    pub maximum_pitch_rate: f64,
    /// Gains of pitch control, rising pitch; at least one row.
    pub pitch_gains: Vec<PitchGains>,
    /// How torque and pitch control give way to each other around rated.
    pub set_point_smoothing: SetPointSmoothing,
    /// Corner of the first-order low-pass filter on measured rotor speed (rad/s).
    pub speed_filter_corner: f64,
}

/// Proportional and integral gain of torque control.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TorqueGains {
    /// Torque over rotor speed error (N m s).
    pub proportional: f64,
    /// Torque rate over rotor speed error (N m).
    pub integral: f64,
}

/// Proportional and integral gain of pitch control at one collective pitch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PitchGains {
    /// Collective pitch at which they hold (rad).
    pub pitch: f64,
    /// Pitch over rotor speed error (s).
    pub proportional: f64,
    /// Pitch rate over rotor speed error (–).
    pub integral: f64,
}

/// Least collective pitch at one wind speed (peak shaving, or best power away from the optimal tip-speed ratio).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MinimumPitch {
    /// Free-stream wind speed (m/s).
    pub wind_speed: f64,
    /// Least collective pitch (rad).
    pub pitch: f64,
}

/// Shift of the two speed references away from rated, so that torque and pitch control do not fight.
///
/// Source: Abbas, Zalkind, Pao, Wright, "A reference open-source controller for fixed and floating
/// offshore wind turbines", Wind Energ. Sci. 7, 53–73, 2022, set point smoothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SetPointSmoothing {
    /// Relative fall of the torque reference per pitch above its least value (1/rad).
    pub torque_shift: f64,
    /// Relative rise of the pitch reference per power missing to rated, relative to rated (–).
    pub pitch_shift: f64,
    /// Corner of the low-pass filter on the shift (rad/s).
    pub filter_corner: f64,
}

/// Torque over rotor speed squared that holds the rotor at `tip_speed_ratio` (–), (N m s²):
/// ½ ρ π R⁵ C_P / λ³ with `air_density` ρ (kg/m³), `rotor_radius` R (m), `power_coefficient` C_P (–).
///
/// Source: Bossanyi, "The design of closed loop controllers for wind turbines", Wind Energy 3, 2000.
/// Limits: decks made for tip-speed-ratio tracking may carry a gain that does not belong to their own
/// optimal tip-speed ratio; the one given here does.
pub fn greedy_torque_gain(
    air_density: f64,
    rotor_radius: f64,
    power_coefficient: f64,
    tip_speed_ratio: f64,
) -> f64 {
    0.5 * air_density * std::f64::consts::PI * rotor_radius.powi(5) * power_coefficient
        / tip_speed_ratio.powi(3)
}
