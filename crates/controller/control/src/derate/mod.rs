//! De-rating, also called axial-induction control: the turbine takes a share of the power that it could take,
//! and leaves the rest, with less thrust, to those behind.
//!
//! The rotor keeps the speed that greedy control gives it in the same wind, and pitches to feather instead:
//!
//! ```text
//! C_P(λ, β_d) = p C_P(λ, β_0)        λ = Ω(U) R / U,  Ω(U) = λ* U / R between the least and rated speed
//! k_d = p k      rated power and torque: p times those of the turbine
//! ```
//!
//! p is the share, β_0 the least pitch of greedy control at wind speed U, β_d the least pitch here. Below
//! rated this is de-rating at constant tip-speed ratio, above rated at constant speed; in between both meet,
//! since greedy power and all that limits it are scaled alike.
//!
//! Source: Astrain Juangarcia, Eguinoa, Knudsen, "Derating a single wind farm turbine for reducing its wake
//! and fatigue", J. Phys.: Conf. Ser. 1037, 032039, 2018 (the strategy that keeps the tip-speed ratio).
//! Limits: coefficients are those of blade-element momentum theory; where the rotor's are others, the share
//! is missed by as much as their *ratio* at the two pitch angles differs.

mod kind;

pub use kind::DERATE;

use crate::baseline::{Baseline, CoefficientTable, Constants, MinimumPitch, least_pitch};
use crate::controller::{Controller, ForeignState};
use basis::{Commands, Measurements};

/// Wind speeds at which the least pitch is found (–), beside those at which greedy control has its own.
const N_WIND_SPEEDS: usize = 25;
/// They reach from this share of the wind speed at which the rotor leaves its least speed (–)
const LOWEST: f64 = 0.6;
/// to so many times that at which it reaches rated speed (–).
const HIGHEST: f64 = 1.5;
/// Step in which a pitch with less power is looked for (rad): a tenth of a degree.
const PITCH_STEP: f64 = 0.1 * std::f64::consts::PI / 180.0;
/// Halvings of that step (–).
const N_HALVINGS: usize = 20;

/// Greedy control of a turbine of less power.
pub struct Derate {
    inner: Baseline,
    share: f64,
}

impl Derate {
    /// De-rating of the turbine with `constants` and these `coefficients` to the `share` (–) of its power.
    pub fn new(constants: &Constants, coefficients: &CoefficientTable, share: f64) -> Self {
        Self { inner: Baseline::new(derated(constants, coefficients, share)), share }
    }

    /// What the greedy control within knows of its turbine.
    pub fn constants(&self) -> &Constants {
        self.inner.constants()
    }
}

impl Controller for Derate {
    fn update(&mut self, measurements: &Measurements) -> Commands {
        self.inner.update(measurements)
    }

    fn describe(&self) -> String {
        format!("derate {:.0} %", 100.0 * self.share)
    }

    fn save(&self) -> Vec<u8> {
        self.inner.save()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        self.inner.restore(state)
    }
}

/// `constants` of a turbine that takes the `share` (–) of its power, by these `coefficients`.
fn derated(constants: &Constants, coefficients: &CoefficientTable, share: f64) -> Constants {
    let feathered = |tip_speed_ratio: f64, pitch: f64| {
        pitch_of(share, tip_speed_ratio, pitch, coefficients, constants.maximum_pitch)
    };
    let minimum_pitch = wind_speeds(constants).into_iter().map(|wind_speed| MinimumPitch {
        wind_speed,
        pitch: feathered(
            tip_speed_ratio(wind_speed, constants),
            least_pitch(wind_speed, constants),
        ),
    });
    Constants {
        minimum_pitch: minimum_pitch.collect(),
        fine_pitch: feathered(constants.optimal_tip_speed_ratio, constants.fine_pitch),
        torque_gain: share * constants.torque_gain,
        rated_power: share * constants.rated_power,
        rated_torque: share * constants.rated_torque,
        ..constants.clone()
    }
}

/// Wind speeds (m/s) at which the least pitch is found, rising.
fn wind_speeds(constants: &Constants) -> Vec<f64> {
    let optimal = constants.rotor_radius / constants.optimal_tip_speed_ratio;
    let low = LOWEST * optimal * constants.minimum_rotor_speed;
    let high = HIGHEST * optimal * constants.rated_rotor_speed;
    let step = (high - low) / (N_WIND_SPEEDS - 1) as f64;
    let corners = [constants.minimum_rotor_speed, constants.rated_rotor_speed].map(|w| w * optimal);
    let mut all: Vec<f64> = (0..N_WIND_SPEEDS).map(|k| low + k as f64 * step).collect();
    all.extend(corners);
    all.extend(constants.minimum_pitch.iter().map(|row| row.wind_speed));
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// Tip-speed ratio (–) at which greedy control runs in a wind of `wind_speed` (m/s).
fn tip_speed_ratio(wind_speed: f64, constants: &Constants) -> f64 {
    let Constants { rotor_radius, optimal_tip_speed_ratio, .. } = *constants;
    let rotor_speed = (optimal_tip_speed_ratio * wind_speed / rotor_radius)
        .min(constants.rated_rotor_speed)
        .max(constants.minimum_rotor_speed);
    rotor_speed * rotor_radius / wind_speed
}

/// The least pitch (rad) above `pitch` (rad), towards feather, at which the rotor has the `share` (–) of its
/// power coefficient there; `most` (rad) where there is none below.
fn pitch_of(
    share: f64,
    tip_speed_ratio: f64,
    pitch: f64,
    coefficients: &CoefficientTable,
    most: f64,
) -> f64 {
    let target = share * coefficients.power(tip_speed_ratio, pitch);
    let has_more = |pitch: f64| coefficients.power(tip_speed_ratio, pitch) > target;
    let (mut low, mut step) = (pitch, PITCH_STEP);
    while has_more(low + step) {
        low += step;
        if low >= most {
            return most;
        }
    }
    for _ in 0..N_HALVINGS {
        step *= 0.5;
        if has_more(low + step) {
            low += step;
        }
    }
    low
}
