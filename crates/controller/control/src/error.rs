//! Why a turbine cannot be controlled as a case has it.

use crate::library::LibraryError;
use crate::meandering::MeanderingError;
use basis::keys::Value;
use estimation::EstimationError;
use thiserror::Error;

/// Why a turbine cannot be controlled as the case has it.
#[derive(Debug, Error)]
pub enum ControlError {
    /// The phase of a helix cannot be estimated so.
    #[error("the phase of the helix cannot be estimated")]
    Estimation(#[from] EstimationError),
    /// Meandering cannot be followed so.
    #[error("the meandering cannot be followed")]
    Meandering(#[from] MeanderingError),
    /// How pitch acts on the loads is not known.
    #[error("how pitch acts on the loads was neither given nor identified before the run")]
    NotDecoupled,
    /// The azimuth offset of a turbine that joins a helix is not known.
    #[error(
        "the azimuth offset with which it pitches was neither given nor identified before the run"
    )]
    NoAzimuthOffset,
    /// An excitation that fades out before it has faded in.
    #[error(
        "stop = {stop} s comes before the excitation has its full amplitude: it starts at {start} s and fades in over one period of {period:.1} s; stop at {earliest} s or later, or leave `stop` out"
    )]
    StopsTooEarly {
        /// Given stop (s).
        stop: f64,
        /// Start (s).
        start: f64,
        /// Excitation period (s).
        period: f64,
        /// Earliest stop, in whole seconds (s).
        earliest: f64,
    },
    /// A shared library that cannot serve.
    #[error(transparent)]
    Library(LibraryError),
    /// A control law that nobody has read.
    #[error(
        "the control law in {files} was not read; a study reads it, a program sets `linear_laws`"
    )]
    NoLinearLaws {
        /// Its file, or those of its family.
        files: String,
    },
    /// A run of reference that nobody has read.
    #[error(
        "the run of reference {run} was not read; a study reads it once it is complete, a program sets `linear_laws.reference`"
    )]
    NoReference {
        /// Its folder.
        run: String,
    },
    /// A control law that samples faster than the turbine is controlled.
    #[error(
        "the control law in {file} samples every {interval} s, the turbine is controlled every {control} s: make the law with an interval of {control} s or longer"
    )]
    FastLinearLaw {
        /// Its file.
        file: String,
        /// Its interval (s).
        interval: f64,
        /// Control interval (s).
        control: f64,
    },
    /// Noise that the pitch actuator cannot follow.
    #[error(
        "noise_amplitude_deg = {amplitude_deg} up to noise_to_hz = {frequency} Hz on a helix of {helix_deg}° ask for {asked_deg:.1}°/s of pitch at rated rotor speed, the actuator has {most_deg:.1}°/s: {fix}"
    )]
    NoiseTooFast {
        /// Amplitude of the noise (deg).
        amplitude_deg: f64,
        /// Upper end of its band (Hz).
        frequency: f64,
        /// Amplitude of the helix beneath (deg).
        helix_deg: f64,
        /// Fastest pitch of a blade under both (deg/s).
        asked_deg: f64,
        /// The actuator's fastest (deg/s).
        most_deg: f64,
        /// What would mend it.
        fix: String,
    },
    /// Nothing runs on a turbine that is not there.
    #[error("the turbine is not there in this run")]
    NotThere,
    /// A key that the kind does not have, or a value that the key cannot hold.
    #[error("`{key}` = {value:?} cannot be in {heading}; {about}")]
    Key {
        /// The kind's table.
        heading: &'static str,
        /// The key.
        key: String,
        /// Its value; none when it is missing.
        value: Option<Value>,
        /// What the key means, or which keys there are.
        about: String,
    },
    /// What a kind that was added has to say.
    #[error("{kind}: {source}")]
    Added {
        /// Name of the kind.
        kind: &'static str,
        /// What it says.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
}
