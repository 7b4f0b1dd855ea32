//! `kind = "baseline"`: greedy control, nothing on top.

use crate::Controller;
use crate::error::ControlError;
use crate::kind::{Control, ControllerKind, Site};
use basis::keys::Table;
use basis::registry::Named;

/// Greedy control.
pub struct BaselineKind;

/// The kind.
pub static BASELINE: BaselineKind = BaselineKind;

static TABLE: Table = Table {
    heading: "control.T1 = { kind = \"baseline\" }",
    about: "Maximum power below rated, rated power above.",
    keys: &[],
};

impl Named for BaselineKind {
    fn name(&self) -> &'static str {
        "baseline"
    }
}

impl ControllerKind for BaselineKind {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn build(&self, _: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        Ok(site.baseline())
    }

    fn pitches_individually(&self) -> bool {
        false
    }
}
