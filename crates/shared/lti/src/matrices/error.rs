//! What can be wrong with systems and matrix equations.

use num_complex::Complex64;

/// Why a system could not be put together, or a quantity not be worked out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MatrixError {
    /// Two systems that are put together have different sample times.
    #[error("systems with different sample times: {}, {}", time(first), time(second))]
    SampleTimes {
        /// s, `None` in continuous time.
        first: Option<f64>,
        /// s, `None` in continuous time.
        second: Option<f64>,
    },
    /// A system is in the other kind of time than is needed.
    #[error("a system in {needed} time is needed")]
    Time {
        /// `continuous` or `discrete`.
        needed: &'static str,
    },
    /// A length, order or number of signals that does not fit.
    #[error("{what}: {found} where {expected} is needed")]
    Size {
        /// What is counted.
        what: &'static str,
        /// As it is.
        found: usize,
        /// As it should be.
        expected: usize,
    },
    /// A number that is not in its range.
    #[error("{what} is {value}: {needed}")]
    OutOfRange {
        /// What it is.
        what: &'static str,
        /// As it is.
        value: f64,
        /// What it should be.
        needed: &'static str,
    },
    /// A loop without delay whose equation has no single solution.
    #[error(
        "the loop is ill-posed: its gain without delay leaves the equation of the loop singular"
    )]
    IllPosedLoop,
    /// A pole where the system is to be evaluated, or where a transformation has its own.
    #[error("a pole at {pole}, where the system is evaluated")]
    PoleAt {
        /// rad/s in continuous time, – in discrete time.
        pole: Complex64,
    },
    /// A pole that is not strictly stable where stability is needed.
    #[error("the system is not stable: it has a pole at {pole}")]
    Unstable {
        /// rad/s in continuous time, – in discrete time.
        pole: Complex64,
    },
    /// A Riccati equation without a stabilising solution.
    #[error("the Riccati equation has no stabilising solution: an eigenvalue at {eigenvalue}")]
    NoStabilisingSolution {
        /// Eigenvalue nearest the imaginary axis (rad/s), or nearest the unit circle (–).
        eigenvalue: Complex64,
    },
    /// A norm that is infinite.
    #[error("the H2 norm is infinite: the system has gain at infinite frequency")]
    InfiniteNorm,
    /// A matrix that is singular to working precision.
    #[error("{0} is singular")]
    Singular(&'static str),
    /// An entry that is no finite number.
    #[error("an entry of a matrix is no finite number")]
    NotFinite,
    /// An iteration that did not end.
    #[error("{0} did not converge")]
    NotConverged(&'static str),
}

/// A sample time in words.
fn time(interval: &Option<f64>) -> String {
    interval.map_or("continuous".to_owned(), |interval| format!("{interval} s"))
}
