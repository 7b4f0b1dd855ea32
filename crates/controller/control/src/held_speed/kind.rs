//! `kind = "held-speed"`: its keys, how it is built, and how excitations go on top of it.

use super::HeldSpeed;
use crate::Controller;
use crate::error::ControlError;
use crate::kind::{Control, ControllerKind, Site};
use basis::keys::LeftOut::Otherwise;
use basis::keys::{Key, Objection, Table, Values, from, key};
use basis::registry::Named;

/// Speed held by torque.
pub struct HeldSpeedKind;

/// The kind.
pub static HELD_SPEED: HeldSpeedKind = HeldSpeedKind;

/// Under an excitation.
pub(crate) const HELD_RATIO: Key = key(
    "held_tip_speed_ratio",
    from(1.0, 20.0),
    "–",
    Otherwise("torque as in `baseline`"),
    "Torque holds the rotor at this tip-speed ratio of `wind.speed`, as `kind = \"held-speed\"` does.",
);

static TABLE: Table = Table {
    heading: "control.T1 = { kind = \"held-speed\", … }",
    about: "Torque holds the rotor at one speed, as with models in wind tunnels; pitch as in baseline.",
    keys: &[Key {
        left_out: Otherwise("the turbine's optimal one"),
        about: "Tip-speed ratio of `wind.speed` at which the rotor is held, below rated wind.",
        ..HELD_RATIO
    }],
};

/// What decides pitch and torque on the turbine at `site` where `values` name no library: greedy control,
/// its torque in the place of greedy torque where they ask for a speed to be held.
pub(crate) fn held_or_greedy(values: &Values, site: &Site) -> Box<dyn Controller> {
    match values.optional_number(HELD_RATIO.name) {
        Some(ratio) => Box::new(HeldSpeed::new(site.constants, ratio, site.wind_speed)),
        None => site.baseline(),
    }
}

/// What about `values` cannot be: a library decides on torque, too.
pub(crate) fn held_twice(values: &Values) -> Option<Objection> {
    (values.has(HELD_RATIO.name) && values.has("library")).then(|| Objection {
        key: Some(HELD_RATIO.name),
        message: "has no effect beside `library`, which decides on torque".to_owned(),
        label: "twice",
        fix: "leave one of the two out".to_owned(),
    })
}

impl Named for HeldSpeedKind {
    fn name(&self) -> &'static str {
        "held-speed"
    }
}

impl ControllerKind for HeldSpeedKind {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn build(&self, control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        let ratio = control.values().optional_number(HELD_RATIO.name);
        let ratio = ratio.unwrap_or(site.constants.optimal_tip_speed_ratio);
        Ok(Box::new(HeldSpeed::new(site.constants, ratio, site.wind_speed)))
    }

    fn pitches_individually(&self) -> bool {
        false
    }
}
