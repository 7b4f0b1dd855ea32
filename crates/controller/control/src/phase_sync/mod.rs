//! Phase synchronisation: a turbine in a helix joins it, a chosen angle ahead of or behind the wind that
//! meets it.
//!
//! Source: van Vondelen et al. (2025), "Synchronized Helix wake mixing control", Wind Energ. Sci. 10, 2411,
//! Eq. 22:
//!
//! ```text
//! tilt = A sin(ω_e t + φ̂_tilt + φ_off)     yaw = A sin(ω_e t ± π/2 + φ̂_yaw + φ_off)     upper sign: ccw
//! ```
//!
//! with the phases φ̂ of the wind that [`HelixEstimator`] finds. Offset 0: pitch rises where the wind does,
//! and the blades lose load there; offset 180°: pitch falls where the wind rises.
//!
//! The blades follow by the inverse multi-blade transformation with the azimuth offset ψ_o, which multiplies
//! tilt + j yaw by e^(−jψ_o). Where both axes have one phase that is another phase: the blades pitch as with
//! φ_off + ψ_o (ccw) or φ_off − ψ_o (cw) and no azimuth offset. What the axes' phases differ by is a wave of
//! the other sense, which is turned the other way.
//!
//! With a lidar that looks upwind the wave that meets the rotor is known before it comes: what a [`Preview`]
//! finds then takes the place of the wave in the loads, as far as the lidar sees. That goes beyond the paper.
//!
//! What the paper leaves open: the excitation is as strong as the estimate is trusted. Where the wind carries
//! no helix, or the loads go missing, it fades to the baseline, and comes back when the helix does.

mod choices;
mod kind;
mod preview;
mod settings;

pub use choices::{Adapts, EstimatorChoices};
pub use kind::PHASE_SYNC;
pub use preview::Preview;
pub use settings::{
    PhaseEstimator, PhaseNoise, PhaseSyncSettings, azimuth_offset_of, calibration_of, response_of,
};

use crate::controller::{ForeignState, from_bytes, to_bytes};
use crate::excitation::{Excitation, add, fade_in};
use basis::mbc::to_blades;
use basis::{Channel, FixedFrame, Measurements, PerBlade, Sense};
use estimation::helix::{HelixEstimatorState as EstimatorState, PreviewState};
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
    /// Trust (–) below which the excitation fades out, and above which it comes back; none: it never fades
    /// out.
    pub trust: Option<[f64; 2]>,
}

impl SyncSettings {
    /// Tilt and yaw commands (rad) at `time` (s), of a `share` (–) of the amplitude, where tilt and yaw of
    /// the wind have the `phases` (rad). van Vondelen et al. (2025), Eq. 22.
    fn commands(&self, time: f64, share: f64, phases: [f64; 2]) -> FixedFrame {
        let Self { sense, amplitude, rate, offset, start, .. } = *self;
        let amplitude = amplitude * share * fade_in(time, start, rate);
        let angle = rate * time + offset;
        FixedFrame {
            average: 0.0,
            tilt: amplitude * (angle + phases[0]).sin(),
            yaw: amplitude * (angle + sense.yaw_lead() + phases[1]).sin(),
        }
    }
}

/// Trust below which the excitation fades out, and above which it comes back (–).
///
/// [`Trust::overall`](estimation::helix::Trust::overall) lies near 0 in turbulence without a helix; five
/// diameters behind one it was 0.2 to 0.5 in large-eddy flow (docs/validation/synchronised-helix.md).
pub const TRUST: [f64; 2] = [0.05, 0.15];

/// Excitation periods over which the found phases are steadied before they pitch (–).
const STEADY: f64 = 1.0 / 16.0;

/// The controller, with its estimator.
#[derive(Clone, Debug)]
pub struct PhaseSync {
    settings: SyncSettings,
    estimator: HelixEstimator,
    preview: Option<Preview>,
    estimate: Option<HelixEstimate>,
    trusted: bool,
    share: f64,
    steady: [Phasor; 2],
}

/// Everything of it that time changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct SyncState {
    estimator: EstimatorState,
    preview: Option<PreviewState>,
    trusted: bool,
    share: f64,
    steady: [Phasor; 2],
}

/// A direction: cosine and sine, no longer than one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Phasor([f64; 2]);

impl Phasor {
    /// Moves by `share` (–) of the way towards `phase` (rad).
    fn smooth(&mut self, share: f64, phase: f64) {
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
            preview: None,
            estimate: None,
            trusted: false,
            share: 0.0,
            steady: Default::default(),
        }
    }

    /// It, which sees the helix ahead through `preview` where there is one.
    pub fn with_preview(self, preview: Option<Preview>) -> Self {
        Self { preview, ..self }
    }

    /// Settings.
    pub fn settings(&self) -> &SyncSettings {
        &self.settings
    }

    /// What finds the helix.
    pub fn estimator(&self) -> &HelixEstimator {
        &self.estimator
    }

    /// Estimate at the last instant; none before the first.
    pub fn estimate(&self) -> Option<&HelixEstimate> {
        self.estimate.as_ref()
    }

    /// Share of the amplitude that trust allowed at the last instant (–), [`fade-in`](SyncSettings::start)
    /// aside.
    pub fn share(&self) -> f64 {
        self.share
    }

    /// What is added to each blade's pitch (rad), given `measurements`.
    pub fn pitch(&mut self, measurements: &Measurements) -> PerBlade<f64> {
        let estimate = self.estimator.update(measurements);
        let estimate = match &mut self.preview {
            Some(preview) => preview.update(measurements, estimate),
            None => estimate,
        };
        self.follow_trust(estimate.trust.overall(), measurements.interval);
        self.estimate = Some(estimate);
        // Passing blades make the found phases tremble three times a turn; pitch must not.
        let share = 1.0 - (-measurements.interval * self.settings.rate / (TAU * STEADY)).exp();
        for (steady, axis) in self.steady.iter_mut().zip([estimate.tilt, estimate.yaw]) {
            steady.smooth(share, axis.phase);
        }
        let azimuth = measurements.azimuth + self.settings.azimuth_offset;
        let phases = self.steady.map(Phasor::phase);
        let commands = self.settings.commands(measurements.time, self.share, phases);
        to_blades(azimuth, commands, measurements.pitch.len())
    }

    /// Moves the share towards all or nothing within about one excitation period.
    fn follow_trust(&mut self, trust: f64, interval: f64) {
        let Some([low, high]) = self.settings.trust else {
            (self.trusted, self.share) = (true, 1.0);
            return;
        };
        // A trust that is not a number is none.
        self.trusted = trust > if self.trusted { low } else { high };
        let step = interval * self.settings.rate / TAU;
        let target = if self.trusted { 1.0 } else { 0.0 };
        self.share += (target - self.share).clamp(-step, step);
    }
}

impl Excitation for PhaseSync {
    fn add_to(&mut self, pitch: &mut PerBlade<f64>, measurements: &Measurements) {
        let added = PhaseSync::pitch(self, measurements);
        if self.settings.amplitude == 0.0 {
            return;
        }
        add(pitch, &added);
    }

    fn describe(&self) -> String {
        let SyncSettings { sense, amplitude, offset, .. } = self.settings;
        if amplitude == 0.0 {
            return "baseline, monitoring".to_owned();
        }
        let (amplitude, offset) = (amplitude.to_degrees(), offset.to_degrees());
        format!("synchronised {sense} {amplitude:.1}° at {offset:.0}°")
    }

    fn signals(&self) -> Vec<Channel> {
        let mut signals = basis::channels::of_phase_sync();
        signals.extend(self.preview.iter().flat_map(|_| Preview::signals()));
        signals
    }

    fn write_signals(&self, values: &mut [f64]) {
        let Some(estimate) = &self.estimate else { return };
        let values = match &self.preview {
            Some(preview) => {
                let (own, seen) = values.split_at_mut(values.len() - Preview::signals().len());
                preview.write_signals(seen);
                own
            }
            None => values,
        };
        values.copy_from_slice(&[
            estimate.mean_wind,
            estimate.helix.tilt,
            estimate.helix.yaw,
            estimate.tilt.amplitude,
            estimate.yaw.amplitude,
            estimate.tilt.phase,
            estimate.yaw.phase,
            estimate.tilt.phase_variance.sqrt(),
            estimate.yaw.phase_variance.sqrt(),
            estimate.mean_wind_variance.sqrt(),
            estimate.helix_deviation[0],
            estimate.helix_deviation[1],
            estimate.trust.overall(),
            self.share,
        ]);
    }

    fn save(&self) -> Vec<u8> {
        to_bytes(&SyncState {
            estimator: self.estimator.state().clone(),
            preview: self.preview.as_ref().map(|preview| preview.state().clone()),
            trusted: self.trusted,
            share: self.share,
            steady: self.steady,
        })
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        let state: SyncState = from_bytes(state)?;
        match (&mut self.preview, state.preview) {
            (Some(preview), Some(state)) => preview.restore(state),
            (None, None) => {}
            _ => return Err(ForeignState),
        }
        self.estimator.restore(state.estimator);
        (self.trusted, self.share, self.steady) = (state.trusted, state.share, state.steady);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn settings(sense: Sense, offset: f64, azimuth_offset: f64) -> SyncSettings {
        let (amplitude, rate) = (0.07, 0.069);
        SyncSettings { sense, amplitude, rate, offset, azimuth_offset, start: -1e6, trust: None }
    }

    /// Pitch (rad) of three blades at `time` (s), the first at `azimuth` (rad), that follow `phases` (rad).
    fn blades(settings: &SyncSettings, time: f64, azimuth: f64, phases: [f64; 2]) -> PerBlade<f64> {
        to_blades(azimuth + settings.azimuth_offset, settings.commands(time, 1.0, phases), 3)
    }

    proptest! {
        /// Axes half a turn apart in phase make a wave of the other sense, which an azimuth offset turns the
        /// other way.
        #[test]
        fn an_azimuth_offset_is_another_offset_where_both_axes_have_one_phase(
            offset in 0.0..TAU, azimuth_offset in -PI..PI, phase in -PI..PI,
            time in 0.0..3000.0_f64, azimuth in 0.0..TAU,
        ) {
            for (sense, sign) in [(Sense::CounterClockwise, 1.0), (Sense::Clockwise, -1.0)] {
                for (apart, sign) in [(0.0, sign), (PI, -sign)] {
                    let phases = [phase, phase + apart];
                    let turned = settings(sense, offset, azimuth_offset);
                    let plain = settings(sense, offset + sign * azimuth_offset, 0.0);
                    let turned = blades(&turned, time, azimuth, phases);
                    let plain = blades(&plain, time, azimuth, phases);
                    for (turned, plain) in turned.iter().zip(plain.iter()) {
                        prop_assert!((turned - plain).abs() < 1e-12);
                    }
                }
            }
        }
    }
}
