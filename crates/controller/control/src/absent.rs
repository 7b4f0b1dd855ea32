//! `kind = "absent"`: the turbine is not there.

use crate::Controller;
use crate::error::ControlError;
use crate::kind::{Control, ControllerKind, Site};
use basis::keys::Table;
use basis::registry::Named;

/// The turbine is not there in a run.
pub struct Absent;

/// The kind.
pub static ABSENT: Absent = Absent;

static TABLE: Table = Table {
    heading: "control.T1 = { kind = \"absent\" }",
    about: "The turbine is left out of this run: the wake of the others, undisturbed.",
    keys: &[],
};

impl Named for Absent {
    fn name(&self) -> &'static str {
        "absent"
    }
}

impl ControllerKind for Absent {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn build(&self, _: &Control, _: &Site) -> Result<Box<dyn Controller>, ControlError> {
        Err(ControlError::NotThere)
    }

    fn is_there(&self) -> bool {
        false
    }

    fn pitches_individually(&self) -> bool {
        false
    }
}
