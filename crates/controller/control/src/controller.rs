//! What every controller can do.

use basis::{Channel, Commands, Measurements};
use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

/// Runs on one turbine.
///
/// ```
/// use basis::{Commands, Measurements, PerBlade};
/// use control::{Controller, ForeignState};
///
/// /// Torque that grows with the square of the speed, and no pitch.
/// struct Square(f64);
///
/// impl Controller for Square {
///     fn update(&mut self, measurements: &Measurements) -> Commands {
///         let pitch = PerBlade::splat(measurements.pitch.len(), 0.0);
///         let generator_torque = self.0 * measurements.rotor_speed.powi(2);
///         Commands { pitch, generator_torque, yaw_rate: 0.0 }
///     }
///     fn describe(&self) -> String {
///         "k ω² alone".to_owned()
///     }
///     fn save(&self) -> Vec<u8> {
///         Vec::new()
///     }
///     fn restore(&mut self, _: &[u8]) -> Result<(), ForeignState> {
///         Ok(())
///     }
/// }
/// let mut control: Box<dyn Controller> = Box::new(Square(1e7));
/// let commands = control.update(&Measurements { rotor_speed: 0.5, ..Measurements::at_rest(3) });
/// assert_eq!(commands.generator_torque, 2.5e6);
/// ```
pub trait Controller: Send {
    /// What the turbine does until the next control instant, given its `measurements` at this one. Must not
    /// allocate, block or fail.
    fn update(&mut self, measurements: &Measurements) -> Commands;

    /// What runs, in a few words: "baseline", "helix ccw 4.0° St 0.25".
    fn describe(&self) -> String;

    /// Signals that it adds to the series, such as `EstTrust`.
    fn signals(&self) -> Vec<Channel> {
        Vec::new()
    }

    /// On return `values`, one for each of [`Self::signals`], hold them as they are after the last update, in
    /// SI units. A signal that is not known yet is left as it is.
    fn write_signals(&self, _values: &mut [f64]) {}

    /// Why it cannot go on, after an update or once it is restored; nothing of this house ever fails, a
    /// controller of others may. The run ends there.
    fn failure(&self) -> Option<&str> {
        None
    }

    /// What a reader of the run's numbers must know of it, each as what follows "run R: T".
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }

    /// Everything that time changes, for a checkpoint; [`to_bytes`] makes it of plain data.
    fn save(&self) -> Vec<u8>;

    /// Continues with the same bits from what a controller of the same settings [saved](Self::save).
    ///
    /// # Errors
    /// [`ForeignState`] for bytes that such a controller did not write.
    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState>;
}

/// Bytes that are no state of this controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the stored state does not belong to this controller")]
pub struct ForeignState;

/// `state` as bytes, for [`Controller::save`].
///
/// # Panics
/// When `state` holds a sequence of unknown length, which plain data never does.
pub fn to_bytes<T: Serialize>(state: &T) -> Vec<u8> {
    postcard::to_stdvec(state).expect("plain data has a length")
}

/// What [`to_bytes`] made bytes of, for [`Controller::restore`].
///
/// # Errors
/// [`ForeignState`] for other bytes.
pub fn from_bytes<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, ForeignState> {
    match postcard::take_from_bytes(bytes) {
        Ok((state, [])) => Ok(state),
        _ => Err(ForeignState),
    }
}
