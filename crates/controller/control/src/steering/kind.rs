//! `kind = "steering"`: its keys, and how it is built.

use super::Steering;
use crate::Controller;
use crate::error::ControlError;
use crate::excitation::Excitation;
use crate::keys::starts_too_late;
use crate::kind::{Control, ControllerKind, Place, Site};
use crate::outcome::{MissingChannel, Outcome, TurbineRecord};
use basis::Channel;
use basis::channels::NAC_YAW;
use basis::keys::LeftOut::{Required, Value};
use basis::keys::{Objection, Table, Values, above, from, key};
use basis::registry::Named;

/// Wake steering.
pub struct SteeringKind;

/// The kind.
pub static STEERING: SteeringKind = SteeringKind;

/// A nacelle that is farther away from where it is steered to is still on its way (rad): a degree.
const STILL_TURNING: f64 = std::f64::consts::PI / 180.0;

static TABLE: Table = Table {
    heading: "control.T1 = { kind = \"steering\", … }",
    about: "The nacelle turns out of the wind, on top of baseline: the wake goes to the right looking downwind for a positive yaw.",
    keys: &[
        key(
            "yaw_deg",
            from(-60.0, 60.0),
            "deg",
            Required,
            "Yaw misalignment that it turns to, positive counter-clockwise seen from above, from the `yaw_deg` of its `[[turbine]]`; 0 faces the wind.",
        ),
        key(
            "rate_deg_per_s",
            above(0.0, 5.0),
            "deg/s",
            Value("0.3"),
            "Greatest rate of the turn; the last degrees are made more slowly.",
        ),
        key(
            "start",
            from(0.0, 1e6),
            "s",
            Value("0"),
            "Time from which it turns; before `time.duration`. What is to be analysed begins once the wake has followed: leave time for it in `time.spin_up`.",
        ),
    ],
};

impl Named for SteeringKind {
    fn name(&self) -> &'static str {
        "steering"
    }
}

impl ControllerKind for SteeringKind {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn check(&self, values: &mut Values, place: &Place) -> Vec<Objection> {
        Vec::from_iter(starts_too_late(values, place.duration))
    }

    fn build(&self, control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        let values = control.values();
        let steering = Steering {
            yaw: values.angle("yaw_deg"),
            maximum_rate: values.angle("rate_deg_per_s"),
            start: values.number("start"),
        };
        Ok(steering.on_top_of(site.baseline()))
    }

    fn pitches_individually(&self) -> bool {
        false
    }

    fn turns_nacelle(&self) -> bool {
        true
    }

    fn outcome_channels(&self, _: &Control, _: usize) -> Vec<Channel> {
        vec![NAC_YAW]
    }

    fn outcome(
        &self,
        control: &Control,
        record: &dyn TurbineRecord,
    ) -> Result<Outcome, MissingChannel> {
        let target = control.values().angle("yaw_deg");
        let away =
            record.column(&NAC_YAW)?.iter().map(|yaw| (yaw - target).abs()).fold(0.0, f64::max);
        let warning = (away > STILL_TURNING).then(|| {
            format!(
                " stood up to {:.1}° away from the yaw that it was steered to while the run was analysed; raise time.spin_up, or start earlier",
                away.to_degrees()
            )
        });
        Ok(Outcome { warnings: Vec::from_iter(warning), ..Outcome::default() })
    }
}
