//! Fatigue of a pitch bearing: pitch travel under load.

use super::Damage;
use super::load::check_duration;
use crate::AnalysisError;
use std::f64::consts::{PI, TAU};

/// Pitch travel per time of the reference motion (rad/s): 600° in 10 minutes.
///
/// Source: van der Hoek et al., section 2.4: what a helix of 2° at St 0.25 and 10 m/s travels on the IEA 22
/// MW turbine.
pub const REFERENCE_TRAVEL_RATE: f64 = PI / 180.0;

/// Slope of a pitch bearing's equivalent load (–), after the same.
pub const BEARING_SLOPE: f64 = 3.0;

/// Positions round a pitch bearing's ring (–): every 10°, after the same.
pub const N_BEARING_POSITIONS: usize = 36;

/// The convention of pitch-bearing load and pitch travel in words, for printing beside a figure: moments and
/// pitch of one blade, sampled every `interval` (s).
pub fn duty_convention(slope: f64, n_positions: usize, interval: f64) -> String {
    format!(
        "pitch-bearing load (van der Hoek et al., Eq. 9): that moment which, over the reference travel of 600° in 10 minutes, does the \
         damage of max(cos φ M_flap + sin φ M_edge, 0)^m weighted with the pitch travelled since the sample before, m = {slope}, at \
         {n_positions} positions φ round the ring from the flapwise moment (RootMyb) towards the edgewise one (RootMxb); pitch travel: sum of all \
         motion; samples every {} s",
        (1e4 * interval).round() / 1e4
    )
}

/// Equivalent load of a bearing at one position of its ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BearingLoad {
    /// Angle round the ring from the direction of the flapwise moment towards the edgewise one (rad), [0,
    /// 2π).
    pub position: f64,
    /// Moment (N m) that does the same damage over the reference travel.
    pub load: f64,
}

/// Accumulates the damage of one pitch bearing at positions round its ring, sample by sample.
///
/// Where the ring is pressed, the moment there counts to the power m, weighted with the pitch travelled since
/// the sample before; where it is relieved, nothing. The equivalent load is that moment which does the same
/// over the reference travel, [`REFERENCE_TRAVEL_RATE`] × duration.
///
/// Source: van der Hoek et al., Eq. 9 (see [the module](super)), after van Vondelen et al. (2024); there m is
/// [`BEARING_SLOPE`] and positions are [`N_BEARING_POSITIONS`].
#[derive(Clone, Debug)]
pub struct PitchBearing {
    positions: Vec<Position>,
    pitch: Option<f64>,
    n_samples: usize,
}

#[derive(Clone, Debug)]
struct Position {
    angle: f64,
    sine: f64,
    cosine: f64,
    damage: Damage,
}

impl PitchBearing {
    /// A bearing that has not moved, for the slope `slope` (–) at `n_positions` equally spaced positions, the
    /// first at the flapwise moment.
    ///
    /// # Errors
    /// [`AnalysisError::Slope`].
    pub fn new(slope: f64, n_positions: usize) -> Result<Self, AnalysisError> {
        let damage = Damage::new(slope)?;
        let position = |index: usize| {
            let angle = TAU * index as f64 / n_positions as f64;
            let (sine, cosine) = angle.sin_cos();
            Position { angle, sine, cosine, damage: damage.clone() }
        };
        Ok(Self { positions: (0..n_positions).map(position).collect(), pitch: None, n_samples: 0 })
    }

    /// Takes one sample: `pitch` (rad) and the moments at the blade's root, `flapwise` and `edgewise` (N m).
    ///
    /// # Errors
    /// [`AnalysisError::NotFinite`] with the sample's index; the bearing is as before.
    pub fn push(&mut self, pitch: f64, flapwise: f64, edgewise: f64) -> Result<(), AnalysisError> {
        if ![pitch, flapwise, edgewise].into_iter().all(f64::is_finite) {
            return Err(AnalysisError::NotFinite { index: self.n_samples });
        }
        let travel = self.pitch.map_or(0.0, |before| (pitch - before).abs());
        if travel > 0.0 {
            for position in &mut self.positions {
                let moment = position.cosine * flapwise + position.sine * edgewise;
                position.damage.add(moment, travel);
            }
        }
        self.pitch = Some(pitch);
        self.n_samples += 1;
        Ok(())
    }

    /// Equivalent loads at all positions after `duration` (s) from the first sample to the last.
    ///
    /// # Errors
    /// [`AnalysisError::NotPositive`] for the duration.
    pub fn loads(&self, duration: f64) -> Result<Vec<BearingLoad>, AnalysisError> {
        check_duration(duration)?;
        let reference_travel = REFERENCE_TRAVEL_RATE * duration;
        let load = |position: &Position| BearingLoad {
            position: position.angle,
            load: position.damage.equivalent_load(reference_travel),
        };
        Ok(self.positions.iter().map(load).collect())
    }
}
