//! What a reader of a turbine's numbers must know.

use super::Turbine;
use basis::records::{DeliveredPitch, Warning, WarningKind};

/// Share of clipped control instants beyond which a reader must know (–).
const CLIPPED_SHARE: f64 = 0.01;
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
        let own = self.control.kind().pitching(self.control);
        let is_steady = own.is_none_or(|own| own.is_steady);
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
}
