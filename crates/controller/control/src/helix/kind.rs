//! `kind = "helix"`: its keys, and how it is built.

use super::Helix;
use super::chirp::{self, Chirp};
use crate::Controller;
use crate::discon::base;
use crate::error::ControlError;
use crate::excitation::Excitation;
use crate::held_speed::{HELD_RATIO, held_twice};
use crate::keys::{
    AMPLITUDE, BASE, PHASE_RANGE, SENSE, START, STOP, STROUHAL, TILT_PHASE, sense, starts_too_late,
};
use crate::kind::{Control, ControllerKind, Motion, Pitching, Place, Site};
use crate::library::Hosted;
use crate::stop::stop_of;
use basis::Sense;
use basis::keys::LeftOut::{Otherwise, Value};
use basis::keys::{Key, Objection, Table, Values, above, key};
use basis::registry::Named;

/// The helix.
pub struct HelixKind;

/// The kind.
pub static HELIX: HelixKind = HelixKind;

static TABLE: Table = Table {
    heading: "control.T1 = { kind = \"helix\", … }",
    about: "Individual pitch that moves the thrust centre on a circle, on top of baseline.",
    keys: &[
        SENSE,
        AMPLITUDE,
        STROUHAL,
        key(
            "strouhal_last",
            above(0.0, 2.0),
            "–",
            Otherwise("`strouhal` throughout"),
            "Strouhal number to which the frequency goes evenly from `strouhal` at time zero, over `strouhal_change_time`. No turbine downstream can join a helix whose frequency changes.",
        ),
        Key {
            former_names: &["sweep"],
            ..key(
                "strouhal_change_time",
                above(0.0, 1e6),
                "s",
                Otherwise("needed with `strouhal_last`"),
                "Time that the change of frequency takes, from time zero.",
            )
        },
        TILT_PHASE,
        key(
            "azimuth_offset_deg",
            PHASE_RANGE,
            "deg",
            Value("0"),
            "Azimuth offset of the inverse multi-blade transformation. An open helix has a free phase, of which this is a part: it adds to `phase_deg` (`ccw`) or takes from it (`cw`).",
        ),
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

impl Named for HelixKind {
    fn name(&self) -> &'static str {
        "helix"
    }
}

impl ControllerKind for HelixKind {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn check(&self, values: &mut Values, place: &Place) -> Vec<Objection> {
        starts_too_late(values, place.duration)
            .into_iter()
            .chain(chirp::objections(values))
            .chain(held_twice(values))
            .collect()
    }

    fn build(&self, control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        let values = control.values();
        let (amplitude, strouhal) = (values.angle("amplitude_deg"), values.number("strouhal"));
        let mut helix =
            Helix::new(sense(values), amplitude, strouhal, site.wind_speed, site.diameter);
        helix.phase = values.angle("phase_deg");
        helix.azimuth_offset = values.angle("azimuth_offset_deg");
        helix.start = values.number("start");
        helix.chirp = Chirp::of(values, site);
        helix.stop = stop_of(helix.start, values.optional_number("stop"), helix.rate)?;
        Ok(helix.on_top_of(base(control, site)?))
    }

    fn helix(&self, control: &Control) -> Option<(Sense, f64)> {
        let values = control.values();
        // One frequency is what others can be told of.
        (!values.has("strouhal_last")).then(|| (sense(values), values.number("strouhal")))
    }

    fn hosted(&self, control: &Control) -> Option<Hosted> {
        Hosted::of(control.values())
    }

    fn pitching(&self, control: &Control) -> Option<Pitching> {
        let values = control.values();
        let pitching = Pitching::open_loop(values, Motion::Cyclic, Some(sense(values)));
        Some(Pitching { is_steady: !values.has("strouhal_last"), ..pitching })
    }
}
