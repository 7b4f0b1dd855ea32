//! The ground truth of a wake's phase, from the wind in the absence of the downstream rotor.

use super::{Band, Narrowband, Reference, narrowband};
use crate::AnalysisError;
use basis::FixedFrame;
use basis::angle::wrap_to_turn;
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

/// One fixed-frame component of the helix wind over time.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisWind {
    /// Its wave within the band (m/s).
    pub wind: Vec<f64>,
    /// Its amplitude A (m/s).
    pub amplitude: Vec<f64>,
    /// Its wind phase φ (rad, [0, 2π)).
    pub phase: Vec<f64>,
}

/// Wind and phases of the helix at equally spaced instants.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundTruth {
    /// Time of the first sample since the run's start (s).
    pub start: f64,
    /// Sampling interval (s).
    pub interval: f64,
    /// Mean wind over the disc (m/s), not filtered.
    pub average: Vec<f64>,
    /// Tilt component.
    pub tilt: AxisWind,
    /// Yaw component.
    pub yaw: AxisWind,
    /// Samples that lie further from both ends than the filter remembers; empty for a short record.
    pub trusted: Range<usize>,
}

impl GroundTruth {
    /// Time of sample `index` since the run's start (s).
    pub fn time(&self, index: usize) -> f64 {
        self.start + index as f64 * self.interval
    }

    /// The sample nearest to `time` (s); none beyond half an interval outside the record.
    pub fn index_at(&self, time: f64) -> Option<usize> {
        let place = ((time - self.start) / self.interval).round();
        (place >= 0.0 && place < self.average.len() as f64).then_some(place as usize)
    }
}

/// Phases of the helix in the fixed-frame `winds` (m/s), the first at `start` (s since the run's start), one
/// every `interval` (s), against `reference`; only what lies in `band` counts as helix.
///
/// Each of tilt and yaw goes through [`narrowband`]; the angle of the analytic signal, less what the
/// reference has turned, is the wind phase as the [module](super) defines it. A [`Band::around`] the
/// excitation with [`Band::RATIO`] follows changes of phase within about two periods and removes turbulence
/// beyond the neighbouring octave.
///
/// Source: van Vondelen et al. (2025), Algorithm 2 and §3.3.1.
///
/// # Errors
/// Those of [`narrowband`], and [`AnalysisError::AboveNyquist`] for an excitation that cannot be sampled.
pub fn ground_truth(
    winds: &[FixedFrame],
    start: f64,
    interval: f64,
    reference: &Reference,
    band: Band,
) -> Result<GroundTruth, AnalysisError> {
    let (frequency, nyquist) = (reference.frequency(), 0.5 / interval);
    if frequency >= nyquist {
        return Err(AnalysisError::AboveNyquist { frequency, nyquist });
    }
    let component = |of: fn(&FixedFrame) -> f64, lead: f64| {
        let samples: Vec<f64> = winds.iter().map(of).collect();
        let Narrowband { wave, amplitude, angle } = narrowband(&samples, interval, band)?;
        let phase = angle.iter().enumerate().map(|(index, angle)| {
            // The analytic signal's angle is that of a cosine, the wind's that of a sine.
            let turned = reference.rate * (start + index as f64 * interval) + lead;
            wrap_to_turn(angle + FRAC_PI_2 - turned)
        });
        Ok(AxisWind { wind: wave, amplitude, phase: phase.collect() })
    };
    let forgotten = (band.memory() / interval).ceil() as usize;
    let end = winds.len().saturating_sub(forgotten);
    Ok(GroundTruth {
        start,
        interval,
        average: winds.iter().map(|wind| wind.average).collect(),
        tilt: component(|wind| wind.tilt, 0.0)?,
        yaw: component(|wind| wind.yaw, reference.sense.yaw_lead())?,
        trusted: forgotten.min(end)..end,
    })
}
