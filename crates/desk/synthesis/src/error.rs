//! What keeps a controller from being found.

use lti::Complex64;
use lti::matrices::MatrixError;

/// Which assumption on a generalised plant fails, or what else went wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SynthesisError {
    /// A system could not be put together or worked out.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
    /// A predictor for a model that is not stable.
    #[error("a Smith predictor bridges the delay of stable models alone")]
    UnstableModel(#[source] MatrixError),
    /// More signals are named than the system has.
    #[error("{what}: the system has {found}, {needed} are needed")]
    Signals {
        /// Which signals.
        what: &'static str,
        /// As many as there are.
        found: usize,
        /// At least as many.
        needed: usize,
    },
    /// A weight or option that is not in its range.
    #[error("{what} is {value}: {needed}")]
    OutOfRange {
        /// What it is.
        what: &'static str,
        /// As it is.
        value: f64,
        /// What it should be.
        needed: &'static str,
    },
    /// A mode that no controller can stabilise, because no control moves it.
    #[error(
        "not stabilisable: no control moves the mode at {mode} (a weight that integrates has such one)"
    )]
    NotStabilisable {
        /// rad/s in continuous time, – in discrete time.
        mode: Complex64,
    },
    /// A mode that no controller can stabilise, because no measurement shows it.
    #[error(
        "not detectable: no measurement shows the mode at {mode} (a weight that integrates has such one)"
    )]
    NotDetectable {
        /// rad/s in continuous time, – in discrete time.
        mode: Complex64,
    },
    /// D12 without full column rank: some control costs nothing at infinite frequency.
    #[error(
        "D12 has rank {rank} of {controls}: the errors do not show each control at high frequency"
    )]
    FreeControl {
        /// Rank.
        rank: usize,
        /// Controls.
        controls: usize,
    },
    /// D21 without full row rank: some measurement is free of noise at infinite frequency.
    #[error(
        "D21 has rank {rank} of {measurements}: no disturbance reaches some measurement at high frequency"
    )]
    PerfectMeasurement {
        /// Rank.
        rank: usize,
        /// Measurements.
        measurements: usize,
    },
    /// The way from the controls to the errors has a zero on the border of stability.
    #[error(
        "the errors do not show the controls at {frequency} rad/s: a zero on the border of stability"
    )]
    ControlZero {
        /// rad/s.
        frequency: f64,
    },
    /// The way from the disturbances to the measurements has a zero on the border of stability, as a plant
    /// with a pole there has where disturbances enter at its output alone.
    #[error(
        "the measurements do not show disturbances at {frequency} rad/s: a zero on the border of stability"
    )]
    MeasurementZero {
        /// rad/s.
        frequency: f64,
    },
    /// A weight that is not stable.
    #[error("the {weight} weight is not stable: it has a pole at {pole}")]
    UnstableWeight {
        /// Which one.
        weight: &'static str,
        /// rad/s in continuous time, – in discrete time.
        pole: Complex64,
    },
    /// Disturbances reach errors at once, so that the H2 norm in continuous time is infinite.
    #[error("the H2 norm is infinite: D11 is not zero")]
    DirectDisturbance,
    /// A weight that should be symmetric and positive semidefinite or definite.
    #[error("the {0} is not symmetric and positive, or has another size")]
    NotPositive(&'static str),
    /// No bound up to the largest that is tried lets both Riccati equations be solved.
    #[error("no controller keeps the norm below {largest}")]
    NoBound {
        /// The largest one tried.
        largest: f64,
    },
    /// A controller was found whose closed loop is not stable or exceeds its bound.
    #[error("no controller up to the bound {bound} stood its check: {found}")]
    CheckFailed {
        /// The bound of the last one.
        bound: f64,
        /// What was found.
        found: String,
    },
}
