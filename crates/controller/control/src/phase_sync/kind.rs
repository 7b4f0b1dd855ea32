//! `kind = "phase-sync"`: its checks, and how it is built.

use super::settings::{PhaseEstimator, PhaseSyncSettings, TABLE, response_of};
use super::{PhaseSync, Preview, SyncSettings, choices, preview};
use crate::Controller;
use crate::discon::base;
use crate::error::ControlError;
use crate::excitation::Excitation;
use crate::keys::{sense, starts_too_late};
use crate::kind::{Control, ControllerKind, Identification, Motion, Pitching, Place, Site};
use crate::library::Hosted;
use crate::outcome::{MissingChannel, Outcome, TurbineRecord};
use basis::angle::wrap_to_turn;
use basis::channels::SYNC_SHARE;
use basis::keys::{Objection, Table, Values};
use basis::records::{Finding, PitchResponse};
use basis::registry::Named;
use basis::{Channel, Sense};
use estimation::HelixEstimator;
use std::f64::consts::TAU;

/// Share of the time without a trusted phase beyond which a reader must know (–).
const FADED_SHARE: f64 = 0.02;

/// A helix synchronised with the one from upstream.
pub struct PhaseSyncKind;

/// The kind.
pub static PHASE_SYNC: PhaseSyncKind = PhaseSyncKind;

impl Named for PhaseSyncKind {
    fn name(&self) -> &'static str {
        "phase-sync"
    }
}

/// What `control`, which is of this kind, says.
fn settings(control: &Control) -> Result<PhaseSyncSettings, ControlError> {
    PhaseSyncSettings::of(control).ok_or(ControlError::NoAzimuthOffset)
}

impl ControllerKind for PhaseSyncKind {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn check(&self, values: &mut Values, place: &Place) -> Vec<Objection> {
        let mut objections = Vec::from_iter(starts_too_late(values, place.duration));
        if let Some((sense, strouhal)) = place.upstream {
            if !values.has("sense") {
                values.set("sense", if sense == Sense::Clockwise { "cw" } else { "ccw" });
            }
            if !values.has("strouhal") {
                values.set("strouhal", strouhal);
            }
        }
        if !values.has("sense") || !values.has("strouhal") {
            let turbine = place.turbine;
            objections.push(Objection {
                key: None,
                message: format!(
                    "{turbine} is to join a helix, but no turbine upstream of it pitches one in this run"
                ),
                label: "no helix upstream",
                fix: "give a turbine upstream a helix, or set which helix it is: sense = \"ccw\", strouhal = 0.25"
                    .to_owned(),
            });
        }
        if values.number("amplitude_deg") == 0.0 && !values.has("azimuth_offset_deg") {
            // Nothing is pitched, with whatever offset.
            values.set("azimuth_offset_deg", 0.0);
        }
        objections.extend(choices::objections(values));
        objections.extend(preview::objections(values, place));
        objections
    }

    fn build(&self, control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        let given = settings(control)?;
        let setting = given.estimator_setting(site);
        let options = given.estimator_options(site.flow_resolves_induction);
        let options = given.calibration.map_or(options, |found| found.apply(options));
        let estimator = HelixEstimator::new(site.rotor, &setting, options)?;
        let settings = SyncSettings {
            sense: given.sense,
            amplitude: given.amplitude,
            rate: setting.rate,
            offset: wrap_to_turn(given.offset),
            azimuth_offset: given.azimuth_offset.ok_or(ControlError::NoAzimuthOffset)?,
            start: given.start,
            trust: given.trust(),
        };
        let preview = Preview::of(control.values(), site)?;
        Ok(PhaseSync::new(settings, estimator)
            .with_preview(preview)
            .on_top_of(base(control, site)?))
    }

    fn helix(&self, control: &Control) -> Option<(Sense, f64)> {
        Some((sense(control.values()), control.values().number("strouhal")))
    }

    fn pitching(&self, control: &Control) -> Option<Pitching> {
        let given = PhaseSyncSettings::of(control)?;
        Some(Pitching {
            motion: Motion::Cyclic,
            amplitude: given.amplitude,
            strouhal: given.strouhal,
            sense: Some(given.sense),
            phase_offset: Some(given.offset),
            start: given.start,
            stop: None,
            is_steady: false,
        })
    }

    fn identification(&self, control: &Control) -> Option<Identification> {
        let given = PhaseSyncSettings::of(control)?;
        let open = given.azimuth_offset.is_none() || given.estimator == PhaseEstimator::Robust;
        (open && given.amplitude != 0.0).then_some(Identification::OwnPitch(given))
    }

    fn pitch_response(&self, control: &Control) -> Option<PitchResponse> {
        let given = PhaseSyncSettings::of(control)?;
        let azimuth_offset = given.azimuth_offset.filter(|_| given.amplitude != 0.0)?;
        Some(response_of(azimuth_offset, given.calibration))
    }

    fn any_response(&self) -> Option<PitchResponse> {
        Some(PitchResponse::Transformation { azimuth_offset: 0.0 })
    }

    fn hosted(&self, control: &Control) -> Option<Hosted> {
        Hosted::of(control.values())
    }

    fn outcome_channels(&self, control: &Control, _: usize) -> Vec<Channel> {
        let looks_ahead = control.values().has("preview");
        let seen = looks_ahead.then(Preview::signals).into_iter().flatten();
        std::iter::once(SYNC_SHARE).chain(seen).collect()
    }

    fn outcome(
        &self,
        control: &Control,
        record: &dyn TurbineRecord,
    ) -> Result<Outcome, MissingChannel> {
        let mut outcome = if control.values().has("preview") {
            preview::outcome(record)?
        } else {
            Outcome::default()
        };
        if control.values().number("amplitude_deg") == 0.0 {
            return Ok(outcome);
        }
        let share = record.column(&SYNC_SHARE)?;
        let n_faded = share.iter().filter(|share| **share < 0.5).count();
        let faded = n_faded as f64 / share.len().max(1) as f64;
        let finding = Finding {
            name: "faded-share".to_owned(),
            value: Some(faded),
            unit: "–".to_owned(),
            about: "share of the time in which the phase estimate was not trusted and baseline ran"
                .to_owned(),
        };
        let warning = || {
            format!(
                " did not trust its phase estimate {:.0} % of the time, and ran baseline then",
                100.0 * faded
            )
        };
        outcome.findings.push(finding);
        outcome.warnings.extend((faded > FADED_SHARE).then(warning));
        Ok(outcome)
    }

    fn warnings(&self, control: &Control) -> Vec<String> {
        let given = control.values().angle("offset_deg");
        if (0.0..TAU).contains(&given) {
            return Vec::new();
        }
        let taken = wrap_to_turn(given);
        let [given, taken] = [given, taken].map(f64::to_degrees);
        vec![format!("'s offset of {given:.0}° is taken as {taken:.0}°")]
    }
}
