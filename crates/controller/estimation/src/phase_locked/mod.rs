//! Phase-locked loops: frequency, phase, amplitude and offset of a slow, irregular oscillation such as wake
//! meandering.
//!
//! ```text
//!            ┌───────────┐ A sin θ   ┌─────────────┐ θ̃  ┌─────────────┐
//!  sample ──>│ generator │──────────>│ phase error │───>│ loop filter │──┬──> rate ω̂
//!            │  at ω̂     │ −A cos θ  └─────────────┘    └─────────────┘  │
//!            └───────────┘                  ^ θ̂                          v
//!              ^      └──> amplitude,       └──────────────────── ∫ ω̂ (oscillator) ──> phase
//!              └───────── ω̂      offset
//! ```
//!
//! [`PhaseLockedLoop`] follows one signal, [`TwoAxisLoop`] a rotor's tilt and yaw moments as an
//! [`Estimator`](crate::Estimator); [`follow`] follows a whole record. `docs/phase-locked-loops.md` has the
//! theory.
//!
//! Source: van Veldhoven, "Closed-Loop Wake Meandering Control of Downstream Wind Turbines", TU Delft 2024,
//! chapter 2.

mod amplitude;
mod generator;
mod lock;
mod oscillator;
mod record;
mod single;
mod stability;
mod transfer;
mod two_axis;

pub use amplitude::AmplitudeLoop;
pub use generator::{Generator, GeneratorKind, dc_gain};
pub use oscillator::{Gains, LoopSettings, Order, Oscillator, Pole};
pub use record::{FEWEST_PERIODS, follow};
pub use single::{Estimate, PhaseLockedLoop, PhaseLockedSettings};
pub use transfer::{Response, Transfer, transfer};
pub use two_axis::{Axis, Leader, TwoAxisEstimate, TwoAxisLoop, TwoAxisSettings};

/// Why a phase-locked loop cannot be made, or a record cannot be followed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PhaseLockedError {
    /// Rates do not span a range above zero.
    #[error("rates from {lowest} to {highest} rad/s are not a range above zero")]
    Rates {
        /// Lowest rate (rad/s).
        lowest: f64,
        /// Highest rate (rad/s).
        highest: f64,
    },
    /// Too few samples a period.
    #[error(
        "samples every {interval} s are too far apart for the highest rate; the interval can be {longest:.3} s at most"
    )]
    Interval {
        /// Interval given (s).
        interval: f64,
        /// Longest possible interval (s).
        longest: f64,
    },
    /// Damping of a generator out of range.
    #[error("damping {damping} of the generator is not between 0 and {most:.4}")]
    Damping {
        /// Damping given (–).
        damping: f64,
        /// Upper end of the range (–).
        most: f64,
    },
    /// Ratio of poles out of range.
    #[error("ratio {pole_ratio} of the offset's pole to the oscillation's is not positive")]
    PoleRatio {
        /// Ratio given (–).
        pole_ratio: f64,
    },
    /// Gain of the offset out of range.
    #[error("gain {dc_gain} of the generator's offset is not positive")]
    DcGain {
        /// Gain given (–).
        dc_gain: f64,
    },
    /// A number of the loop out of range.
    #[error("{name} of the loop is {value}, not positive")]
    LoopSetting {
        /// Which number, with its unit.
        name: &'static str,
        /// Its value (unit as in `name`).
        value: f64,
    },
    /// Unstable gains.
    #[error(
        "the loop is unstable at {rate:.4} rad/s: a pole at {pole}; lower its natural rate or raise its damping"
    )]
    Unstable {
        /// The rightmost pole.
        pole: Pole,
        /// Rate of the oscillation at which it is unstable (rad/s).
        rate: f64,
    },
    /// Unstable control of the amplitude.
    #[error(
        "the amplitude loop is unstable at {rate:.4} rad/s: a pole at {pole} with an integral gain of {integral} 1/s; it is stable up to {largest:.4} 1/s"
    )]
    AmplitudeUnstable {
        /// The pole of an amplitude error.
        pole: Pole,
        /// Rate of the oscillation at which it is unstable (rad/s).
        rate: f64,
        /// Integral gain given (1/s).
        integral: f64,
        /// Largest stable integral gain at that rate (1/s); zero where the proportional gain alone is too
        /// large.
        largest: f64,
    },
    /// Too few samples to follow anything.
    #[error("{n_samples} samples are too few; three periods of the lowest rate are {needed}")]
    TooShort {
        /// Samples given (–).
        n_samples: usize,
        /// Samples needed (–).
        needed: usize,
    },
    /// Nothing to follow.
    #[error("the {n_samples} samples are all equal: there is no oscillation to follow")]
    Constant {
        /// Samples given (–).
        n_samples: usize,
    },
}

#[cfg(test)]
mod tests;
