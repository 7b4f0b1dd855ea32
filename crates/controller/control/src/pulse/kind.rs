//! `kind = "pulse"`: its keys, and how it is built.

use super::Pulse;
use crate::Controller;
use crate::discon::base;
use crate::error::ControlError;
use crate::excitation::Excitation;
use crate::held_speed::{HELD_RATIO, held_twice};
use crate::keys::{AMPLITUDE, BASE, PHASE_RANGE, START, STOP, STROUHAL, starts_too_late};
use crate::kind::{Control, ControllerKind, Motion, Pitching, Place, Site};
use crate::library::Hosted;
use crate::stop::stop_of;
use basis::keys::LeftOut::Value;
use basis::keys::{Objection, Table, Values, key};
use basis::registry::Named;

/// The pulse.
pub struct PulseKind;

/// The kind.
pub static PULSE: PulseKind = PulseKind;

static TABLE: Table = Table {
    heading: "control.T1 = { kind = \"pulse\", … }",
    about: "Collective pitch, periodic, on top of baseline.",
    keys: &[
        AMPLITUDE,
        STROUHAL,
        key("phase_deg", PHASE_RANGE, "deg", Value("0"), "Phase at time zero."),
        START,
        STOP,
        HELD_RATIO,
        BASE[0],
        BASE[1],
        BASE[2],
        BASE[3],
        BASE[4],
    ],
};

impl Named for PulseKind {
    fn name(&self) -> &'static str {
        "pulse"
    }
}

impl ControllerKind for PulseKind {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn check(&self, values: &mut Values, place: &Place) -> Vec<Objection> {
        starts_too_late(values, place.duration).into_iter().chain(held_twice(values)).collect()
    }

    fn build(&self, control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        let values = control.values();
        let (amplitude, strouhal) = (values.angle("amplitude_deg"), values.number("strouhal"));
        let mut pulse = Pulse::new(amplitude, strouhal, site.wind_speed, site.diameter);
        pulse.phase = values.angle("phase_deg");
        pulse.start = values.number("start");
        pulse.stop = stop_of(pulse.start, values.optional_number("stop"), pulse.rate)?;
        Ok(pulse.on_top_of(base(control, site)?))
    }

    fn pitches_individually(&self) -> bool {
        false
    }

    fn hosted(&self, control: &Control) -> Option<Hosted> {
        Hosted::of(control.values())
    }

    fn pitching(&self, control: &Control) -> Option<Pitching> {
        Some(Pitching::open_loop(control.values(), Motion::Collective, None))
    }
}
