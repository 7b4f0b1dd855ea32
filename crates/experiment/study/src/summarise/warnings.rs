//! What a reader of a turbine's numbers must know.

use super::Turbine;
use crate::StudyError;
use crate::columns::Analysed;
use basis::channels::{ROT_SPEED, TIME};
use basis::records::{DeliveredPitch, Warning, WarningKind};

/// Turns a minute in a radian a second.
const RPM: f64 = 30.0 / std::f64::consts::PI;
/// Share of clipped control instants beyond which a reader must know (–).
const CLIPPED_SHARE: f64 = 0.01;
/// Rotor speed over the rated one beyond which a reader must know (–): machines of today shut down at 1.1 to
/// 1.2 of it.
const OVERSPEED: f64 = 1.2;
/// Least share of the set amplitude that the blades must deliver (–).
const DELIVERED_SHARE: f64 = 0.95;

impl Turbine<'_> {
    /// A warning about this turbine.
    pub(super) fn warning(&self, kind: WarningKind, message: String) -> Warning {
        Warning { kind, turbine: Some(self.name.to_owned()), message }
    }

    /// Where its rotor turned much faster than its rated speed in the `analysed` time.
    pub(super) fn warning_of_overspeed(
        &self,
        analysed: &Analysed,
    ) -> Result<Option<Warning>, StudyError> {
        let Self { setup, run, index, name, .. } = self;
        let rated = setup.models[*index].constants.rated_rotor_speed;
        let times = analysed.column(&TIME.name)?;
        let speeds = analysed.column(&ROT_SPEED.at(name))?;
        let instants = times.iter().zip(speeds).map(|(&time, speed)| (time, speed.abs()));
        let fastest = instants.reduce(|a, b| if b.1 > a.1 { b } else { a });
        let Some((time, speed)) = fastest.filter(|(_, speed)| *speed > OVERSPEED * rated) else {
            return Ok(None);
        };
        let n_beyond = speeds.iter().filter(|speed| speed.abs() > OVERSPEED * rated).count();
        let message = format!(
            "{}: {name} turned at {:.2} times its rated speed at {time:.0} s ({:.1} for {:.1} rpm), and beyond {OVERSPEED} times {:.1} % of the time: \
             a real machine would have shut down; power and loads of that time are not those of one that runs",
            run.name,
            speed / rated,
            speed * RPM,
            rated * RPM,
            100.0 * n_beyond as f64 / speeds.len() as f64,
        );
        Ok(Some(self.warning(WarningKind::Overspeed, message)))
    }

    /// Where its blades did not do what they were set to.
    pub(super) fn warning_of_clipping(&self, pitch: Option<DeliveredPitch>) -> Option<Warning> {
        let Self { run, name, left, .. } = self;
        let clipped_share = left.clipped_share;
        let held = 100.0 * clipped_share;
        let is_clipped = clipped_share > CLIPPED_SHARE;
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
