//! What a reader of a turbine's numbers must know.

use super::Turbine;
use crate::StudyError;
use crate::columns::Analysed;
use basis::records::{DeliveredPitch, MeanderingSummary, Warning, WarningKind};
use farm::case::Control;

/// Share of clipped control instants beyond which a reader must know (–).
const CLIPPED_SHARE: f64 = 0.01;
/// Share of the time without a trusted phase beyond which a reader must know (–).
const FADED_SHARE: f64 = 0.02;
/// Least share of the set amplitude that the blades must deliver (–).
const DELIVERED_SHARE: f64 = 0.95;

impl Turbine<'_> {
    /// A warning about this turbine.
    pub(super) fn warning(&self, kind: WarningKind, message: String) -> Warning {
        Warning { kind, turbine: Some(self.name.to_owned()), message }
    }

    /// Where its blades did not do what they were set to.
    pub(super) fn warning_of_clipping(&self, pitch: Option<DeliveredPitch>) -> Option<Warning> {
        let Self { run, name, clipped_share, .. } = self;
        let held = 100.0 * clipped_share;
        let is_clipped = *clipped_share > CLIPPED_SHARE;
        // A phase that follows the wind spreads the line: what is missing of it was not held back.
        let is_steady = !matches!(self.control, Control::PhaseSync(_));
        let message = match pitch {
            None if is_clipped => {
                format!("{}: a pitch limit held {name} back {held:.0} % of the time", run.name)
            }
            Some(DeliveredPitch {
                commanded_amplitude_deg: set,
                delivered_amplitude_deg: delivered,
                ..
            }) if is_clipped || is_steady && delivered < DELIVERED_SHARE * set => format!(
                "{}: {name} delivered {delivered:.2}° of the {set:.2}° that it was set to; a pitch limit held it back {held:.0} % of the time",
                run.name
            ),
            _ => return None,
        };
        Some(self.warning(WarningKind::PitchHeldBack, message))
    }

    /// Where it was set to join a helix and could not trust its estimate.
    pub(super) fn warning_of_fading(
        &self,
        analysed: &Analysed,
    ) -> Result<Option<Warning>, StudyError> {
        let Control::PhaseSync(sync) = self.control else { return Ok(None) };
        if sync.amplitude == 0.0 {
            return Ok(None);
        }
        let share = analysed.column(&format!("{}.sync_share", self.name))?;
        let faded =
            share.iter().filter(|share| **share < 0.5).count() as f64 / share.len().max(1) as f64;
        if faded <= FADED_SHARE {
            return Ok(None);
        }
        let message = format!(
            "{}: {} could not trust the phase that it found {:.0} % of the time, and ran baseline meanwhile",
            self.run.name,
            self.name,
            100.0 * faded
        );
        Ok(Some(self.warning(WarningKind::Controller, message)))
    }

    /// Where it was set to act on meandering and `found` nothing to lock to.
    pub(super) fn warning_of_no_lock(&self, found: Option<MeanderingSummary>) -> Option<Warning> {
        let found = found.filter(|found| found.locked_share < 1.0 - FADED_SHARE)?;
        let Control::Meandering(set) = self.control else { return None };
        (set.amplitude != 0.0 && set.fallback).then(|| {
            let message = format!(
                "{}: {} was locked to the wake's motion {:.0} % of the time, and pitched nothing of its own meanwhile",
                self.run.name,
                self.name,
                100.0 * found.locked_share
            );
            self.warning(WarningKind::Controller, message)
        })
    }
}
