//! `kind = "discon"`: its keys, and how any other kind goes on top of a library.

use super::Discon;
use crate::Controller;
use crate::error::ControlError;
use crate::held_speed::held_or_greedy;
use crate::keys::BASE;
use crate::kind::{Control, ControllerKind, Site};
use crate::library::{Hosted, LibraryError};
use basis::keys::LeftOut::Required;
use basis::keys::{Holds, Table, key};
use basis::registry::Named;
use std::sync::Arc;

/// A controller in a shared library.
pub struct DisconKind;

/// The kind.
pub static DISCON: DisconKind = DisconKind;

static TABLE: Table = Table {
    heading: "control.T1 = { kind = \"discon\", … }",
    about: "A controller of one's own, in a shared library with Bladed's interface, such as ROSCO. `docs/how-to/own-controller.md` has the records.",
    keys: &[
        key("library", Holds::Text, "", Required, LIBRARY_ABOUT),
        BASE[1],
        BASE[2],
        BASE[3],
        BASE[4],
    ],
};

const LIBRARY_ABOUT: &str = "The shared library, such as `libdiscon.so`; a path relative to the case file. Each turbine runs a copy, with a state of its own.";

/// What decides pitch and torque under an excitation of `control` on the turbine at `site`: the library that
/// it names, or greedy control, with its speed held where that is asked for.
///
/// # Errors
/// [`ControlError::Library`].
pub(crate) fn base(control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
    let Some(hosted) = Hosted::of(control.values()) else {
        return Ok(held_or_greedy(control.values(), site));
    };
    let libraries = control.libraries.as_ref().ok_or_else(|| {
        ControlError::Library(LibraryError(format!(
            "nobody opens {}: `libraries` of its `Control` is not set; a study sets it",
            hosted.request.library
        )))
    })?;
    Ok(Box::new(Discon::new(&hosted, Arc::clone(libraries), site)?))
}

impl Named for DisconKind {
    fn name(&self) -> &'static str {
        "discon"
    }
}

impl ControllerKind for DisconKind {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn build(&self, control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        base(control, site)
    }

    fn turns_nacelle(&self) -> bool {
        true
    }

    fn hosted(&self, control: &Control) -> Option<Hosted> {
        Hosted::of(control.values())
    }

    fn pitches_individually(&self) -> bool {
        false
    }
}
