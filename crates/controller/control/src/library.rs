//! The seam to controllers that come as shared libraries: what is asked of whoever opens them.
//!
//! This room opens no files. A study gives each [`Control`](crate::Control) that runs a library its
//! [`Libraries`]; what they open answers as a [`Library`].

use basis::keys::Values;
use std::fmt;
use thiserror::Error;

/// Name of the sensor that shows the wind to a library, where the case names none.
pub const ANEMOMETER: &str = "anemometer";

/// Opens shared libraries.
pub trait Libraries: Send + Sync {
    /// An instance of the library that is `asked` for, with a state of its own whoever else runs it.
    ///
    /// # Errors
    /// [`LibraryError`] for a file that is not there, that is no library of this machine, or that lacks the
    /// procedure.
    fn open(&self, asked: &Request) -> Result<Box<dyn Library>, LibraryError>;
}

/// A shared library with Bladed's interface, at work on one turbine.
pub trait Library: Send {
    /// One call with `swap`, whose record n is element n − 1. The records of the lengths of texts are filled
    /// here, see [`Texts`](crate::discon::TEXTS). Gives `aviFAIL`: 0, a warning above, an error below.
    fn call(&mut self, swap: &mut [f32]) -> i32;

    /// What it said in `avcMSG` at the last call; empty when nothing.
    fn message(&self) -> String;
}

/// A library as a case asks for it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Request {
    /// Path of the library as the case has it.
    pub library: String,
    /// Path of its input file as the case has it; none where it reads none.
    pub input: Option<String>,
    /// Name of the procedure.
    pub procedure: String,
}

/// A library as the values of a controller ask for it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hosted {
    /// Library, input file and procedure.
    pub request: Request,
    /// Whether each blade has a pitch of its own.
    pub is_individual: bool,
    /// Sensor that shows it the wind; none for a library that looks at no wind.
    pub anemometer: Option<String>,
}

impl Hosted {
    /// The library that `values` ask for; none where they ask for none.
    pub(crate) fn of(values: &Values) -> Option<Self> {
        if !values.has("library") {
            return None;
        }
        let or = |key: &str, otherwise: &str| {
            if values.has(key) { values.word(key) } else { otherwise }.to_owned()
        };
        let anemometer = or("anemometer", ANEMOMETER);
        Some(Self {
            request: Request {
                library: or("library", ""),
                input: values.has("input").then(|| or("input", "")),
                procedure: or("procedure", "DISCON"),
            },
            is_individual: or("pitch_control", "individual") == "individual",
            anemometer: (anemometer != "none").then_some(anemometer),
        })
    }
}

/// Why a library cannot serve: the file, what was expected, and the fix.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{0}")]
pub struct LibraryError(pub String);

impl fmt::Debug for dyn Libraries {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("libraries")
    }
}
