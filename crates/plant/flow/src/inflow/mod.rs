//! Wind that blows in: mean profiles, gusts, synthetic turbulence carried along by Taylor's hypothesis.
//!
//! [`MeanProfile`] alone is steady wind, [`DeterministicWind`] adds veer and one event; [`mann::generate`]
//! and [`kaimal::generate`] make a [`TurbulenceBox`]. For a solver's inlet [`TurbulentInflow`] carries it
//! past the farm on top of a profile, [`sizing`] says how large it must be, and [`RecordedInflow`] brings
//! the planes of a file, or what [`CutPlanes`] takes of them. Without a flow solver,
//! [`PrescribedWind`] is the flow: any of these winds, or [`Planes`] that come from a file one by one.
//! Sources: Mann (1994) J. Mann, J. Fluid Mech. 273 (1994) 141-168; Mann (1998) J. Mann, Probabilistic
//! Engineering Mechanics 13 (1998) 269-282.

pub mod column;
pub mod cut;
pub mod deterministic;
pub mod iec;
pub mod kaimal;
pub mod lifetime;
pub mod mann;
mod noise;
pub mod planes;
pub mod prescribed;
pub mod profile;
pub mod recorded;
pub mod sampled;
pub mod sectors;
pub mod sizing;
pub mod spectra;
pub mod statistics;
pub mod tabulated;
pub mod tensor;
pub mod turbulence_box;
pub mod turbulent;
mod walk;

pub use column::{ColumnLevel, MeanColumn};
pub use cut::{Cut, CutError, CutPlanes};
pub use deterministic::DeterministicWind;
pub use planes::{PlaneGrid, Planes};
pub use prescribed::PrescribedWind;
pub use profile::{GREATEST_ROUGHNESS, MeanProfile};
pub use recorded::RecordedInflow;
pub use sampled::sampled;
pub use sectors::{Disc, PlaneMeans, SECTOR_NAMES};
pub use sizing::size_box;
pub use tabulated::TabulatedWind;
pub use tensor::SpectralTensor;
pub use turbulence_box::TurbulenceBox;
pub use turbulent::TurbulentInflow;

use basis::Vector3;
use thiserror::Error;

/// Why turbulence could not be made or used.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum InflowError {
    /// A setting out of its range.
    #[error("{name} = {value} cannot be used: {expected}")]
    Setting {
        /// Setting, in words.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// Arrays that do not fit the numbers of points.
    #[error("a box of {n_x} × {n_y} × {n_z} points needs {needed} values per component, component {component} has {found}", n_x = n_points[0], n_y = n_points[1], n_z = n_points[2])]
    Shape {
        /// Points along x, y, z.
        n_points: [usize; 3],
        /// Component, 0 to 2.
        component: usize,
        /// Values needed.
        needed: usize,
        /// Values found.
        found: usize,
    },
    /// A box that the machine cannot hold.
    #[error("a box of {n_x} × {n_y} × {n_z} points needs {memory} bytes of memory, which are not available; make it coarser or shorter", n_x = n_points[0], n_y = n_points[1], n_z = n_points[2])]
    Memory {
        /// Points along x, y, z.
        n_points: [usize; 3],
        /// Bytes at the peak.
        memory: u64,
    },
    /// A place where the wind is not known.
    #[error(
        "the wind is needed at y {y:.1} m, z {z:.1} m, outside its grid of y {left:.1} to {right:.1} m, z {low:.1} to {high:.1} m; make the grid larger, or move it",
        y = position.y, z = position.z, left = across[0], right = across[1], low = up[0], high = up[1]
    )]
    Outside {
        /// The place, farm frame (m).
        position: Vector3,
        /// What the grid spans along y (m).
        across: [f64; 2],
        /// What the grid spans along z (m).
        up: [f64; 2],
    },
    /// A record of wind that is over.
    #[error(
        "the wind's record of {length:.1} s does not repeat, and the run needs it at {time:.1} s; make a longer record, or one that repeats"
    )]
    Ended {
        /// Length of the record (s).
        length: f64,
        /// Time into the record (s).
        time: f64,
    },
    /// The receiver of its progress stopped it.
    #[error("the making of turbulence was broken off")]
    BrokenOff,
    /// A plane of wind that its source could not give.
    #[error("plane {step} of the wind cannot be read: {problem}")]
    Plane {
        /// Its place in order of arrival, from 0.
        step: usize,
        /// What the source says: file, place and fix.
        problem: String,
    },
}

/// # Errors
/// [`InflowError::Setting`] for numbers of points or spacings (m) along x, y, z that make no box to
/// transform.
pub(crate) fn check_grid(n_points: [usize; 3], spacing: [f64; 3]) -> Result<(), InflowError> {
    for points in n_points {
        if !(2..=1 << 20).contains(&points) {
            let (name, value) = ("number of points (–)", points as f64);
            let expected = "2 to 1048576 along each axis";
            return Err(InflowError::Setting { name, value, expected });
        }
    }
    if !n_points[0].is_multiple_of(2) {
        let (name, value) = ("number of points along x (–)", n_points[0] as f64);
        return Err(InflowError::Setting { name, value, expected: "an even number" });
    }
    for spacing in spacing {
        positive("spacing (m)", spacing)?;
    }
    Ok(())
}

pub(crate) fn positive(name: &'static str, value: f64) -> Result<(), InflowError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(InflowError::Setting { name, value, expected: "a positive number" })
    }
}

pub(crate) fn not_negative(name: &'static str, value: f64) -> Result<(), InflowError> {
    if value.is_finite() && value >= 0.0 {
        Ok(())
    } else {
        Err(InflowError::Setting { name, value, expected: "zero or a positive number" })
    }
}
