//! What the baseline controller must know of its turbine.

use super::CoefficientTable;
use serde::{Deserialize, Serialize};

/// Most notch filters on rotor speed (–).
pub const MAXIMUM_NOTCHES: usize = 4;

/// Corner of the filter on the estimated wind speed where nothing else is known (rad/s): a period of half a
/// minute.
pub const WIND_SPEED_FILTER_CORNER: f64 = std::f64::consts::TAU / 30.0;

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
    /// Least collective pitch against wind speed, rising wind speed; empty where [`Constants::fine_pitch`]
    /// holds throughout.
    pub minimum_pitch: Vec<MinimumPitch>,
    /// Greatest collective pitch (rad).
    pub maximum_pitch: f64,
    /// Fastest change of collective pitch (rad/s).
    pub maximum_pitch_rate: f64,
    /// Gains of pitch control, rising pitch; at least one row.
    pub pitch_gains: Vec<PitchGains>,
    /// How torque and pitch control give way to each other around rated.
    pub set_point_smoothing: SetPointSmoothing,
    /// Corner of the low-pass filter on measured speed (rad/s).
    pub speed_filter_corner: f64,
    /// Damping ratio of that filter, then of second order (–); of first order without.
    pub speed_filter_damping: Option<f64>,
    /// Notch filters on measured speed, [`MAXIMUM_NOTCHES`] of them at most; further ones are left out.
    pub speed_notches: Vec<Notch>,
    /// How torque finds the greatest power below rated; without, tip-speed-ratio tracking where there is an
    /// [`Constants::estimator`] and k ω² where there is none.
    pub torque_control: Option<TorqueControl>,
    /// Corner of the filter on the estimated wind speed (rad/s).
    pub wind_speed_filter_corner: f64,
    /// What the estimator of the wind speed knows of the rotor; without, the wind is guessed from the power.
    pub estimator: Option<WindSpeedEstimator>,
    /// Pitch against the motion of the tower top, where wanted.
    pub tower_damping: Option<TowerDamping>,
    /// Pitch of each blade against tilt and yaw moment of the rotor, where wanted.
    pub individual_pitch: Option<IndividualPitch>,
}

impl Constants {
    /// The same with the wind speed estimated from a rotor of `inertia` (kg m², with the generator, low-speed
    /// side) and `coefficients` in air of `air_density` (kg/m³).
    pub fn with_estimator(
        self,
        inertia: f64,
        air_density: f64,
        coefficients: CoefficientTable,
    ) -> Self {
        let estimator = Some(WindSpeedEstimator { inertia, air_density, coefficients });
        Self { estimator, ..self }
    }

    /// How torque finds the greatest power below rated, as it will be done: tracking needs the estimator.
    pub fn torque_control(&self) -> TorqueControl {
        match (self.torque_control, &self.estimator) {
            (Some(TorqueControl::KOmegaSquared), _) | (_, None) => TorqueControl::KOmegaSquared,
            _ => TorqueControl::TipSpeedRatio,
        }
    }
}

/// How torque finds the greatest power below rated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TorqueControl {
    /// Torque is a constant times rotor speed squared.
    KOmegaSquared,
    /// Torque holds the rotor at the speed that the estimated wind asks for.
    TipSpeedRatio,
}

/// What the estimator of the rotor-effective wind speed knows of the rotor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindSpeedEstimator {
    /// Inertia of rotor and generator on the low-speed side (kg m²).
    pub inertia: f64,
    /// Air density (kg/m³).
    pub air_density: f64,
    /// Power and thrust of the rotor, for [`Constants::rotor_radius`].
    pub coefficients: CoefficientTable,
}

/// A notch filter: (s² + 2 ζₙ ω s + ω²)/(s² + 2 ζ ω s + ω²).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Notch {
    /// Frequency ω that it takes out (rad/s).
    pub frequency: f64,
    /// Damping ratio ζₙ of the numerator (–); 0 takes out all.
    pub numerator_damping: f64,
    /// Damping ratio ζ of the denominator (–); more is wider.
    pub denominator_damping: f64,
}

/// Collective pitch against the fore-aft motion of the tower top.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TowerDamping {
    /// Pitch over velocity downwind (rad s/m).
    pub gain: f64,
    /// What is slower is left alone (rad/s).
    pub high_pass_corner: f64,
    /// Most that it adds or takes (rad).
    pub limit: f64,
}

/// Individual pitch control at rotor frequency.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct IndividualPitch {
    /// Pitch over moment (rad/(N m)).
    pub proportional: f64,
    /// Pitch rate over moment (rad/(N m s)).
    pub integral: f64,
    /// Added to the azimuth on the way back to the blades (rad); none while it is yet to be found: whoever
    /// puts a controller together tells it before, and nothing is added without.
    pub azimuth_offset: Option<f64>,
    /// Greatest amplitude (rad).
    pub limit: f64,
    /// Wind speeds (m/s) between which the amplitude is let in.
    pub ramp: [f64; 2],
    /// What the blades stay above.
    pub floor: PitchFloor,
}

/// What the blades stay above under individual pitch control: its amplitude shrinks with the room that is
/// left.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum PitchFloor {
    /// Nothing but the actuators' own limits.
    None,
    /// [`Constants::fine_pitch`].
    #[default]
    Fine,
    /// [`Constants::minimum_pitch`], so that the limit on thrust holds for every blade.
    Least,
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

/// Least collective pitch at one wind speed (peak shaving, or best power away from the optimal tip-speed
/// ratio).
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
