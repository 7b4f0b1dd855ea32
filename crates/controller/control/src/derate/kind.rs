//! `kind = "derate"`: its keys, and how it is built.

use super::Derate;
use crate::Controller;
use crate::error::ControlError;
use crate::kind::{Control, ControllerKind, Site};
use basis::keys::LeftOut::Required;
use basis::keys::{Table, from, key};
use basis::registry::Named;

/// De-rating.
pub struct DerateKind;

/// The kind.
pub static DERATE: DerateKind = DerateKind;

static TABLE: Table = Table {
    heading: "control.T1 = { kind = \"derate\", … }",
    about: "Less power than the turbine could take, and less thrust: axial-induction control.",
    keys: &[key(
        "power_percent",
        from(30.0, 100.0),
        "%",
        Required,
        "Share of the baseline's power, at every wind speed, that the turbine takes; 100 is the baseline, bit for bit. The rotor keeps the baseline's speed, and pitches to feather.",
    )],
};

impl Named for DerateKind {
    fn name(&self) -> &'static str {
        "derate"
    }
}

impl ControllerKind for DerateKind {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn build(&self, control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        let share = 0.01 * control.values().number("power_percent");
        if share == 1.0 {
            return Ok(site.baseline());
        }
        let constants = site.constants;
        let derate = match &constants.estimator {
            Some(known) => Derate::new(constants, &known.coefficients, share),
            None => Derate::new(constants, &(site.coefficients)(site.rotor), share),
        };
        Ok(Box::new(derate))
    }

    fn pitches_individually(&self) -> bool {
        false
    }
}
