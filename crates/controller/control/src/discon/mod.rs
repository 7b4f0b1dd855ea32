//! A controller of others, in a shared library with Bladed's interface (DISCON).
//!
//! The library sees what every controller sees: instruments and named sensors, in the records of the
//! [swap array](swap). It decides pitch and torque; an [excitation](crate::Excitation) may go on top of that.
//! What a library does beyond its procedure, this room cannot know: it may allocate, block, open files and
//! fail. A failure ends the run.

mod journal;
mod kind;
mod remarks;
mod swap;

pub use kind::DISCON;
pub(crate) use kind::base;
pub use swap::{N_RECORDS, TEXTS};

use crate::controller::{Controller, ForeignState, from_bytes, to_bytes};
use crate::error::ControlError;
use crate::kind::Site;
use crate::library::{Hosted, Libraries, Library, LibraryError, Request};
use basis::{Commands, Measurements, PerBlade};
use journal::Journal;
use remarks::Remarks;
use std::sync::Arc;
use swap::{BRAKE, CONTACTOR, Layout, OVERRIDES, Returned, STATUS, Sent, get, put};

/// Status of the first call, of those after it, and of the last.
const STATUSES: [f32; 3] = [0.0, 1.0, -1.0];
/// Calls that a journal has room for at once, at most (–).
const MOST_ROOM: f64 = 1e7;

/// A library at work on one turbine; it is opened with the first update.
pub struct Discon {
    libraries: Arc<dyn Libraries>,
    request: Request,
    layout: Layout,
    swap: Vec<f32>,
    library: Option<Box<dyn Library>>,
    journal: Journal,
    remarks: Remarks,
    failure: Option<String>,
}

impl Discon {
    /// The library of `hosted`, which `libraries` open, on the turbine at `site`.
    ///
    /// # Errors
    /// [`ControlError::Library`] for a rotor that the interface does not know.
    pub fn new(
        hosted: &Hosted,
        libraries: Arc<dyn Libraries>,
        site: &Site,
    ) -> Result<Self, ControlError> {
        let n_blades = site.rotor.n_blades;
        if n_blades > swap::MOST_BLADES {
            return Err(ControlError::Library(LibraryError(format!(
                "Bladed's interface knows {} blades, the rotor has {n_blades}: take a controller of the program's own",
                swap::MOST_BLADES
            ))));
        }
        let layout = Layout::new(hosted, site);
        let n_calls = (site.duration / site.interval).clamp(0.0, MOST_ROOM) as usize + 2;
        Ok(Self {
            libraries,
            request: hosted.request.clone(),
            swap: layout.blank(),
            layout,
            library: None,
            journal: Journal::with_room(n_calls),
            remarks: Remarks::default(),
            failure: None,
        })
    }

    /// One call with `sent`.
    ///
    /// # Errors
    /// Why the run cannot go on, in words.
    fn exchange(&mut self, sent: &Sent) -> Result<Returned, String> {
        let library = match &mut self.library {
            Some(library) => library,
            None => self.library.insert(self.libraries.open(&self.request).map_err(|e| e.0)?),
        };
        let is_first = !self.journal.is_begun();
        self.layout.send(&mut self.swap, sent);
        put(&mut self.swap, STATUS, if is_first { STATUSES[0] } else { STATUSES[1] });
        let flag = library.call(&mut self.swap);
        if flag != 0 {
            let message = library.message();
            let message = if message.is_empty() { "(no message)" } else { &message };
            if flag < 0 {
                return Err(format!("it failed with aviFAIL = {flag}: {message}"));
            }
            self.remarks.add(sent[0], &format!("warned with aviFAIL = {flag}: {message}"));
        }
        self.look_at(sent[0])?;
        let returned = swap::returned(&self.swap);
        self.journal.add(*sent, returned);
        Ok(returned)
    }

    /// Whether what came back at `time` (s) can be done; remembers what cannot, and does no harm.
    ///
    /// # Errors
    /// What cannot be done, in words.
    fn look_at(&mut self, time: f32) -> Result<(), String> {
        let library = &self.request.library;
        for record in swap::RETURNED {
            let value = get(&self.swap, record);
            if !value.is_finite() {
                return Err(format!(
                    "record {record} came back as {value}, which no turbine can do"
                ));
            }
        }
        for (record, quantity) in OVERRIDES.into_iter().zip(["pitch", "torque"]) {
            if get(&self.swap, record).round() != 0.0 {
                return Err(format!(
                    "it leaves {quantity} to a built-in controller (record {record} = {}), and there is none beside it: set the record to 0 in {library}",
                    get(&self.swap, record)
                ));
            }
        }
        let contactor = get(&self.swap, CONTACTOR).round();
        if contactor != 0.0 && contactor != 1.0 {
            return Err(format!(
                "it switches to generator {contactor} (record {CONTACTOR}); there are 0, off, and 1: correct it in {library}"
            ));
        }
        if get(&self.swap, BRAKE) != 0.0 {
            let about = "asks for the shaft brake, which the turbine does not have";
            self.remarks.add(time, &format!("{about} (record {BRAKE})"));
        }
        Ok(())
    }

    /// Sends all that `journal` has, and finds what came back then.
    ///
    /// # Errors
    /// Why the run cannot go on, in words.
    fn repeat(&mut self, journal: Journal) -> Result<(), String> {
        for call in journal.into_calls() {
            let returned = self.exchange(&call.sent)?;
            if !call.repeats(&returned) {
                return Err(format!(
                    "the run cannot be resumed: sent the same as before the checkpoint, the library asks for something else at {:.2} s, so what it does depends on more than it is sent (a clock, files, a network, random numbers); make the run again with --overwrite",
                    call.sent[0]
                ));
            }
        }
        Ok(())
    }
}

impl Controller for Discon {
    fn update(&mut self, measurements: &Measurements) -> Commands {
        let held = Commands {
            pitch: measurements.pitch,
            generator_torque: measurements.generator_torque,
            yaw_rate: 0.0,
        };
        if self.failure.is_some() {
            return held;
        }
        match self.exchange(&self.layout.sent(measurements)) {
            Ok(returned) => self.layout.commands(&returned),
            Err(failure) => {
                self.failure = Some(failure);
                held
            }
        }
    }

    fn describe(&self) -> String {
        let name = self.request.library.rsplit(['/', '\\']).next();
        format!("discon {}", name.unwrap_or_default())
    }

    fn save(&self) -> Vec<u8> {
        to_bytes(&self.journal)
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        let journal: Journal = from_bytes(state)?;
        self.failure = self.repeat(journal).err();
        Ok(())
    }

    fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    fn remarks(&self) -> Vec<String> {
        self.remarks.told()
    }
}

impl Drop for Discon {
    /// Tells the library that it was the last call, as it may close files then.
    fn drop(&mut self) {
        if let (Some(library), Some(last), None) =
            (&mut self.library, self.journal.last(), &self.failure)
        {
            self.layout.send(&mut self.swap, &last.sent);
            put(&mut self.swap, STATUS, STATUSES[2]);
            library.call(&mut self.swap);
        }
    }
}

/// One call of the library of `hosted` on the turbine at `site`, as it would be at the start of a run: what
/// is wrong with library and input shows before any run begins.
///
/// # Errors
/// [`ControlError::Library`].
pub fn trial(
    hosted: &Hosted,
    libraries: &Arc<dyn Libraries>,
    site: &Site,
) -> Result<(), ControlError> {
    let mut controller = Discon::new(hosted, Arc::clone(libraries), site)?;
    let n_blades = site.rotor.n_blades;
    let (constants, at_rest) = (site.constants, Measurements::at_rest(n_blades));
    let slow = 0.8 * constants.rated_rotor_speed;
    let torque = constants.torque_gain * slow.powi(2);
    controller.update(&Measurements {
        interval: site.interval,
        rotor_speed: slow,
        generator_speed: slow,
        generator_torque: torque,
        power: constants.generator_efficiency * torque * slow,
        pitch: PerBlade::splat(n_blades, constants.fine_pitch),
        ..at_rest
    });
    match controller.failure() {
        None => Ok(()),
        Some(failure) => Err(ControlError::Library(LibraryError(format!(
            "{} cannot begin: {failure}",
            hosted.request.library
        )))),
    }
}
