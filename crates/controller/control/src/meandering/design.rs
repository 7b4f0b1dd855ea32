//! What meandering control is built with, in SI units, and what keeps it from being built.

use super::{Decoupling, PhaseLockedError, Reference, TwoAxisSettings};
use estimation::phase_locked::AmplitudeLoop;
use serde::{Deserialize, Serialize};

/// What the phase-locked loop is locked to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Followed {
    /// The loads as they are, what pitch adds among them, as the source has it. The phase then answers to the
    /// control that it commands, the more the less is left of the load; deep attenuation oscillates or loses
    /// the lock.
    #[default]
    Load,
    /// The loads less what pitch adds to them: the wake's own part, which stays however little is left of the
    /// sum. Each axis' pitch then goes with that axis' own phase.
    Wake,
}

/// Settings of the control.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeanderingControlSettings {
    /// How the loads are followed, and which way they circle.
    pub follower: TwoAxisSettings,
    /// What is followed.
    pub followed: Followed,
    /// Target amplitude over the baseline's, α (–): above one amplifies, below attenuates.
    pub factor: f64,
    /// The baseline's amplitudes.
    pub reference: Reference,
    /// How pitch acts on the loads.
    pub decoupling: Decoupling,
    /// Integral action: amplitude added per time and amplitude error (1/s).
    pub bandwidth: f64,
    /// Proportional action: amplitude added per amplitude error (–).
    pub proportional: f64,
    /// Largest pitch amplitude on either axis (rad); 0, with no constant pitch either, only monitors.
    pub maximum_amplitude: f64,
    /// Largest constant pitch on either axis to bring offsets to zero (rad); 0 leaves offsets alone.
    pub maximum_offset: f64,
    /// Whether it fades out while the loop is not locked, and learns nothing then. Without it the estimated
    /// phase is pitched with whatever it follows, as the source does.
    pub needs_lock: bool,
    /// Time from which it acts (s).
    pub start: f64,
}

/// What keeps meandering control from being built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MeanderingError {
    /// The loads cannot be followed so.
    #[error(transparent)]
    PhaseLocked(#[from] PhaseLockedError),
    /// A number out of range.
    #[error("{name} is {value}, not {expected}")]
    Setting {
        /// Which number, with its unit.
        name: &'static str,
        /// What it is (unit as in `name`).
        value: f64,
        /// What it should be.
        expected: &'static str,
    },
}

impl MeanderingControlSettings {
    /// Whether no pitch is allowed, so that the loads are followed and nothing else.
    pub fn only_monitors(&self) -> bool {
        self.maximum_amplitude == 0.0 && self.maximum_offset == 0.0
    }

    /// How each axis' amplitude is brought to its reference.
    pub(super) fn amplitude_loop(&self) -> AmplitudeLoop {
        AmplitudeLoop {
            integral: self.bandwidth,
            proportional: self.proportional,
            delay: self.decoupling.delay,
            is_taken_off: self.followed == Followed::Wake,
        }
    }

    /// That every number can be used.
    pub(super) fn check(&self) -> Result<(), MeanderingError> {
        let check = |name, value: f64, good: bool, expected| {
            if good && value.is_finite() {
                Ok(())
            } else {
                Err(MeanderingError::Setting { name, value, expected })
            }
        };
        let positive = |name, value: f64| check(name, value, value > 0.0, "positive");
        let not_negative = |name, value: f64| check(name, value, value >= 0.0, "zero or more");
        not_negative("factor of the baseline's amplitude (–)", self.factor)?;
        positive("moment lost per pitch (N m/rad)", self.decoupling.gain)?;
        let offset = self.decoupling.azimuth_offset;
        check("azimuth offset (rad)", offset, true, "a number")?;
        check("delay of the load behind pitch (s)", self.decoupling.delay, true, "a number")?;
        positive("bandwidth of the integral action (1/s)", self.bandwidth)?;
        not_negative("proportional action (–)", self.proportional)?;
        not_negative("largest pitch amplitude (rad)", self.maximum_amplitude)?;
        not_negative("largest constant pitch (rad)", self.maximum_offset)?;
        check("start (s)", self.start, true, "a number")?;
        match self.reference {
            Reference::Given { tilt, yaw } => {
                positive("baseline amplitude of the tilt moment (N m)", tilt)?;
                positive("baseline amplitude of the yaw moment (N m)", yaw)
            }
            Reference::Learned { duration } => positive("duration of learning (s)", duration),
            Reference::Observed => Ok(()),
        }
    }
}
