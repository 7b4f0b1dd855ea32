//! Phase synchronisation: a turbine in a helix joins it, a chosen angle ahead of or behind the wind that meets it.
//!
//! Source: van Vondelen et al. (2025), "Synchronized Helix wake mixing control", Wind Energ. Sci. 10, 2411, Eq. 22:
//!
//! ```text
//! tilt = A sin(ω_e t + φ̂_tilt + φ_off)        yaw = A sin(ω_e t ± π/2 + φ̂_yaw + φ_off)        upper sign: ccw
//! ```
//!
//! with the phases φ̂ of the wind that [`HelixEstimator`] finds. Offset 0: pitch rises where the wind does, and the blades
//! lose load there; offset 180°: pitch falls where the wind rises.
//!
//! What the paper leaves open: the excitation is as strong as the estimate is trusted. Where the wind carries no helix, or
//! the loads go missing, it fades to the baseline, and comes back when the helix does.

use crate::excitation::fade_in;
use basis::mbc::to_blades;
use basis::{FixedFrame, Measurements, PerBlade, Sense};
use estimation::helix::State as EstimatorState;
use estimation::{Estimator, HelixEstimate, HelixEstimator};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Settings of a turbine that joins the helix that meets it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SyncSettings {
    /// Which way the helix winds.
    pub sense: Sense,
    /// Pitch amplitude (rad).
    pub amplitude: f64,
    /// Excitation rate of the turbine upstream (rad/s).
    pub rate: f64,
    /// Lead φ_off of the pitch over the wind (rad).
    pub offset: f64,
    /// Azimuth offset ψ_o of the inverse multi-blade transformation (rad).
    pub azimuth_offset: f64,
    /// Time at which it fades in, over one excitation period (s); the estimator runs from the beginning.
    pub start: f64,
    /// Trust (–) below which the excitation fades out, and above which it comes back; none: it never fades out.
    pub trust: Option<[f64; 2]>,
}

/// Trust below which the excitation fades out, and above which it comes back (–).
///
/// [`Trust::overall`](estimation::helix::Trust::overall) lies near 0 in turbulence without a helix; five diameters behind one it was
/// 0.2 to 0.5 in large-eddy flow (docs/validation/synchronised-helix.md).
pub const TRUST: [f64; 2] = [0.05, 0.15];

/// Excitation periods over which the found phases are steadied before they pitch (–).
const STEADY: f64 = 1.0 / 16.0;

/// The controller, with what it believes.
#[derive(Clone, Debug)]
pub struct PhaseSync {
    settings: SyncSettings,
    estimator: HelixEstimator,
    estimate: Option<HelixEstimate>,
    trusted: bool,
    share: f64,
    steady: [Phasor; 2],
}

/// Everything of it that time changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SyncState {
    estimator: EstimatorState,
    trusted: bool,
    share: f64,
    steady: [Phasor; 2],
}

/// A direction: cosine and sine, no longer than one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Phasor([f64; 2]);

impl Phasor {
    /// Moves by `share` (–) of the way towards `phase` (rad).
    fn lean(&mut self, share: f64, phase: f64) {
        let (sine, cosine) = phase.sin_cos();
        for (own, target) in self.0.iter_mut().zip([cosine, sine]) {
            *own += share * (target - *own);
        }
    }

    /// Its direction (rad).
    fn phase(self) -> f64 {
        self.0[1].atan2(self.0[0])
    }
}

impl PhaseSync {
    /// Joins what `estimator` finds.
    pub fn new(settings: SyncSettings, estimator: HelixEstimator) -> Self {
        Self {
            settings,
            estimator,
            estimate: None,
            trusted: false,
            share: 0.0,
            steady: Default::default(),
        }
    }

    /// Settings.
    pub fn settings(&self) -> &SyncSettings {
        &self.settings
    }

    /// What finds the helix.
    pub fn estimator(&self) -> &HelixEstimator {
        &self.estimator
    }

    /// What was believed at the last instant; nothing before the first.
    pub fn estimate(&self) -> Option<&HelixEstimate> {
        self.estimate.as_ref()
    }

    /// Share of the amplitude that trust allowed at the last instant (–), [`fade-in`](SyncSettings::start) aside.
    pub fn share(&self) -> f64 {
        self.share
    }

    /// What is added to each blade's pitch (rad), given `measurements`.
    pub fn pitch(&mut self, measurements: &Measurements) -> PerBlade<f64> {
        let estimate = self.estimator.update(measurements);
        self.follow_trust(estimate.trust.overall(), measurements.interval);
        self.estimate = Some(estimate);
        // Passing blades make the found phases tremble three times a turn; pitch must not.
        let share = 1.0 - (-measurements.interval * self.settings.rate / (TAU * STEADY)).exp();
        for (steady, axis) in self.steady.iter_mut().zip([estimate.tilt, estimate.yaw]) {
            steady.lean(share, axis.phase);
        }
        let azimuth = measurements.azimuth + self.settings.azimuth_offset;
        to_blades(azimuth, self.commands(measurements.time), measurements.pitch.len())
    }

    /// Tilt and yaw commands (rad) at `time` (s). van Vondelen et al. (2025), Eq. 22.
    fn commands(&self, time: f64) -> FixedFrame {
        let SyncSettings { sense, amplitude, rate, offset, start, .. } = self.settings;
        let amplitude = amplitude * self.share * fade_in(time, start, rate);
        let angle = rate * time + offset;
        FixedFrame {
            average: 0.0,
            tilt: amplitude * (angle + self.steady[0].phase()).sin(),
            yaw: amplitude * (angle + sense.yaw_lead() + self.steady[1].phase()).sin(),
        }
    }

    /// Moves the share towards all or nothing within about one excitation period.
    fn follow_trust(&mut self, trust: f64, interval: f64) {
        let Some([low, high]) = self.settings.trust else {
            (self.trusted, self.share) = (true, 1.0);
            return;
        };
        // A trust that is no number is none.
        self.trusted = trust > if self.trusted { low } else { high };
        let step = interval * self.settings.rate / TAU;
        let target = if self.trusted { 1.0 } else { 0.0 };
        self.share += (target - self.share).clamp(-step, step);
    }

    /// Everything that time changes, for a checkpoint.
    pub fn state(&self) -> SyncState {
        SyncState {
            estimator: self.estimator.state().clone(),
            trusted: self.trusted,
            share: self.share,
            steady: self.steady,
        }
    }

    /// Continues from `state`, which a controller of the same settings gave.
    pub fn restore(&mut self, state: SyncState) {
        self.estimator.restore(state.estimator);
        (self.trusted, self.share, self.steady) = (state.trusted, state.share, state.steady);
    }

    /// In words: "synchronised ccw 4.0° at 150°".
    pub fn describe(&self) -> String {
        let SyncSettings { sense, amplitude, offset, .. } = self.settings;
        if amplitude == 0.0 {
            return "baseline, watching".to_owned();
        }
        format!(
            "synchronised {sense} {:.1}° at {:.0}°",
            amplitude.to_degrees(),
            offset.to_degrees()
        )
    }
}
