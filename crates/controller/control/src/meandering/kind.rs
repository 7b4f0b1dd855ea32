//! `kind = "meandering"`: its checks, and how it is built.

use super::outcome;
use super::settings::{MeanderingSettings, TABLE};
use super::{Decoupling, Meandering, MeanderingControlSettings, TwoAxisSettings};
use crate::Controller;
use crate::discon::base;
use crate::error::ControlError;
use crate::excitation::Excitation;
use crate::keys::starts_too_late;
use crate::kind::{Control, ControllerKind, Identification, Place, Site};
use crate::library::Hosted;
use crate::outcome::{MissingChannel, Outcome, TurbineRecord};
use basis::Channel;
use basis::keys::{Objection, Table, Values};
use basis::records::PitchResponse;
use basis::registry::Named;
use estimation::phase_locked;

/// Meandering amplified or attenuated.
pub struct MeanderingKind;

/// The kind.
pub static MEANDERING: MeanderingKind = MeanderingKind;

/// Keys of the decoupling: all or none.
const DECOUPLING: [&str; 3] = ["azimuth_offset_deg", "delay", "moment_per_degree_mnm"];
/// Keys of the reference, each with the word of `reference` that it goes with.
const REFERENCES: [(&str, &str); 3] =
    [("reference_tilt_mnm", "given"), ("reference_yaw_mnm", "given"), ("learning_time", "learned")];

impl Named for MeanderingKind {
    fn name(&self) -> &'static str {
        "meandering"
    }
}

/// `key` is missing beside others that need it.
fn missing(key: &'static str, fix: &str) -> Objection {
    Objection {
        key: Some(key),
        message: "is missing".to_owned(),
        label: "should stand in here",
        fix: fix.to_owned(),
    }
}

fn check_strouhal(values: &Values) -> Option<Objection> {
    let (low, high) = (values.number("strouhal_low"), values.number("strouhal_high"));
    (low >= high).then(|| Objection {
        key: Some("strouhal_low"),
        message: format!("= {low} is not below `strouhal_high` = {high}"),
        label: "not below the other",
        fix: "wakes meander between about 0.15 and 0.3; give the loop a range to follow them in"
            .to_owned(),
    })
}

/// What is missing for the reference, and what does not apply to it.
fn check_reference(values: &Values) -> Vec<Objection> {
    let word = values.word("reference");
    let mut objections = Vec::new();
    for (key, needed) in REFERENCES {
        if values.has(key) && word != needed {
            let message = format!(
                "has no effect here: it applies only with reference = \"{needed}\", not \"{word}\""
            );
            let fix = "leave it out".to_owned();
            objections.push(Objection { key: Some(key), message, label: "no effect", fix });
        } else if !values.has(key) && word == "given" && needed == "given" {
            let fix = "reference = \"given\" needs the amplitudes of tilt and yaw moment in the baseline, in MN m";
            objections.push(missing(key, fix));
        }
    }
    objections
}

fn check_decoupling(values: &Values) -> Vec<Objection> {
    let fix = "azimuth_offset_deg, delay and moment_per_degree_mnm go together; leave all three out to have them identified before the runs";
    let is_given = DECOUPLING.iter().any(|key| values.has(key));
    let absent = DECOUPLING.into_iter().filter(|key| is_given && !values.has(key));
    absent.map(|key| missing(key, fix)).collect()
}

impl ControllerKind for MeanderingKind {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn check(&self, values: &mut Values, place: &Place) -> Vec<Objection> {
        let mut objections = Vec::from_iter(check_strouhal(values));
        objections.extend(check_reference(values));
        objections.extend(check_decoupling(values));
        objections.extend(starts_too_late(values, place.duration));
        objections
    }

    fn build(&self, control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        let given = MeanderingSettings::of(control).ok_or(ControlError::NotDecoupled)?;
        let range = given.strouhal.map(|strouhal| site.rate(strouhal));
        let signal = phase_locked::PhaseLockedSettings::between(range);
        let only_follows = given.amplitude == 0.0;
        let decoupling = match given.decoupling {
            Some(decoupling) => decoupling,
            // Nothing is pitched.
            None if only_follows => Decoupling { azimuth_offset: 0.0, delay: 0.0, gain: 1.0 },
            None => return Err(ControlError::NotDecoupled),
        };
        let settings = MeanderingControlSettings {
            follower: TwoAxisSettings { signal, sense: given.sense, leader: given.leader },
            followed: given.followed,
            factor: given.factor,
            reference: given.reference,
            decoupling,
            bandwidth: given.bandwidth,
            proportional: 0.0,
            maximum_amplitude: given.amplitude,
            maximum_offset: if only_follows { 0.0 } else { given.offset },
            needs_lock: given.fallback,
            start: given.start,
        };
        Ok(Meandering::new(settings, site.interval)?.on_top_of(base(control, site)?))
    }

    fn slowest_strouhal(&self, control: &Control) -> Option<f64> {
        control.values().optional_number("strouhal_low")
    }

    fn identification(&self, control: &Control) -> Option<Identification> {
        let given = MeanderingSettings::of(control)?;
        let needs = given.decoupling.is_none() && given.amplitude != 0.0;
        needs.then_some(Identification::Loads { strouhal: given.strouhal })
    }

    fn hosted(&self, control: &Control) -> Option<Hosted> {
        Hosted::of(control.values())
    }

    fn outcome_channels(&self, _: &Control, n_blades: usize) -> Vec<Channel> {
        outcome::channels(n_blades)
    }

    fn outcome(
        &self,
        control: &Control,
        record: &dyn TurbineRecord,
    ) -> Result<Outcome, MissingChannel> {
        outcome::outcome(control, record)
    }

    fn pitch_response(&self, control: &Control) -> Option<PitchResponse> {
        MeanderingSettings::of(control)?.decoupling.map(PitchResponse::from)
    }

    fn any_response(&self) -> Option<PitchResponse> {
        Some(PitchResponse::Loads { azimuth_offset: 0.0, delay: 0.0, gain: 1.0 })
    }
}
